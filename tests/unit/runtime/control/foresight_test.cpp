#include "runtime/control/foresight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "runtime/base/random.h"

namespace flaneur {
namespace {

Walkable OpenField() {
  Walkable w;
  w.ground = Share({{-60, -60}, 0.5f, 240, 240, std::vector<float>(57600, 0), std::vector<uint8_t>(57600, 3)});
  BuildWalkable(0.3f, &w);
  return w;
}

// All walk west, where the camera at the origin looks at them.
void AddWalker(Vec2 at, Crowd* crowd) {
  Person p;
  p.position = at;
  p.field = FieldFor({-50, at.y}, crowd);
  AddPerson(p, crowd);
  crowd->way.back() = {-1, 0};
  crowd->view.back() = ViewClass::kVisible;
}

int Detours(const Crowd& crowd) {
  return static_cast<int>(std::count_if(crowd.detour_s.begin(), crowd.detour_s.end(), [](float s) { return s > 0; }));
}

TEST(Foresight, LeavesEverybodyAloneWhileThereIsRoom) {
  const Walkable w = OpenField();
  Crowd crowd;
  for (int i = 0; i < 8; ++i) AddWalker({12.0f + static_cast<float>(i % 4), static_cast<float>(i) - 4}, &crowd);
  ForesightState state;
  for (int step = 0; step < 30; ++step)
    Foresee(ViewCamera{}, {}, w, ControlSettings{}, ControlSettings{}.high_limit, &crowd, &state);
  // Those who would walk into the visitor give way; the others go on.
  for (size_t i = 0; i < crowd.size(); ++i) {
    const bool meets_visitor = std::abs(crowd.position[i].y) < 1.5f;
    EXPECT_TRUE(meets_visitor || crowd.detour_s[i] <= 0) << i;
  }
}

TEST(Foresight, SomeOfTooManyTurnAsideBeforeTheyComeNear) {
  const Walkable w = OpenField();
  Crowd crowd;
  for (int i = 0; i < 30; ++i)
    AddWalker({13.0f + static_cast<float>(i / 10), static_cast<float>(i % 10) - 4.5f}, &crowd);
  ForesightState state;
  Foresee(ViewCamera{}, {}, w, ControlSettings{}, ControlSettings{}.high_limit, &crowd, &state);
  EXPECT_GT(Detours(crowd), 10);
  EXPECT_LT(Detours(crowd), 30) << "who fits may come";
  for (size_t i = 0; i < crowd.size(); ++i) {
    if (crowd.detour_s[i] <= 0) continue;
    EXPECT_LE(Length(crowd.detour[i]), crowd.top_mps[i] + 1e-4f);
    EXPECT_TRUE(IsFree(w, crowd.position[i] + crowd.detour[i]));
  }
}

TEST(Foresight, NobodyIsSentIntoAWall) {
  Walkable w = OpenField();
  w.polygons.push_back({{{8, 6}, {30, 6}, {30, 7}, {8, 7}}, {}});
  w.polygons.push_back({{{8, -7}, {30, -7}, {30, -6}, {8, -6}}, {}});
  BuildWalkable(0.3f, &w);
  Random random{3};
  for (int round = 0; round < 20; ++round) {
    Crowd crowd;
    for (int i = 0; i < 40; ++i) AddWalker({random.Uniform(9, 25), random.Uniform(-5, 5)}, &crowd);
    ForesightState state;
    Foresee(ViewCamera{}, {}, w, ControlSettings{}, ControlSettings{}.high_limit, &crowd, &state);
    for (size_t i = 0; i < crowd.size(); ++i) {
      EXPECT_TRUE(crowd.detour_s[i] <= 0 || IsFree(w, crowd.position[i] + crowd.detour[i]));
    }
  }
}

TEST(Foresight, OutOfReachNobodyIsTouched) {
  const Walkable w = OpenField();
  Crowd crowd;
  for (int i = 0; i < 60; ++i) AddWalker({40.0f + static_cast<float>(i / 10), static_cast<float>(i % 10)}, &crowd);
  ForesightState state;
  Foresee(ViewCamera{}, {}, w, ControlSettings{}, ControlSettings{}.high_limit, &crowd, &state);
  EXPECT_EQ(Detours(crowd), 0);
}

// How many of 60 who walk by at this distance from a visitor with a full view keep farther out.
int MindingAt(float away_m) {
  const Walkable w = OpenField();
  Crowd crowd;
  for (int i = 0; i < 30; ++i) {
    AddWalker({5.0f + 0.7f * static_cast<float>(i / 6), 0.7f * static_cast<float>(i % 6) - 2}, &crowd);
    crowd.field.back() = -1;
  }
  for (int i = 0; i < 60; ++i) {
    AddWalker({away_m, 0.1f * static_cast<float>(i % 10)}, &crowd);
    crowd.way.back() = {0, 1};
  }
  ForesightState state;
  Foresee(ViewCamera{}, {}, w, ControlSettings{}, ControlSettings{}.high_limit, &crowd, &state);
  return Detours(crowd);
}

// All at one distance would stand in a ring there.
TEST(Foresight, PeopleKeepOutOfAFullViewEachAtTheirOwnDistance) {
  const float r_high_m = ControlSettings{}.r_high_m;
  const int near = MindingAt(1.07f * r_high_m), far = MindingAt(1.2f * r_high_m);
  EXPECT_GT(near, 20);
  EXPECT_GT(far, 5);
  EXPECT_LT(far, near);
  EXPECT_EQ(MindingAt(1.45f * r_high_m), 0);
}

}  // namespace
}  // namespace flaneur
