// Worlds that cannot be lived in as they are: named at the start, never a hang, never people inside walls.
#include <gtest/gtest.h>

#include "runtime/simulation/simulation.h"
#include "tests/unit/runtime/simulation/box_obstacle.h"

namespace flaneur {
namespace {

// A square of 20 m with a house in its middle.
TourPack Town() {
  TourPack pack;
  pack.ground = Share({{0, 0}, 0.5f, 40, 40, std::vector<float>(1600, 0), std::vector<uint8_t>(1600, 3)});
  pack.obstacles.polygons.push_back(Box({8, 8}, {14, 14}));
  pack.avatars.emplace_back();
  pack.avatars.back().levels.push_back({0, 1000, 0, 0, 0});
  pack.places = {{"west", "exit", {1, 10}, 3}, {"east", "exit", {19, 10}, 3}};
  pack.crowd.people = 10;
  return pack;
}

Scenario Watched(const TourPack& pack) {
  Scenario scenario = ScenarioOf(pack);
  scenario.has_camera = true;
  scenario.camera_position_m = {3, 3};
  scenario.camera_yaw_deg = 45;
  return scenario;
}

std::string Complaint(const TourPack& pack, const Scenario& scenario) {
  Simulation s;
  const Error e = StartSimulation(&pack, scenario, &s);
  EXPECT_EQ(e.message.find('\n'), std::string::npos);
  return e.message;
}

std::vector<std::string> Warnings(const TourPack& pack, const Scenario& scenario) {
  Simulation s;
  const Error e = StartSimulation(&pack, scenario, &s);
  EXPECT_FALSE(e) << e.message;
  for (int step = 0; step < 300; ++step) {
    StepSimulation({}, 0, &s);
    for (const Vec2 p : s.town.crowd.position) EXPECT_FALSE(InsideObstacle(s.town.walkable, p)) << p.x << " " << p.y;
  }
  return s.town.warnings;
}

bool Has(const std::vector<std::string>& warnings, const std::string& text) {
  for (const std::string& w : warnings) {
    if (w.find(text) != std::string::npos) return true;
  }
  return false;
}

TEST(BadWorld, NoWalkableGround) {
  TourPack pack = Town();
  GroundRaster ground = *pack.ground;
  ground.kind.assign(1600, 0);
  pack.ground = Share(std::move(ground));
  EXPECT_EQ(Complaint(pack, Watched(pack)), "there is no walkable ground");
  pack = Town();
  pack.obstacles.polygons.push_back(Box({-1, -1}, {21, 21}));
  EXPECT_EQ(Complaint(pack, Watched(pack)), "there is no walkable ground");
}

TEST(BadWorld, ObstaclesUponEachOtherWithoutEnd) {
  TourPack pack = Town();
  for (int k = 0; k < 200; ++k) pack.obstacles.polygons.push_back(Box({0, 0}, {20, 20}));
  EXPECT_NE(Complaint(pack, Watched(pack)).find("lie over each other"), std::string::npos);
  pack = Town();
  pack.obstacles.circles.assign(200, {{10, 10}, 1000});
  EXPECT_NE(Complaint(pack, Watched(pack)).find("lie over each other"), std::string::npos);
  pack = Town();
  PolygonObstacle comb;  // a ring that goes to and fro
  for (int k = 0; k < 200000; ++k)
    comb.outer.push_back({1 + 1e-5f * static_cast<float>(k), k % 2 == 0 ? -1000.0f : 1000.0f});
  pack.obstacles.polygons.push_back(comb);
  EXPECT_NE(Complaint(pack, Watched(pack)).find("more walls"), std::string::npos);
}

TEST(BadWorld, PlacesInsideAHouseAndBehindWalls) {
  TourPack pack = Town();
  pack.places.push_back({"cellar", "goal", {11, 11}, 1});
  pack.places.push_back({"camp", "spawn", {9, 9}, 1});
  pack.obstacles.polygons.push_back(Box({16, 1}, {19.5f, 1.2f}));
  pack.obstacles.polygons.push_back(Box({16, 4}, {19.5f, 4.2f}));
  pack.obstacles.polygons.push_back(Box({16, 1.2f}, {16.2f, 4}));
  pack.obstacles.polygons.push_back(Box({19.3f, 1.2f}, {19.5f, 4}));
  pack.places.push_back({"yard", "goal", {17.7f, 2.6f}, 1});
  const auto warnings = Warnings(pack, Watched(pack));
  EXPECT_TRUE(Has(warnings, "place 'cellar' cannot be reached"));
  EXPECT_TRUE(Has(warnings, "place 'camp' (spawn) is inside an obstacle"));
  EXPECT_TRUE(Has(warnings, "place 'yard' cannot be reached"));
}

TEST(BadWorld, MorePeopleThanFit) {
  TourPack pack = Town();
  pack.crowd.people = 5000;
  const auto warnings = Warnings(pack, Watched(pack));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].find("only "), 0u) << warnings[0];
  EXPECT_NE(warnings[0].find(" of 5000 people fit"), std::string::npos) << warnings[0];
}

TEST(BadWorld, ContradictoryLimits) {
  Scenario scenario = Watched(Town());
  scenario.control.r_high_m = 0.5f;
  EXPECT_EQ(Complaint(Town(), scenario),
            "contradictory limits: r_personal_m 0.6 m must be below camera.r_high_m 0.5 m");
  scenario.control.r_high_m = 500;
  EXPECT_EQ(Complaint(Town(), scenario), "contradictory limits: camera.r_high_m 500 m must be below r_far_m 200 m");
  scenario = Watched(Town());
  scenario.control.budget_triangles = 5000;
  EXPECT_TRUE(Has(Warnings(Town(), scenario),
                  "12 people in high resolution have at least 12000 triangles, budget_triangles is 5000"));
  scenario = Watched(Town());
  ScenarioPerson hasty;
  hasty.position_m = {5, 5};
  hasty.speed_mps = 3;
  hasty.top_speed_mps = 2;
  scenario.persons = {hasty};
  EXPECT_EQ(Complaint(Town(), scenario), "person 1: contradictory limits: speed_mps is above top_speed_mps");
}

TEST(BadWorld, ACrowdAreaInsideAHouse) {
  Scenario scenario = Watched(Town());
  scenario.crowd_area = Area{{9, 9}, {13, 13}};
  EXPECT_NE(Complaint(Town(), scenario).find("crowd_area holds no walkable ground"), std::string::npos);
}

}  // namespace
}  // namespace flaneur
