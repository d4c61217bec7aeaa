#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/footprint/base_ground.h"
#include "pipeline/footprint/overhead.h"
#include "pipeline/footprint/rasterize_ground.h"
#include "pipeline/footprint/town_objects.h"
#include "tests/unit/pipeline/footprint/test_town.h"

namespace flaneur {
namespace {

size_t CellAt(const GroundRaster& raster, double x, double y) {
  const int column = static_cast<int>((x - raster.min_m.x) / raster.cell_m);
  const int row = static_cast<int>((y - raster.min_m.y) / raster.cell_m);
  return static_cast<size_t>(row * raster.columns + column);
}

GroundRaster Rasterize(const TestTown& town, const GroundRasterOptions& options = {}) {
  GroundRaster raster;
  EXPECT_EQ(RasterizeGround(town.scene, options, &raster).message, "");
  return raster;
}

TEST(RasterizeGround, CoversTheGroundAndFollowsItsHeight) {
  TestTown town;
  town.Ground(40, 30, 0.1f);
  const GroundRaster raster = Rasterize(town);
  EXPECT_EQ(raster.columns, 160);
  EXPECT_EQ(raster.rows, 120);
  for (const double x : {1.0, 17.3, 39.0}) {
    const size_t cell = CellAt(raster, x, 12);
    EXPECT_EQ(raster.kind[cell], static_cast<uint8_t>(GroundKind::kSquare));
    EXPECT_NEAR(raster.height_m[cell], 0.1 * x, 0.1 * raster.cell_m);
  }
}

TEST(RasterizeGround, TheTopmostGroundWinsWhateverTheOrder) {
  const auto add_kerb = [](TestTown* town) {
    town->Node("pavement", NodeKind::kGround);
    town->scene.nodes.back().ground = GroundKind::kPavement;
    town->Quad({5, 5, 0.12f}, {10, 5, 0.12f}, {10, 10, 0.12f}, {5, 10, 0.12f});
  };
  TestTown below, above;
  below.Ground(), add_kerb(&below);
  add_kerb(&above), above.Ground();
  for (const TestTown* town : {&below, &above}) {
    const GroundRaster raster = Rasterize(*town);
    EXPECT_EQ(raster.kind[CellAt(raster, 7, 7)], static_cast<uint8_t>(GroundKind::kPavement));
    EXPECT_FLOAT_EQ(raster.height_m[CellAt(raster, 7, 7)], 0.12f);
    EXPECT_EQ(raster.kind[CellAt(raster, 12, 7)], static_cast<uint8_t>(GroundKind::kSquare));
  }
}

// Two tiles with a crack between them, along either axis; the second higher by `step_m`.
bool IsWhole(float crack_m, float offset_m, float step_m, bool northwards) {
  TestTown town;
  const auto tile = [&](float from, float to, float z) {
    const auto at = [&](float along, float across) {
      return northwards ? Vec3{across, along, z} : Vec3{along, across, z};
    };
    town.Node("tile", NodeKind::kGround);
    town.Quad(at(from, 0), at(to, 0), at(to, 8), at(from, 8));
  };
  const float border_m = 5 + offset_m;
  tile(0, border_m, 0), tile(border_m + crack_m, 12, step_m);
  const GroundRaster raster = Rasterize(town);
  for (double along = 1; along < 11; along += 0.25) {
    if (raster.kind[northwards ? CellAt(raster, 4, along) : CellAt(raster, along, 4)] == 0) return false;
  }
  return true;
}

TEST(RasterizeGround, PeopleStepOverCracksButNotOverDitchesAndTerraces) {
  for (const bool northwards : {false, true}) {
    for (float offset_m = 0; offset_m < 0.25f; offset_m += 0.03f) {
      for (const float crack_m : {0.001f, 0.02f, 0.1f, 0.3f, 0.49f}) {
        EXPECT_TRUE(IsWhole(crack_m, offset_m, 0.1f, northwards)) << crack_m << " " << offset_m;
        if (crack_m > 0.26f) {
          EXPECT_FALSE(IsWhole(crack_m, offset_m, 1, northwards)) << crack_m << " " << offset_m;
        }
      }
      EXPECT_FALSE(IsWhole(0.8f, offset_m, 0.1f, northwards)) << offset_m;
    }
  }
}

TEST(RasterizeGround, ATownWithoutGroundStandsOnASquare) {
  TestTown town;
  town.Node("house", NodeKind::kBuilding).Box({10, 10, 2}, {18, 16, 8});
  const GroundRaster raster = Rasterize(town);
  EXPECT_NE(raster.kind[CellAt(raster, 5, 13)], 0);
  EXPECT_FLOAT_EQ(raster.height_m[CellAt(raster, 5, 13)], 2);
}

TEST(RasterizeGround, LargeTownsGetCoarserCells) {
  TestTown town;
  town.Ground(400, 300);
  GroundRasterOptions options;
  options.max_cells = 10'000;
  const GroundRaster raster = Rasterize(town, options);
  EXPECT_LE(raster.columns * raster.rows, 10'000);
  EXPECT_GT(raster.cell_m, 0.25f);
}

TEST(RasterizeGround, RefusesNothingAndTheWholeWorld) {
  GroundRaster raster;
  EXPECT_NE(RasterizeGround(Scene(), {}, &raster).message, "");
  TestTown wide;
  wide.Ground(200'000, 10);
  EXPECT_NE(RasterizeGround(wide.scene, {}, &raster).message.find("100 km"), std::string::npos);
}

TEST(LocalGround, GoesOnUnderHousesAndBeyondTheEdge) {
  TestTown town;
  town.Node("ground", NodeKind::kGround);
  town.Quad({0, 0, 1}, {10, 0, 1}, {10, 30, 1}, {0, 30, 1});
  town.Quad({20, 0, 1}, {40, 0, 1}, {40, 30, 1}, {20, 30, 1});
  const LocalGround ground(Rasterize(town));
  EXPECT_NEAR(ground.Height(15, 15), 1, 1e-3) << "in the gap";
  EXPECT_NEAR(ground.Height(-50, 15), 1, 1e-3);
}

TEST(Overhead, FindsTheLowestSurfaceAbove) {
  const std::vector<Triangle3> roof = {{{{0, 0, 3}, {4, 0, 3}, {0, 4, 3}}}, {{{0, 0, 6}, {4, 0, 6}, {0, 4, 6}}}};
  const Overhead overhead({&roof});
  EXPECT_DOUBLE_EQ(overhead.LowestAbove({1, 1}, 0), 3);
  EXPECT_DOUBLE_EQ(overhead.LowestAbove({1, 1}, 4), 6);
  EXPECT_FALSE(overhead.Covers({1, 1}, 7));
  EXPECT_FALSE(overhead.Covers({3.5, 3.5}, 0)) << "beside the triangles";
}

TEST(SortTown, TellsUntaggedNodesByNameAndShape) {
  TestTown town;
  town.Node("Street_01", NodeKind::kUntagged).Box({0, 0, 0}, {10, 4, 0.5f});
  town.Node("tree_small", NodeKind::kUntagged).Box({2, 6, 0}, {3, 7, 4});
  town.Node("slab", NodeKind::kUntagged).Box({20, 0, 0}, {30, 10, 0.1f});
  town.Node("blacksmith", NodeKind::kUntagged).Box({12, 6, 0}, {16, 9, 5});
  const TownObjects objects = SortTown(town.scene, 1);
  EXPECT_EQ(objects.ground.size(), 2u);
  ASSERT_EQ(objects.obstacles.size(), 2u);
  EXPECT_EQ(objects.obstacles[0].kind, ObstacleKind::kTree);
  EXPECT_EQ(objects.obstacles[1].name, "blacksmith");
  EXPECT_EQ(objects.obstacles[1].kind, ObstacleKind::kBuilding);
}

TEST(SortTown, ReadsWholeWordsAndTakesNothingHighForGround) {
  TestTown town;
  town.Node("Broadway Inn", NodeKind::kUntagged).Box({0, 0, 0}, {10, 4, 6});
  town.Node("mountain_A_grass", NodeKind::kUntagged).Box({20, 0, 0}, {30, 10, 8});
  town.Node("street_lamp.003", NodeKind::kUntagged).Box({2, 6, 0}, {2.2f, 6.2f, 4});
  town.Node("HexGrass", NodeKind::kUntagged).Box({40, 0, 0}, {50, 10, 2});
  const TownObjects objects = SortTown(town.scene, 1);
  ASSERT_EQ(objects.obstacles.size(), 3u);
  EXPECT_EQ(objects.obstacles[0].kind, ObstacleKind::kBuilding);
  EXPECT_EQ(objects.obstacles[1].kind, ObstacleKind::kBuilding);
  EXPECT_EQ(objects.obstacles[2].kind, ObstacleKind::kLamp);
  ASSERT_EQ(objects.ground.size(), 1u);
  EXPECT_EQ(objects.ground[0].kind, GroundKind::kGrass);
}

// A shell whose flat roof is an object of its own.
void AddShell(TestTown* town) {
  town->Node("shell", NodeKind::kUntagged).Box({0, 0, 0}, {20, 10, 6}, {Side::kTop, Side::kBottom});
  town->Node("roof", NodeKind::kUntagged).Quad({0, 0, 6}, {20, 0, 6}, {20, 10, 6}, {0, 10, 6});
}

TEST(SortTown, AFlatRoofIsNoGroundWhereThereIsNoOther) {
  TestTown bare, among, carries;
  AddShell(&bare);
  const TownObjects roof = SortTown(bare.scene, 1);
  EXPECT_TRUE(roof.ground.empty() && roof.flat.empty());
  ASSERT_EQ(roof.obstacles.size(), 2u);
  EXPECT_EQ(roof.obstacles[1].name, "roof");

  among.Ground();
  AddShell(&among);
  EXPECT_EQ(SortTown(among.scene, 1).ground.size(), 2u) << "there is other ground";

  AddShell(&carries);
  carries.Node("house", NodeKind::kUntagged).Box({5, 3, 6}, {12, 8, 12});
  EXPECT_EQ(SortTown(carries.scene, 1).ground.size(), 1u) << "a house stands on it: a terrace";
}

// Walls of a tower that stands on a house's roof at its edge, and those that hang over a passage.
TEST(BaseOf, WallsOnRoofsAndOverPassagesAreNoFeet) {
  TestTown town;
  town.Node("house", NodeKind::kBuilding).Box({0, 0, 0}, {60, 40, 8}, {Side::kBottom});
  town.Box({30, 0, 8}, {60, 24, 14}, {Side::kBottom});
  town.Box({60, 6, 3}, {64, 14, 8});
  const TownObjects objects = SortTown(town.scene, 1);
  const GroundRaster base = BaseOf(objects.obstacles[0]);
  EXPECT_NEAR(*std::max_element(base.height_m.begin(), base.height_m.end()), 0, 1e-6);
}

TEST(SortTown, PartsOfOneTaggedNodeAreOneObject) {
  TestTown town;
  town.Node("house", NodeKind::kBuilding).Box({10, 10, 0}, {18, 16, 8});
  town.Node("chimney", NodeKind::kBuilding).Box({12, 12, 8}, {13, 13, 10});
  town.scene.nodes.back().parent = 0;
  const TownObjects objects = SortTown(town.scene, 1);
  ASSERT_EQ(objects.obstacles.size(), 1u);
  EXPECT_EQ(objects.obstacles[0].name, "house");
  EXPECT_EQ(objects.obstacles[0].triangles.size(), 24u);
}

}  // namespace
}  // namespace flaneur
