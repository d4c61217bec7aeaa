#include "pipeline/footprint/untold_ground.h"

#include <gtest/gtest.h>

#include "tests/unit/pipeline/footprint/test_town.h"

namespace flaneur {
namespace {

// A hill of strips that rises to the east, `named` or one mesh with all else; houses on it, open below, some with flat
// roofs.
TestTown Hill(const char* named, bool one_mesh, bool turned) {
  TestTown town;
  const auto height = [](float x) { return 0.1f * x; };
  const auto node = [&](const std::string& name) {
    if (!one_mesh || town.scene.nodes.empty()) town.Node(name, NodeKind::kUntagged);
  };
  node(named);
  for (int i = 0; i < 30; ++i) {
    const float x0 = 4 * static_cast<float>(i), x1 = x0 + 4;
    const Vec3 a{x0, 0, height(x0)}, b{x1, 0, height(x1)}, c{x1, 80, height(x1)}, d{x0, 80, height(x0)};
    if (turned) town.Quad(d, c, b, a);
    else town.Quad(a, b, c, d);
  }
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 3; ++j) {
      const float x = 10 + 28 * static_cast<float>(i), y = 10 + 24 * static_cast<float>(j);
      node("b" + std::to_string(10 * i + j));
      town.Box({x, y, height(x) - 1}, {x + 12, y + 10, height(x) + 8}, {Side::kBottom});
    }
  }
  return town;
}

double GroundArea(const TownObjects& town) {
  double area_m2 = 0;
  for (const GroundPatch& patch : town.ground)
    for (const auto& [a, b, c] : patch.triangles)
      area_m2 += std::abs((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y)) / 2;
  return area_m2;
}

TEST(UntoldGround, IsFoundWhateverItIsCalledAndHoweverItIsJoined) {
  for (const bool one_mesh : {false, true}) {
    for (const bool turned : {false, true}) {
      const TownObjects town = SortTown(Hill("Object_4", one_mesh, turned).scene, 1);
      EXPECT_NEAR(GroundArea(town), 120 * 80, 1) << one_mesh << turned;
      EXPECT_EQ(town.obstacles.size(), one_mesh ? 1u : 12u);
      EXPECT_EQ(town.untold, std::vector<std::string>{"Object_4"});
    }
  }
}

TEST(UntoldGround, IsNotLookedForWhereTheTownSaysWhatItIs) {
  for (const char* name :
       {"terrain", "Gel\xC3\xA4nde", "Hanggel\xC3\xA4nde.001", "Boden", "DGM_5", "\xE5\x9C\xB0\xE5\xBD\xA2"}) {
    const TownObjects town = SortTown(Hill(name, false, false).scene, 1);
    EXPECT_NEAR(GroundArea(town), 120 * 80, 1) << name;
    EXPECT_EQ(town.obstacles.size(), 12u) << name;
    EXPECT_TRUE(town.untold.empty()) << name;
  }
}

// Streets that rise and fall, each an object of its own or all things in one mesh; houses along them, nothing in
// between, and far away a chapel: in all a small part of what the town spans.
TestTown Streets(bool one_mesh = false) {
  TestTown town;
  const auto node = [&](const std::string& name) -> TestTown& {
    if (!one_mesh || town.scene.nodes.empty()) town.Node(name, NodeKind::kUntagged);
    return town;
  };
  for (int i = 0; i < 4; ++i) {
    const float y = 30 * static_cast<float>(i), fall = 0.5f + 0.3f * static_cast<float>(i % 2);
    node("object_1" + std::to_string(i)).Quad({0, y, 0}, {60, y, fall}, {60, y + 8, fall}, {0, y + 8, 0});
    for (int k = 0; k < 4; ++k) {
      const float x = 15 * static_cast<float>(k);
      node("h" + std::to_string(4 * i + k)).Box({x, y + 8, -0.5f}, {x + 10, y + 16, 6});
    }
  }
  node("object_20").Box({600, 500, 0}, {606, 512, 9});
  return town;
}

TEST(UntoldGround, IsFoundInStreetsOfTheirOwnHoweverPatchyTheTownIs) {
  for (const bool one_mesh : {false, true}) {
    const TownObjects objects = SortTown(Streets(one_mesh).scene, 1);
    EXPECT_NEAR(GroundArea(objects), 4 * 60 * 8, 1) << one_mesh;
    EXPECT_EQ(objects.obstacles.size(), one_mesh ? 1u : 17u);
  }
}

TEST(UntoldGround, IsAMeadowToo) {
  TestTown town = Streets();
  town.Node("object_8", NodeKind::kUntagged).Quad({100, 0, 2}, {120, 0, 3}, {120, 40, 3.5f}, {100, 40, 2});
  const TownObjects objects = SortTown(town.scene, 1);
  EXPECT_NEAR(GroundArea(objects), 4 * 60 * 8 + 20 * 40, 1);
  EXPECT_EQ(objects.obstacles.size(), 17u);
}

TEST(UntoldGround, LeavesHousesOnAPlaneAsTheyAre) {
  TestTown town;
  town.Node("object_1", NodeKind::kUntagged).Quad({0, 0, 0}, {60, 0, 0}, {60, 60, 0}, {0, 60, 0});
  for (const float x : {10.0f, 35.0f})
    town.Node("object_" + std::to_string(x), NodeKind::kUntagged).Box({x, 20, 0}, {x + 10, 30, 6});
  const TownObjects objects = SortTown(town.scene, 1);
  EXPECT_NEAR(GroundArea(objects), 60 * 60, 1);
  ASSERT_EQ(objects.obstacles.size(), 2u);
  for (const TownObject& house : objects.obstacles) EXPECT_EQ(house.triangles.size(), 12u);
}

// Water is flat, and ground for that; the streets beside it are not.
TEST(UntoldGround, IsFoundBesideFlatWater) {
  TestTown town = Streets();
  town.Node("object_7", NodeKind::kUntagged).Quad({0, -60, -0.4f}, {100, -60, -0.4f}, {100, -2, -0.4f}, {0, -2, -0.4f});
  const TownObjects objects = SortTown(town.scene, 1);
  EXPECT_EQ(objects.flat, std::vector<std::string>{"object_7"});
  EXPECT_NEAR(GroundArea(objects), 100 * 58 + 4 * 60 * 8, 1);
  EXPECT_EQ(objects.obstacles.size(), 17u);
}

// A mirrored model whose faces all show their backs: the ground is the block's upper side, not the lower that then
// shows upwards.
TEST(UntoldGround, OfATownInsideOutIsItsUpperSide) {
  for (const bool inside_out : {false, true}) {
    TestTown town;
    town.Node("block", NodeKind::kUntagged).Box({-40, -40, -1}, {40, 40, 0});
    for (const float x : {-20.0f, 0.0f, 20.0f})
      town.Node("house_" + std::to_string(x), NodeKind::kUntagged).Box({x, 0, 0}, {x + 9, 8, 6});
    if (inside_out)
      for (Mesh& mesh : town.scene.meshes)
        for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) std::swap(mesh.indices[i], mesh.indices[i + 1]);
    const TownObjects objects = SortTown(town.scene, 1);
    EXPECT_NEAR(GroundArea(objects), 80 * 80, 1) << inside_out;
    for (const GroundPatch& patch : objects.ground)
      for (const Triangle3& t : patch.triangles) EXPECT_NEAR(t[0].z, 0, 1e-6) << inside_out;
  }
}

// Round a hill, as high everywhere: uphill there is more of it in the ground than above.
TEST(UntoldGround, CarriesATownWallThatIsSunkIntoIt) {
  TestTown town = Hill("Object_4", true, false);
  const auto wall = [&](Vec3 low, Vec3 high) { town.Box(low, high, {Side::kBottom}); };
  wall({0, 0, -3}, {120, 1, 12.5f});
  wall({0, 79, -3}, {120, 80, 12.5f});
  wall({119, 1, -3}, {120, 79, 12.5f});
  const TownObjects objects = SortTown(town.scene, 1);
  EXPECT_GT(GroundArea(objects), 0.9 * 120 * 80);
}

// Nothing but houses: flat roofs, and in the second town the floors of rooms.
TEST(UntoldGround, RoofsAndFloorsAreNone) {
  for (const bool floors : {false, true}) {
    TestTown town;
    for (int i = 0; i < 6; ++i) {
      const float x = 20 * static_cast<float>(i);
      town.Node("b" + std::to_string(i), NodeKind::kUntagged).Box({x, 0, 0}, {x + 14, 30, 6});
      if (floors) town.Quad({x, 0, 0.1f}, {x + 14, 0, 0.1f}, {x + 14, 30, 0.1f}, {x, 30, 0.1f});
    }
    const TownObjects objects = SortTown(town.scene, 1);
    EXPECT_TRUE(objects.ground.empty() && objects.untold.empty()) << floors;
    EXPECT_EQ(objects.obstacles.size(), 6u);
  }
}

TEST(SortTown, KnowsWordsOfOtherLanguages) {
  TestTown town;
  town.Node(
          "Breite Herzogstra\xC3\x9F"
          "e",
          NodeKind::kUntagged)
      .Box({0, 0, 0}, {30, 4, 0.5f});
  town.Node("Stadtmarktplatz", NodeKind::kUntagged).Box({0, 10, 0}, {30, 30, 0.5f});
  town.Node("Kastanienbaum.003", NodeKind::kUntagged).Box({2, 12, 0}, {3, 13, 4});
  town.Node("Haus am Platz", NodeKind::kUntagged).Box({40, 10, 0}, {50, 20, 9});
  const TownObjects objects = SortTown(town.scene, 1);
  ASSERT_EQ(objects.ground.size(), 2u);
  EXPECT_EQ(objects.ground[0].kind, GroundKind::kCarriageway);
  EXPECT_EQ(objects.ground[1].kind, GroundKind::kSquare);
  ASSERT_EQ(objects.obstacles.size(), 2u);
  EXPECT_EQ(objects.obstacles[0].kind, ObstacleKind::kTree);
  EXPECT_EQ(objects.obstacles[1].kind, ObstacleKind::kBuilding);
}

}  // namespace
}  // namespace flaneur
