#include "runtime/likeness/compare.h"

#include <gtest/gtest.h>

#include <array>

namespace flaneur {
namespace {

// A square of `color` with normal +Z before a grey sky, from column `left` on.
Portrait Square(int left, std::array<uint8_t, 3> color, std::array<uint8_t, 3> normal = {128, 128, 255}) {
  constexpr int kSize = 16;
  Portrait p;
  p.size_px = kSize;
  for (int i = 0; i < kSize * kSize; ++i) {
    const bool in = i % kSize >= left && i % kSize < left + 8 && i / kSize >= 4 && i / kSize < 12;
    if (in) p.rgba.insert(p.rgba.end(), {color[0], color[1], color[2], 255});
    else p.rgba.insert(p.rgba.end(), {90, 90, 90, 255});
    if (in) p.normals.insert(p.normals.end(), {normal[0], normal[1], normal[2], 255});
    else p.normals.insert(p.normals.end(), {0, 0, 0, 0});
  }
  return p;
}

TEST(DeltaE, KnownColours) {
  const uint8_t white[] = {255, 255, 255}, black[] = {0, 0, 0}, red[] = {255, 0, 0}, green[] = {0, 255, 0};
  EXPECT_NEAR(DeltaE(white, black), 100, 0.01);
  EXPECT_NEAR(DeltaE(red, green), 170.6, 0.1);
  EXPECT_EQ(DeltaE(red, red), 0);
}

TEST(Compare, TheSamePictureIsAlike) {
  const Likeness same = Compare(Square(4, {200, 10, 10}), Square(4, {200, 10, 10}));
  EXPECT_EQ(same.delta_e, 0);
  EXPECT_EQ(same.delta_e_whole, 0);
  EXPECT_EQ(same.overlap, 1);
  EXPECT_NEAR(same.normal_deg, 0, 1e-4);
}

TEST(Compare, AMovedSquareOverlapsInPart) {
  const Likeness moved = Compare(Square(4, {200, 10, 10}), Square(6, {200, 10, 10}));
  EXPECT_NEAR(moved.overlap, 6.0 / 10, 1e-9);
  EXPECT_EQ(moved.delta_e, 0);
  EXPECT_GT(moved.delta_e_whole, 0);
}

TEST(Compare, TurnedNormals) {
  const Likeness turned = Compare(Square(4, {9, 9, 9}), Square(4, {9, 9, 9}, {255, 128, 128}));
  EXPECT_NEAR(turned.normal_deg, 90, 0.5);
}

TEST(Compare, NobodyIsLikeNobody) { EXPECT_EQ(Compare(Square(40, {1, 1, 1}), Square(4, {1, 1, 1})).overlap, 0); }

}  // namespace
}  // namespace flaneur
