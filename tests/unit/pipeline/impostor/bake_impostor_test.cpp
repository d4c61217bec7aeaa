#include "pipeline/impostor/bake_impostor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "pipeline/core/temporary_folder.h"
#include "pipeline/impostor/atlas_image.h"
#include "pipeline/impostor/atlas_layers.h"
#include "pipeline/impostor/block_compression.h"
#include "pipeline/impostor/compress_atlas.h"
#include "pipeline/impostor/view_geometry.h"
#include "pipeline/pictures/picture_files.h"
#include "runtime/base/file.h"
#include "runtime/pack/ktx2.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;

struct Rgb {
  int r, g, b;
};

// Faces of the box towards +Z, +X, -Z, -X: what directions 0 to 3 of 4 see.
constexpr Rgb kFaces[4] = {{200, 100, 50}, {10, 128, 255}, {77, 3, 166}, {255, 255, 0}};
constexpr Rgb kSign{180, 90, 30};
constexpr Vec3 kHalf{0.3f, 0.9f, 0.2f};
constexpr float kSignZ = 0.25f;

float Linear(int srgb) {
  const float value = static_cast<float>(srgb) / 255;
  return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

// A rectangle that faces `azimuth` anticlockwise from +Z, its centre `out` before the axis.
void AddWall(float azimuth, float out, float half_width, float bottom, float top, Rgb color, Mesh* mesh) {
  const Vec3 normal{std::sin(azimuth), 0, std::cos(azimuth)};
  const Vec3 right{normal.z, 0, -normal.x};
  const auto first = static_cast<uint32_t>(mesh->positions.size());
  for (int corner = 0; corner < 4; ++corner) {
    const float u = corner == 1 || corner == 2 ? 1.0f : 0.0f, v = corner < 2 ? 0.0f : 1.0f;
    const Vec3 base = normal * out + right * (half_width * (2 * u - 1));
    mesh->positions.push_back({base.x, bottom + (top - bottom) * v, base.z});
    mesh->normals.push_back(normal);
    mesh->uvs.push_back({u, 1 - v});
    mesh->colors.push_back({Linear(color.r), Linear(color.g), Linear(color.b), 1});
  }
  for (uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) mesh->indices.push_back(first + i);
}

// Left half of the sign's colour, right half a hole.
Image SignTexture() {
  Pixels pixels;
  pixels.width = pixels.height = 32;
  for (int i = 0; i < 32 * 32; ++i) {
    const uint8_t alpha = i % 32 < 16 ? 255 : 0;
    pixels.rgba.insert(pixels.rgba.end(), {uint8_t{kSign.r}, uint8_t{kSign.g}, uint8_t{kSign.b}, alpha});
  }
  Image image;
  EXPECT_FALSE(EncodePng(pixels, true, &image));
  return image;
}

// A box without lid or floor, and before its front a textured sign with a hole. The only clip
// stands still.
Avatar BoxAvatar() {
  Avatar avatar;
  avatar.name = "box";
  avatar.meshes.resize(2);
  const float outs[4] = {kHalf.z, kHalf.x, kHalf.z, kHalf.x};
  for (int face = 0; face < 4; ++face) {
    AddWall(kPi / 2 * static_cast<float>(face), outs[face], outs[(face + 1) % 4], 0, 2 * kHalf.y, kFaces[face],
            &avatar.meshes[0]);
  }
  AddWall(0, kSignZ, 0.25f, 0.5f, 1.5f, {255, 255, 255}, &avatar.meshes[1]);
  avatar.meshes[1].colors.clear();
  avatar.meshes[1].material = 0;
  avatar.materials.resize(1);
  avatar.materials[0].base_color_image = 0;
  avatar.materials[0].alpha = Material::Alpha::kMask;
  avatar.images = {SignTexture()};
  avatar.clips = {{"walk", 1.0f, 1, {}}};
  return avatar;
}

ImpostorOptions SmallOptions() {
  ImpostorOptions options;
  options.directions = 4;
  options.elevations_deg = {0};
  options.clips = {{"walk", 1}, {"talk", 2}};
  options.height_px = 48;
  options.samples = 4;
  return options;
}

const uint8_t* Texel(const Pixels& pixels, int x, int y) {
  return &pixels.rgba[4 * static_cast<size_t>(y * pixels.width + x)];
}

// One bake for all tests that look at it.
class BoxImpostor : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    error_ = BakeImpostor(BoxAvatar(), SmallOptions(), &atlas_, &statistics_, &warnings_);
    albedo_ = Decoded(atlas_.albedo.bytes).value();
    normal_ = Decoded(atlas_.normal.bytes).value();
  }
  void SetUp() override {
    ASSERT_FALSE(error_) << error_.message;
    ASSERT_FALSE(albedo_.rgba.empty());
    ASSERT_FALSE(normal_.rgba.empty());
  }

  // The texel that shows the point `right_m` of the axis and `up_m` above the ground.
  static const uint8_t* At(const Pixels& pixels, int direction, float right_m, float up_m) {
    const ImpostorCell& cell = atlas_.cells[static_cast<size_t>(direction)];
    return Texel(pixels, int(std::floor(float(cell.origin_x) + right_m / atlas_.texel_m)),
                 int(std::floor(float(cell.origin_y) - up_m / atlas_.texel_m)));
  }

  static PackTexture Texture(const std::vector<uint8_t>& ktx2) {
    PackTexture texture;
    const Error error = ReadKtx2(ktx2, &texture);
    EXPECT_FALSE(error) << error.message;
    return texture;
  }

  static void ExpectColor(const uint8_t* texel, Rgb color, int least_alpha = 255) {
    EXPECT_NEAR(texel[0], color.r, 1);
    EXPECT_NEAR(texel[1], color.g, 1);
    EXPECT_NEAR(texel[2], color.b, 1);
    EXPECT_GE(texel[3], least_alpha);
  }

  static inline Error error_;
  static inline ImpostorAtlas atlas_;
  static inline ImpostorStatistics statistics_;
  static inline std::vector<std::string> warnings_;
  static inline Pixels albedo_, normal_;
};

TEST_F(BoxImpostor, EveryDirectionShowsItsSideInItsExactColor) {
  for (int d = 0; d < 4; ++d) {
    SCOPED_TRACE(d);
    ExpectColor(At(albedo_, d, 0, 0.2f), kFaces[d]);
    ExpectColor(At(albedo_, d, 0.1f, 1.7f), kFaces[d]);
  }
}

TEST_F(BoxImpostor, TextureIsExactAndItsHolesAreOpen) {
  ExpectColor(At(albedo_, 0, -0.12f, 1), kSign);
  ExpectColor(At(albedo_, 0, 0.12f, 1), kFaces[0]);
}

// A wall half black, half white along its diagonal, and above it one with a picture of black and white pixels in turn,
// much finer than the impostor's.
Avatar BlackAndWhiteAvatar() {
  Avatar avatar = BoxAvatar();
  for (Mesh& mesh : avatar.meshes) mesh = {};
  Mesh& halves = avatar.meshes[0];
  for (const Rgb color : {Rgb{0, 0, 0}, Rgb{255, 255, 255}}) AddWall(0, 0, 0.3f, 0, 0.9f, color, &halves);
  halves.indices = {0, 1, 2, 4, 6, 7};
  AddWall(0, 0, 0.3f, 0.9f, 1.8f, {255, 255, 255}, &avatar.meshes[1]);
  avatar.meshes[1].material = 0;
  avatar.materials[0].alpha = Material::Alpha::kOpaque;
  Pixels pixels{128, 128, {}};
  for (int i = 0; i < 128 * 128; ++i) {
    const uint8_t v = (i % 128 + i / 128) % 2 == 0 ? 255 : 0;
    pixels.rgba.insert(pixels.rgba.end(), {v, v, v, 255});
  }
  EXPECT_FALSE(EncodePng(pixels, true, &avatar.images[0]));
  return avatar;
}

TEST(BakeImpostor, EdgesAreMixedAsOnAScreenAndPicturesAsInMipLevels) {
  ImpostorOptions options = SmallOptions();
  options.directions = 1;
  ImpostorAtlas atlas;
  ImpostorStatistics statistics;
  ASSERT_EQ(BakeImpostor(BlackAndWhiteAvatar(), options, &atlas, &statistics).message, "");
  const Pixels albedo = Decoded(atlas.albedo.bytes).value();
  int mixed = 0;
  for (int y = 0; y < albedo.height; ++y) {
    for (int x = 0; x < albedo.width; ++x) {
      const uint8_t* texel = Texel(albedo, x, y);
      const float up_m = static_cast<float>(atlas.cells[0].origin_y - y) * atlas.texel_m;
      if (texel[3] < 255 || std::abs(up_m - 0.9f) < 0.1f) continue;
      if (up_m > 0.9f) {
        EXPECT_NEAR(texel[0], 188, 2);  // as bright as black and white in turn, far off
      } else {
        const int quarters = (texel[0] + 32) / 64;  // four samples
        EXPECT_NEAR(texel[0], 63.75 * quarters, 2);
        mixed += quarters > 0 && quarters < 4;
      }
    }
  }
  EXPECT_GT(mixed, 10);
}

TEST_F(BoxImpostor, NormalsAreTheAvatarsOwn) {
  const Rgb expected[4] = {{128, 128, 255}, {255, 128, 128}, {128, 128, 0}, {0, 128, 128}};
  for (int d = 0; d < 4; ++d) {
    const uint8_t* texel = At(normal_, d, 0.1f, 0.2f);
    EXPECT_NEAR(texel[0], expected[d].r, 1) << d;
    EXPECT_NEAR(texel[1], expected[d].g, 1) << d;
    EXPECT_NEAR(texel[2], expected[d].b, 1) << d;
  }
}

TEST_F(BoxImpostor, DepthIsMetresFromTheAxisTowardsTheCamera) {
  const auto depth_m = [](const uint8_t* texel) {
    return (static_cast<float>(texel[3]) / 255 * 2 - 1) * atlas_.depth_range_m;
  };
  const float step_m = 2 * atlas_.depth_range_m / 255;
  EXPECT_NEAR(depth_m(At(normal_, 0, -0.12f, 1)), kSignZ, step_m);
  EXPECT_NEAR(depth_m(At(normal_, 0, 0.12f, 1)), kHalf.z, step_m);
  EXPECT_NEAR(depth_m(At(normal_, 1, 0.05f, 1)), kHalf.x, step_m);
  EXPECT_GE(atlas_.depth_range_m, kHalf.x);
}

TEST_F(BoxImpostor, CellsAreCroppedAndApart) {
  EXPECT_EQ(atlas_.frames, 1);
  ASSERT_EQ(atlas_.clips.size(), 1u) << "a clip the avatar does not have is left out";
  EXPECT_EQ(atlas_.clips[0].name, "walk");
  EXPECT_EQ(albedo_.width, atlas_.width_px);
  EXPECT_EQ(normal_.height, atlas_.height_px);
  ASSERT_EQ(atlas_.cells.size(), 4u);
  std::vector<int> owners(static_cast<size_t>(atlas_.width_px * atlas_.height_px), 0);
  for (const ImpostorCell& cell : atlas_.cells) {
    EXPECT_EQ((cell.x | cell.y | cell.width | cell.height) % 4, 0);
    EXPECT_LE(cell.height, 48);
    for (int y = cell.y; y < cell.y + cell.height; ++y) {
      for (int x = cell.x; x < cell.x + cell.width; ++x) {
        EXPECT_EQ(++owners[static_cast<size_t>(y * atlas_.width_px + x)], 1);
        const bool rim = x == cell.x || y == cell.y || x == cell.x + cell.width - 1 || y == cell.y + cell.height - 1;
        if (!rim) continue;
        EXPECT_EQ(Texel(albedo_, x, y)[3], 0);
      }
    }
  }
  EXPECT_LT(atlas_.cells[1].width, atlas_.cells[0].width) << "the box is narrower from the side";
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(BoxImpostor, SilhouettesHaveTheirSize) {
  for (size_t d = 0; d < 4; ++d) {
    double covered = 0;
    const ImpostorCell& cell = atlas_.cells[d];
    for (int y = cell.y; y < cell.y + cell.height; ++y) {
      for (int x = cell.x; x < cell.x + cell.width; ++x) covered += Texel(albedo_, x, y)[3] / 255.0;
    }
    const float width_m = d % 2 == 0 ? 2 * kHalf.x : 2 * kHalf.z;
    EXPECT_NEAR(covered * double(atlas_.texel_m * atlas_.texel_m), double(width_m * 2 * kHalf.y), 0.02) << d;
  }
}

TEST_F(BoxImpostor, OfWhoIsLowHasTexelsAsLargeAsAGrownUps) {
  ImpostorOptions options = SmallOptions();
  options.full_height_m = 2 * 2 * kHalf.y;
  ImpostorAtlas low;
  ImpostorStatistics statistics;
  const Error error = BakeImpostor(BoxAvatar(), options, &low, &statistics);
  ASSERT_FALSE(error) << error.message;
  EXPECT_NEAR(low.texel_m, 2 * atlas_.texel_m, 1e-4f);
  for (size_t i = 0; i < low.cells.size(); ++i) EXPECT_LE(low.cells[i].height, 28) << i;
  EXPECT_LT(low.width_px * low.height_px, atlas_.width_px * atlas_.height_px / 2);
}

TEST_F(BoxImpostor, GuttersCarryThePersonsColors) {
  for (int d = 1; d < 4; ++d) {  // cell 0 has two colours
    const ImpostorCell& cell = atlas_.cells[static_cast<size_t>(d)];
    for (int y = cell.y; y < cell.y + cell.height; ++y) {
      for (int x = cell.x; x < cell.x + cell.width; ++x) {
        if (Texel(albedo_, x, y)[3] > 0) continue;
        EXPECT_NEAR(Texel(albedo_, x, y)[0], kFaces[d].r, 2);
        EXPECT_NEAR(Texel(albedo_, x, y)[1], kFaces[d].g, 2);
        EXPECT_NEAR(Texel(albedo_, x, y)[2], kFaces[d].b, 2);
      }
    }
  }
}

TEST_F(BoxImpostor, CompressedPicturesShowTheSame) {
  const PackTexture albedo = Texture(atlas_.albedo_ktx2), depth = Texture(atlas_.depth_ktx2);
  const PackTexture normal = Texture(atlas_.normal_ktx2), motion = Texture(atlas_.motion_ktx2);
  EXPECT_EQ(albedo.format, TextureFormat::kBc7Srgb);
  EXPECT_EQ(motion.width_px, atlas_.width_px / 2);
  EXPECT_EQ(TextureBytes(albedo) + TextureBytes(depth) + TextureBytes(normal) + TextureBytes(motion),
            statistics_.memory_bytes);
  const int width = atlas_.width_px, height = atlas_.height_px;
  const Pixels seen{width, height, DecodeLevel(albedo.format, width, height, albedo.levels[0])};
  for (int d = 0; d < 4; ++d) ExpectColor(At(seen, d, 0, 0.2f), kFaces[d], 253);
  const std::vector<uint8_t> depths = DecodeLevel(depth.format, width, height, depth.levels[0]);
  const std::vector<uint8_t> normals = DecodeLevel(normal.format, width, height, normal.levels[0]);
  for (size_t i = 0; i < depths.size(); ++i) {
    if (seen.rgba[4 * i + 3] < 253) continue;
    EXPECT_NEAR(normals[2 * i], 128, 1) << "every face looks at its camera";
    EXPECT_NEAR(normals[2 * i + 1], 128, 1);
    EXPECT_NEAR(depths[i], normal_.rgba[4 * i + 3], 3);
  }
}

TEST(BakeImpostor, SaysTexelByTexelWhereATintMayDye) {
  Avatar avatar = BoxAvatar();
  avatar.materials.resize(2);
  avatar.meshes[0].material = 1;
  avatar.materials[0].tints = 0b101;  // the sign
  avatar.materials[1].tints = 0b110;
  ImpostorAtlas atlas;
  ImpostorStatistics statistics;
  ASSERT_EQ(BakeImpostor(avatar, SmallOptions(), &atlas, &statistics).message, "");
  ASSERT_TRUE(atlas.tint_regions);
  const Pixels albedo = Decoded(atlas.albedo.bytes).value(), tints = Decoded(atlas.tints.bytes).value();
  int signs = 0, walls = 0;
  for (size_t i = 0; i + 3 < albedo.rgba.size(); i += 4) {
    if (albedo.rgba[i + 3] < 255) continue;
    const bool sign = std::abs(albedo.rgba[i] - kSign.r) < 2 && std::abs(albedo.rgba[i + 1] - kSign.g) < 2;
    if (tints.rgba[i] > 0 && tints.rgba[i] < 255) continue;  // an edge between the two
    ++(sign ? signs : walls);
    EXPECT_EQ(tints.rgba[i], sign ? 255 : 0) << i;
    EXPECT_EQ(tints.rgba[i + 1], sign ? 0 : 255) << i;
    EXPECT_EQ(tints.rgba[i + 2], 255) << i;
  }
  EXPECT_GT(signs, 50);
  EXPECT_GT(walls, 500);
  PackTexture picture;
  ASSERT_EQ(ReadKtx2(atlas.tints_ktx2, &picture).message, "");
  EXPECT_EQ(picture.width_px, atlas.width_px / 2);
}

TEST_F(BoxImpostor, IsTheSameAgainOnAnotherNumberOfThreads) {
  ImpostorOptions options = SmallOptions();
  options.threads = 1;
  ImpostorAtlas again;
  ImpostorStatistics statistics;
  const Error error = BakeImpostor(BoxAvatar(), options, &again, &statistics);
  ASSERT_FALSE(error) << error.message;
  EXPECT_EQ(again.albedo.bytes, atlas_.albedo.bytes);
  EXPECT_EQ(again.normal.bytes, atlas_.normal.bytes);
  EXPECT_EQ(again.albedo_ktx2, atlas_.albedo_ktx2);
  EXPECT_EQ(again.motion_ktx2, atlas_.motion_ktx2);
}

TEST_F(BoxImpostor, IsWrittenAsSevenFilesAndNothingElse) {
  TemporaryFolder folder;
  ASSERT_FALSE(folder.Create("flaneur_test_"));
  const fs::path target = folder.path() / "new" / "box";
  ASSERT_FALSE(WriteImpostor(target, atlas_));
  std::vector<uint8_t> bytes;
  ASSERT_FALSE(ReadFile(target / "albedo.png", &bytes));
  EXPECT_EQ(bytes, atlas_.albedo.bytes);
  std::string text;
  ASSERT_FALSE(ReadTextFile(target / "impostor.json", &text));
  EXPECT_NE(text.find("\"directions\": 4"), std::string::npos);
  EXPECT_EQ(std::distance(fs::directory_iterator(target), fs::directory_iterator()), 7);
}

// Discs and thin bars of two colours, as heads and limbs are, each a little elsewhere in its square of 64 texels.
constexpr int kSide = 1024;
AtlasLevel Figures() {
  AtlasLevel level{kSide, kSide, std::vector<AtlasTexel>(kSide * kSide)};
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const int figure = y / 64 * (kSide / 64) + x / 64;
      const float u = float(x % 64) - 31.5f - float(figure * 7 % 31) * 0.61f + 9,
                  v = float(y % 64) - 31.5f - float(figure * 5 % 9) * 0.37f;
      const float out = std::min({std::hypot(u, v + 16) - 11, std::max(std::abs(u) - 4, std::abs(v - 8) - 20)});
      AtlasTexel& texel = level.texels[static_cast<size_t>(y * kSide + x)];
      texel.coverage = std::clamp(0.5f - out, 0.0f, 1.0f);
      if (texel.coverage > 0)
        texel.albedo = v < -6 ? std::array<float, 3>{0.8f, 0.5f, 0.4f} : std::array<float, 3>{0.1f, 0.2f, 0.6f};
    }
  }
  return level;
}

TEST(AtlasLevels, KeepTheirCoverageToWithinAHundredth) {
  std::vector<AtlasLevel> levels = MakeLevels(Figures());
  const double share = CoveredShare(levels[0], 0.5f);
  KeepCoverage(&levels, 6);
  for (size_t k = 1; k < 6; ++k) EXPECT_NEAR(CoveredShare(levels[k], 0.5f), share, 0.01) << k;
}

TEST(AtlasLevels, EdgesKeepTheColourOfWhatIsCovered) {
  std::vector<AtlasLevel> levels = MakeLevels(Figures());
  FillGutters(&levels);
  for (size_t k = 1; k < 6; ++k) {
    const int side = kSide >> k, step = 1 << k;
    for (int i = 0; i < side * side; ++i) {
      const AtlasTexel& texel = levels[k].texels[static_cast<size_t>(i)];
      double red = 0, weight = 0;
      for (int j = 0; j < step * step; ++j) {
        const AtlasTexel& fine =
            levels[0].texels[static_cast<size_t>((i / side * step + j / step) * kSide + i % side * step + j % step)];
        red += double(fine.coverage) * double(fine.albedo[0]);
        weight += double(fine.coverage);
      }
      if (weight <= 0) continue;
      EXPECT_NEAR(double(texel.albedo[0]), red / weight, 1e-3) << k;
    }
  }
}

TEST(BlockCompression, ComesNearPersonsColours) {
  // A cloth's weave with an outline through it, and one colour alone.
  BlockTexels weave{}, flat{};
  for (size_t i = 0; i < 16; ++i) {
    const auto shade = static_cast<uint8_t>(90 + 10 * (i % 3));
    weave[i] = {shade, static_cast<uint8_t>(shade / 2), 40, static_cast<uint8_t>(i < 8 ? 255 : i < 12 ? 100 : 0)};
    flat[i] = {10, 128, 255, 255};
  }
  std::array<float, 16> weights{};
  weights.fill(1);
  for (const BlockTexels& texels : {weave, flat}) {
    std::vector<uint8_t> block(16);
    CompressBc7(texels, weights, std::span<uint8_t, 16>(block.data(), 16));
    const std::vector<uint8_t> decoded = DecodeLevel(TextureFormat::kBc7Srgb, 4, 4, block);
    for (size_t i = 0; i < 64; ++i) EXPECT_NEAR(decoded[i], texels[i / 4][i % 4], texels[0][0] == 10 ? 1 : 14) << i;
  }
}

// Two cloths that meet within a block, each woven of two shades; with an outline beside them, and without.
TEST(BlockCompression, HoldsTwoClothsInOneBlock) {
  std::array<float, 16> weights{};
  weights.fill(1);
  for (const bool outline : {false, true}) {
    BlockTexels texels{};
    for (size_t i = 0; i < 16; ++i) {
      const auto shade = static_cast<uint8_t>(i % 2 * 12);
      texels[i] = i % 4 < 2 ? std::array<uint8_t, 4>{static_cast<uint8_t>(200 - shade), 40, 30, 255}
                            : std::array<uint8_t, 4>{20, 60, static_cast<uint8_t>(150 + shade), 255};
      if (outline && i < 4) texels[i][3] = 60;
    }
    std::vector<uint8_t> block(16);
    CompressBc7(texels, weights, std::span<uint8_t, 16>(block.data(), 16));
    const std::vector<uint8_t> decoded = DecodeLevel(TextureFormat::kBc7Srgb, 4, 4, block);
    double squares = 0;
    for (size_t i = 0; i < 64; ++i) squares += std::pow(decoded[i] - texels[i / 4][i % 4], 2);
    EXPECT_LT(std::sqrt(squares / 64), outline ? 8 : 2);
  }
}

// Blocks with two pairs of ends, and what another program (Pillow) decodes them to.
TEST(BlockCompression, IsReadAsOthersReadIt) {
  const std::vector<uint8_t> opaque{0x06, 0xc6, 0x03, 0x41, 0xc4, 0x30, 0x18, 0xc2,
                                    0x30, 0x18, 0x87, 0x3d, 0x50, 0xc6, 0xe5, 0x3f};
  const std::vector<uint8_t> edge{0x80, 0x0e, 0x5a, 0x27, 0x89, 0x11, 0x84, 0x18,
                                  0x41, 0x7c, 0xfb, 0x3f, 0x83, 0xa9, 0xa9, 0x2a};
  const std::vector<uint8_t> a = DecodeLevel(TextureFormat::kBc7Srgb, 4, 4, opaque);
  const std::vector<uint8_t> b = DecodeLevel(TextureFormat::kBc7Srgb, 4, 4, edge);
  const auto texel = [](const std::vector<uint8_t>& all, size_t i) {
    return std::vector<uint8_t>(all.begin() + static_cast<std::ptrdiff_t>(4 * i),
                                all.begin() + static_cast<std::ptrdiff_t>(4 * i + 4));
  };
  EXPECT_EQ(texel(a, 0), (std::vector<uint8_t>{31, 17, 11, 255}));
  EXPECT_EQ(texel(a, 3), (std::vector<uint8_t>{66, 26, 26, 255}));
  EXPECT_EQ(texel(a, 12), (std::vector<uint8_t>{62, 14, 14, 255}));
  EXPECT_EQ(texel(a, 15), (std::vector<uint8_t>{66, 14, 14, 255}));
  EXPECT_EQ(texel(b, 0), (std::vector<uint8_t>{65, 16, 16, 251}));
  EXPECT_EQ(texel(b, 3), (std::vector<uint8_t>{89, 24, 24, 178}));
  EXPECT_EQ(texel(b, 7), (std::vector<uint8_t>{77, 20, 20, 255}));
  EXPECT_EQ(texel(b, 15), (std::vector<uint8_t>{60, 12, 12, 255}));
}

TEST(NormalSquare, HoldsEveryDirectionTowardsTheCamera) {
  for (int i = 0; i < 200; ++i) {
    const float z = float(i) / 199, r = std::sqrt(1 - z * z), a = float(i) * 2.4f;
    const Vec3 n{r * std::cos(a), r * std::sin(a), z};
    const Vec2 s = SquareFromNormal(n) * 2 - Vec2{1, 1};
    const Vec2 p{(s.x + s.y) / 2, (s.x - s.y) / 2};
    const Vec3 back = Normalized(Vec3{p.x, p.y, 1 - std::abs(p.x) - std::abs(p.y)});
    EXPECT_GT(Dot(n, back), 0.99999f);
  }
}

TEST(ViewGeometryTest, MotionAndBendLeadToThePosesHalfAPhaseAway) {
  Avatar avatar = BoxAvatar();
  avatar.joints.resize(1);
  for (Mesh& mesh : avatar.meshes) {
    mesh.joints.assign(mesh.positions.size(), {0, 0, 0, 0});
    mesh.weights.assign(mesh.positions.size(), {1, 0, 0, 0});
  }
  // Goes aside at an even pace, up and down again.
  avatar.clips = {
      {"walk", 1.0f, 3, {{{0, 0, 0}, {}, {1, 1, 1}}, {{1, 1, 0}, {}, {1, 1, 1}}, {{2, 0, 0}, {}, {1, 1, 1}}}}};
  ViewGeometry geometry;
  ASSERT_FALSE(PoseFrames(avatar, {{"walk", 2}}, &geometry));
  for (size_t i = geometry.uvs.size(); i < geometry.positions.size(); ++i) {  // the picture half way, at the top
    const Vec3 before = geometry.bends[i] - geometry.motions[i] * 0.5f,
               after = geometry.bends[i] + geometry.motions[i] * 0.5f;
    EXPECT_NEAR(before.x, -0.5f, 1e-5f);
    EXPECT_NEAR(after.x, 0.5f, 1e-5f);
    EXPECT_NEAR(before.y, -0.5f, 1e-5f);
    EXPECT_NEAR(after.y, -0.5f, 1e-5f);
  }
}

TEST(ViewGeometryTest, PhasesAreEvenlySpacedAndBoundsHoldForAnyDirection) {
  ViewGeometry geometry;
  ASSERT_FALSE(PoseFrames(BoxAvatar(), {{"idle", 2}, {"walk", 3}}, &geometry));
  EXPECT_EQ(geometry.frames, 3);
  EXPECT_EQ(geometry.positions.size(), 3 * geometry.uvs.size());
  EXPECT_EQ(geometry.motions.size(), geometry.positions.size());
  EXPECT_EQ(geometry.bends.size(), geometry.positions.size());
  EXPECT_EQ(Longest(geometry.motions, geometry), 0) << "it stands still";
  EXPECT_EQ(Longest(geometry.bends, geometry), 0);
  const std::vector<ViewBounds> front = MeasureViews(geometry, 1, {0});
  ASSERT_EQ(front.size(), 3u);
  EXPECT_NEAR(front[0].right_m, kHalf.x, 1e-6f);
  EXPECT_NEAR(front[0].left_m, -kHalf.x, 1e-6f);
  EXPECT_NEAR(front[0].top_m, 2 * kHalf.y, 1e-6f);
  EXPECT_NEAR(front[0].depth_m, kSignZ, 1e-6f);
  const std::vector<ViewBounds> above = MeasureViews(geometry, 4, {0, 45});
  ASSERT_EQ(above.size(), 24u);
  EXPECT_LT(above[4].bottom_m, -0.1f) << "seen from above, what stands before the axis reaches lower";
}

std::string ErrorOf(const Avatar& avatar, const ImpostorOptions& options) {
  ImpostorAtlas atlas;
  ImpostorStatistics statistics;
  return BakeImpostor(avatar, options, &atlas, &statistics).message;
}

TEST(BakeImpostorErrors, NameWhatIsWrong) {
  ImpostorOptions options = SmallOptions();
  options.directions = 0;
  EXPECT_NE(ErrorOf(BoxAvatar(), options).find("directions"), std::string::npos);
  options = SmallOptions();
  options.clips = {{"dance", 4}};
  EXPECT_NE(ErrorOf(BoxAvatar(), options).find("dance"), std::string::npos);
  options.clips = {{"walk", 200}};
  options.height_px = 1024;
  EXPECT_NE(ErrorOf(BoxAvatar(), options).find("fewer"), std::string::npos);
  Avatar broken = BoxAvatar();
  broken.meshes[0].positions[3].y = NAN;
  EXPECT_NE(ErrorOf(broken, SmallOptions()).find("vertex 3"), std::string::npos);
  broken = BoxAvatar();
  broken.meshes.clear();
  EXPECT_NE(ErrorOf(broken, SmallOptions()).find("no triangles"), std::string::npos);
}

TEST(BakeImpostorErrors, UnreadableTextureIsNamed) {
  Avatar broken = BoxAvatar();
  broken.images[0].bytes = {'n', 'o', 't', ' ', 'a', ' ', 'P', 'N', 'G'};
  EXPECT_NE(ErrorOf(broken, SmallOptions()).find("texture"), std::string::npos);
}

TEST(BakeImpostorErrors, MissingBlenderSaysWhatToDo) {
  ::setenv("FLANEUR_BLENDER", "/nowhere/blender", 1);
  const std::string message = ErrorOf(BoxAvatar(), SmallOptions());
  ::unsetenv("FLANEUR_BLENDER");
  EXPECT_NE(message.find("Blender not found"), std::string::npos);
}

TEST(ViewMaterialsTest, UnusableTextureIsWarnedAbout) {
  Avatar avatar = BoxAvatar();
  avatar.meshes[1].uvs.clear();
  std::vector<std::string> warnings;
  EXPECT_EQ(ViewMaterials(avatar, &warnings)[1].image, -1);
  avatar = BoxAvatar();
  avatar.images.clear();
  EXPECT_EQ(ViewMaterials(avatar, &warnings)[1].image, -1);
  EXPECT_EQ(warnings.size(), 2u);
}

}  // namespace
}  // namespace flaneur
