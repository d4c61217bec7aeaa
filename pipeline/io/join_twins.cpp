#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "pipeline/core/rotation.h"
#include "pipeline/io/join_documents.h"
#include "pipeline/rig/copy_clip.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

constexpr float kSamePlace = 0.002f;  // of the skeleton's size
constexpr float kSameTurn_rad = 0.02f;
constexpr size_t kMostPairs = 4'000'000;  // of joints that are compared

struct Skeleton {
  std::vector<int> skins;
  std::map<int, Mat4> bind;  // by joint's node: its matrix when the skin is bound
  size_t channels = 0;       // of clips, that move it
};

// Skins that share a joint are of one skeleton.
std::vector<Skeleton> SkeletonsOf(const GltfDocument& document) {
  std::vector<Skeleton> skeletons;
  std::vector<int> of_node(document.nodes.size(), -1);
  for (int s = 0; s < Count(document.skins); ++s) {
    const DocumentSkin& skin = At(document.skins, s);
    Skeleton own;
    own.skins = {s};
    for (size_t j = 0; j < skin.joints.size(); ++j) {
      const int known = At(of_node, skin.joints[j]);
      if (known >= 0) {
        Skeleton other = std::exchange(At(skeletons, known), {});
        own.skins.insert(own.skins.end(), other.skins.begin(), other.skins.end());
        for (const auto& [node, bind] : other.bind) At(of_node, node) = -1;
        own.bind.merge(other.bind);
      }
      own.bind.emplace(skin.joints[j], Inverse(skin.inverse_binds[j]));
    }
    for (const auto& [node, bind] : own.bind) At(of_node, node) = Count(skeletons);
    skeletons.push_back(std::move(own));
  }
  for (const DocumentClip& clip : document.clips) {
    for (const DocumentChannel& channel : clip.channels) {
      if (const int s = At(of_node, channel.node); s >= 0) ++At(skeletons, s).channels;
    }
  }
  std::erase_if(skeletons, [](const Skeleton& each) { return each.bind.empty(); });
  return skeletons;
}

// Without the number that programs write behind a name that is there already: "Hips.001", "Hips_1".
std::string Stem(const std::string& name) {
  const std::string bare = BareName(name);
  const size_t last = bare.find_last_not_of("0123456789");
  if (last == std::string::npos || last + 1 == bare.size()) return bare;
  return bare.substr(0, bare[last] == '.' || bare[last] == '_' ? last : last + 1);
}

float SizeOf(const Skeleton& skeleton) {
  Vec3 low = TransformPoint(skeleton.bind.begin()->second, {}), high = low;
  for (const auto& [node, bind] : skeleton.bind) {
    const Vec3 p = TransformPoint(bind, {});
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return Length(high - low);
}

bool Same(const Mat4& a, const Mat4& b, float near) {
  return Length(TransformPoint(a, {}) - TransformPoint(b, {})) <= near &&
         AngleOf(Product(Conjugate(RotationOf(a)), RotationOf(b))) < kSameTurn_rad;
}

// The joints of `twin` that stand where joints of `main` with their names do.
std::map<int, int> TwinsOf(const GltfDocument& document, const Skeleton& main, const Skeleton& twin) {
  std::multimap<std::string, int> by_stem;
  for (const auto& [node, bind] : main.bind) by_stem.emplace(Stem(At(document.nodes, node).name), node);
  std::map<int, int> twins;
  const float near = kSamePlace * SizeOf(main);
  for (const auto& [node, bind] : twin.bind) {
    const auto [begin, end] = by_stem.equal_range(Stem(At(document.nodes, node).name));
    const auto same =
        std::find_if(begin, end, [&](const auto& at) { return Same(bind, main.bind.at(at.second), near); });
    if (same != end) twins[node] = same->second;
  }
  return twins;
}

// Parents before children again.
void Reorder(GltfDocument* document) {
  std::vector<std::vector<int>> children_of(document->nodes.size());
  std::vector<int> roots;
  for (const int n : document->order) {
    const int parent = At(document->nodes, n).parent;
    (parent >= 0 ? At(children_of, parent) : roots).push_back(n);
  }
  document->order = DepthFirst(roots, children_of);
}

bool IsAbove(const GltfDocument& document, int node, int other) {
  while (other >= 0 && other != node) other = At(document.nodes, other).parent;
  return other == node;
}

void GoOver(const std::map<int, int>& twins, const Skeleton& twin, GltfDocument* document) {
  for (const int s : twin.skins) {
    for (int& joint : At(document->skins, s).joints) {
      if (const auto to = twins.find(joint); to != twins.end()) joint = to->second;
    }
  }
  for (int n = 0; n < Count(document->nodes); ++n) {
    DocumentNode& node = At(document->nodes, n);
    const auto own = twins.find(n), above = twins.find(node.parent);
    if (own != twins.end() && node.mesh < 0) {
      node.in_scene = false;  // another stands for it
    } else if (own != twins.end() && !IsAbove(*document, n, own->second)) {
      node.parent = own->second;  // it shows something, and stands there
      node.translation = {}, node.rotation = {}, node.scale = {1, 1, 1}, node.has_matrix = false;
    } else if (above != twins.end() && !IsAbove(*document, n, above->second)) {
      node.parent = above->second;
    }
  }
}

}  // namespace

void JoinTwins(GltfDocument* document) {
  const std::vector<Skeleton> skeletons = SkeletonsOf(*document);
  if (skeletons.size() < 2) return;
  const auto main = std::max_element(skeletons.begin(), skeletons.end(), [](const Skeleton& a, const Skeleton& b) {
    return std::pair(a.channels, a.bind.size()) < std::pair(b.channels, b.bind.size());
  });
  bool any = false;
  for (auto twin = skeletons.begin(); twin != skeletons.end(); ++twin) {
    if (twin == main || main->bind.size() * twin->bind.size() > kMostPairs) continue;
    const std::map<int, int> twins = TwinsOf(*document, *main, *twin);
    if (2 * twins.size() < twin->bind.size()) continue;
    GoOver(twins, *twin, document);
    any = true;
  }
  if (any) Reorder(document);
}

}  // namespace flaneur
