#include "pipeline/footprint/polygon_sets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "pipeline/footprint/segment_grid.h"
#include "tests/unit/pipeline/footprint/test_town.h"

namespace flaneur {
namespace {

const Rings kLeft = {Rectangle(0, 0, 4, 4)}, kRight = {Rectangle(3, 1, 7, 3)};

Ring Star(int points, double inner, double outer) {
  Ring ring;
  for (int i = 0; i < 2 * points; ++i) {
    const double angle = 3.14159265358979 * i / points, radius = i % 2 ? inner : outer;
    ring.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return ring;
}

TEST(PolygonSets, AreasOfSetsAddUp) {
  EXPECT_NEAR(Area(Union(kLeft, kRight)), 16 + 8 - 2, 1e-6);
  EXPECT_NEAR(Area(Intersection(kLeft, kRight)), 2, 1e-6);
  EXPECT_NEAR(Area(Difference(kLeft, kRight)), 14, 1e-6);
}

TEST(PolygonSets, AHoleStaysAHole) {
  const Rings frame = Difference({Rectangle(0, 0, 10, 10)}, {Rectangle(4, 4, 6, 6)});
  EXPECT_NEAR(Area(frame), 96, 1e-6);
  const std::vector<Polygon> polygons = ToPolygons(frame);
  ASSERT_EQ(polygons.size(), 1u);
  ASSERT_EQ(polygons[0].holes.size(), 1u);
  EXPECT_NEAR(Area(UnionOfAreas(frame)), 96, 1e-6);
  EXPECT_FALSE(Contains(frame, {5, 5}));
}

TEST(PolygonSets, AnIslandInAHoleIsAPolygonOfItsOwn) {
  Rings rings = Difference({Rectangle(0, 0, 10, 10)}, {Rectangle(2, 2, 8, 8)});
  rings.push_back(Rectangle(4, 4, 6, 6));
  EXPECT_EQ(ToPolygons(rings).size(), 2u);
}

TEST(PolygonSets, UnionOfRingsFillsWhateverTheirOrientation) {
  Ring turned = kRight[0];
  std::reverse(turned.begin(), turned.end());
  EXPECT_NEAR(Area(UnionOfRings({kLeft[0], turned})), 22, 1e-6);
}

TEST(PolygonSets, OffsetsStayWithinTheMitre) {
  const Rings star = {Star(7, 2, 6)}, grown = Offset(star, 0.1, 2);
  EXPECT_LT(Area(Difference(star, grown)), 1e-6);
  for (const Ring& ring : grown)
    for (const Point2& p : ring) EXPECT_LE(DistanceToBoundary(star, p), 0.2 + 1e-3);
  for (int i = 0; i < 14; ++i) {  // nothing nearer than the distance is left out
    const Point2 a = star[0][static_cast<size_t>(i)], b = star[0][static_cast<size_t>((i + 1) % 14)];
    EXPECT_GE(DistanceToBoundary(grown, {(a.x + b.x) / 2, (a.y + b.y) / 2}), 0.1 - 1e-3);
  }
}

// Rounding has turned it, so that it looks like a hole: of nothing.
TEST(PolygonSets, ASliverBesideAnAreaDoesNotTurnIt) {
  const Ring square{{0, 0}, {10, 0}, {10, 10}, {0, 10}};
  const Ring sliver{{0, 20}, {3, 20.0001}, {8, 20}};
  ASSERT_LT(SignedArea(sliver), 0);
  EXPECT_NEAR(Area(Offset({square, sliver}, 0.5)), 121, 0.01);
  EXPECT_NEAR(Area(Offset({sliver, square}, -0.5)), 81, 0.01);
}

TEST(PolygonSets, SimplifyingMovesTheBoundaryByTheToleranceAtMost) {
  const Rings round = {Star(100, 5, 5.004)};
  const Rings simple = Simplify(round, 0.02);
  ASSERT_EQ(simple.size(), 1u);
  EXPECT_LT(simple[0].size(), 80u);
  for (const Point2& p : round[0]) EXPECT_LE(DistanceToBoundary(simple, p), 0.0201);
}

TEST(PolygonSets, SimplifyingDoesNotDependOnWhereTheRingStarts) {
  Ring ring = Star(50, 5, 5.01);
  const Rings before = Simplify({ring}, 0.03);
  std::rotate(ring.begin(), ring.begin() + 37, ring.end());
  EXPECT_LT(Differ(before, Simplify({ring}, 0.03)), 1e-6);
}

TEST(PolygonSets, TidyDropsStripsAndKeepsWalls) {
  Rings rings = {Rectangle(0, 0, 8, 6)};
  rings = Union(rings, {Rectangle(7, 2, 12, 2.01)});  // a strip of 1 cm
  rings = Union(rings, {Rectangle(7, 4, 12, 4.1)});   // a wall of 10 cm
  EXPECT_LT(Differ(Tidy(rings, 0.022), Union({Rectangle(0, 0, 8, 6)}, {Rectangle(7, 4, 12, 4.1)})), 0.002);
}

TEST(PolygonSets, SegmentsBecomeBands) {
  EXPECT_NEAR(Area(OffsetSegments({{{0, 0}, {10, 0}}}, 0.05)), 10.1 * 0.1, 1e-4);
  EXPECT_NEAR(Area(OffsetSegments({{{0, 0}, {10, 0}}, {{5, -5}, {5, 5}}}, 0.05)), 2 * 1.01 - 0.01, 1e-4);
}

TEST(PolygonSets, OutsideKeepsWhatLooksOut) {
  const std::vector<Segment> segments = {{{1, 1}, {2, 2}}, {{1, 1}, {9, 1}}, {{20, 1}, {21, 1}}};
  const std::vector<Segment> outside = Outside(segments, kLeft);
  ASSERT_EQ(outside.size(), 2u);
  EXPECT_EQ(outside[0].b.x, 9);
  EXPECT_EQ(Outside(segments, {}).size(), 3u);
}

TEST(PolygonSets, TheIndexAgreesWithThePlainAnswers) {
  const Rings rings = Difference({Star(9, 3, 8)}, {Rectangle(-1, -1, 1, 1)});
  const AreaIndex index(rings, 0.7);
  std::mt19937 random(5);
  for (int i = 0; i < 2000; ++i) {
    const Point2 p{static_cast<double>(random() % 20001) / 1000 - 10,
                   static_cast<double>(random() % 20001) / 1000 - 10};
    const bool inside = Contains(rings, p);
    const double distance = std::min(DistanceToBoundary(rings, p), 0.7);
    EXPECT_EQ(index.Inside(p), inside);
    EXPECT_NEAR(index.Depth(p), inside ? distance : -distance, 1e-9);
  }
}

TEST(Outside, SeesAShortPieceThatSticksOut) {
  const Rings strip{Ring{{0, 0}, {10, 0}, {10, 0.1}, {0, 0.1}}};
  EXPECT_TRUE(Outside({{{1, 0.05}, {9, 0.05}}}, strip).empty());
  EXPECT_EQ(Outside({{{1, 0.05}, {10.02, 0.05}}}, strip).size(), 1u) << "beyond the end";
  const Rings gap{Ring{{0, 0}, {4, 0}, {4, 0.1}, {0, 0.1}}, Ring{{4.03, 0}, {10, 0}, {10, 0.1}, {4.03, 0.1}}};
  EXPECT_EQ(Outside({{{1, 0.05}, {9, 0.05}}}, gap).size(), 1u) << "between two areas";
}

// ---- Arrangements ----

TEST(CutWhereTheyMeet, CrossingSegmentsMeetInOnePoint) {
  const std::vector<Segment> pieces = CutWhereTheyMeet({{{0, 0}, {2, 2}}, {{0, 2}, {2, 0}}});
  ASSERT_EQ(pieces.size(), 4u);
  for (const Segment& s : pieces) EXPECT_TRUE((s.a.x == 1 && s.a.y == 1) || (s.b.x == 1 && s.b.y == 1));
}

TEST(CutWhereTheyMeet, OverlapsAreKeptOnce) {
  const std::vector<Segment> pieces = CutWhereTheyMeet({{{0, 0}, {3, 0}}, {{1, 0}, {4, 0}}, {{3, 0}, {0, 0}}});
  EXPECT_EQ(pieces.size(), 3u);
  EXPECT_NEAR(Length(pieces), 4, 1e-9);
}

TEST(CutWhereTheyMeet, ATeeCutsTheBar) { EXPECT_EQ(CutWhereTheyMeet({{{0, 0}, {4, 0}}, {{2, 0}, {2, 3}}}).size(), 3u); }

TEST(CutWhereTheyMeet, KeepsEveryLineWhereItWas) {
  std::mt19937 random(11);
  const auto coordinate = [&] { return static_cast<double>(random() % 5001) / 1000; };
  std::vector<Segment> lines;
  for (int i = 0; i < 60; ++i) lines.push_back({{coordinate(), coordinate()}, {coordinate(), coordinate()}});
  const std::vector<Segment> pieces = CutWhereTheyMeet(lines);
  EXPECT_NEAR(Length(pieces), Length(lines), 0.01);
  for (const Segment& piece : pieces) {
    const Point2 middle{(piece.a.x + piece.b.x) / 2, (piece.a.y + piece.b.y) / 2};
    double nearest = 1e9;
    for (const Segment& line : lines) nearest = std::min(nearest, DistanceToSegment(middle, line.a, line.b));
    EXPECT_LT(nearest, 3e-4);
  }
}

}  // namespace
}  // namespace flaneur
