// The title page in windows of any size.
#include "runtime/visit/title_layout.h"

#include <gtest/gtest.h>

#include <array>

#include "runtime/base/png.h"

namespace flaneur {
namespace {

// Left half red, right half green.
std::vector<uint8_t> TwoColours(int width_px, int height_px) {
  std::vector<uint8_t> rgb;
  for (int k = 0; k < width_px * height_px; ++k) {
    const bool left = k % width_px < width_px / 2;
    for (const uint8_t value : {left ? 200 : 0, left ? 0 : 200, 0}) rgb.push_back(value);
  }
  return EncodePng(width_px, height_px, 3, rgb);
}

std::vector<uint8_t> BlueGlass(int width_px, int height_px) {
  std::vector<uint8_t> rgba;
  for (int k = 0; k < width_px * height_px; ++k) rgba.insert(rgba.end(), {0, 0, 255, 128});
  return EncodePng(width_px, height_px, 4, rgba);
}

std::array<int, 4> At(const Pixels& page, float x, float y) {
  const auto column = static_cast<size_t>(x * static_cast<float>(page.width - 1) + 0.5f);
  const auto row = static_cast<size_t>(y * static_cast<float>(page.height - 1) + 0.5f);
  const uint8_t* p = &page.rgba[4 * (row * static_cast<size_t>(page.width) + column)];
  return {p[0], p[1], p[2], p[3]};
}

TEST(TitleLayout, ThePictureFillsWindowsOfAnyShape) {
  const TitlePictures pictures = DecodeTitlePage({TwoColours(64, 36), {}, {1, 1, 1}});
  for (const auto& [width_px, height_px] : {std::pair{320, 180}, {180, 320}, {1000, 100}, {17, 16}, {1, 1}}) {
    const Pixels page = LayOutTitlePage(pictures, width_px, height_px);
    ASSERT_EQ(page.rgba.size(), static_cast<size_t>(4 * width_px * height_px));
    if (width_px == 1) continue;
    for (const float y : {0.0f, 0.5f, 1.0f}) {
      EXPECT_EQ(At(page, 0, y), (std::array{200, 0, 0, 255})) << width_px;
      EXPECT_EQ(At(page, 1, y), (std::array{0, 200, 0, 255})) << width_px;
    }
  }
}

TEST(TitleLayout, TheLogoStandsOverItTranslucentAndWhole) {
  const TitlePictures pictures = DecodeTitlePage({TwoColours(64, 36), BlueGlass(90, 30), {}});
  const Pixels page = LayOutTitlePage(pictures, 640, 360);
  const auto middle = At(page, 0.3f, 0.4f);
  EXPECT_NEAR(middle[0], 100, 2);
  EXPECT_NEAR(middle[2], 128, 2);
  for (const float x : {0.02f, 0.2f, 0.8f, 0.98f}) EXPECT_EQ(At(page, x, 0.4f)[2], 0) << x;
  for (const float y : {0.02f, 0.2f, 0.6f, 0.98f}) EXPECT_EQ(At(page, 0.5f, y)[2], 0) << y;
}

TEST(TitleLayout, WhatIsMissingOrDamagedLeavesTheBackground) {
  std::vector<uint8_t> cut = TwoColours(64, 36);
  cut.resize(cut.size() / 2);
  for (const auto& picture : {std::vector<uint8_t>{}, {1, 2, 3}, cut}) {
    const TitlePictures pictures = DecodeTitlePage({picture, picture, {1, 0.5f, 0}});
    const Pixels page = LayOutTitlePage(pictures, 32, 20);
    EXPECT_EQ(At(page, 0.5f, 0.5f), (std::array{255, 128, 0, 255}));
  }
}

}  // namespace
}  // namespace flaneur
