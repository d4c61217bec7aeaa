#include "pipeline/footprint/segment_grid.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "pipeline/footprint/constants.h"

namespace flaneur {
namespace {

int64_t Key(int64_t x, int64_t y) { return x * 73856093 + y; }

Point2 Rounded(Point2 p) {
  return {std::round(p.x / kPointGrid_m) * kPointGrid_m, std::round(p.y / kPointGrid_m) * kPointGrid_m};
}
bool Same(Point2 a, Point2 b) { return a.x == b.x && a.y == b.y; }
bool Before(const Segment& s, const Segment& t) {
  return std::tie(s.a.x, s.a.y, s.b.x, s.b.y) < std::tie(t.a.x, t.a.y, t.b.x, t.b.y);
}
double Share(const Segment& s, Point2 p) {
  const double dx = s.b.x - s.a.x, dy = s.b.y - s.a.y;
  return ((p.x - s.a.x) * dx + (p.y - s.a.y) * dy) / (dx * dx + dy * dy);
}

bool Apart(double a0, double a1, double b0, double b1) {
  return std::min(a0, a1) > std::max(b0, b1) + kTouching_m || std::min(b0, b1) > std::max(a0, a1) + kTouching_m;
}

using Cuts = std::vector<std::vector<Point2>>;

void CutAtEnd(const Segment& s, Point2 end, std::vector<Point2>* cuts) {
  if (Same(end, s.a) || Same(end, s.b)) return;
  if (DistanceToSegment(end, s.a, s.b) <= kTouching_m) cuts->push_back(end);
}

void CutPair(const std::vector<Segment>& segments, size_t i, size_t j, Cuts* cuts) {
  const Segment &s = segments[i], &t = segments[j];
  if (Apart(s.a.x, s.b.x, t.a.x, t.b.x) || Apart(s.a.y, s.b.y, t.a.y, t.b.y)) return;
  CutAtEnd(s, t.a, &(*cuts)[i]);
  CutAtEnd(s, t.b, &(*cuts)[i]);
  CutAtEnd(t, s.a, &(*cuts)[j]);
  CutAtEnd(t, s.b, &(*cuts)[j]);
  const Point2 u{s.b.x - s.a.x, s.b.y - s.a.y}, v{t.b.x - t.a.x, t.b.y - t.a.y}, w{t.a.x - s.a.x, t.a.y - s.a.y};
  const double cross = u.x * v.y - u.y * v.x;
  if (cross == 0) return;
  const double along_s = (w.x * v.y - w.y * v.x) / cross, along_t = (w.x * u.y - w.y * u.x) / cross;
  if (along_s <= 0 || along_s >= 1 || along_t <= 0 || along_t >= 1) return;
  const Point2 p = Rounded({s.a.x + along_s * u.x, s.a.y + along_s * u.y});
  (*cuts)[i].push_back(p);
  (*cuts)[j].push_back(p);
}

void AddPieces(const Segment& s, std::vector<Point2> cuts, std::vector<Segment>* out) {
  std::sort(cuts.begin(), cuts.end(), [&](Point2 p, Point2 q) {
    const double a = Share(s, p), b = Share(s, q);
    return a != b ? a < b : std::tie(p.x, p.y) < std::tie(q.x, q.y);
  });
  cuts.push_back(s.b);
  Point2 from = s.a;
  for (const Point2 to : cuts) {
    if (Same(from, to)) continue;
    const bool forward = std::tie(from.x, from.y) < std::tie(to.x, to.y);
    out->push_back(forward ? Segment{from, to} : Segment{to, from});
    from = to;
  }
}

void DropRepeated(std::vector<Segment>* segments) {
  std::sort(segments->begin(), segments->end(), Before);
  const auto same = [](const Segment& s, const Segment& t) { return Same(s.a, t.a) && Same(s.b, t.b); };
  segments->erase(std::unique(segments->begin(), segments->end(), same), segments->end());
}

}  // namespace

SegmentGrid::SegmentGrid(const std::vector<Segment>& segments, double reach_m, double cell_m)
    : cell_m_(cell_m), one_cell_(segments.size() <= kFewSegments) {
  if (one_cell_) {
    std::vector<size_t>& all = cells_[Key(0, 0)];
    for (size_t i = 0; i < segments.size(); ++i) all.push_back(i);
    return;
  }
  for (size_t i = 0; i < segments.size(); ++i) {
    const Segment& s = segments[i];
    const double length = std::hypot(s.b.x - s.a.x, s.b.y - s.a.y);
    const int steps = std::max(1, static_cast<int>(std::ceil(length / cell_m)));
    for (int k = 0; k < steps; ++k) {  // box by box along the segment, so that long ones stay cheap
      const double t0 = static_cast<double>(k) / steps, t1 = static_cast<double>(k + 1) / steps;
      AddBox(i, {s.a.x + t0 * (s.b.x - s.a.x), s.a.y + t0 * (s.b.y - s.a.y)},
             {s.a.x + t1 * (s.b.x - s.a.x), s.a.y + t1 * (s.b.y - s.a.y)}, reach_m);
    }
  }
}

double CellFor(const std::vector<Segment>& segments) {
  double length = 0;
  for (const Segment& s : segments) length += std::hypot(s.b.x - s.a.x, s.b.y - s.a.y);
  return std::clamp(length / static_cast<double>(segments.size()), kMinCutCell_m, kMaxCutCell_m);
}

int64_t SegmentGrid::Cell(double v) const { return one_cell_ ? 0 : static_cast<int64_t>(std::floor(v / cell_m_)); }

void SegmentGrid::AddBox(size_t i, Point2 a, Point2 b, double reach_m) {
  for (int64_t x = Cell(std::min(a.x, b.x) - reach_m); x <= Cell(std::max(a.x, b.x) + reach_m); ++x) {
    for (int64_t y = Cell(std::min(a.y, b.y) - reach_m); y <= Cell(std::max(a.y, b.y) + reach_m); ++y) {
      std::vector<size_t>& cell = cells_[Key(x, y)];
      if (cell.empty() || cell.back() != i) cell.push_back(i);
    }
  }
}

const std::vector<size_t>& SegmentGrid::Near(Point2 p) const {
  static const std::vector<size_t> none;
  const auto found = cells_.find(Key(Cell(p.x), Cell(p.y)));
  return found == cells_.end() ? none : found->second;
}

Point2 NearestOn(const Segment& s, Point2 p) {
  const double t = std::clamp(Share(s, p), 0.0, 1.0);
  return {s.a.x + t * (s.b.x - s.a.x), s.a.y + t * (s.b.y - s.a.y)};
}

std::vector<Segment> CutWhereTheyMeet(std::vector<Segment> segments) {
  for (Segment& s : segments) s = {Rounded(s.a), Rounded(s.b)};
  std::erase_if(segments, [](const Segment& s) { return Same(s.a, s.b); });
  for (int round = 0; round < kCuttingRounds && !segments.empty(); ++round) {
    const SegmentGrid grid(segments, kTouching_m, CellFor(segments));
    Cuts cuts(segments.size());
    for (const auto& [_, cell] : grid.cells()) {
      for (size_t k = 0; k < cell.size(); ++k) {
        for (size_t l = 0; l < k; ++l) CutPair(segments, cell[l], cell[k], &cuts);
      }
    }
    std::vector<Segment> pieces;
    for (size_t i = 0; i < segments.size(); ++i) AddPieces(segments[i], std::move(cuts[i]), &pieces);
    DropRepeated(&pieces);
    const bool settled = pieces.size() == segments.size();
    segments = std::move(pieces);
    if (settled) break;
  }
  return segments;
}

}  // namespace flaneur
