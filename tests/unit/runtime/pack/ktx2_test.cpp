// KTX2 files: what is written is read again, packed or not, and nothing that is damaged gets through.
#include "runtime/pack/ktx2.h"

#include <gtest/gtest.h>

#include "runtime/base/random.h"

namespace flaneur {
namespace {

// Of 64 x 48 pixels with three levels, half of it noise.
PackTexture Picture(TextureFormat format) {
  Random random{7};
  PackTexture texture{format, 64, 48, {}};
  for (int k = 0; k < 3; ++k) {
    std::vector<uint8_t>& level = texture.levels.emplace_back(LevelBytes(format, 64 >> k, 48 >> k), uint8_t{17});
    for (size_t i = 0; i < level.size() / 2; ++i) level[i] = static_cast<uint8_t>(random.Below(256));
  }
  return texture;
}

TEST(Ktx2, WhatIsWrittenIsReadAgain) {
  for (const TextureFormat format :
       {TextureFormat::kBc4, TextureFormat::kBc5, TextureFormat::kBc7, TextureFormat::kBc7Srgb}) {
    const PackTexture before = Picture(format);
    size_t plain = 0;
    for (const Supercompression packed : {Supercompression::kNone, Supercompression::kZstandard}) {
      const std::vector<uint8_t> file = WriteKtx2(before, packed);
      PackTexture after;
      ASSERT_EQ(ReadKtx2(file, &after).message, "");
      EXPECT_EQ(after.format, format);
      EXPECT_EQ(after.width_px, 64);
      EXPECT_EQ(after.height_px, 48);
      EXPECT_EQ(after.levels, before.levels);
      EXPECT_EQ(Ktx2BytesInMemory(file), TextureBytes(before));
      if (packed == Supercompression::kNone) plain = file.size();
    }
    EXPECT_LT(WriteKtx2(before, Supercompression::kZstandard).size(), plain * 3 / 4);
  }
}

TEST(Ktx2, NothingDamagedOrCutIsRead) {
  const std::vector<uint8_t> file = WriteKtx2(Picture(TextureFormat::kBc7), Supercompression::kZstandard);
  PackTexture texture;
  for (size_t size = 0; size < file.size(); size += 7)
    EXPECT_TRUE(ReadKtx2(std::span(file).first(size), &texture)) << size;
  Random random{3};
  int read = 0;
  for (int k = 0; k < 2000; ++k) {
    std::vector<uint8_t> spoilt = file;
    spoilt[static_cast<size_t>(random.Below(static_cast<int>(file.size())))] ^=
        static_cast<uint8_t>(1 + random.Below(255));
    if (ReadKtx2(spoilt, &texture)) continue;
    ++read;  // a texel of another value, or what nobody asks for
    for (size_t level = 0; level < texture.levels.size(); ++level)
      ASSERT_EQ(texture.levels[level].size(), LevelBytes(texture.format, std::max(1, texture.width_px >> level),
                                                         std::max(1, texture.height_px >> level)));
  }
  EXPECT_LT(read, 2000);
}

TEST(Ktx2, ALevelThatSaysItIsLargerThanItIsIsRefused) {
  std::vector<uint8_t> file = WriteKtx2(Picture(TextureFormat::kBc7), Supercompression::kZstandard);
  constexpr size_t kUncompressedBytesOfFirst = 80 + 16;
  file[kUncompressedBytesOfFirst] ^= 16;
  PackTexture texture;
  EXPECT_EQ(ReadKtx2(file, &texture).message, "is a KTX2 picture with a level of the wrong length");
}

TEST(Ktx2, APictureOfManyPixelsInFewBytesIsCountedByItsPixels) {
  PackTexture texture{
      TextureFormat::kBc7, 4096, 4096, {std::vector<uint8_t>(LevelBytes(TextureFormat::kBc7, 4096, 4096))}};
  const std::vector<uint8_t> file = WriteKtx2(texture, Supercompression::kZstandard);
  EXPECT_LT(file.size(), 10000u);
  EXPECT_EQ(Ktx2BytesInMemory(file), uint64_t{4096} * 4096);
}

}  // namespace
}  // namespace flaneur
