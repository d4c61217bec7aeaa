#include "runtime/pack/gltf_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "runtime/base/array.h"
#include "runtime/base/limits.h"
#include "runtime/pack/tour_pack.h"

namespace flaneur {
namespace {

constexpr int64_t kMostWhole = 1'000'000'000'000;

// Members that are indices, counts or places in the file, alone or in a list; and all members of "attributes".
constexpr std::array<std::string_view, 21> kWholeMembers{
    "buffer", "bufferView", "byteLength", "byteOffset", "byteStride", "children", "componentType",
    "count",  "index",      "indices",    "input",      "joints",     "material", "mesh",
    "mode",   "node",       "nodes",      "output",     "sampler",    "skin",     "source"};
constexpr std::array<std::string_view, 8> kLists{"accessors", "animations", "bufferViews", "images",
                                                 "materials", "meshes",     "nodes",       "skins"};

bool IsWholeMember(std::string_view key) {
  return std::find(kWholeMembers.begin(), kWholeMembers.end(), key) != kWholeMembers.end();
}

void CheckNumber(const Json& json, const std::string& key, bool whole) {
  if (!json.is_number()) return;
  if (whole && !json.is_number_integer()) throw PackRefused("has '" + key + "' that is no whole number");
  const auto number = json.get<double>();
  if (whole && !(number >= -1 && number <= static_cast<double>(kMostWhole)))
    throw PackRefused("has '" + key + "' that is out of range");
  if (!(std::abs(number) <= kMostNumber)) throw PackRefused("has a number in '" + key + "' that is out of range");
}

void CheckValue(const Json& json, const std::string& key, bool whole) {
  CheckNumber(json, key, whole);
  if (json.is_array()) {
    for (const Json& item : json) CheckValue(item, key, whole);
  }
  if (!json.is_object()) return;
  for (const auto& [member, value] : json.items()) {
    if (member == "extras" || member == kTourExtension) continue;
    CheckValue(value, member, key == "attributes" || IsWholeMember(member));
  }
}

}  // namespace

void CheckGltf(const Json& root) {
  for (const std::string_view list : kLists) {
    const auto found = root.find(list);
    if (found == root.end()) continue;
    const auto is_object = [](const Json& item) { return item.is_object(); };
    if (!found->is_array() || !std::all_of(found->begin(), found->end(), is_object))
      throw PackRefused("has '" + std::string(list) + "' that is no list of objects");
  }
  CheckValue(root, "", false);
}

NodeTree TreeOf(const Json& root) {
  const size_t count = CountOf(root, "nodes");
  NodeTree tree{std::vector<int>(count, -1), std::vector<int>(count, -1)};
  for (size_t i = 0; i < count; ++i) {
    const Json& node = root["nodes"][i];
    const auto children = node.find("children");
    if (children == node.end()) continue;
    for (const Json& child : *children) {
      const auto c = child.get<int64_t>();
      if (!InRange(tree.parent, c) || At(tree.parent, c) >= 0) throw PackRefused("has a broken node tree");
      At(tree.parent, c) = static_cast<int>(i);
    }
  }
  std::vector<int> chain;  // up from a node to one whose depth is known
  for (size_t i = 0; i < count; ++i) {
    chain.clear();
    int n = static_cast<int>(i);
    for (; n >= 0 && At(tree.depth, n) < 0; n = At(tree.parent, n)) {
      chain.push_back(n);
      if (chain.size() > kMostNodeDepth) throw PackRefused("has nodes in a loop, or more than 256 in each other");
    }
    int depth = n < 0 ? -1 : At(tree.depth, n);
    for (size_t k = chain.size(); k-- > 0;) At(tree.depth, chain[k]) = ++depth;
    if (depth >= static_cast<int>(kMostNodeDepth)) throw PackRefused("has more than 256 nodes in each other");
  }
  return tree;
}

}  // namespace flaneur
