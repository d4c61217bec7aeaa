#include "pipeline/rig/clip_loop.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/array.h"

namespace flaneur {
namespace {

constexpr float kTravel = 0.05f;          // of the height: more than sway, so the root travels
constexpr float kBlendedShare = 0.25f;    // of a clip that does not loop
constexpr float kLongRecording_s = 3.2f;  // of a walk; shorter ones are a cycle or a few already
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

// Joints against their mean on the ground, and the mean's own place.
struct Moment {
  std::vector<Vec3> joints;
  Vec3 middle;
};

std::vector<Moment> MomentsOf(const std::vector<Joint>& joints, const Clip& clip) {
  std::vector<Moment> moments;
  for (int k = 0; k < clip.keys; ++k) {
    Moment& moment = moments.emplace_back();
    moment.joints = JointPositions(joints, clip, k);
    moment.middle = Mean(moment.joints);
    const Vec3 level{moment.middle.x, 0, moment.middle.z};
    for (Vec3& p : moment.joints) p = p - level;
  }
  return moments;
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

bool CutToCycle(const std::vector<Joint>& joints, Clip* clip) {
  if (clip->duration_s < kLongRecording_s || clip->keys < 4) return false;
  const std::vector<Moment> moments = MomentsOf(joints, *clip);
  const float step_s = clip->duration_s / static_cast<float>(clip->keys - 1);
  const auto keys = [&](float s) { return static_cast<size_t>(std::max(2.0f, std::round(s / step_s))); };
  std::vector<float> moved(moments.size(), 0.0f);  // since the beginning, a joint's mean
  for (size_t k = 1; k < moments.size(); ++k) {
    moved[k] = moved[k - 1] + MeanDistance(moments[k - 1].joints, moments[k].joints);
  }
  float best = kCycleGap;
  size_t first = 0, length = 0;
  for (size_t a = 1; a + 1 < moments.size(); ++a) {
    for (size_t n = keys(kMinCycle_s); n <= keys(kMaxCycle_s) && a + n + 1 < moments.size(); ++n) {
      const float way = moved[a + n] - moved[a];
      const float busiest = moved.back() / static_cast<float>(moments.size()) * static_cast<float>(n);
      if (!(way > 0.7f * busiest)) continue;
      // Also one key before and after, so that it comes back the same way round.
      const float gap = MeanDistance(moments[a].joints, moments[a + n].joints) +
                        MeanDistance(moments[a - 1].joints, moments[a + n - 1].joints) +
                        MeanDistance(moments[a + 1].joints, moments[a + n + 1].joints);
      if (gap / way < best) best = gap / way, first = a, length = n;
    }
  }
  if (length == 0) return false;
  const auto at = [&](size_t k) { return clip->transforms.begin() + static_cast<std::ptrdiff_t>(k * joints.size()); };
  clip->transforms = std::vector<Transform>(at(first), at(first + length + 1));
  clip->keys = static_cast<int>(length) + 1;
  clip->duration_s = step_s * static_cast<float>(length);
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
