#include "pipeline/footprint/roofs.h"

#include <algorithm>

#include "pipeline/footprint/constants.h"

namespace flaneur {
namespace {

// Points of a lattice, finer until enough of them are inside.
std::vector<RegionSample> Samples(const Rings& region) {
  Point2 min = region[0][0], max = min;
  for (const Point2& p : region[0]) {
    min = {std::min(min.x, p.x), std::min(min.y, p.y)};
    max = {std::max(max.x, p.x), std::max(max.y, p.y)};
  }
  std::vector<RegionSample> samples;
  for (int n = 8; samples.size() < kMinRoofSamples && n <= 64; n *= 2) {
    samples.clear();
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < n; ++k) {
        const Point2 p{min.x + (i + 0.5) / n * (max.x - min.x), min.y + (k + 0.5) / n * (max.y - min.y)};
        if (Contains(region, p)) samples.emplace_back(p, 1.0);
      }
    }
  }
  return samples;
}

}  // namespace

bool Roofs::operator()(double area_m2, const std::vector<RegionSample>& samples) const {
  if (area_m2 < site_.options.open_yard_m2) return true;
  double roofed = 0, all = 0;
  // On ground that the building itself tells even a low part of it is no ground to stand on.
  const double over_ground_m =
      site_.ground ? site_.options.band_m[0] : std::min(kRoofOverFloor_m, site_.options.band_m[0]);
  for (const auto& [p, weight] : samples) {
    all += weight;
    if (overhead_.Covers(p, ground_.Height(p.x, p.y) + over_ground_m)) roofed += weight;
  }
  return roofed > kRoofedShare * all;
}

bool Roofs::operator()(const Rings& region) const {
  const double area_m2 = Area(region);
  return (*this)(area_m2, area_m2 < site_.options.open_yard_m2 ? std::vector<RegionSample>() : Samples(region));
}

}  // namespace flaneur
