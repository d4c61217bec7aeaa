#include "pipeline/avatar/figure_picture.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/pipeline/test_human.h"

namespace flaneur {
namespace {

// Columns of a view of that width in which something is drawn above the ground's line.
std::vector<int> DrawnColumns(const Pixels& picture, int first, int width) {
  std::vector<int> drawn;
  for (int x = 0; x < width; ++x) {
    for (int y = 0; y < picture.height / 2; ++y) {
      const auto at =
          4 * (static_cast<size_t>(y) * static_cast<size_t>(picture.width) + static_cast<size_t>(first + x));
      if (picture.rgba[at] == 255 && picture.rgba[at + 1] == 255 && picture.rgba[at + 2] == 255) continue;
      drawn.push_back(x);
      break;
    }
  }
  return drawn;
}

// Horses, and who rides one.
TEST(FigurePicture, WhoIsLongerThanHighIsSeenWhole) {
  Avatar horse;
  horse.joints = {{"body", -1, {}, {}}};
  Mesh body;
  AddBox({0, 0.8f, -1.2f}, {0, 0.8f, 1.2f}, 0.2f, 0, &body);
  const std::vector<Mat4> rest(1);
  const Pixels picture = DrawFigures({body}, horse, {{rest, 90}, {rest, 0}}, 1, 200);
  const int width = picture.width / 2;
  const std::vector<int> aside = DrawnColumns(picture, 0, width), front = DrawnColumns(picture, width, width);
  ASSERT_FALSE(aside.empty() || front.empty());
  EXPECT_GT(aside.front(), 0);
  EXPECT_LT(aside.back(), width - 1);
  EXPECT_NEAR(static_cast<double>(aside.size()) / static_cast<double>(front.size()), 2.8 / 0.4, 0.4) << "one scale";
}

// Who raises a hand above their head.
TEST(FigurePicture, WhatReachesHigherThanTheFigureIsInThePicture) {
  Avatar person;
  person.joints = {{"body", -1, {}, {}}};
  Mesh body;
  AddBox({0, 0.2f, 0}, {0, 1.8f, 0}, 0.2f, 0, &body);
  const Pixels picture = DrawFigures({body}, person, {{std::vector<Mat4>(1), 0}}, 1.4f, 200);
  const auto top = picture.rgba.begin();
  EXPECT_TRUE(std::all_of(top, top + 4 * picture.width, [](uint8_t c) { return c == 255; })) << "not cut by the edge";
}

}  // namespace
}  // namespace flaneur
