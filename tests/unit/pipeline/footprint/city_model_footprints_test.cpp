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
  const Footprints a = Extracted("nrw-lod2/LoD2_32_354_5652_1_NW.gml", one), b = Extracted("nrw-lod2/LoD2_32_354_5652_1_NW.gml", three);
  ASSERT_EQ(a.obstacles.size(), b.obstacles.size());
  for (size_t i = 0; i < a.obstacles.size(); ++i) {
    ASSERT_EQ(a.obstacles[i].outer.size(), b.obstacles[i].outer.size()) << a.obstacles[i].name;
    for (size_t k = 0; k < a.obstacles[i].outer.size(); ++k) {
      EXPECT_EQ(a.obstacles[i].outer[k].x, b.obstacles[i].outer[k].x);
      EXPECT_EQ(a.obstacles[i].outer[k].y, b.obstacles[i].outer[k].y);
    }
  }
}

// Looked at on the map, one by one: three houses stand in others on the same level, as the cadastre's ground surfaces do;
// two yards open to one side only; three are closed all round.
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
      const bool north = std::hypot(f.at_m.x - 358.5, f.at_m.y - 227.4) < 1, south = std::hypot(f.at_m.x - 372.5, f.at_m.y - 206.8) < 1;
      EXPECT_TRUE(north || south) << f.message;
    }
  }
  EXPECT_EQ(count, (std::map<int, int>{{401, 3}, {501, 3}, {502, 2}, {503, 2}}));
}

// Listed by looking at the model: pillars stand, the ways between and behind them are open.
TEST_F(CityModelFootprints, TheArcadeOfIngolstadt4018115IsOpen) {
  const Footprints f = Extracted("ingolstadt-lod3/4018115.gml");
  const Point2 pillars[] = {{678063.15, 5403819.15}, {678066.56, 5403820.85}, {678069.12, 5403822.13}, {678071.68, 5403823.41},
                            {678074.90, 5403825.02}, {678077.17, 5403826.15}, {678079.67, 5403827.81}, {678078.85, 5403829.39},
                            {678077.78, 5403831.45}, {678076.54, 5403833.85}};
  for (size_t i = 0; i < std::size(pillars); ++i) {
    EXPECT_TRUE(BlockedAt(f, pillars[i].x, pillars[i].y)) << "pillar " << i;
    if (i == 0) continue;
    const Point2 p = pillars[i - 1], q = pillars[i];
    EXPECT_FALSE(BlockedAt(f, (p.x + q.x) / 2, (p.y + q.y) / 2)) << "between pillars " << i - 1 << " and " << i;
    if (i > 5) continue;  // along the southern front: the way is on the left
    const double length = std::hypot(q.x - p.x, q.y - p.y), x = -(q.y - p.y) / length, y = (q.x - p.x) / length;
    EXPECT_FALSE(BlockedAt(f, (p.x + q.x) / 2 + 1.2 * x, (p.y + q.y) / 2 + 1.2 * y)) << "behind pillars " << i - 1 << " and " << i;
  }
  EXPECT_TRUE(BlockedAt(f, 678064, 5403833)) << "the rooms behind";
}

TEST_F(CityModelFootprints, ThePassageOfIngolstadt4018150aIsOpen) {
  const Footprints f = Extracted("ingolstadt-lod3/4018150a.gml");
  EXPECT_FALSE(BlockedAt(f, 678058.0, 5403858.4));
  EXPECT_TRUE(BlockedAt(f, 678053.5, 5403864.0)) << "the rooms beside it";
}

TEST_F(CityModelFootprints, ThePorchOfIngolstadt4018267StandsOnTwoPosts) {
  const Footprints f = Extracted("ingolstadt-lod3/4018267.gml");
  EXPECT_TRUE(BlockedAt(f, 678102.08, 5403623.46));
  EXPECT_TRUE(BlockedAt(f, 678099.92, 5403618.85));
  EXPECT_FALSE(BlockedAt(f, 678101.0, 5403621.15)) << "between them";
}

}  // namespace
}  // namespace flaneur
