#include "pipeline/impostor/bake_impostor.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "pipeline/core/temporary_folder.h"
#include "pipeline/impostor/atlas_image.h"
#include "pipeline/impostor/view_geometry.h"
#include "runtime/base/file.h"

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
void AddWall(float azimuth, float out, float half_width, float bottom, float top, Rgb color,
             Mesh* mesh) {
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
    pixels.rgba.insert(pixels.rgba.end(),
                       {uint8_t{kSign.r}, uint8_t{kSign.g}, uint8_t{kSign.b}, alpha});
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
    AddWall(kPi / 2 * static_cast<float>(face), outs[face], outs[(face + 1) % 4], 0, 2 * kHalf.y,
            kFaces[face], &avatar.meshes[0]);
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
  options.clips = {{"walk", 1}, {"talk", 2}};
  options.height_px = 48;
  options.samples = 4;
  return options;
}

Pixels Decoded(const Image& image) {
  Pixels pixels;
  TemporaryFolder folder;
  EXPECT_FALSE(folder.Create("flaneur_test_"));
  const fs::path file = folder.path() / "atlas.png";
  EXPECT_FALSE(WriteFile(file, image.bytes));
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  const auto input = OIIO::ImageInput::open(file.string(), &config);
  if (!input) return pixels;
  pixels.width = input->spec().width;
  pixels.height = input->spec().height;
  pixels.rgba.resize(4 * static_cast<size_t>(pixels.width) * static_cast<size_t>(pixels.height));
  EXPECT_EQ(input->spec().nchannels, 4);
  input->read_image(0, 0, 0, 4, OIIO::TypeDesc::UINT8, pixels.rgba.data());
  return pixels;
}

const uint8_t* Texel(const Pixels& pixels, int x, int y) {
  return &pixels.rgba[4 * static_cast<size_t>(y * pixels.width + x)];
}

// One bake for all tests that look at it.
class BoxImpostor : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    error_ = BakeImpostor(BoxAvatar(), SmallOptions(), &atlas_, &statistics_, &warnings_);
    albedo_ = Decoded(atlas_.albedo);
    normal_ = Decoded(atlas_.normal);
  }
  void SetUp() override {
    ASSERT_FALSE(error_) << error_.message;
    ASSERT_FALSE(albedo_.rgba.empty());
    ASSERT_FALSE(normal_.rgba.empty());
  }

  // The texel that shows the point `right_m` of the axis and `up_m` above the ground.
  static const uint8_t* At(const Pixels& pixels, int direction, float right_m, float up_m) {
    const float x = (right_m / atlas_.window_width_m + 0.5f) * float(atlas_.cell_width_px);
    const float y =
        (1 - (up_m - atlas_.bottom_m) / atlas_.window_height_m) * float(atlas_.cell_height_px);
    return Texel(pixels, direction * atlas_.cell_width_px + int(x), int(y));
  }

  static void ExpectColor(const uint8_t* texel, Rgb color) {
    EXPECT_NEAR(texel[0], color.r, 1);
    EXPECT_NEAR(texel[1], color.g, 1);
    EXPECT_NEAR(texel[2], color.b, 1);
    EXPECT_EQ(texel[3], 255);
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

TEST_F(BoxImpostor, LayoutHolds) {
  EXPECT_EQ(atlas_.directions, 4);
  EXPECT_EQ(atlas_.frames, 1);
  ASSERT_EQ(atlas_.clips.size(), 1u) << "a clip the avatar does not have is left out";
  EXPECT_EQ(atlas_.clips[0].name, "walk");
  EXPECT_EQ(atlas_.cell_width_px % 4, 0);
  EXPECT_EQ(atlas_.cell_height_px, 48);
  EXPECT_EQ(albedo_.width, 4 * atlas_.cell_width_px);
  EXPECT_EQ(albedo_.height, atlas_.cell_height_px);
  EXPECT_EQ(normal_.width, albedo_.width);
  EXPECT_EQ(normal_.height, albedo_.height);
  EXPECT_NEAR(atlas_.window_width_m / float(atlas_.cell_width_px),
              atlas_.window_height_m / float(atlas_.cell_height_px), 1e-6f);
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(BoxImpostor, SilhouetteFillsTheWindowUpToItsBorder) {
  const int width = atlas_.cell_width_px, height = atlas_.cell_height_px;
  int lowest = 0, highest = height;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < albedo_.width; ++x) {
      if (Texel(albedo_, x, y)[3] == 0) continue;
      lowest = std::max(lowest, y);
      highest = std::min(highest, y);
      EXPECT_GE(x % width, 2);
      EXPECT_LT(x % width, width - 2);
    }
  }
  EXPECT_EQ(highest, 2);
  EXPECT_EQ(lowest, height - 3);
}

TEST_F(BoxImpostor, GuttersCarryThePersonsColors) {
  for (int y = 0; y < albedo_.height; ++y) {
    for (int x = 0; x < albedo_.width; ++x) {
      const int d = x / atlas_.cell_width_px;
      if (d == 0 || Texel(albedo_, x, y)[3] > 0) continue;  // cell 0 has two colours
      const uint8_t* texel = Texel(albedo_, x, y);
      EXPECT_NEAR(texel[0], kFaces[d].r, 2);
      EXPECT_NEAR(texel[1], kFaces[d].g, 2);
      EXPECT_NEAR(texel[2], kFaces[d].b, 2);
    }
  }
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
}

TEST_F(BoxImpostor, IsWrittenAsThreeFilesAndNothingElse) {
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
  EXPECT_EQ(std::distance(fs::directory_iterator(target), fs::directory_iterator()), 3);
}

TEST(FillGuttersTest, ColorsStayInTheirCellAndNearTheirSource) {
  AtlasPixels atlas;
  atlas.albedo.width = atlas.normal.width = 16;
  atlas.albedo.height = atlas.normal.height = 8;
  atlas.albedo.rgba.assign(4 * 16 * 8, 0);
  atlas.normal.rgba.assign(4 * 16 * 8, 0);
  const auto put = [&](int x, int y, Rgb color) {
    uint8_t* texel = &atlas.albedo.rgba[4 * static_cast<size_t>(y * 16 + x)];
    texel[0] = static_cast<uint8_t>(color.r);
    texel[1] = static_cast<uint8_t>(color.g);
    texel[2] = static_cast<uint8_t>(color.b);
    texel[3] = 255;
    atlas.normal.rgba[4 * static_cast<size_t>(y * 16 + x) + 3] = static_cast<uint8_t>(color.r);
  };
  put(7, 4, {250, 0, 0});
  put(8, 4, {0, 250, 0});
  FillGutters(8, 8, &atlas);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 16; ++x) {
      EXPECT_EQ(Texel(atlas.albedo, x, y)[0], x < 8 ? 250 : 0);
      EXPECT_EQ(Texel(atlas.albedo, x, y)[1], x < 8 ? 0 : 250);
      EXPECT_EQ(Texel(atlas.normal, x, y)[3], x < 8 ? 250 : 0);
      EXPECT_EQ(Texel(atlas.albedo, x, y)[3], y == 4 && (x == 7 || x == 8) ? 255 : 0);
    }
  }
}

TEST(FillGuttersTest, EmptyCellStaysEmpty) {
  AtlasPixels atlas{{4, 4, std::vector<uint8_t>(64, 0)}, {4, 4, std::vector<uint8_t>(64, 0)}};
  FillGutters(4, 4, &atlas);
  EXPECT_EQ(atlas.albedo.rgba, std::vector<uint8_t>(64, 0));
}

TEST(ViewGeometryTest, PhasesAreEvenlySpacedAndExtentHoldsForAnyDirection) {
  ViewGeometry geometry;
  ASSERT_FALSE(PoseFrames(BoxAvatar(), {{"idle", 2}, {"walk", 3}}, &geometry));
  EXPECT_EQ(geometry.frames, 3);
  EXPECT_EQ(geometry.positions.size(), 3 * geometry.uvs.size());
  const ViewExtent front = MeasureExtent(geometry, 1, {0});
  EXPECT_NEAR(front.half_width_m, kHalf.x, 1e-6f);
  EXPECT_NEAR(front.top_m, 2 * kHalf.y, 1e-6f);
  EXPECT_NEAR(front.bottom_m, 0, 1e-6f);
  EXPECT_NEAR(front.depth_m, kSignZ, 1e-6f);
  const ViewExtent above = MeasureExtent(geometry, 4, {0, 45});
  EXPECT_LT(above.bottom_m, -0.2f) << "seen from above, what stands before the axis reaches lower";
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
