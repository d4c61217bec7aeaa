#include "runtime/simulation/simulation.h"

#include <gtest/gtest.h>

#include "tests/unit/runtime/simulation/box_obstacle.h"

namespace flaneur {
namespace {

// A square of 40 m with a solid house, and a yard that walls close off.
TourPack SmallTown() {
  TourPack pack;
  pack.ground = Share({{0, 0}, 0.5f, 80, 80, std::vector<float>(6400, 0), std::vector<uint8_t>(6400, 3)});
  pack.obstacles.polygons.push_back(Box({10, 10}, {14, 14}));
  PolygonObstacle yard = Box({25, 25}, {35, 35});
  yard.holes = {{{26, 26}, {26, 34}, {34, 34}, {34, 26}}};
  pack.obstacles.polygons.push_back(yard);
  pack.crowd.people = 0;
  return pack;
}

TourStop Stop(Vec2 position) {
  TourStop stop;
  stop.position_m = position;
  return stop;
}

Simulation Started(const TourPack& pack) {
  Simulation s;
  const Error e = StartSimulation(&pack, ScenarioOf(pack), &s);
  EXPECT_FALSE(e) << e.message;
  return s;
}

TEST(StartSimulation, ATourThatBeginsInAHouseBeginsBesideIt) {
  TourPack pack = SmallTown();
  pack.path = {Stop({11, 12}), Stop({30, 5})};
  Simulation s = Started(pack);
  EXPECT_FALSE(InsideObstacle(s.town.walkable, s.visitor.camera.view.position));
  EXPECT_LT(Length(s.visitor.camera.view.position - Vec2{11, 12}), 3);
  ASSERT_EQ(s.town.warnings.size(), 1u);
  EXPECT_NE(s.town.warnings[0].find("stop 1 is not on free ground"), std::string::npos) << s.town.warnings[0];
  for (int step = 0; step < 1200 && !s.visitor.finished; ++step) StepSimulation({}, 0, &s);
  EXPECT_LT(Length(s.visitor.camera.view.position - Vec2{30, 5}), 1);
}

TEST(StartSimulation, NamesAStopThatNoWayLeadsTo) {
  TourPack pack = SmallTown();
  pack.path = {Stop({5, 5}), Stop({30, 30}), Stop({5, 35})};
  Simulation s = Started(pack);
  ASSERT_EQ(s.town.warnings.size(), 1u);
  EXPECT_NE(s.town.warnings[0].find("stop 2 cannot be reached"), std::string::npos) << s.town.warnings[0];
  for (int step = 0; step < 1800 && !s.visitor.finished; ++step) StepSimulation({}, 0, &s);
  EXPECT_LT(Length(s.visitor.camera.view.position - Vec2{5, 35}), 1) << "goes on to the next stop";
}

TEST(StartSimulation, ATourIsWhereMostOfItsStopsAre) {
  TourPack pack = SmallTown();
  pack.path = {Stop({30, 30}), Stop({5, 5}), Stop({5, 35})};
  Simulation s = Started(pack);
  ASSERT_EQ(s.town.warnings.size(), 1u);
  EXPECT_NE(s.town.warnings[0].find("stop 1 cannot be reached"), std::string::npos) << s.town.warnings[0];
  EXPECT_EQ(s.visitor.tour.stops.size(), 2u);
  EXPECT_LT(Length(s.visitor.camera.view.position - Vec2{5, 5}), 1);
}

TEST(StartSimulation, WithoutATourTheVisitorStandsInTheLargestPartOfTheTown) {
  TourPack pack = SmallTown();
  const Simulation s = Started(pack);
  EXPECT_TRUE(IsFree(s.town.walkable, s.visitor.camera.view.position));
  EXPECT_LT(Length(s.visitor.camera.view.position - Vec2{20, 20}), 5);
  const Vec2 p = s.visitor.camera.view.position;
  EXPECT_FALSE(p.x > 25 && p.y > 25 && p.x < 35 && p.y < 35);
}

}  // namespace
}  // namespace flaneur
