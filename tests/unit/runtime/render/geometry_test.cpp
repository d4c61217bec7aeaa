// What a graphics card gets of towns and people.
#include <gtest/gtest.h>

#include <cmath>

#include "runtime/render/block_picture.h"
#include "runtime/render/mip_chain.h"
#include "runtime/render/person_geometry.h"
#include "runtime/render/textures.h"
#include "runtime/render/town_geometry.h"
#include "tests/unit/runtime/render/made_up_tour.h"

namespace flaneur {
namespace {

TEST(SurfacePlan, PicturesOfOneSizeShareAnArrayAndSurfacesOfOneKindAGroup) {
  TourPack pack = MakePack({{11, 3}});
  pack.images = {{512, 512, {}}, {300, 512, {}}, {1024, 7, {}}, {9000, 9000, {}}};
  for (int i = 0; i < 4; ++i) {
    pack.materials.push_back({"m", {1, 1, 1, 1}, i, false, false, 0.5f});
    pack.meshes[1].primitives.push_back(BoxPrimitive({0, 0, 0}, {1, 1, 1}, i + 1, false));
  }
  const SurfacePlan plan = PlanSurfaces(pack, {1024, 512});
  ASSERT_EQ(plan.arrays.size(), 2u);
  EXPECT_EQ(plan.arrays[0].side_px, 512);
  EXPECT_EQ(plan.arrays[0].layers, 2);
  EXPECT_EQ(plan.arrays[1].side_px, 1024);
  EXPECT_EQ(plan.groups.size(), 2u);
  EXPECT_NE(plan.pictures[0].layer, plan.pictures[1].layer);
  EXPECT_EQ(SurfaceOf(-1, plan).layer, -1);
  const PackImage wide{2, 1, {0, 0, 0, 255, 255, 255, 255, 255}};
  const std::vector<PackImage> levels = PreparePicture(wide, 64);
  ASSERT_EQ(levels.size(), 7u);
  EXPECT_LT(levels[0].rgba[static_cast<size_t>(32 * 64 + 16) * 4], 40);
  EXPECT_GT(levels[0].rgba[static_cast<size_t>(32 * 64 + 48) * 4], 215);
  EXPECT_EQ(levels.back().width_px, 1);

  PackImage large{128, 128, std::vector<uint8_t>(128 * 128 * 4, 255)};
  for (size_t i = 0; i < 128 * 64 * 4; ++i) large.rgba[i] = 40;
  const std::vector<PackImage> halves = PreparePicture(large, 64);
  ASSERT_EQ(halves.size(), 7u);
  EXPECT_EQ(halves[0].rgba, MakeMipChain(large, true, 1).back().rgba);
  EXPECT_EQ(halves[0].rgba[0], 40);
  EXPECT_EQ(halves[0].rgba[static_cast<size_t>(63 * 64) * 4], 255);
}

TEST(SurfacePlan, PicturesThatCutOutKeepTheirAlphaWhereOthersAreBlocks) {
  TourPack pack = MakePack({});
  pack.images = {{512, 512, {}}, {512, 512, {}}};
  for (int i = 0; i < 2; ++i) pack.materials.push_back({"m", {1, 1, 1, 1}, i, false, i == 1, 0.5f});
  const SurfacePlan plan = PlanSurfaces(pack, {1024, 512, true});
  EXPECT_TRUE(plan.arrays[static_cast<size_t>(plan.pictures[0].array)].blocks);
  EXPECT_FALSE(plan.arrays[static_cast<size_t>(plan.pictures[1].array)].blocks);
}

// A block by its definition: two ends of 5, 6 and 5 bits, and which of four mixtures of them each texel is.
std::array<double, 3> TexelOfBc1(const uint8_t* block, size_t texel) {
  const auto end = [&](size_t k) {
    const int bits = block[2 * k] | block[2 * k + 1] << 8;
    return std::array<double, 3>{(bits >> 11) * 255.0 / 31, (bits >> 5 & 63) * 255.0 / 63, (bits & 31) * 255.0 / 31};
  };
  constexpr double kSecond[] = {0, 1, 1.0 / 3, 2.0 / 3};
  const double second = kSecond[block[4 + texel / 4] >> 2 * (texel % 4) & 3];
  const std::array<double, 3> a = end(0), b = end(1);
  return {a[0] + second * (b[0] - a[0]), a[1] + second * (b[1] - a[1]), a[2] + second * (b[2] - a[2])};
}

TEST(BlockPicture, ColoursStayWithinAFewSteps) {
  PackImage image{6, 5, {}};  // blocks reach beyond it
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 6; ++x)
      image.rgba.insert(image.rgba.end(),
                        {static_cast<uint8_t>(90 + 12 * x), static_cast<uint8_t>(60 + 8 * x), 40, 255});
  }
  const std::vector<uint8_t> blocks = Bc1Blocks(image);
  ASSERT_EQ(blocks.size(), 4u * 8);
  for (size_t y = 0; y < 5; ++y) {
    for (size_t x = 0; x < 6; ++x) {
      const std::array<double, 3> texel = TexelOfBc1(&blocks[8 * (2 * (y / 4) + x / 4)], 4 * (y % 4) + x % 4);
      for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(texel[c], image.rgba[4 * (6 * y + x) + c], 8) << x << ", " << y;
    }
  }
}

TEST(ShadowGeometry, IsMuchSmallerAndStaysInShape) {
  TourPack pack = MakePack({});
  PackPrimitive& p = pack.meshes[0].primitives[0];
  p = {};
  const int around = 64, up = 40;
  for (int j = 0; j <= up; ++j) {
    for (int i = 0; i < around; ++i) {
      const float a = 2 * kPi * static_cast<float>(i) / around;
      p.positions.push_back({0.3f * std::cos(a), 1.8f * static_cast<float>(j) / up, 0.3f * std::sin(a)});
      p.normals.push_back({std::cos(a), 0, std::sin(a)});
      if (j == up) continue;
      const auto at = [&](int x, int y) { return static_cast<uint32_t>(y * around + x % around); };
      for (uint32_t corner : {at(i, j), at(i + 1, j), at(i, j + 1), at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)})
        p.indices.push_back(corner);
    }
  }
  const PersonGeometry whole = BuildPersonGeometry(pack, pack.meshes[0], PlanSurfaces(pack, {})),
                       shadow = ShadowGeometry(whole, 0.16f, 1000);
  EXPECT_LT(shadow.indices.size(), whole.indices.size() / 10);
  EXPECT_LE(ShadowGeometry(whole, 0.01f, 100).indices.size() / 3, 100u) << "whatever the cells";
  Box box;
  for (uint32_t i : shadow.indices) Include(shadow.vertices[i].position, &box);
  EXPECT_NEAR(box.high.y, 1.8f, 0.1f);
  EXPECT_NEAR(box.high.x - box.low.x, 0.6f, 0.1f);
}

// Of legs thinner than its cells nothing was left: people 20 m away stood beside the shadow of their trunk.
TEST(ShadowGeometry, KeepsThinLegsFromWhereverTheSunShines) {
  TourPack pack = MakePack({});
  PackPrimitive& p = pack.meshes[0].primitives[0];
  p = {};
  const auto add_tube = [&p](Vec3 foot, float height_m, float radius_m, uint16_t joint) {
    constexpr int kAround = 12, kUp = 6;
    const auto first = static_cast<uint32_t>(p.positions.size());
    for (int j = 0; j <= kUp; ++j) {
      for (int i = 0; i < kAround; ++i) {
        const float a = 2 * kPi * static_cast<float>(i) / kAround;
        p.positions.push_back(
            foot + Vec3{radius_m * std::cos(a), height_m * static_cast<float>(j) / kUp, radius_m * std::sin(a)});
        p.normals.push_back({std::cos(a), 0, std::sin(a)});
        p.joints.push_back({joint, 0, 0, 0});
        p.weights.push_back({255, 0, 0, 0});
        if (j == kUp) continue;
        const auto at = [&](int x, int y) { return first + static_cast<uint32_t>(y * kAround + x % kAround); };
        for (const uint32_t corner :
             {at(i, j), at(i + 1, j), at(i, j + 1), at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)})
          p.indices.push_back(corner);
      }
    }
  };
  add_tube({0, 0.85f, 0}, 0.9f, 0.2f, 0);
  for (const float side : {-0.1f, 0.1f}) {
    add_tube({side, 0, 0.03f}, 0.43f, 0.05f, side < 0 ? 1 : 2);
    add_tube({side, 0.43f, 0.03f}, 0.42f, 0.07f, side < 0 ? 3 : 4);
  }
  const PersonGeometry whole = BuildPersonGeometry(pack, pack.meshes[0], PlanSurfaces(pack, {})),
                       shadow = ShadowGeometry(whole, 0.34f, 96);
  EXPECT_LE(shadow.indices.size() / 3, 96u);
  for (const uint16_t joint : {1, 2, 3, 4}) {
    const auto area_from = [joint](const PersonGeometry& of, Vec3 sun) {
      float area = 0;
      for (size_t i = 0; i + 2 < of.indices.size(); i += 3) {
        const PersonVertex &a = of.vertices[of.indices[i]], &b = of.vertices[of.indices[i + 1]],
                           &c = of.vertices[of.indices[i + 2]];
        if (a.joints[0] == joint && b.joints[0] == joint && c.joints[0] == joint)
          area += std::abs(Dot(Cross(b.position - a.position, c.position - a.position), sun)) / 2;
      }
      return area;
    };
    for (const float turn_rad : {0.0f, 0.5f, 0.8f, 1.6f}) {
      const Vec3 sun{std::cos(turn_rad), 0, std::sin(turn_rad)};
      EXPECT_GT(area_from(shadow, sun), 0.6f * area_from(whole, sun) / 2) << joint << ": " << turn_rad;  // it is closed
    }
  }
  Box box;
  for (const uint32_t i : shadow.indices) Include(shadow.vertices[i].position, &box);
  EXPECT_NEAR(box.low.y, 0, 0.01f) << "down to the soles";
}

TEST(ShadowGeometry, KeepsTheBrimOfAHat) {
  TourPack pack = MakePack({});
  PackPrimitive& p = pack.meshes[0].primitives[0];
  p = {};
  const int around = 48, rings = 9;  // from the middle of the crown to a brim of 20 cm
  for (int j = 0; j < rings; ++j) {
    for (int i = 0; i < around; ++i) {
      const float a = 2 * kPi * static_cast<float>(i) / around, radius_m = 0.025f * static_cast<float>(j);
      p.positions.push_back({radius_m * std::cos(a), 1.7f + (radius_m < 0.09f ? 0.1f : 0), radius_m * std::sin(a)});
      p.normals.push_back({0, 1, 0});
      if (j + 1 == rings) continue;
      const auto at = [&](int x, int y) { return static_cast<uint32_t>(y * around + x % around); };
      for (uint32_t corner : {at(i, j), at(i + 1, j), at(i, j + 1), at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)})
        p.indices.push_back(corner);
    }
  }
  const PersonGeometry shadow =
      ShadowGeometry(BuildPersonGeometry(pack, pack.meshes[0], PlanSurfaces(pack, {})), 0.1f, 1000);
  Box box;
  for (uint32_t i : shadow.indices) Include(shadow.vertices[i].position, &box);
  EXPECT_GT(box.high.x - box.low.x, 0.38f);
  EXPECT_GT(box.high.z - box.low.z, 0.38f);
}

TEST(TownGeometry, EveryTriangleIsInOneBlockAndItsBox) {
  const TourPack pack = MakePack({{11, 3}, {-14, -4}, {60, 80}});
  const TownGeometry town = BuildTownGeometry(pack, PlanSurfaces(pack, {}));
  uint32_t next = 0;
  int64_t triangles = 0;
  for (const TownBlock& block : town.blocks) {
    for (const TownRange& range : block.ranges) {
      EXPECT_EQ(range.first, next);
      next += range.count;
      for (uint32_t i = range.first; i < next; ++i)
        EXPECT_EQ(Distance(block.box, town.vertices[town.indices[i]].position), 0);
    }
    triangles += block.triangles;
  }
  EXPECT_EQ(next, town.indices.size());
  EXPECT_EQ(triangles, 36);
}

// Opaque houses and trees that are cut out, side by side.
TourPack HousesAndTrees() {
  std::vector<Vec2> houses;
  for (int k = 0; k < 144; ++k)
    houses.push_back({10.0f * static_cast<float>(k % 12), 10.0f * static_cast<float>(k / 12) - 60});
  TourPack pack = MakePack(houses);
  pack.materials.push_back({"leaves", {0.2f, 0.6f, 0.2f, 1}, -1, true, true, 0.5f});
  pack.meshes.push_back({{BoxPrimitive({4, 0, 4}, {6, 3, 6}, static_cast<int>(pack.materials.size()) - 1, false)}});
  for (size_t k = 0, count = pack.town.size(); k < count; ++k)
    pack.town.push_back({"tree", static_cast<int>(pack.meshes.size()) - 1, pack.town[k].world});
  return pack;
}

TEST(TownGeometry, IsBuiltInPartsWhereThereAreManyTriangles) {
  TourPack pack = HousesAndTrees();
  const std::vector<TownInstance> once = pack.town;
  for (int k = 0; k < 6; ++k) pack.town.insert(pack.town.end(), once.begin(), once.end());
  const SurfacePlan plan = PlanSurfaces(pack, {});
  TownBuilder builder(pack, plan);
  int parts = 1;
  while (!builder.Advance()) ++parts;
  EXPECT_GE(parts, 4) << "two that append, two that pack";
  EXPECT_EQ(builder.Take().indices, BuildTownGeometry(pack, plan).indices);
}

TEST(TownGeometry, WhatIsCutOutStandsTogetherBehindWhatIsOpaque) {
  const TourPack pack = HousesAndTrees();
  const SurfacePlan plan = PlanSurfaces(pack, {});
  const TownGeometry town = BuildTownGeometry(pack, plan);
  std::vector<int> group_of(town.indices.size(), -1);
  for (const TownBlock& block : town.blocks) {
    for (const TownRange& range : block.ranges) {
      for (uint32_t i = range.first; i < range.first + range.count; ++i) {
        EXPECT_EQ(group_of[i], -1) << "twice";
        group_of[i] = range.group;
        EXPECT_EQ(Distance(block.box, town.vertices[town.indices[i]].position), 0);
      }
    }
  }
  bool masked = false;
  int last = -1;
  for (int group : group_of) {
    ASSERT_GE(group, 0) << "left out";
    const bool is_masked = plan.groups[static_cast<size_t>(group)].masked;
    EXPECT_TRUE(is_masked || !masked) << "opaque behind what is cut out";
    EXPECT_TRUE(!masked || group >= last);
    masked = is_masked;
    last = group;
  }
  EXPECT_TRUE(masked);
}

TEST_F(Drawing, ATownWithManyTreesThatAreCutOutTakesFewDrawCalls) {
  FrameInput frame = LookEast();
  frame.to_sun = Normalized(Vec3{-0.5f, 0.4f, 0.6f});
  Draw(HousesAndTrees(), frame);
  EXPECT_LE(statistics_.draw_calls, 64) << "all shadows among them";
}

}  // namespace
}  // namespace flaneur
