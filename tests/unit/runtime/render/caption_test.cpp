// Words at the foot of a picture.
#include <gtest/gtest.h>

#include <algorithm>

#include "runtime/render/caption.h"
#include "tests/unit/runtime/render/made_up_tour.h"

namespace flaneur {
namespace {

TEST_F(Drawing, ACaptionStandsAtTheFootAndNowhereElse) {
  const TourPack pack = MakePack({});
  FrameInput frame = LookEast();
  const std::vector<uint8_t> without = Draw(pack, frame);
  frame.caption = "The well has never run dry, so they say: draw from it and see for yourself.";
  const std::vector<uint8_t> with = Draw(pack, frame);
  const size_t upper = static_cast<size_t>(kWidth * kHeight / 2) * 3;
  EXPECT_TRUE(std::equal(with.begin(), with.begin() + static_cast<std::ptrdiff_t>(upper), without.begin()));
  int bright = 0, dark = 0;
  for (int x = 0; x < kWidth; ++x) {
    for (int y = kHeight - 30; y < kHeight; ++y) {
      bright += Pixel(with, x, y).g > 200;
      dark += Pixel(with, x, y).g < Pixel(without, x, y).g / 2 + 20;
    }
  }
  EXPECT_GT(bright, 200);
  EXPECT_GT(dark, 3000);
  frame.caption_share = 0;
  EXPECT_EQ(Draw(pack, frame), without);
}

TEST(Caption, WrapsWordsOverAsManyLinesAsItNeeds) {
  Fonts fonts;
  EXPECT_EQ(LayOutCaption("", {}, 1280, 720, &fonts).height_px, 0);
  EXPECT_EQ(LayOutCaption("well", {}, 40, 30, &fonts).height_px, 0);
  const PackImage one = LayOutCaption("Der Marktplatz: \xC3\xBC\xC3\xA4\xC3\x9F \xFF", {}, 1280, 720, &fonts);
  const PackImage more = LayOutCaption(
      "The market square. The stalls open at six; the well has never run dry, or so they say.", {}, 1280, 720, &fonts);
  EXPECT_EQ(one.width_px, 1280);
  EXPECT_GT(more.height_px, one.height_px * 3 / 2);
  for (const PackImage* image : {&one, &more}) {  // no letter touches the sides
    for (int y = 0; y < image->height_px; ++y) EXPECT_LT(image->rgba[static_cast<size_t>(y * image->width_px) * 4], 64);
  }
}

// The most opaque colour, and how many pixels are letters.
std::pair<Vec3, int> LettersOf(const PackImage& image) {
  std::pair<Vec3, int> found;
  for (size_t k = 0; k < image.rgba.size(); k += 4) {
    if (image.rgba[k] < 200) continue;
    found.first = {static_cast<float>(image.rgba[k]), static_cast<float>(image.rgba[k + 1]),
                   static_cast<float>(image.rgba[k + 2])};
    ++found.second;
  }
  return found;
}

TEST(Caption, IsLargerAndWithoutTranslucencyForWhoeverAsksForIt) {
  Fonts fonts;
  const std::string text = "The market square.";
  const PackImage usual = LayOutCaption(text, {"en", 1, false}, 1280, 720, &fonts);
  const PackImage large = LayOutCaption(text, {"en", 1.6f, true}, 1280, 720, &fonts);
  EXPECT_GT(large.height_px, usual.height_px * 4 / 3);
  EXPECT_GT(LettersOf(large).second, LettersOf(usual).second * 2);
  EXPECT_LT(usual.rgba[3], 255);
  for (size_t k = 3; k < large.rgba.size(); k += 4) ASSERT_EQ(large.rgba[k], 255);
  const Vec3 yellow = LettersOf(large).first;
  EXPECT_GT(yellow.x, 220);
  EXPECT_LT(yellow.z, 100);
}

TEST(Caption, OnOneSideLeavesTheRestOfThePictureFree) {
  Fonts fonts;
  for (const int side : {-1, 1}) {
    for (const char* text :
         {"Next: the well", "The market square. The stalls open at six; the well has never run dry."}) {
      const PackImage image = LayOutCaption(text, {"en", 1, false, side}, 1280, 720, &fonts);
      ASSERT_GT(image.height_px, 0);
      for (int x = 0; x < 1280; ++x) {
        const bool beyond = side < 0 ? x > 1280 * 0.64f : x < 1280 * 0.36f;
        for (int y = 0; y < image.height_px && beyond; ++y)
          ASSERT_EQ(image.rgba[static_cast<size_t>(y * 1280 + x) * 4 + 3], 0) << x << ' ' << text;
      }
      EXPECT_GT(LettersOf(image).second, 100);
    }
  }
}

TEST(Caption, LeavesHalfOfThePictureFreeHoweverMuchItSays) {
  Fonts fonts;
  std::string text;
  for (int k = 0; k < 60; ++k) text += "The stalls open at six; the well has never run dry. ";
  for (const auto& [width_px, height_px] : {std::pair{800, 600}, std::pair{1280, 720}, std::pair{720, 1280}}) {
    const PackImage image = LayOutCaption(text, {"en", 1.65f, false}, width_px, height_px, &fonts);
    EXPECT_LE(image.height_px, height_px * 0.53f) << width_px;
    EXPECT_GT(image.height_px, height_px / 3) << width_px;
  }
}

TEST(Caption, WithAnAddressAsLongAsTwoLinesIsReadAsWellAsAnyOther) {
  Fonts fonts;
  const std::string words = "The well has never run dry.", address = std::string(150, 'm');
  for (const float size : {1.0f, 1.65f}) {
    const auto height_px = [&](const std::string& text) {
      return LayOutCaption(text, {"en", size, false}, 1280, 720, &fonts).height_px;
    };
    const int one_px = height_px("m"), line_px = height_px("m\nm") - one_px;
    EXPECT_NEAR(height_px(address + " " + words), one_px + 3 * line_px, line_px + 4) << size;
    EXPECT_LE(height_px(std::string(size > 1 ? 33 : 42, 'm')), one_px)
        << "a little too long: in smaller letters, whole";
  }
}

TEST(Caption, TooLongForThePictureComesInPartsWhileItIsRead) {
  Fonts fonts;
  std::string text;
  for (int k = 0; k < 1200; ++k) text += k < 800 ? "... " : "MMM ";
  const auto letters = [&](float passed, CaptionPart* part) {
    const PackImage image = LayOutCaption(text, {"en", 1, false}, 1280, 720, &fonts, passed, part);
    EXPECT_LE(image.height_px, 720 / 2 + 20) << passed;
    return LettersOf(image).second;
  };
  CaptionPart first, last;
  const int dots = letters(0, &first), ems = letters(1, &last);
  EXPECT_GT(first.count, 1);
  EXPECT_EQ(first.index, 0);
  EXPECT_EQ(last, (CaptionPart{first.count - 1, first.count}));
  EXPECT_GT(ems, 3 * dots);
  const PackImage cut = LayOutCaption(text, {"en", 1, false}, 1280, 720, &fonts);
  EXPECT_GT(cut.height_px, 300) << "without a time what fits, in smaller letters";
  CaptionPart whole;
  LayOutCaption("The well has never run dry.", {"en", 1, false}, 1280, 720, &fonts, 0.9f, &whole);
  EXPECT_EQ(whole, CaptionPart{});
}

TEST_F(Drawing, APartOfACaptionGivesWayToTheNextInTime) {
  FrameInput frame = LookEast();
  for (int k = 0; k < 300; ++k) frame.caption += k < 150 ? "... " : "MMM ";
  const TourPack pack = MakePack({});
  Renderer renderer;
  ASSERT_EQ(renderer.Create(pack).message, "");
  frame.caption_passed = 0;
  const std::vector<uint8_t> first = DrawWith(frame, &renderer);
  frame.caption_passed = 0.02f;
  EXPECT_EQ(DrawWith(frame, &renderer), first);
  frame.caption_passed = 1;
  EXPECT_NE(DrawWith(frame, &renderer), first);
}

TEST(Caption, BeginsAtTheRightInArabic) {
  Fonts fonts;
  const std::string text =
      "ساحة السوق. تفتح الأكشاك في الساعة السادسة صباحا، ولم تجف البئر قط منذ أن حفرت في وسط المدينة.\nنعم";
  const PackImage image = LayOutCaption(text, {"ar", 1, false}, 1280, 720, &fonts);
  int left = 0, right = 0;  // of the last line, which is short
  for (int y = image.height_px * 3 / 4; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      const bool letter = image.rgba[static_cast<size_t>(y * image.width_px + x) * 4] > 200;
      (x < image.width_px / 2 ? left : right) += letter;
    }
  }
  EXPECT_EQ(left, 0);
  EXPECT_GT(right, 20);
}

}  // namespace
}  // namespace flaneur
