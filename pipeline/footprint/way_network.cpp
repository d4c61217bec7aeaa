#include "pipeline/footprint/way_network.h"

#include <algorithm>
#include <boost/polygon/segment_data.hpp>
#include <boost/polygon/voronoi.hpp>
#include <cmath>
#include <limits>

#include "pipeline/footprint/constants.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

namespace bp = boost::polygon;

using GridPoint = bp::point_data<int>;
using GridSegment = bp::segment_data<int>;
using Diagram = bp::voronoi_diagram<double>;

struct Edge {
  Point2 a, b;
  size_t ring, index, count;
  bool open;
};

// Which edges pass a row of the plan, to tell inside from outside quickly.
class Rows {
 public:
  explicit Rows(const std::vector<Edge>& edges) {
    double low = 1e300, high = -1e300;
    for (const Edge& e : edges) low = std::min({low, e.a.y, e.b.y}), high = std::max({high, e.a.y, e.b.y});
    low_ = low;
    rows_.resize(edges.empty() ? 1 : static_cast<size_t>((high - low) / kRowHeight_m) + 1);
    for (const Edge& e : edges)
      for (size_t row = Row(std::min(e.a.y, e.b.y)); row <= Row(std::max(e.a.y, e.b.y)); ++row)
        rows_[row].push_back(&e);
  }

  bool Inside(Point2 p) const {
    bool inside = false;
    if (p.y < low_ || Row(p.y) >= rows_.size()) return false;
    for (const Edge* e : rows_[Row(p.y)])
      if ((e->a.y > p.y) != (e->b.y > p.y) && p.x < e->a.x + (e->b.x - e->a.x) * (p.y - e->a.y) / (e->b.y - e->a.y))
        inside = !inside;
    return inside;
  }

 private:
  size_t Row(double y) const { return static_cast<size_t>((y - low_) / kRowHeight_m); }
  double low_ = 0;
  std::vector<std::vector<const Edge*>> rows_;
};

class Builder {
 public:
  Builder(const Rings& ground, double least_clearance, const OpenTest& is_open) : least_(least_clearance) {
    FindGrid(ground);
    for (size_t r = 0; r < ground.size(); ++r) AddRing(ground[r], r, is_open);
  }

  WayNetwork Build() {
    if (edges_.empty()) return {};
    bp::construct_voronoi(grid_.begin(), grid_.end(), &diagram_);
    AddNodes();
    AddWays();
    return std::move(network_);
  }

 private:
  void FindGrid(const Rings& ground) {
    Point2 min{1e300, 1e300}, max{-1e300, -1e300};
    for (const Ring& ring : ground) {
      for (const Point2& p : ring) {
        min = {std::min(min.x, p.x), std::min(min.y, p.y)};
        max = {std::max(max.x, p.x), std::max(max.y, p.y)};
      }
    }
    units_per_metre_ = std::max(max.x - min.x, max.y - min.y) < kMaxFineGround_m ? 1e4 : 1e3;
    middle_ = {(min.x + max.x) / 2, (min.y + max.y) / 2};
  }

  GridPoint OnGrid(Point2 p) const {
    return {static_cast<int>(std::lround((p.x - middle_.x) * units_per_metre_)),
            static_cast<int>(std::lround((p.y - middle_.y) * units_per_metre_))};
  }
  Point2 FromGrid(double x, double y) const {
    return {middle_.x + x / units_per_metre_, middle_.y + y / units_per_metre_};
  }

  void AddRing(const Ring& ring, size_t number, const OpenTest& is_open) {
    Ring snapped;  // to the diagram's grid, where neighbours may fall together
    for (const Point2& p : ring) {
      const GridPoint g = OnGrid(p);
      const Point2 q = FromGrid(g.x(), g.y());
      if (snapped.empty() || snapped.back().x != q.x || snapped.back().y != q.y) snapped.push_back(q);
    }
    while (snapped.size() > 1 && snapped.front().x == snapped.back().x && snapped.front().y == snapped.back().y)
      snapped.pop_back();
    const size_t n = snapped.size();
    if (n < 3) return;
    for (size_t i = 0; i < n; ++i) {
      const Point2 a = snapped[i], b = snapped[(i + 1) % n];
      edges_.push_back({a, b, number, i, n, is_open(a, b)});
      grid_.push_back({OnGrid(a), OnGrid(b)});
    }
  }

  const Edge& EdgeOf(const Diagram::cell_type& cell) const { return edges_[cell.source_index()]; }

  // The corner that the cell belongs to, where it is not an edge's.
  static bool IsCorner(const Diagram::cell_type& cell) { return cell.contains_point(); }
  Point2 CornerOf(const Diagram::cell_type& cell) const {
    const Edge& edge = EdgeOf(cell);
    return cell.source_category() == bp::SOURCE_CATEGORY_SEGMENT_START_POINT ? edge.a : edge.b;
  }

  double DistanceTo(const Diagram::cell_type& cell, Point2 p) const {
    if (IsCorner(cell)) return std::hypot(p.x - CornerOf(cell).x, p.y - CornerOf(cell).y);
    return DistanceToSegment(p, EdgeOf(cell).a, EdgeOf(cell).b);
  }

  void AddNodes() {
    const Rows rows(edges_);
    node_of_.assign(diagram_.num_vertices(), -1);
    size_t index = 0;
    for (const auto& vertex : diagram_.vertices()) {
      vertex.color(index);
      const Point2 at = FromGrid(vertex.x(), vertex.y());
      const auto& cell = *vertex.incident_edge()->cell();
      const double clearance = DistanceTo(cell, at);
      if (clearance >= least_ && IsInside(vertex, at, rows)) {
        node_of_[index] = Count(network_.nodes);
        network_.nodes.push_back({at, clearance, IsOpen(vertex), {}});
      }
      ++index;
    }
  }

  // Ground lies on the left of every edge.
  bool IsInside(const Diagram::vertex_type& vertex, Point2 at, const Rows& rows) const {
    const auto* first = vertex.incident_edge();
    const auto* edge = first;
    do {
      if (!IsCorner(*edge->cell())) {
        const Edge& e = EdgeOf(*edge->cell());
        return (e.b.x - e.a.x) * (at.y - e.a.y) - (e.b.y - e.a.y) * (at.x - e.a.x) > 0;
      }
      edge = edge->rot_next();
    } while (edge != first);
    return rows.Inside(at);
  }

  bool IsOpen(const Diagram::cell_type& cell) const { return !IsCorner(cell) && EdgeOf(cell).open; }
  bool IsOpen(const Diagram::vertex_type& vertex) const {
    const auto* first = vertex.incident_edge();
    const auto* edge = first;
    do {
      if (IsOpen(*edge->cell())) return true;
      edge = edge->rot_next();
    } while (edge != first);
    return false;
  }

  void AddWays() {
    for (const auto& edge : diagram_.edges()) {
      if (&edge > edge.twin() || !edge.is_finite() || !edge.is_primary()) continue;
      const int from = node_of_[edge.vertex0()->color()], to = node_of_[edge.vertex1()->color()];
      if (from < 0 || to < 0 || from == to) continue;
      const auto &cell = *edge.cell(), &other = *edge.twin()->cell();
      if (RunsIntoCorner(cell, other)) continue;
      Point2 at;
      const double narrowest = Narrowest(cell, other, from, to, &at);
      if (narrowest < least_) continue;
      if (narrowest >= std::min(ClearanceOf(from), ClearanceOf(to))) {
        AddWay(from, to, cell, other);
        continue;
      }
      const int middle = AddNode(at, narrowest, IsOpen(cell) || IsOpen(other));
      AddWay(from, middle, cell, other), AddWay(middle, to, cell, other);
    }
  }

  double ClearanceOf(int node) const { return At(network_.nodes, node).clearance_m; }

  int AddNode(Point2 at, double clearance, bool open) {
    network_.nodes.push_back({at, clearance, open, {}});
    return Count(network_.nodes) - 1;
  }

  // In steps.
  void AddWay(int from, int to, const Diagram::cell_type& cell, const Diagram::cell_type& other) {
    const Point2 a = At(network_.nodes, from).at, b = At(network_.nodes, to).at;
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    const double step = std::max(kNodeStep_m, std::min(ClearanceOf(from), ClearanceOf(to)) / 2);
    const int steps = static_cast<int>(std::clamp(std::ceil(length / step), 1.0, kMaxNodeSteps));
    int before = from;
    for (int s = 1; s <= steps; ++s) {
      const Point2 at{a.x + (b.x - a.x) * s / steps, a.y + (b.y - a.y) * s / steps};
      const int next = s == steps ? to
                                  : AddNode(at, std::max(least_, std::min(DistanceTo(cell, at), DistanceTo(other, at))),
                                            IsOpen(cell) || IsOpen(other));
      const int way = Count(network_.ways);
      network_.ways.push_back({before, next, length / steps});
      At(network_.nodes, before).ways.push_back(way);
      At(network_.nodes, next).ways.push_back(way);
      before = next;
    }
  }

  bool RunsIntoCorner(const Diagram::cell_type& cell, const Diagram::cell_type& other) const {
    if (IsCorner(cell) || IsCorner(other)) return false;
    const Edge &a = EdgeOf(cell), &b = EdgeOf(other);
    if (a.ring != b.ring) return false;
    return (a.index + 1) % a.count == b.index || (b.index + 1) % b.count == a.index;
  }

  // The least clearance between two nodes: at one of them, or `at` where the way passes straight between corners.
  double Narrowest(const Diagram::cell_type& cell, const Diagram::cell_type& other, int from, int to,
                   Point2* at) const {
    const WayNode &p = At(network_.nodes, from), &q = At(network_.nodes, to);
    const double ends = std::min(p.clearance_m, q.clearance_m);
    if (!IsCorner(cell) && !IsCorner(other)) return ends;
    const auto& corner = IsCorner(cell) ? cell : other;
    const auto& facing = IsCorner(cell) ? other : cell;
    const Point2 c = CornerOf(corner);
    const Point2 f = IsCorner(facing) ? CornerOf(facing) : Foot(c, EdgeOf(facing));
    const Point2 middle{(c.x + f.x) / 2, (c.y + f.y) / 2};
    *at = middle;
    const double dx = q.at.x - p.at.x, dy = q.at.y - p.at.y;
    const double along = (middle.x - p.at.x) * dx + (middle.y - p.at.y) * dy;
    if (along <= 0 || along >= dx * dx + dy * dy) return ends;
    return std::min(ends, std::hypot(c.x - f.x, c.y - f.y) / 2);
  }

  static Point2 Foot(Point2 p, const Edge& e) {
    const double dx = e.b.x - e.a.x, dy = e.b.y - e.a.y,
                 t = ((p.x - e.a.x) * dx + (p.y - e.a.y) * dy) / (dx * dx + dy * dy);
    return {e.a.x + t * dx, e.a.y + t * dy};
  }

  double least_, units_per_metre_ = 1e4;
  Point2 middle_;
  std::vector<Edge> edges_;
  std::vector<GridSegment> grid_;
  Diagram diagram_;
  std::vector<int> node_of_;
  WayNetwork network_;
};

}  // namespace

WayNetwork BuildWayNetwork(const Rings& ground, double least_clearance_m, const OpenTest& is_open) {
  return Builder(ground, least_clearance_m, is_open).Build();
}

}  // namespace flaneur
