// Answers what stands over a place.
#pragma once
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "pipeline/footprint/polygon_sets.h"
#include "pipeline/footprint/town_objects.h"

namespace flaneur {

// Holds pointers to the triangles given to Add: they must outlive it.
class Overhead {
 public:
  void Add(const std::vector<Triangle3>& triangles);
  // True where a triangle lies over p, higher than z.
  bool Covers(Point2 p, double z) const;
  // The lowest surface over p that is higher than z, else infinity.
  double LowestAbove(Point2 p, double z) const;

 private:
  std::unordered_map<int64_t, std::vector<const Triangle3*>> cells_;
};

}  // namespace flaneur
