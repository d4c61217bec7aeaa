// A glTF file's content as plain arrays: what the scene and the avatar reader both start from.
// Every index in it is in range and every accessor is decoded.
#pragma once
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/core/mesh.h"
#include "pipeline/rig/bone_names.h"
#include "pipeline/rig/face_names.h"
#include "runtime/base/error.h"
#include "runtime/base/math.h"

namespace flaneur {

// Joints and weights of a vertex: `per_vertex` pairs, vertex by vertex, as in the file.
struct Influences {
  int per_vertex = 0;
  std::vector<int> joints;
  std::vector<float> weights;
};

struct DocumentPrimitive {
  Mesh mesh;  // normals and indices always there; joints and weights empty
  Influences influences;
  std::array<std::vector<Vec3>, kFaceMoves>
      face;  // by FaceMove: where a morph target takes each vertex; empty: nowhere
};

struct DocumentMesh {
  std::string name;
  bool morphs = false;
  std::vector<DocumentPrimitive> primitives;  // triangles only
};

// Numbers and strings of ours in a node's extras; empty or 0 where absent.
struct NodeTags {
  std::string kind, ground, street, clip, avatars, turns;
  float radius_m = 0, width_m = 0, walk_speed_mps = 0, seat_m = 0, stay_s = 0;
};

struct DocumentNode {
  std::string name;  // "node 7" where the file gives none
  int parent = -1;
  bool in_scene = false;
  Vec3 translation;
  Quat rotation;
  Vec3 scale{1, 1, 1};
  bool has_matrix = false;  // then `matrix` is the local transform
  Mat4 matrix;
  int mesh = -1, skin = -1;
  NodeTags tags;
};

struct DocumentSkin {
  std::vector<int> joints;          // nodes
  std::vector<Mat4> inverse_binds;  // one a joint
};

enum class Interpolation { kStep, kLinear, kCubic };
enum class ChannelPath { kTranslation, kRotation, kScale };

// Key k is values[k], for kCubic values[3k] (in-tangent), [3k + 1], [3k + 2] (out-tangent).
struct DocumentChannel {
  int node = 0;
  ChannelPath path = ChannelPath::kTranslation;
  Interpolation interpolation = Interpolation::kLinear;
  std::vector<float> times;  // rising, at least one
  std::vector<Vec4> values;
};

struct DocumentClip {
  std::string name;
  std::vector<DocumentChannel> channels;
};

// What VRM says of a node: part and side of a human body.
struct DocumentBone {
  int node = 0;
  BodyPart part = BodyPart::kNone;
  BodySide side = BodySide::kNone;
};

struct GltfDocument {
  std::string path;  // for messages
  std::vector<DocumentNode> nodes;
  std::vector<int> order;            // all nodes, depth first, parents before children
  std::vector<DocumentMesh> meshes;  // those the scene does not use are empty
  std::vector<DocumentSkin> skins;
  std::vector<DocumentClip> clips;
  std::vector<Material> materials;
  std::vector<Image> images;        // only those that a material uses
  std::vector<DocumentBone> bones;  // of VRM 0.x, VRM 1.0 and VRM animations
};

// Parents before children; nodes in a ring are never reached.
std::vector<int> DepthFirst(const std::vector<int>& roots, const std::vector<std::vector<int>>& children_of);

Mat4 LocalMatrix(const DocumentNode& node);

// World matrices of all nodes, from each node's own transform.
std::vector<Mat4> WorldMatrices(const GltfDocument& document);

// Errors and warnings name the element and the file: `named`, the user's own where the glTF was made of it; empty:
// `path`.
Error LoadGltf(const std::filesystem::path& path, GltfDocument* document, std::vector<std::string>* warnings,
               const std::filesystem::path& named = {});

}  // namespace flaneur
