#include "runtime/pack/tint.h"

#include <gtest/gtest.h>

#include "runtime/base/color_text.h"

namespace flaneur {
namespace {

const Tint kBlue{{0.22f, 0.29f, 0.38f}, 0.15f, {{0.43f, 0.19f, 0.18f}, {0.29f, 0.36f, 0.22f}}};

TEST(Tint, ItsOwnColourIsWhollyDyedAndOthersAreNot) {
  EXPECT_EQ(TintShare(kBlue, kBlue.color), 1);
  EXPECT_EQ(TintShare(kBlue, {0.78f, 0.75f, 0.70f}), 0) << "linen";
  EXPECT_EQ(TintShare(kBlue, {0.80f, 0.60f, 0.50f}), 0) << "skin";
}

TEST(Tint, AFoldIsDyedWithItsCloth) {
  const Vec3 fold = kBlue.color * 0.7f;
  EXPECT_EQ(TintShare(kBlue, fold), 1);
  const Vec3 dyed = Tinted({kBlue}, {1}, kBlue.color), dyed_fold = Tinted({kBlue}, {1}, fold);
  EXPECT_NEAR(dyed.x, 0.43f, 1e-6f);
  EXPECT_NEAR(Length(dyed_fold - dyed * 0.7f), 0, 1e-6f) << "of the same hue, as deep as before";
}

TEST(Tint, OfMaterialsDyesTheirDeepestShadowsToo) {
  Tint bound = kBlue;
  bound.by_material = true;
  const Vec3 crease = kBlue.color * 0.3f;
  EXPECT_LT(TintShare(kBlue, crease), 0.6f) << "as dark as hair may be";
  EXPECT_EQ(TintShare(bound, crease), 1);
  EXPECT_EQ(TintShare(bound, {0.78f, 0.75f, 0.70f}), 0) << "linen sewn to it";
  const Vec3 dyed = Tinted({bound}, {1}, kBlue.color);
  EXPECT_NEAR(Length(Tinted({bound}, {1}, crease) - dyed * 0.3f), 0, 1e-6f);
}

TEST(Tint, ChangesLittleWhereTheColourChangesLittle) {
  Vec3 before = Tinted({kBlue}, {1}, kBlue.color);
  for (int k = 1; k <= 500; ++k) {
    const Vec3 now = Tinted({kBlue}, {1}, kBlue.color + Vec3{0.001f, 0.0005f, -0.0005f} * static_cast<float>(k));
    EXPECT_LT(Length(now - before), 0.02f) << k;
    before = now;
  }
}

TEST(Tint, WhereTwoReachOneColourItIsDyedOnce) {
  Tint second = kBlue;
  second.colors = {{0.9f, 0.9f, 0.9f}};
  const Vec3 both = Tinted({kBlue, second}, {2, 1}, kBlue.color);
  EXPECT_NEAR(both.y, 0.36f, 1e-6f);
}

TEST(Tint, WhoWearsTheOwnColourIsAsInTheFile) {
  const Vec3 color{0.25f, 0.27f, 0.35f}, same = Tinted({kBlue}, {0}, color);
  EXPECT_EQ(same.x, color.x);
  EXPECT_EQ(same.z, color.z);
}

TEST(ColorText, ReadsWhatItWrites) {
  for (const char* text : {"#000000", "#ffffff", "#2f4f8f"})
    EXPECT_EQ(TextFromColor(ColorFromText(text).value()), text);
  for (const char* text : {"", "2f4f8f", "#2f4f8", "#2f4f8g", "#2f4f8f0", "# f4f8f", "#-f4f8f"})
    EXPECT_FALSE(ColorFromText(text)) << text;
}

}  // namespace
}  // namespace flaneur
