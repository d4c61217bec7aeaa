// Segments by the cells of a grid that they pass, and their arrangement on a grid of points.
#pragma once
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "pipeline/footprint/polygon_sets.h"

namespace flaneur {

class SegmentGrid {
 public:
  // A segment is listed in all cells within reach_m of it.
  SegmentGrid(const std::vector<Segment>& segments, double reach_m, double cell_m);
  // Indices of the segments within reach_m of p, and some farther ones; ascending.
  const std::vector<size_t>& Near(Point2 p) const;
  double cell_m() const { return cell_m_; }
  bool one_cell() const { return one_cell_; }  // few segments: all are near each other
  // The lists of all cells, in no particular order.
  const std::unordered_map<int64_t, std::vector<size_t>>& cells() const { return cells_; }

 private:
  int64_t Cell(double v) const;
  void AddBox(size_t i, Point2 a, Point2 b, double reach_m);
  double cell_m_;
  bool one_cell_;
  std::unordered_map<int64_t, std::vector<size_t>> cells_;
};

// A cell about as long as the segments, for a grid of which each cell holds few of them.
double CellFor(const std::vector<Segment>& segments);

Point2 NearestOn(const Segment& s, Point2 p);

// Cuts segments where they meet, each meeting point rounded to a tenth of a millimetre, and drops repeated pieces: what
// comes back hardly ever crosses, so exact arithmetic on it stays cheap. Deterministic for the same segments in the
// same order.
std::vector<Segment> CutWhereTheyMeet(std::vector<Segment> segments);

}  // namespace flaneur
