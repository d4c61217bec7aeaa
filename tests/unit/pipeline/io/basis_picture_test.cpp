#include "pipeline/io/basis_picture.h"

#include <gtest/gtest.h>

#include <random>

#include "runtime/base/file.h"
#include "runtime/base/limits.h"

namespace flaneur {
namespace {

std::vector<uint8_t> Bytes(const std::string& name) {
  std::vector<uint8_t> bytes;
  const Error error = ReadFile(std::filesystem::path(FLANEUR_SOURCE_DIR "/tests/data/basis") / name, &bytes);
  EXPECT_EQ(error.message, "");
  return bytes;
}

std::string Refusal(const std::vector<uint8_t>& bytes, uint64_t most_pixels = kFreePixels) {
  Pixels pixels;
  return DecodeBasisPicture(bytes, most_pixels, &pixels).message;
}

void Put(size_t at, uint32_t value, std::vector<uint8_t>* bytes) {
  for (size_t i = 0; i < 4; ++i) (*bytes)[at + i] = static_cast<uint8_t>(value >> (8 * i));
}

class BasisPicture : public testing::TestWithParam<const char*> {};

// Beside each stands what Basis Universal's own transcoder makes of it.
TEST_P(BasisPicture, IsWhatTheReferenceMakesOfIt) {
  const std::string name = GetParam();
  const std::optional<Pixels> expected = Decoded(Bytes(name + ".png"));
  Pixels pixels;
  ASSERT_EQ(DecodeBasisPicture(Bytes(name + ".ktx2"), kFreePixels, &pixels).message, "");
  EXPECT_EQ(pixels.width, expected->width);
  EXPECT_EQ(pixels.height, expected->height);
  EXPECT_EQ(pixels.rgba, expected->rgba);
}

TEST_P(BasisPicture, IsRefusedWhereItIsCutShort) {
  const std::vector<uint8_t> whole = Bytes(std::string(GetParam()) + ".ktx2");
  for (size_t length = 0; length < whole.size(); ++length) {
    const std::string message = Refusal({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length)});
    // Coarser levels stand before the finest, tables after nothing: what is cut is always of the picture.
    EXPECT_NE(message, "") << length << " of " << whole.size() << " bytes";
  }
}

TEST_P(BasisPicture, StaysSoundWhateverItsBytesAre) {
  const std::vector<uint8_t> whole = Bytes(std::string(GetParam()) + ".ktx2");
  std::mt19937 random(7);
  for (int i = 0; i < 3000; ++i) {
    std::vector<uint8_t> changed = whole;
    for (int k = 0; k < 1 + i % 4; ++k) changed[random() % changed.size()] = static_cast<uint8_t>(random());
    Pixels pixels;
    if (DecodeBasisPicture(changed, 65536, &pixels)) continue;
    EXPECT_EQ(pixels.rgba.size(), 4 * static_cast<size_t>(pixels.width) * static_cast<size_t>(pixels.height));
  }
}

INSTANTIATE_TEST_SUITE_P(Files, BasisPicture,
                         testing::Values("etc1s", "etc1s_alpha", "uastc", "uastc_zstd_alpha", "uastc_all_modes"),
                         [](const auto& file) { return std::string(file.param); });

constexpr size_t kWidthAt = 20, kHeightAt = 24, kDepthAt = 28, kFacesAt = 36, kSchemeAt = 44;

TEST(BasisPictures, OfOtherSizesThanTheirDataAreRefused) {
  for (const char* name : {"etc1s.ktx2", "uastc.ktx2", "uastc_zstd_alpha.ktx2"}) {
    for (const uint32_t width : {0u, 26u, 5000u, 20000u, 0xFFFFFFFFu}) {
      std::vector<uint8_t> bytes = Bytes(name);
      Put(kWidthAt, width, &bytes);
      EXPECT_NE(Refusal(bytes), "") << name << ", " << width;
    }
  }
}

TEST(BasisPictures, AskForNoMoreThanTheyMay) {
  std::vector<uint8_t> bytes = Bytes("etc1s.ktx2");
  Put(kWidthAt, 16384, &bytes);
  Put(kHeightAt, 16384, &bytes);
  EXPECT_EQ(Refusal(bytes), "asks for 268435456 pixels, far more than its size is worth");
}

TEST(BasisPictures, OfOtherKindsAreRefused) {
  for (const auto& [at, value] : {std::pair{kDepthAt, 4u}, {kFacesAt, 6u}, {kSchemeAt, 3u}}) {
    std::vector<uint8_t> bytes = Bytes("uastc.ktx2");
    Put(at, value, &bytes);
    EXPECT_TRUE(Refusal(bytes).starts_with("is a KTX2 picture")) << at;
  }
  std::vector<uint8_t> bytes = Bytes("uastc.ktx2");
  bytes[bytes[48] + 12u] = 134;  // BC7
  EXPECT_EQ(Refusal(bytes),
            "is a KTX2 picture in another code than ETC1S or UASTC; export it as Basis Universal, PNG or JPEG");
}

}  // namespace
}  // namespace flaneur
