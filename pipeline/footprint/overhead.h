// Answers what stands over a place.
#pragma once
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "pipeline/footprint/polygon_sets.h"
#include "pipeline/footprint/town_objects.h"

namespace flaneur {

inline constexpr double kLowest = -std::numeric_limits<double>::infinity();  // below everything

// Holds pointers to the triangles: they must outlive it.
class Overhead {
 public:
  explicit Overhead(const std::vector<const std::vector<Triangle3>*>& objects);
  // True where a triangle lies over p, higher than z.
  bool Covers(Point2 p, double z) const;
  // The lowest surface over p that is higher than z, else infinity.
  double LowestAbove(Point2 p, double z) const;

 private:
  using Entry = std::pair<int64_t, const Triangle3*>;  // a cell, and one of the triangles over it
  double cell_m_ = 1;
  std::vector<Entry> entries_;  // by cell
};

}  // namespace flaneur
