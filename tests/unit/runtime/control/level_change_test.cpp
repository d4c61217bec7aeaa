// How people change their level: what a picture draws meanwhile, and that the budget is about all of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "runtime/base/random.h"
#include "runtime/control/level_control.h"

namespace flaneur {
namespace {

constexpr float kStep_s = 1.0f / 30;

// People ahead of a camera that looks east, near enough to be meshes of 9,000 triangles.
struct Stage {
  explicit Stage(int people) {
    for (int k = 0; k < people; ++k) {
      Person person;
      person.position = {5 + static_cast<float>(k), 0};
      AddPerson(person, &crowd);
    }
    crowd.view.assign(crowd.size(), ViewClass::kVisible);
  }
  void Step(int steps = 1) {
    for (int k = 0; k < steps; ++k) {
      ChooseLevels(crowd, avatars, settings, {ViewCamera{}, {}, 0}, &state);
      for (size_t i = 0; i < crowd.size(); ++i) crowd.was_visible[i] = crowd.view[i] == ViewClass::kVisible;
      EXPECT_LE(state.triangles + state.shadows.triangles, settings.budget_triangles);
    }
  }
  const PersonLevel& at(size_t i) const { return state.people[i]; }

  Crowd crowd;
  std::vector<AvatarCosts> avatars{{{{9000, 300}, {900, 0}}, 1.75f, 128}};
  ControlSettings settings;
  LevelState state;
};

TEST(LevelChange, BothLevelsCountWhileOneFadesIntoTheOther) {
  Stage s(1);
  s.Step();
  EXPECT_EQ(s.at(0), (PersonLevel{MeshLevel(0), kNotDrawn, kLongAgo_s})) << "comes with the first picture";
  s.settings.high_limit = 0;
  s.Step();
  EXPECT_EQ(s.at(0), (PersonLevel{kImpostor, MeshLevel(0), 0}));
  EXPECT_EQ(s.state.triangles, 9000 + kImpostorTriangles);
  float last_s = 0;
  while (IsDrawn(s.at(0).from)) {
    EXPECT_EQ(s.state.fading_triangles, 9000);
    s.Step();
    EXPECT_GT(s.at(0).age_s, last_s) << "and is over, sometime";
    last_s = s.at(0).age_s;
  }
  EXPECT_EQ(s.at(0).from, kNotDrawn);
  EXPECT_EQ(s.state.triangles, kImpostorTriangles);
}

// The picture showed the one in the middle for a while after the budget had stopped counting it.
TEST(LevelChange, WhoChangesTwiceSoonIsStillDrawnWithTwoLevelsThatBothCount) {
  for (int between = 1; between < 12; ++between) {
    Stage s(1);
    s.Step();
    s.settings.high_limit = 0;
    s.Step(between);
    s.settings.high_limit = 12;
    for (int k = 0; k < 15; ++k) {
      s.Step();
      const PersonLevel& p = s.at(0);
      const auto triangles = [](Level level) { return IsMesh(level) ? 9000 : IsDrawn(level) ? kImpostorTriangles : 0; };
      EXPECT_EQ(s.state.triangles, triangles(p.level) + triangles(p.from)) << between << " " << k;
    }
    EXPECT_EQ(s.at(0), (PersonLevel{MeshLevel(0), kNotDrawn, kLongAgo_s}));
  }
}

TEST(LevelChange, IsDoneAtOnceWhereTheBudgetHasNoRoomForBoth) {
  Stage s(2);
  s.settings.budget_triangles = 24000;
  s.avatars[0].shadow = {};
  s.Step();
  s.settings.high_limit = 0;
  s.Step();
  EXPECT_EQ(s.state.fading_triangles, 18000);
  s.settings.budget_triangles = 12000;  // it falls: nothing fades any more
  s.Step();
  EXPECT_EQ(s.state.fading_triangles, 0);
  for (size_t i = 0; i < 2; ++i) EXPECT_EQ(s.at(i), (PersonLevel{kImpostor, kNotDrawn, kLongAgo_s}));
  s.settings.high_limit = 1;
  s.settings.budget_triangles = 9003;  // the mesh and the other's impostor, and no more than one triangle
  s.Step();
  EXPECT_EQ(s.at(0), (PersonLevel{MeshLevel(0), kNotDrawn, kLongAgo_s}));
}

TEST(LevelChange, WhoLeavesTheTownInViewFadesWhereTheyWereAndCountsMeanwhile) {
  Stage s(2);
  s.Step();
  const int slot = s.crowd.slot[0];
  RemovePerson(0, &s.crowd);
  s.Step();
  ASSERT_EQ(s.state.gone.size(), 1u);
  EXPECT_EQ(s.state.gone[0].slot, slot);
  EXPECT_EQ(s.state.gone[0].level, (PersonLevel{kNotDrawn, MeshLevel(0), 0}));
  EXPECT_EQ(s.state.triangles, 18000);
  s.Step(static_cast<int>(kFade_s / kStep_s) + 3);
  EXPECT_TRUE(s.state.gone.empty());
  EXPECT_EQ(s.state.triangles, 9000);
}

TEST(LevelChange, WhoLeavesTheViewIsGoneAtOnceAndSoIsWhatFadedOfThem) {
  Stage s(1);
  s.Step();
  s.settings.high_limit = 0;
  s.Step();
  s.crowd.view[0] = ViewClass::kOutside;
  s.Step();
  EXPECT_FALSE(IsDrawn(s.at(0)));
  EXPECT_EQ(s.state.triangles, 0);
  EXPECT_TRUE(s.state.gone.empty());
}

TEST(LevelChange, FartherThanAnybodyIsDrawnPeopleFadeOutAndIn) {
  Stage s(1);
  s.settings.r_far_m = 50;
  s.Step();
  s.crowd.position[0] = {50.1f, 0};
  s.Step();
  EXPECT_EQ(s.at(0), (PersonLevel{kNotDrawn, MeshLevel(0), 0}));
  s.Step(15);
  EXPECT_FALSE(IsDrawn(s.at(0)));
  s.crowd.position[0] = {49.9f, 0};
  s.Step();
  EXPECT_EQ(s.at(0).age_s, 0);
  EXPECT_EQ(s.at(0).from, kNotDrawn);
  EXPECT_TRUE(IsDrawn(s.at(0).level));
}

// Twenty who mill about at 3 to 9 m, for a minute, with a budget for half of what they would get where there is plenty.
// The first in order got all of it, so that the last changed with every step they took past each other.
TEST(LevelChange, WhereTheBudgetIsShortPeopleWhoMillAboutKeepTheirLevels) {
  Stage s(20);
  s.avatars[0].levels = {{9000, 300}, {4500, 150}, {2200, 75}, {900, 0}};
  s.settings.high_limit = 20;
  s.settings.budget_triangles = 75000;
  const auto mill = [&](float time_s) {
    for (int k = 0; k < 20; ++k) {
      const float phase = 2.4f * static_cast<float>(k);
      s.crowd.position[static_cast<size_t>(k)] = {
          3 + 0.28f * static_cast<float>(k) + 0.6f * std::sin(0.7f * time_s + phase), std::cos(time_s + phase)};
    }
  };
  int switches = 0, fewest = 20;
  for (int step = 0; step < 70 * 30; ++step) {
    mill(static_cast<float>(step) * kStep_s);
    s.Step();
    if (step < 10 * 30) continue;  // until it has found what fits
    switches += s.state.switches_in_view;
    fewest = std::min(fewest, s.state.meshes);
  }
  EXPECT_LE(switches, 20) << "one a person and minute";
  EXPECT_EQ(fewest, 20) << "nobody near is an impostor for lack of budget while others have more than they need";
}

// A visitor who turns on the spot in a throng, thrice as many in view as there may be meshes: who comes into view near
// is served with a mesh, before anybody sees them change, and hardly anybody changes while they pass.
TEST(LevelChange, WhoTurnsInAThrongSeesFewPeopleChange) {
  Stage s(0);
  Random random{4};
  for (int k = 0; k < 240; ++k) {
    Person person;
    const float around = 2 * kPi * random.Uniform(), away_m = 1.5f + 10.5f * std::sqrt(random.Uniform());
    person.position = {away_m * std::cos(around), away_m * std::sin(around)};
    AddPerson(person, &s.crowd);
  }
  s.settings.high_limit = 14;
  ViewCamera camera;
  constexpr float kTurns_radps = 0.4f;
  int switches = 0, seen = 0, near = 0, near_meshes = 0;
  for (int step = 0; step < 70 * 30; ++step) {
    camera.yaw_rad = std::remainder(camera.yaw_rad + kTurns_radps * kStep_s, 2 * kPi);
    for (size_t i = 0; i < s.crowd.size(); ++i) {
      s.crowd.was_visible[i] = s.crowd.view[i] == ViewClass::kVisible;
      s.crowd.view[i] = Classify(s.crowd.position[i], s.crowd.reach_m[i], camera, 10);
    }
    ChooseLevels(s.crowd, s.avatars, s.settings, {camera, {{}, kTurns_radps}, 0}, &s.state);
    ASSERT_LE(s.state.meshes, s.settings.high_limit);
    if (step < 10 * 30) continue;  // until it has found how far meshes reach
    switches += s.state.switches_in_view;
    for (size_t i = 0; i < s.crowd.size(); ++i) {
      if (s.crowd.view[i] != ViewClass::kVisible) continue;
      ++seen;
      if (Length(s.crowd.position[i]) > 3.5f) continue;
      ++near, near_meshes += IsMesh(s.at(i).level);
    }
  }
  const float minutes = static_cast<float>(seen) * kStep_s / 60;
  EXPECT_GT(seen, 30 * 1800) << "it is a throng";
  EXPECT_LE(static_cast<float>(switches), 2 * minutes);
  EXPECT_GE(near_meshes, 9 * near / 10) << "who is nearest is drawn best";
}

// As many arrivals as ten hours of a busy square have: what is kept about people grows with how many there are at once,
// not with how many there have been.
TEST(LevelChange, TenHoursOfArrivalsKeepMemoryFlat) {
  Stage s(40);
  s.avatars[0].props = {{"hat", 0.5f, "", 10}};
  const auto kept = [&] {
    return s.crowd.slots.owner.capacity() + s.state.memory.capacity() + s.state.props.memory.capacity() +
           s.state.people.capacity() + s.state.drawn.capacity() + s.state.drawn_before.capacity() +
           s.state.gone.capacity() + s.crowd.id.capacity();
  };
  Random random{7};
  size_t after_an_hour = 0;
  constexpr int kArrivalsAnHour = 3600;
  for (int arrival = 0; arrival < 10 * kArrivalsAnHour; ++arrival) {
    RemovePerson(static_cast<size_t>(random.Below(static_cast<int>(s.crowd.size()))), &s.crowd);
    Person person;
    person.position = {random.Uniform(2, 60), random.Uniform(-5, 5)};
    AddPerson(person, &s.crowd);
    s.crowd.view.back() = ViewClass::kVisible;
    s.Step();
    for (size_t i = 0; i < s.crowd.size(); ++i)
      ASSERT_EQ(s.crowd.slots.owner[static_cast<size_t>(s.crowd.slot[i])], s.crowd.id[i]);
    if (arrival == kArrivalsAnHour) after_an_hour = kept();
  }
  EXPECT_EQ(kept(), after_an_hour);
  EXPECT_EQ(s.crowd.next_id, 40 + 10 * kArrivalsAnHour);
}

}  // namespace
}  // namespace flaneur
