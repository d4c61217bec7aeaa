// The visitor's map: where things are on it, what it shows, and that one is led there.
#include "runtime/visit/town_map.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/runtime/simulation/tour_town.h"

namespace flaneur {
namespace {

Simulation TownWithHouse() {
  Simulation s;
  Scenario scenario;
  scenario.has_ground = scenario.has_camera = true;
  scenario.ground_min_m = {-30, -20};
  scenario.ground_max_m = {30, 20};
  scenario.camera_position_m = {-20, 0};
  scenario.obstacles.polygons = {{{{-8, -12}, {8, -12}, {8, 12}, {-8, 12}}, {}}};
  EXPECT_EQ(StartSimulation(nullptr, scenario, &s).message, "");
  return s;
}

std::array<int, 3> ColorAt(const std::vector<uint8_t>& rgba, const MapView& view, Vec2 p) {
  const Vec2 px = OnMap(view, p);
  const size_t at = (static_cast<size_t>(px.y) * static_cast<size_t>(view.width_px) + static_cast<size_t>(px.x)) * 4;
  return {rgba[at], rgba[at + 1], rgba[at + 2]};
}

TEST(TownMap, WhatIsTappedIsWhereItIs) {
  const Simulation s = TownWithHouse();
  for (const float times : {1.0f, 4.0f}) {
    const MapView view = Enlarged(WholeTown(s.town.walkable, 640, 480), times, {-20, 3});
    for (const Vec2 p : {Vec2{-20, 3}, Vec2{-17, -1}, Vec2{-22, 5}}) {
      const Vec2 back = FromMap(view, OnMap(view, p));
      EXPECT_NEAR(back.x, p.x, 1e-3f);
      EXPECT_NEAR(back.y, p.y, 1e-3f);
    }
  }
  const MapView view = WholeTown(s.town.walkable, 640, 480);
  EXPECT_LT(OnMap(view, {0, 15}).y, OnMap(view, {0, -15}).y) << "north is at the top";
  EXPECT_LT(OnMap(view, {-15, 0}).x, OnMap(view, {15, 0}).x) << "and east to the right";
}

TEST(TownMap, AllOfTheTownIsOnItHoweverItIsShaped) {
  const Simulation s = TownWithHouse();
  for (const auto& [width, height] : {std::pair{640, 480}, std::pair{200, 900}, std::pair{1200, 100}}) {
    const MapView view = WholeTown(s.town.walkable, width, height);
    for (const Vec2 corner : {Vec2{-30, -20}, Vec2{30, 20}}) {
      const Vec2 px = OnMap(view, corner);
      EXPECT_GE(px.x, 0);
      EXPECT_GE(px.y, 0);
      EXPECT_LE(px.x, static_cast<float>(width));
      EXPECT_LE(px.y, static_cast<float>(height));
    }
  }
}

TEST(TownMap, HousesStandOutFromTheirCourtsAndWays) {
  Simulation s = TownWithHouse();
  s.town.walkable.polygons[0].holes = {{{-3, -3}, {3, -3}, {3, 3}, {-3, 3}}};
  const MapView view = WholeTown(s.town.walkable, 300, 200);
  const std::vector<uint8_t> map = DrawTownMap(s.town.walkable, view);
  ASSERT_EQ(map.size(), 300u * 200 * 4);
  const auto house = ColorAt(map, view, {-6, 0}), yard = ColorAt(map, view, {0, 0}), way = ColorAt(map, view, {-20, 0});
  const auto beyond = ColorAt(map, view, FromMap(view, {1, 100}));
  EXPECT_EQ(yard, way);
  EXPECT_NE(beyond, way);
  EXPECT_GT(way[0] - house[0], 40);
  // Crisp: from way to house within two pixels of the wall.
  const float m_per_px = 1 / view.px_per_m;
  EXPECT_EQ(ColorAt(map, view, {-8 - 2 * m_per_px, 0}), way);
  EXPECT_EQ(ColorAt(map, view, {-8 + 2 * m_per_px, 0}), house);
}

TEST(TownMap, StreetsAreNamedAfterTheNearest) {
  const std::vector<Street> streets{{{{"en", "Long"}}, {{0, 0}, {40, 0}}}, {{{"en", "Short"}}, {{50, 0}, {50, 20}}}};
  EXPECT_EQ(StreetAt(streets, {20, 3}), 0);
  EXPECT_EQ(StreetAt(streets, {47, 10}), 1);
  EXPECT_EQ(StreetAt(streets, {20, 30}), -1);
  EXPECT_NEAR(MiddleOf(streets[0]).x, 20, 1e-4f);
}

// Step by step to where the map said, never into a house.
TEST(TownMap, WhoIsLedToAPlaceArrivesAroundTheHouses) {
  Simulation s = TownWithHouse();
  CameraInput input;
  input.active = true;
  input.walk_to = Vec2{20, 0};
  for (int step = 0; step < 30 * 90 && Length(s.visitor.camera.view.position - Vec2{20, 0}) > 0.5f; ++step) {
    StepSimulation(input, 0, &s);
    input.walk_to.reset();
    ASSERT_FALSE(InsideObstacle(s.town.walkable, s.visitor.camera.view.position)) << step;
  }
  EXPECT_LT(Length(s.visitor.camera.view.position - Vec2{20, 0}), 0.5f);
}

TEST(TownMap, TheTourLeadsToTheStopThatWasChosenAndGoesOnThere) {
  for (const char* guide : {"", "monk"}) {
    TourPack pack = TourTown(10);
    pack.guide = guide;
    Simulation s = Started(pack);
    const std::vector<MapStop> stops = StopsOnMap(s.visitor.tour);
    ASSERT_GE(stops.size(), 2u);
    const size_t wished = stops.back().stop;
    CameraInput input;
    input.tour.lead_to = wished;
    bool rested = false;
    for (int step = 0; step < 30 * 180 && !rested; ++step) {
      StepSimulation(input, 0, &s);
      input.tour = {};
      rested = s.visitor.tour.resting;
      ASSERT_FALSE(InsideObstacle(s.town.walkable, s.visitor.camera.view.position));
    }
    ASSERT_TRUE(rested);
    EXPECT_EQ(HaltOf(s.visitor.tour), wished);
  }
}

}  // namespace
}  // namespace flaneur
