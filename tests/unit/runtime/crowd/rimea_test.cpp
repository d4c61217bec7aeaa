// Cases of the guideline for microscopic evacuation analysis (RiMEA e.V., Richtlinie fuer Mikroskopische
// Entfluchtungsanalysen 3.0, 2016), each with the guideline's criterion. Not here:
//   2, 3  walking on stairs: there are slopes, no stairs.
//   4     speed and flow against density: weidmann_test.cpp. Above 4 people/m^2 discs of 0.25 m no longer fit side by
//   side. 5     reaction before setting out: whoever sends people somewhere decides when. 11    choice of the exit by
//   its crowding: people have a goal of their own, which crowding doesn't change.
// Cases 13 and 14 have a ramp for the guideline's stairs; case 8 has one floor of its building.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "runtime/base/random.h"
#include "runtime/crowd/crowd.h"

namespace flaneur {
namespace {

CrowdScratch scratch;
constexpr float kStep_s = 1.0f / 30, kRadius_m = 0.25f, kUsual_mps = 1.33f, kWall_m = 0.2f;

PolygonObstacle Box(float x0, float y0, float x1, float y1) { return {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, {}}; }

// Walls of kWall_m along x at y, or along y at x, from one end to the other but for openings [from, to].
struct Opening {
  float from, to;
};
void AddWall(bool along_x, float at, float first, float last, const std::vector<Opening>& openings, Walkable* w) {
  const auto add = [&](float from, float to) {
    if (to <= from) return;
    w->polygons.push_back(along_x ? Box(from, at - kWall_m / 2, to, at + kWall_m / 2)
                                  : Box(at - kWall_m / 2, from, at + kWall_m / 2, to));
  };
  for (const Opening& o : openings) add(first, o.from), first = o.to;
  add(first, last);
}

GroundRaster Flat(Vec2 min_m, Vec2 max_m) {
  GroundRaster g{min_m, 0.5f, static_cast<int>(2 * (max_m.x - min_m.x)), static_cast<int>(2 * (max_m.y - min_m.y)),
                 {},    {}};
  const size_t all = static_cast<size_t>(g.columns) * static_cast<size_t>(g.rows);
  g.height_m.assign(all, 0), g.kind.assign(all, 3);
  return g;
}

Walkable On(GroundRaster ground) {
  Walkable w;
  w.ground = Share(std::move(ground));
  return w;
}

Walkable Plan(Vec2 min_m, Vec2 max_m) { return On(Flat(min_m, max_m)); }

void Add(Vec2 position, Vec2 goal, float preferred_mps, Crowd* c) {
  Person p;
  p.position = position;
  p.radius_m = kRadius_m;
  p.preferred_mps = preferred_mps;
  p.field = FieldFor(goal, c);
  AddPerson(p, c);
  c->view.back() = ViewClass::kVisible;
}

// Evenly over a rectangle; goal_of(position) is where each goes.
template <typename GoalOf>
void Spread(Vec2 min_m, Vec2 max_m, int people, float preferred_mps, GoalOf goal_of, Crowd* c) {
  const Vec2 size = max_m - min_m;
  const int columns = static_cast<int>(std::ceil(std::sqrt(static_cast<float>(people) * size.x / size.y)));
  const int rows = (people + columns - 1) / columns;
  for (int k = 0; k < people; ++k) {
    const Vec2 p{min_m.x + size.x * (static_cast<float>(k % columns) + 0.5f) / static_cast<float>(columns),
                 min_m.y + size.y * (static_cast<float>(k / columns) + 0.5f) / static_cast<float>(rows)};
    Add(p, goal_of(p), preferred_mps, c);
  }
}

// Steps until everybody has reached the goal and gone, and says when that was; most_s where somebody is left. look()
// sees every step.
template <typename Look>
float Empty_s(const Walkable& w, float most_s, Crowd* c, Look look) {
  float time_s = 0;
  while (c->size() > 0 && time_s < most_s) {
    StepCrowd(w, {}, kStep_s, &scratch, c);
    time_s += kStep_s;
    look();
    for (size_t i = c->size(); i-- > 0;) {
      if (c->arrived[i] == Arrival::kThere) RemovePerson(i, c);
    }
  }
  return time_s;
}

// Mean speed of those in a rectangle, over all calls.
struct SpeedIn {
  Vec2 min_m, max_m;
  double sum_mps = 0;
  int count = 0;
  void Look(const Crowd& c) {
    for (size_t i = 0; i < c.size(); ++i) {
      const Vec2 p = c.position[i];
      if (p.x < min_m.x || p.x > max_m.x || p.y < min_m.y || p.y > max_m.y) continue;
      sum_mps += static_cast<double>(Length(c.velocity[i]));
      ++count;
    }
  }
  double Mean_mps() const { return count > 0 ? sum_mps / count : 0; }
};

TEST(Rimea, Case1SomebodyKeepsTheSpeedInACorridor) {
  Walkable w = Plan({-2, 0}, {44, 2});
  BuildWalkable(0.3f, &w, kRadius_m);
  Crowd c;
  Add({0, 1}, {43, 1}, kUsual_mps, &c);
  float time_s = 0;
  while (c.position[0].x < 40 && time_s < 60) StepCrowd(w, {}, kStep_s, &scratch, &c), time_s += kStep_s;
  std::printf("case 1: 40 m in %.1f s\n", static_cast<double>(time_s));
  EXPECT_GE(time_s, 26);
  EXPECT_LE(time_s, 34);
}

TEST(Rimea, Case6TwentyGoRoundACornerAndThroughNoWall) {
  Walkable w = Plan({0, 0}, {12, 12});
  w.polygons.push_back(Box(-1, 2, 10, 13));
  BuildWalkable(0.3f, &w, kRadius_m);
  Crowd c;
  Spread(
      {0, 0}, {6, 2}, 20, kUsual_mps,
      [](Vec2) {
        return Vec2{11, 11};
      },
      &c);
  const float time_s = Empty_s(w, 120, &c, [&] {
    for (size_t i = 0; i < c.size(); ++i) {
      ASSERT_FALSE(InsideObstacle(w, c.position[i]));
      ASSERT_TRUE(OnGround(w, c.position[i]));
      for (size_t j = 0; j < i; ++j) ASSERT_GE(Length(c.position[i] - c.position[j]), 2 * kRadius_m - 0.02f);
    }
  });
  std::printf("case 6: all round the corner after %.1f s\n", static_cast<double>(time_s));
  EXPECT_EQ(c.size(), 0u);
}

// Fifty adults of the guideline's groups by age (Weidmann 1993), each alone.
TEST(Rimea, Case7SpeedsAreThoseOfThePopulation) {
  const struct {
    float least_mps, most_mps;
  } groups[] = {{0.58f, 1.61f}, {1.41f, 1.54f}, {0.68f, 1.41f}, {0.46f, 0.76f}};
  Walkable w = Plan({0, 0}, {30, 200});
  BuildWalkable(0.3f, &w, kRadius_m);
  Crowd c;
  Random random{1};
  for (int k = 0; k < 50; ++k) {
    const float y_m = 2 + 4 * static_cast<float>(k);
    Add({1, y_m}, {29, y_m}, random.Uniform(groups[k % 4].least_mps, groups[k % 4].most_mps), &c);
  }
  for (int step = 0; step < 60; ++step) StepCrowd(w, {}, kStep_s, &scratch, &c);
  const std::vector<Vec2> before = c.position;
  for (int step = 0; step < 300; ++step) StepCrowd(w, {}, kStep_s, &scratch, &c);
  for (size_t i = 0; i < c.size(); ++i) {
    const float speed_mps = Length(c.position[i] - before[i]) / 10;
    EXPECT_NEAR(speed_mps, c.preferred_mps[i], 0.01f * c.preferred_mps[i]);
    EXPECT_GE(speed_mps, 0.99f * groups[i % 4].least_mps);
    EXPECT_LE(speed_mps, 1.01f * groups[i % 4].most_mps);
  }
}

// A room of 20 x 10 m with one door of 1.2 m.
TEST(Rimea, Case8FasterPeopleLeaveSooner) {
  Walkable w = Plan({0, 0}, {25, 10});
  AddWall(false, 20, 0, 10, {{4.4f, 5.6f}}, &w);
  BuildWalkable(0.3f, &w, kRadius_m);
  float last_s = 1e9f;
  for (float preferred_mps : {0.7f, 0.9f, 1.1f, 1.3f, 1.5f}) {
    Crowd c;
    Spread(
        {0, 0}, {16, 10}, 40, preferred_mps,
        [](Vec2) {
          return Vec2{23, 5};
        },
        &c);
    const float time_s = Empty_s(w, 300, &c, [] {});
    std::printf("case 8: at %.1f m/s out after %.1f s\n", static_cast<double>(preferred_mps),
                static_cast<double>(time_s));
    EXPECT_EQ(c.size(), 0u);
    EXPECT_LT(time_s, last_s);
    last_s = time_s;
  }
}

// A thousand people leave a hall of 30 x 20 m by its doors of 1 m: two in each long wall, or two in one of them alone.
float HallEmpty_s(bool four_doors) {
  Walkable w = Plan({-4, -5}, {34, 25});
  const std::vector<Opening> doors{{7, 8}, {22, 23}};
  AddWall(true, 20, 0, 30, doors, &w);
  AddWall(true, 0, 0, 30, four_doors ? doors : std::vector<Opening>{}, &w);
  AddWall(false, 0, 0, 20, {}, &w);
  AddWall(false, 30, 0, 20, {}, &w);
  BuildWalkable(0.3f, &w, kRadius_m);
  Crowd c;
  const auto nearest_door = [&](Vec2 p) {
    return Vec2{p.x < 15 ? 7.5f : 22.5f, four_doors && p.y < 10 ? -3.0f : 23.0f};
  };
  Spread({0.5f, 0.5f}, {29.5f, 19.5f}, 1000, kUsual_mps, nearest_door, &c);
  size_t inside = c.size();
  int still_steps = 0, longest_steps = 0;  // in which nobody gets out, though many want to
  const float time_s = Empty_s(w, 1200, &c, [&] {
    still_steps = c.size() < inside || inside < 100 ? 0 : still_steps + 1;
    longest_steps = std::max(longest_steps, still_steps);
    inside = c.size();
  });
  EXPECT_EQ(c.size(), 0u);
  EXPECT_LT(static_cast<float>(longest_steps) * kStep_s, 10) << "people before the doors block each other";
  return time_s;
}

TEST(Rimea, Case9HalfTheDoorsTakeTwiceAsLong) {
  const float four_s = HallEmpty_s(true), two_s = HallEmpty_s(false);
  std::printf("case 9: 1,000 people, four doors %.0f s, two doors %.0f s: %.2f times; %.2f people/m/s\n",
              static_cast<double>(four_s), static_cast<double>(two_s), static_cast<double>(two_s / four_s),
              static_cast<double>(250 / four_s));
  EXPECT_NEAR(two_s / four_s, 2, 0.3f);
}

// Twelve rooms on both sides of a corridor; those of the last two rooms on each side have the exit at the far end.
TEST(Rimea, Case10EverybodyLeavesByTheExitGivenThem) {
  Walkable w = Plan({-4, 0}, {22, 12});
  const std::vector<Opening> doors{{1, 2}, {4, 5}, {7, 8}, {10, 11}, {13, 14}, {16, 17}};
  AddWall(true, 5, 0, 18, doors, &w);
  AddWall(true, 7, 0, 18, doors, &w);
  for (int k = 0; k <= 6; ++k) {
    AddWall(false, 3 * static_cast<float>(k), 0, 5, {}, &w);
    AddWall(false, 3 * static_cast<float>(k), 7, 12, {}, &w);
  }
  BuildWalkable(0.3f, &w, kRadius_m);
  const Vec2 main_exit{-3, 6}, other_exit{21, 6};
  Crowd c;
  for (int k = 0; k < 23; ++k) {
    const int room = k % 12, column = room % 6;
    const Vec2 p{3 * static_cast<float>(column) + (k < 12 ? 1.0f : 2.0f), room < 6 ? 2.0f : 10.0f};
    Add(p, column < 4 ? main_exit : other_exit, kUsual_mps, &c);
  }
  int by_main = 0, by_other = 0;
  Empty_s(w, 120, &c, [&] {
    for (size_t i = 0; i < c.size(); ++i) {
      if (c.arrived[i] != Arrival::kThere) continue;
      const bool for_main = c.id[i] % 12 % 6 < 4;
      EXPECT_EQ(c.position[i].x < 0, for_main) << "person " << c.id[i];
      (for_main ? by_main : by_other) += 1;
    }
  });
  EXPECT_EQ(by_main, 16);
  EXPECT_EQ(by_other, 7);
}

// A room, a corridor of 1 x 5 m, a second room and an exit as wide as the corridor, which lets as many out as come in.
TEST(Rimea, Case12OnlyTheFirstBottleneckJams) {
  Walkable w = Plan({0, 0}, {29, 10});
  w.polygons.push_back(Box(10, -1, 15, 4.5f));
  w.polygons.push_back(Box(10, 5.5f, 15, 11));
  AddWall(false, 25, 0, 10, {{4.5f, 5.5f}}, &w);
  BuildWalkable(0.3f, &w, kRadius_m);
  Crowd c;
  Spread(
      {0, 0}, {10, 10}, 150, kUsual_mps,
      [](Vec2) {
        return Vec2{28, 5};
      },
      &c);
  SpeedIn before_corridor{{7.5f, 2.5f}, {9.8f, 7.5f}}, before_exit{{22.5f, 2.5f}, {24.8f, 7.5f}};
  const float time_s = Empty_s(w, 600, &c, [&] { before_corridor.Look(c), before_exit.Look(c); });
  std::printf("case 12: %.2f m/s before the corridor, %.2f m/s before the exit; out after %.0f s\n",
              before_corridor.Mean_mps(), before_exit.Mean_mps(), static_cast<double>(time_s));
  EXPECT_EQ(c.size(), 0u);
  EXPECT_LE(before_corridor.Mean_mps(), 0.5 * kUsual_mps);
  EXPECT_GE(before_exit.Mean_mps(), 0.7 * kUsual_mps);
}

// A room of 8 x 5 m, a corridor of 2 x 12 m, and a ramp of the same width that rises 4 m over 8 m.
TEST(Rimea, Case13PeopleQueueBeforeARamp) {
  GroundRaster ground = Flat({0, 0}, {32, 5});
  for (int y = 0; y < ground.rows; ++y) {
    for (int x = 40; x < ground.columns; ++x) {
      ground.height_m[static_cast<size_t>(y * ground.columns + x)] =
          0.5f * static_cast<float>(std::min(x, 56) - 40) * 0.5f;
    }
  }
  Walkable w = On(std::move(ground));
  w.polygons.push_back(Box(8, -1, 33, 1.5f));
  w.polygons.push_back(Box(8, 3.5f, 33, 6));
  BuildWalkable(0.3f, &w, kRadius_m);
  Crowd c;
  Spread(
      {0, 0}, {8, 5}, 100, kUsual_mps,
      [](Vec2) {
        return Vec2{31, 2.5f};
      },
      &c);
  SpeedIn into_corridor{{5, 0}, {8, 5}}, before_ramp{{16, 1.5f}, {20, 3.5f}}, after_ramp{{28.5f, 1.5f}, {30, 3.5f}};
  Empty_s(w, 600, &c, [&] { into_corridor.Look(c), before_ramp.Look(c), after_ramp.Look(c); });
  std::printf("case 13: %.2f m/s before the corridor, %.2f m/s before the ramp, %.2f m/s beyond it\n",
              into_corridor.Mean_mps(), before_ramp.Mean_mps(), after_ramp.Mean_mps());
  EXPECT_EQ(c.size(), 0u);
  EXPECT_LE(into_corridor.Mean_mps(), 0.5 * kUsual_mps);
  EXPECT_LE(before_ramp.Mean_mps(), 0.6 * kUsual_mps);
  EXPECT_GE(after_ramp.Mean_mps(), 0.75 * kUsual_mps);
}

// Two ways round a block of 16 x 4 m, the short one below it, 8 m longer above. The guideline asks to document which is
// taken: always the cheaper one, however crowded; a ramp on the short way makes it costlier.
TEST(Rimea, Case14TheCheaperWayIsTaken) {
  for (bool ramp : {false, true}) {
    GroundRaster ground = Flat({0, 0}, {30, 14});
    if (ramp) {
      for (int y = 0; y < 12; ++y) {  // on under the block: its edge is not seen as a step
        for (int x = 16; x < 44; ++x) {
          const float up = static_cast<float>(std::min(x - 16, 43 - x)) * 0.25f;
          ground.height_m[static_cast<size_t>(y * ground.columns + x)] = up;
        }
      }
    }
    Walkable w = On(std::move(ground));
    w.polygons.push_back(Box(7, 4, 23, 8));
    BuildWalkable(0.3f, &w, kRadius_m);
    Crowd c;
    Spread(
        {0, 0}, {6, 4}, 30, kUsual_mps,
        [](Vec2) {
          return Vec2{28, 2};
        },
        &c);
    std::vector<int> above(c.size(), 0);
    Empty_s(w, 300, &c, [&] {
      for (size_t i = 0; i < c.size(); ++i) above[static_cast<size_t>(c.id[i])] |= c.position[i].y > 8 ? 1 : 0;
    });
    const int by_long_way = static_cast<int>(std::count(above.begin(), above.end(), 1));
    std::printf("case 14: %s, %d of %zu by the long way\n", ramp ? "ramp on the short way" : "level", by_long_way,
                above.size());
    EXPECT_EQ(c.size(), 0u);
    EXPECT_EQ(by_long_way, ramp ? 30 : 0);
  }
}

}  // namespace
}  // namespace flaneur
