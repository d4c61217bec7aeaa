#include "runtime/base/pixels.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "runtime/base/png.h"

namespace flaneur {
namespace {

using Bytes = std::vector<uint8_t>;

Bytes SmallJpeg() {
  std::vector<uint8_t> rgb(3 * 16 * 16);
  for (size_t i = 0; i < rgb.size(); ++i) rgb[i] = static_cast<uint8_t>(i * 5);
  return EncodeJpeg(16, 16, 90, rgb);
}

// A table that no scan uses, with as many codes of 16 bits as asked for, and values beside.
Bytes WithTable(int codes, size_t values, size_t before_end) {
  const Bytes jpeg = SmallJpeg();
  Bytes table{0xFF, 0xC4, 0, 0, 0x13};
  table.insert(table.end(), 15, 0);
  table.push_back(static_cast<uint8_t>(std::min(codes, 255)));
  if (codes > 255) table[19] = static_cast<uint8_t>(codes - 255);  // of 15 bits
  table.insert(table.end(), values, 7);
  table[2] = static_cast<uint8_t>((table.size() - 2) >> 8), table[3] = static_cast<uint8_t>(table.size() - 2);
  Bytes all(jpeg.begin(), before_end == 0 ? jpeg.begin() + 2 : jpeg.end() - static_cast<std::ptrdiff_t>(before_end));
  const size_t at = all.size();
  all.insert(all.end(), table.begin(), table.end());
  all.insert(all.end(), jpeg.begin() + static_cast<std::ptrdiff_t>(at), jpeg.end());
  return all;
}

TEST(Pixels, ReadsAJpegWithATableThatIsFull) {
  ASSERT_TRUE(Decoded(SmallJpeg()));
  EXPECT_TRUE(Decoded(WithTable(200, 200, 0)));
  EXPECT_TRUE(DecodedSize(WithTable(200, 200, 0)));
}

// Their reader would write beyond its own tables.
TEST(Pixels, RefusesAJpegWithATableOfTooManyCodes) {
  for (const size_t before_end : {size_t{0}, size_t{2}}) {
    EXPECT_FALSE(Decoded(WithTable(300, 300, before_end))) << before_end;
    EXPECT_FALSE(Decoded(WithTable(300, 0, before_end))) << before_end;
  }
  EXPECT_FALSE(DecodedSize(WithTable(300, 300, 0)));
  Bytes filled = WithTable(300, 300, 0);
  filled.insert(filled.begin(), 0xFF);  // markers may be filled up
  EXPECT_FALSE(Decoded(filled));
}

TEST(Pixels, WhatIsCutAnywhereEndsWell) {
  const Bytes whole = WithTable(200, 200, 0);
  for (size_t size = 0; size < whole.size(); ++size) Decoded(std::span(whole).first(size));
  SUCCEED();
}

}  // namespace
}  // namespace flaneur
