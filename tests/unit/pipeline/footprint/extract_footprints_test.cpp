#include "pipeline/footprint/extract_footprints.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>

#include "pipeline/footprint/check.h"
#include "tests/unit/pipeline/footprint/test_town.h"

namespace flaneur {
namespace {

constexpr double kSlack_m2 = 0.005;

// A house of 8 m x 6 m whose walls, enlarged by 5 cm, are this.
TestTown House(const std::set<Side>& without = {}) {
  TestTown town;
  town.Ground().Node("house", NodeKind::kBuilding).Box({10, 10, TestTown::kBelow}, {18, 16, 8}, without);
  return town;
}
Rings HouseArea(double clearance = 0.05) {
  return {Rectangle(10 - clearance, 10 - clearance, 18 + clearance, 16 + clearance)};
}

bool SameFootprints(const Footprints& a, const Footprints& b) {
  const auto same = [](const Ring& r, const Ring& s) {
    return std::equal(r.begin(), r.end(), s.begin(), s.end(),
                      [](Point2 p, Point2 q) { return p.x == q.x && p.y == q.y; });
  };
  return std::equal(a.obstacles.begin(), a.obstacles.end(), b.obstacles.begin(), b.obstacles.end(),
                    [&](const Obstacle& o, const Obstacle& p) {
                      return o.name == p.name && same(o.outer, p.outer) &&
                             std::equal(o.holes.begin(), o.holes.end(), p.holes.begin(), p.holes.end(), same);
                    });
}

TEST(ExtractFootprints, ABoxIsItselfEnlargedByTheClearance) {
  for (const double clearance : {0.0, 0.03, 0.05, 0.2}) {
    FootprintOptions options;
    options.clearance_m = clearance;
    options.tolerance_m = 0;
    const Footprints f = Extract(House(), options);
    ASSERT_EQ(f.obstacles.size(), 1u);
    EXPECT_LT(Differ(AreaOf(f), HouseArea(clearance)), kSlack_m2) << clearance;
    EXPECT_EQ(f.obstacles[0].clearance_m, clearance);
  }
}

TEST(ExtractFootprints, RingsAreSimpleAndRunTheRightWay) {
  TestTown town;
  town.Ground().Node("ring", NodeKind::kWall);
  town.Box({10, 10, -1}, {20, 10.4f, 3}).Box({10, 19.6f, -1}, {20, 20, 3});
  town.Box({10, 10, -1}, {10.4f, 20, 3}).Box({19.6f, 10, -1}, {20, 20, 3});
  const Footprints f = Extract(town);
  ASSERT_EQ(f.obstacles.size(), 1u);
  EXPECT_GT(SignedArea(f.obstacles[0].outer), 0);
  ASSERT_EQ(f.obstacles[0].holes.size(), 1u);
  EXPECT_LT(SignedArea(f.obstacles[0].holes[0]), 0);
  EXPECT_NEAR(SignedArea(f.obstacles[0].outer), 10.1 * 10.1, 0.01);
  EXPECT_NEAR(SignedArea(f.obstacles[0].holes[0]), -9.1 * 9.1, 0.01);
}

// ---- Messy shells give what the clean one gives ----

struct Mess {
  const char* name;
  void (*apply)(Mesh*);
};

template <typename Function>
void ForTriangles(Mesh* mesh, const Function& function) {
  for (size_t i = 0; i < mesh->indices.size() / 3; ++i) function(i, &mesh->indices[3 * i]);
}

void FlipAll(Mesh* mesh) {
  ForTriangles(mesh, [](size_t, uint32_t* triangle) { std::swap(triangle[1], triangle[2]); });
}
void FlipSome(Mesh* mesh) {
  ForTriangles(mesh, [](size_t i, uint32_t* triangle) {
    if (i % 3 == 0) std::swap(triangle[1], triangle[2]);
  });
}
void Double(Mesh* mesh) {
  const std::vector<uint32_t> all = mesh->indices;
  mesh->indices.insert(mesh->indices.end(), all.begin(), all.end());
}
void Jitter(Mesh* mesh) {
  std::mt19937 random(7);
  const auto step = [&] { return static_cast<float>(random() % 1001) * 1e-5f - 0.005f; };
  for (Vec3& p : mesh->positions) p.x += step(), p.z += step();
}
void AddDegenerate(Mesh* mesh) {
  for (uint32_t i = 0; i < 6; ++i) mesh->indices.insert(mesh->indices.end(), {i, i, i + 1});
}

constexpr Mess kMesses[] = {{"AllFlipped", FlipAll},
                            {"SomeFlipped", FlipSome},
                            {"Doubled", Double},
                            {"Jittered", Jitter},
                            {"Degenerate", AddDegenerate}};

class MessyShell : public testing::TestWithParam<Mess> {};

std::string NameOf(const testing::TestParamInfo<Mess>& mess) { return mess.param.name; }

TEST_P(MessyShell, KeepsItsFootprint) {
  TestTown town = House();
  GetParam().apply(&town.scene.meshes.back());
  const Footprints f = Extract(town);
  EXPECT_LT(Differ(AreaOf(f), HouseArea()), 28 * 0.01) << "more than 1 cm along 28 m of walls";
  EXPECT_TRUE(Blocked(f, {14, 13}));
}

INSTANTIATE_TEST_SUITE_P(All, MessyShell, testing::ValuesIn(kMesses), NameOf);

TEST(ExtractFootprints, NeedsNeitherFloorNorCellar) {
  TestTown town;
  town.Ground().Node("house", NodeKind::kBuilding).Box({10, 10, 0}, {18, 16, 8}, {Side::kBottom});
  EXPECT_LT(Differ(AreaOf(Extract(town)), HouseArea()), kSlack_m2);
}

// Where so much is gone that a person would walk in, nobody can tell whether the wall or the model ends there.
TEST(ExtractFootprints, AHouseWithAFallenTriangleIsSolidOrNamed) {
  int solid = 0;
  for (size_t dropped = 0; dropped < 8; ++dropped) {  // the walls come first
    TestTown town = House();
    std::vector<uint32_t>& indices = town.scene.meshes.back().indices;
    indices.erase(indices.begin() + static_cast<long>(3 * dropped),
                  indices.begin() + static_cast<long>(3 * dropped + 3));
    FootprintStats stats;
    if (Blocked(Extract(town, {}, &stats), {14, 13})) ++solid;
    else EXPECT_EQ(stats.open_shells, std::vector<std::string>{"house"}) << dropped;
  }
  EXPECT_GE(solid, 4) << "the upper triangles are not missed between ground and head";
}

TEST(ExtractFootprints, WallsThatMissEachOtherByLittleStillClose) {
  TestTown town;
  town.Ground().Node("house", NodeKind::kBuilding);
  town.Quad({10, 10, -1}, {17.97f, 10, -1}, {17.97f, 10, 8}, {10, 10, 8});  // 3 cm short of the east wall
  town.Box({10, 10, -1}, {18, 16, 8}, {Side::kSouth});
  const Footprints f = Extract(town);
  EXPECT_TRUE(Blocked(f, {14, 13}));
  EXPECT_LT(Differ(AreaOf(f), HouseArea()), 0.05);
}

// The fourth wall of the one house is the other's.
TEST(ExtractFootprints, HousesThatShareOneWallAreBothSolid) {
  TestTown town;
  town.Ground();
  town.Node("west", NodeKind::kBuilding).Box({10, 10, -1}, {14, 16, 8}, {Side::kEast});
  town.Node("east", NodeKind::kBuilding).Box({14, 10, -1}, {18, 16, 9});
  FootprintStats stats;
  const Footprints f = Extract(town, {}, &stats);
  EXPECT_TRUE(Blocked(f, {12, 13}));
  EXPECT_TRUE(Blocked(f, {16, 13}));
  EXPECT_LT(Differ(AreaOf(f), HouseArea()), 0.02);
  EXPECT_TRUE(stats.open_shells.empty()) << "nothing is missing from the two together";
}

// Its two missing walls are its neighbours': no wall runs from corner to corner instead.
TEST(ExtractFootprints, AHouseAtACornerOfABlockKeepsItsCorner) {
  TestTown town;
  town.Ground();
  const float z = TestTown::kBelow;
  town.Node("corner", NodeKind::kBuilding).Box({20, 5, z}, {28, 13, 8}, {Side::kWest, Side::kNorth});
  town.Node("west", NodeKind::kBuilding).Box({10, 5, z}, {20, 13, 8});
  town.Node("north", NodeKind::kBuilding).Box({20, 13, z}, {28, 23, 8});
  FootprintOptions exactly;
  exactly.clearance_m = exactly.tolerance_m = 0;
  const Footprints f = Extract(town, exactly);
  ASSERT_EQ(f.obstacles.size(), 3u);
  EXPECT_LT(Differ(RingsOf(f.obstacles[0]), {Rectangle(20, 5, 28, 13)}), 0.05);
}

TEST(ExtractFootprints, AHouseWithoutOneWallIsOpenOnThatSideAndNamed) {
  FootprintStats stats;
  const Footprints f = Extract(House({Side::kSouth}), {}, &stats);
  EXPECT_TRUE(Blocked(f, {10, 13})) << "the walls that are there block";
  EXPECT_TRUE(Blocked(f, {14, 16}));
  EXPECT_FALSE(Blocked(f, {14, 10})) << "nothing stands there";
  EXPECT_EQ(stats.open_shells, std::vector<std::string>{"house"});
}

TEST(ExtractFootprints, AHouseBehindOneDoorwayIsSolidAndNamed) {
  TestTown town = House({Side::kSouth});
  town.Quad({10, 10, 0}, {13, 10, 0}, {13, 10, 8}, {10, 10, 8})
      .Quad({14, 10, 0}, {18, 10, 0}, {18, 10, 8}, {14, 10, 8});
  FootprintStats stats;
  const Footprints f = Extract(town, {}, &stats);
  EXPECT_LT(Differ(AreaOf(f), HouseArea()), kSlack_m2);
  EXPECT_EQ(stats.open_shells, std::vector<std::string>{"house"});
}

TEST(ExtractFootprints, AWayNoWiderThanItsMouthIsNoRoom) {
  TestTown town;
  town.Ground().Node("passage", NodeKind::kBuilding).Quad({10, 10, 3}, {12, 10, 3}, {12, 16, 3}, {10, 16, 3});
  town.Quad({10, 10, 0}, {10, 16, 0}, {10, 16, 3}, {10, 10, 3})
      .Quad({12, 10, 0}, {12, 16, 0}, {12, 16, 3}, {12, 10, 3});
  town.Quad({10, 16, 0}, {12, 16, 0}, {12, 16, 3}, {10, 16, 3});
  const Footprints f = Extract(town);
  for (double y = 9; y < 15.8; y += 0.25) EXPECT_FALSE(Blocked(f, {11, y})) << y;
  EXPECT_TRUE(Blocked(f, {11, 16}));
}

TEST(ExtractFootprints, AClosedHouseIsNoOpenShell) {
  FootprintStats stats;
  Extract(House(), {}, &stats);
  EXPECT_TRUE(stats.open_shells.empty());
}

// ---- What is overhead does not block ----

TEST(ExtractFootprints, JettiesAndEavesDoNotBlock) {
  TestTown town = House();
  town.Box({9, 9, 2.4f}, {19, 17, 8});              // upper storey, 1 m out
  town.Box({8.5f, 8.5f, 8}, {19.5f, 17.5f, 8.2f});  // roof
  EXPECT_LT(Differ(AreaOf(Extract(town)), HouseArea()), kSlack_m2);
}

TEST(ExtractFootprints, AJettyBelowTheHeadBlocks) {
  TestTown town = House();
  town.Box({9, 9, 1.9f}, {19, 17, 8});
  EXPECT_LT(Differ(AreaOf(Extract(town)), {Rectangle(8.95, 8.95, 19.05, 17.05)}), kSlack_m2);
}

TEST(ExtractFootprints, WhatOneStepsOverDoesNotBlock) {
  TestTown town = House();
  town.Node("kerb", NodeKind::kOther).Box({25, 5, -1}, {30, 8, 0.08f});
  town.Node("block", NodeKind::kOther).Box({25, 15, -1}, {30, 18, 0.15f});
  const Footprints f = Extract(town);
  EXPECT_FALSE(Blocked(f, {27, 6}));
  EXPECT_TRUE(Blocked(f, {27, 16}));
}

TestTown Arcade() {
  TestTown town;
  town.Ground().Node("town_hall", NodeKind::kBuilding);
  town.Box({10, 13, -1}, {20, 18, 9});  // rooms behind the arcade
  town.Box({10, 10, 3}, {20, 13, 9});   // and over it
  for (const float x : {10.0f, 13.2f, 16.4f, 19.6f}) town.Box({x, 10, -1}, {x + 0.4f, 10.4f, 3});
  return town;
}

TEST(ExtractFootprints, AnArcadeIsOpenAndItsPillarsStand) {
  const Footprints f = Extract(Arcade());
  for (const double x : {10.2, 13.4, 16.6, 19.8}) EXPECT_TRUE(Blocked(f, {x, 10.2})) << "pillar at " << x;
  for (double x = 10.1; x < 20; x += 0.2) EXPECT_FALSE(Blocked(f, {x, 11.6})) << "the way along it, at " << x;
  for (const double x : {11.8, 15.0, 18.2}) EXPECT_FALSE(Blocked(f, {x, 10.2})) << "the way into it, at " << x;
  EXPECT_TRUE(Blocked(f, {15, 15}));
  EXPECT_EQ(f.obstacles.size(), 5u);
}

TEST(ExtractFootprints, APassageUnderAHouseIsOpen) {
  TestTown town;
  town.Ground().Node("gatehouse", NodeKind::kBuilding);
  town.Box({10, 10, -1}, {13, 16, 8}).Box({15, 10, -1}, {18, 16, 8}).Box({13, 10, 2.6f}, {15, 16, 8});
  const Footprints f = Extract(town);
  for (double y = 9; y < 17; y += 0.25) EXPECT_FALSE(Blocked(f, {14, y})) << y;
  EXPECT_TRUE(Blocked(f, {11.5, 13}));
  EXPECT_TRUE(Blocked(f, {16.5, 13}));
  EXPECT_LT(Differ(AreaOf(f), {Rectangle(9.95, 9.95, 13.05, 16.05), Rectangle(14.95, 9.95, 18.05, 16.05)}), kSlack_m2);
}

// ---- Enclosures ----

TestTown FourWings(float roof_over_the_yard) {
  TestTown town;
  town.Ground().Node("castle", NodeKind::kBuilding);
  town.Box({10, 5, -1}, {30, 9, 8}).Box({10, 21, -1}, {30, 25, 8});
  town.Box({10, 9, -1}, {14, 21, 8}).Box({26, 9, -1}, {30, 21, 8});
  if (roof_over_the_yard > 0) town.Box({12, 7, roof_over_the_yard}, {28, 23, roof_over_the_yard + 0.5f});
  return town;
}

TEST(ExtractFootprints, AYardOpenToTheSkyIsAHole) {
  const Footprints f = Extract(FourWings(0));
  ASSERT_EQ(f.obstacles.size(), 1u);
  ASSERT_EQ(f.obstacles[0].holes.size(), 1u);
  EXPECT_NEAR(-SignedArea(f.obstacles[0].holes[0]), 11.9 * 11.9, 0.05);
  EXPECT_FALSE(Blocked(f, {20, 15}));
}

TEST(ExtractFootprints, ARoofedEnclosureIsSolid) {
  const Footprints f = Extract(FourWings(9));
  EXPECT_TRUE(Blocked(f, {20, 15}));
  ASSERT_EQ(f.obstacles.size(), 1u);
  EXPECT_TRUE(f.obstacles[0].holes.empty());
}

TEST(ExtractFootprints, AnAirShaftIsFilledWhereItIsSmallerThanAsked) {
  TestTown town;
  town.Ground().Node("house", NodeKind::kBuilding);
  town.Box({10, 10, -1}, {13, 16, 8}).Box({13.6f, 10, -1}, {18, 16, 8});
  town.Box({13, 10, -1}, {13.6f, 12, 8}).Box({13, 12.6f, -1}, {13.6f, 16, 8});  // leaves 0.6 x 0.6 m open
  EXPECT_TRUE(Blocked(Extract(town), {13.3, 12.3}));
  FootprintOptions options;
  options.open_yard_m2 = 0.1;
  EXPECT_FALSE(Blocked(Extract(town, options), {13.3, 12.3}));
}

TEST(ExtractFootprints, AHollowWallIsSolid) {
  TestTown town;
  town.Ground().Node("wall", NodeKind::kBuilding).Box({10, 10, -1}, {20, 10.3f, 4}, {Side::kTop, Side::kBottom});
  const Footprints f = Extract(town);
  ASSERT_EQ(f.obstacles.size(), 1u);
  EXPECT_TRUE(f.obstacles[0].holes.empty()) << "nobody can stand in it";
}

TEST(ExtractFootprints, AWallWithoutThicknessBlocks) {
  TestTown town;
  town.Ground().Node("fence", NodeKind::kWall).Quad({5, 10, 0}, {15, 10, 0}, {15, 10, 1.2f}, {5, 10, 1.2f});
  const Footprints f = Extract(town);
  EXPECT_LT(Differ(AreaOf(f), {Rectangle(4.95, 9.95, 15.05, 10.05)}), kSlack_m2);
}

// ---- Slopes ----

TEST(ExtractFootprints, TheBandFollowsTheGround) {
  TestTown town;
  town.Ground(40, 30, 0.1f);  // 4 m up on 40 m
  town.Node("house", NodeKind::kBuilding).Box({10, 10, -1}, {18, 16, 12});
  // A beam that hangs 2.5 m over the ground at its west end and runs into the slope.
  town.Node("beam", NodeKind::kOther).Box({22, 20, 4.7f}, {39, 20.5f, 5.0f});
  const Footprints f = Extract(town);
  EXPECT_LT(Differ(Intersection(AreaOf(f), {Rectangle(0, 0, 40, 18)}), HouseArea()), 0.02);
  EXPECT_FALSE(Blocked(f, {25, 20.25})) << "2.2 m of headroom";
  EXPECT_TRUE(Blocked(f, {29, 20.25})) << "1.8 m of headroom";
}

TEST(ExtractFootprints, AKerbOnASlopeDoesNotBlock) {
  TestTown town;
  town.Ground(40, 30, 0.1f);
  town.Node("step", NodeKind::kOther)
      .Quad({5, 5, 0.55f}, {35, 5, 3.55f}, {35, 8, 3.55f}, {5, 8, 0.55f});  // 5 cm over the ground all along
  town.Node("house", NodeKind::kBuilding).Box({10, 10, -1}, {18, 16, 12});
  EXPECT_FALSE(Blocked(Extract(town), {20, 6}));
}

// ---- Outlines ----

TEST(ExtractFootprints, SimplifyingNeverUncoversAWall) {
  for (const double tolerance : {0.005, 0.01, 0.04, 0.2}) {
    for (const double clearance : {0.0, 0.02, 0.05}) {
      TestTown town;
      town.Ground().Node("tower", NodeKind::kBuilding).Column({12, 12, -1}, 4, 10, 96);
      FootprintOptions options;
      options.tolerance_m = tolerance;
      options.clearance_m = clearance;
      const Rings area = AreaOf(Extract(town, options));
      for (int i = 0; i < 96; ++i) {
        const double angle = 2 * 3.14159265358979 * (i + 0.5) / 96;
        const Point2 wall{12 + 3.997 * std::cos(angle), 12 + 3.997 * std::sin(angle)};
        EXPECT_TRUE(Contains(area, wall)) << tolerance << " " << clearance << " " << i;
      }
      EXPECT_LT(Area(area), 3.15 * std::pow(4 + std::max(clearance, tolerance) + tolerance, 2));
    }
  }
}

TEST(ExtractFootprints, SimplifyingDropsPoints) {
  TestTown town;
  town.Ground().Node("tower", NodeKind::kBuilding).Column({12, 12, -1}, 4, 10, 96);
  FootprintOptions exact, rough;
  exact.tolerance_m = 0, rough.tolerance_m = 0.04;
  EXPECT_GE(Extract(town, exact).obstacles.at(0).outer.size(), 96u);
  EXPECT_LT(Extract(town, rough).obstacles.at(0).outer.size(), 50u);
}

TEST(ExtractFootprints, SharpCornersDoNotShootOut) {
  TestTown town;
  Mesh mesh;
  town.Ground().Node("wedge", NodeKind::kBuilding);
  town.Quad({10, 10, -1}, {20, 10, -1}, {20, 10, 8}, {10, 10, 8});
  town.Quad({20, 10, -1}, {10, 10.5f, -1}, {10, 10.5f, 8}, {20, 10, 8});
  town.Quad({10, 10.5f, -1}, {10, 10, -1}, {10, 10, 8}, {10, 10.5f, 8});
  town.Quad({10, 10, 8}, {20, 10, 8}, {20, 10, 8}, {10, 10.5f, 8});
  for (const Obstacle& o : Extract(town).obstacles)
    for (const Point2& p : o.outer) EXPECT_LT(p.x, 20 + 3 * 0.05) << "a mitre of less than three clearances";
}

TEST(ExtractFootprints, NeighboursTouchWithoutOverlapping) {
  TestTown town;
  town.Ground();
  for (int i = 0; i < 5; ++i) {
    const float x = 5 + 5.0f * static_cast<float>(i), depth = 14 + static_cast<float>(i % 2);
    town.Node("house_" + std::to_string(i), NodeKind::kBuilding).Box({x, 10, -1}, {x + 5, depth, 8});
  }
  const Footprints f = Extract(town);
  ASSERT_EQ(f.obstacles.size(), 5u);
  double sum = 0;
  for (const Obstacle& o : f.obstacles) sum += Area(RingsOf(o));
  EXPECT_NEAR(sum, Area(AreaOf(f)), 1e-3) << "no square metre twice";
  for (double x = 5; x <= 30; x += 0.05) EXPECT_TRUE(Blocked(f, {x, 12})) << "no crack at " << x;
}

TEST(ExtractFootprints, MergingMakesOneObstacleOfABlock) {
  TestTown town;
  town.Ground();
  town.Node("a", NodeKind::kBuilding).Box({10, 10, -1}, {14, 16, 8});
  town.Node("b", NodeKind::kBuilding).Box({14, 10, -1}, {18, 16, 8});
  town.Node("far", NodeKind::kBuilding).Box({25, 10, -1}, {28, 16, 8});
  FootprintOptions options;
  options.merge_blocks = true;
  const Footprints f = Extract(town, options);
  ASSERT_EQ(f.obstacles.size(), 2u);
  EXPECT_LT(Differ(RingsOf(f.obstacles[0]), HouseArea()), kSlack_m2);
}

// ---- Names, kinds, circles ----

TEST(ExtractFootprints, EveryObstacleKeepsTheNameAndKindOfItsNode) {
  TestTown town = Arcade();
  town.Node("garden wall", NodeKind::kWall).Box({25, 5, -1}, {35, 5.3f, 2});
  town.Node("cart", NodeKind::kOther).Box({30, 20, 0}, {32, 21, 1});
  town.Node("cart", NodeKind::kOther).Box({30, 24, 0}, {32, 25, 1});
  town.Node("oak", NodeKind::kTree, 0.3f).Column({5, 25, 0}, 0.3f, 5, 8);
  const std::map<std::string, ObstacleKind> kinds = {{"town_hall", ObstacleKind::kBuilding},
                                                     {"garden wall", ObstacleKind::kWall},
                                                     {"cart", ObstacleKind::kOther},
                                                     {"oak", ObstacleKind::kTree}};
  std::set<std::string> names, sources;
  for (const Obstacle& o : Extract(town).obstacles) {
    ASSERT_TRUE(kinds.contains(o.source)) << o.source;
    EXPECT_EQ(o.kind, kinds.at(o.source)) << o.name;
    EXPECT_TRUE(o.name.starts_with(o.source)) << o.name;
    EXPECT_TRUE(names.insert(o.name).second) << o.name << " twice";
    sources.insert(o.source);
  }
  EXPECT_EQ(sources.size(), kinds.size());
}

TEST(ExtractFootprints, TreesAndLampsAreCirclesRoundTheirTrunk) {
  TestTown town = House();
  town.Node("oak", NodeKind::kTree, 0.35f).Column({5, 20, 0}, 0.3f, 4, 12).Column({5, 20, 3}, 3, 3, 12);
  town.Node("lamp", NodeKind::kLamp).Column({25, 20, 0}, 0.1f, 4, 12).Column({25, 20, 3}, 0.5f, 1, 12);
  const Footprints f = Extract(town);
  ASSERT_EQ(f.obstacles.size(), 3u);
  EXPECT_TRUE(f.obstacles[1].outer.empty());
  EXPECT_NEAR(f.obstacles[1].radius_m, 0.40, 1e-4) << "tagged radius and clearance";
  EXPECT_NEAR(f.obstacles[1].center.x, 5, 0.01);
  EXPECT_NEAR(f.obstacles[1].center.y, 20, 0.01);
  EXPECT_NEAR(f.obstacles[2].radius_m, 0.15, 0.003) << "measured on the post, not on the lantern";
}

TEST(ExtractFootprints, NodesThatNeverBlockLeaveNothing) {
  TestTown town = House();
  town.Node("hills", NodeKind::kNone).Box({25, 5, -1}, {35, 15, 8});
  town.Gate("door", NodeKind::kDoor, {14, 9.9f}, {0, -1});
  EXPECT_LT(Differ(AreaOf(Extract(town)), HouseArea()), kSlack_m2);
}

TEST(ExtractFootprints, SaysWhichObjectLeavesNothingInTheWay) {
  TestTown town = House();
  town.Node("sign", NodeKind::kOther).Box({25, 5, 2.5f}, {26, 5.1f, 3});
  Footprints footprints;
  std::vector<std::string> warnings;
  ASSERT_EQ(ExtractFootprints(town.scene, {}, &footprints, nullptr, &warnings).message, "");
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("'sign'"), std::string::npos) << warnings[0];
  for (float x : {27.0f, 29.0f}) town.Node("sign", NodeKind::kOther).Box({x, 5, 2.5f}, {x + 1, 5.1f, 3});
  warnings.clear();
  ASSERT_EQ(ExtractFootprints(town.scene, {}, &footprints, nullptr, &warnings).message, "");
  ASSERT_EQ(warnings.size(), 1u) << "of instances once";
  EXPECT_NE(warnings[0].find("(3 times)"), std::string::npos) << warnings[0];
}

// ---- The same every time ----

TEST(ExtractFootprints, TheOrderOfTrianglesDoesNotMatter) {
  TestTown town = Arcade();
  const Footprints before = Extract(town);
  std::mt19937 random(3);
  town.EachMesh([&](Mesh* mesh) {
    std::vector<std::array<uint32_t, 3>> triangles;
    ForTriangles(mesh, [&](size_t, uint32_t* t) { triangles.push_back({t[1], t[2], t[0]}); });
    std::shuffle(triangles.begin(), triangles.end(), random);
    mesh->indices.clear();
    for (const auto& t : triangles) mesh->indices.insert(mesh->indices.end(), t.begin(), t.end());
  });
  EXPECT_TRUE(SameFootprints(before, Extract(town)));
}

TEST(ExtractFootprints, AHouseAKilometreWideIsThatWide) {
  TestTown town;
  town.Node("hall", NodeKind::kBuilding).Box({0, 0, 0}, {1000, 1000, 50});
  const Footprints f = Extract(town);
  ASSERT_EQ(f.obstacles.size(), 1u);
  EXPECT_LT(Differ(AreaOf(f), {Rectangle(-0.05, -0.05, 1000.05, 1000.05)}), 0.5);
}

// Crowns block nothing, also where they come down to 1.5 m; of a bush, and of what hangs in the air, all blocks.
TEST(ExtractFootprints, ATreeIsAsWideAsItsTrunk) {
  const struct {
    float crown_from_m;
    bool has_trunk;
    double radius_m;
  } kTrees[] = {{1.5f, true, 0.2}, {2.5f, true, 0.2}, {0.3f, true, 1.5}, {1.5f, false, 1.5}};
  for (const auto& [from, has_trunk, radius_m] : kTrees) {
    TestTown town;
    town.Ground().Node("tree", NodeKind::kTree);
    if (has_trunk) town.Column({0, 0, 0}, 0.2f, 3, 12);
    town.Column({0, 0, from}, 1.5f, 3, 12);
    const Footprints footprints = Extract(town);
    ASSERT_EQ(footprints.obstacles.size(), 1u) << from;
    EXPECT_NEAR(footprints.obstacles[0].radius_m, radius_m + footprints.clearance_m, 0.01) << from;
  }
}

// In one mesh without ground, a town wall sunk deeper than the houses stand, one of them on posts: the check looks at
// it over the ground that the extraction found.
TEST(ExtractFootprints, ATownWithoutGroundIsCheckedOverTheSameGround) {
  TestTown town;
  town.Node("town", NodeKind::kBuilding);
  const std::set<Side> open{Side::kBottom, Side::kTop};
  for (const float y : {-30.0f, 29.0f}) town.Box({-30, y, -3}, {30, y + 1, 6}, open);
  for (const float x : {-30.0f, 29.0f}) town.Box({x, -29, -3}, {x + 1, 29, 6}, open);
  for (const float x : {-22.0f, -8.0f, 8.0f}) town.Box({x, 8, 0}, {x + 8, 16, 7}, {Side::kBottom});
  for (const float x : {-4.0f, 3.7f})
    for (const float y : {-16.0f, -8.3f}) town.Box({x, y, 0}, {x + 0.3f, y + 0.3f, 2.6f}, {Side::kBottom});
  town.Box({-4.2f, -16.2f, 2.6f}, {4.2f, -7.8f, 5.7f}, {Side::kBottom});
  std::vector<Finding> findings;
  ASSERT_EQ(Check(Extract(town), &town.scene, {}, &findings).message, "");
  for (const Finding& finding : findings) EXPECT_FALSE(finding.code >= 301 && finding.code <= 305) << finding.message;
}

// A low branch on one side drew it aside, off the trunk.
TEST(ExtractFootprints, ATreeStandsWhereItsTrunkDoes) {
  TestTown town;
  town.Ground()
      .Node("tree", NodeKind::kTree, 0.25f)
      .Column({3, 4, 0}, 0.2f, 3, 12)
      .Box({3, 3.9f, 1.6f}, {5, 4.1f, 1.7f});
  const Footprints footprints = Extract(town);
  ASSERT_EQ(footprints.obstacles.size(), 1u);
  EXPECT_NEAR(footprints.obstacles[0].center.x, 3, 0.01);
  EXPECT_NEAR(footprints.obstacles[0].center.y, 4, 0.01);
  EXPECT_NEAR(footprints.obstacles[0].radius_m, 0.25 + footprints.clearance_m, 1e-6);
}

// All lower than a person; or as high as mountains, whatever stands between them.
TEST(ExtractFootprints, TownsOfOddHeightsAreAskedAboutOnce) {
  const struct {
    Vec3 house;
    bool asked;
  } kTowns[] = {{{1.2f, 1, 1.3f}, true}, {{1.2f, 1, 3}, false}, {{300, 280, 400}, true}, {{90, 60, 120}, false}};
  for (const auto& [house, asked] : kTowns) {
    TestTown town;
    for (int i = 0; i < 5; ++i) {
      const float x = 3 * house.x * static_cast<float>(i);
      town.Node("house_" + std::to_string(i), NodeKind::kBuilding).Box({x, 0, 0}, {x + house.x, house.y, house.z});
    }
    Footprints footprints;
    FootprintStats stats;
    std::vector<std::string> warnings;
    ASSERT_EQ(ExtractFootprints(town.scene, {}, &footprints, &stats, &warnings).message, "") << house.z;
    EXPECT_EQ(!stats.doubt_of_units.empty(), asked) << house.z << ": " << stats.doubt_of_units;
    EXPECT_EQ(std::count(warnings.begin(), warnings.end(), stats.doubt_of_units), asked ? 1 : 0);
  }
}

// A post without a top is no roof's, and was nobody's where the model had open walls besides: a scan in one mesh.
TEST(ExtractFootprints, AnOpenPostAmongOpenWallsStands) {
  TestTown town;
  town.Ground().Node("town", NodeKind::kBuilding).Box({10, 10, -0.3f}, {18, 18, 6});
  town.Box({-0.15f, -0.15f, -0.1f}, {0.15f, 0.15f, 3}, {Side::kTop, Side::kBottom});
  for (const Vec3 along : {Vec3{1.5f, 0, 0}, Vec3{0, 1.5f, 0}})
    town.Quad(along * -1 + Vec3{0, 0, 1.5f}, along + Vec3{0, 0, 1.5f}, along + Vec3{0, 0, 4},
              along * -1 + Vec3{0, 0, 4});
  const Footprints footprints = Extract(town);
  const auto post = std::find_if(footprints.obstacles.begin(), footprints.obstacles.end(), [](const Obstacle& o) {
    return Contains(o.outer, {0.14, 0.14});
  });
  EXPECT_NE(post, footprints.obstacles.end());
  std::vector<Finding> findings;
  ASSERT_EQ(Check(footprints, &town.scene, {}, &findings).message, "");
  for (const Finding& finding : findings) EXPECT_FALSE(finding.code >= 301 && finding.code <= 305) << finding.message;
}

TEST(ExtractFootprints, HousesOfOddSizesAreAskedAboutOnce) {
  for (const float size : {0.001f, 0.2f, 20.0f, 8000.0f}) {
    TestTown town;
    for (int i = 0; i < 5; ++i) {
      const float x = 3 * size * static_cast<float>(i);
      town.Node("house_" + std::to_string(i), NodeKind::kBuilding).Box({x, 0, 0}, {x + size, size, 5});
    }
    Footprints footprints;
    std::vector<std::string> warnings;
    ASSERT_EQ(ExtractFootprints(town.scene, {}, &footprints, nullptr, &warnings).message, "") << size;
    const auto asked = std::count_if(warnings.begin(), warnings.end(),
                                     [](const std::string& w) { return w.find("units") != std::string::npos; });
    EXPECT_EQ(asked, size == 20 ? 0 : 1) << size;
  }
  TestTown far;
  far.Node("house", NodeKind::kBuilding).Box({0, 0, 0}, {600'000, 8, 5});
  Footprints footprints;
  const std::string refused = ExtractFootprints(far.scene, {}, &footprints).message;
  EXPECT_NE(refused.find("'house' is 600 km wide"), std::string::npos) << refused;
}

// Several times what takes minutes where every triangle is compared with every other.
TEST(ExtractFootprints, AMillionTrianglesInOneHouseAreTheSameHouse) {
  constexpr int kSquares = 354;
  TestTown town;
  town.Ground().Node("house", NodeKind::kBuilding);
  Mesh mesh;
  const auto sheet = [&](Vec3 corner, Vec3 along) {  // 8 m high
    const auto first = static_cast<uint32_t>(mesh.positions.size()), row = static_cast<uint32_t>(kSquares + 1);
    for (int i = 0; i <= kSquares; ++i)
      for (int k = 0; k <= kSquares; ++k)
        mesh.positions.push_back(GltfFromGround(corner + along * (static_cast<float>(i) / kSquares) +
                                                Vec3{0, 0, 8.0f * static_cast<float>(k) / kSquares}));
    for (uint32_t i = 0; i + 1 < row; ++i)
      for (uint32_t k = 0; k + 1 < row; ++k)
        for (const uint32_t step : {0u, row, row + 1, 0u, row + 1, 1u})
          mesh.indices.push_back(first + i * row + k + step);
  };
  sheet({10, 10, 0}, {8, 0, 0}), sheet({18, 10, 0}, {0, 6, 0}), sheet({18, 16, 0}, {-8, 0, 0}),
      sheet({10, 16, 0}, {0, -6, 0});
  town.Quad({10, 10, 8}, {18, 10, 8}, {18, 16, 8}, {10, 16, 8});
  town.scene.nodes.back().meshes.push_back(static_cast<int>(town.scene.meshes.size()));
  town.scene.meshes.push_back(std::move(mesh));
  FootprintStats stats;
  const Footprints f = Extract(town, {}, &stats);
  EXPECT_GT(stats.triangles, 1'000'000);
  ASSERT_EQ(f.obstacles.size(), 1u);
  EXPECT_LT(Differ(AreaOf(f), HouseArea()), 0.05);
}

TEST(ExtractFootprints, AHeapOfTrianglesIsOneObstacle) {
  std::mt19937 random(5);
  const auto in = [&](float from, float to) {
    return from + (to - from) * static_cast<float>(random() % 10'000) / 10'000;
  };
  Mesh mesh;
  for (int i = 0; i < 30'000; ++i) {
    const Vec3 at{in(10, 18), in(10, 16), in(0, 3)};
    for (uint32_t k = 0; k < 3; ++k) {
      mesh.indices.push_back(static_cast<uint32_t>(mesh.positions.size()));
      mesh.positions.push_back(GltfFromGround(at + Vec3{in(-0.5f, 0.5f), in(-0.5f, 0.5f), in(-0.5f, 0.5f)}));
    }
  }
  TestTown town;
  town.Ground().Node("heap", NodeKind::kOther);
  town.scene.nodes.back().meshes.push_back(static_cast<int>(town.scene.meshes.size()));
  town.scene.meshes.push_back(std::move(mesh));
  const Footprints f = Extract(town);
  ASSERT_EQ(f.obstacles.size(), 1u);
  EXPECT_TRUE(f.obstacles[0].holes.empty());
  EXPECT_LT(Area(Difference({Rectangle(10, 10, 18, 16)}, AreaOf(f))), 0.01);
}

TEST(ExtractFootprints, ScalesMiniatures) {
  TestTown small;
  small.Ground(8, 6).Node("house", NodeKind::kBuilding).Box({2, 2, -0.1f}, {3.6f, 3.2f, 1.6f});
  FootprintOptions options;
  options.scale = 5;
  EXPECT_LT(Differ(AreaOf(Extract(small, options)), HouseArea()), 0.01);
}

TEST(ExtractFootprints, RefusesOptionsOutOfRangeAndEmptyTowns) {
  Footprints footprints;
  const Scene house = House().scene;
  for (const auto& [word, change] : std::vector<std::pair<std::string, std::function<void(FootprintOptions*)>>>{
           {"clearance", [](FootprintOptions* o) { o->clearance_m = -0.1; }},
           {"tolerance", [](FootprintOptions* o) { o->tolerance_m = -1; }},
           {"bridging", [](FootprintOptions* o) { o->bridge_m = -1; }},
           {"scale", [](FootprintOptions* o) { o->scale = 0; }},
           {"clearance", [](FootprintOptions* o) { o->clearance_m = std::nan(""); }},
           {"band", [](FootprintOptions* o) {
              o->band_m = {2, 0.1};
            }}}) {
    FootprintOptions options;
    change(&options);
    const Error error = ExtractFootprints(house, options, &footprints);
    EXPECT_NE(error.message.find(word), std::string::npos) << word << ": " << error.message;
  }
  EXPECT_NE(ExtractFootprints(Scene(), {}, &footprints).message, "");
}

}  // namespace
}  // namespace flaneur
