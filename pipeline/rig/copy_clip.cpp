#include "pipeline/rig/copy_clip.h"

#include <algorithm>
#include <map>

#include "pipeline/core/rotation.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

constexpr float kSameTurn_rad = 0.09f;  // between the rests of two joints that are the same
constexpr float kSameLength = 0.03f;    // of the skeleton's mean bone, how much one may be off
constexpr float kMostJoints = 0.9f;     // of the target's, that the source must have

std::map<std::string, int> ByName(const std::vector<Joint>& joints) {
  std::map<std::string, int> by_name;
  for (int j = 0; j < Count(joints); ++j) by_name.try_emplace(BareName(At(joints, j).name), j);
  return by_name;
}

}  // namespace

std::string BareName(const std::string& name) {
  const size_t space = name.find_last_of("|:");
  return space == std::string::npos || space + 1 == name.size() ? name : name.substr(space + 1);
}

bool SameSkeleton(const std::vector<Joint>& source, const std::vector<Joint>& target, float* scale) {
  const std::map<std::string, int> by_name = ByName(source);
  std::vector<float> ratios, off_rad;
  std::vector<std::pair<Vec3, Vec3>> bones;
  for (const Joint& joint : target) {
    const auto found = by_name.find(BareName(joint.name));
    if (found == by_name.end()) continue;
    const Joint& other = At(source, found->second);
    const bool rooted = joint.parent < 0 || other.parent < 0;
    if (!rooted && BareName(At(target, joint.parent).name) != BareName(At(source, other.parent).name)) continue;
    if (!rooted) off_rad.push_back(AngleOf(Product(Conjugate(joint.rest.rotation), other.rest.rotation)));
    if (!rooted) bones.emplace_back(joint.rest.translation, other.rest.translation);
    if (rooted) off_rad.push_back(0);
  }
  if (static_cast<float>(off_rad.size()) < kMostJoints * static_cast<float>(target.size())) return false;
  float own = 0, theirs = 0;
  for (const auto& [a, b] : bones) own += Length(a), theirs += Length(b);
  if (!(own > 0) || !(theirs > 0)) return false;
  *scale = own / theirs;
  const float mean = own / static_cast<float>(bones.size());
  for (const auto& [a, b] : bones) {
    if (Length(a - b * *scale) > kSameLength * (Length(a) + mean)) return false;
  }
  return std::all_of(off_rad.begin(), off_rad.end(), [](float off) { return off < kSameTurn_rad; });
}

int CopyClip(const std::vector<Joint>& source, const Clip& clip, const std::vector<Joint>& target, Clip* copied) {
  const std::map<std::string, int> by_name = ByName(source);
  std::vector<int> from(target.size(), -1);
  float own = 0, theirs = 0;
  int found = 0;
  for (size_t j = 0; j < target.size(); ++j) {
    const auto known = by_name.find(BareName(target[j].name));
    if (known == by_name.end()) continue;
    from[j] = known->second;
    ++found;
    own += Length(target[j].rest.translation), theirs += Length(At(source, from[j]).rest.translation);
  }
  const float scale = own > 0 && theirs > 0 ? own / theirs : 1;
  *copied = {clip.name, clip.duration_s, clip.keys, {}};
  for (int k = 0; k < clip.keys; ++k) {
    for (size_t j = 0; j < target.size(); ++j) {
      Transform t = target[j].rest;
      if (from[j] >= 0) {
        const Transform& rest = At(source, from[j]).rest;
        const Transform& now = clip.transforms[static_cast<size_t>(k) * source.size() + static_cast<size_t>(from[j])];
        t.rotation = Normalized(Product(t.rotation, Product(Conjugate(rest.rotation), now.rotation)));
        const Quat turned = Product(target[j].rest.rotation, Conjugate(rest.rotation));
        t.translation = t.translation + Rotated(turned, now.translation - rest.translation) * scale;
        t.scale = now.scale;
      }
      copied->transforms.push_back(t);
    }
  }
  return found;
}

}  // namespace flaneur
