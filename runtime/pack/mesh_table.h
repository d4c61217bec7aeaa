// Internal to runtime/pack.
#pragma once
#include <map>
#include <vector>

#include "runtime/base/array.h"

namespace flaneur {

// Which of the file's meshes are used, each once, in the order of their first use.
class MeshTable {
 public:
  int Get(int gltf_mesh) {
    const auto [entry, fresh] = indices_.try_emplace(gltf_mesh, Count(used_));
    if (fresh) used_.push_back(gltf_mesh);
    return entry->second;
  }
  const std::vector<int>& used() const { return used_; }

 private:
  std::map<int, int> indices_;
  std::vector<int> used_;
};

}  // namespace flaneur
