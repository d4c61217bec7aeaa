#include "runtime/crowd/density_map.h"

#include <gtest/gtest.h>

namespace flaneur {
namespace {

// Square ground of 40 m with a house in its eastern half.
Walkable Ground() {
  Walkable w;
  w.ground = Share({{0, 0}, 0.5f, 80, 80, std::vector<float>(6400, 0), std::vector<uint8_t>(6400, 3)});
  w.polygons.push_back({{{20, 0}, {40, 0}, {40, 20}, {20, 20}}, {}});
  BuildWalkable(0.3f, &w);
  return w;
}

std::vector<Vec2> Spread(Vec2 min, Vec2 max, float apart_m) {
  std::vector<Vec2> people;
  for (float y = min.y + 0.5f * apart_m; y < max.y; y += apart_m) {
    for (float x = min.x + 0.5f * apart_m; x < max.x; x += apart_m) people.push_back({x, y});
  }
  return people;
}

TEST(DensityMap, AnEvenCrowdHasTheSameDensityEverywhere) {
  const Walkable w = Ground();
  DensityMap map;
  EXPECT_EQ(DensityAt_pm2(map, {5, 5}), 0) << "nobody was counted";
  CountPeople(w, Spread({0, 0}, {20, 40}, 0.5f), &map);
  for (const Vec2 p : {Vec2{4, 4}, Vec2{9.3f, 31}, Vec2{15, 20.7f}})
    EXPECT_NEAR(DensityAt_pm2(map, p), 4, 0.5f) << p.x << ", " << p.y;
  EXPECT_EQ(DensityAt_pm2(map, {35, 35}), 0);
  CountPeople(w, {}, &map);
  EXPECT_EQ(DensityAt_pm2(map, {4, 4}), 0) << "everybody has left";
}

TEST(DensityMap, AStraightLineMeetsTheCrowdThatLiesOnIt) {
  const Walkable w = Ground();
  DensityMap map;
  CountPeople(w, Spread({8, 18}, {12, 22}, 0.5f), &map);
  EXPECT_GT(MostDensityBetween_pm2(map, {10, 2}, {10, 38}), 3);
  EXPECT_GT(MostDensityBetween_pm2(map, {2, 20}, {10, 20}), 3) << "at its end";
  EXPECT_EQ(MostDensityBetween_pm2(map, {2, 2}, {2, 38}), 0);
}

TEST(DensityMap, PeopleOffTheMapCountAtItsEdge) {
  const Walkable w = Ground();
  DensityMap map;
  CountPeople(w, {{-50, 10}, {90, 90}}, &map);
  EXPECT_GE(DensityAt_pm2(map, {-3, 10}), 0);
  EXPECT_GE(MostDensityBetween_pm2(map, {-100, -100}, {100, 100}), 0);
}

}  // namespace
}  // namespace flaneur
