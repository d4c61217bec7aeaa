#include "pipeline/avatar/merge_joints.h"

#include <gtest/gtest.h>

#include "tests/unit/pipeline/test_person.h"

namespace flaneur {
namespace {

// The made person with a toe on the left leg that turns by `angle_rad` within the walk.
Avatar WithToe(float angle_rad) {
  Avatar avatar = MadePerson();
  Joint toe{"toe", 1, {}, Moved({-0.1f, 0, 0})};
  toe.rest.translation = {0, -0.9f, 0};
  avatar.joints.push_back(toe);
  AddTube(0.1f, 0, 0.1f, 0.08f, 3, 3, &avatar.meshes[0]);
  Clip& walk = avatar.clips[0];
  std::vector<Transform> transforms;
  for (int k = 0; k < walk.keys; ++k) {
    for (size_t j = 0; j < 3; ++j) {
      transforms.push_back(walk.transforms[static_cast<size_t>(k) * 3 + j]);
    }
    Transform t = toe.rest;
    const float half = 0.5f * angle_rad * std::sin(2 * kPi * static_cast<float>(k) / static_cast<float>(walk.keys));
    t.rotation = {std::sin(half), 0, 0, std::cos(half)};
    transforms.push_back(t);
  }
  walk.transforms = transforms;
  return avatar;
}

TEST(MergeJoints, KeepsToItsBound) {
  for (const float angle_rad : {0.02f, 0.2f}) {
    Avatar avatar = WithToe(angle_rad);
    const std::vector<Mesh> before = avatar.meshes;
    const float moved_m = MergeJoints(avatar, 0.005f, &avatar.meshes);
    EXPECT_LE(moved_m, 0.005f);
    float greatest_m = 0;
    for (const float share : {0.1f, 0.25f, 0.6f}) {
      const auto pose = SkinningMatrices(avatar, avatar.clips[0], share);
      const auto was = SkinnedPositions(before[0], pose);
      const auto is = SkinnedPositions(avatar.meshes[0], pose);
      for (size_t v = 0; v < was.size(); ++v) {
        greatest_m = std::max(greatest_m, Length(was[v] - is[v]));
      }
    }
    EXPECT_LE(greatest_m, 0.005f);
    // A toe that hardly bends follows the leg; one that does, and the legs, stay.
    EXPECT_EQ(CountJoints(avatar.meshes), angle_rad < 0.1f ? 3 : 4);
  }
}

TEST(MergeJoints, KeepsWeightsWhole) {
  Avatar avatar = WithToe(0.02f);
  Mesh& mesh = avatar.meshes[0];
  const size_t v = mesh.positions.size() - 1;  // of the toe
  mesh.joints[v] = {0, 1, 3, 2};
  mesh.weights[v] = {0.1f, 0.3f, 0.4f, 0.2f};
  MergeJoints(avatar, 0.005f, &avatar.meshes);
  std::array<float, 3> by_joint{};
  for (size_t i = 0; i < 4; ++i) {
    ASSERT_LT(mesh.joints[v][i], 3);
    by_joint[mesh.joints[v][i]] += mesh.weights[v][i];
  }
  EXPECT_NEAR(by_joint[0], 0.1f, 1e-6f);
  EXPECT_NEAR(by_joint[1], 0.7f, 1e-6f);
  EXPECT_NEAR(by_joint[2], 0.2f, 1e-6f);
}

TEST(DropIdleJoints, LeavesEveryPoseAsItWas) {
  Avatar avatar = WithToe(0);
  MergeJoints(avatar, 1e-4f, &avatar.meshes);
  const auto pose = SkinningMatrices(avatar, avatar.clips[0], 0.3f);
  const auto before = SkinnedPositions(avatar.meshes[0], pose);
  DropIdleJoints(&avatar);
  EXPECT_EQ(avatar.joints.size(), 3u);
  const auto after = SkinnedPositions(avatar.meshes[0], SkinningMatrices(avatar, avatar.clips[0], 0.3f));
  for (size_t v = 0; v < before.size(); ++v) EXPECT_LT(Length(before[v] - after[v]), 1e-6f);
}

}  // namespace
}  // namespace flaneur
