// Children who run about a place.
#include <gtest/gtest.h>

#include <algorithm>

#include "runtime/show/frame_from_simulation.h"
#include "tests/unit/runtime/simulation/box_obstacle.h"

namespace flaneur {
namespace {

constexpr float kRun_mps = 2.4f;

// A square of 60 m with a box in the middle of the place where children play.
TourPack Square() {
  TourPack pack;
  pack.ground = Share({{-30, -30}, 0.5f, 120, 120, std::vector<float>(14400, 0), std::vector<uint8_t>(14400, 3)});
  pack.obstacles.polygons = {Box({3, -1}, {4, 1})};
  pack.places = {{"west", "exit", {-29, 0}, 3}, {"east", "exit", {29, 0}, 3}};
  Place green{"green", "play", {0, 0}, 14};
  green.clip = "run";
  green.avatars = {"child"};
  green.people = 4;
  pack.places.push_back(green);
  pack.avatars.resize(2);
  pack.avatars[0].name = "person";
  pack.avatars[1].name = "child";
  pack.avatars[1].share = 0;
  for (PackAvatar& avatar : pack.avatars) avatar.levels = {{0, 8000, 0, 0, 200}, {0, 1000, 0, 0, 0}};
  pack.avatars[1].other_clips.push_back({"run", {0.6f, 1, {Mat4{}}}, 0, kRun_mps});
  pack.crowd.people = 30;
  return pack;
}

Simulation Started(const TourPack& pack) {
  Scenario scenario = ScenarioOf(pack);
  scenario.has_camera = true;
  scenario.camera_position_m = {0, -20};
  scenario.camera_yaw_deg = 90;
  Simulation s;
  const Error e = StartSimulation(&pack, scenario, &s);
  EXPECT_FALSE(e) << e.message;
  return s;
}

TEST(Play, ChildrenRunAboutTheirPlaceAndNobodyIsRunInto) {
  const TourPack pack = Square();
  Simulation s = Started(pack);
  PersonLooks looks;
  FrameInput frame;
  float fastest_mps = 0;
  int runs = 0, rests = 0, running_pictures = 0;
  for (int step = 0; step < 1800; ++step) {
    StepSimulation({}, 0, &s);
    FrameFromSimulation(pack, s, &looks, &frame);
    running_pictures +=
        static_cast<int>(std::count_if(frame.people.begin(), frame.people.end(), [](const DrawnPerson& p) {
          return p.avatar == 1 && p.moment.clip == OtherClip(0);
        }));
    const Crowd& c = s.town.crowd;
    int children = 0;
    for (size_t i = 0; i < c.size(); ++i) {
      if (c.avatar[i] != 1) continue;
      ++children;
      const float speed_mps = Length(c.velocity[i]);
      fastest_mps = std::max(fastest_mps, speed_mps);
      runs += speed_mps > 0.8f * kRun_mps ? 1 : 0;
      rests += speed_mps < 0.1f ? 1 : 0;
      EXPECT_LT(Length(c.position[i]), 10) << "stays about the place";
      EXPECT_FALSE(InsideObstacle(s.town.walkable, c.position[i]));
    }
    ASSERT_EQ(children, 4);
  }
  EXPECT_GT(fastest_mps, 0.85f * kRun_mps);
  EXPECT_LT(fastest_mps, 1.3f * kRun_mps);
  EXPECT_GT(runs, 1800 / 4);
  EXPECT_GT(rests, 1800 / 4);
  EXPECT_GT(running_pictures, 100);
}

TEST(Play, WhereNobodyCanRunIsSaidSo) {
  TourPack pack = Square();
  pack.avatars[1].other_clips[0].speed_mps = 0;
  const Simulation s = Started(pack);
  const auto& warnings = s.town.warnings;
  EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [](const std::string& warning) {
    return warning.find("'green': nobody can play there") != std::string::npos;
  }));
}

}  // namespace
}  // namespace flaneur
