#include "pipeline/footprint/overhead.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flaneur {
namespace {

constexpr double kCell_m = 1.0;

int64_t Cell(double v) { return static_cast<int64_t>(std::floor(v / kCell_m)); }
int64_t Key(int64_t x, int64_t y) { return x * 1'000'003 + y; }

}  // namespace

void Overhead::Add(const std::vector<Triangle3>& triangles) {
  for (const Triangle3& t : triangles) {
    const auto [a, b, c] = t;
    if (std::abs((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y)) < 1e-9) continue;
    for (int64_t x = Cell(std::min({a.x, b.x, c.x})); x <= Cell(std::max({a.x, b.x, c.x})); ++x)
      for (int64_t y = Cell(std::min({a.y, b.y, c.y})); y <= Cell(std::max({a.y, b.y, c.y})); ++y)
        cells_[Key(x, y)].push_back(&t);
  }
}

double Overhead::LowestAbove(Point2 p, double z) const {
  double lowest = std::numeric_limits<double>::infinity();
  const auto found = cells_.find(Key(Cell(p.x), Cell(p.y)));
  if (found == cells_.end()) return lowest;
  for (const Triangle3* t : found->second) {
    const auto [a, b, c] = *t;
    const double area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    const double wb = ((p.x - a.x) * (c.y - a.y) - (c.x - a.x) * (p.y - a.y)) / area;
    const double wc = ((b.x - a.x) * (p.y - a.y) - (p.x - a.x) * (b.y - a.y)) / area;
    if (wb < 0 || wc < 0 || wb + wc > 1) continue;
    const double height = a.z + wb * (b.z - a.z) + wc * (c.z - a.z);
    if (height > z) lowest = std::min(lowest, height);
  }
  return lowest;
}

bool Overhead::Covers(Point2 p, double z) const { return std::isfinite(LowestAbove(p, z)); }

}  // namespace flaneur
