#include "pipeline/rig/retarget.h"

#include <gtest/gtest.h>

#include "pipeline/rig/motion_quality.h"
#include "tests/unit/pipeline/test_human.h"

namespace flaneur {
namespace {

Rig RigOf(const Avatar& person) {
  Rig rig;
  std::string why;
  EXPECT_TRUE(MakeRig(person, {}, &rig, &why)) << why;
  return rig;
}

// Where a limb points in a key, in the reference pose's space.
Vec3 Direction(const Rig& rig, const Clip& clip, int key, int from, int to) {
  Pose pose = PoseOf(rig.joints, clip.transforms.data() + static_cast<size_t>(key) * rig.joints.size());
  TurnPose(rig.turn, &pose);
  return Normalized(pose.positions[static_cast<size_t>(to)] - pose.positions[static_cast<size_t>(from)]);
}

class Retargeting : public testing::TestWithParam<HumanShape> {};

TEST_P(Retargeting, LimbsPointAsTheSourcesDo) {
  const Avatar source = MadeHuman({});
  const Clip walk = MadeWalk(source);
  const Rig from = RigOf(source);
  const Avatar target = MadeHuman(GetParam());
  const Rig to = RigOf(target);
  const Retargeted made = Retarget(from, walk, to);
  ASSERT_EQ(made.clip.keys, walk.keys);
  ASSERT_EQ(made.clip.transforms.size(), target.joints.size() * static_cast<size_t>(walk.keys));
  for (int k = 0; k < walk.keys; k += 5) {
    for (const auto& [a, b] : {std::pair{4, 5}, {5, 6}, {7, 8}, {8, 9}, {1, 2}}) {
      EXPECT_LT(AngleBetween(Direction(from, walk, k, a, b), Direction(to, made.clip, k, a, b)), 0.02f)
          << k << " " << a;
    }
  }
  EXPECT_LT(WrongBend(to, made.clip), 0.02f);
  EXPECT_NEAR(to.leg_m * (HipsHeight(to, made.clip) - HipsHeight(from, walk)) / GetParam().unit, 0, 0.03f);
  EXPECT_GT(made.walk_speed_mps, 0.5f * GetParam().leg_m * GetParam().unit);
}

INSTANTIATE_TEST_SUITE_P(Shapes, Retargeting,
                         testing::Values(HumanShape{}, HumanShape{.leg_m = 0.55f}, HumanShape{.unit = 100},
                                         HumanShape{.arm_down_deg = 45}, HumanShape{.arm_down_deg = 80},
                                         HumanShape{.turn = TurnAbout({1, 0, 0}, kPi / 2)},
                                         HumanShape{.turn = TurnAbout({0, 1, 0}, kPi)},
                                         HumanShape{.feet_on_root = true}));

TEST(Retarget, FeetStandOnTheGround) {
  const Avatar source = MadeHuman({});
  Avatar target = MadeHuman({.leg_m = 0.6f});
  const Rig from = RigOf(source), to = RigOf(target);
  const Retargeted made = Retarget(from, MadeWalk(source), to);
  for (int k = 0; k < made.clip.keys; ++k) {
    float lowest = 1e30f;
    for (const Vec3 p : SkinnedPositions(
             target.meshes[0],
             SkinningMatrices(target, made.clip,
                              made.clip.duration_s * static_cast<float>(k) / static_cast<float>(made.clip.keys))))
      lowest = std::min(lowest, p.y);
    EXPECT_NEAR(lowest, 0, 0.03f) << k;
    EXPECT_GT(lowest, -0.005f) << k;
  }
}

TEST(Retarget, HandsAreLedOutOfABroadBody) {
  Avatar human = MadeHuman({.arm_down_deg = 45});
  AddBox({-0.2f, 0.9f, -0.1f}, {0.2f, 1.4f, 0.1f}, 0.12f, 1, &human.meshes[0]);
  const Rig rig = RigOf(human);
  Clip down;
  down.name = "idle";
  down.duration_s = 1;
  down.keys = 2;
  for (int k = 0; k < 2; ++k) {
    for (size_t j = 0; j < human.joints.size(); ++j) {
      Transform t = human.joints[j].rest;
      if (j == 4 || j == 7) t.rotation = TurnAbout({0, 0, 1}, (j == 4 ? -1.0f : 1.0f) * 40 * kPi / 180);
      down.transforms.push_back(t);
    }
  }
  const float before = std::max(HandDepth(human, rig, down, kLeft, 2), HandDepth(human, rig, down, kRight, 2));
  ASSERT_GT(before, 0.01f);
  EXPECT_GT(ClearHands(human, rig, &down), 0);
  EXPECT_LT(std::max(HandDepth(human, rig, down, kLeft, 2), HandDepth(human, rig, down, kRight, 2)), 0.01f);
}

TEST(Humanoid, IsFoundByShapeWhereNamesSayNothing) {
  HumanShape shape;
  for (size_t j = 0; j < shape.names.size(); ++j) shape.names[j] = "node " + std::to_string(j);
  const Rig rig = RigOf(MadeHuman(shape));
  EXPECT_TRUE(rig.humanoid.by_shape);
  EXPECT_EQ(rig.humanoid.legs[kLeft].upper, 10);
  EXPECT_EQ(rig.humanoid.legs[kRight].foot, 16);
  EXPECT_EQ(rig.humanoid.arms[kLeft].upper, 4);
  EXPECT_EQ(rig.humanoid.hips, 0);
  EXPECT_EQ(rig.humanoid.head, 3);
}

TEST(Humanoid, WhatHasNoLegsIsNone) {
  Avatar human = MadeHuman({});
  for (size_t j = 10; j < human.joints.size(); ++j) human.joints[j].name = "cloth";
  human.joints.resize(10);
  Humanoid humanoid;
  std::string why;
  EXPECT_FALSE(FindHumanoid(human.joints, BindPose(human.joints).positions, {}, &humanoid, &why));
  EXPECT_EQ(why, "no two legs are found");
}

}  // namespace
}  // namespace flaneur
