// How people pass a visitor who stands somewhere, with any adaptation: behaviour towards a person, not adaptation.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "runtime/simulation/simulation.h"

namespace flaneur {
namespace {

constexpr float kHalf_m = 25, kBeforeLens_m = 1.15f;

// A square on which people want to walk right through where the visitor stands, one after the other, from every side.
Scenario Crossing(Adaptation adaptation, uint64_t seed) {
  Random random{seed};
  Scenario s;
  s.control.adaptation = adaptation;
  s.has_ground = s.has_camera = true;
  s.ground_min_m = {-kHalf_m, -kHalf_m};
  s.ground_max_m = {kHalf_m, kHalf_m};
  s.legs.assign(1, {});
  s.legs[0].wait_s = 90;
  for (int k = 0; k < 36; ++k) {
    const float angle = random.Uniform(-kPi, kPi), away_m = random.Uniform(6, kHalf_m - 1);
    ScenarioPerson p;
    p.position_m = Vec2{std::cos(angle), std::sin(angle)} * away_m;
    p.goals_m = {p.position_m * -1, p.position_m};
    p.stay = true;
    s.persons.push_back(p);
  }
  return s;
}

class Courtesy : public testing::TestWithParam<Adaptation> {};

TEST_P(Courtesy, NobodyCrossesCloseBeforeTheLensOrStandsThere) {
  for (const uint64_t seed : {1, 2, 3}) {
    Simulation s;
    const Error e = StartSimulation(nullptr, Crossing(GetParam(), seed), &s);
    ASSERT_FALSE(e) << e.message;
    const Crowd& c = s.town.crowd;
    std::map<int, int> stood;  // steps, by id
    int passed_near = 0;
    for (int step = 0; step < 30 * 75; ++step) {
      StepSimulation({}, 0, &s);
      for (size_t i = 0; i < c.size(); ++i) {
        const float away_m = Length(c.position[i]);
        ASSERT_GE(away_m, s.control.settings.r_personal_m + c.radius_m[i] - 0.01f);
        passed_near += away_m < 3;
        if (Classify(c.position[i], 0, s.visitor.camera.view, 0) == ViewClass::kOutside) continue;
        EXPECT_GE(away_m, kBeforeLens_m) << "seed " << seed << " step " << step << " person " << c.id[i];
        const bool waits = c.activity[i] == Activity::kWalking && Length(c.velocity[i]) < 0.2f && away_m < 3;
        EXPECT_LT(waits ? ++stood[c.id[i]] : 0, 45) << "person " << c.id[i] << " stands before the lens";
      }
    }
    EXPECT_GT(passed_near, 300) << "people still come by";
  }
}

// Early and gently: the line is bent from afar, nobody jumps aside.
TEST_P(Courtesy, TheWayRoundBeginsFarAway) {
  Scenario scenario = Crossing(GetParam(), 1);
  scenario.persons.resize(1);
  scenario.persons[0].position_m = {20, 0.05f};
  scenario.persons[0].goals_m = {{-20, 0.05f}};
  Simulation s;
  ASSERT_FALSE(StartSimulation(nullptr, scenario, &s));
  const Crowd& c = s.town.crowd;
  float aside_at_4_m = 0, fastest_aside_mps = 0, before_mps = 0, jerk = 0;
  bool arrived = false;
  for (int step = 0; step < 30 * 60 && !arrived; ++step) {
    StepSimulation({}, 0, &s);
    const Vec2 p = c.position[0];
    if (p.x > 4) aside_at_4_m = std::abs(p.y);
    if (p.x > 1) fastest_aside_mps = std::max(fastest_aside_mps, std::abs(c.velocity[0].y));
    jerk = std::max(jerk, std::abs(c.velocity[0].y - before_mps) * 30);
    before_mps = c.velocity[0].y;
    arrived = p.x < -19;
  }
  EXPECT_TRUE(arrived);
  EXPECT_GT(aside_at_4_m, 0.5f);
  EXPECT_LT(fastest_aside_mps, 0.6f);
  EXPECT_LT(jerk, 2.0f);
}

INSTANTIATE_TEST_SUITE_P(Modes, Courtesy, testing::Values(Adaptation::kOff, Adaptation::kPaper, Adaptation::kFull));

}  // namespace
}  // namespace flaneur
