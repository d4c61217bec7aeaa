// What a bake says of stops and places where nobody can be; before, only the player did, to a visitor.
#include "pipeline/cli/visit_places.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace flaneur {
namespace {

// 40 m square, with a house on (0, 0) and a walled yard about (12, 12), whose wall is half a metre thick.
Footprints HouseAndYard() {
  const auto square = [](double x, double y, double half) {
    return std::vector<Point2>{{x - half, y - half}, {x + half, y - half}, {x + half, y + half}, {x - half, y + half}};
  };
  Footprints footprints;
  Obstacle house, wall;
  house.name = "house", house.outer = square(0, 0, 3);
  wall.name = "wall", wall.outer = square(12, 12, 4), wall.holes = {square(12, 12, 3.5)};
  std::reverse(wall.holes[0].begin(), wall.holes[0].end());
  footprints.obstacles = {house, wall};
  return footprints;
}

GroundRaster Square() {
  GroundRaster ground;
  ground.min_m = {-20, -20};
  ground.columns = ground.rows = 160;
  ground.height_m.assign(160 * 160, 0);
  ground.kind.assign(160 * 160, 3);
  return ground;
}

TourStop StopAt(Vec2 at) {
  TourStop stop;
  stop.position_m = at;
  return stop;
}
Place PlaceAt(const char* name, const char* kind, Vec2 at) {
  Place place;
  place.name = name, place.kind = kind, place.position_m = at;
  return place;
}

TEST(VisitPlaces, WhatIsFreeIsNotSpokenOf) {
  EXPECT_TRUE(PlacesNobodyReaches(HouseAndYard(), Square(), {StopAt({-10, 0}), StopAt({10, -8})},
                                  {PlaceAt("well", "goal", {-8, 8})}, 0.3f)
                  .empty());
  EXPECT_TRUE(PlacesNobodyReaches(HouseAndYard(), Square(), {}, {}, 0.3f).empty());
}

TEST(VisitPlaces, StopsAndPlacesInHousesInYardsAndOffTheGroundAreNamed) {
  const auto said = PlacesNobodyReaches(HouseAndYard(), Square(),
                                        {StopAt({-10, 0}), StopAt({0, 2.5f}), StopAt({12, 12}), StopAt({500, 0})},
                                        {PlaceAt("bench", "loiter", {2.5f, 0}), PlaceAt("", "goal", {12, 12})}, 0.3f);
  const std::vector<std::string> expected = {
      "place 'bench' (loiter) is inside an obstacle; the nearest free ground is taken",
      "place 'goal' cannot be reached; it is not used", "stop 2 is not on free ground; the tour passes near it",
      "stops 3 and 4 cannot be reached; the tour passes them by"};
  EXPECT_EQ(said, expected);
}

TEST(VisitPlaces, ATownWithoutRoomForAnybodyIsOneLine) {
  Footprints footprints = HouseAndYard();
  footprints.obstacles[0].outer = {{-19.9, -19.9}, {19.9, -19.9}, {19.9, 19.9}, {-19.9, 19.9}};
  EXPECT_EQ(PlacesNobodyReaches(footprints, Square(), {StopAt({1, 1})}, {PlaceAt("well", "goal", {1, 1})}, 0.3f).size(),
            1u);
  EXPECT_EQ(PlacesNobodyReaches({}, {}, {StopAt({1, 1})}, {PlaceAt("well", "goal", {1, 1})}, 0.3f).size(), 1u);
}

// Of a square kilometre.
TEST(VisitPlaces, ACrowdThatIsTooThinToBeMetIsSpokenOf) {
  GroundRaster wide = Square();
  wide.cell_m = 5;
  wide.columns = wide.rows = 200;
  wide.height_m.assign(200 * 200, 0);
  wide.kind.assign(200 * 200, 3);
  const std::string said = DoubtOfThinCrowd({}, wide, {}, 120, 0.3f);
  EXPECT_NE(said.find("ha to walk on are a lot for 120 people"), std::string::npos) << said;
  EXPECT_EQ(DoubtOfThinCrowd({}, wide, {PlaceAt("well", "goal", {0, 0})}, 120, 0.3f), "");
  EXPECT_EQ(DoubtOfThinCrowd({}, wide, {}, 1000, 0.3f), "");
  EXPECT_EQ(DoubtOfThinCrowd({}, wide, {}, 1, 0.3f), "") << "meant so";
  EXPECT_EQ(DoubtOfThinCrowd(HouseAndYard(), Square(), {}, 30, 0.3f), "");
}

}  // namespace
}  // namespace flaneur
