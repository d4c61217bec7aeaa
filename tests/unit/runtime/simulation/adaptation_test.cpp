// What adaptation is for, over whole runs: fewer frames with too many people near, and nobody hindered by it.
#include <gtest/gtest.h>

#include "runtime/simulation/simulation.h"

namespace flaneur {
namespace {

constexpr float kHalf_m = 20;
constexpr int kSteps = 1500;

// A square with 160 strollers and a visitor who walks across it again and again.
Scenario Square(Adaptation adaptation, float speed_mps, uint64_t seed) {
  Random random{seed};
  const auto anywhere = [&] {
    return Vec2{random.Uniform(-kHalf_m + 1, kHalf_m - 1), random.Uniform(-kHalf_m + 1, kHalf_m - 1)};
  };
  Scenario s;
  s.control.adaptation = adaptation;
  s.control.high_limit = 12;
  s.control.r_high_m = 10;
  s.has_ground = s.has_camera = true;
  s.ground_min_m = {-kHalf_m, -kHalf_m};
  s.ground_max_m = {kHalf_m, kHalf_m};
  s.camera_position_m = {-15, -15};
  for (int k = 0; k < 12; ++k) {
    CameraLeg leg;
    leg.kind = CameraLeg::Kind::kWalk;
    leg.to_m = anywhere();
    leg.speed_mps = speed_mps;
    s.legs.push_back(leg);
  }
  for (int row = 0; row < 13; ++row) {
    for (int column = 0; column < 13; ++column) {
      ScenarioPerson p;
      p.position_m = {-kHalf_m + 1.5f + 2.9f * static_cast<float>(column),
                      -kHalf_m + 2.2f + 2.8f * static_cast<float>(row)};
      if (Length(p.position_m - s.camera_position_m) < 2) continue;
      for (int g = 0; g < 10; ++g) p.goals_m.push_back(anywhere());
      p.stay = true;
      s.persons.push_back(p);
    }
  }
  return s;
}

struct Outcome {
  int exceeded = 0, over_budget = 0;
  float asked_m = 0, walked_m = 0, longest_step = 0;
  double accelerations_mps2 = 0;  // summed over whoever is seen near, as what follows
  int seen = 0;

  double MeanAcceleration_mps2() const { return accelerations_mps2 / std::max(1, seen); }
};

Outcome Played(const Scenario& scenario) {
  Simulation s;
  const Error e = StartSimulation(nullptr, scenario, &s);
  EXPECT_FALSE(e) << e.message;
  Outcome out;
  std::map<int, Vec2> before, velocity;  // by id
  for (int step = 0; step < kSteps && !s.visitor.finished; ++step) {
    for (size_t i = 0; i < s.town.crowd.size(); ++i) {
      before[s.town.crowd.id[i]] = s.town.crowd.position[i];
      velocity[s.town.crowd.id[i]] = s.town.crowd.velocity[i];
    }
    StepSimulation({}, 0, &s);
    out.exceeded += s.control.levels.exceeded;
    out.over_budget += s.control.levels.triangles > static_cast<int64_t>(s.control.settings.budget_triangles);
    out.asked_m += s.visitor.camera.asked_mps * Step_s(s);
    out.walked_m += s.visitor.camera.actual_mps * Step_s(s);
    for (size_t i = 0; i < s.town.crowd.size(); ++i) {
      if (s.town.crowd.view[i] != ViewClass::kVisible) continue;
      const float step_m = Length(s.town.crowd.position[i] - before[s.town.crowd.id[i]]);
      out.longest_step = std::max(out.longest_step, step_m / (s.town.crowd.top_mps[i] * Step_s(s)));
      if (Length(s.town.crowd.position[i] - s.visitor.camera.view.position) > s.control.settings.r_high_m) continue;
      out.accelerations_mps2 += Length(s.town.crowd.velocity[i] - velocity[s.town.crowd.id[i]]) / Step_s(s);
      ++out.seen;
    }
  }
  return out;
}

class CrowdOfASquare : public testing::TestWithParam<float> {};

TEST_P(CrowdOfASquare, WithoutDiscretionFewFramesExceedTheLimitAndTheVisitorGetsOn) {
  int off = 0, full = 0;
  float asked_m = 0, walked_m = 0;
  for (uint64_t seed = 1; seed <= 20; ++seed) {  // of fewer the figures differ by half
    off += Played(Square(Adaptation::kOff, GetParam(), seed)).exceeded;
    Scenario strict = Square(Adaptation::kFull, GetParam(), seed);
    strict.control.discretion = 0;
    const Outcome o = Played(strict);
    full += o.exceeded;
    EXPECT_EQ(o.over_budget, 0);
    EXPECT_LE(o.longest_step, 1.001f);
    asked_m += o.asked_m, walked_m += o.walked_m;
  }
  RecordProperty("exceeded_off", off);
  RecordProperty("exceeded_full", full);
  EXPECT_GT(off, 100) << "the square is crowded enough to matter";
  EXPECT_LE(full, off / 5);
  EXPECT_GT(walked_m, 0.8f * asked_m);
}

TEST_P(CrowdOfASquare, WithDiscretionPeopleStayNearbyAndWalkAsFreeOnesDo) {
  Outcome off, full, strict;
  const auto add = [](const Outcome& o, Outcome* sum) {
    sum->exceeded += o.exceeded, sum->over_budget += o.over_budget;
    sum->accelerations_mps2 += o.accelerations_mps2, sum->seen += o.seen;
  };
  for (const uint64_t seed : {1, 2, 3, 4, 5}) {
    add(Played(Square(Adaptation::kOff, GetParam(), seed)), &off);
    Scenario s = Square(Adaptation::kFull, GetParam(), seed);
    add(Played(s), &full);
    s.control.discretion = 0;
    add(Played(s), &strict);
  }
  EXPECT_EQ(full.over_budget, 0);
  EXPECT_LE(full.exceeded, off.exceeded / 2);
  EXPECT_LT(full.MeanAcceleration_mps2(), 1.2 * off.MeanAcceleration_mps2());
  EXPECT_GT(full.seen, 1.1 * strict.seen) << "the foreground is not emptied";
  EXPECT_LT(full.seen, off.seen);
}

TEST(Discretion, TheFirstPictureKeepsTheLimitWhereTheTownIsFull) {
  int off = 0, full = 0;
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    for (const Adaptation adaptation : {Adaptation::kOff, Adaptation::kFull}) {
      Scenario s = Square(adaptation, 1.9f, seed);
      s.persons.clear();
      s.crowd.people = 300;
      s.control.high_limit = 10;
      s.crowd.seed = seed;
      s.camera_position_m = {0, 0};
      s.camera_yaw_deg = 36 * static_cast<float>(seed);
      Simulation simulation;
      const Error e = StartSimulation(nullptr, s, &simulation);
      ASSERT_FALSE(e) << e.message;
      StepSimulation({}, 0, &simulation);
      EXPECT_GE(simulation.town.crowd.size(), 290u);
      (adaptation == Adaptation::kOff ? off : full) += simulation.control.levels.exceeded;
    }
  }
  EXPECT_GE(off, 3) << "the square is crowded enough to matter";
  EXPECT_EQ(full, 0);
}

// As a market is: more people than the limit allows in any view, and nowhere else to go. The first picture keeps it
// still.
TEST(Discretion, TheFirstPictureKeepsTheLimitInAThrong) {
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    Scenario s = Square(Adaptation::kFull, 1.9f, seed);
    s.persons.clear();
    s.crowd.people = 120;
    s.crowd_area = Area{{-9, -9}, {9, 9}};
    s.control.high_limit = 14;
    s.crowd.seed = seed;
    s.camera_position_m = {0, 0};
    s.camera_yaw_deg = 36 * static_cast<float>(seed);
    Simulation simulation;
    const Error e = StartSimulation(nullptr, s, &simulation);
    ASSERT_FALSE(e) << e.message;
    StepSimulation({}, 0, &simulation);
    EXPECT_GE(simulation.town.crowd.size(), 115u);
    EXPECT_FALSE(simulation.control.levels.exceeded) << "seed " << seed;
  }
}

TEST(PersonalSpace, IsKeptWhereTheVisitorTurnsInADenseSquare) {
  Scenario scenario = Square(Adaptation::kOff, 1.9f, 1);
  scenario.camera_position_m = {0, 0};
  scenario.legs.assign(1, {});
  scenario.legs[0].kind = CameraLeg::Kind::kTurn;
  scenario.legs[0].turn_deg = 3600;
  scenario.legs[0].rate_dps = 90;
  for (size_t k = 0; k < scenario.persons.size(); ++k) {
    Vec2& p = scenario.persons[k].position_m;
    p = p * 0.3f;
    if (Length(p) < 1.5f) p = p + Vec2{12, 0.3f};
    for (Vec2& goal : scenario.persons[k].goals_m) goal = goal * 0.3f;
  }
  Simulation s;
  const Error e = StartSimulation(nullptr, scenario, &s);
  ASSERT_FALSE(e) << e.message;
  for (int step = 0; step < 900; ++step) {
    StepSimulation({}, 0, &s);
    for (Vec2 p : s.town.crowd.position) ASSERT_GE(Length(p), s.control.settings.r_personal_m) << "step " << step;
  }
}

INSTANTIATE_TEST_SUITE_P(AtWalkingPaceAndTwiceAsFast, CrowdOfASquare, testing::Values(1.9f, 3.8f));

}  // namespace
}  // namespace flaneur
