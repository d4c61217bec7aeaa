// What takes longest of writing meshes and clips as glTF, apart from the builder: so that much is done at once, and
// nothing twice.
#pragma once
#include <span>
#include <vector>

#include "pipeline/core/avatar.h"
#include "pipeline/core/mesh.h"
#include "pipeline/io/clip_keys.h"
#include "pipeline/io/draco_codec.h"
#include "pipeline/io/gltf_builder.h"
#include "runtime/base/error.h"
#include "runtime/base/jobs.h"

namespace flaneur {

struct EncodedPart {
  int material = -1;
  DracoMesh draco;  // where the mesh is compressed
  Mesh mesh;        // else: only what its triangles use
};

// A mesh's parts as GltfBuilder::AddMesh stores them.
struct EncodedMesh {
  bool compressed = false, byte_joints = false;
  std::vector<EncodedPart> parts;
};

// All parts share one grid of rounded positions, so that they stay joined; those without triangles are left out.
// Errors: an index or array length out of range, Draco's refusal.
Error EncodeMesh(std::span<const Mesh> parts, const DracoOptions& draco, EncodedMesh* encoded);

struct EncodedAvatar {
  std::vector<EncodedMesh> levels, props;      // as AvatarLevels::levels and Avatar::props
  std::vector<std::vector<KeyChannel>> clips;  // as Avatar::clips
};

// draco.compress: clips with as few and as rough keys as keep every vertex within 1 mm (see ReduceKeysTogether); else
// with every key of whatever moves. Errors: as EncodeMesh; each names the mesh.
Error EncodeAvatar(const AvatarLevels& levels, const DracoOptions& draco, Jobs* jobs, EncodedAvatar* encoded);

}  // namespace flaneur
