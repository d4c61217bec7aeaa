#include "pipeline/rig/clip_rig.h"

#include <gtest/gtest.h>

#include "pipeline/rig/retarget.h"
#include "tests/unit/pipeline/test_human.h"

namespace flaneur {
namespace {

// The walk's own skeleton, resting in other local transforms; the clip stays the same.
Avatar RestingIn(const Avatar& human, const std::vector<Transform>& locals) {
  Avatar resting;
  resting.joints = human.joints;
  std::vector<Mat4> world;
  for (size_t j = 0; j < locals.size(); ++j) {
    Joint& joint = resting.joints[j];
    joint.rest = locals[j];
    const Mat4 local = FromTranslationRotationScale(locals[j].translation, locals[j].rotation, {1, 1, 1});
    world.push_back(joint.parent < 0 ? local : world[static_cast<size_t>(joint.parent)] * local);
    joint.inverse_bind = Inverse(world.back());
  }
  return resting;
}

std::vector<Transform> KeyOf(const Clip& clip, int key, size_t joints) {
  const auto begin = clip.transforms.begin() + key * static_cast<int>(joints);
  return {begin, begin + static_cast<int>(joints)};
}

// How far any joint of a figure is from where it goes by the same clip of a skeleton that rests in a T-pose.
float WorstOff(const Avatar& resting, const Avatar& human, const Clip& walk) {
  const Avatar figure = MadeHuman({.leg_m = 0.75f, .arm_down_deg = 45});
  Rig plain, source, target;
  std::string why;
  EXPECT_TRUE(MakeRig(human, {}, &plain, &why)) << why;
  EXPECT_TRUE(MakeClipRig(resting, {}, walk, &source, &why)) << why;
  EXPECT_TRUE(MakeRig(figure, {}, &target, &why)) << why;
  const Clip wanted = Retarget(plain, walk, target).clip, made = Retarget(source, walk, target).clip;
  EXPECT_EQ(wanted.keys, made.keys);
  float worst = 0;
  for (int k = 0; k < std::min(wanted.keys, made.keys); ++k) {
    const Pose a = PoseAt(target, wanted, k), b = PoseAt(target, made, k);
    for (size_t j = 0; j < a.positions.size(); ++j) worst = std::max(worst, Length(a.positions[j] - b.positions[j]));
  }
  return worst;
}

TEST(ClipRig, ASkeletonThatRestsInMidStrideMovesAFigureAsOneThatRestsInATPose) {
  const Avatar human = MadeHuman({});
  Avatar bones = human;
  bones.meshes.clear();
  const Clip walk = MadeWalk(human);
  EXPECT_LT(WorstOff(bones, human, walk), 0.03f) << "soles of boots and of bones";
  for (int key = 0; key < walk.keys; ++key)
    EXPECT_LT(WorstOff(RestingIn(human, KeyOf(walk, key, human.joints.size())), human, walk), 0.05f) << key;
}

// As recordings have it whose bones all lie along one axis of their own.
TEST(ClipRig, ASkeletonWhoseBonesAllLieAlongOneAxisMovesAFigureAsOneThatRestsInATPose) {
  const Avatar human = MadeHuman({});
  const Clip walk = MadeWalk(human);
  std::vector<Transform> folded = KeyOf(walk, 0, human.joints.size());
  for (const size_t hip : {size_t{10}, size_t{14}}) folded[hip].rotation = TurnAbout({1, 0, 0}, kPi);  // legs up
  EXPECT_LT(WorstOff(RestingIn(human, folded), human, walk), 0.05f);
}

TEST(ClipRig, ASkeletonThatStandsRestsAsItDoes) {
  const Avatar human = MadeHuman({.arm_down_deg = 30});
  const Clip walk = MadeWalk(human);
  Rig plain, source;
  std::string why;
  ASSERT_TRUE(MakeRig(human, {}, &plain, &why)) << why;
  ASSERT_TRUE(MakeClipRig(human, {}, walk, &source, &why)) << why;
  for (size_t j = 0; j < human.joints.size(); ++j)
    EXPECT_LT(Length(plain.reference.positions[j] - source.reference.positions[j]), 1e-6f);
}

// Its one joint says nothing of where it points; what hangs on it does.
TEST(ClipRig, AnArmOfOneBonePointsWhereTheFiguresDoes) {
  HumanShape shape{.arm_down_deg = 30};
  for (const size_t j : {size_t{5}, size_t{6}, size_t{8}, size_t{9}}) shape.names[j] = "ornament";
  const Avatar human = MadeHuman(shape);
  Rig rig;
  std::string why;
  ASSERT_TRUE(MakeClipRig(human, {}, MadeWalk(human), &rig, &why)) << why;
  const Vec3 along = Rotated(rig.arms[kLeft].upper, {1, 0, 0});
  EXPECT_LT(AngleBetween(along, {std::cos(kPi / 6), -std::sin(kPi / 6), 0}), 0.05f);
}

}  // namespace
}  // namespace flaneur
