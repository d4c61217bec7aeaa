// Lines of text as a reader of each script expects them.
#include "runtime/text/layout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "runtime/text/system_fonts.h"
#include "runtime/text/unicode.h"

namespace flaneur {
namespace {

constexpr float kWide_px = 10000;

TextStyle In(const std::string& language) { return {.letter_px = 40, .language = language}; }

// Where each letter that begins a glyph stands, from left to right.
std::string FromLeftToRight(const std::string& text, const std::string& language, Fonts* fonts) {
  const TextLayout layout = LayOutText(text, kWide_px, In(language), fonts);
  const std::u32string letters = CodePoints(text);
  std::multimap<float, char32_t> places;
  for (const PlacedGlyph& g : layout.glyphs) places.insert({g.pen_px.x, letters[g.letter]});
  std::u32string seen;
  for (const auto& [x, letter] : places) seen.push_back(letter);
  return Utf8(seen);
}

TEST(Text, ReadsHebrewFromRightToLeftAndNumbersInItFromLeftToRight) {
  Fonts fonts;
  EXPECT_EQ(FromLeftToRight("abc", "en", &fonts), "abc");
  EXPECT_EQ(FromLeftToRight("שלום", "he", &fonts), "םולש");
  EXPECT_EQ(FromLeftToRight("בשנת 1584 נבנה", "he", &fonts), "הנבנ 1584 תנשב");
  EXPECT_EQ(FromLeftToRight("Tor שלום 12", "en", &fonts), "Tor 12 םולש");
  EXPECT_EQ(FromLeftToRight("Tor שלום 12", "he", &fonts), "12 םולש Tor") << "the text's language leads";
  const auto first = [&](const char* text) {
    return LayOutText(text, kWide_px, In("he"), &fonts).glyphs.front().glyph;
  };
  EXPECT_EQ(first("(שלום)"), first("(a)")) << "brackets turn round with what they hold";
}

TEST(Text, JoinsArabicLetters) {
  Fonts fonts;
  const auto glyphs = [&](const std::string& text) {
    std::vector<uint32_t> all;
    for (const PlacedGlyph& g : LayOutText(text, kWide_px, In("ar"), &fonts).glyphs) all.push_back(g.glyph);
    return all;
  };
  const std::vector<uint32_t> alone = glyphs("ب"), word = glyphs("ببب");
  ASSERT_EQ(word.size(), 3u);
  EXPECT_EQ(std::set<uint32_t>(word.begin(), word.end()).size(), 3u) << "final, medial, initial";
  EXPECT_EQ(std::count(word.begin(), word.end(), alone.front()), 0);
  EXPECT_EQ(glyphs("لا").size(), 1u) << "lam and alef are one sign";
}

TEST(Text, StandsAtTheSideWhereItBegins) {
  Fonts fonts;
  const TextLayout english = LayOutText("One", 1000, In("en"), &fonts);
  const TextLayout arabic = LayOutText("ساحة السوق", 1000, In("ar"), &fonts);
  EXPECT_FALSE(english.right_to_left);
  EXPECT_TRUE(arabic.right_to_left);
  EXPECT_FLOAT_EQ(english.lines[0].left_px, 0);
  EXPECT_NEAR(arabic.lines[0].left_px + arabic.lines[0].width_px, 1000, 0.01f);
}

TEST(Text, BreaksRightToLeftLinesInReadingOrder) {
  Fonts fonts;
  const std::string text = "بني هذا البيت سنة 1584 وسكنه التجار";
  const float whole_px = LayOutText(text, kWide_px, In("ar"), &fonts).width_px;
  const TextLayout layout = LayOutText(text, whole_px * 0.55f, In("ar"), &fonts);
  ASSERT_EQ(layout.lines.size(), 2u);
  size_t most_in_first = 0, least_in_second = 1000;
  for (size_t k = 0; k < layout.glyphs.size(); ++k) {
    const size_t letter = layout.glyphs[k].letter;
    if (k < layout.lines[1].first_glyph) most_in_first = std::max(most_in_first, letter);
    else least_in_second = std::min(least_in_second, letter);
  }
  EXPECT_LT(most_in_first, least_in_second) << "what is said first stands in the first line";
  for (const TextLine& line : layout.lines) EXPECT_NEAR(line.left_px + line.width_px, whole_px * 0.55f, 0.01f);
}

TEST(Text, KeepsEveryLineWithinItsWidthInEveryScript) {
  Fonts fonts(SystemFonts());
  const std::pair<const char*, const char*> texts[] = {
      {"de", "Die Stände öffnen um sechs; der Brunnen ist nie versiegt, sagt man seit jeher."},
      {"fr", "Les étals ouvrent à six heures\u202f; le puits n’a jamais tari\u00a0: voilà ce qu’on dit."},
      {"he", "הדוכנים נפתחים בשש (6:00); הבאר מעולם לא יבשה."},
      {"ar", "تفتح الأكشاك في الساعة 6؛ لم تجف البئر قط (Brunnen)."},
      {"ja", "市場の屋台は六時に開き、井戸は一度も涸れたことがないと言われています。"},
      {"th", "แผงลอยเปิดเวลาหกโมงและบ่อน้ำไม่เคยแห้งเลยตามที่ผู้คนเล่าขานกันมา"},
      {"hi", "दुकानें छह बजे खुलती हैं और कुआँ कभी नहीं सूखा, ऐसा लोग कहते हैं।"}};
  for (const auto& [language, text] : texts) {
    for (const float width_px : {400.0f, 250.0f}) {
      const TextLayout layout = LayOutText(text, width_px, In(language), &fonts);
      EXPECT_GT(layout.lines.size(), 1u) << language;
      EXPECT_FALSE(layout.broken_words) << language;
      for (const TextLine& line : layout.lines) {
        EXPECT_LE(line.width_px, width_px + 0.01f) << language;
        EXPECT_GE(line.left_px, -0.01f) << language;
      }
    }
  }
}

TEST(Text, NeverBeginsAJapaneseLineWithAFullStop) {
  Fonts fonts(SystemFonts());
  const std::string text = "屋台。屋台。屋台。屋台。屋台。屋台。";
  const std::u32string letters = CodePoints(text);
  for (float width_px = 110; width_px < 300; width_px += 7) {
    const TextLayout layout = LayOutText(text, width_px, In("ja"), &fonts);
    for (const TextLine& line : layout.lines) {
      if (line.glyphs == 0) continue;
      EXPECT_NE(letters[layout.glyphs[line.first_glyph].letter], U'。') << width_px;
    }
  }
}

TEST(Text, IsCutWithAnEllipsisWhereLinesAreMissing) {
  Fonts fonts;
  TextStyle style = In("en");
  style.most_lines = 2;
  const std::string text = "The market square. The stalls open at six; the well has never run dry, so they say.";
  const TextLayout cut = LayOutText(text, 300, style, &fonts);
  EXPECT_TRUE(cut.cut);
  EXPECT_EQ(cut.lines.size(), 2u);
  const TextLayout whole = LayOutText(text, 3000, style, &fonts);
  EXPECT_FALSE(whole.cut);
}

TEST(Text, SaysWhichWordsWereWiderThanTheLine) {
  Fonts fonts;
  EXPECT_TRUE(LayOutText("Donaudampfschifffahrt", 100, In("de"), &fonts).broken_words);
  EXPECT_FALSE(LayOutText("Donau\u00ADdampf\u00ADschiff\u00ADfahrt", 150, In("de"), &fonts).broken_words);
}

TEST(Text, ShowsASoftHyphenAtALinesEndAlone) {
  Fonts fonts;
  const size_t whole = LayOutText("Donau\u00ADfahrt", kWide_px, In("de"), &fonts).lines.size();
  EXPECT_EQ(whole, 1u);
  const TextLayout broken = LayOutText("Donau\u00ADfahrt", 140, In("de"), &fonts);
  ASSERT_EQ(broken.lines.size(), 2u);
  const TextLayout hyphen = LayOutText("Donau-", kWide_px, In("de"), &fonts);
  EXPECT_NEAR(broken.lines[0].width_px, hyphen.lines[0].width_px, 0.5f);
}

TEST(Text, BeginsAParagraphAtEachLineBreak) {
  Fonts fonts;
  const TextLayout layout = LayOutText("One\nשלום\n\nThree", 500, In(""), &fonts);
  ASSERT_EQ(layout.lines.size(), 4u);
  EXPECT_FLOAT_EQ(layout.lines[0].left_px, 0);
  EXPECT_GT(layout.lines[1].left_px, 100) << "each in its own direction";
  EXPECT_EQ(layout.lines[2].glyphs, 0u);
}

TEST(Text, TakesAnyBytes) {
  Fonts fonts;
  uint32_t random = 1;
  for (int round = 0; round < 300; ++round) {
    std::string bytes;
    for (int k = 0; k < 40; ++k) {
      random = random * 1664525 + 1013904223;
      bytes.push_back(static_cast<char>(round % 2 == 0 ? random >> 24 : 0xD0 + (random >> 28)));
    }
    const TextLayout layout = LayOutText(bytes, 200, In(round % 3 == 0 ? "ar" : "xx-;"), &fonts);
    EXPECT_GE(layout.lines.size(), 1u);
  }
  EXPECT_EQ(Utf8(CodePoints("aü€𝄞")), "aü€𝄞");
  EXPECT_EQ(CodePoints("\xC0\x80")[0], U'\xFFFD') << "an overlong form is no letter";
}

TEST(Text, NamesLettersThatNoFontShows) {
  Fonts fonts;
  LayOutText("Tor 門 and 門", 500, In("en"), &fonts);
  EXPECT_EQ(fonts.TakeMissing(), U"門");
  EXPECT_EQ(fonts.TakeMissing(), U"");
  LayOutText("Das Tor, la porte, Η πύλη, Ворота, الباب, השער \u202b\u200d", 500, In("en"), &fonts);
  EXPECT_EQ(fonts.TakeMissing(), U"") << "the font that comes along has these";
}

TEST(Text, FindsLettersInTheMachinesFonts) {
  Fonts fonts(SystemFonts());
  const int font = fonts.FontFor(U'門', "ja");
  if (font < 0) GTEST_SKIP() << "no font on this machine shows 門; fonts-droid-fallback has it";
  EXPECT_GT(font, 0);
  EXPECT_NE(fonts.NameOf(font), "");
  const TextLayout layout = LayOutText("Tor 門", 500, In("ja"), &fonts);
  bool seen = false;
  for (const PlacedGlyph& g : layout.glyphs) {
    if (g.font != font) continue;
    const GlyphPicture picture = fonts.Draw(g.font, g.glyph, layout.em_px);
    seen = seen || std::count_if(picture.cover.begin(), picture.cover.end(), [](uint8_t c) { return c > 128; }) > 50;
  }
  EXPECT_TRUE(seen);
}

}  // namespace
}  // namespace flaneur
