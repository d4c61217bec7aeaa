#include "runtime/pack/meshopt_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "pipeline/io/meshopt_codec.h"
#include "runtime/pack/gltf_file.h"

namespace flaneur {
namespace {

// Elements that change slowly, quickly and not at all, byte by byte.
std::vector<uint8_t> Elements(size_t count, size_t stride) {
  std::mt19937 random(static_cast<unsigned>(count * 7 + stride));
  std::vector<uint8_t> out(count * stride);
  for (size_t i = 0; i < out.size(); ++i) {
    const size_t lane = i % stride % 4, before = i >= stride ? out[i - stride] : 0;
    const auto any = static_cast<uint8_t>(random());
    out[i] = static_cast<uint8_t>(lane == 0   ? any
                                  : lane == 1 ? before + any % 3
                                  : lane == 2 ? before + any % 20 / 2
                                              : before);
  }
  return out;
}

TEST(MeshoptView, ReadsWhatTheLibraryWrites) {
  for (const size_t stride : {4, 8, 12, 64, 256}) {
    for (const size_t count : {1, 15, 16, 17, 255, 256, 257, 1000}) {
      const std::vector<uint8_t> wanted = Elements(count, stride);
      EXPECT_EQ(DecodeMeshoptView(EncodeMeshopt(wanted, stride), count, stride, "NONE"), wanted)
          << count << ' ' << stride;
    }
  }
}

TEST(MeshoptView, TurnsRoundedRotationsBack) {
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  std::vector<uint8_t> bytes;
  std::vector<Vec4> wanted;
  for (int i = 0; i < 300; ++i) {
    Vec4 q{normal(random), normal(random), normal(random), normal(random)};
    q = q * (1 / std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w));
    const auto rounded = FilteredRotation(q, 6 + i % 11);
    const auto* first = reinterpret_cast<const uint8_t*>(rounded.data());
    bytes.insert(bytes.end(), first, first + sizeof rounded);
    wanted.push_back(Unfiltered(rounded));
  }
  const auto read = DecodeMeshoptView(EncodeMeshopt(bytes, 8), wanted.size(), 8, "QUATERNION");
  for (size_t i = 0; i < wanted.size(); ++i) {
    int16_t q[4];
    std::memcpy(q, read.data() + 8 * i, sizeof q);
    for (size_t c = 0; c < 4; ++c) EXPECT_NEAR(static_cast<float>(q[c]) / 32767, (&wanted[i].x)[c], 1.01f / 32767);
  }
}

TEST(MeshoptView, TurnsRoundedNumbersBack) {
  std::vector<uint8_t> bytes;
  std::vector<float> wanted;
  for (int i = -100; i < 100; ++i) {
    const uint32_t rounded = FilteredNumber(0.0137f * static_cast<float>(i), -4 - (i & 7));
    const auto* first = reinterpret_cast<const uint8_t*>(&rounded);
    bytes.insert(bytes.end(), first, first + sizeof rounded);
    wanted.push_back(Unfiltered(rounded));
    EXPECT_NEAR(wanted.back(), 0.0137f * static_cast<float>(i), std::ldexp(0.5f, -4 - (i & 7)) + 1e-6f);
  }
  const auto read = DecodeMeshoptView(EncodeMeshopt(bytes, 4), wanted.size(), 4, "EXPONENTIAL");
  ASSERT_EQ(read.size(), wanted.size() * sizeof(float));
  EXPECT_EQ(std::memcmp(read.data(), wanted.data(), read.size()), 0);
}

TEST(MeshoptView, RefusesBrokenInput) {
  const std::vector<uint8_t> whole = EncodeMeshopt(Elements(300, 8), 8);
  for (size_t size = 0; size < whole.size(); ++size) {
    EXPECT_THROW(DecodeMeshoptView(std::span(whole).first(size), 300, 8, "NONE"), PackRefused) << size;
  }
  EXPECT_THROW(DecodeMeshoptView(whole, 100, 8, "NONE"), PackRefused);
  EXPECT_THROW(DecodeMeshoptView(whole, size_t{1} << 60, 8, "NONE"), PackRefused);
  EXPECT_THROW(DecodeMeshoptView(whole, 300, 0, "NONE"), PackRefused);
  EXPECT_THROW(DecodeMeshoptView(whole, 300, 7, "NONE"), PackRefused);
  EXPECT_THROW(DecodeMeshoptView(whole, 300, 8, "OCTAHEDRAL"), PackRefused);
  EXPECT_THROW(DecodeMeshoptView(EncodeMeshopt(Elements(300, 4), 4), 300, 4, "QUATERNION"), PackRefused);
}

}  // namespace
}  // namespace flaneur
