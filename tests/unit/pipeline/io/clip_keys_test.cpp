#include "pipeline/io/clip_keys.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/pipeline/test_person.h"

namespace flaneur {
namespace {

constexpr float kError_m = 0.001f;

// A clip of so many keys in which every joint of the made person swings and trembles its own way.
Clip Restless(const Avatar& avatar, int keys) {
  Clip clip;
  clip.name = "walk";
  clip.duration_s = static_cast<float>(keys - 1) / 30;
  clip.keys = keys;
  for (int k = 0; k < keys; ++k) {
    const float turn = 2 * kPi * static_cast<float>(k) / static_cast<float>(keys - 1);
    for (size_t j = 0; j < avatar.joints.size(); ++j) {
      Transform t = avatar.joints[j].rest;
      const float own = static_cast<float>(j + 1);
      const float half = 0.2f * std::sin(own * turn) + 0.0005f * std::sin(7 * turn + own);
      t.rotation = {std::sin(half), 0, 0, std::cos(half)};
      t.translation.y += 0.02f * std::cos(2 * turn);
      clip.transforms.push_back(t);
    }
  }
  return clip;
}

// The channel's value at a key of the clip, as players interpolate it.
Vec4 ValueAt(const KeyChannel& channel, float time_s) {
  const auto after = std::lower_bound(channel.times.begin() + 1, channel.times.end() - 1, time_s);
  const auto k = static_cast<size_t>(after - channel.times.begin());
  const float from = channel.times[k - 1], to = channel.times[k];
  const float t = std::clamp((time_s - from) / (to - from), 0.0f, 1.0f);
  const Vec4 a = channel.values[k - 1], b = channel.values[k];
  if (channel.path == "rotation") {
    const Quat q = Slerp({a.x, a.y, a.z, a.w}, {b.x, b.y, b.z, b.w}, t);
    return {q.x, q.y, q.z, q.w};
  }
  return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z), 0};
}

float Turned(Quat a, Vec4 b) {
  const float cosine = std::abs(a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w);
  return 2 * std::acos(std::min(cosine, 1.0f));
}

TEST(ReduceKeys, KeepsEveryChannelWithinTheError) {
  const Avatar avatar = MadePerson();
  const std::vector<float> reaches = JointReaches(avatar.joints, avatar.meshes);
  for (const int keys : {1, 2, 3, 31, 150}) {
    SCOPED_TRACE(keys);
    const Clip clip = Restless(avatar, keys);
    size_t kept = 0;
    const auto channels = ReduceKeys(clip, avatar.joints, reaches, kError_m);
    for (const KeyChannel& channel : channels) {
      ASSERT_EQ(channel.times.size(), channel.values.size());
      ASSERT_GE(channel.times.size(), 1u);
      EXPECT_TRUE(std::is_sorted(channel.times.begin(), channel.times.end()));
      kept += channel.times.size();
      for (int k = 0; k < keys; ++k) {
        const float time_s = clip.duration_s * static_cast<float>(k) / static_cast<float>(std::max(keys - 1, 1));
        const Vec4 value = channel.values.size() == 1 ? channel.values[0] : ValueAt(channel, time_s);
        const Transform& wanted = clip.transforms[static_cast<size_t>(k) * avatar.joints.size() + channel.joint];
        const float off_m = channel.path == "rotation" ? Turned(wanted.rotation, value) * reaches[channel.joint]
                                                       : Length(wanted.translation - Vec3{value.x, value.y, value.z});
        ASSERT_LE(off_m, 1.05f * kError_m + 5e-4f * reaches[channel.joint]);  // acos near 1
      }
    }
    if (keys > 100) {
      EXPECT_LT(kept, channels.size() * static_cast<size_t>(keys) / 2);
    }
  }
}

// Looping clips must not jerk where they begin again.
TEST(ReduceKeys, LetsTheEndsMeet) {
  const Avatar avatar = MadePerson();
  const Clip clip = Restless(avatar, 31);
  for (const KeyChannel& channel :
       ReduceKeys(clip, avatar.joints, JointReaches(avatar.joints, avatar.meshes), kError_m)) {
    EXPECT_NEAR(channel.values.front().x, channel.values.back().x, 1e-6f);
    EXPECT_NEAR(channel.values.front().y, channel.values.back().y, 1e-6f);
  }
}

// Whoever stands in another pose than at rest does so for as long as before.
TEST(ReduceKeys, StillClipsKeepTheirLength) {
  const Avatar avatar = MadePerson();
  Clip clip = Restless(avatar, 31);
  const auto joints = static_cast<std::ptrdiff_t>(avatar.joints.size());
  for (std::ptrdiff_t k = 1; k < 31; ++k) {
    std::copy_n(clip.transforms.begin(), joints, clip.transforms.begin() + k * joints);
  }
  const auto channels = ReduceKeys(clip, avatar.joints, JointReaches(avatar.joints, avatar.meshes), kError_m);
  ASSERT_FALSE(channels.empty());
  EXPECT_FLOAT_EQ(channels[0].times.back(), 1);
  for (size_t i = 1; i < channels.size(); ++i) EXPECT_EQ(channels[i].times.size(), 1u);
}

float WorstMoved(const Avatar& avatar, const Clip& clip, const std::vector<KeyChannel>& channels) {
  Clip read = clip;
  for (int k = 0; k < clip.keys; ++k) {
    const float time_s = clip.duration_s * static_cast<float>(k) / static_cast<float>(clip.keys - 1);
    for (const KeyChannel& channel : channels) {
      const Vec4 v = channel.values.size() == 1 ? channel.values[0] : ValueAt(channel, time_s);
      Transform& t = read.transforms[static_cast<size_t>(k) * avatar.joints.size() + channel.joint];
      if (channel.path == "rotation") t.rotation = {v.x, v.y, v.z, v.w};
      if (channel.path == "translation") t.translation = {v.x, v.y, v.z};
    }
  }
  float worst = 0;
  for (int i = 0; i < 100; ++i) {
    const float time_s = clip.duration_s * static_cast<float>(i) / 100;
    for (const Mesh& mesh : avatar.meshes) {
      const auto wanted = SkinnedPositions(mesh, SkinningMatrices(avatar, clip, time_s));
      const auto is = SkinnedPositions(mesh, SkinningMatrices(avatar, read, time_s));
      for (size_t v = 0; v < is.size(); ++v) worst = std::max(worst, Length(is[v] - wanted[v]));
    }
  }
  return worst;
}

TEST(ReduceKeysTogether, MovesNoVertexFartherThanTheError) {
  const Avatar avatar = MadePerson();
  const Clip clip = Restless(avatar, 61);
  size_t last = SIZE_MAX;
  for (const float error_m : {0.0002f, 0.001f, 0.005f}) {
    const auto channels = ReduceKeysTogether(clip, avatar.joints, avatar.meshes, error_m);
    EXPECT_LE(WorstMoved(avatar, clip, channels), 1.1f * error_m) << error_m;
    size_t keys = 0;
    for (const KeyChannel& channel : channels) keys += channel.values.size();
    EXPECT_LE(keys, last) << error_m;
    last = keys;
  }
}

}  // namespace
}  // namespace flaneur
