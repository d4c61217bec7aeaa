// Footprints of random towns that are known.
#include "tests/unit/pipeline/footprint/made_up_town.h"

#include <gtest/gtest.h>

#include "tests/unit/pipeline/footprint/figures.h"
#include "tests/unit/pipeline/footprint/test_town.h"

namespace flaneur {
namespace {

using made_up::PartyWalls;
using made_up::Tags;

struct Case {
  const char* name;
  made_up::Mix mix;
  figures::Spoiling spoiling;
  bool tagged;
  double least_iou;
};
std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

class MadeUpTown : public testing::TestWithParam<Case> {};

TEST_P(MadeUpTown, HasItsFootprints) {
  const Case& c = GetParam();
  const made_up::Town town = made_up::Build(c.mix, 4, 7);
  const Scene clean = ToScene(town, Tags::kCityModel), spoilt = figures::Spoilt(clean, c.spoiling);
  FootprintOptions exactly;
  exactly.clearance_m = exactly.tolerance_m = 0;
  Footprints footprints;
  FootprintStats stats;
  ASSERT_EQ(ExtractFootprints(c.tagged ? spoilt : figures::Untagged(spoilt), exactly, &footprints, &stats).message, "");
  const std::vector<figures::BuildingFit> fits = figures::Fits(clean, footprints, stats);
  ASSERT_EQ(fits.size(), town.names.size());
  EXPECT_GE(figures::MeanIou(fits), c.least_iou);
  for (const figures::BuildingFit& fit : fits)
    EXPECT_TRUE(fit.iou > 0.97 || fit.flagged) << fit.name << ": " << fit.iou;
}

constexpr made_up::Mix kRows{"rows", PartyWalls::kNone, true, false, false, false, false, false};
constexpr made_up::Mix kRowsOfOne{"rows of one", PartyWalls::kOneOwner, true, false, false, false, false, false};
constexpr made_up::Mix kYardsOfOne{"yards of one", PartyWalls::kOneOwner, false, true, false, false, false, false};
constexpr made_up::Mix kYards{"yards", PartyWalls::kNone, false, true, false, false, false, false};
constexpr made_up::Mix kYardsOfHouses{"yards", PartyWalls::kBoth, false, true, false, false, false, false};
constexpr made_up::Mix kHuge{"huge", PartyWalls::kBoth, false, false, true, false, false, false};
constexpr made_up::Mix kTowers{"towers", PartyWalls::kBoth, false, false, false, true, false, false};
constexpr made_up::Mix kBasins{"basins", PartyWalls::kBoth, false, false, false, false, true, false};
constexpr made_up::Mix kTerraces{"terraces", PartyWalls::kBoth, false, false, false, false, false, true};

INSTANTIATE_TEST_SUITE_P(
    Cases, MadeUpTown,
    testing::Values(
        Case{"rows without party walls", kRows, {}, true, 0.999},
        Case{"rows without party walls, untagged", kRows, {}, false, 0.99},
        Case{"rows without party walls, dropped", kRows, {.name = "", .drop = true}, false, 0.97},
        Case{"yards without party walls, dropped", kYards, {.name = "", .drop = true}, false, 0.97},
        Case{"rows, walls of one owner, dropped", kRowsOfOne, {.name = "", .drop = true}, false, 0.99},
        Case{"yards, walls of one owner, dropped", kYardsOfOne, {.name = "", .drop = true}, false, 0.97},
        Case{"rows without party walls, jittered", kRows, {.name = "", .jitter = true}, false, 0.995},
        Case{"yards, untagged", kYardsOfHouses, {}, false, 0.999},
        Case{"huge, no ground", kHuge, {.name = "", .no_ground = true}, false, 0.998},
        Case{"towers, no ground", kTowers, {.name = "", .no_ground = true}, false, 0.998},
        Case{"yards, no ground", kYardsOfHouses, {.name = "", .no_ground = true}, false, 0.999},
        Case{"yards without party walls, no ground", kYards, {.name = "", .no_ground = true}, false, 0.999},
        Case{"rows, walls of one owner, no ground", kRowsOfOne, {.name = "", .no_ground = true}, false, 0.99},
        Case{"yards, walls of one owner, no ground", kYardsOfOne, {.name = "", .no_ground = true}, false, 0.99},
        Case{"basins, no ground", kBasins, {.name = "", .no_ground = true}, false, 0.998},
        Case{"rows, walls of one owner", kRowsOfOne, {}, true, 0.999},
        Case{"yards, walls of one owner", kYardsOfOne, {}, true, 0.999},
        Case{"huge, untagged", kHuge, {}, false, 0.998},
        Case{"huge, untagged, jittered", kHuge, {.name = "", .jitter = true}, false, 0.995},
        Case{"towers, untagged", kTowers, {}, false, 0.998}, Case{"basins", kBasins, {}, true, 0.998},
        Case{"basins, untagged", kBasins, {}, false, 0.998}, Case{"terraces, untagged", kTerraces, {}, false, 0.998}),
    [](const testing::TestParamInfo<Case>& tested) {
      std::string name;
      for (const char c : std::string(tested.param.name)) name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
      return name;
    });

std::vector<figures::BuildingFit> FitsOf(const Scene& clean, const Scene& town) {
  FootprintOptions exactly;
  exactly.clearance_m = exactly.tolerance_m = 0;
  Footprints footprints;
  FootprintStats stats;
  EXPECT_EQ(ExtractFootprints(town, exactly, &footprints, &stats).message, "");
  return figures::Fits(clean, footprints, stats);
}

// As where a program wrote each face for itself: nothing is torn, nothing is lost, and yards stay open.
TEST(MadeUpTowns, FacesWithCornersOfTheirOwnAreWhole) {
  const Scene town = ToScene(made_up::Build(kYardsOfHouses, 12, 303), Tags::kCityModel);
  for (const float apart_m : {0.001f, 0.0015f}) {
    for (const figures::BuildingFit& fit : FitsOf(town, figures::Spoilt(town, {.name = "", .apart_m = apart_m}))) {
      EXPECT_GT(fit.iou, 0.99) << fit.name;
      EXPECT_FALSE(fit.flagged) << fit.name;
    }
  }
}

// One house's strip may run all round another.
TEST(MadeUpTowns, WallsRoundABlockSwallowNobody) {
  const Scene town = ToScene(made_up::Build(kYardsOfOne, 12, 31), Tags::kCityModel);
  for (const figures::BuildingFit& fit : FitsOf(town, town)) EXPECT_GT(fit.iou, 0.99) << fit.name;
}

// Where a block's walls have lost too much to enclose it, they still stand round its houses' floors.
TEST(MadeUpTowns, WallsOfOneOwnerStandRoundFloorsWhereSomeAreLost) {
  const Scene town = ToScene(made_up::Build(kRowsOfOne, 12, 301), Tags::kCityModel);
  const Scene spoilt = figures::Untagged(figures::Spoilt(town, {.name = "", .drop = true}));
  EXPECT_GT(figures::MeanIou(FitsOf(town, spoilt)), 0.99);
}

// Holes at corners of faces, and several in one house, close by the planes that they lie in.
TEST(MadeUpTowns, ClosedHousesThatHaveLostTrianglesKeepTheirGround) {
  const Scene town = ToScene(made_up::Build(kYardsOfHouses, 12, 302), Tags::kCityModel);
  const Scene spoilt = figures::Untagged(figures::Spoilt(town, {.name = "", .drop = true}));
  EXPECT_GT(figures::MeanIou(FitsOf(town, spoilt)), 0.999);
}

TEST(MadeUpTowns, NeighboursDoNotOverlap) {
  const made_up::Town town = made_up::Build({"rows", PartyWalls::kBoth, true, true, false, false, false, false}, 6, 3);
  Footprints footprints;
  ASSERT_EQ(ExtractFootprints(ToScene(town, Tags::kCityModel), {}, &footprints).message, "");
  for (size_t i = 0; i < footprints.obstacles.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      EXPECT_LT(Area(Intersection(RingsOf(footprints.obstacles[i]), RingsOf(footprints.obstacles[j]))), 0.01)
          << footprints.obstacles[i].name << ", " << footprints.obstacles[j].name;
}

// ---- What is left out is named ----

std::vector<std::string> WarningsOf(const TestTown& town) {
  Footprints footprints;
  std::vector<std::string> warnings;
  EXPECT_EQ(ExtractFootprints(town.scene, {}, &footprints, nullptr, &warnings).message, "");
  return warnings;
}
int CountNaming(const std::vector<std::string>& warnings, const std::string& text) {
  return static_cast<int>(std::count_if(warnings.begin(), warnings.end(), [&](const std::string& warning) {
    return warning.find(text) != std::string::npos;
  }));
}

TEST(LeftOut, AHouseThatStandsWithinAnotherIsNamed) {
  TestTown town;
  town.Node("hall", NodeKind::kBuilding).Box({0, 0, 0}, {20, 10, 8});
  town.Node("closet", NodeKind::kBuilding).Box({4, 4, 0}, {11, 5.34f, 3});  // 9.4 m2
  const std::vector<std::string> warnings = WarningsOf(town);
  EXPECT_EQ(CountNaming(warnings, "'closet' (9.38 m2) has no obstacle of its own: it stands within 'hall'"), 1);
}

TEST(LeftOut, FlatThingsAreNamed) {
  TestTown town;
  town.Node("house", NodeKind::kUntagged).Box({0, 0, 0}, {10, 10, 8});
  town.Node("slab", NodeKind::kUntagged).Box({20, 0, 0}, {30, 10, 0.1f});
  EXPECT_EQ(CountNaming(WarningsOf(town), "'slab'"), 1);
}

TEST(LeftOut, PartsBeneathTheTerrainAreNamed) {
  TestTown town;
  town.Ground();
  town.Node("house", NodeKind::kBuilding).Box({5, 5, -0.3f}, {12, 12, 6}).Box({12, 5, -3}, {16, 12, -0.5f});
  town.Node("cellar", NodeKind::kBuilding).Box({20, 5, -3}, {26, 12, -0.5f});
  const std::vector<std::string> warnings = WarningsOf(town);
  EXPECT_EQ(CountNaming(warnings, "'house' (28 m2) has parts beneath"), 1);
  EXPECT_EQ(CountNaming(warnings, "'cellar' leaves nothing in the way"), 1);
}

TEST(LeftOut, ThoseToWhomTheSameHappensStandInOneLine) {
  TestTown town;
  town.Ground();
  town.Node("house", NodeKind::kBuilding).Box({5, 5, 0}, {12, 12, 6});
  for (const char* name : {"sign", "awning", "sign", "banner"})
    town.Node(name, NodeKind::kOther).Box({20, 5, 3}, {21, 5.1f, 3.5f});
  const std::vector<std::string> warnings = WarningsOf(town);
  EXPECT_EQ(CountNaming(warnings, "3 objects leave nothing in the way"), 1);
  EXPECT_EQ(CountNaming(warnings, "'sign' (2 times), 'awning', 'banner'"), 1);
  EXPECT_EQ(warnings.size(), 1u);
}

// ---- Bridges ----

TestTown Bridge(const std::set<Side>& without = {}) {
  TestTown town;
  town.Ground(60, 40);
  town.Node("bridge", NodeKind::kOther).Box({10, 10, 4}, {50, 16, 4.5f}, without);
  town.scene.nodes.back().is_bridge = true;
  return town;
}

TEST(Bridges, AreOpenBelowAndTheirPylonsBlock) {
  TestTown town = Bridge();
  town.Box({29, 12, -0.3f}, {31, 14, 4});
  const Footprints f = Extract(town);
  EXPECT_TRUE(Blocked(f, {30, 13}));
  EXPECT_FALSE(Blocked(f, {20, 13}));
  EXPECT_FALSE(Blocked(f, {30, 11}));
}

TEST(Bridges, AreWalkedOverWhereTheGroundLeadsOn) {
  TestTown town;
  town.Node("west", NodeKind::kGround).Quad({0, 0, 0}, {10, 0, 0}, {10, 40, 0}, {0, 40, 0});
  town.Node("east", NodeKind::kGround).Quad({50, 0, 0}, {60, 0, 0}, {60, 40, 0}, {50, 40, 0});
  town.Node("river", NodeKind::kGround).Quad({10, 0, -4}, {50, 0, -4}, {50, 40, -4}, {10, 40, -4});
  town.Node("bridge", NodeKind::kOther).Box({10, 10, -4}, {50, 16, 0});
  town.scene.nodes.back().is_bridge = true;
  const Footprints f = Extract(town);
  EXPECT_FALSE(Blocked(f, {30, 13})) << "on it";
  EXPECT_TRUE(Blocked(f, {30, 10})) << "its side";
  EXPECT_FALSE(Blocked(f, {10, 13})) << "its western end";
  EXPECT_FALSE(Blocked(f, {50, 13})) << "its eastern end";
  GroundRaster raster;
  ASSERT_EQ(RasterizeGround(town.scene, {}, &raster).message, "");
  const LocalGround ground(raster);
  EXPECT_NEAR(ground.Height(30, 13), 0, 0.01);
  EXPECT_NEAR(ground.Height(30, 20), -4, 0.01);
}

TEST(Bridges, WithoutTerrainASolidOneIsNoBlock) {
  TestTown town;
  town.Node("house", NodeKind::kBuilding).Box({0, 0, 0}, {8, 8, 8});
  town.Node("bridge", NodeKind::kBuilding).Box({10, 10, 0}, {50, 16, 4});
  town.scene.nodes.back().is_bridge = true;
  const Footprints f = Extract(town);
  EXPECT_FALSE(Blocked(f, {30, 13}));
  EXPECT_FALSE(Blocked(f, {10, 13}));
  EXPECT_TRUE(Blocked(f, {4, 4}));
}

}  // namespace
}  // namespace flaneur
