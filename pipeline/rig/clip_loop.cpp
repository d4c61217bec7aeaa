#include "pipeline/rig/clip_loop.h"

#include <algorithm>
#include <cmath>

#include "pipeline/core/rotation.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

constexpr float kTravel = 0.05f;          // of the height: more than sway, so the root travels
constexpr float kBlendedShare = 0.25f;    // of a clip that does not loop
constexpr float kLongRecording_s = 3.2f;  // of a walk; shorter ones are a cycle or a few already
constexpr float kJump = 0.04f;            // of the height, a key, a joint's mean: nobody moves so much faster than else
constexpr float kJumpOverUsual = 3.5f;    // and of the usual way between two keys
constexpr size_t kMostRestKeys = 3;       // a rest pose of one frame is in two keys where frames are longer than keys
constexpr float kAlike = 1e-3f;           // two cycles whose gaps differ by less; the livelier is taken
constexpr size_t kParts = 8;              // of a cycle, each of which
constexpr float kMovesOn = 0.3f;          // does so much of its share of the way
constexpr float kMinCycle_s = 0.6f, kMaxCycle_s = 2.5f;
constexpr float kCycleGap = 0.35f;  // of the mean way of a joint in the cycle: how far it may be from where it began

Vec3 Mean(const std::vector<Vec3>& points) {
  Vec3 sum;
  for (const Vec3 p : points) sum = sum + p;
  return sum * (1 / static_cast<float>(points.size()));
}

float MeanDistance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  float sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += Length(a[i] - b[i]);
  return sum / static_cast<float>(a.size());
}

Transform Mix(const Transform& a, const Transform& b, float t) {
  return {a.translation * (1 - t) + b.translation * t, Slerp(a.rotation, b.rotation, t),
          a.scale * (1 - t) + b.scale * t};
}

// Leaves the keys from the first to the last.
void Keep(size_t first, size_t last, size_t joints, Clip* clip) {
  const float step_s = clip->duration_s / static_cast<float>(clip->keys - 1);
  const auto at = [&](size_t k) { return clip->transforms.begin() + static_cast<std::ptrdiff_t>(k * joints); };
  clip->transforms = std::vector<Transform>(at(first), at(last + 1));
  clip->keys = static_cast<int>(last - first) + 1;
  clip->duration_s = step_s * static_cast<float>(last - first);
}

// Whether every part of the stretch of `n` keys does its share. `moved`: since the clip's beginning, a key.
bool MovesOn(const std::vector<float>& moved, size_t first, size_t n) {
  const float way = moved[first + n] - moved[first];
  for (size_t part = 0; part < kParts; ++part) {
    const size_t from = n * part / kParts, to = n * (part + 1) / kParts;
    const float share = way * static_cast<float>(to - from) / static_cast<float>(n);
    if (moved[first + to] - moved[first + from] < kMovesOn * share) return false;
  }
  return true;
}

// Of every key the joints against their mean, whichever way is up.
std::vector<std::vector<Vec3>> PosesOf(const std::vector<Joint>& joints, const Clip& clip) {
  std::vector<std::vector<Vec3>> poses;
  for (int k = 0; k < clip.keys; ++k) {
    std::vector<Vec3>& pose = poses.emplace_back(JointPositions(joints, clip, k));
    const Vec3 middle = Mean(pose);
    for (Vec3& p : pose) p = p - middle;
  }
  return poses;
}

float LongestSide(const std::vector<Vec3>& points) {
  Vec3 low = points[0], high = points[0];
  for (const Vec3 p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return std::max({high.x - low.x, high.y - low.y, high.z - low.z});
}

}  // namespace

float TimeOf(const Clip& clip, int key) {
  return clip.keys < 2 ? 0 : clip.duration_s * static_cast<float>(key) / static_cast<float>(clip.keys - 1);
}

// Unlike SkinningMatrices at a time, this does not wrap the last key to the first.
std::vector<Vec3> JointPositions(const std::vector<Joint>& joints, const Clip& clip, int key) {
  const size_t count = joints.size();
  std::vector<Mat4> world(count);
  std::vector<Vec3> positions(count);
  for (size_t j = 0; j < count; ++j) {
    const Transform& t = clip.transforms[static_cast<size_t>(key) * count + j];
    const Mat4 local = FromTranslationRotationScale(t.translation, t.rotation, t.scale);
    const int parent = joints[j].parent;
    world[j] = parent < 0 ? local : At(world, parent) * local;
    positions[j] = TransformPoint(world[j], {});
  }
  return positions;
}

// Moves the whole figure in one key.
void ShiftClip(const std::vector<Joint>& joints, Clip* clip, int key, Vec3 by) {
  const size_t count = joints.size();
  for (size_t j = 0; j < count; ++j) {
    if (joints[j].parent >= 0) continue;
    Vec3& t = clip->transforms[static_cast<size_t>(key) * count + j].translation;
    t = t + by;
  }
}

void ShiftClip(const std::vector<Joint>& joints, Clip* clip, Vec3 by) {
  for (int k = 0; k < clip->keys; ++k) ShiftClip(joints, clip, k, by);
}

void TurnClip(Quat turn, const std::vector<Joint>& joints, Clip* clip) {
  for (size_t i = 0; i < clip->transforms.size(); ++i) {
    if (joints[i % joints.size()].parent >= 0) continue;
    Transform& t = clip->transforms[i];
    t.translation = Rotated(turn, t.translation);
    t.rotation = Normalized(Product(turn, t.rotation));
  }
}

// Takes even horizontal travel out of the clip; returns its velocity.
Vec3 RemoveTravel(const std::vector<Joint>& joints, float height, Clip* clip) {
  Vec3 travel = Mean(JointPositions(joints, *clip, clip->keys - 1)) - Mean(JointPositions(joints, *clip, 0));
  travel.y = 0;
  if (Length(travel) < kTravel * height) return {};
  const Vec3 velocity = travel * (1 / clip->duration_s);
  for (int k = 0; k < clip->keys; ++k) {
    ShiftClip(joints, clip, k, velocity * -TimeOf(*clip, k));
  }
  return velocity;
}

// Makes the last key equal the first: exactly where it nearly does, by one more key where just that
// is missing, else by blending the clip's end into its first pose.
void MakeLoop(const std::vector<Joint>& joints, Clip* clip, std::vector<std::string>* warnings) {
  const size_t count = joints.size();
  const std::vector<Vec3> first = JointPositions(joints, *clip, 0);
  float step = 0;
  std::vector<Vec3> previous = first;
  for (int k = 1; k < clip->keys; ++k) {
    std::vector<Vec3> next = JointPositions(joints, *clip, k);
    step += MeanDistance(previous, next) / static_cast<float>(clip->keys - 1);
    previous = std::move(next);
  }
  const float gap = MeanDistance(previous, first);
  const auto key = [&](int k) { return clip->transforms.begin() + static_cast<std::ptrdiff_t>(count) * k; };
  if (gap > 0.5f * step && gap <= 2 * step) {
    clip->duration_s *= static_cast<float>(clip->keys) / static_cast<float>(clip->keys - 1);
    ++clip->keys;
    clip->transforms.resize(clip->transforms.size() + count);
  } else if (gap > 2 * step) {
    if (clip->name == "walk") {
      warnings->push_back("the walk clip does not loop; its end is blended into its start");
    }
    const int blended = std::max(1, static_cast<int>(kBlendedShare * static_cast<float>(clip->keys)));
    for (int k = clip->keys - blended; k < clip->keys; ++k) {
      const float t = static_cast<float>(k - (clip->keys - blended) + 1) / static_cast<float>(blended);
      for (size_t j = 0; j < count; ++j) {
        Transform& own = *(key(k) + static_cast<std::ptrdiff_t>(j));
        own = Mix(own, clip->transforms[j], t * t * (3 - 2 * t));
      }
    }
  }
  std::copy(key(0), key(1), key(clip->keys - 1));
}

void DropRestPose(const std::vector<Joint>& joints, Clip* clip) {
  if (clip->keys < 8) return;
  std::vector<std::vector<Vec3>> keys;
  for (int k = 0; k < clip->keys; ++k) keys.push_back(JointPositions(joints, *clip, k));
  std::vector<float> ways;
  for (size_t k = 1; k < keys.size(); ++k) ways.push_back(MeanDistance(keys[k - 1], keys[k]));
  std::vector<float> sorted = ways;
  std::nth_element(sorted.begin(), sorted.begin() + Count(sorted) / 2, sorted.end());
  const float jump = std::max(kJump * LongestSide(keys[0]), kJumpOverUsual * sorted[sorted.size() / 2]);
  size_t first = 0, last = keys.size() - 1;
  for (size_t k = 0; k < kMostRestKeys; ++k) {
    if (ways[k] > jump) first = k + 1;
    if (ways[ways.size() - 1 - k] > jump) last = keys.size() - 2 - k;
  }
  Keep(first, last, joints.size(), clip);
}

bool CutToCycle(const std::vector<Joint>& joints, Clip* clip) {
  if (clip->duration_s < kLongRecording_s || clip->keys < 4) return false;
  const std::vector<std::vector<Vec3>> poses = PosesOf(joints, *clip);
  const float step_s = clip->duration_s / static_cast<float>(clip->keys - 1);
  const auto keys = [&](float s) { return static_cast<size_t>(std::max(2.0f, std::round(s / step_s))); };
  std::vector<float> moved(poses.size(), 0.0f);  // since the beginning, a joint's mean
  for (size_t k = 1; k < poses.size(); ++k) {
    moved[k] = moved[k - 1] + MeanDistance(poses[k - 1], poses[k]);
  }
  float best = kCycleGap, best_pace = 0;
  size_t first = 0, length = 0;
  for (size_t a = 1; a + 1 < poses.size(); ++a) {
    for (size_t n = keys(kMinCycle_s); n <= keys(kMaxCycle_s) && a + n + 1 < poses.size(); ++n) {
      const float way = moved[a + n] - moved[a];
      const float busiest = moved.back() / static_cast<float>(poses.size()) * static_cast<float>(n);
      if (!(way > 0.7f * busiest) || !MovesOn(moved, a, n)) continue;
      // Also one key before and after, so that it comes back the same way round.
      const float gap = MeanDistance(poses[a], poses[a + n]) + MeanDistance(poses[a - 1], poses[a + n - 1]) +
                        MeanDistance(poses[a + 1], poses[a + n + 1]);
      const float pace = way / static_cast<float>(n);
      const bool alike = std::abs(gap / way - best) < kAlike;
      if (alike ? pace <= best_pace : gap / way > best) continue;
      best = gap / way, best_pace = pace, first = a, length = n;
    }
  }
  if (length == 0) return false;
  Keep(first, first + length, joints.size(), clip);
  return true;
}

void CutTo(float duration_s, size_t joints, Clip* clip) {
  if (clip->duration_s <= duration_s || clip->keys < 2) return;
  const float step_s = clip->duration_s / static_cast<float>(clip->keys - 1);
  clip->keys = 1 + static_cast<int>(duration_s / step_s);
  clip->duration_s = step_s * static_cast<float>(clip->keys - 1);
  clip->transforms.resize(static_cast<size_t>(clip->keys) * joints);
}

}  // namespace flaneur
