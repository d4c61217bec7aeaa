// One primitive's raw attributes, however they were stored, made into a mesh of indexed triangles.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "pipeline/io/gltf_document.h"
#include "runtime/base/error.h"

namespace flaneur {

// uv' = offset + rotation * scale * uv of KHR_texture_transform, on one of the file's uv sets.
struct UvSource {
  int set = 0;
  Vec2 offset;
  float rotation_rad = 0;
  Vec2 scale{1, 1};
};

enum class TriangleMode { kList, kStrip, kFan };

struct RawPrimitive {
  std::map<std::string, std::vector<float>> attributes;  // by glTF's names, packed; FACE_0, ...: by FaceMove
  std::vector<uint32_t> indices;                         // empty: 0, 1, 2, ...
  bool indexed = false;
  TriangleMode mode = TriangleMode::kList;
};

// Missing normals are computed flat, as glTF asks, which parts the triangles; triangles with a
// repeated corner go. Errors: an attribute of the wrong length, an index out of range, a non-finite
// number (names attribute and vertex).
Error MakePrimitive(RawPrimitive raw, const UvSource& uv_source, DocumentPrimitive* out);

}  // namespace flaneur
