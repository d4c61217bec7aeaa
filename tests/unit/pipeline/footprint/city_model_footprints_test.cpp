// Footprints of real city models, where they are at hand.
#include <gtest/gtest.h>

#include "pipeline/footprint/check.h"
#include "tests/unit/pipeline/footprint/figures.h"
#include "tests/unit/pipeline/footprint/test_town.h"

namespace flaneur {
namespace {

class CityModelFootprints : public testing::Test {
 protected:
  void SetUp() override {
    if (figures::SharedData().empty()) GTEST_SKIP() << "no city models at hand: set FLANEUR_SHARED_DIR";
  }
  static Footprints Extracted(const std::string& file, const FootprintOptions& options = {}) {
    Scene scene;
    Footprints footprints;
    EXPECT_EQ(ReadScene(figures::SharedData() / "towns" / file, &scene).message, "");
    EXPECT_EQ(ExtractFootprints(scene, options, &footprints).message, "");
    return footprints;
  }
  // At a place in the model's own coordinates.
  static bool BlockedAt(const Footprints& f, double east, double north) {
    return Blocked(f, {east - f.origin_m.x, north - f.origin_m.y});
  }
};

TEST_F(CityModelFootprints, FitTheModelsGroundSurfaces) {
  Scene town;
  ASSERT_EQ(ReadScene(figures::SharedData() / "towns/nrw-lod2/LoD2_32_354_5652_1_NW.gml", &town).message, "");
  FootprintOptions exactly;
  exactly.clearance_m = exactly.tolerance_m = 0;
  const figures::Spoiling ways[] = {{.name = "clean"},
                                    {.name = "flipped", .flip = true},
                                    {.name = "doubled", .repeat = true},
                                    {.name = "eaves added", .eaves = true}};
  for (const figures::Spoiling& how : ways) {
    Footprints footprints;
    FootprintStats stats;
    ASSERT_EQ(ExtractFootprints(figures::Spoilt(town, how), exactly, &footprints, &stats).message, "");
    const std::vector<figures::BuildingFit> fits = figures::Fits(town, footprints, stats);
    EXPECT_GE(figures::MeanIou(fits), 0.9999) << how.name;
    EXPECT_GE(figures::ShareWithin2cm(fits), 0.97) << how.name;
    EXPECT_TRUE(stats.open_shells.empty()) << how.name;
  }
}

TEST_F(CityModelFootprints, CoverAllWallsAndHardlyMore) {
  Scene town;
  ASSERT_EQ(ReadScene(figures::SharedData() / "towns/nrw-lod2/LoD2_32_354_5652_1_NW.gml", &town).message, "");
  Footprints footprints;
  ASSERT_EQ(ExtractFootprints(town, {}, &footprints).message, "");
  const figures::Cover cover = figures::MeasureCover(town, footprints, {});
  EXPECT_GT(cover.walls_m, 1000);
  EXPECT_EQ(cover.uncovered_m, 0);
  EXPECT_LT(cover.over_m2, 0.01 * cover.truth_m2);
}

TEST_F(CityModelFootprints, AreTheSameForAnyNumberOfThreads) {
  FootprintOptions one, three;
  one.threads = 1, three.threads = 3;
  const Footprints a = Extracted("nrw-lod2/LoD2_32_354_5652_1_NW.gml", one),
                   b = Extracted("nrw-lod2/LoD2_32_354_5652_1_NW.gml", three);
  ASSERT_EQ(a.obstacles.size(), b.obstacles.size());
  for (size_t i = 0; i < a.obstacles.size(); ++i) {
    ASSERT_EQ(a.obstacles[i].outer.size(), b.obstacles[i].outer.size()) << a.obstacles[i].name;
    for (size_t k = 0; k < a.obstacles[i].outer.size(); ++k) {
      EXPECT_EQ(a.obstacles[i].outer[k].x, b.obstacles[i].outer[k].x);
      EXPECT_EQ(a.obstacles[i].outer[k].y, b.obstacles[i].outer[k].y);
    }
  }
}

// Looked at on the map, one by one: three houses stand in others on the same level, as the cadastre's ground surfaces
// do; two yards open to one side only; three are closed all round.
TEST_F(CityModelFootprints, TheCheckFindsInACleanTownOnlyWhatIsThere) {
  Scene town;
  ASSERT_EQ(ReadScene(figures::SharedData() / "towns/nrw-lod2/LoD2_32_354_5652_1_NW.gml", &town).message, "");
  Footprints footprints;
  ASSERT_EQ(ExtractFootprints(town, {}, &footprints).message, "");
  CheckOptions options;
  options.open_rings.resize(footprints.obstacles.size());
  std::vector<Finding> findings;
  ASSERT_EQ(Check(footprints, &town, options, &findings).message, "");
  std::map<int, int> count;
  for (const Finding& f : findings) {
    ++count[f.code];
    if (f.code == 401) {
      const Rings shared = Intersection(figures::GroundSurface(town, f.feature), figures::GroundSurface(town, f.other));
      EXPECT_GT(Area(shared), 0.9 * f.value) << f.message;
    } else if (f.code == 501) {
      EXPECT_EQ(f.severity, Severity::kWarning) << f.message;
    } else {
      const bool north = std::hypot(f.at_m.x - 358.5, f.at_m.y - 227.4) < 1,
                 south = std::hypot(f.at_m.x - 372.5, f.at_m.y - 206.8) < 1;
      EXPECT_TRUE(north || south) << f.message;
    }
  }
  EXPECT_EQ(count, (std::map<int, int>{{401, 3}, {501, 3}, {502, 1}, {503, 1}}));
}

// Quays, bridges and water; the ground beneath them is not given.
TEST_F(CityModelFootprints, TheCheckFindsNothingWrongWithOwnObstaclesOfDelft) {
  Scene town;
  ASSERT_EQ(ReadScene(figures::SharedData() / "towns/delft-cityjson/delft.json", &town).message, "");
  Footprints footprints;
  ASSERT_EQ(ExtractFootprints(town, {}, &footprints).message, "");
  std::vector<Finding> findings;
  ASSERT_EQ(Check(footprints, &town, {}, &findings).message, "");
  EXPECT_FALSE(findings.empty()) << "gaps too narrow for a person";
  for (const Finding& f : findings) EXPECT_GE(f.code, 403) << f.message;
}

// Listed by looking at the model: pillars stand, the ways between and behind them are open.
TEST_F(CityModelFootprints, TheArcadeOfIngolstadt4018115IsOpen) {
  const Footprints f = Extracted("ingolstadt-lod3/4018115.gml");
  const Point2 pillars[] = {{678063.15, 5403819.15}, {678066.56, 5403820.85}, {678069.12, 5403822.13},
                            {678071.68, 5403823.41}, {678074.90, 5403825.02}, {678077.17, 5403826.15},
                            {678079.67, 5403827.81}, {678078.85, 5403829.39}, {678077.78, 5403831.45},
                            {678076.54, 5403833.85}};
  for (size_t i = 0; i < std::size(pillars); ++i) {
    EXPECT_TRUE(BlockedAt(f, pillars[i].x, pillars[i].y)) << "pillar " << i;
    if (i == 0) continue;
    const Point2 p = pillars[i - 1], q = pillars[i];
    EXPECT_FALSE(BlockedAt(f, (p.x + q.x) / 2, (p.y + q.y) / 2)) << "between pillars " << i - 1 << " and " << i;
    if (i > 5) continue;  // along the southern front: the way is on the left
    const double length = std::hypot(q.x - p.x, q.y - p.y), x = -(q.y - p.y) / length, y = (q.x - p.x) / length;
    EXPECT_FALSE(BlockedAt(f, (p.x + q.x) / 2 + 1.2 * x, (p.y + q.y) / 2 + 1.2 * y))
        << "behind pillars " << i - 1 << " and " << i;
  }
  EXPECT_TRUE(BlockedAt(f, 678064, 5403833)) << "the rooms behind";
}

// The other places of the twelve models where people walk under something, by looking at all of them. There are none in
// 4018152a, 4018198, 4018204a and 4018258 but eaves.
TEST_F(CityModelFootprints, WaysUnderTheHousesOfIngolstadtAreOpen) {
  struct Place {
    const char *file, *what;
    double east, north;
    bool blocked;
  };
  const Place places[] = {
      {"4018106", "under the oriel at the corner", 678092.00, 5403811.25, false},
      {"4018106", "the house below it", 678090.5, 5403809.5, true},
      {"4018150a", "the passage, its mouth", 678062.5, 5403859.6, false},
      {"4018150a", "the passage, in the middle", 678058.25, 5403858.25, false},
      {"4018150a", "the passage, its end", 678053.6, 5403856.8, false},
      {"4018150a", "the wall along the passage", 678058.6, 5403856.75, true},
      {"4018150a", "the rooms beside the passage", 678053.5, 5403864.0, true},
      {"4018150a", "the loggia", 678059.75, 5403870.75, false},
      {"4018150a", "the loggia's pier", 678059.0, 5403872.85, true},
      {"4018150b", "the doorway", 678056.75, 5403880.25, false},
      {"4018154", "the northern doorway", 678120.9, 5403909.05, false},
      {"4018154", "the eastern doorway", 678125.5, 5403904.00, false},
      {"4018154", "the recess in the east", 678127.25, 5403894.75, false},
      {"4018154", "the rooms behind", 678115.0, 5403903.0, true},
      {"4018206", "under the canopy", 678141.00, 5403679.50, false},
      {"4018210", "under the first bay", 678161.50, 5403712.00, false},
      {"4018210", "under the second bay", 678159.75, 5403714.00, false},
      {"4018210", "under the third bay", 678157.75, 5403716.00, false},
      {"4018210", "under the fourth bay", 678156.00, 5403718.00, false},
      {"4018210", "the house behind the bays", 678155.0, 5403712.0, true},
      {"4018267", "the porch's northern post", 678102.08, 5403623.46, true},
      {"4018267", "the porch's southern post", 678099.92, 5403618.85, true},
      {"4018267", "between its posts", 678101.0, 5403621.15, false},
      {"4018267", "under the porch", 678101.75, 5403620.75, false},
  };
  std::map<std::string, Footprints> footprints;
  for (const Place& place : places) {
    const auto [entry, is_new] = footprints.try_emplace(place.file);
    if (is_new) entry->second = Extracted("ingolstadt-lod3/" + std::string(place.file) + ".gml");
    EXPECT_EQ(BlockedAt(entry->second, place.east, place.north), place.blocked) << place.file << ": " << place.what;
  }
}

}  // namespace
}  // namespace flaneur
