#include "pipeline/footprint/box_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace flaneur {
namespace {

TEST(BoxGrid, FindsWhatComesNear) {
  std::mt19937 random(3);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  std::vector<BoundingBox> boxes{{}, {{-5000, -5000}, {5000, 5000}}};  // nothing, and one that is wide
  for (int i = 0; i < 500; ++i) {
    const Point2 at{uniform(-400, 400), uniform(-400, 400)};
    boxes.push_back({at, {at.x + uniform(0, 40), at.y + uniform(0, 40)}});
  }
  const BoxGrid grid(boxes);
  for (int i = 0; i < 100; ++i) {
    const Point2 at{uniform(-500, 500), uniform(-500, 500)};
    const BoundingBox box{at, {at.x + uniform(0, 60), at.y + uniform(0, 60)}};
    const double reach = uniform(0, 10);
    std::vector<size_t> expected;
    for (size_t k = 1; k < boxes.size(); ++k) {
      const BoundingBox& b = boxes[k];
      if (b.min.x <= box.max.x + reach && box.min.x <= b.max.x + reach && b.min.y <= box.max.y + reach &&
          box.min.y <= b.max.y + reach)
        expected.push_back(k);
    }
    EXPECT_EQ(grid.Near(box, reach), expected);
  }
}

TEST(BoxGrid, OutwardsMeetsTheNearest) {
  const BoxGrid grid({{{100, 0}, {110, 10}}, {{-300, -5}, {-290, 5}}, {{900, 900}, {901, 901}}});
  double nearest = 1e100;
  size_t which = 99;
  grid.Outwards(
      {0, 0},
      [&](size_t i) {
        const double d = std::hypot(grid.boxes()[i].min.x, grid.boxes()[i].min.y);
        if (d < nearest) nearest = d, which = i;
      },
      [&] { return nearest; });
  EXPECT_EQ(which, 0u);
}

}  // namespace
}  // namespace flaneur
