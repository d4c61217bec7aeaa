// A visitor's photo: its file, its line, and the code that leads to it.
#include "runtime/visit/photo.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <set>

#include "runtime/base/file.h"
#include "runtime/base/pixels.h"
#include "runtime/base/png.h"

namespace flaneur {
namespace {
namespace fs = std::filesystem;

struct Photos : ::testing::Test {
  fs::path folder = fs::temp_directory_path() / ("flaneur_photo_test_" + std::to_string(::getpid()));
  void TearDown() override { fs::remove_all(folder); }
  Photo Blue() const {
    Photo photo{120, 80, {}};
    for (int k = 0; k < 120 * 80; ++k) photo.rgb.insert(photo.rgb.end(), {30, 60, 200});
    return photo;
  }
};

TEST_F(Photos, AreKeptAsTheyWereSeen) {
  ASSERT_EQ(KeepPhoto(Blue(), folder, "abc", 10).message, "");
  std::vector<uint8_t> bytes;
  ASSERT_FALSE(ReadFile(folder / PhotoFileName("abc"), &bytes));
  const auto picture = Decoded(bytes);
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->width, 120);
  EXPECT_EQ(picture->height, 80);
  EXPECT_NEAR(picture->rgba[2], 200, 8);
}

TEST_F(Photos, TheLineStandsBelowAndHidesNothing) {
  Fonts fonts;
  const Photo plain = Blue(), with = WithLine(Blue(), "Museum", "en", &fonts);
  EXPECT_EQ(WithLine(Blue(), "", "en", &fonts).height_px, plain.height_px);
  ASSERT_GT(with.height_px, plain.height_px);
  ASSERT_EQ(with.rgb.size(), static_cast<size_t>(with.width_px * with.height_px * 3));
  EXPECT_TRUE(std::equal(plain.rgb.begin(), plain.rgb.end(), with.rgb.begin()));
  EXPECT_GT(*std::max_element(with.rgb.begin() + static_cast<std::ptrdiff_t>(plain.rgb.size()), with.rgb.end()), 180)
      << "letters";
}

TEST_F(Photos, NoTwoHaveTheSameNameAndNoneSaysWhenItWasTaken) {
  std::set<std::string> ids;
  for (int k = 0; k < 200; ++k) ids.insert(NewPhotoId());
  EXPECT_EQ(ids.size(), 200u);
  for (const std::string& id : ids)
    EXPECT_EQ(id.find_first_not_of("23456789abcdefghjkmnpqrstuvwxyz"), std::string::npos);
}

TEST_F(Photos, OfTooManyTheEldestGoAndOtherFilesStay) {
  std::vector<std::string> ids;
  for (int k = 0; k < 5; ++k) {
    ids.push_back(NewPhotoId());
    ASSERT_FALSE(KeepPhoto(Blue(), folder, ids.back(), 100));
    fs::last_write_time(folder / PhotoFileName(ids.back()),
                        fs::file_time_type::clock::now() - std::chrono::hours(9 - k));
  }
  ASSERT_FALSE(WriteTextFile(folder / "notes.txt", "ours"));
  ASSERT_FALSE(WriteTextFile(folder / "flaneur-own-name.jpg", "ours"));
  ASSERT_FALSE(KeepPhoto(Blue(), folder, NewPhotoId(), 3));
  for (size_t k = 0; k < ids.size(); ++k) EXPECT_EQ(fs::exists(folder / PhotoFileName(ids[k])), k >= 3) << k;
  EXPECT_TRUE(fs::exists(folder / "notes.txt"));
  EXPECT_TRUE(fs::exists(folder / "flaneur-own-name.jpg"));
}

TEST_F(Photos, WhereNothingCanBeWrittenOneLineSaysSo) {
  ASSERT_FALSE(WriteTextFile(folder, "a file where the folder should be"));
  const Error error = KeepPhoto(Blue(), folder, "abc", 10);
  ASSERT_TRUE(error);
  EXPECT_EQ(error.message.find('\n'), std::string::npos);
  EXPECT_NE(error.message.find(folder.string()), std::string::npos);
}

TEST_F(Photos, TheLinkHoldsFileAndId) {
  EXPECT_EQ(PhotoLink("https://a.example/{file}?i={id}&j={id}", "xyz"),
            "https://a.example/flaneur-xyz.jpg?i=xyz&j=xyz");
}

TEST_F(Photos, TheCodeLeadsToTheLink) {
  if (std::system("command -v zbarimg > /dev/null") != 0) GTEST_SKIP() << "zbar-tools is not there";
  const std::string link = PhotoLink("https://museum.example/photos/{file}", NewPhotoId());
  const auto code = QrOf(link);
  ASSERT_TRUE(code);
  fs::create_directories(folder);
  ASSERT_FALSE(WriteFile(folder / "code.png", EncodePng(code->side_px, code->side_px, 4, code->rgba)));
  const std::string read = "zbarimg -q --raw " + (folder / "code.png").string() + " > " + (folder / "read").string();
  ASSERT_EQ(std::system(read.c_str()), 0);
  std::string text;
  ASSERT_FALSE(ReadTextFile(folder / "read", &text));
  EXPECT_EQ(text, link + "\n");
  EXPECT_FALSE(QrOf(std::string(9000, 'x')));
}

}  // namespace
}  // namespace flaneur
