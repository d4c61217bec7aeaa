#include "runtime/simulation/scenario.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>

#include "runtime/base/file.h"
#include "runtime/simulation/side_by_side.h"
#include "runtime/simulation/simulation.h"

namespace flaneur {
namespace {

Error Parse(const std::string& text, Scenario* scenario) {
  const auto path =
      std::filesystem::temp_directory_path() / ("flaneur_scenario_" + std::to_string(::getpid()) + ".toml");
  EXPECT_EQ(WriteTextFile(path, text).message, "");
  const Error error = ReadScenario(path, scenario);
  std::filesystem::remove(path);
  return error;
}

constexpr const char* kGround = "[ground]\nmin_m = [-20, -20]\nmax_m = [20, 20]\n";

TEST(Scenario, EveryAgreedKeyIsUnderstood) {
  Scenario s;
  ASSERT_EQ(Parse(R"(
name = "all"
people = 5
seed = 2
step_hz = 30
seconds = 12
adaptation = "paper"
[limit]
method = "frame_time"
high = 7
target_ms = 20
budget_triangles = 1000
[camera]
position_m = [1, 2]
yaw_deg = 90
fov_deg = 70
r_high_m = 9
[[camera.leg]]
walk_to_m = [3, 4]
speed_mps = 2.8
[[camera.leg]]
turn_by_deg = 360
rate_dps = 120
[[camera.leg]]
wait_s = 5
[[person]]
position_m = [12, 3]
goals_m = [[50, 3]]
avatar = "monk"
speed_mps = 1.3
top_speed_mps = 1.8
radius_m = 0.3
stay = true
[ground]
min_m = [-20, -20]
max_m = [20, 20]
[[obstacle]]
polygon_m = [[0, 0], [4, 0], [4, 1], [0, 1]]
[[obstacle]]
center_m = [8, 8]
radius_m = 0.5
)",
                  &s)
                .message,
            "");
  EXPECT_EQ(s.legs.size(), 3u);
  EXPECT_EQ(s.control.high_limit, 7);
  EXPECT_EQ(s.control.method, LimitMethod::kFrameTime);
  EXPECT_EQ(s.control.adaptation, Adaptation::kPaper);
  EXPECT_EQ(s.persons.size(), 1u);
  EXPECT_EQ(s.obstacles.polygons.size(), 1u);
  EXPECT_EQ(s.obstacles.circles.size(), 1u);
}

TEST(Scenario, TheReferenceRuns) {
  Scenario s;
  ASSERT_EQ(ReadScenario(std::filesystem::path(FLANEUR_SOURCE_DIR) / "assets_src/reference/scenario.toml", &s).message,
            "");
  Simulation simulation;
  ASSERT_EQ(StartSimulation(nullptr, s, &simulation).message, "");
  EXPECT_EQ(simulation.town.crowd.size(), 52u);
}

TEST(Scenario, MistakesAreNamedWithTheirLine) {
  Scenario s;
  EXPECT_NE(Parse("peple = 5\n", &s).message.find(":1: unknown key 'peple'; did you mean 'people'?"),
            std::string::npos);
  EXPECT_NE(Parse("\nadaptation = \"ful\"\n", &s)
                .message.find(":2: adaptation is 'ful', it must be one of: off, paper, full"),
            std::string::npos);
  EXPECT_NE(Parse("[[camera.leg]]\nspeed_mps = 1\n", &s).message.find("exactly one of"), std::string::npos);
  EXPECT_NE(Parse("[crowd_area]\nmin_m = [4, 4]\nmax_m = [0, 9]\n", &s).message.find(":1: crowd_area needs"),
            std::string::npos);
  EXPECT_NE(Parse("[tour]\nstops = [1.5]\n", &s).message.find(":1: tour.stops are whole numbers"), std::string::npos);
  EXPECT_NE(Parse("[[camera.leg]]\nwait_s = 1\n[tour]\nmost_rest_s = 3\n", &s).message.find(":3: [tour] is for runs"),
            std::string::npos);
  EXPECT_NE(Parse("seconds = -1\n", &s).message.find("seconds is -1, it must be from 0 to"), std::string::npos);
  EXPECT_NE(Parse("[limit]\nbudget_triangles = 0\n", &s).message.find("budget_triangles is 0"), std::string::npos);
}

TEST(Scenario, MayAskForMuchButNotForEverything) {
  Scenario s;
  EXPECT_NE(Parse("[ground]\nmin_m = [0, 0]\nmax_m = [900000, 2]\n", &s).message.find("20 km"), std::string::npos);
  std::string many;
  for (int k = 0; k < 20001; ++k) many += "[[person]]\nposition_m = [0, 0]\n";
  EXPECT_NE(Parse(many, &s).message.find("there may be 20000"), std::string::npos);
  EXPECT_NE(Parse("name = \"" + std::string(2000000, 'a') + "\"\n", &s).message.find("more than 20000 bytes"),
            std::string::npos);
}

Simulation Played(const std::string& text, int steps) {
  Scenario scenario;
  EXPECT_EQ(Parse(kGround + text, &scenario).message, "");
  Simulation s;
  EXPECT_EQ(StartSimulation(nullptr, scenario, &s).message, "");
  for (int step = 0; step < steps; ++step) StepSimulation({}, 0, &s);
  return s;
}

TEST(Legs, TheViewKeepsItsAngleToTheWay) {
  for (const float facing_deg : {90.0f, 180.0f, -40.0f}) {
    const Simulation s = Played("[camera]\nposition_m = [-10, 0]\n[[camera.leg]]\nwalk_to_m = [15, 0]\nfacing_deg = " +
                                    std::to_string(facing_deg) + "\n",
                                300);
    EXPECT_GT(s.visitor.camera.view.position.x, 2);
    EXPECT_NEAR(s.visitor.camera.view.position.y, 0, 0.01f);
    const float off_rad = std::remainder(s.visitor.camera.view.yaw_rad - facing_deg * kPi / 180, 2 * kPi);
    EXPECT_NEAR(off_rad, 0, 0.01f) << facing_deg;
  }
}

TEST(Legs, WhoIsFollowedIsKeptInViewAtADistance) {
  const Simulation s = Played(
      "[camera]\nposition_m = [-15, 0]\n[[camera.leg]]\nfollow_s = 60\nbehind_m = 3\nspeed_mps = 2\n"
      "[[person]]\nposition_m = [-11, 1]\ngoals_m = [[0, 2], [0, 15]]\nstay = true\nspeed_mps = 1.2\n",
      450);
  ASSERT_EQ(s.town.crowd.size(), 1u);
  EXPECT_EQ(s.town.crowd.view[0], ViewClass::kVisible);
  EXPECT_NEAR(Length(s.town.crowd.position[0] - s.visitor.camera.view.position), 3, 0.7f);
  EXPECT_GT(s.visitor.camera.view.position.y, 1);
}

TEST(Legs, LookingAboutStaysWithinBothSides) {
  Scenario scenario;
  ASSERT_EQ(Parse(kGround + std::string("[camera]\nposition_m = [0, 0]\n[[camera.leg]]\nwait_s = 30\n"
                                        "look_about_deg = 45\nrate_dps = 60\n"),
                  &scenario)
                .message,
            "");
  Simulation s;
  ASSERT_FALSE(StartSimulation(nullptr, scenario, &s));
  float least_rad = 0, most_rad = 0;
  for (int step = 0; step < 300; ++step) {
    StepSimulation({}, 0, &s);
    least_rad = std::min(least_rad, s.visitor.camera.view.yaw_rad);
    most_rad = std::max(most_rad, s.visitor.camera.view.yaw_rad);
  }
  EXPECT_NEAR(least_rad * 180 / kPi, -45, 6);
  EXPECT_NEAR(most_rad * 180 / kPi, 45, 6);
}

const std::string kWanders = "[camera]\nposition_m = [0, 0]\n[[camera.leg]]\nwander_s = 40\nseed = ";

TEST(Legs, AWandererGoesAboutAsTheSeedSays) {
  std::vector<Vec2> ends;
  for (const char* seed : {"7", "7", "8"}) {
    const Simulation s = Played(kWanders + seed + "\n", 900);
    EXPECT_FALSE(s.visitor.finished);
    ends.push_back(s.visitor.camera.view.position);
  }
  EXPECT_EQ(Length(ends[0] - ends[1]), 0);
  EXPECT_GT(Length(ends[0] - ends[2]), 0.5f);
  EXPECT_TRUE(Played(kWanders + "7\n", 1210).visitor.finished);
}

// A crowd that walks about in the visitor's way, as free people and as the control asks them to.
TEST(SideBySide, VisitorsAreAtTheSamePlaceAtTheSameMomentsAndComeTooNearToNobody) {
  const std::string text = kWanders + "3\n";
  std::vector<Simulation> runs(2);
  for (size_t k = 0; k < 2; ++k) {
    Scenario scenario;
    ASSERT_EQ(Parse("people = 120\nadaptation = \"" + std::string(k == 0 ? "off" : "full") + "\"\n" + kGround + text,
                    &scenario)
                  .message,
              "");
    ASSERT_FALSE(StartSimulation(nullptr, scenario, &runs[k]));
  }
  const float personal_m = runs[0].control.settings.r_personal_m;
  double apart_m = 0, walked_m = 0;
  for (int step = 0; step < 900; ++step) {
    StepSideBySide({&runs[0], &runs[1]}, {0, 0});
    const CameraState &first = runs[0].visitor.camera, &second = runs[1].visitor.camera;
    ASSERT_EQ(Length(first.view.position - second.view.position), 0);
    ASSERT_EQ(first.view.yaw_rad, second.view.yaw_rad);
    walked_m += static_cast<double>(first.actual_mps * Step_s(runs[0]));
    for (const Simulation& run : runs) {
      for (const Vec2 p : run.town.crowd.position) ASSERT_GE(Length(p - first.view.position), personal_m);
    }
    for (size_t i = 0; i < 10; ++i)
      apart_m += static_cast<double>(Length(runs[0].town.crowd.position[i] - runs[1].town.crowd.position[i]));
  }
  EXPECT_GT(walked_m, 5);
  EXPECT_GT(apart_m, 0) << "the crowds are not the same";
}

TEST(Legs, AKeyOfAnotherKindIsRefused) {
  Scenario s;
  EXPECT_NE(Parse("[[camera.leg]]\nwait_s = 1\nseed = 3\n", &s).message.find("seed belongs"), std::string::npos);
  EXPECT_NE(Parse("[[camera.leg]]\nwander_s = 1\nspeed_mps = 3\n", &s).message.find("draws its own"),
            std::string::npos);
  EXPECT_NE(Parse("[[camera.leg]]\nwait_s = 1\nfacing_deg = 90\n", &s).message.find("facing_deg belongs"),
            std::string::npos);
  EXPECT_NE(Parse("[[camera.leg]]\nwalk_to_m = [1, 1]\nbehind_m = 2\n", &s).message.find("behind_m belongs"),
            std::string::npos);
}

TEST(Simulation, ImpossiblePeopleAreNamed) {
  Scenario s;
  Simulation simulation;
  const std::string house = "[[obstacle]]\npolygon_m = [[0, 0], [4, 0], [4, 4], [0, 4]]\n";
  ASSERT_EQ(Parse(std::string(kGround) + house + "[[person]]\nposition_m = [2, 2]\n", &s).message, "");
  EXPECT_NE(StartSimulation(nullptr, s, &simulation).message.find("person 1: starts inside an obstacle"),
            std::string::npos);
  s = {};
  const std::string wall = "[[obstacle]]\npolygon_m = [[0, -21], [1, -21], [1, 21], [0, 21]]\n";
  ASSERT_EQ(Parse(std::string(kGround) + wall + "[[person]]\nposition_m = [-5, 2]\ngoals_m = [[9, 2]]\n", &s).message,
            "");
  EXPECT_NE(StartSimulation(nullptr, s, &simulation).message.find("nobody can get to goal 1"), std::string::npos);
}

TEST(Simulation, ImpossibleGroupsAreNamed) {
  Scenario s;
  Simulation simulation;
  const auto person = [](int k, const char* goal) {
    return "[[person]]\nposition_m = [" + std::to_string(k) + ", 0]\ngoals_m = [" + goal + "]\ngroup = \"us\"\n";
  };
  ASSERT_EQ(Parse(kGround + person(1, "[9, 2]"), &s).message, "");
  EXPECT_EQ(StartSimulation(nullptr, s, &simulation).message, "group 'us' has 1 people; 2 to 4 can walk together");
  s = {};
  ASSERT_EQ(Parse(kGround + person(1, "[9, 2]") + person(2, "[9, 3]"), &s).message, "");
  EXPECT_EQ(StartSimulation(nullptr, s, &simulation).message,
            "group 'us': person 1 and person 2 have different goals_m");
}

TEST(Simulation, WithoutACameraEverybodyIsVisibleAndIdsAreNeverReused) {
  Scenario s;
  ASSERT_EQ(
      Parse("people = 60\nseed = 4\n" + std::string(kGround) + "[[person]]\nposition_m = [-5, 2]\ngoals_m = [[9, 2]]\n",
            &s)
          .message,
      "");
  Simulation simulation;
  ASSERT_EQ(StartSimulation(nullptr, s, &simulation).message, "");
  EXPECT_EQ(simulation.town.crowd.size(), 61u);
  for (int step = 0; step < 600; ++step) {
    StepSimulation({}, 0, &simulation);
    for (ViewClass view : simulation.town.crowd.view) ASSERT_EQ(view, ViewClass::kVisible);
  }
  for (int id : simulation.town.crowd.id) EXPECT_NE(id, 0) << "the first person has arrived and left";
}

TEST(Simulation, ACrowdWithAnAreaOfItsOwnLivesThere) {
  Scenario scenario;
  ASSERT_EQ(
      Parse("people = 30\nseed = 4\n" + std::string(kGround) + "[crowd_area]\nmin_m = [-12, -6]\nmax_m = [4, 9]\n",
            &scenario)
          .message,
      "");
  Simulation s;
  ASSERT_FALSE(StartSimulation(nullptr, scenario, &s));
  const Area roomy{{-13, -7}, {5, 10}};  // who walks round others may step out for a moment
  for (int step = 0; step < 900; ++step) {
    StepSimulation({}, 0, &s);
    ASSERT_EQ(s.town.crowd.size(), 30u);
    for (const Vec2 p : s.town.crowd.position) ASSERT_TRUE(Contains(roomy, p)) << step << ": " << p.x << " " << p.y;
  }
}

TEST(Simulation, TheCrowdStartsClearOfPeoplePlacedExactly) {
  std::string text = "people = 200\nseed = 4\n" + std::string(kGround);
  for (int k = 0; k < 20; ++k) {
    text +=
        "[[person]]\nposition_m = [" + std::to_string(-9.9 + k) + ", " + std::to_string(0.37 * k) + "]\nstay = true\n";
  }
  Scenario scenario;
  ASSERT_EQ(Parse(text, &scenario).message, "");
  Simulation s;
  ASSERT_FALSE(StartSimulation(nullptr, scenario, &s));
  ASSERT_EQ(s.town.crowd.size(), 220u);
  for (size_t i = 0; i < s.town.crowd.size(); ++i) {
    for (size_t j = 0; j < i; ++j) {
      ASSERT_GE(Length(s.town.crowd.position[i] - s.town.crowd.position[j]),
                s.town.crowd.radius_m[i] + s.town.crowd.radius_m[j])
          << i << " " << j;
    }
  }
}

TEST(Simulation, TheSameSeedGivesTheSameTown) {
  Scenario s;
  ASSERT_EQ(Parse("people = 60\nseed = 4\n" + std::string(kGround), &s).message, "");
  Simulation a, b;
  ASSERT_EQ(StartSimulation(nullptr, s, &a).message, "");
  ASSERT_EQ(StartSimulation(nullptr, s, &b).message, "");
  for (int step = 0; step < 150; ++step) {
    StepSimulation({}, 0, &a);
    StepSimulation({}, 0, &b);
  }
  EXPECT_EQ(StateHash(a.town.crowd), StateHash(b.town.crowd));
  s.crowd.seed = 5;
  ASSERT_EQ(StartSimulation(nullptr, s, &b).message, "");
  EXPECT_NE(StateHash(a.town.crowd), StateHash(b.town.crowd));
}

}  // namespace
}  // namespace flaneur
