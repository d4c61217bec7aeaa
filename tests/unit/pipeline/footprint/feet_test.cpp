// Where houses without floors stand.
#include "pipeline/footprint/feet.h"

#include <gtest/gtest.h>

#include "tests/unit/pipeline/footprint/test_town.h"

namespace flaneur {
namespace {

std::optional<double> FeetOfFirst(const TestTown& town) {
  std::vector<TownObject> objects = SortTown(town.scene, 1).obstacles;
  FindLevelFeet(BlocksOf(Adjoining(objects)), 1, &objects);
  return objects[0].level_feet_m;
}

TEST(LevelFeet, AreWhereTheShellOfABlockIsOpenBelow) {
  TestTown town;
  town.Node("west", NodeKind::kBuilding).Box({0, 0, 3}, {8, 10, 9}, {Side::kEast, Side::kBottom});
  town.Node("east", NodeKind::kBuilding).Box({8, 0, 3}, {15, 10, 9}, {Side::kWest, Side::kBottom});
  EXPECT_EQ(FeetOfFirst(town), 3);
}

TEST(LevelFeet, DoNotMindWhatStandsOnARoof) {
  TestTown town;
  town.Node("house", NodeKind::kBuilding).Box({0, 0, 3}, {8, 10, 9}, {Side::kBottom});
  town.Box({2, 2, 9}, {4, 4, 11}, {Side::kBottom});
  EXPECT_EQ(FeetOfFirst(town), 3);
}

TEST(LevelFeet, AreUnknownWhereAHouseBesideStandsHigher) {
  TestTown town;
  town.Node("low", NodeKind::kBuilding).Box({0, 0, 3}, {8, 10, 9}, {Side::kBottom});
  town.Node("high", NodeKind::kBuilding).Box({8, 0, 9}, {15, 10, 12}, {Side::kBottom});
  EXPECT_EQ(FeetOfFirst(town), std::nullopt);
}

TEST(LevelFeet, AreEachHousesOwnWhereTheyHaveNoCornerInCommon) {
  TestTown town;
  town.Node("low", NodeKind::kBuilding).Box({0, 0, 3}, {8, 10, 9}, {Side::kBottom});
  town.Node("high", NodeKind::kBuilding).Box({8, 1, 5}, {15, 9, 11}, {Side::kBottom});
  EXPECT_EQ(FeetOfFirst(town), 3);
}

TEST(LevelFeet, AreUnknownOnAnothersRoof) {
  TestTown town;
  town.Node("tower", NodeKind::kBuilding).Box({2, 2, 9}, {6, 6, 15}, {Side::kBottom});
  town.Node("house", NodeKind::kBuilding).Box({0, 0, 3}, {8, 10, 9}, {Side::kBottom});
  EXPECT_EQ(FeetOfFirst(town), std::nullopt);
}

TEST(LevelFeet, OfAHouseOnTwoTerracesAreItsFloor) {
  TestTown town;
  town.Node("house", NodeKind::kBuilding).Box({0, 0, 3}, {8, 10, 4}, {Side::kBottom, Side::kEast, Side::kTop});
  town.Box({0, 0, 4}, {8, 10, 9}, {Side::kBottom, Side::kEast});
  town.Box({8, 0, 4}, {16, 10, 9}, {Side::kBottom, Side::kWest});
  town.Quad({8, 0, 3}, {8, 10, 3}, {8, 10, 4}, {8, 0, 4});  // the step
  std::vector<TownObject> objects = SortTown(town.scene, 1).obstacles;
  FindLevelFeet(BlocksOf(Adjoining(objects)), 1, &objects);
  ASSERT_EQ(objects[0].foundation.size(), 4u);
  for (const Triangle3& t : objects[0].foundation) EXPECT_EQ(t[0].z, t[0].x + t[1].x + t[2].x < 24 ? 3 : 4);
}

// One house owns the walls under another's low roof.
TEST(LevelFeet, LieBelowTheRoofOfALowPart) {
  TestTown town;
  town.Node("owner", NodeKind::kBuilding).Box({0, 0, 3}, {8, 10, 9}, {Side::kEast, Side::kBottom});
  town.Box({8, 0, 3}, {15, 10, 6}, {Side::kWest, Side::kTop, Side::kBottom});
  town.Node("low", NodeKind::kBuilding).Quad({8, 0, 6}, {15, 0, 6}, {15, 10, 6}, {8, 10, 6});
  std::vector<TownObject> objects = SortTown(town.scene, 1).obstacles;
  ASSERT_EQ(objects.size(), 2u);
  FindLevelFeet(BlocksOf(Adjoining(objects)), 1, &objects);
  EXPECT_TRUE(objects[1].has_no_floor);
  EXPECT_EQ(objects[1].level_feet_m, 3);
}

TEST(LevelFeet, AreUnknownWhereAHouseIsClosed) {
  TestTown town;
  town.Node("house", NodeKind::kBuilding).Box({0, 0, 3}, {8, 10, 9});
  EXPECT_EQ(FeetOfFirst(town), std::nullopt);
}

}  // namespace
}  // namespace flaneur
