#include "pipeline/footprint/check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <set>

#include "pipeline/io/geojson.h"
#include "pipeline/io/gltf.h"
#include "tests/unit/pipeline/footprint/test_town.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;

const fs::path kCases = fs::path(FLANEUR_SOURCE_DIR) / "tests/data/check";

std::set<int> CodesOf(const std::vector<Finding>& findings) {
  std::set<int> codes;
  for (const Finding& f : findings) codes.insert(f.code);
  return codes;
}

std::string Listed(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& f : findings) text += std::to_string(f.code) + " " + f.feature + ": " + f.message + "\n";
  return text;
}

std::vector<Finding> CheckCase(const std::string& name) {
  GeoJsonFile file;
  EXPECT_EQ(ReadGeoJson(kCases / (name + ".geojson"), {}, &file).message, "");
  Scene town;
  const fs::path town_path = kCases / (name + ".gltf");
  const bool with_town = fs::exists(town_path);
  if (with_town) {
    EXPECT_EQ(ReadScene(town_path, &town).message, "");
  }
  CheckOptions options;
  options.open_rings = file.open_rings;
  std::vector<Finding> findings;
  EXPECT_EQ(Check(file.footprints, with_town ? &town : nullptr, options, &findings).message, "");
  return findings;
}

TEST(Check, FindsNothingInSoundFiles) {
  for (const char* name : {"sound", "street"}) {
    const std::vector<Finding> findings = CheckCase(name);
    EXPECT_TRUE(findings.empty()) << name << "\n" << Listed(findings);
  }
}

// ---- Either side of each tolerance: also in the files of tests/data/check, which tests/cli/check_test.py goes through
// ----

Obstacle Polygon(const std::string& name, const Ring& outer, const Rings& holes = {}) {
  Obstacle obstacle;
  obstacle.name = obstacle.source = name;
  obstacle.outer = outer;
  obstacle.holes = holes;
  return obstacle;
}

std::vector<Finding> CheckAlone(const std::vector<Obstacle>& obstacles, const Scene* town = nullptr,
                                CheckOptions options = {}) {
  Footprints footprints;
  footprints.obstacles = obstacles;
  std::vector<Finding> findings;
  EXPECT_EQ(Check(footprints, town, options, &findings).message, "");
  return findings;
}

std::set<int> CodesAlone(const std::vector<Obstacle>& obstacles) { return CodesOf(CheckAlone(obstacles)); }

const Ring kHouse = Rectangle(0, 0, 8, 6);

TEST(Check, NearPoints) {
  const auto ring = [](double step) { return Ring{{0, 0}, {8, 0}, {8, step}, {8, 6}, {0, 6}}; };
  EXPECT_EQ(CodesAlone({Polygon("house", ring(0.0009))}), std::set<int>{102});
  EXPECT_EQ(CodesAlone({Polygon("house", ring(0.0011))}), std::set<int>{});
}

TEST(Check, SmallAreas) {
  EXPECT_EQ(CodesAlone({Polygon("post", Rectangle(0, 0, 0.1, 0.099))}), std::set<int>{106});
  EXPECT_EQ(CodesAlone({Polygon("post", Rectangle(0, 0, 0.1, 0.101))}), std::set<int>{});
}

TEST(Check, CoordinatesFarAwayOrNotFinite) {
  const auto at = [](double x) { return std::vector<Obstacle>{Polygon("house", Rectangle(x, 0, x + 8, 6))}; };
  EXPECT_EQ(CodesAlone(at(999'000)), std::set<int>{});
  EXPECT_EQ(CodesAlone(at(1'000'001)), std::set<int>{107});
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(CodesAlone({Polygon("house", {{0, 0}, {8, 0}, {bad, 6}, {0, 6}})}), std::set<int>{107}) << "x " << bad;
    EXPECT_EQ(CodesAlone({Polygon("house", {{0, 0}, {8, 0}, {8, bad}, {0, 6}})}), std::set<int>{107}) << "y " << bad;
    Obstacle circle;
    circle.center = {0, bad}, circle.radius_m = 1;
    EXPECT_EQ(CodesAlone({circle}), std::set<int>{107}) << "centre " << bad;
  }
}

TEST(Check, ManyPoints) {
  const auto ring = [](int corners) {
    Ring out;
    for (int i = 0; i < corners; ++i)
      out.push_back({9 * std::cos(6.283185307 * i / corners), 9 * std::sin(6.283185307 * i / corners)});
    return out;
  };
  EXPECT_EQ(CodesAlone({Polygon("tower", ring(256))}), std::set<int>{});
  EXPECT_EQ(CodesAlone({Polygon("tower", ring(257))}), std::set<int>{108});
}

TEST(Check, SpikesByWidthAndLength) {
  const auto ring = [](double width, double length) {
    return Ring{{0, 0},
                {8, 0},
                {8, 3 - width / 2},
                {8 + length, 3 - width / 2},
                {8 + length, 3 + width / 2},
                {8, 3 + width / 2},
                {8, 6},
                {0, 6}};
  };
  EXPECT_EQ(CodesAlone({Polygon("house", ring(0.015, 1))}), std::set<int>{203});
  EXPECT_EQ(CodesAlone({Polygon("house", ring(0.03, 1))}), std::set<int>{}) << "a thin wall";
  EXPECT_EQ(CodesAlone({Polygon("house", ring(0.015, 0.08))}), std::set<int>{}) << "too short to matter";
}

TEST(Check, OverlapsAndTouching) {
  const auto beside = [](double x) {
    return std::vector<Obstacle>{Polygon("a", kHouse), Polygon("b", Rectangle(x, 0, 12, 6))};
  };
  EXPECT_EQ(CodesAlone(beside(8)), std::set<int>{}) << "touching is fine";
  EXPECT_EQ(CodesAlone(beside(7.9985)), std::set<int>{}) << "0.009 m2";
  EXPECT_EQ(CodesAlone(beside(7.998)), std::set<int>{401}) << "0.012 m2";
}

TEST(Check, GapsByTheWidthOfPeople) {
  const auto gap = [](double width) {
    return std::vector<Obstacle>{Polygon("a", kHouse), Polygon("b", Rectangle(8 + width, 0, 14, 6))};
  };
  EXPECT_EQ(CodesAlone(gap(0.009)), std::set<int>{}) << "as good as touching";
  EXPECT_EQ(CodesAlone(gap(0.05)), std::set<int>{403});
  EXPECT_EQ(CodesAlone(gap(0.59)), std::set<int>{403});
  EXPECT_EQ(CodesAlone(gap(0.61)), std::set<int>{404});
  EXPECT_EQ(CodesAlone(gap(1.19)), std::set<int>{404});
  EXPECT_EQ(CodesAlone(gap(1.21)), std::set<int>{});
}

TEST(Check, WallsByClearance) {
  TestTown town;
  town.Ground().Node("house", NodeKind::kBuilding).Box({10, 10, -1}, {18, 16, 8});
  const auto codes = [&](double east) {
    return CodesOf(CheckAlone({Polygon("house", Rectangle(9.95, 9.95, east, 16.05))}, &town.scene));
  };
  EXPECT_EQ(codes(18.05), std::set<int>{});
  EXPECT_EQ(codes(18.041), std::set<int>{}) << "within 1 cm of the clearance";
  EXPECT_EQ(codes(18.038), std::set<int>{302});
  EXPECT_EQ(codes(17.995), std::set<int>{302}) << "uncovered by less than 1 cm";
  EXPECT_EQ(codes(17.98), std::set<int>{301});
  EXPECT_EQ(codes(18.059), std::set<int>{}) << "within 1 cm of the clearance";
  EXPECT_EQ(codes(18.08), std::set<int>{303});
}

TEST(Check, ACourtyardIsAWarningAndACutOffPlaceAnError) {
  const auto yard = [](double gate) {
    return std::vector<Obstacle>{Polygon(
        "yard", {{0, 0}, {40, 0}, {40, 1}, {1, 1}, {1, 5}, {39, 5}, {39, 1 + gate}, {40, 1 + gate}, {40, 6}, {0, 6}})};
  };
  EXPECT_EQ(CodesAlone(yard(0.4)), std::set<int>{501});
  EXPECT_EQ(CodesAlone(yard(0.8)), (std::set<int>{502, 503})) << "open, but by one way only";
  const std::vector<Finding> closed =
      CheckAlone({Polygon("house", Rectangle(0, 0, 12, 12), {{{5, 5}, {5, 7}, {7, 7}, {7, 5}}}),
                  Polygon("far", Rectangle(30, 30, 31, 31))});
  ASSERT_EQ(CodesOf(closed), std::set<int>{501});
  EXPECT_EQ(closed[0].severity, Severity::kWarning);
}

TEST(Check, DoorsByTheirDistance) {
  TestTown town;
  town.Ground().Node("house", NodeKind::kBuilding).Box({10, 10, -1}, {18, 16, 8});
  town.Gate("door", NodeKind::kDoor, {14, 10}, {0, -1}).Gate("exit", NodeKind::kExit, {1, 15}, {1, 0});
  const Obstacle house = Polygon("house", Rectangle(9.95, 9.95, 18.05, 16.05));
  EXPECT_EQ(CodesOf(CheckAlone({house}, &town.scene)), std::set<int>{}) << "a door stands in its wall's clearance";
  CheckOptions options;
  options.gates = {{"spawn", {20, 12}, {}, false}};
  EXPECT_EQ(CodesOf(CheckAlone({house}, &town.scene, options)), std::set<int>{});
  options.gates[0].at_m = {18.25, 12};
  EXPECT_EQ(CodesOf(CheckAlone({house}, &town.scene, options)), std::set<int>{603});
  options.gates[0].at_m = {17, 12};
  EXPECT_EQ(CodesOf(CheckAlone({house}, &town.scene, options)), std::set<int>{601});
  options.gates[0].at_m = {60, 12};
  EXPECT_EQ(CodesOf(CheckAlone({house}, &town.scene, options)), std::set<int>{604}) << "beyond the ground";
}

// ---- Together ----

TEST(Check, IndependentFaultsAreAllReported) {
  const std::vector<Finding> findings = CheckAlone(
      {Polygon("bow", {{0, 0}, {8, 6}, {8, 0}, {0, 6}}), Polygon("turned", {{20, 0}, {20, 6}, {28, 6}, {28, 0}}),
       Polygon("a", Rectangle(40, 0, 48, 6)), Polygon("b", Rectangle(47, 0, 55, 6))});
  EXPECT_EQ(CodesOf(findings), (std::set<int>{104, 105, 401})) << Listed(findings);
  EXPECT_TRUE(std::is_sorted(findings.begin(), findings.end(),
                             [](const Finding& f, const Finding& g) { return f.code < g.code; }));
}

TEST(Check, PlacesLieAtTheFault) {
  const std::vector<Finding> findings = CheckAlone({Polygon("bow", {{0, 0}, {8, 6}, {8, 0}, {0, 6}})});
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_NEAR(findings[0].at_m.x, 4, 1e-9);
  EXPECT_NEAR(findings[0].at_m.y, 3, 1e-9);
}

TEST(Check, WhatIsExtractedPasses) {
  TestTown town;
  town.Ground();
  for (int i = 0; i < 4; ++i) {  // a row with jetties, depths that differ, and a party wall that is missing
    const float x = 6 + 5.0f * static_cast<float>(i), depth = 20 + 0.7f * static_cast<float>(i % 3);
    town.Node("house_" + std::to_string(i), NodeKind::kBuilding);
    town.Box({x, 14, -1}, {x + 5, depth, 2.5f}, i == 1 ? std::set<Side>{Side::kEast} : std::set<Side>{});
    town.Box({x, 13.4f, 2.5f}, {x + 5, depth + 0.6f, 8});
    town.Gate("door_" + std::to_string(i), NodeKind::kDoor, {x + 2.5f, 14}, {0, -1});
  }
  town.Node("town_hall", NodeKind::kBuilding).Box({6, 4, -1}, {16, 7, 9}).Box({6, 7, 3}, {16, 9.5f, 9});
  for (const float x : {6.0f, 10.8f, 15.6f}) town.Box({x, 9.1f, -1}, {x + 0.4f, 9.5f, 3});
  town.Node("wall", NodeKind::kWall).Box({30, 5, -1}, {30.3f, 25, 3});
  town.Node("oak", NodeKind::kTree, 0.3f).Column({35, 15, 0}, 0.3f, 5, 10);
  town.Gate("exit", NodeKind::kExit, {0.5f, 12}, {1, 0});
  const Footprints footprints = Extract(town);
  std::vector<Finding> findings;
  ASSERT_EQ(Check(footprints, &town.scene, {}, &findings).message, "");
  EXPECT_TRUE(findings.empty()) << Listed(findings);
}

TEST(Check, RefusesOptionsOutOfRange) {
  std::vector<Finding> findings;
  CheckOptions options;
  options.tolerance_m = 0;
  EXPECT_NE(Check({}, nullptr, options, &findings).message.find("tolerance"), std::string::npos);
  options = {}, options.person_radius_m = -1;
  EXPECT_NE(Check({}, nullptr, options, &findings).message.find("radius"), std::string::npos);
}

}  // namespace
}  // namespace flaneur
