#include "pipeline/footprint/polygon_sets.h"

#include <algorithm>
#include <clipper.hpp>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>
#include <utility>

namespace flaneur {
namespace {

namespace cl = ClipperLib;
constexpr double kUnitsPerMetre = 1e4;

cl::Path ToPath(const Ring& ring) {
  cl::Path path;
  path.reserve(ring.size());
  for (const Point2& p : ring)
    path.push_back({static_cast<cl::cInt>(std::llround(p.x * kUnitsPerMetre)),
                    static_cast<cl::cInt>(std::llround(p.y * kUnitsPerMetre))});
  return path;
}

cl::Paths ToPaths(const Rings& rings) {
  cl::Paths paths;
  paths.reserve(rings.size());
  for (const Ring& ring : rings) paths.push_back(ToPath(ring));
  return paths;
}

// Of a path what ClipperOffset calls its lowest point.
cl::IntPoint LowestOf(const cl::Path& path) {
  return *std::min_element(path.begin(), path.end(), [](const cl::IntPoint& p, const cl::IntPoint& q) {
    return p.Y != q.Y ? p.Y > q.Y : p.X < q.X;
  });
}

// ClipperOffset takes the ring with the lowest point for an outer one, of several with that point the first. A hole
// that lies lower than all areas is none, but a sliver that rounding has turned: it would turn everything.
cl::Paths OutersFirst(const Rings& rings) {
  cl::Paths paths = ToPaths(rings);
  std::erase_if(paths, [](const cl::Path& path) { return path.empty(); });
  const auto holes =
      std::stable_partition(paths.begin(), paths.end(), [](const cl::Path& path) { return cl::Orientation(path); });
  if (holes == paths.begin()) return paths;
  cl::IntPoint lowest = LowestOf(paths[0]);
  for (auto outer = paths.begin(); outer != holes; ++outer) {
    const cl::IntPoint p = LowestOf(*outer);
    if (p.Y > lowest.Y || (p.Y == lowest.Y && p.X < lowest.X)) lowest = p;
  }
  const auto is_none = [&](const cl::Path& hole) {
    const cl::IntPoint p = LowestOf(hole);
    return p.Y > lowest.Y || (p.Y == lowest.Y && p.X < lowest.X);
  };
  paths.erase(std::remove_if(holes, paths.end(), is_none), paths.end());
  return paths;
}

Ring ToRing(const cl::Path& path) {
  Ring ring;
  ring.reserve(path.size());
  for (const cl::IntPoint& p : path)
    ring.push_back({static_cast<double>(p.X) / kUnitsPerMetre, static_cast<double>(p.Y) / kUnitsPerMetre});
  return ring;
}

Rings ToRings(const cl::Paths& paths) {
  Rings rings;
  for (const cl::Path& path : paths)
    if (path.size() >= 3) rings.push_back(ToRing(path));
  return rings;
}

Rings Combine(cl::ClipType type, const Rings& a, const Rings& b, cl::PolyFillType fill = cl::pftEvenOdd) {
  cl::Clipper clipper;
  clipper.StrictlySimple(true);
  clipper.AddPaths(ToPaths(a), cl::ptSubject, true);
  clipper.AddPaths(ToPaths(b), cl::ptClip, true);
  cl::Paths out;
  clipper.Execute(type, out, fill, fill);
  return ToRings(out);
}

// How many paths are united at once. The time that takes grows with the square of those that overlap.
constexpr size_t kAtOnce = 64;

cl::Paths UnionAtOnce(const cl::Paths& paths) {
  cl::Clipper clipper;
  clipper.StrictlySimple(true);
  clipper.AddPaths(paths, cl::ptSubject, true);
  cl::Paths out;
  clipper.Execute(cl::ctUnion, out, cl::pftNonZero, cl::pftNonZero);
  return out;
}

// The bits of x and y in turn: near places mostly have near numbers.
uint64_t AlongCurve(uint64_t x, uint64_t y) {
  const auto spread = [](uint64_t v) {
    v &= 0xffffffff;
    for (const auto& [shift, mask] : {std::pair{16, 0x0000ffff0000ffff},
                                      {8, 0x00ff00ff00ff00ff},
                                      {4, 0x0f0f0f0f0f0f0f0f},
                                      {2, 0x3333333333333333},
                                      {1, 0x5555555555555555}})
      v = (v | v << shift) & static_cast<uint64_t>(mask);
    return v;
  };
  return spread(x) | spread(y) << 1;
}

// Each path once, sorted so that those near each other come one after the other, whatever order they came in.
cl::Paths Neighbouring(cl::Paths paths) {
  std::erase_if(paths, [](const cl::Path& path) { return path.size() < 3; });
  if (paths.size() <= kAtOnce) return paths;
  cl::IntPoint low = paths[0][0];
  for (const cl::Path& path : paths)
    for (const cl::IntPoint& p : path) low = {std::min(low.X, p.X), std::min(low.Y, p.Y)};
  constexpr int kPerCell = 8;  // a power of two of units: the finest difference that counts
  std::vector<std::pair<uint64_t, size_t>> order;
  for (size_t i = 0; i < paths.size(); ++i) {
    cl::IntPoint least = paths[i][0];
    for (const cl::IntPoint& p : paths[i]) least = {std::min(least.X, p.X), std::min(least.Y, p.Y)};
    order.emplace_back(AlongCurve(static_cast<uint64_t>(least.X - low.X) >> kPerCell,
                                  static_cast<uint64_t>(least.Y - low.Y) >> kPerCell),
                       i);
  }
  const auto before = [](const cl::IntPoint& p, const cl::IntPoint& q) {
    return std::tie(p.X, p.Y) < std::tie(q.X, q.Y);
  };
  std::sort(order.begin(), order.end(), [&](const auto& a, const auto& b) {
    if (a.first != b.first) return a.first < b.first;
    const cl::Path &p = paths[a.second], &q = paths[b.second];
    return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end(), before);
  });
  cl::Paths sorted;
  for (const auto& [_, i] : order)
    if (sorted.empty() || sorted.back() != paths[i]) sorted.push_back(std::move(paths[i]));
  return sorted;
}

cl::Paths UnionByHalves(const cl::Paths& paths, size_t from, size_t to) {
  if (to - from <= kAtOnce)
    return UnionAtOnce(cl::Paths(paths.begin() + static_cast<long>(from), paths.begin() + static_cast<long>(to)));
  const size_t middle = from + (to - from) / 2;
  cl::Paths both = UnionByHalves(paths, from, middle);
  const cl::Paths other = UnionByHalves(paths, middle, to);
  both.insert(both.end(), other.begin(), other.end());
  return UnionAtOnce(both);
}
cl::Paths UnionByHalves(const cl::Paths& paths) { return UnionByHalves(paths, 0, paths.size()); }

constexpr double kGrid_m = 1e-4;

// A ring with the area on its left, losing vertices. Each vertex knows how far the boundary has moved outwards there
// and along the edge that follows.
class Simplifier {
 public:
  Simplifier(const Ring& ring, double tolerance_m) : tolerance_m_(tolerance_m) {
    // Starts at the south-western vertex, so that the result does not depend on where the ring starts.
    const auto sum = [](Point2 p) { return p.x + p.y; };
    const auto less = [&](Point2 p, Point2 q) { return sum(p) != sum(q) ? sum(p) < sum(q) : p.x < q.x; };
    const auto start = std::min_element(ring.begin(), ring.end(), less) - ring.begin();
    for (size_t i = 0; i < ring.size(); ++i)
      corners_.push_back({ring[(i + static_cast<size_t>(start)) % ring.size()], 0, 0});
  }

  Ring Run() {
    for (bool changed = true; changed && corners_.size() > 3;) {
      changed = false;
      for (size_t i = 0; i < corners_.size() && corners_.size() > 3;) {
        if (DropReflex(i) || CutOffEdge(i)) changed = true;
        else ++i;
      }
    }
    Ring ring;
    for (const Corner& corner : corners_) ring.push_back(corner.at);
    return ring;
  }

 private:
  struct Corner {
    Point2 at;
    double moved_m, edge_moved_m;
  };

  Corner& At(size_t i) { return corners_[i % corners_.size()]; }
  static double Turn(Point2 a, Point2 b, Point2 c) { return (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x); }

  // A corner that points into the area, or hardly out of it, goes.
  bool DropReflex(size_t i) {
    const size_t n = corners_.size();
    Corner &a = At(i + n - 1), &v = At(i);
    const Point2 b = At(i + 1).at;
    const double aside_m = DistanceToSegment(v.at, a.at, b);
    const bool outwards = Turn(a.at, v.at, b) <= 0;
    const double moved_m = aside_m + std::max({a.edge_moved_m, v.moved_m, v.edge_moved_m});
    if (moved_m > (outwards ? tolerance_m_ : std::min(kGrid_m, tolerance_m_))) return false;
    a.edge_moved_m = moved_m;
    corners_.erase(corners_.begin() + static_cast<long>(i));
    return true;
  }

  // Of two corners that point out, the edges before and after run on until they meet.
  bool CutOffEdge(size_t i) {
    const size_t n = corners_.size();
    const Corner &a = At(i + n - 1), &d = At(i + 2);
    Corner &b = At(i), &c = At(i + 1);
    if (Turn(a.at, b.at, c.at) <= 0 || Turn(b.at, c.at, d.at) <= 0) return false;
    const Point2 u{b.at.x - a.at.x, b.at.y - a.at.y}, w{c.at.x - d.at.x, c.at.y - d.at.y};
    const double cross = u.x * w.y - u.y * w.x;
    if (!(cross < 0)) return false;  // the two would not meet ahead
    const double t = ((d.at.x - a.at.x) * w.y - (d.at.y - a.at.y) * w.x) / cross;
    const Point2 p{a.at.x + t * u.x, a.at.y + t * u.y};
    if (!(t >= 1)) return false;
    const double moved_m = DistanceToSegment(p, b.at, c.at) + std::max({b.moved_m, b.edge_moved_m, c.moved_m});
    if (moved_m > tolerance_m_) return false;
    b = {p, moved_m, c.edge_moved_m};
    corners_.erase(corners_.begin() + static_cast<long>((i + 1) % n));
    return true;
  }

  double tolerance_m_;
  std::vector<Corner> corners_;
};

void AddPolygons(const cl::PolyNode& node, std::vector<Polygon>* out) {
  for (const cl::PolyNode* outer : node.Childs) {
    Polygon polygon{ToRing(outer->Contour), {}};
    for (const cl::PolyNode* hole : outer->Childs) {
      polygon.holes.push_back(ToRing(hole->Contour));
      AddPolygons(*hole, out);
    }
    out->push_back(std::move(polygon));
  }
}

}  // namespace

double Length(const Segment& s) { return std::hypot(s.b.x - s.a.x, s.b.y - s.a.y); }

double Length(const std::vector<Segment>& segments) {
  double length = 0;
  for (const Segment& s : segments) length += Length(s);
  return length;
}

std::vector<Segment> Outline(const Rings& rings) {
  std::vector<Segment> lines;
  for (const Ring& ring : rings)
    for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) lines.push_back({ring[j], ring[i]});
  return lines;
}

double SignedArea(const Ring& ring) {
  if (ring.empty()) return 0;
  double twice = 0;
  const Point2 o = ring[0];
  for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
    twice += (ring[j].x - o.x) * (ring[i].y - o.y) - (ring[i].x - o.x) * (ring[j].y - o.y);
  return twice / 2;
}

double Area(const Rings& rings) {
  double area = 0;
  for (const Ring& ring : rings) area += SignedArea(ring);
  return area;
}

BoundingBox BoundingBoxOf(const Rings& rings) {
  BoundingBox box;
  for (const Ring& ring : rings) {
    for (const Point2& p : ring) {
      box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y)};
      box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y)};
    }
  }
  return box;
}

Rings Union(const Rings& a, const Rings& b) { return Combine(cl::ctUnion, a, b); }
Rings Intersection(const Rings& a, const Rings& b) { return Combine(cl::ctIntersection, a, b); }
Rings Difference(const Rings& a, const Rings& b) { return Combine(cl::ctDifference, a, b); }

Rings DifferenceOfAreas(const Rings& a, const Rings& b) {
  if (a.empty() || b.empty()) return a;
  return Combine(cl::ctDifference, a, b, cl::pftNonZero);
}

Rings UnionOfRings(const Rings& rings) {
  if (rings.empty()) return {};
  cl::Paths paths = ToPaths(rings);
  for (cl::Path& path : paths)
    if (!cl::Orientation(path)) cl::ReversePath(path);
  return ToRings(UnionByHalves(Neighbouring(std::move(paths))));
}

Rings UnionOfAreas(const Rings& rings) {
  if (rings.empty()) return {};
  return ToRings(UnionAtOnce(ToPaths(rings)));
}

Rings Offset(const Rings& rings, double distance_m, double miter_limit) {
  if (rings.empty()) return {};
  cl::ClipperOffset offset(miter_limit);
  offset.AddPaths(OutersFirst(rings), cl::jtMiter, cl::etClosedPolygon);
  cl::Paths out;
  offset.Execute(out, distance_m * kUnitsPerMetre);
  return ToRings(out);
}

Rings OffsetSegments(const std::vector<Segment>& segments, double distance_m) {
  Rings boxes;
  for (const Segment& s : segments) {
    const double length = std::hypot(s.b.x - s.a.x, s.b.y - s.a.y);
    const double dx = length > 0 ? (s.b.x - s.a.x) / length * distance_m : distance_m;
    const double dy = length > 0 ? (s.b.y - s.a.y) / length * distance_m : 0;
    boxes.push_back({{s.a.x - dx + dy, s.a.y - dy - dx},
                     {s.b.x + dx + dy, s.b.y + dy - dx},
                     {s.b.x + dx - dy, s.b.y + dy + dx},
                     {s.a.x - dx - dy, s.a.y - dy + dx}});
  }
  return UnionOfRings(boxes);
}

std::vector<Rings> Enclosed(const std::vector<Segment>& segments, const Rings& areas, double reach_m) {
  constexpr double kSharpMiter = 10, kArcTolerance = 0.01;
  const double reach = reach_m * kUnitsPerMetre;
  cl::ClipperOffset offset(2, std::max(2.0, kArcTolerance * reach));
  for (const Segment& s : segments) offset.AddPath(ToPath({s.a, s.b}), cl::jtRound, cl::etOpenRound);
  offset.AddPaths(OutersFirst(areas), cl::jtRound, cl::etClosedPolygon);
  cl::PolyTree thick;
  offset.Execute(thick, reach);
  std::vector<Rings> regions;
  for (const cl::PolyNode* node = thick.GetFirst(); node; node = node->GetNext()) {
    if (!node->IsHole()) continue;
    Rings rings{ToRing(node->Contour)};
    for (const cl::PolyNode* island : node->Childs) rings.push_back(ToRing(island->Contour));
    for (Ring& ring : rings) std::reverse(ring.begin(), ring.end());
    regions.push_back(Offset(rings, reach_m, kSharpMiter));
  }
  return regions;
}

namespace {

constexpr double kMinOutside_m = 0.001;  // shorter pieces outside do not count

// Where along a segment, from 0 to 1, its pieces outside begin and end: the first, or all of them.
std::vector<std::pair<double, double>> SharesOutside(const Segment& s, const AreaIndex& index, bool all) {
  std::vector<double> cuts = index.Crossings(s);
  cuts.insert(cuts.end(), {0.0, 1.0});
  std::sort(cuts.begin(), cuts.end());
  const double least = kMinOutside_m / std::max(kMinOutside_m, Length(s));
  std::vector<std::pair<double, double>> shares;
  for (size_t i = 0; i + 1 < cuts.size() && (all || shares.empty()); ++i) {
    const double t = (cuts[i] + cuts[i + 1]) / 2;
    if (cuts[i + 1] - cuts[i] >= least && !index.Inside({s.a.x + t * (s.b.x - s.a.x), s.a.y + t * (s.b.y - s.a.y)}))
      shares.emplace_back(cuts[i], cuts[i + 1]);
  }
  return shares;
}

}  // namespace

std::vector<Segment> Outside(const std::vector<Segment>& segments, const Rings& area) {
  if (area.empty() || segments.empty()) return segments;
  const AreaIndex index(area, 0.01);
  std::vector<Segment> out;
  for (const Segment& s : segments)
    if (!SharesOutside(s, index, false).empty()) out.push_back(s);
  return out;
}

std::vector<Segment> PiecesOutside(const std::vector<Segment>& segments, const Rings& area) {
  if (area.empty()) return segments;
  const AreaIndex index(area, 0.01);
  std::vector<Segment> out;
  for (const Segment& s : segments) {
    const auto at = [&](double t) { return Point2{s.a.x + t * (s.b.x - s.a.x), s.a.y + t * (s.b.y - s.a.y)}; };
    for (const auto& [from, to] : SharesOutside(s, index, true)) out.push_back({at(from), at(to)});
  }
  return out;
}

Rings Simplify(const Rings& rings, double tolerance_m) {
  Rings out;
  for (const Ring& ring : rings) {
    if (ring.size() >= 3) out.push_back(Simplifier(ring, tolerance_m).Run());
  }
  return UnionOfAreas(out);
}

Rings Tidy(const Rings& rings, double width_m) {
  constexpr double kSharpMiter = 20, kNear_m = 0.0015, kSlit_m = 0.0005;
  const Rings without_slits = Offset(rings, kSlit_m, kSharpMiter);
  const Rings without_slivers = Offset(without_slits, -width_m / 2 - kSlit_m, kSharpMiter);
  cl::Paths paths = ToPaths(Offset(without_slivers, width_m / 2, kSharpMiter));
  if (width_m > kNear_m) cl::CleanPolygons(paths, kNear_m * kUnitsPerMetre);
  return Union(ToRings(paths), {});
}

std::vector<Polygon> ToPolygons(const Rings& rings) {
  cl::Clipper clipper;
  clipper.StrictlySimple(true);
  clipper.AddPaths(ToPaths(rings), cl::ptSubject, true);
  cl::PolyTree tree;
  clipper.Execute(cl::ctUnion, tree, cl::pftEvenOdd, cl::pftEvenOdd);
  std::vector<Polygon> out;
  AddPolygons(tree, &out);
  return out;
}

bool Contains(const Ring& ring, Point2 p) {
  bool inside = false;
  for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Point2 a = ring[i], b = ring[j];
    if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) inside = !inside;
  }
  return inside;
}

bool Contains(const Rings& rings, Point2 p) {
  bool inside = false;
  for (const Ring& ring : rings)
    if (Contains(ring, p)) inside = !inside;
  return inside;
}

double DistanceToSegment(Point2 p, Point2 a, Point2 b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const double square = dx * dx + dy * dy;
  const double t = square > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / square, 0.0, 1.0) : 0;
  return std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

double DistanceToBoundary(const Rings& rings, Point2 p) {
  double nearest = std::numeric_limits<double>::max();
  for (const Ring& ring : rings)
    for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
      nearest = std::min(nearest, DistanceToSegment(p, ring[j], ring[i]));
  return nearest;
}

AreaIndex::AreaIndex(Rings rings, double reach_m) : rings_(std::move(rings)), reach_m_(reach_m) {
  constexpr double kMinCell_m = 1, kMaxCells = 1e6;
  const std::vector<Segment> outline = Outline(rings_);
  cell_m_ = std::max(kMinCell_m, Length(outline) / kMaxCells);
  for (const Segment& s : outline) Add(s);
}

void AreaIndex::Add(const Segment& s) {
  const auto [low, high] = std::minmax(s.a.y, s.b.y);
  for (int64_t y = Cell(low - reach_m_); y <= Cell(high + reach_m_); ++y) rows_[y].push_back(s);
  // Box by box along the segment, so that long ones stay cheap.
  const int steps = std::max(1, static_cast<int>(std::ceil(std::hypot(s.b.x - s.a.x, s.b.y - s.a.y) / (4 * cell_m_))));
  std::set<std::pair<int64_t, int64_t>> done;
  for (int k = 0; k < steps; ++k) {
    const auto at = [&](int step) {
      const double t = static_cast<double>(step) / steps;
      return Point2{s.a.x + t * (s.b.x - s.a.x), s.a.y + t * (s.b.y - s.a.y)};
    };
    const Point2 a = at(k), b = at(k + 1);
    for (int64_t x = Cell(std::min(a.x, b.x) - reach_m_); x <= Cell(std::max(a.x, b.x) + reach_m_); ++x)
      for (int64_t y = Cell(std::min(a.y, b.y) - reach_m_); y <= Cell(std::max(a.y, b.y) + reach_m_); ++y)
        if (steps == 1 || done.emplace(x, y).second) cells_[x * 1'000'003 + y].push_back(s);
  }
}

int64_t AreaIndex::Cell(double v) const { return static_cast<int64_t>(std::floor(v / cell_m_)); }

bool AreaIndex::Inside(Point2 p) const {
  const auto found = rows_.find(Cell(p.y));
  if (found == rows_.end()) return false;
  bool inside = false;
  for (const auto& [a, b] : found->second)
    if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) inside = !inside;
  return inside;
}

std::vector<double> AreaIndex::Crossings(const Segment& s) const {
  const Point2 u{s.b.x - s.a.x, s.b.y - s.a.y};
  const auto [low, high] = std::minmax(s.a.y, s.b.y);
  std::vector<double> shares;
  for (int64_t row = Cell(low); row <= Cell(high); ++row) {
    const auto found = rows_.find(row);
    if (found == rows_.end()) continue;
    for (const auto& [a, b] : found->second) {
      const Point2 v{b.x - a.x, b.y - a.y}, w{a.x - s.a.x, a.y - s.a.y};
      const double cross = u.x * v.y - u.y * v.x;
      if (cross == 0) continue;
      const double along_s = (w.x * v.y - w.y * v.x) / cross, along_edge = (w.x * u.y - w.y * u.x) / cross;
      if (along_s > 0 && along_s < 1 && along_edge >= 0 && along_edge <= 1) shares.push_back(along_s);
    }
  }
  return shares;
}

double AreaIndex::Depth(Point2 p) const {
  double nearest = reach_m_;
  const auto found = cells_.find(Cell(p.x) * 1'000'003 + Cell(p.y));
  if (found != cells_.end())
    for (const Segment& s : found->second) nearest = std::min(nearest, DistanceToSegment(p, s.a, s.b));
  return Inside(p) ? nearest : -nearest;
}

}  // namespace flaneur
