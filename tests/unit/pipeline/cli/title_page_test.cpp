#include "pipeline/cli/title_page.h"

#include <gtest/gtest.h>

#include "pipeline/core/temporary_folder.h"
#include "runtime/base/file.h"
#include "runtime/base/pixels.h"
#include "runtime/base/png.h"

namespace flaneur {
namespace {

TEST(TitlePage, PicturesOfAnySizeFitAPack) {
  TemporaryFolder folder;
  ASSERT_FALSE(folder.Create("flaneur_test_"));
  const auto wide = folder.path() / "wide.png", logo = folder.path() / "logo.png";
  ASSERT_FALSE(WritePng(wide, 3000, 1000, std::vector<uint8_t>(3 * 3000 * 1000, 90)));
  std::vector<uint8_t> glass;
  for (int k = 0; k < 100 * 900; ++k) glass.insert(glass.end(), {255, 0, 0, 64});
  ASSERT_FALSE(WriteFile(logo, EncodePng(100, 900, 4, glass)));
  TitlePage page;
  ASSERT_EQ(MakeTitlePage({wide, logo, {0, 0, 1}}, &page).message, "");
  const auto picture = Decoded(page.picture), small = Decoded(page.logo);
  ASSERT_TRUE(picture && small);
  EXPECT_EQ(picture->width, kMaxTitlePicture_px);
  EXPECT_EQ(picture->height, kMaxTitlePicture_px / 3);
  EXPECT_NEAR(picture->rgba[0], 90, 2);
  EXPECT_EQ(small->height, kMaxTitleLogo_px);
  EXPECT_NEAR(small->rgba[0], 255, 2);
  EXPECT_NEAR(small->rgba[3], 64, 2) << "it stays translucent";
  EXPECT_EQ(page.background.z, 1);
}

TEST(TitlePage, WhatIsNoPictureIsNamed) {
  TemporaryFolder folder;
  ASSERT_FALSE(folder.Create("flaneur_test_"));
  const auto text = folder.path() / "words.jpg";
  ASSERT_FALSE(WriteTextFile(text, "no picture"));
  TitlePage page;
  const std::string message = MakeTitlePage({text, {}, {}}, &page).message;
  EXPECT_EQ(message.rfind(text.string(), 0), 0u) << message;
}

}  // namespace
}  // namespace flaneur
