// Everybody's class fits to where they stand once the step is over, whatever moved them in it.
#include <gtest/gtest.h>

#include "runtime/simulation/simulation.h"

namespace flaneur {
namespace {

// A square so full that people who avoid nobody out of view keep standing in each other, before a visitor who turns.
Scenario Throng(float pitch_deg) {
  Scenario s;
  s.crowd.people = 500;
  s.control.adaptation = Adaptation::kFull;
  s.has_ground = s.has_camera = true;
  s.ground_min_m = {-20, -20};
  s.ground_max_m = {20, 20};
  s.pitch_deg = pitch_deg;
  CameraLeg turn;
  turn.kind = CameraLeg::Kind::kTurn;
  turn.turn_deg = 3600;
  s.legs = {turn};
  return s;
}

int MovedApart(const Simulation& s) { return static_cast<int>(s.town.scratch.displaced.people.size()); }

TEST(ViewClass, FitsToWhereEverybodyStandsAfterTheStep) {
  for (const float pitch_deg : {0.0f, -20.0f}) {
    Simulation s;
    const Error e = StartSimulation(nullptr, Throng(pitch_deg), &s);
    ASSERT_FALSE(e) << e.message;
    int moved = 0;
    for (int step = 0; step < 600; ++step) {
      StepSimulation({}, 0, &s);
      moved += MovedApart(s);
      const Crowd& c = s.town.crowd;
      for (size_t i = 0; i < c.size(); ++i) {
        const ViewClass now =
            Classify(c.position[i], c.view_reach_m[i], s.visitor.camera.view, s.control.outer_apex_back_m);
        ASSERT_EQ(c.view[i], now) << "person " << c.id[i] << " in step " << step << ", pitch " << pitch_deg;
      }
    }
    EXPECT_GT(moved, 50) << "the square is not full enough to say anything";
  }
}

}  // namespace
}  // namespace flaneur
