#include "runtime/crowd/crowd.h"

#include <gtest/gtest.h>

#include <cmath>

#include "runtime/crowd/constants.h"
#include "runtime/crowd/fast_math.h"
#include "runtime/crowd/walls.h"

namespace flaneur {
namespace {

CrowdScratch scratch;
constexpr float kStep_s = 1.0f / 30;

// A square field of 40 m with a house, a tree and a wall with a doorway of 1.5 m.
Walkable Field() {
  Walkable w;
  w.ground = Share({{-20, -20}, 0.5f, 80, 80, std::vector<float>(6400, 0), std::vector<uint8_t>(6400, 3)});
  w.polygons.push_back({{{-8, -3}, {-3, -3}, {-3, 3}, {-8, 3}}, {}});
  w.polygons.push_back({{{5, -20}, {5.3f, -20}, {5.3f, -0.75f}, {5, -0.75f}}, {}});
  w.polygons.push_back({{{5, 0.75f}, {5.3f, 0.75f}, {5.3f, 20}, {5, 20}}, {}});
  w.circles.push_back({{0, 6}, 0.5f});
  BuildWalkable(0.3f, &w);
  return w;
}

// Jagged houses with yards, over each other and over the ground's edge.
Walkable JaggedTown(Random* random) {
  Walkable w;
  w.ground = Share({{-20, -20}, 0.5f, 80, 80, std::vector<float>(6400, 0), std::vector<uint8_t>(6400, 3)});
  const auto ring = [&](Vec2 middle, float least_m, float most_m) {
    std::vector<Vec2> points;
    const int corners = 3 + random->Below(12);
    for (int k = 0; k < corners; ++k) {
      const float angle = 2 * kPi * static_cast<float>(k) / static_cast<float>(corners);
      points.push_back(middle + DirectionOf(angle) * random->Uniform(least_m, most_m));
    }
    return points;
  };
  for (int k = 0; k < 12; ++k) {
    const Vec2 middle{random->Uniform(-22, 22), random->Uniform(-22, 22)};
    w.polygons.push_back({ring(middle, 2, 6), {}});
    for (int hole = random->Below(3); hole > 0; --hole) w.polygons.back().holes.push_back(ring(middle, 0.5f, 3));
  }
  BuildWalkable(0.3f, &w);
  return w;
}

float DistanceToWalls_m(const Walkable& w, Vec2 p) {
  float least_m = 1e9f;
  for (const Walkable::Edge& e : w.edges) least_m = std::min(least_m, Length(NearestOnSegment(p, e.a, e.b) - p));
  return least_m;
}

// In the cell about p, or in a cell beside it: for somebody who squeezes through.
bool HasRoomAround(const Walkable& w, Vec2 p) {
  constexpr int kSteps = 30;
  constexpr float kNearlyAlike_m = 0.02f;
  for (int y = -kSteps; y <= kSteps; ++y) {
    for (int x = -kSteps; x <= kSteps; ++x) {
      const Vec2 q = p + Vec2{static_cast<float>(x), static_cast<float>(y)} * (1.5f * w.cell_m / kSteps);
      if (!InsideObstacle(w, q) && DistanceToWalls_m(w, q) > w.person_radius_m - kByChoice_m - kNearlyAlike_m)
        return true;
    }
  }
  return false;
}

// By looking at every wall and house from every cell.
TEST(Walkable, IsFreeWhereNoHouseIsAndNoWallIsNear) {
  constexpr float kNearlyAlike_m = 0.01f;
  Random random{28};
  for (int town = 0; town < 20; ++town) {
    const Walkable w = JaggedTown(&random);
    int free = 0;
    for (int cell = 0; cell < static_cast<int>(w.cost.size()); ++cell) {
      const Vec2 p = CellCenter(w, cell);
      const float wall_m = DistanceToWalls_m(w, p);
      if (InsideObstacle(w, p) || std::max(std::abs(p.x), std::abs(p.y)) > 20) {
        // Where a person just fits through between two walls, the way is open though a cell's middle lies in one.
        const bool is_door = w.cost[static_cast<size_t>(cell)] == kGroundCost[3] * kNarrowCost && HasRoomAround(w, p);
        EXPECT_TRUE(!IsFree(w, p) || is_door) << p.x << " " << p.y;
      } else if (wall_m > w.person_radius_m + kNearlyAlike_m) {
        EXPECT_TRUE(IsFree(w, p)) << p.x << " " << p.y;
        ++free;
      }
      if (wall_m < w.person_radius_m) {
        EXPECT_LE(Clearance(w, cell, p), wall_m + kNearlyAlike_m);
      }
    }
    EXPECT_GT(free, 1000);
  }
}

TEST(NearEdges, PushToTheSamePlaceAsTheListOfWalls) {
  Random random{31};
  const Walkable w = JaggedTown(&random);
  NearEdges edges;
  int pushed = 0;
  for (int k = 0; k < 20000; ++k) {
    const Vec2 p{random.Uniform(-19, 19), random.Uniform(-19, 19)};
    const float radius_m = random.Uniform(0.1f, 0.5f);
    const int cell = CellAt(w, p);
    edges.LookAt(w, cell);
    const Vec2 expected = PushedOff(w, cell, p, radius_m), found = edges.PushedOff(p, radius_m);
    ASSERT_EQ(found.x, expected.x) << p.x << " " << p.y;
    ASSERT_EQ(found.y, expected.y) << p.x << " " << p.y;
    pushed += found.x != p.x ? 1 : 0;
  }
  EXPECT_GT(pushed, 1000);
}

// However they are pushed along the wall: they had been thrown off it as fast as they may walk.
TEST(KeepOffWalls, LetsWhoIsNearerThanTheirRadiusComeAwayLittleByLittle) {
  const Walkable w = Field();
  constexpr float kRadius_m = 0.3f, kWall_m = -3;  // the house's eastern
  for (const float off_m : {0.02f, 0.1f, 0.2f, 0.28f}) {
    Vec2 p{kWall_m + off_m, 0};
    for (int step = 0; step < 45; ++step) {
      const Vec2 to = KeepOffWalls(w, p, p + Vec2{0, 0.06f}, kRadius_m);
      EXPECT_LT(to.x - p.x, 0.015f);
      EXPECT_GE(to.x, p.x - 1e-4f);
      EXPECT_GT(to.y, p.y + 0.03f) << "and gets on";
      p = to;
    }
    EXPECT_GT(p.x, kWall_m + kRadius_m - 0.002f) << off_m;
  }
}

Crowd PeopleWhoCross(const Walkable& w, int count) {
  Crowd crowd;
  Random random{7};
  while (static_cast<int>(crowd.size()) < count) {
    Person p;
    p.position = {random.Uniform(-19, 19), random.Uniform(-19, 19)};
    p.top_mps = 1.9f;
    p.preferred_mps = random.Uniform(1.0f, 1.5f);
    if (!IsFree(w, p.position)) continue;
    bool taken = false;
    for (Vec2 other : crowd.position) taken = taken || Length(other - p.position) < 0.7f;
    if (taken) continue;
    p.field = FieldFor({p.position.x > 0 ? -18.0f : 18.0f, std::round(p.position.y / 8) * 8}, &crowd);
    AddPerson(p, &crowd);
    crowd.view.back() = ViewClass::kVisible;
  }
  return crowd;
}

TEST(Crowd, NobodyOverlapsWarpsOrEntersAnObstacle) {
  const Walkable w = Field();
  Crowd crowd = PeopleWhoCross(w, 120);
  for (int step = 0; step < 900; ++step) {
    const std::vector<Vec2> before = crowd.position;
    StepCrowd(w, {}, kStep_s, &scratch, &crowd);
    for (size_t i = 0; i < crowd.size(); ++i) {
      ASSERT_LE(Length(crowd.position[i] - before[i]), crowd.top_mps[i] * kStep_s * 1.001f + 1e-5f);
      ASSERT_FALSE(InsideObstacle(w, crowd.position[i])) << "person " << i << " at step " << step;
      for (size_t j = 0; j < i; ++j) {
        const float reach_m = crowd.radius_m[i] + crowd.radius_m[j];
        ASSERT_GT(Length(crowd.position[i] - crowd.position[j]), reach_m - 0.05f) << "step " << step;
      }
    }
  }
}

TEST(Crowd, OnePersonGoesRoundTheHouseToTheGoal) {
  const Walkable w = Field();
  Crowd crowd;
  Person p;
  p.position = {-15, 0};
  p.field = FieldFor({15, 0}, &crowd);
  AddPerson(p, &crowd);
  int step = 0;
  while (crowd.arrived[0] != Arrival::kThere && step < 3000) {
    StepCrowd(w, {}, kStep_s, &scratch, &crowd);
    ++step;
  }
  EXPECT_LT(static_cast<float>(step) * kStep_s, 1.25f * 31 / 1.3f) << "the way round is about 31 m at 1.3 m/s";
}

TEST(Crowd, WhoIsHeldUpBesideTheGoalIsNearIt) {
  const Walkable w = Field();
  const Vec2 goal{12, 0};
  Crowd crowd;
  Person p;
  p.position = {12, -12};
  p.field = FieldFor(goal, &crowd);
  AddPerson(p, &crowd);
  int step = 0;
  while (crowd.arrived[0] == Arrival::kNot && ++step < 900)
    StepCrowd(w, {{goal, 1.5f, true}}, kStep_s, &scratch, &crowd);
  EXPECT_EQ(crowd.arrived[0], Arrival::kNear) << "the visitor stands there";
  EXPECT_LE(Length(crowd.position[0] - goal), kNearArrival_m);
  while (crowd.arrived[0] != Arrival::kThere && ++step < 1200) StepCrowd(w, {}, kStep_s, &scratch, &crowd);
  EXPECT_EQ(crowd.arrived[0], Arrival::kThere) << "the visitor has left";
}

// A visitor who wants to pass had somebody between them and a tree, who stood there for seconds.
TEST(Crowd, NobodyIsPinnedBetweenTheVisitorAndATree) {
  Walkable w;
  w.ground = Share({{-10, -10}, 0.5f, 40, 40, std::vector<float>(1600, 0), std::vector<uint8_t>(1600, 3)});
  w.circles.push_back({{0, 0}, 0.3f});
  BuildWalkable(0.3f, &w);
  Random random{5};
  for (int k = 0; k < 300; ++k) {
    const float from_tree_rad = random.Uniform(-kPi, kPi), to_visitor_rad = from_tree_rad + random.Uniform(-0.5f, 0.5f);
    Crowd crowd;
    Person p;
    p.position = DirectionOf(from_tree_rad) * 0.551f;
    p.field = FieldFor(DirectionOf(random.Uniform(-kPi, kPi)) * 8, &crowd);
    AddPerson(p, &crowd);
    crowd.view[0] = ViewClass::kVisible;
    const Vec2 wish = DirectionOf(to_visitor_rad + kPi + random.Uniform(-0.7f, 0.7f)) * 3.8f;
    const MovingObstacle visitor{p.position + DirectionOf(to_visitor_rad) * 0.851f, 0.6f, true, wish};
    for (int step = 0; step < 90; ++step) StepCrowd(w, {visitor}, kStep_s, &scratch, &crowd);
    const Vec2 off = crowd.position[0] - visitor.center;
    const bool bars_the_way = Length(off) < 1 && Dot(off, wish) > 0.5f * Length(wish);
    EXPECT_FALSE(bars_the_way) << "case " << k;
  }
}

TEST(Crowd, AGoalBehindWallsIsUnreachable) {
  Walkable w = Field();
  w.polygons.push_back({{{5, -0.75f}, {5.3f, -0.75f}, {5.3f, 0.75f}, {5, 0.75f}}, {}});
  BuildWalkable(0.3f, &w);
  EXPECT_FALSE(Reachable(w, BuildFlowField(w, {15, 0}), {-15, 0}));
  EXPECT_TRUE(Reachable(w, BuildFlowField(w, {-15, 10}), {-15, 0}));
}

TEST(Crowd, TheSameRunGivesTheSameState) {
  const Walkable w = Field();
  Crowd a = PeopleWhoCross(w, 80), b = PeopleWhoCross(w, 80);
  for (int step = 0; step < 200; ++step) {
    StepCrowd(w, {}, kStep_s, &scratch, &a);
    StepCrowd(w, {}, kStep_s, &scratch, &b);
  }
  EXPECT_EQ(StateHash(a), StateHash(b));
}

// How far people lie apart who follow each other in memory.
float ApartInMemory_m(const Crowd& crowd) {
  float sum_m = 0;
  for (size_t i = 1; i < crowd.size(); ++i) sum_m += Length(crowd.position[i] - crowd.position[i - 1]);
  return sum_m / static_cast<float>(crowd.size() - 1);
}

// Also where the way leads to and fro across the border of the goal's cell.
TEST(Crowd, WhoeverIsOutOfSightArrivesAsWell) {
  const Walkable w = Field();
  const Vec2 goal = CellCenter(w, CellAt(w, {14, 2}));
  for (int k = 0; k < 60; ++k) {
    Crowd crowd;
    Person p;
    p.position = goal + Vec2{1 + 0.013f * static_cast<float>(k), 0.16f};
    p.preferred_mps = 0.88f;
    p.field = FieldFor(goal, &crowd);
    AddPerson(p, &crowd);  // seen by nobody
    BuildField(w, p.field, &crowd);
    int steps = 0;
    while (crowd.arrived[0] != Arrival::kThere && steps < 600) StepCrowd(w, {}, kStep_s, &scratch, &crowd), ++steps;
    EXPECT_LT(steps, 600) << "from " << p.position.x << ' ' << p.position.y;
  }
}

TEST(Crowd, SortedBySpaceEverybodyStaysWhoTheyAre) {
  const Walkable w = Field();
  Crowd crowd = PeopleWhoCross(w, 200);
  for (int k = 20; k < 80; k += 3) AddGroup({k, k + 1, k + 2}, &crowd);
  for (int step = 0; step < 30; ++step) StepCrowd(w, {}, kStep_s, &scratch, &crowd);
  const Crowd before = crowd;
  SortBySpace(&scratch, &crowd);
  EXPECT_LT(ApartInMemory_m(crowd), 0.25f * ApartInMemory_m(before));
  for (size_t i = 0; i < crowd.size(); ++i) {
    const size_t was = static_cast<size_t>(crowd.id[i]);  // nobody has left
    EXPECT_EQ(Length(crowd.position[i] - before.position[was]), 0);
    EXPECT_EQ(Length(crowd.velocity[i] - before.velocity[was]), 0);
    EXPECT_EQ(crowd.field[i], before.field[was]);
    EXPECT_EQ(crowd.walked_m[i], before.walked_m[was]);
    EXPECT_EQ(crowd.mind[i].asked_mps, before.mind[was].asked_mps);
    ASSERT_EQ(crowd.group[i], before.group[was]);
    if (crowd.group[i] < 0) continue;
    const Group &now = crowd.groups[static_cast<size_t>(crowd.group[i])],
                &then = before.groups[static_cast<size_t>(crowd.group[i])];
    for (int m = 0; m < now.size; ++m) EXPECT_EQ(crowd.id[static_cast<size_t>(now.member[m])], then.member[m]);
  }
}

TEST(Crowd, NobodyEntersTheVisitorsPersonalSpace) {
  const Walkable w = Field();
  Crowd crowd = PeopleWhoCross(w, 80);
  const MovingObstacle visitor{{12, 0}, 0.6f, true};
  std::vector<char> outside(crowd.size(), 0);
  for (int step = 0; step < 600; ++step) {
    StepCrowd(w, {visitor}, kStep_s, &scratch, &crowd);
    for (size_t i = 0; i < crowd.size(); ++i) {
      const float distance_m = Length(crowd.position[i] - visitor.center);
      if (outside[i]) {
        ASSERT_GE(distance_m, 0.6f);
      }
      if (distance_m > 0.6f + crowd.radius_m[i]) outside[i] = 1;
    }
  }
}

// The guide has a disc too, and whoever passes presses besides.
TEST(Crowd, NobodyIsPressedIntoTheVisitorsPersonalSpaceByWhoStandsBehindThem) {
  Walkable w = Field();
  for (const float side : {-1.0f, 1.0f}) {
    w.polygons.push_back({{{-3, 0.32f * side}, {3, 0.32f * side}, {3, 2 * side}, {-3, 2 * side}}, {}});
  }
  BuildWalkable(0.3f, &w);
  Random random{3};
  for (int k = 0; k < 60; ++k) {
    Crowd crowd;
    const MovingObstacle visitor{{0, random.Uniform(-0.05f, 0.05f)}, 0.6f, true};
    const float off_m = random.Uniform(-0.05f, 0.05f);
    for (const float x : {0.87f, 2.2f}) {
      Person p;
      p.position = {x, random.Uniform(-0.05f, 0.05f)};
      p.field = FieldFor({random.Uniform(-1, 1) < 0 ? -9.0f : 9.0f, 0}, &crowd);
      AddPerson(p, &crowd);
      crowd.view.back() = ViewClass::kVisible;
    }
    for (int step = 0; step < 120; ++step) {
      const Vec2 guide{1.6f - 0.004f * static_cast<float>(step), off_m};
      StepCrowd(w, {visitor, {guide, 0.4f, true, {-0.12f, 0}, 0.25f}}, kStep_s, &scratch, &crowd);
      ASSERT_GT(Length(crowd.position[0] - visitor.center) - crowd.radius_m[0], 0.59f) << "case " << k << ' ' << step;
    }
  }
}

}  // namespace
}  // namespace flaneur
