// Boolean operations, offsets and simplification of polygons on a grid of 0.1 mm.
#pragma once
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "pipeline/core/footprint.h"

namespace flaneur {

using Ring = std::vector<Point2>;
// The area inside by the even-odd rule. Results have outer rings anticlockwise and holes clockwise, all simple.
using Rings = std::vector<Ring>;
struct Segment {
  Point2 a, b;
};
struct Polygon {
  Ring outer;
  Rings holes;
};

double Length(const Segment& segment);
double Length(const std::vector<Segment>& segments);  // of all together
std::vector<Segment> Outline(const Rings& rings);

double SignedArea(const Ring& ring);  // square metres, positive where anticlockwise
double Area(const Rings& rings);
struct BoundingBox {
  Point2 min{1e300, 1e300}, max{-1e300, -1e300};
};  // of nothing: min above max
BoundingBox BoundingBoxOf(const Rings& rings);

Rings Union(const Rings& a, const Rings& b);
// The union of rings that overlap, each filled whatever its orientation.
Rings UnionOfRings(const Rings& rings);
// The union of areas whose rings are listed one after the other: outer rings anticlockwise, holes clockwise.
Rings UnionOfAreas(const Rings& rings);
Rings Intersection(const Rings& a, const Rings& b);
Rings Difference(const Rings& a, const Rings& b);
// The first areas less the second; either lists rings as UnionOfAreas takes them.
Rings DifferenceOfAreas(const Rings& a, const Rings& b);

// Grown by distance_m (shrunk where negative). Corners are mitred up to miter_limit * distance_m, sharper ones cut.
Rings Offset(const Rings& rings, double distance_m, double miter_limit = 2);
// All that lies within distance_m of a segment, ends squared.
Rings OffsetSegments(const std::vector<Segment>& segments, double distance_m);
// What is enclosed by segments and areas that reach towards each other over gaps of up to 2 * reach_m: each region up
// to the segments and areas round it, without the islands in it.
std::vector<Rings> Enclosed(const std::vector<Segment>& segments, const Rings& areas, double reach_m);
// The segments that lie, wholly or in part, outside the area.
std::vector<Segment> Outside(const std::vector<Segment>& segments, const Rings& area);
// Likewise, but only the pieces that lie outside.
std::vector<Segment> PiecesOutside(const std::vector<Segment>& segments, const Rings& area);

// Drops vertices where the boundary moves outwards by at most tolerance_m; inwards by no more than the grid is wide.
Rings Simplify(const Rings& rings, double tolerance_m);

// Fit for a file: without slivers thinner than width_m, slits thinner than 1 mm, and crossings; where width_m is more
// than 1.5 mm also without points nearer than that to each other.
Rings Tidy(const Rings& rings, double width_m);

// Splits an area into polygons with their holes.
std::vector<Polygon> ToPolygons(const Rings& rings);

// Even-odd; a point on the boundary may be either.
bool Contains(const Ring& ring, Point2 p);
bool Contains(const Rings& rings, Point2 p);
double DistanceToSegment(Point2 p, Point2 a, Point2 b);
double DistanceToBoundary(const Rings& rings, Point2 p);

// Fast answers about one area with many corners.
class AreaIndex {
 public:
  AreaIndex(Rings rings, double reach_m);
  const Rings& rings() const { return rings_; }
  bool Inside(Point2 p) const;
  // Where the segment passes an edge, as shares of its length, in no particular order.
  std::vector<double> Crossings(const Segment& s) const;
  // The distance to the boundary, at most reach_m; negative outside.
  double Depth(Point2 p) const;

 private:
  void Add(const Segment& s);
  int64_t Cell(double v) const;
  Rings rings_;
  double reach_m_, cell_m_ = 1;
  std::unordered_map<int64_t, std::vector<Segment>> rows_, cells_;
};

}  // namespace flaneur
