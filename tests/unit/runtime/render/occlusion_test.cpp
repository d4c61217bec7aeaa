// What hides what.
#include <gtest/gtest.h>

#include <random>

#include "runtime/render/occlusion.h"
#include "runtime/render/projection.h"
#include "runtime/render/visible_triangles.h"
#include "tests/unit/runtime/render/made_up_tour.h"

namespace flaneur {
namespace {

// A wall of 8 x 4 m, 10 m before the eye, and boxes of 1 m beside, above, behind and before it.
TEST(Occlusion, HidesWhatIsBehindAWallAndNothingElse) {
  const Mat4 view = Perspective(1.2f, 16.0f / 9, 0.1f, 500) * LookMatrix({0, 0, 0}, {0, 0, -1}, {0, 1, 0});
  const auto box = [](float x, float y, float z) {
    return Box{{x - 0.5f, y - 0.5f, z - 0.5f}, {x + 0.5f, y + 0.5f, z + 0.5f}};
  };
  const std::vector<Vec3> wall{{-4, -2, -10}, {4, -2, -10}, {4, 2, -10}, {-4, -2, -10}, {4, 2, -10}, {-4, 2, -10}};
  const std::vector<Vec3> from_behind(wall.rbegin(), wall.rend());
  OcclusionMap map;
  ClearOcclusion(view, &map);
  const std::vector<uint32_t> corners{0, 1, 2, 3, 4, 5};
  AddWalls(from_behind, corners, &map);  // not drawn, hides nothing
  FinishOcclusion(&map);
  EXPECT_TRUE(MayBeSeen(map, box(0, 0, -20), true));
  AddWalls(wall, corners, &map);
  FinishOcclusion(&map);
  for (bool finished : {false, true}) {
    EXPECT_FALSE(MayBeSeen(map, box(0, 0, -20), finished));
    EXPECT_FALSE(MayBeSeen(map, box(5, 2, -20), finished));
    EXPECT_TRUE(MayBeSeen(map, box(8, 0, -20), finished));  // looks out at the side: the wall ends at 8 m there
    EXPECT_TRUE(MayBeSeen(map, box(0, 4, -20), finished));  // above it
    EXPECT_TRUE(MayBeSeen(map, box(0, 0, -9), finished));   // before it
    EXPECT_TRUE(MayBeSeen(map, box(0, 0, -10), finished));  // in it
    EXPECT_TRUE(MayBeSeen(map, box(0, 0, 0), finished));    // around the eye
  }
}

TEST(Occlusion, AWallThatTheEyeStandsBesideHidesToo) {
  const Mat4 view = Perspective(1.2f, 16.0f / 9, 0.1f, 500) * LookMatrix({0, 0, 0}, {0, 0, -1}, {0, 1, 0});
  OcclusionMap map;
  ClearOcclusion(view, &map);
  // From 5 m behind the eye to 40 m ahead, 1 m to the left, seen from the right.
  AddWalls(std::vector<Vec3>{{-1, -30, 5}, {-1, -30, -40}, {-1, 30, -40}, {-1, 30, 5}},
           std::vector<uint32_t>{0, 1, 2, 0, 2, 3}, &map);
  FinishOcclusion(&map);
  EXPECT_FALSE(MayBeSeen(map, {{-9, -1, -20}, {-8, 1, -19}}, true));
  EXPECT_TRUE(MayBeSeen(map, {{1, -1, -20}, {2, 1, -19}}, true));
}

// Where the eye at 0 that looks along -z sees a point, in pixels of a picture of 64 x 36.
Vec2 Pixel(const Mat4& view, Vec3 p) {
  const auto row = [&](size_t r) {
    return view.m[0][r] * p.x + view.m[1][r] * p.y + view.m[2][r] * p.z + view.m[3][r];
  };
  return {(row(0) / row(3) + 1) * 32, (row(1) / row(3) + 1) * 18};
}

bool ReachesAMiddle(Vec2 a, Vec2 b, Vec2 c) {
  for (int i = 0; i < 64 * 36; ++i) {
    const Vec2 p{static_cast<float>(i % 64) + 0.5f, static_cast<float>(i / 64) + 0.5f};
    const float u = Cross(b - a, p - a), v = Cross(c - b, p - b), w = Cross(a - c, p - c);
    if ((u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0)) return true;
  }
  return false;
}

TEST(VisibleTriangles, WhatReachesAPixelsMiddleIsSeenAndMostOfTheRestIsNot) {
  const Mat4 view = Perspective(1.2f, 16.0f / 9, 0.1f, 500) * LookMatrix({0, 0, 0}, {0, 0, -1}, {0, 1, 0});
  OcclusionMap map;
  ClearOcclusion(view, &map);
  FinishOcclusion(&map);
  const TriangleSight sight{64, 36, &map};
  std::mt19937 random(5);
  const auto number = [&](float low, float high) {
    return low + (high - low) * static_cast<float>(random() % 10000) / 10000;
  };
  int seen_in_vain = 0, unseen = 0;
  for (int k = 0; k < 4000; ++k) {
    const Vec3 a{number(-12, 12), number(-7, 7), number(-20, -2)};
    const float reach_m = k % 2 == 0 ? 0.2f : 3.0f;
    const auto beside = [&] {
      return a + Vec3{number(-reach_m, reach_m), number(-reach_m, reach_m), number(-0.5f, 0.5f)};
    };
    const std::array<Vec3, 3> t{a, beside(), beside()};
    const bool reaches = ReachesAMiddle(Pixel(view, t[0]), Pixel(view, t[1]), Pixel(view, t[2])),
               seen = MayBeSeen(t, sight);
    EXPECT_TRUE(seen || !reaches) << k;
    unseen += !reaches;
    seen_in_vain += seen && !reaches;
  }
  EXPECT_GT(unseen, 1000);
  EXPECT_LT(seen_in_vain, unseen / 10);
  EXPECT_TRUE(MayBeSeen({{{-1, -1, 1}, {1, -1, 1}, {0, 0, -5}}}, sight));  // from behind the eye
}

TEST(VisibleTriangles, AWallHidesWhatIsBehindItButNotWhatLiesOnIt) {
  const Mat4 view = Perspective(1.2f, 16.0f / 9, 0.1f, 500) * LookMatrix({0, 0, 0}, {0, 0, -1}, {0, 1, 0});
  OcclusionMap map;
  ClearOcclusion(view, &map);
  AddWalls(std::vector<Vec3>{{-4, -2, -10}, {4, -2, -10}, {4, 2, -10}, {-4, 2, -10}},
           std::vector<uint32_t>{0, 1, 2, 0, 2, 3}, &map);
  FinishOcclusion(&map);
  const auto at = [](float x, float z) {
    return std::array<Vec3, 3>{{{x, -0.5f, z}, {x + 1, -0.5f, z}, {x, 0.5f, z}}};
  };
  const TriangleSight sight{1280, 720, &map};
  EXPECT_FALSE(MayBeSeen(at(0, -12), sight));
  EXPECT_TRUE(MayBeSeen(at(0, -10), sight));
  EXPECT_TRUE(MayBeSeen(at(0, -9), sight));
  EXPECT_TRUE(MayBeSeen(at(4.5f, -12), sight));  // looks out at the side
  EXPECT_FALSE(MayBeSeen(at(12, -12), sight));   // beside the view
}

}  // namespace
}  // namespace flaneur
