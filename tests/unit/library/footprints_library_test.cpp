// The footprints library as a program in C sees it: results for triangles, and a status for whatever else it is given.
#include <flaneur/footprints.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <thread>
#include <vector>

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInfinity = std::numeric_limits<double>::infinity();

struct Solid {
  std::vector<double> positions_m;
  std::vector<uint32_t> indices;
};

Solid Box(double x0, double y0, double z0, double x1, double y1, double z1) {
  Solid box;
  for (const double z : {z0, z1})
    for (const auto& [x, y] : {std::pair{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}})
      box.positions_m.insert(box.positions_m.end(), {x, y, z});
  for (uint32_t i = 0; i < 4; ++i) {
    const uint32_t j = (i + 1) % 4;
    box.indices.insert(box.indices.end(), {i, j, j + 4, i, j + 4, i + 4});
  }
  box.indices.insert(box.indices.end(), {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7});
  return box;
}

Solid Ground(double size_m) { return {{0, 0, 0, size_m, 0, 0, size_m, size_m, 0, 0, size_m, 0}, {0, 1, 2, 0, 2, 3}}; }

FlaneurObject ObjectOf(const char* name, int kind, const Solid& solid) {
  FlaneurObject object{};
  object.name = name, object.kind = kind;
  object.positions_m = solid.positions_m.data(), object.vertex_count = static_cast<int>(solid.positions_m.size() / 3);
  object.indices = solid.indices.data(), object.index_count = static_cast<int>(solid.indices.size());
  return object;
}

FlaneurFootprintsDef DefOf(const std::vector<FlaneurObject>& objects) {
  FlaneurFootprintsDef def = flaneur_default_footprints_def();
  def.objects = objects.data(), def.object_count = static_cast<int>(objects.size());
  return def;
}

// A house of 8 m x 6 m on a square, `east` and `north` of the origin.
class House : public testing::Test {
 protected:
  explicit House(double east = 0, double north = 0) : house(Box(10, 10, -0.3, 18, 16, 8)), ground(Ground(40)) {
    for (Solid* solid : {&house, &ground})
      for (size_t i = 0; i < solid->positions_m.size(); i += 3)
        solid->positions_m[i] += east, solid->positions_m[i + 1] += north;
    objects = {ObjectOf("house", FLANEUR_OBJECT_BUILDING, house), ObjectOf("square", FLANEUR_OBJECT_GROUND, ground)};
  }

  FlaneurStatus Create(FlaneurFootprintsId* id) const {
    const FlaneurFootprintsDef def = DefOf(objects);
    return flaneur_create_footprints(&def, id);
  }

  // What creating it with `change` applied to the house gives, and checking it.
  template <typename Change>
  FlaneurStatus With(const Change& change) {
    std::vector<FlaneurObject> changed = objects;
    change(&changed[0]);
    const FlaneurFootprintsDef def = DefOf(changed);
    FlaneurFootprintsId id{};
    const FlaneurStatus status = flaneur_create_footprints(&def, &id);
    EXPECT_EQ(id.index1 != 0, status == FLANEUR_OK);  // untouched where it fails
    if (status != FLANEUR_OK) return status;
    const FlaneurCheckDef check = flaneur_default_check_def();
    FlaneurFindingSpan findings;
    EXPECT_EQ(flaneur_footprints_check(id, &check, &findings), FLANEUR_OK) << flaneur_footprints_last_error();
    EXPECT_EQ(flaneur_destroy_footprints(id), FLANEUR_OK);
    return status;
  }

  Solid house, ground;
  std::vector<FlaneurObject> objects;
};

TEST_F(House, IsAnObstacleLargerByTheClearance) {
  FlaneurFootprintsId id;
  ASSERT_EQ(Create(&id), FLANEUR_OK) << flaneur_footprints_last_error();
  FlaneurObstacleSpan obstacles;
  ASSERT_EQ(flaneur_footprints_obstacles(id, &obstacles), FLANEUR_OK);
  ASSERT_EQ(obstacles.count, 1);
  const FlaneurObstacle& o = obstacles.items[0];
  EXPECT_STREQ(o.name, "house");
  EXPECT_EQ(o.kind, FLANEUR_OBJECT_BUILDING);
  EXPECT_EQ(o.hole_count, 0);
  ASSERT_EQ(o.outer.count, 4);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(std::abs(o.outer.points[i].x - 14), 4.05, 0.011);
    EXPECT_NEAR(std::abs(o.outer.points[i].y - 13), 3.05, 0.011);
  }
  FlaneurFindingSpan findings;
  const FlaneurCheckDef check = flaneur_default_check_def();
  ASSERT_EQ(flaneur_footprints_check(id, &check, &findings), FLANEUR_OK) << flaneur_footprints_last_error();
  EXPECT_EQ(findings.count, 0) << findings.items[0].message;
  EXPECT_EQ(flaneur_destroy_footprints(id), FLANEUR_OK);
}

class HouseOnTheMap : public House {
 protected:
  HouseOnTheMap() : House(603'900, 5'780'000) {}
};

TEST_F(HouseOnTheMap, IsGivenInTheCallersCoordinates) {
  FlaneurFootprintsId id;
  ASSERT_EQ(Create(&id), FLANEUR_OK) << flaneur_footprints_last_error();
  FlaneurObstacleSpan obstacles;
  flaneur_footprints_obstacles(id, &obstacles);
  ASSERT_EQ(obstacles.count, 1);
  for (int i = 0; i < obstacles.items[0].outer.count; ++i)
    EXPECT_NEAR(std::abs(obstacles.items[0].outer.points[i].x - 603'914), 4.05, 0.011);
  FlaneurCheckDef check = flaneur_default_check_def();
  const FlaneurGate gates[] = {{"door", {603'914, 5'780'013}, {0, -1}, false}};
  const FlaneurPoint line[] = {{603'901, 5'780'013}, {603'930, 5'780'013}};
  const FlaneurStreet streets[] = {{"lane", line, 2}};
  check.gates = gates, check.gate_count = 1, check.streets = streets, check.street_count = 1;
  FlaneurFindingSpan findings;
  ASSERT_EQ(flaneur_footprints_check(id, &check, &findings), FLANEUR_OK) << flaneur_footprints_last_error();
  ASSERT_EQ(findings.count, 2);
  EXPECT_EQ(findings.items[0].code, 504);
  EXPECT_EQ(findings.items[1].code, 601);
  EXPECT_TRUE(findings.items[1].is_error);
  EXPECT_NEAR(findings.items[1].at_m.x, 603'914, 0.5);
  EXPECT_NEAR(findings.items[1].at_m.y, 5'780'013, 0.5);
  EXPECT_EQ(flaneur_destroy_footprints(id), FLANEUR_OK);
}

TEST_F(House, TrianglesThatAreNoneAreRefused) {
  for (const double bad : {kNan, kInfinity, -kInfinity, 1e9, 1e300}) {
    for (size_t i = 0; i < 3; ++i) {
      Solid broken = house;
      broken.positions_m[3 + i] = bad;
      EXPECT_EQ(With([&](FlaneurObject* o) { o->positions_m = broken.positions_m.data(); }), FLANEUR_ERROR_OUT_OF_RANGE)
          << bad;
      EXPECT_NE(std::string(flaneur_footprints_last_error()).find("house"), std::string::npos);
    }
  }
  EXPECT_EQ(With([](FlaneurObject* o) { o->positions_m = nullptr; }), FLANEUR_ERROR_NULL);
  EXPECT_EQ(With([](FlaneurObject* o) { o->vertex_count = -1; }), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(With([](FlaneurObject* o) { o->index_count = -3; }), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(With([](FlaneurObject* o) { o->index_count -= 1; }), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(With([](FlaneurObject* o) { o->vertex_count -= 1; }),
            FLANEUR_ERROR_OUT_OF_RANGE);  // the last index is behind it
  EXPECT_EQ(With([](FlaneurObject* o) { o->indices = nullptr; }), FLANEUR_ERROR_NULL);
  EXPECT_EQ(With([](FlaneurObject* o) { o->kind = 7; }), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(With([](FlaneurObject* o) { o->kind = -1; }), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(With([](FlaneurObject* o) { o->radius_m = kNan; }), FLANEUR_ERROR_OUT_OF_RANGE);
  const std::vector<uint32_t> far(house.indices.size(), UINT32_MAX);
  EXPECT_EQ(With([&](FlaneurObject* o) { o->indices = far.data(); }), FLANEUR_ERROR_OUT_OF_RANGE);
}

TEST_F(House, TrianglesThatAreOddGiveAStatusOrObstacles) {
  EXPECT_EQ(With([](FlaneurObject* o) { o->name = nullptr; }), FLANEUR_OK);
  EXPECT_EQ(With([](FlaneurObject* o) { o->name = ""; }), FLANEUR_OK);
  EXPECT_EQ(With([](FlaneurObject* o) { o->name = "\xff\xfe\n%s%n"; }), FLANEUR_OK);
  EXPECT_EQ(With([](FlaneurObject* o) { o->index_count = 0, o->vertex_count = 0; }), FLANEUR_OK);  // the ground is left
  const std::vector<uint32_t> one_point(house.indices.size(), 3);
  EXPECT_EQ(With([&](FlaneurObject* o) { o->indices = one_point.data(); }), FLANEUR_OK);
  for (const double far : {1e5, 9e7, 1e-300, 1e-12}) {
    Solid odd = house;
    odd.positions_m[6] = far, odd.positions_m[7] = -far;
    EXPECT_NE(With([&](FlaneurObject* o) { o->positions_m = odd.positions_m.data(); }), FLANEUR_ERROR_INTERNAL)
        << far << flaneur_footprints_last_error();
  }
}

TEST(Footprints, OfNothingIsAnError) {
  FlaneurFootprintsDef def = flaneur_default_footprints_def();
  FlaneurFootprintsId id{};
  EXPECT_EQ(flaneur_create_footprints(&def, &id), FLANEUR_ERROR_OUT_OF_RANGE);
  const std::vector<FlaneurObject> empty(3, FlaneurObject{});
  def = DefOf(empty);
  EXPECT_EQ(flaneur_create_footprints(&def, &id), FLANEUR_ERROR_INPUT);
  def.objects = nullptr;
  EXPECT_EQ(flaneur_create_footprints(&def, &id), FLANEUR_ERROR_NULL);
  EXPECT_EQ(flaneur_create_footprints(nullptr, &id), FLANEUR_ERROR_NULL);
  EXPECT_EQ(flaneur_create_footprints(&def, nullptr), FLANEUR_ERROR_NULL);
  const FlaneurFootprintsDef not_made{};
  EXPECT_EQ(flaneur_create_footprints(&not_made, &id), FLANEUR_ERROR_DEFINITION);
}

TEST_F(House, EveryNumberOfADefinitionMayBeAnything) {
  using Def = FlaneurFootprintsDef;
  for (double Def::*member : {&Def::clearance_m, &Def::band_low_m, &Def::band_high_m, &Def::tolerance_m, &Def::bridge_m,
                              &Def::open_yard_m2}) {
    for (const double value : {kNan, kInfinity, -1.0, 1e300}) {
      Def def = DefOf(objects);
      def.*member = value;
      FlaneurFootprintsId id{};
      EXPECT_EQ(flaneur_create_footprints(&def, &id), FLANEUR_ERROR_OUT_OF_RANGE) << value;
    }
  }
  FlaneurFootprintsId id{};
  ASSERT_EQ(Create(&id), FLANEUR_OK);
  using Check = FlaneurCheckDef;
  for (double Check::*member :
       {&Check::person_radius_m, &Check::tolerance_m, &Check::spike_width_m, &Check::spike_length_m,
        &Check::over_cover_share, &Check::headroom_m, &Check::overlap_m2, &Check::least_ground_m2, &Check::dead_end_m,
        &Check::high_resolution_radius_m}) {
    for (const double value : {kNan, kInfinity, -1.0, 1e300}) {
      Check check = flaneur_default_check_def();
      check.*member = value;
      FlaneurFindingSpan findings{nullptr, 17};
      EXPECT_EQ(flaneur_footprints_check(id, &check, &findings), FLANEUR_ERROR_OUT_OF_RANGE) << value;
      EXPECT_EQ(findings.count, 17);
    }
  }
  flaneur_destroy_footprints(id);
}

TEST_F(House, GatesAndStreetsMayBeAnything) {
  FlaneurFootprintsId id{};
  ASSERT_EQ(Create(&id), FLANEUR_OK);
  FlaneurFindingSpan findings{};
  const auto check = [&](FlaneurGate gate, FlaneurStreet street) {
    FlaneurCheckDef def = flaneur_default_check_def();
    def.gates = &gate, def.gate_count = 1, def.streets = &street, def.street_count = 1;
    return flaneur_footprints_check(id, &def, &findings);
  };
  const FlaneurPoint line[] = {{0, 0}, {1, 1}, {kNan, 0}};
  const FlaneurGate gate{"gate", {1, 1}, {0, 0}, false};
  EXPECT_EQ(check(gate, {"street", line, 2}), FLANEUR_OK);
  EXPECT_EQ(check({nullptr, {1, 1}, {0, 0}, true}, {nullptr, line, 2}), FLANEUR_OK);
  EXPECT_EQ(check({"gate", {kNan, 1}, {0, 0}, false}, {"street", line, 2}), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(check({"gate", {1, 1}, {kInfinity, 0}, false}, {"street", line, 2}), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(check(gate, {"street", line, 3}), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(check(gate, {"street", line, 1}), FLANEUR_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(check(gate, {"street", nullptr, 2}), FLANEUR_ERROR_NULL);
  EXPECT_NE(check({"gate", {9e7, -9e7}, {0, 0}, false}, {"street", line, 2}),
            FLANEUR_ERROR_INTERNAL);  // far away, but a place
  EXPECT_EQ(flaneur_footprints_check(id, nullptr, &findings), FLANEUR_ERROR_NULL);
  const FlaneurCheckDef def = flaneur_default_check_def(), not_made{};
  EXPECT_EQ(flaneur_footprints_check(id, &def, nullptr), FLANEUR_ERROR_NULL);
  EXPECT_EQ(flaneur_footprints_check(id, &not_made, &findings), FLANEUR_ERROR_DEFINITION);
  flaneur_destroy_footprints(id);
}

TEST_F(House, IdsOfWhatIsGoneAreRefused) {
  FlaneurFootprintsId id{};
  ASSERT_EQ(Create(&id), FLANEUR_OK);
  EXPECT_TRUE(flaneur_footprints_is_valid(id));
  ASSERT_EQ(flaneur_destroy_footprints(id), FLANEUR_OK);
  FlaneurFootprintsId next{};
  ASSERT_EQ(Create(&next), FLANEUR_OK);  // may stand where the first stood
  FlaneurObstacleSpan obstacles{};
  FlaneurTextSpan warnings{};
  FlaneurFindingSpan findings{};
  const FlaneurCheckDef check = flaneur_default_check_def();
  for (const FlaneurFootprintsId gone : {id, FlaneurFootprintsId{0, 0}, FlaneurFootprintsId{UINT32_MAX, 1},
                                         FlaneurFootprintsId{next.index1, UINT32_MAX}}) {
    EXPECT_FALSE(flaneur_footprints_is_valid(gone));
    EXPECT_EQ(flaneur_destroy_footprints(gone), FLANEUR_ERROR_ID);
    EXPECT_EQ(flaneur_footprints_obstacles(gone, &obstacles), FLANEUR_ERROR_ID);
    EXPECT_EQ(flaneur_footprints_warnings(gone, &warnings), FLANEUR_ERROR_ID);
    EXPECT_EQ(flaneur_footprints_check(gone, &check, &findings), FLANEUR_ERROR_ID);
    EXPECT_STRNE(flaneur_footprints_last_error(), "");
  }
  EXPECT_EQ(flaneur_footprints_obstacles(next, nullptr), FLANEUR_ERROR_NULL);
  EXPECT_EQ(flaneur_footprints_warnings(next, nullptr), FLANEUR_ERROR_NULL);
  EXPECT_EQ(flaneur_destroy_footprints(next), FLANEUR_OK);
}

TEST_F(House, ThreadsWorkAtTheSameTimeEachWithItsOwn) {
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < 5; ++i) {
        FlaneurFootprintsId id{};
        ASSERT_EQ(Create(&id), FLANEUR_OK);
        FlaneurObstacleSpan obstacles{};
        ASSERT_EQ(flaneur_footprints_obstacles(id, &obstacles), FLANEUR_OK);
        EXPECT_EQ(obstacles.count, 1);
        if (t % 2 == 0) {
          EXPECT_EQ(flaneur_destroy_footprints({}), FLANEUR_ERROR_ID);
        } else {
          EXPECT_STREQ(flaneur_footprints_last_error(), "");  // another thread's
        }
        EXPECT_EQ(flaneur_destroy_footprints(id), FLANEUR_OK);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
}

TEST(Versions, OfHeaderAndLibraryAreTheSame) {
  const FlaneurVersion version = flaneur_footprints_version();
  EXPECT_EQ(std::to_string(version.major) + "." + std::to_string(version.minor) + "." + std::to_string(version.patch),
            FLANEUR_VERSION_TEXT);
}

}  // namespace
