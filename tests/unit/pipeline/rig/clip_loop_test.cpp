#include "pipeline/rig/clip_loop.h"

#include <gtest/gtest.h>

#include "tests/unit/pipeline/test_human.h"

namespace flaneur {
namespace {

constexpr int kStand = 60, kCycles = 2, kCycle = 30;  // keys

// As motion capture has it: a frame of the rest pose, somebody who stands, walks straight on and stands again.
Clip Recording(const Avatar& human, Vec3 ahead) {
  const Clip walk = MadeWalk(human, kCycle + 1);
  Clip clip{"take", 0, 0, {}};
  const auto add = [&](const Transform* key, Vec3 place) {
    for (size_t j = 0; j < human.joints.size(); ++j) {
      clip.transforms.push_back(key == nullptr ? human.joints[j].rest : key[j]);
      Vec3& at = clip.transforms.back().translation;
      if (human.joints[j].parent < 0) at = at + place;
    }
    ++clip.keys;
  };
  const auto key = [&](int k) { return walk.transforms.data() + static_cast<size_t>(k) * human.joints.size(); };
  add(nullptr, ahead * 3);
  for (int k = 0; k < kStand; ++k) add(key(0), {});
  for (int k = 0; k < kCycles * kCycle; ++k) add(key(k % kCycle), ahead * (0.04f * static_cast<float>(k)));
  for (int k = 0; k < kStand; ++k) add(key(0), ahead * (0.04f * kCycles * kCycle));
  clip.duration_s = static_cast<float>(clip.keys - 1) / 30;
  return clip;
}

TEST(Recordings, AreCutToACycleWithoutTheRestPoseAndWhoStands) {
  for (const Quat turn : {Quat{}, TurnAbout({1, 0, 0}, kPi / 2), TurnAbout({0, 1, 0}, 1)}) {
    const Avatar human = MadeHuman({.turn = turn});
    const Vec3 ahead = Rotated(turn, {0, 0, 1});
    Clip clip = Recording(human, ahead);
    const int whole = clip.keys;
    DropRestPose(human.joints, &clip);
    EXPECT_EQ(clip.keys, whole - 1);
    ASSERT_TRUE(CutToCycle(human.joints, &clip));
    const auto first = JointPositions(human.joints, clip, 0), last = JointPositions(human.joints, clip, clip.keys - 1);
    const float way_m = Dot(last[0] - first[0], ahead);
    EXPECT_NEAR(std::remainder(way_m, 0.04f * kCycle), 0, 0.01f) << "whole cycles";
    EXPECT_LT(0.04f * static_cast<float>(clip.keys - 1) - way_m, 0.04f * 5) << "walks all along";
  }
}

TEST(Recordings, StayWholeWhereNothingJumps) {
  const Avatar human = MadeHuman({});
  Clip walk = MadeWalk(human);
  DropRestPose(human.joints, &walk);
  EXPECT_EQ(walk.keys, 31);
}

}  // namespace
}  // namespace flaneur
