// Ground for towns that come without: through the feet of what stands there.
#include "pipeline/cli/bare_ground.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace flaneur {
namespace {

TownObject Box(Point3 low, Point3 size) {
  TownObject box;
  box.min_m = low;
  box.max_m = {low.x + size.x, low.y + size.y, low.z + size.z};
  return box;
}

// Of the ground's corners the heights, by place on the map.
struct Spot {
  double x, y, z;
};
std::vector<Spot> SpotsOf(const Mesh& ground) {
  std::vector<Spot> spots;
  for (const Vec3& p : ground.positions) {
    const Vec3 at = GroundFromGltf(p);
    spots.push_back({static_cast<double>(at.x), static_cast<double>(at.y), static_cast<double>(at.z)});
  }
  return spots;
}

double Off(const Spot& s, const TownObject& t) {
  return std::hypot(std::max({t.min_m.x - s.x, s.x - t.max_m.x, 0.0}),
                    std::max({t.min_m.y - s.y, s.y - t.max_m.y, 0.0}));
}

TEST(BareGround, LiesUnderPartsOnOnePlaneWhateverHangsBelowOrFliesAboveIt) {
  std::vector<TownObject> things;
  for (int k = 0; k < 9; ++k) things.push_back(Box({12.0 * k, 0, 0}, {8, 8, 6}));
  things.push_back(Box({20, 20, -7}, {3, 3, 9}));
  things.push_back(Box({40, 20, 30}, {9, 9, 2}));
  for (const Spot& s : SpotsOf(BareGround(things, true, 15))) EXPECT_EQ(s.z, 0);
  const std::vector<Spot> corners = SpotsOf(BareGround(things, true, 15));
  ASSERT_EQ(corners.size(), 4u);
  EXPECT_EQ(corners[0].x, -15);
  EXPECT_EQ(corners[0].y, -15);
  EXPECT_EQ(corners[3].x, 104 + 15);
  EXPECT_EQ(corners[3].y, 29 + 15);  // the farthest is the kite
}

// The triangles of boxes, as one thing.
TownObject Merged(const std::vector<TownObject>& boxes) {
  TownObject all = boxes.front();
  for (const TownObject& b : boxes) {
    const auto corner = [&](int k) {
      return Point3{k & 1 ? b.max_m.x : b.min_m.x, k & 2 ? b.max_m.y : b.min_m.y, k & 4 ? b.max_m.z : b.min_m.z};
    };
    for (const auto& [p, q, r, s] :
         {std::array{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}) {
      all.triangles.push_back({corner(p), corner(q), corner(r)});
      all.triangles.push_back({corner(p), corner(r), corner(s)});
    }
    all.min_m = {std::min(all.min_m.x, b.min_m.x), std::min(all.min_m.y, b.min_m.y), std::min(all.min_m.z, b.min_m.z)};
    all.max_m = {std::max(all.max_m.x, b.max_m.x), std::max(all.max_m.y, b.max_m.y), std::max(all.max_m.z, b.max_m.z)};
  }
  return all;
}

TEST(BareGround, FollowsAHillsideByTheFeetOfItsHousesAndNotByTheirRoofs) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> share(0, 1);
    const double east = 0.12 * share(random), north = 0.12 * share(random);
    std::vector<TownObject> walls, things;
    for (int k = 0; k < 30; ++k) {
      const double x = 25.0 * (k % 6) + 6 * share(random), y = 25.0 * (k / 6) + 6 * share(random);
      const double z = 300 + east * x + north * y, up = 5 + 4 * share(random);
      walls.push_back(Box({x, y, z}, {10, 8, up}));
      things.push_back(walls.back());
      things.push_back(Box({x - 0.4, y - 0.4, z + up}, {10.8, 8.8, 3}));
      things.push_back(Box({x + 4, y - 0.1, z + 2}, {1, 0.1, 1}));
      things.push_back(Box({x + 4, y + 4, z + up + 3}, {0.6, 0.6, 1}));
    }
    std::shuffle(things.begin(), things.end(), random);
    things.push_back(Box({60, 60, 280}, {4, 4, 3}));  // a cellar
    if (seed % 2 == 0) things = {Merged(things)};
    const Mesh ground = BareGround(things, false, 15);
    int beside = 0;
    for (const Spot& s : SpotsOf(ground)) {
      EXPECT_NEAR(s.z, 300 + east * s.x + north * s.y, 8) << "seed " << seed;
      for (const TownObject& wall : walls) {
        if (Off(s, wall) > 1) continue;
        EXPECT_NEAR(s.z, wall.min_m.z, 0.15) << "seed " << seed;
        ++beside;
      }
    }
    EXPECT_GT(beside, 30);
    for (const Vec3& n : ground.normals) EXPECT_GT(n.y, 0.7f);
  }
}

// A house that stands askew, as most do, and a smaller one within its bounding box, but beside it and higher up.
TEST(BareGround, NobodysWallsHangInTheAirBesideALowerNeighbour) {
  constexpr double kUp_m = 0.8;
  TownObject large;
  const std::array<Point2, 4> outline{{{0, 0}, {5, -5}, {30, 20}, {25, 25}}};
  for (size_t k = 0; k < 4; ++k) {
    const Point2 a = outline[k], b = outline[(k + 1) % 4];
    large.triangles.push_back({{{a.x, a.y, 0}, {b.x, b.y, 0}, {b.x, b.y, 9}}});
    large.triangles.push_back({{{a.x, a.y, 0}, {b.x, b.y, 9}, {a.x, a.y, 9}}});
  }
  large.triangles.push_back({{{0, 0, 9}, {5, -5, 9}, {30, 20, 9}}});
  large.triangles.push_back({{{0, 0, 9}, {30, 20, 9}, {25, 25, 9}}});
  large.min_m = {0, -5, 0}, large.max_m = {30, 25, 9};
  const TownObject small = Merged({Box({22, -2, kUp_m}, {6, 6, 3})});
  std::vector<TownObject> things{large, small};
  for (int k = 0; k < 5; ++k) things.push_back(Box({-300.0 + 100 * k, 200, 0}, {10, 10, 6}));  // a wide town
  const Mesh ground = BareGround(things, false, 15);
  int under = 0;
  for (size_t i = 0; i + 2 < ground.indices.size(); i += 3) {
    Point3 low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
    for (size_t k = 0; k < 3; ++k) {
      const Vec3 p = GroundFromGltf(ground.positions[ground.indices[i + k]]);
      low = {std::min(low.x, double(p.x)), std::min(low.y, double(p.y)), std::min(low.z, double(p.z))};
      high = {std::max(high.x, double(p.x)), std::max(high.y, double(p.y)), 0};
    }
    if (high.x < small.min_m.x || low.x > small.max_m.x || high.y < small.min_m.y || low.y > small.max_m.y) continue;
    EXPECT_GE(low.z, kUp_m - 1e-3);
    ++under;
  }
  EXPECT_GT(under, 0);
}

}  // namespace
}  // namespace flaneur
