#include "pipeline/cli/painting.h"

#include <gtest/gtest.h>

#include "pipeline/core/temporary_folder.h"
#include "pipeline/pictures/picture_files.h"
#include "runtime/base/file.h"

namespace flaneur {
namespace {

// 40 x 20 m from (-10, 5), all of it pavement but the eastern 10 m.
GroundRaster Ground() {
  GroundRaster g;
  g.min_m = {-10, 5};
  g.cell_m = 0.5f;
  g.columns = 80;
  g.rows = 40;
  g.height_m.assign(3200, 0);
  for (int i = 0; i < 3200; ++i) g.kind.push_back(i % 80 < 60 ? 2 : 0);
  return g;
}

class PaintedPicture : public testing::Test {
 protected:
  void SetUp() override { ASSERT_FALSE(folder_.Create("flaneur_painting_", std::filesystem::temp_directory_path())); }

  // color(x, y) from the top left gives red, green, blue, alpha.
  template <typename Color>
  std::filesystem::path Written(int width, int height, Color color) {
    Pixels pixels{width, height, {}};
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const std::array<uint8_t, 4> c = color(x, y);
        pixels.rgba.insert(pixels.rgba.end(), c.begin(), c.end());
      }
    }
    Image png;
    EXPECT_FALSE(EncodePng(pixels, true, &png));
    const auto path = folder_.path() / "paint.png";
    EXPECT_FALSE(WriteFile(path, png.bytes));
    return path;
  }

  TemporaryFolder folder_;
  Painting painting_;
};

using Rgba = std::array<uint8_t, 4>;

TEST_F(PaintedPicture, RedAndGreenCountByHowFarTheyAreFromGreyAndNorthIsAtTheTop) {
  const auto path = Written(80, 40, [](int x, int y) -> Rgba {
    if (x < 20 && y < 10) return {255, 55, 55, 255};   // the north-western quarter of the quarter: 200
    if (x < 20 && y >= 30) return {90, 190, 90, 255};  // the south-western: 100 of green
    if (x >= 40 && x < 50) return {255, 0, 0, 0};      // transparent
    return {176, 176, 176, 255};                       // the plan's grey
  });
  ASSERT_EQ(ReadPainting({path, {}, {}}, Ground(), &painting_).message, "");
  EXPECT_EQ(painting_.columns, 40);
  EXPECT_EQ(painting_.rows, 20);
  const auto people = [&](Vec2 p) { return painting_.people[static_cast<size_t>(PaintingCell(painting_, p))]; };
  const auto loiter = [&](Vec2 p) { return painting_.loiter[static_cast<size_t>(PaintingCell(painting_, p))]; };
  EXPECT_EQ(people({-5, 24}), 200);
  EXPECT_EQ(people({-5, 6}), 0);
  EXPECT_EQ(loiter({-5, 6}), 100);
  EXPECT_EQ(people({12, 15}) + loiter({12, 15}) + people({5, 15}), 0);
  EXPECT_EQ(PaintingCell(painting_, {31, 15}), -1);
}

TEST_F(PaintedPicture, TheAreaMayBeGiven) {
  const auto path = Written(10, 10, [](int, int) -> Rgba { return {255, 0, 0, 255}; });
  ASSERT_EQ(ReadPainting({path, Vec2{0, 10}, Vec2{10, 20}}, Ground(), &painting_).message, "");
  EXPECT_EQ(PaintingCell(painting_, {-1, 15}), -1);
  EXPECT_EQ(painting_.people.size(), 100u);
}

TEST_F(PaintedPicture, WhatIsWrongIsSaidInOneLine) {
  const auto red = [](int, int) -> Rgba { return {255, 0, 0, 255}; };
  const auto says = [&](const PaintingSettings& settings, const char* what) {
    const Error e = ReadPainting(settings, Ground(), &painting_);
    EXPECT_NE(e.message.find(what), std::string::npos) << e.message;
    EXPECT_EQ(e.message.find('\n'), std::string::npos) << e.message;
  };
  says({folder_.path() / "none.png", {}, {}}, "none.png");
  says({Written(40, 40, red), {}, {}}, "40 x 40 pixels don't fit the shape of the 40 x 20 m");
  says({Written(80, 40, [](int, int) -> Rgba { return {0, 0, 0, 255}; }), {}, {}}, "nothing is painted");
  says({Written(10, 10, red), Vec2{22, 10}, Vec2{28, 16}}, "off the town's ground");
  ASSERT_FALSE(WriteTextFile(folder_.path() / "text.png", "no picture"));
  says({folder_.path() / "text.png", {}, {}}, "text.png");
}

TEST_F(PaintedPicture, ThePlanIsACanvasThatSaysNothingItself) {
  Footprints footprints;
  Obstacle house, tree;
  house.outer = {{0, 10}, {5, 10}, {5, 15}, {0, 15}};
  tree.center = {10, 20};
  tree.radius_m = 1;
  footprints.obstacles = {house, tree};
  const auto plan = folder_.path() / "plan.png";
  ASSERT_EQ(WritePlan(plan, Ground(), footprints).message, "");
  const Error e = ReadPainting({plan, {}, {}}, Ground(), &painting_);
  EXPECT_NE(e.message.find("nothing is painted"), std::string::npos) << e.message;
}

}  // namespace
}  // namespace flaneur
