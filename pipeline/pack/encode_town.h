// A town as a pack has it: its meshes compressed, which is most of the work that a pack takes besides its people.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "pipeline/core/avatar.h"
#include "pipeline/core/scene.h"
#include "pipeline/io/encode_avatar.h"
#include "runtime/base/error.h"
#include "runtime/base/jobs.h"

namespace flaneur {

struct EncodedTown {
  struct Node {
    std::string name;
    size_t mesh = 0;
    Transform transform;
    std::string extras;  // JSON; empty: none
  };
  std::vector<Material> materials;
  std::vector<Image> images;
  std::vector<Node> nodes;
  std::vector<EncodedMesh> meshes;  // nodes of the same meshes share theirs
};

// The same town gives the same bytes. Errors: geometry that cannot be compressed, and what turns but is sheared; names
// the node.
Error EncodeTown(const Scene& town, Jobs* jobs, EncodedTown* encoded);

}  // namespace flaneur
