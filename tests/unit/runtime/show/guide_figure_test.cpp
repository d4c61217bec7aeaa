#include "runtime/show/guide_figure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "runtime/show/guide_arm.h"
#include "tests/unit/runtime/show/posed_person.h"
#include "tests/unit/runtime/simulation/tour_town.h"

namespace flaneur {
namespace {

size_t Triangles(const PackMesh& mesh) {
  size_t triangles = 0;
  for (const PackPrimitive& p : mesh.primitives) triangles += p.indices.size() / 3;
  return triangles;
}

// Two levels of a slab of a person, each one triangle; joint 3 carries the back.
TourPack WithMeshes() {
  TourPack pack = TourTown(10);
  PackPrimitive body;
  body.positions = {{0, 1.3f, -0.2f}, {0.3f, 0, 0}, {-0.3f, 0, 0.1f}};
  body.normals.assign(3, {0, 0, 1});
  body.joints = {{3, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}};
  body.weights.assign(3, {255, 0, 0, 0});
  body.indices = {0, 1, 2};
  pack.meshes = {{{body}}, {{body}}};
  for (PackAvatar& avatar : pack.avatars) {
    avatar.levels[1].mesh = 1;
    avatar.levels[0].triangles = avatar.levels[1].triangles = 1;
    avatar.joints = 4;
  }
  return pack;
}

TEST(GuideFigure, CountsItsTrianglesInEveryLevel) {
  TourPack pack = WithMeshes();
  AddGuideFigure(&pack);
  ASSERT_EQ(pack.avatars.size(), 3u);
  const PackAvatar& figure = pack.avatars.back();
  EXPECT_EQ(figure.name, "monk");
  EXPECT_EQ(figure.share, 0);
  EXPECT_EQ(figure.impostor_of, 1);
  for (const PackLevel& level : figure.levels) {
    EXPECT_EQ(Triangles(pack.meshes[static_cast<size_t>(level.mesh)]), static_cast<size_t>(level.triangles));
    EXPECT_GT(level.triangles, 10);
  }
  EXPECT_EQ(Triangles(pack.meshes[0]), 1u) << "the townspeople stay as they are";
}

TEST(GuideFigure, IsSeenOverEverybodysHeadAndMovesWithTheBackOfOneWithoutArms) {
  TourPack pack = WithMeshes();
  AddGuideFigure(&pack);
  const PackAvatar& figure = pack.avatars.back();
  const PackPrimitive& banner = pack.meshes[static_cast<size_t>(figure.levels[0].mesh)].primitives.back();
  float highest_m = 0;
  for (size_t i = 0; i < banner.positions.size(); ++i) {
    highest_m = std::max(highest_m, banner.positions[i].y);
    EXPECT_LT(banner.positions[i].z, -0.2f) << "behind the back";
    EXPECT_EQ(banner.joints[i][0], 3);
  }
  EXPECT_GT(highest_m, 1.3f * figure.height_m);
}

// A trunk and a right arm of two bones and a hand with a finger, stretched out or hanging; joint 0 is the hip.
std::vector<PackJoint> Skeleton(bool hangs, bool named) {
  const Vec3 shoulder{-0.2f, 1.4f, 0}, along = hangs ? Vec3{-0.05f, -1, 0.05f} : Vec3{-1, 0, 0};
  std::vector<PackJoint> s{{"hip", -1, {0, 0.95f, 0}}, {"chest", 0, {0, 1.3f, 0}}};
  const float at_m[] = {0, 0.26f, 0.52f, 0.59f};
  const char* names[] = {"Arm.R", "ForeArm.R", "Hand.R", "Finger.R"};
  for (int k = 0; k < 4; ++k) s.push_back({named ? names[k] : "", 1 + k, shoulder + Normalized(along) * at_m[k]});
  s.push_back({named ? "Foot.R" : "", 0, {-0.1f, 0.08f, 0.1f}});
  return s;
}

TEST(GuideFigure, CarriesTheBannerInTheHandOfAnySkeleton) {
  for (const bool hangs : {false, true}) {
    for (const bool named : {false, true}) {
      SCOPED_TRACE(std::string(hangs ? "hangs" : "stretched out") + (named ? ", named" : ""));
      TourPack pack = WithMeshes();
      for (PackAvatar& avatar : pack.avatars) {
        avatar.skeleton = Skeleton(hangs, named);
        avatar.joints = static_cast<int>(avatar.skeleton.size());
        for (PackClip* clip : {&avatar.walk, &avatar.idle, &avatar.talk}) {
          clip->frames = 2;
          clip->matrices.assign(2 * avatar.skeleton.size(), Mat4{});
          // In the second frame the arm swings far off.
          for (size_t j = 2; j < 6; ++j)
            clip->matrices[avatar.skeleton.size() + j] = FromTranslationRotationScale({0, 0, 5}, {}, {1, 1, 1});
        }
      }
      AddGuideFigure(&pack);
      const PackAvatar& figure = pack.avatars.back();
      const PackPrimitive& banner = pack.meshes[static_cast<size_t>(figure.levels[0].mesh)].primitives.back();
      for (size_t frame = 0; frame < 2; ++frame) {
        float lowest_m = 9, highest_m = 0;
        for (size_t i = 0; i < banner.positions.size(); ++i) {
          ASSERT_EQ(banner.joints[i][0], 4) << "the hand";
          const Mat4& joint = figure.walk.matrices[frame * figure.skeleton.size() + banner.joints[i][0]];
          const Vec3 p = TransformPoint(joint, banner.positions[i]);
          lowest_m = std::min(lowest_m, p.y), highest_m = std::max(highest_m, p.y);
          EXPECT_LT(p.x, -0.12f) << "beside the head";
          EXPECT_GT(p.z, 0.05f) << "before the body";
          EXPECT_LT(p.z, 0.6f);
        }
        EXPECT_GT(lowest_m, 0.1f);
        EXPECT_GT(highest_m, 1.3f * figure.height_m);
      }
      EXPECT_EQ(pack.avatars[1].walk.matrices.back().m[3][2], 0.0f) << "the townspeople keep their arms";
      EXPECT_EQ(pack.avatars[1].walk.matrices[figure.skeleton.size() + 4].m[3][2], 5.0f);
    }
  }
}

// The brim of a hat, all round, on a head.
PackPrimitive Brim(float radius_m, float height_m, uint16_t head) {
  PackPrimitive brim;
  for (int k = 0; k < 24; ++k) {
    const float angle = 2 * kPi * static_cast<float>(k) / 24;
    brim.positions.push_back({radius_m * std::sin(angle), height_m, radius_m * std::cos(angle)});
    brim.normals.push_back({0, 1, 0});
    brim.joints.push_back({head, 0, 0, 0});
    brim.weights.push_back({255, 0, 0, 0});
    brim.indices.push_back(static_cast<uint32_t>(k));
  }
  return brim;
}

TEST(GuideFigure, HoldsTheBannerClearOfAHatsBrim) {
  for (const float brim_m : {0.15f, 0.5f, 0.6f}) {
    SCOPED_TRACE(brim_m);
    TourPack pack = WithMeshes();
    std::vector<PackJoint> skeleton = Skeleton(true, true);
    skeleton.push_back({"Head", 1, {0, 1.5f, 0}});
    for (PackMesh& mesh : pack.meshes)
      mesh.primitives.push_back(Brim(brim_m, 1.6f, static_cast<uint16_t>(skeleton.size() - 1)));
    for (PackAvatar& avatar : pack.avatars) {
      avatar.skeleton = skeleton;
      avatar.joints = static_cast<int>(skeleton.size());
    }
    AddGuideFigure(&pack);
    const PackAvatar& figure = pack.avatars.back();
    const auto arm = FindCarryingArm(figure.skeleton, figure.height_m);
    ASSERT_TRUE(arm);
    const PackPrimitive& banner = pack.meshes[static_cast<size_t>(figure.levels[0].mesh)].primitives.back();
    Vec3 foot, top;  // of the pole, which is the first box
    for (size_t i = 0; i < 24; ++i) {
      const Vec3 p = TransformPoint(arm->hand_bent, banner.positions[i]);
      (p.y < arm->grip_m.y ? foot : top) = (p.y < arm->grip_m.y ? foot : top) + p * (1 / 12.0f);
    }
    const Vec3 at_brim = foot + (top - foot) * ((1.6f - foot.y) / (top.y - foot.y));
    EXPECT_GT(std::hypot(at_brim.x, at_brim.z), brim_m);
    EXPECT_GT(top.y, 1.6f + 0.1f);
    const Vec3 on_way = foot + (top - foot) * ((arm->grip_m.y - foot.y) / (top.y - foot.y));
    EXPECT_LT(Length(on_way - arm->grip_m), 0.02f) << "in the hand";
    if (brim_m > 0.2f) continue;
    EXPECT_LT(std::hypot(top.x - foot.x, top.z - foot.z), 0.01f) << "upright";
  }
}

TEST(GuideFigure, CarriesTheBannerAtTheBackWhereThereIsNoArm) {
  for (const size_t joints : {size_t{0}, size_t{1}, size_t{3}, size_t{4}}) {
    TourPack pack = WithMeshes();
    std::vector<PackJoint> odd = Skeleton(true, true);
    odd.resize(joints);
    for (PackAvatar& avatar : pack.avatars) avatar.skeleton = odd;
    AddGuideFigure(&pack);
    const PackAvatar& figure = pack.avatars.back();
    for (const Vec3& p : pack.meshes[static_cast<size_t>(figure.levels[0].mesh)].primitives.back().positions)
      EXPECT_LT(p.z, -0.2f);
  }
}

TEST(GuideOfTheDemo, CarriesTheBannerInTheHand) {
  const std::filesystem::path path =
      std::filesystem::path(FLANEUR_SOURCE_DIR) / "build_assets/wolfenbuettel/wolfenbuettel.glb";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path << ": bake the demo tour with ./demo";
  TourPack pack;
  ASSERT_EQ(LoadTourPack(path, {.geometry_and_images = false}, &pack).message, "");
  for (const PackAvatar& avatar : pack.avatars) {
    const auto arm = FindCarryingArm(avatar.skeleton, avatar.height_m);
    if (avatar.name.ends_with("dog") || avatar.name == "horse" || IsBird(pack, avatar.name)) {
      EXPECT_FALSE(arm) << avatar.name;
      continue;
    }
    ASSERT_TRUE(arm) << avatar.name;
    EXPECT_LT(arm->grip_m.x, -0.1f * avatar.height_m) << avatar.name;
    EXPECT_GT(arm->grip_m.z, 0.05f * avatar.height_m) << avatar.name;
    int fingers = 0;
    for (const auto& [joint, bent] : arm->bent) {
      const PackJoint& j = avatar.skeleton[static_cast<size_t>(joint)];
      if (joint == arm->hand || j.parent == arm->hand) continue;
      if (j.name.find("finger") == std::string::npos) continue;
      ++fingers;
      const Vec3 way = j.rest_m - avatar.skeleton[static_cast<size_t>(j.parent)].rest_m;
      EXPECT_LT(Dot(TransformDirection(bent, way), TransformDirection(arm->hand_bent, way)), 0)
          << avatar.name << ": " << j.name << " goes round the pole and back";
    }
    EXPECT_GE(fingers, 1) << avatar.name;
  }
}

// What has no geometry loaded walks by the same numbers.
TEST(GuideFigure, CostsTheSameWithoutGeometry) {
  TourPack with = WithMeshes(), without = WithMeshes();
  without.meshes.clear();
  AddGuideFigure(&with);
  AddGuideFigure(&without);
  for (size_t k = 0; k < 2; ++k)
    EXPECT_EQ(with.avatars.back().levels[k].triangles, without.avatars.back().levels[k].triangles);
}

TEST(GuideFigure, IsTheGuideAndNobodyElse) {
  TourPack pack = WithMeshes();
  AddGuideFigure(&pack);
  const Simulation s = Started(pack);
  EXPECT_EQ(std::count(s.town.crowd.avatar.begin(), s.town.crowd.avatar.end(), 2), 1);
  EXPECT_EQ(s.town.crowd.avatar[s.visitor.guide.index], 2);
  TourPack plain = WithMeshes();
  plain.guide.clear();
  AddGuideFigure(&plain);
  EXPECT_EQ(plain.avatars.size(), 2u);
}

}  // namespace
}  // namespace flaneur
