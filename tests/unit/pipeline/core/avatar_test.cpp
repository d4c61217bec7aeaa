#include "pipeline/core/avatar.h"

#include <gtest/gtest.h>

#include "pipeline/core/scene.h"
#include "tests/unit/pipeline/test_person.h"

namespace flaneur {
namespace {

TEST(SkinningMatrices, LeaveTheBindPoseWhereTheClipIsAtRest) {
  const Avatar avatar = MadePerson();
  const Mesh posed = Skinned(avatar.meshes[0], SkinningMatrices(avatar, avatar.clips[0], 0));
  for (size_t v = 0; v < posed.positions.size(); ++v) {
    EXPECT_LT(Length(posed.positions[v] - avatar.meshes[0].positions[v]), 1e-5f);
  }
}

TEST(SkinningMatrices, WrapTheTimeIntoTheClip) {
  const Avatar avatar = MadePerson();
  const Clip& walk = avatar.clips[0];
  for (const float t : {0.13f, 0.5f, 0.99f}) {
    const auto a = SkinningMatrices(avatar, walk, t), b = SkinningMatrices(avatar, walk, t + 3),
               c = SkinningMatrices(avatar, walk, t - 2);
    for (size_t j = 0; j < a.size(); ++j) {
      for (size_t i = 0; i < 16; ++i) {
        EXPECT_NEAR(a[j].m[i / 4][i % 4], b[j].m[i / 4][i % 4], 1e-4f);
        EXPECT_NEAR(a[j].m[i / 4][i % 4], c[j].m[i / 4][i % 4], 1e-4f);
      }
    }
  }
}

TEST(Skinned, KeepsNormalsUnitAndAtRightAnglesToTheSurface) {
  Avatar avatar = MadePerson();
  // A joint that stretches: normals must not lean with it.
  for (Transform& t : avatar.clips[0].transforms) t.scale = {1, 3, 1};
  const Mesh posed = Skinned(avatar.meshes[0], SkinningMatrices(avatar, avatar.clips[0], 0.2f));
  for (size_t i = 0; i < posed.indices.size(); i += 6) {  // first edges run along the tube
    const Vec3 a = posed.positions[posed.indices[i]], b = posed.positions[posed.indices[i + 1]];
    const Vec3 n = posed.normals[posed.indices[i]];
    EXPECT_NEAR(Length(n), 1, 1e-4f);
    EXPECT_NEAR(Dot(Normalized(b - a), n), 0, 1e-4f);
  }
}

TEST(Skinned, ReturnsAMeshWithoutJointsUnchanged) {
  Mesh mesh;
  mesh.positions = {{1, 2, 3}};
  EXPECT_EQ(Skinned(mesh, {}).positions[0].y, 2);
}

TEST(FindClip, FindsByExactNameOrNothing) {
  const Avatar avatar = MadePerson();
  EXPECT_EQ(FindClip(avatar, "walk"), &avatar.clips[0]);
  EXPECT_EQ(FindClip(avatar, "talk"), nullptr);
}

TEST(SceneNames, AreThoseOfTheConvention) {
  EXPECT_STREQ(NodeKindName(NodeKind::kBuilding), "building");
  EXPECT_STREQ(GroundKindName(GroundKind::kCarriageway), "carriageway");
}

}  // namespace
}  // namespace flaneur
