#include "pipeline/avatar/material_atlas.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "pipeline/avatar/atlas_picture.h"
#include "tests/unit/pipeline/test_person.h"

namespace flaneur {
namespace {

using Rgba = std::array<int, 4>;

// A square picture of one colour on its left half and another on its right.
Image TwoColors(Rgba left, Rgba right) {
  Pixels picture = Blank(64, 64);
  for (size_t i = 0; i < picture.rgba.size(); ++i) {
    picture.rgba[i] = static_cast<uint8_t>(((i / 4) % 64 < 32 ? left : right)[i % 4]);
  }
  return Encoded(picture, true);
}

// A square of 0.5 m in two triangles, with the picture from `min` to `max`.
Mesh Square(int material, Vec2 min, Vec2 max) {
  Mesh mesh;
  mesh.material = material;
  mesh.positions = {{0, 0, 0}, {0.5f, 0, 0}, {0.5f, 0.5f, 0}, {0, 0.5f, 0}};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.uvs = {min, {max.x, min.y}, max, {min.x, max.y}};
  mesh.joints.assign(4, {});
  mesh.weights.assign(4, {1, 0, 0, 0});
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

// Two levels, alike, of these squares.
AvatarLevels TwoLevels(std::vector<Mesh> meshes, std::vector<Material> materials, std::vector<Image> images) {
  AvatarLevels levels;
  levels.avatar = MadePerson();
  levels.avatar.meshes = meshes;
  levels.avatar.materials = std::move(materials);
  levels.avatar.images = std::move(images);
  levels.levels.resize(2);
  for (AvatarLevel& level : levels.levels) level.meshes = meshes;
  levels.levels[0].switch_px = 300;
  return levels;
}

Material Pictured(int image) {
  Material material;
  material.base_color_image = image;
  return material;
}

// The colour that a mesh of the coarser level shows at its first vertices' middle, shares from 0.
Rgba Shown(const AvatarLevels& levels, const Mesh& mesh, size_t first, float u, float v) {
  const Material& material = levels.avatar.materials[static_cast<size_t>(mesh.material)];
  const Pixels picture = *Decoded(levels.avatar.images[static_cast<size_t>(material.base_color_image)].bytes);
  const Vec2 a = mesh.uvs[first], b = mesh.uvs[first + 2];
  const float x = (a.x + u * (b.x - a.x)) * static_cast<float>(picture.width);
  const float y = (a.y + v * (b.y - a.y)) * static_cast<float>(picture.height);
  const size_t at = 4 * (static_cast<size_t>(y) * static_cast<size_t>(picture.width) + static_cast<size_t>(x));
  return {picture.rgba[at], picture.rgba[at + 1], picture.rgba[at + 2], picture.rgba[at + 3]};
}

void ExpectNear(Rgba a, Rgba b) {
  for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(a[i], b[i], 4) << "channel " << i;
}

TEST(MergeMaterials, ShowsTheSamePicturesInOneDraw) {
  Material plain;
  plain.base_color = {0.2158605f, 0, 1, 1};  // 0.5 in sRGB
  AvatarLevels levels =
      TwoLevels({Square(0, {0, 0}, {1, 1}), Square(1, {0, 0}, {1, 1}), Square(2, {0, 0}, {1, 1})},
                {Pictured(0), Pictured(1), plain},
                {TwoColors({200, 0, 0, 255}, {0, 200, 0, 255}), TwoColors({0, 0, 90, 255}, {9, 9, 9, 255})});
  std::vector<std::string> warnings;
  MergeMaterials(&levels, &warnings);
  EXPECT_TRUE(warnings.empty());
  EXPECT_EQ(levels.levels[0].meshes.size(), 3u);  // who is near stays as it was
  ASSERT_EQ(levels.levels[1].meshes.size(), 1u);
  const Mesh& mesh = levels.levels[1].meshes[0];
  EXPECT_EQ(TriangleCount(mesh), 6);
  ASSERT_EQ(mesh.uvs.size(), 12u);
  ExpectNear(Shown(levels, mesh, 0, 0.25f, 0.5f), {200, 0, 0, 255});
  ExpectNear(Shown(levels, mesh, 0, 0.75f, 0.5f), {0, 200, 0, 255});
  ExpectNear(Shown(levels, mesh, 4, 0.25f, 0.5f), {0, 0, 90, 255});
  ExpectNear(Shown(levels, mesh, 8, 0.5f, 0.5f), {128, 0, 255, 255});
}

TEST(MergeMaterials, KeepsApartWhatIsDyedOtherwiseButInOnePicture) {
  AvatarLevels levels = TwoLevels(
      {Square(0, {0, 0}, {1, 1}), Square(1, {0, 0}, {1, 1}), Square(0, {0, 0}, {1, 1})}, {Pictured(0), Pictured(1)},
      {TwoColors({200, 0, 0, 255}, {0, 200, 0, 255}), TwoColors({0, 0, 90, 255}, {9, 9, 9, 255})});
  levels.avatar.materials[1].tints = 0xFE;
  std::vector<std::string> warnings;
  MergeMaterials(&levels, &warnings);
  ASSERT_EQ(levels.levels[1].meshes.size(), 2u);
  const auto material = [&](size_t mesh) {
    return levels.avatar.materials[static_cast<size_t>(levels.levels[1].meshes[mesh].material)];
  };
  int triangles[2] = {};
  for (size_t mesh : {0u, 1u}) triangles[material(mesh).tints & 1] += TriangleCount(levels.levels[1].meshes[mesh]);
  EXPECT_EQ(triangles[0], 2);
  EXPECT_EQ(triangles[1], 4);
  EXPECT_EQ(material(0).base_color_image, material(1).base_color_image);
}

TEST(MergeMaterials, MultipliesBaseColoursAndMovesCutoffs) {
  Material tinted = Pictured(0), mask = Pictured(1);
  tinted.base_color = {0.5f, 1, 1, 1};
  mask.alpha = Material::Alpha::kMask;
  mask.alpha_cutoff = 0.8f;
  AvatarLevels levels =
      TwoLevels({Square(0, {0, 0}, {1, 1}), Square(1, {0, 0}, {1, 1})}, {tinted, mask},
                {TwoColors({255, 255, 255, 0}, {255, 255, 255, 0}), TwoColors({50, 50, 50, 210}, {50, 50, 50, 190})});
  std::vector<std::string> warnings;
  MergeMaterials(&levels, &warnings);
  ASSERT_EQ(levels.levels[1].meshes.size(), 1u);
  const Mesh& mesh = levels.levels[1].meshes[0];
  const Material& merged = levels.avatar.materials[static_cast<size_t>(mesh.material)];
  EXPECT_EQ(merged.alpha, Material::Alpha::kMask);
  EXPECT_FLOAT_EQ(merged.alpha_cutoff, 0.5f);
  ExpectNear(Shown(levels, mesh, 0, 0.25f, 0.5f), {188, 255, 255, 255});  // 0.5 of white, opaque
  EXPECT_GT(Shown(levels, mesh, 4, 0.25f, 0.5f)[3], 128);                 // above and below the cutoff as before
  EXPECT_LT(Shown(levels, mesh, 4, 0.75f, 0.5f)[3], 128);
}

TEST(MergeMaterials, WritesRepeatsOutOrKeepsThemApart) {
  const std::vector<Image> images{TwoColors({200, 0, 0, 255}, {0, 200, 0, 255})};
  AvatarLevels levels =
      TwoLevels({Square(0, {-7, 3}, {-4, 4}), Square(1, {0, 0}, {1, 1})}, {Pictured(0), Material{}}, images);
  std::vector<std::string> warnings;
  MergeMaterials(&levels, &warnings);
  EXPECT_TRUE(warnings.empty());
  ASSERT_EQ(levels.levels[1].meshes.size(), 1u);
  for (const float tile : {0.0f, 1.0f, 2.0f}) {
    const Mesh& mesh = levels.levels[1].meshes[0];
    ExpectNear(Shown(levels, mesh, 0, (tile + 0.25f) / 3, 0.5f), {200, 0, 0, 255});
    ExpectNear(Shown(levels, mesh, 0, (tile + 0.75f) / 3, 0.5f), {0, 200, 0, 255});
  }
  levels = TwoLevels({Square(0, {0, 0}, {40, 1}), Square(1, {0, 0}, {1, 1})}, {Pictured(0), Material{}}, images);
  MergeMaterials(&levels, &warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("repeats"), std::string::npos) << warnings[0];
  EXPECT_EQ(levels.levels[1].meshes.size(), 2u);
}

TEST(MergeMaterials, KeepsApartWhatIsDrawnOtherwise) {
  Material two_sided, blended;
  two_sided.double_sided = true;
  blended.alpha = Material::Alpha::kBlend;
  AvatarLevels levels = TwoLevels(
      {Square(0, {0, 0}, {1, 1}), Square(1, {0, 0}, {1, 1}), Square(2, {0, 0}, {1, 1}), Square(-1, {0, 0}, {1, 1})},
      {Material{}, two_sided, blended}, {});
  std::vector<std::string> warnings;
  MergeMaterials(&levels, &warnings);
  EXPECT_EQ(levels.levels[1].meshes.size(), 3u);
}

}  // namespace
}  // namespace flaneur
