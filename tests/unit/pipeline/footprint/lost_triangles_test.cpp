// Towns that have lost triangles: what houses have together is put back.
#include <gtest/gtest.h>

#include "pipeline/footprint/repair_block.h"
#include "tests/unit/pipeline/footprint/test_town.h"

namespace flaneur {
namespace {

// Two houses without a wall between them.
TestTown TwoHouses() {
  TestTown town;
  town.Node("west", NodeKind::kBuilding).Box({0, 0, 0}, {8, 10, 6}, {Side::kEast});
  town.Node("east", NodeKind::kBuilding).Box({8, 0, 0}, {15, 10, 6}, {Side::kWest});
  return town;
}

std::vector<MissingTriangle> Missing(const std::vector<TownObject>& houses) {
  std::vector<const TownObject*> all;
  for (const TownObject& house : houses) all.push_back(&house);
  return MissingTogether(all);
}

TEST(MissingTogether, IsNothingWhereHousesCloseEachOther) {
  EXPECT_TRUE(Missing(SortTown(TwoHouses().scene, 1).obstacles).empty());
}

TEST(MissingTogether, IsEachTriangleThatWasLost) {
  const std::vector<TownObject> houses = SortTown(TwoHouses().scene, 1).obstacles;
  for (size_t k = 0; k < houses.size(); ++k) {
    for (size_t i = 0; i < houses[k].triangles.size(); ++i) {
      std::vector<TownObject> spoilt = houses;
      spoilt[k].triangles.erase(spoilt[k].triangles.begin() + static_cast<long>(i));
      const std::vector<MissingTriangle> missing = Missing(spoilt);
      ASSERT_EQ(missing.size(), 1u);
      EXPECT_EQ(missing[0].member, k);
      EXPECT_TRUE(missing[0].is_of_face);
    }
  }
}

TEST(MissingTogether, IsAWholeWallToo) {
  TestTown town;
  town.Node("west", NodeKind::kBuilding).Box({0, 0, 0}, {8, 10, 6}, {Side::kEast, Side::kSouth});
  town.Node("east", NodeKind::kBuilding).Box({8, 0, 0}, {15, 10, 6}, {Side::kWest});
  const std::vector<MissingTriangle> missing = Missing(SortTown(town.scene, 1).obstacles);
  ASSERT_EQ(missing.size(), 2u);
  for (const MissingTriangle& each : missing) EXPECT_EQ(each.member, 0u);
}

// A wall's and a floor's with an edge in common leave a hole that is not plane.
TEST(MissingTogether, GoesOnInThePlanesBesideIt) {
  TestTown town;
  town.Node("house", NodeKind::kBuilding).Box({0, 0, 0}, {8, 10, 6});
  TownObject house = SortTown(town.scene, 1).obstacles[0];
  const auto is_lost = [](const Triangle3& t) {  // the lower of the southern wall's, and the southern of the floor's
    const auto lies = [&](auto test) { return std::all_of(t.begin(), t.end(), test); };
    const auto count = [&](auto test) { return std::count_if(t.begin(), t.end(), test); };
    const auto is_south = [](const Point3& p) { return p.y == 0; };
    const auto is_low = [](const Point3& p) { return p.z == 0; };
    return (lies(is_south) && count(is_low) == 2) || (lies(is_low) && count(is_south) == 2);
  };
  ASSERT_EQ(std::erase_if(house.triangles, is_lost), 2u);
  const std::vector<MissingTriangle> missing = MissingTogether({&house}, Holes::kPartsOfFaces);
  EXPECT_EQ(missing.size(), 2u);
  for (const MissingTriangle& each : missing) EXPECT_TRUE(is_lost(each.triangle));
}

TEST(MissingTogether, IsNoRoofOverAWalledYard) {
  TestTown town;
  town.Node("house", NodeKind::kBuilding).Box({0, 0, 0}, {8, 10, 6}, {Side::kEast});
  town.Node("walls", NodeKind::kBuilding).Box({8, 0, 0}, {15, 10, 6}, {Side::kTop, Side::kBottom});
  EXPECT_TRUE(Missing(SortTown(town.scene, 1).obstacles).empty());
}

// Such is a house that has lost its roof. It is no terrain for houses that stand higher and lower on a hill.
TEST(LostTriangles, ASlabAmongManyHousesIsNoGround) {
  TestTown town;
  for (int i = 0; i < 8; ++i) {
    const float x = 20.0f * static_cast<float>(i), z = 3.0f * static_cast<float>(i);
    town.Node("house_" + std::to_string(i), NodeKind::kUntagged).Box({x, 0, z}, {x + 10, 10, z + 6});
  }
  town.Node("slab", NodeKind::kUntagged).Quad({90, 20, 12}, {100, 20, 12}, {100, 30, 12}, {90, 30, 12});
  const Footprints f = Extract(town);
  EXPECT_EQ(f.obstacles.size(), 8u);
  for (int i = 0; i < 8; ++i) EXPECT_TRUE(Blocked(f, {20.0 * i + 5, 5})) << i;
}

}  // namespace
}  // namespace flaneur
