#include "pipeline/cli/check_words.h"

#include <gtest/gtest.h>

#include "runtime/text/system_fonts.h"

namespace flaneur {
namespace {

bool Says(const std::vector<std::string>& warnings, const std::string& text) {
  for (const std::string& w : warnings) {
    if (w.find(text) != std::string::npos) return true;
  }
  return false;
}

TourData Tour() {
  TourData tour;
  tour.language = "de";
  tour.titles = {{"de", "Wolfenbüttel"}, {"ar", "فولفنبوتل"}};
  TourStop stop;
  stop.caption = "Der Markt – „hier“.";
  stop.captions = {{"he", "השוק, 1584"}, {"el", "Η αγορά"}};
  tour.path = {stop, stop};
  return tour;
}

TEST(CheckWords, HasNothingToSayOfScriptsThatThePlayerBringsAlong) {
  Fonts fonts;
  EXPECT_EQ(WarningsOfWords(Tour(), &fonts), std::vector<std::string>{});
}

TEST(CheckWords, NamesLettersThatNoFontShowsAndWhereTheyStand) {
  TourData tour = Tour();
  tour.path[1].captions["ja"] = "市場";
  Fonts fonts;
  const auto warnings = WarningsOfWords(tour, &fonts);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(Says(warnings, "'ja'")) << warnings[0];
  EXPECT_TRUE(Says(warnings, "(stop 2)")) << warnings[0];
  EXPECT_TRUE(Says(warnings, "場")) << warnings[0];
  EXPECT_TRUE(Says(warnings, "boxes")) << warnings[0];
}

TEST(CheckWords, SpeaksOfALanguageOnceAndOfAllThatVisitorsRead) {
  TourData tour = Tour();
  tour.titles["ja"] = "市場";
  for (TourStop& stop : tour.path) stop.captions["ja"] = "市場";
  tour.hotspots.resize(1);
  tour.hotspots[0].titles["ko"] = "시장";
  tour.streets = {{{{"zh", "市"}}, {}}};
  tour.thanks["th"] = "ตลาด";
  tour.photo.lines["hi"] = "बाज़ार";
  Fonts fonts;
  const auto warnings = WarningsOfWords(tour, &fonts);
  ASSERT_EQ(warnings.size(), 5u);
  EXPECT_TRUE(Says(warnings, "(the title, stop 1, stop 2)"));
  EXPECT_TRUE(Says(warnings, "(hotspot 1)"));
  EXPECT_TRUE(Says(warnings, "(a street's name)"));
  EXPECT_TRUE(Says(warnings, "(the thanks)"));
  EXPECT_TRUE(Says(warnings, "(the photo's line)"));
}

TEST(CheckWords, NamesTheFontThatMustBeThereWhereTheTourIsPlayed) {
  TourData tour = Tour();
  tour.path[1].captions["ja"] = "市場";
  Fonts fonts(SystemFonts());
  const int font = fonts.FontFor(U'市', "ja");
  if (font < 0) GTEST_SKIP() << "no font on this machine shows 市; fonts-droid-fallback has it";
  const auto warnings = WarningsOfWords(tour, &fonts);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(Says(warnings, fonts.NameOf(font))) << warnings[0];
  EXPECT_FALSE(Says(warnings, "boxes")) << warnings[0];
}

TEST(CheckWords, NamesSoundsThatNobodyCanRead) {
  TourData tour = Tour();
  tour.path[0].sounds["de"] = {};
  tour.path[1].sounds["he"] = {};
  Fonts fonts;
  EXPECT_TRUE(WarningsOfWords(tour, &fonts).empty());
  tour.path[1].sounds["fr"] = {};
  const auto warnings = WarningsOfWords(tour, &fonts);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(Says(warnings, "stop 2 has a sound (fr) without a caption")) << warnings[0];
}

}  // namespace
}  // namespace flaneur
