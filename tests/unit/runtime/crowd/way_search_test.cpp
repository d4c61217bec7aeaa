// Ways of people with goals of their own: they get there, about as quickly as by the field, however many ask at once.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/crowd/crowd.h"
#include "runtime/crowd/field_builder.h"
#include "runtime/crowd/walls.h"

namespace flaneur {
namespace {

CrowdScratch scratch;
constexpr float kStep_s = 1.0f / 30;

// 60 x 60 m of pavement, a carriageway across it, and walls with gaps at alternating ends: a labyrinth.
Walkable Labyrinth() {
  Walkable w;
  GroundRaster ground;
  ground.cell_m = 1;
  ground.columns = ground.rows = 60;
  ground.height_m.assign(3600, 0);
  ground.kind.assign(3600, 2);
  for (int y = 28; y < 32; ++y) std::fill_n(ground.kind.begin() + y * 60, 60, uint8_t{1});
  w.ground = Share(std::move(ground));
  for (int k = 0; k < 5; ++k) {
    const float x = 10 + 10 * static_cast<float>(k), low = k % 2 ? 3.0f : 0.0f;
    w.polygons.push_back({{{x, low}, {x + 1, low}, {x + 1, low + 57}, {x, low + 57}}, {}});
  }
  w.circles.push_back({{5, 30}, 1.5f});
  BuildWalkable(0.3f, &w);
  return w;
}

// Metres walked along the ways from p until the goal is as good as reached; infinity where it never is.
template <typename Way>
float Walked_m(const Walkable& w, Vec2 p, Vec2 goal, Way way) {
  for (int step = 0; step < 20000; ++step) {
    if (Length(goal - p) < 0.4f) return 0.05f * static_cast<float>(step);
    p = KeepOffWalls(w, p, p + way(p, step) * 0.05f, 0.25f);
  }
  return INFINITY;
}

TEST(WaySearch, LeadsThereAndIsHardlyLongerThanTheBestWay) {
  const Walkable w = Labyrinth();
  Random random{4};
  WaySearch search;
  float searched_m = 0, best_m = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const auto somewhere = [&] {
      for (;;) {
        const Vec2 p{random.Uniform(1, 59), random.Uniform(1, 59)};
        if (IsFree(w, p)) return p;
      }
    };
    const Vec2 from = somewhere(), goal = somewhere();
    const FlowField field = BuildFlowField(w, goal);
    Corner corner;
    const float searched = Walked_m(
        w, from, goal, [&](Vec2 p, int step) { return WayByCorners(w, p, goal, step % 30 == 0, &corner, &search); });
    ASSERT_TRUE(std::isfinite(searched)) << from.x << ' ' << from.y << " to " << goal.x << ' ' << goal.y;
    searched_m += searched;
    best_m += Walked_m(w, from, goal, [&](Vec2 p, int) {
      return StraightWay(w, p, goal) ? (goal - p) * (1 / Length(goal - p)) : WayAt(w, field, p);
    });
  }
  EXPECT_LT(searched_m, 1.15f * best_m);
}

TEST(WaySearch, SaysWhereThereIsNoWay) {
  Walkable w = Labyrinth();
  w.polygons.push_back({{{30, 0}, {31, 0}, {31, 60}, {30, 60}}, {}});
  BuildWalkable(0.3f, &w);
  WaySearch search;
  Corner corner;
  const Vec2 way = WayByCorners(w, {2, 2}, {58, 58}, true, &corner, &search);
  EXPECT_EQ(way.x, 0);
  EXPECT_EQ(way.y, 0);
}

TEST(WaySearch, AThousandNewGoalsAreGrantedInTheSameStepAndReached) {
  const Walkable w = Labyrinth();
  Random random{8};
  Crowd crowd;
  for (int k = 0; k < 1000;) {
    Person p;
    p.position = {random.Uniform(1, 59), random.Uniform(1, 59)};
    const Vec2 goal{random.Uniform(1, 59), random.Uniform(1, 59)};
    if (!IsFree(w, p.position) || !IsFree(w, goal)) continue;
    p.field = FieldFor(goal, &crowd);
    AddPerson(p, &crowd);
    ++k;
  }
  std::fill(crowd.view.begin(), crowd.view.end(), ViewClass::kOutside);
  StepCrowd(w, {}, kStep_s, &scratch, &crowd);
  for (size_t i = 0; i < crowd.size(); ++i) EXPECT_GT(Length(crowd.way[i]), 0.5f);
  std::vector<char> reached(crowd.size(), 0);
  for (int step = 0; step < 30 * 300; ++step) {
    StepCrowd(w, {}, kStep_s, &scratch, &crowd);
    for (size_t i = 0; i < crowd.size(); ++i) {
      if (crowd.arrived[i] == Arrival::kThere) reached[i] = 1, SetGoal(i, -1, &crowd);
    }
  }
  EXPECT_EQ(std::count(reached.begin(), reached.end(), 1), 1000);
  for (const FlowField& field : crowd.fields) EXPECT_FALSE(IsBuilt(field)) << "a field of its own for one person";
}

TEST(WaySearch, AGoalThatManyShareGetsAField) {
  const Walkable w = Labyrinth();
  Crowd crowd;
  for (int k = 0; k < 20; ++k) {
    Person p;
    p.position = {2, 2 + static_cast<float>(k)};
    p.field = FieldFor({57, 57}, &crowd);
    AddPerson(p, &crowd);
  }
  StepCrowd(w, {}, kStep_s, &scratch, &crowd);
  EXPECT_TRUE(IsBuilt(crowd.fields[0]));
}

TEST(WaySearch, AFieldThatNobodyGoesByIsLetGoAndComesBack) {
  const Walkable w = Labyrinth();
  Crowd crowd;
  for (int k = 0; k < 20; ++k) {
    Person p;
    p.position = {2, 2 + static_cast<float>(k)};
    p.field = FieldFor({57, 57}, &crowd);
    AddPerson(p, &crowd);
  }
  const int shared = crowd.field[0];
  const auto go = [&](int field, int steps) {
    for (size_t i = 0; i < crowd.size(); ++i) SetGoal(i, field, &crowd);
    for (int step = 0; step < steps; ++step) StepCrowd(w, {}, kStep_s, &scratch, &crowd);
  };
  go(shared, 2 * 300);
  EXPECT_TRUE(IsBuilt(crowd.fields[0]));
  go(-1, 3 * 300);
  EXPECT_FALSE(IsBuilt(crowd.fields[0])) << "it would take its memory for ever";
  go(shared, 1);
  EXPECT_TRUE(IsBuilt(crowd.fields[0]));
}

// The first step after which each field is there.
std::vector<int> BuiltAfter(const Walkable& w, Jobs* jobs, uint64_t* state) {
  Crowd crowd;
  crowd.fields_come_later = true;
  for (int k = 0; k < 60; ++k) {
    Person p;
    p.position = {2 + static_cast<float>(k / 20), 2 + static_cast<float>(k % 20)};
    p.field = FieldFor({57, 50 + static_cast<float>(k / 20)}, &crowd);
    AddPerson(p, &crowd);
  }
  FieldBuilder builder;
  std::vector<int> built(crowd.fields.size(), -1);
  for (int step = 0; step < 30; ++step) {
    builder.Step(w, jobs, &crowd);
    StepCrowd(w, {}, kStep_s, &scratch, &crowd);
    for (size_t f = 0; f < built.size(); ++f) built[f] = built[f] < 0 && IsBuilt(crowd.fields[f]) ? step : built[f];
    for (size_t i = 0; i < crowd.size(); ++i)
      EXPECT_GT(Length(crowd.way[i]), 0.5f) << "everybody knows their way all the time";
  }
  *state = StateHash(crowd);
  return built;
}

TEST(WaySearch, FieldsThatComeLaterComeOneAfterTheOtherInTheSameStepsWithAnyNumberOfThreads) {
  const Walkable w = Labyrinth();
  uint64_t first = 0;
  const std::vector<int> built = BuiltAfter(w, nullptr, &first);
  ASSERT_EQ(built.size(), 3u);
  for (size_t f = 0; f < built.size(); ++f) EXPECT_GT(built[f], f == 0 ? 0 : built[f - 1]);
  for (size_t threads : {0, 1, 2, 4}) {
    Jobs jobs(threads);
    uint64_t state = 0;
    EXPECT_EQ(BuiltAfter(w, &jobs, &state), built) << threads;
    EXPECT_EQ(state, first) << threads;
  }
}

TEST(FlowField, IsTheSameInSlicesOfAnySize) {
  const Walkable w = Labyrinth();
  const Vec2 goal{57, 57};
  const FlowField whole = BuildFlowField(w, goal);
  const int64_t all = CellsToGoOver(w);
  for (int64_t slices : {1, 3, 50}) {
    FieldBuild build{{goal, {}}, {}, {}};
    int64_t needed = 1;
    while (!BuildFurther(w, 1 + all / slices, &build)) ++needed;
    EXPECT_LE(needed, slices) << "a slice went over less than it may";
    ASSERT_EQ(build.field.tiles.size(), whole.tiles.size());
    EXPECT_EQ(std::memcmp(build.field.tiles.data(), whole.tiles.data(), whole.tiles.size() * sizeof(DirectionTile)), 0);
  }
}

// Without threads nobody may stand still for a whole field: when it is taken over it has been built already, in parts.
TEST(FlowField, IsDoneByTheStepThatTakesItWithoutThreads) {
  const Walkable w = Labyrinth();
  const int64_t takes_steps = 4;
  FieldBuild build{{{57, 57}, {}}, {}, {}};
  Job job = StartJob(nullptr, [&] { return BuildFurther(w, 1 + CellsToGoOver(w) / takes_steps, &build); });
  for (int64_t step = 0; step < takes_steps; ++step) {
    EXPECT_FALSE(job.Done()) << step;
    job.Advance();
  }
  EXPECT_TRUE(job.Done());
}

TEST(FlowField, MayBeUnderWayWhenItsTownGoes) {
  const Walkable w = Labyrinth();
  for (size_t threads : {0, 1, 4}) {
    Jobs jobs(threads);
    for (int round = 0; round < 20; ++round) {
      Crowd crowd;
      for (int k = 0; k < 6; ++k) FieldFor({50 + static_cast<float>(k), 57}, &crowd), crowd.asked_fields.push_back(k);
      FieldBuilder builder;
      builder.Step(w, &jobs, &crowd);
    }
  }
}

}  // namespace
}  // namespace flaneur
