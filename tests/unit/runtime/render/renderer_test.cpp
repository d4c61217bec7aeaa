// Pictures of a small made-up tour: a wall, and a person who is a box, as a mesh and as an impostor.
#include "runtime/render/renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "runtime/desktop/context.h"
#include "runtime/render/block_picture.h"
#include "runtime/render/caption.h"
#include "runtime/render/mip_chain.h"
#include "runtime/render/occlusion.h"
#include "runtime/render/people_batches.h"
#include "runtime/render/person_geometry.h"
#include "runtime/render/projection.h"
#include "runtime/render/textures.h"
#include "runtime/render/town_geometry.h"
#include "runtime/render/visible_triangles.h"
#include "tests/soak/drivers_stay_loaded.h"

namespace flaneur {
namespace {

constexpr int kWidth = 320, kHeight = 180;

// A box on the ground (glTF axes), every face a quad with its own normal; skinned to joint 0.
PackPrimitive BoxPrimitive(Vec3 low, Vec3 high, int material, bool skinned) {
  PackPrimitive p;
  p.material = material;
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      const auto first = static_cast<uint32_t>(p.positions.size());
      for (int corner = 0; corner < 4; ++corner) {
        float c[3];
        c[axis] = static_cast<float>(side);
        c[(axis + 1) % 3] = corner == 1 || corner == 2 ? 1.0f : 0.0f;
        c[(axis + 2) % 3] = corner >= 2 ? 1.0f : 0.0f;
        float n[3] = {0, 0, 0};
        n[axis] = side == 1 ? 1.0f : -1.0f;
        p.positions.push_back(
            {low.x + c[0] * (high.x - low.x), low.y + c[1] * (high.y - low.y), low.z + c[2] * (high.z - low.z)});
        p.normals.push_back({n[0], n[1], n[2]});
      }
      const std::array<uint32_t, 6> forward{0, 1, 2, 0, 2, 3}, backward{0, 2, 1, 0, 3, 2};
      for (uint32_t i : side == 1 ? forward : backward) p.indices.push_back(first + i);
    }
  }
  if (skinned) {
    p.joints.assign(p.positions.size(), {0, 0, 0, 0});
    p.weights.assign(p.positions.size(), {255, 0, 0, 0});
  }
  return p;
}

// A picture of one colour. BC7: even values, by mode 6 with both ends alike.
PackTexture Flat(TextureFormat format, int width, int height, std::vector<uint8_t> color) {
  std::vector<uint8_t> block(BlockBytes(format), 0);
  if (format == TextureFormat::kBc7 || format == TextureFormat::kBc7Srgb) {
    size_t at = 0;
    const auto put = [&](int value, int bits) {
      for (int i = 0; i < bits; ++i, ++at) block[at / 8] |= static_cast<uint8_t>((value >> i & 1) << at % 8);
    };
    put(1 << 6, 7);
    for (uint8_t c : color) put(c >> 1, 7), put(c >> 1, 7);
  } else {
    for (size_t c = 0; c < color.size(); ++c) block[8 * c] = block[8 * c + 1] = color[c];
  }
  PackTexture texture{format, width, height, {{}}};
  for (size_t i = 0; i < LevelBytes(format, width, height) / block.size(); ++i) {
    texture.levels[0].insert(texture.levels[0].end(), block.begin(), block.end());
  }
  return texture;
}

PackAvatar BoxPerson() {
  PackAvatar a;
  a.name = "box";
  a.joints = 1;
  a.walk = a.idle = a.talk = {1, 1, {Mat4{}}};
  a.levels = {{0, 12, 0, 0, 100}, {0, 12, 0, 0, 0}};
  // Four times the same picture: 0.5 m wide, 1.8 m high, its front 0.25 m before the axis.
  PackImpostor& atlas = a.impostor;
  atlas.directions = 4;
  atlas.frames = 1;
  atlas.elevations_deg = {0};
  atlas.width_px = 128;
  atlas.height_px = 96;
  atlas.texel_m = 1.8f / 72;
  atlas.depth_range_m = 0.5f;
  atlas.motion_range_m = atlas.bend_range_m = 0.1f;
  atlas.clips = {{"walk", 0, 1}};
  for (int16_t d = 0; d < 4; ++d)
    atlas.cells.push_back({static_cast<int16_t>(32 * d), 0, 20, 72, static_cast<int16_t>(32 * d + 10), 72});
  atlas.albedo = Flat(TextureFormat::kBc7Srgb, 128, 96, {200, 60, 60, 254});
  atlas.normal = Flat(TextureFormat::kBc5, 128, 96, {128, 128});
  atlas.depth = Flat(TextureFormat::kBc4, 128, 96, {191});
  atlas.motion = Flat(TextureFormat::kBc7, 64, 48, {128, 128, 128, 128});
  return a;
}

// `boxes` of the town, each at its place on the ground.
TourPack MakePack(const std::vector<Vec2>& boxes) {
  TourPack pack;
  pack.materials = {{"red", {0.578f, 0.045f, 0.045f, 1}, -1, false, false, 0.5f}};  // 200, 60, 60 made linear
  pack.meshes = {{{BoxPrimitive({-0.25f, 0, -0.25f}, {0.25f, 1.8f, 0.25f}, 0, true)}},
                 {{BoxPrimitive({-1, 0, -1}, {1, 4, 1}, 0, false)}}};
  for (Vec2 p : boxes) {
    TownInstance instance{"box", 1, {}};
    const Vec3 at = GltfFromGround({p.x, p.y, 0});
    instance.world.m[3] = {at.x, at.y, at.z, 1};
    pack.town.push_back(instance);
  }
  pack.avatars = {BoxPerson()};
  return pack;
}

FrameInput LookEast() {
  FrameInput frame;
  frame.eye = {0, 0, 1.6f};
  frame.to_sun = Normalized(Vec3{-1, 0.3f, 0.6f});
  return frame;
}

// level: of the mesh; -1: the impostor.
DrawnPerson PersonAt(float x, float y, int level) {
  DrawnPerson person;
  person.level = level < 0 ? kImpostor : MeshLevel(level);
  person.position = {x, y, 0};
  person.heading_rad = kPi;  // towards the eye
  return person;
}

struct Rgb {
  int r, g, b;
};

class Drawing : public ::testing::Test {
 protected:
  void SetUp() override {
    const Error error = context_.Create();
    if (error) GTEST_SKIP() << error.message;
  }

  std::vector<uint8_t> Draw(const TourPack& pack, const FrameInput& frame, const RenderOptions& options = {}) {
    Renderer renderer;
    EXPECT_EQ(renderer.Create(pack, options).message, "");
    return DrawWith(frame, &renderer);
  }
  std::vector<uint8_t> DrawWith(const FrameInput& frame, Renderer* renderer) {
    std::vector<uint8_t> rgb;
    renderer->Draw(frame, kWidth, kHeight, &statistics_);
    renderer->Read(&rgb);
    return rgb;
  }

  void ExpectAreas(float DrawnPerson::*part, double of_larger, double of_smaller, double tolerance);

  HeadlessContext context_;
  FrameStatistics statistics_;
};

Rgb Pixel(const std::vector<uint8_t>& rgb, int x, int y) {
  const size_t i = static_cast<size_t>(y * kWidth + x) * 3;
  return {rgb[i], rgb[i + 1], rgb[i + 2]};
}

bool IsRed(Rgb c) { return c.r > c.g + 30 && c.r > c.b + 30; }

struct Patch {
  int count = 0;
  double r = 0, g = 0, b = 0;
};
Patch RedPatch(const std::vector<uint8_t>& rgb) {
  Patch patch;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const Rgb c = Pixel(rgb, x, y);
      if (!IsRed(c)) continue;
      ++patch.count;
      patch.r += c.r, patch.g += c.g, patch.b += c.b;
    }
  }
  patch.r /= patch.count, patch.g /= patch.count, patch.b /= patch.count;
  return patch;
}

TEST_F(Drawing, ABoxIsWhereTheProjectionSays) {
  const std::vector<uint8_t> rgb = Draw(MakePack({{11, 0}}), LookEast());
  // Its near face is 10 m away, 1 m to each side, up to 4 m: 2.4 m above the eye; the ground 1.6 m below.
  const float focal_px = kWidth / (2 * std::tan(0.5f));
  const auto column = [&](float right_m) { return static_cast<int>(kWidth / 2.0f + right_m / 10 * focal_px); };
  const auto row = [&](float up_m) { return static_cast<int>(kHeight / 2.0f - up_m / 10 * focal_px); };
  for (float right_m : {-0.9f, 0.9f}) {
    for (float up_m : {-1.4f, 2.2f})
      EXPECT_TRUE(IsRed(Pixel(rgb, column(right_m), row(up_m)))) << right_m << ' ' << up_m;
  }
  for (float right_m : {-1.15f, 1.15f}) EXPECT_FALSE(IsRed(Pixel(rgb, column(right_m), row(0)))) << right_m;
  EXPECT_FALSE(IsRed(Pixel(rgb, column(0), row(2.6f))));
  EXPECT_FALSE(IsRed(Pixel(rgb, column(0), row(-1.8f))));
}

// A blue plate that hangs before the chest, or behind the back: on meshes and impostors, fine and fast.
TEST_F(Drawing, APropIsDrawnBeforeThePersonOrHiddenBehindThem) {
  for (const bool in_front : {true, false}) {
    TourPack pack = MakePack({});
    pack.materials.push_back({"blue", {0.05f, 0.05f, 0.6f, 1}, -1, false, false, 0.5f});
    const float z = in_front ? 0.30f : -0.34f;  // the person faces +Z, their front is at 0.25
    pack.meshes.push_back({{BoxPrimitive({-0.15f, 0.9f, z - 0.02f}, {0.15f, 1.3f, z + 0.02f}, 1, true)}});
    pack.avatars[0].props = {{{"plate", 1, "", 12}, static_cast<int>(pack.meshes.size()) - 1}};
    pack.avatars[0].tints = {
        {{0.25f, 0.25f, 0.8f}, 0.3f, {{0.1f, 0.8f, 0.1f}}}};  // the plate's blue, which is no cloth
    for (const int samples : {4, 1}) {
      for (const int level : {0, -1}) {
        FrameInput frame = LookEast();
        frame.people = {PersonAt(5, 0, level)};
        frame.people[0].tints = {1};
        const auto blue = [&](uint8_t props, float share) {
          frame.people[0].props = props;
          frame.people[0].props_share = share;
          const std::vector<uint8_t> rgb = Draw(pack, frame, {.samples = samples});
          int count = 0;
          for (int y = kHeight / 3; y < kHeight; ++y) {
            for (int x = kWidth * 2 / 5; x < kWidth * 3 / 5; ++x)
              count += Pixel(rgb, x, y).b > Pixel(rgb, x, y).r + 40 ? 1 : 0;
          }
          return count;
        };
        SCOPED_TRACE(testing::Message() << "in front " << in_front << ", samples " << samples << ", level " << level);
        EXPECT_EQ(blue(0, 1), 0);
        const int whole = blue(1, 1);
        if (!in_front) {
          EXPECT_LT(whole, 10);
          continue;
        }
        EXPECT_GT(whole, 100);
        EXPECT_NEAR(blue(1, 0.5f), 0.5 * whole, 0.25 * whole) << "fades";
      }
    }
  }
}

// The red of BoxPerson's pictures is dyed blue or left as it is, and every other colour stays.
TEST_F(Drawing, LargePicturesAreMixedBetweenMipLevelsInSoftwareToo) {
  SurfacePlan plan;
  plan.arrays = {{1024, 1, false}, {512, 1, false}};
  const std::vector<GLuint> arrays = CreateTextureArrays(plan, true);
  for (size_t k = 0; k < arrays.size(); ++k) {
    GLint filter = 0;
    glBindTexture(GL_TEXTURE_2D_ARRAY, arrays[k]);
    glGetTexParameteriv(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, &filter);
    EXPECT_EQ(filter, k == 0 ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR_MIPMAP_NEAREST) << k;
  }
  glDeleteTextures(static_cast<GLsizei>(arrays.size()), arrays.data());
}

TEST_F(Drawing, ATintDyesMeshAndImpostorOfWhoWearsItAlone) {
  TourPack pack = MakePack({});
  pack.avatars[0].tints = {{{200 / 255.0f, 60 / 255.0f, 60 / 255.0f}, 0.2f, {{0.2f, 0.3f, 0.8f}, {0.2f, 0.7f, 0.3f}}}};
  for (const int samples : {4, 1}) {
    for (int level : {0, -1}) {
      FrameInput frame = LookEast();
      frame.people = {PersonAt(6, 1, level), PersonAt(6, -1, level)};
      frame.people[0].tints = {1};
      const std::vector<uint8_t> rgb = Draw(pack, frame, {.samples = samples});
      int blue = 0, red = 0;
      for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
          const Rgb c = Pixel(rgb, x, y);
          const bool is_blue = c.b > c.r + 60;
          if (is_blue && x < kWidth / 2 && y > kHeight / 3) ++blue;
          if (IsRed(c) && x > kWidth / 2) ++red;
        }
      }
      EXPECT_GT(red, 300) << "level " << level;
      EXPECT_NEAR(blue, red, 0.15 * red) << "level " << level;
    }
  }
  pack.avatars[0].tints[0].color = {0.1f, 0.9f, 0.1f};
  FrameInput frame = LookEast();
  frame.people = {PersonAt(6, 0, 0)};
  const std::vector<uint8_t> own = Draw(pack, frame);
  frame.people[0].tints = {1};
  EXPECT_EQ(Draw(pack, frame), own) << "nobody wears that colour";
}

// A tunic on the picture's left and hair on its right, both red: who wears the tunic in blue keeps their hair.
TEST_F(Drawing, ATintBoundToAMaterialLeavesAnotherOfTheSameColour) {
  TourPack pack = MakePack({});
  pack.materials.push_back(pack.materials[0]);
  pack.materials[1].tints = 0xFE;
  pack.meshes[0] = {{BoxPrimitive({-0.25f, 0, -0.25f}, {-0.05f, 1.8f, 0.25f}, 0, true),
                     BoxPrimitive({-0.05f, 0, -0.25f}, {0.25f, 1.8f, 0.25f}, 1, true)}};
  pack.avatars[0].tints = {{{200 / 255.0f, 60 / 255.0f, 60 / 255.0f}, 0.2f, {{0.2f, 0.3f, 0.8f}}, {0}}};
  PackTexture& regions = pack.avatars[0].impostor.tints = Flat(TextureFormat::kBc7, 64, 48, {254, 254, 254, 254});
  const std::vector<uint8_t> nothing = Flat(TextureFormat::kBc7, 4, 4, {0, 0, 0, 254}).levels[0];
  for (size_t block = 0; block < regions.levels[0].size() / nothing.size(); ++block) {
    const auto at = regions.levels[0].begin() + static_cast<std::ptrdiff_t>(block * nothing.size());
    if (block % 4 > 0) std::copy(nothing.begin(), nothing.end(), at);
  }
  for (const int samples : {4, 1}) {
    for (int level : {0, -1}) {
      FrameInput frame = LookEast();
      frame.people = {PersonAt(4, 0, level)};
      frame.people[0].tints = {1};
      const std::vector<uint8_t> rgb = Draw(pack, frame, {.samples = samples});
      int blue_left = 0, red_left = 0, blue_right = 0, red_right = 0;
      for (int y = kHeight / 3; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
          const Rgb c = Pixel(rgb, x, y);
          const bool blue = c.b > c.r + 60;
          if (x >= kWidth / 2) blue ? ++blue_right : IsRed(c) ? ++red_right : 0;
          else if (x < kWidth * 47 / 100) blue ? ++blue_left : IsRed(c) ? ++red_left : 0;
        }
      }
      SCOPED_TRACE(testing::Message() << "samples " << samples << ", level " << level);
      EXPECT_GT(blue_left, 300);
      EXPECT_GT(red_right, 300);
      EXPECT_EQ(blue_right, 0) << "the hair stays as it is";
    }
  }
}

// Of somebody whose part is 1.1 and 0.9 of the model's, mesh and impostor, against the model's own.
void Drawing::ExpectAreas(float DrawnPerson::*part, double of_larger, double of_smaller, double tolerance) {
  const TourPack pack = MakePack({});
  for (const int samples : {4, 1}) {
    for (int level : {0, -1}) {
      const auto area = [&](float value) {
        FrameInput frame = LookEast();
        frame.people = {PersonAt(6, 0, level)};
        frame.people[0].*part = value;
        return RedPatch(Draw(pack, frame, {.samples = samples})).count;
      };
      const int own = area(1);
      EXPECT_NEAR(area(1.1f), of_larger * own, tolerance * own) << "level " << level;
      EXPECT_NEAR(area(0.9f), of_smaller * own, tolerance * own) << "level " << level;
    }
  }
}

TEST_F(Drawing, WhoIsLargerIsDrawnLargerAtEveryLevel) { ExpectAreas(&DrawnPerson::size, 1.21, 0.81, 0.05); }

TEST_F(Drawing, WhoIsBroaderIsDrawnBroaderAndNoHigherAtEveryLevel) {
  ExpectAreas(&DrawnPerson::breadth, 1.1, 0.9, 0.07);
}

TEST_F(Drawing, MeshAndImpostorLookAlike) {
  const TourPack pack = MakePack({});
  FrameInput frame = LookEast();
  frame.people = {PersonAt(6, 0, 0)};
  const Patch mesh = RedPatch(Draw(pack, frame));
  frame.people = {PersonAt(6, 0, -1)};
  const Patch impostor = RedPatch(Draw(pack, frame));
  ASSERT_GT(mesh.count, 500);
  EXPECT_NEAR(impostor.count, mesh.count, 0.1 * mesh.count);
  EXPECT_NEAR(impostor.r, mesh.r, 12);
  EXPECT_NEAR(impostor.g, mesh.g, 12);
  EXPECT_NEAR(impostor.b, mesh.b, 12);
}

TEST_F(Drawing, AnImpostorsBlocksLookAsDecoded) {
  const PackTexture blocks = Flat(TextureFormat::kBc7Srgb, 8, 8, {200, 60, 62, 254});
  const std::vector<uint8_t> decoded = DecodeLevel(blocks.format, 8, 8, blocks.levels[0]);
  ASSERT_EQ(decoded.size(), 8u * 8 * 4);
  for (size_t i = 0; i < decoded.size(); ++i) EXPECT_EQ(decoded[i], (std::array<int, 4>{200, 60, 62, 254})[i % 4]);
}

// Drivers that dither what alpha makes of coverage left a grid of holes in impostors whose pixels were fully covered
// but had less than all of it.
TEST_F(Drawing, AnImpostorIsOpaqueWithinItsEdge) {
  Renderer renderer;
  ASSERT_EQ(renderer.Create(MakePack({}), {.samples = 4}).message, "");
  FrameInput frame = LookEast();
  frame.people = {PersonAt(6, 0, -1)};
  renderer.Draw(frame, kWidth, kHeight, &statistics_);
  std::vector<uint8_t> rgba;
  renderer.ReadWithAlpha(&rgba);
  int red = 0, opaque = 0;
  for (size_t i = 0; i < rgba.size(); i += 4) {
    if (!IsRed({rgba[i], rgba[i + 1], rgba[i + 2]})) continue;
    ++red;
    opaque += rgba[i + 3] == 255;
  }
  EXPECT_GT(red, 500);
  EXPECT_GT(opaque, 0.8 * red);
}

TEST_F(Drawing, AnAtlasThatComesInPartsIsTheSame) {
  TourPack pack = MakePack({});
  std::vector<uint8_t>& blocks = pack.avatars[0].impostor.albedo.levels[0];
  const PackTexture green = Flat(TextureFormat::kBc7Srgb, 128, 96, {60, 200, 60, 254});
  for (size_t k = blocks.size() / 3; k < blocks.size() / 2; ++k) blocks[k] = green.levels[0][k];
  FrameInput frame = LookEast();
  frame.people = {PersonAt(6, 0, -1)};
  const std::vector<uint8_t> whole = Draw(pack, frame);
  Renderer renderer;
  ASSERT_EQ(renderer.Begin(pack, {}).message, "");
  for (const AssetId& id : AssetsOf(pack)) {
    Asset asset = PrepareAsset(pack, id, renderer.surfaces(), renderer.formats());
    int parts = 1;
    while (!renderer.Add(1000, &asset)) ++parts;
    EXPECT_TRUE(id.kind != AssetKind::kAtlas || parts > 20) << parts;
  }
  EXPECT_EQ(DrawWith(frame, &renderer), whole);
}

// With several samples a pixel as in software: what stands behind the axis hides nothing, what stands before the feet
// hides all, and between lies a plane that leans back, so that a counter's top hides who stands close behind it.
TEST_F(Drawing, AnImpostorIsAsDeepAsAPlaneThatLeansBack) {
  TourPack pack = MakePack({{7.05f, 0}});  // its near face 5 cm behind the axis of a person 6 m away
  FrameInput frame = LookEast();
  pack.materials[0].base_color = {0.1f, 0.6f, 0.1f, 1};  // the wall's, and the mesh's, which is not drawn
  frame.people = {PersonAt(6, 0, -1)};
  for (const int samples : {1, 4}) {
    const auto red_before_m = [&](float before_m) {
      pack.town[0].world.m[3][0] = 7 - before_m;
      return RedPatch(Draw(pack, frame, {samples, true, false})).count;
    };
    const int whole = red_before_m(-0.05f);
    EXPECT_GT(whole, 500);
    EXPECT_EQ(red_before_m(0.08f), whole);
    const int above_feet = red_before_m(0.28f), to_hip = red_before_m(0.2f);
    EXPECT_GT(above_feet, 0);
    EXPECT_GT(to_hip, above_feet);
    EXPECT_LT(to_hip, 0.8 * whole);
    EXPECT_EQ(red_before_m(0.37f), 0);
  }
}

// Both maps of the town were due again and again, and the near one waited for the far one until it was drawn at once.
TEST_F(Drawing, NoPictureDrawsAllShadowsOfALargeTownOfWhoRunsWhileTheSunTurns) {
  std::vector<Vec2> boxes;
  for (int i = 0; i < 34000; ++i)
    boxes.push_back({-3 - 0.8f * static_cast<float>(i % 185), 0.8f * static_cast<float>(i / 185) - 75});
  const TourPack pack = MakePack(boxes);
  Renderer renderer;
  ASSERT_EQ(renderer.Create(pack, {}).message, "");
  FrameInput frame = LookEast();  // they lie behind the eye
  frame.resolution_scale = 0.5f;
  int64_t most = 0;
  for (int i = 0; i < 400; ++i) {
    const float time_s = static_cast<float>(i) / 27, turn = 0.0075f * time_s;
    frame.eye.y = 3.8f * time_s - 30;
    frame.to_sun = Normalized(Vec3{-std::cos(turn), -std::sin(turn), 0.6f});
    renderer.Draw(frame, kWidth, kHeight, &statistics_);
    if (i == 0) EXPECT_GT(statistics_.shadow_triangles, 400000) << "all of it, before the first picture";
    else most = std::max(most, statistics_.shadow_triangles);
  }
  EXPECT_GT(most, 0);
  EXPECT_LT(most, 12000);
}

TEST_F(Drawing, TwoSharesOfOneFadeFillThePersonAndNoMore) {
  const TourPack pack = MakePack({});
  FrameInput frame = LookEast();
  frame.contact_shade = 0;  // it fades with them
  frame.people = {PersonAt(6, 0, 0)};
  const std::vector<uint8_t> whole = Draw(pack, frame);
  for (float t : {0.1f, 0.5f, 0.9f}) {
    frame.people = {PersonAt(6, 0, 0), PersonAt(6, 0, 1)};
    frame.people[0].share_to = t;
    frame.people[1].share_from = t;
    EXPECT_EQ(Draw(pack, frame), whole) << t;
    EXPECT_EQ(statistics_.people_triangles, 24);
    frame.people.pop_back();
    const Patch part = RedPatch(Draw(pack, frame, {4, true}));
    EXPECT_NEAR(part.count, t * RedPatch(whole).count, 0.12 * RedPatch(whole).count) << t;
  }
}

TEST_F(Drawing, CullingLeavesOutNothingThatIsSeen) {
  std::vector<Vec2> boxes;
  for (int i = -6; i <= 6; ++i) {
    for (int j = -6; j <= 6; ++j) boxes.push_back({9.0f * static_cast<float>(i) + 4, 9.0f * static_cast<float>(j) + 4});
  }
  const TourPack pack = MakePack(boxes);
  Renderer culling, whole;
  ASSERT_EQ(culling.Create(pack).message, "");
  ASSERT_EQ(whole.Create(pack, {0, false}).message, "");
  for (int k = 0; k < 12; ++k) {
    FrameInput frame = LookEast();
    frame.yaw_rad = static_cast<float>(k) * kPi / 6;
    frame.pitch_rad = 0.2f * static_cast<float>(k % 3 - 1);
    const std::vector<uint8_t> some = DrawWith(frame, &culling);
    const int64_t drawn = statistics_.town_triangles;
    EXPECT_EQ(some, DrawWith(frame, &whole)) << k;
    EXPECT_LT(drawn, statistics_.town_triangles / 2) << k;
    EXPECT_EQ(statistics_.town_triangles, static_cast<int64_t>(12 * boxes.size()));
  }
}

FrameInput TwoInTheEast() {
  FrameInput frame = LookEast();
  frame.people = {PersonAt(6, 1, 0), PersonAt(9, -1, -1)};
  return frame;
}

TEST_F(Drawing, TheSameFrameGivesTheSamePicture) {
  const TourPack pack = MakePack({{11, 3}, {14, -4}});
  const FrameInput frame = TwoInTheEast();
  Renderer renderer;
  ASSERT_EQ(renderer.Create(pack).message, "");
  const std::vector<uint8_t> first = DrawWith(frame, &renderer);
  EXPECT_EQ(DrawWith(frame, &renderer), first);
  EXPECT_EQ(Draw(pack, frame), first);
}

TEST_F(Drawing, NobodyWaitsForPicturesThatRunAheadAndTheyAreTheSame) {
  const TourPack pack = MakePack({{11, 3}, {14, -4}});
  Renderer waits, runs_ahead;
  ASSERT_EQ(waits.Create(pack).message, "");
  ASSERT_EQ(runs_ahead.Create(pack, {.runs_ahead = true}).message, "");
  FrameInput frame = TwoInTheEast();
  for (int picture = 0; picture < 3; ++picture) {
    frame.yaw_rad += 0.1f;
    for (int more = 0; more < 2; ++more)
      runs_ahead.Draw(frame, kWidth, kHeight, &statistics_);  // without a look at them
    const std::vector<uint8_t> seen = DrawWith(frame, &runs_ahead);
    EXPECT_GT(statistics_.draw_ms, 0);
    EXPECT_EQ(seen, DrawWith(frame, &waits));
  }
}

double MeanDifference(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b[i]);
  return sum / static_cast<double>(a.size());
}

// Pixels that are neither as dark as the one at one side nor as bright as that at the other.
size_t Between(const std::vector<uint8_t>& rgb) {
  constexpr int kApart = 10;
  size_t count = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 1; x + 1 < kWidth; ++x) {
      const auto green = [&](int at) { return int{Pixel(rgb, at, y).g}; };
      const auto [least, most] = std::minmax({green(x - 1), green(x + 1)});
      count += least + kApart < green(x) && green(x) + kApart < most ? 1 : 0;
    }
  }
  return count;
}

TEST_F(Drawing, AnAverageOfPicturesHasTheSmoothEdgesOfTheDriversSamples) {
  const TourPack pack = MakePack({{11, 3}, {14, -4}});
  FrameInput frame = TwoInTheEast();
  frame.yaw_rad = 0.11f;  // edges that no column holds
  const std::vector<uint8_t> samples = Draw(pack, frame, {.samples = 4});
  Renderer renderer;
  ASSERT_EQ(renderer.Create(pack, {.samples = 4, .averages = true}).message, "");
  const std::vector<uint8_t> average = DrawWith(frame, &renderer);
  EXPECT_LT(MeanDifference(average, samples), 1);
  const auto between = static_cast<double>(Between(samples));
  EXPECT_GT(between, 300);
  EXPECT_NEAR(static_cast<double>(Between(average)), between, 0.3 * between);
  EXPECT_EQ(DrawWith(frame, &renderer), average) << "and nothing of the picture before";
}

TEST_F(Drawing, ACoarsePictureShowsTheSameAndKeepsTheCaptionSharp) {
  const TourPack pack = MakePack({{11, 3}, {14, -4}});
  for (int samples : {1, 4}) {
    Renderer renderer;
    ASSERT_EQ(renderer.Create(pack, {.samples = samples}).message, "");
    FrameInput frame = TwoInTheEast();
    const std::vector<uint8_t> fine = DrawWith(frame, &renderer);
    FrameInput elsewhere = frame;
    elsewhere.yaw_rad = 0.3f;
    double least = 100;
    for (float scale : {0.35f, 0.5f, 0.77f}) {  // from coarse to fine
      frame.resolution_scale = scale;
      const std::vector<uint8_t> coarse = DrawWith(frame, &renderer);
      ASSERT_EQ(coarse.size(), fine.size());
      const double difference = MeanDifference(coarse, fine);
      EXPECT_LT(difference, 4) << samples << ' ' << scale;
      EXPECT_LT(difference, least) << samples << ' ' << scale;
      EXPECT_LT(difference, MeanDifference(DrawWith(elsewhere, &renderer), fine) / 3);
      least = difference;
    }
    frame.caption = elsewhere.caption = "A well.";
    const std::vector<uint8_t> coarse = DrawWith(frame, &renderer);
    frame.resolution_scale = 1;
    const std::vector<uint8_t> sharp = DrawWith(frame, &renderer);
    for (int x = 0; x < kWidth; ++x) {  // white letters on what is nearly black
      for (int y = kHeight - 12; y < kHeight - 4; ++y)
        ASSERT_NEAR(Pixel(coarse, x, y).g, Pixel(sharp, x, y).g, 40) << x << ' ' << y;
    }
  }
}

TEST_F(Drawing, APictureAfterCoarserOnesIsTheSameAsBefore) {
  const TourPack pack = MakePack({{11, 3}, {14, -4}});
  for (int samples : {1, 4}) {
    Renderer renderer;
    ASSERT_EQ(renderer.Create(pack, {.samples = samples}).message, "");
    FrameInput frame = TwoInTheEast();
    const std::vector<uint8_t> whole = DrawWith(frame, &renderer);
    frame.resolution_scale = 0.6f;
    const std::vector<uint8_t> coarse = DrawWith(frame, &renderer);
    frame.resolution_scale = 0.3f;
    DrawWith(frame, &renderer);
    frame.resolution_scale = 0.6f;
    EXPECT_EQ(DrawWith(frame, &renderer), coarse);
    frame.resolution_scale = 1;
    EXPECT_EQ(DrawWith(frame, &renderer), whole);
  }
}

// Before what is behind it, and not at all behind the eye.
TEST_F(Drawing, SmokeIsSeenWhereItIsInOneCall) {
  const TourPack pack = MakePack({{11, 3}});
  const std::vector<uint8_t> clear = Draw(pack, LookEast());
  const int calls = statistics_.draw_calls;
  FrameInput frame = LookEast();
  const Vec3 ahead{std::cos(frame.yaw_rad), std::sin(frame.yaw_rad), 0};
  for (int k = 0; k < 20; ++k)
    frame.smoke.push_back({frame.eye + ahead * (30 - 0.1f * static_cast<float>(k)), 2, 0.6f, 0.3f});
  const std::vector<uint8_t> smoky = Draw(pack, frame);
  EXPECT_NE(clear, smoky);
  EXPECT_EQ(statistics_.draw_calls, calls + 1);
  for (SmokePuff& puff : frame.smoke) puff.position = frame.eye - ahead * 30;
  EXPECT_EQ(Draw(pack, frame), clear) << "behind the eye";
}

TEST_F(Drawing, StatisticsCountWhatIsDrawn) {
  FrameInput frame = LookEast();
  frame.people = {PersonAt(6, 1, 0), PersonAt(9, -1, -1), PersonAt(9, -2, -1)};
  Draw(MakePack({{11, 3}}), frame);
  EXPECT_EQ(statistics_.town_triangles, 4) << "of the two sides that face the eye";
  EXPECT_EQ(statistics_.people_triangles, 12 + 2 + 2);
  EXPECT_EQ(statistics_.people_drawn, 3);
  EXPECT_LE(statistics_.draw_calls, 11);
  frame.people = {PersonAt(6, 1, 0), PersonAt(19, 5.2f, -1),
                  PersonAt(-3, 0, -1)};  // seen, behind the box, behind the eye
  Draw(MakePack({{11, 3}}), frame);
  EXPECT_EQ(statistics_.people_drawn, 1);
  EXPECT_EQ(statistics_.people_hidden, 2);
  EXPECT_GT(statistics_.draw_ms, 0);
}

TEST_F(Drawing, APersonCastsAShadowOnTheGround) {
  TourPack pack = MakePack({});
  pack.materials.push_back({"grey", {0.4f, 0.4f, 0.4f, 1}, -1, false, false, 0.5f});
  pack.meshes.push_back({{BoxPrimitive({-30, -1, -30}, {30, 0, 30}, 1, false)}});
  pack.town.push_back({"ground", 2, {}});
  FrameInput frame = LookEast();
  frame.eye.z = 3;
  frame.pitch_rad = -0.4f;
  const std::vector<uint8_t> empty = Draw(pack, frame);
  for (int level : {0, -1}) {
    frame.people = {PersonAt(6, 0, level)};
    const std::vector<uint8_t> with = Draw(pack, frame);
    int darker = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x)
        darker += !IsRed(Pixel(with, x, y)) && Pixel(with, x, y).g < Pixel(empty, x, y).g - 30;
    }
    EXPECT_GT(darker, 100) << level;
  }
}

// A plain, a wall, a leaning roof and somebody, all of them before the sun and in nobody's shadow: each is lit evenly,
// at any height and heading of the sun, with the light in a pass of its own and with the surfaces.
TEST_F(Drawing, NothingCastsAShadowOnItself) {
  TourPack pack = MakePack({{12, 0}});
  pack.materials.push_back({"grey", {0.4f, 0.4f, 0.4f, 1}, -1, false, false, 0.5f});
  pack.meshes.push_back({{BoxPrimitive({-80, -1, -80}, {80, 0, 80}, 1, false)}});
  pack.town.push_back({"ground", 2, {}});
  PackPrimitive roof;
  roof.material = 1;
  const Vec3 n = Normalized(Vec3{-1, 1, 0});
  roof.positions = {{9, 0.5f, 2}, {9, 0.5f, 6}, {11, 2.5f, 6}, {11, 2.5f, 2}};
  roof.normals.assign(4, n);
  roof.indices = {0, 1, 2, 0, 2, 3};
  pack.meshes.push_back({{roof}});
  pack.town.push_back({"roof", 3, {}});
  FrameInput frame = LookEast();
  const auto column = [](float right_m, float ahead_m) {
    return kWidth / 2 + static_cast<int>(right_m / ahead_m * kWidth / (2 * std::tan(0.5f)));
  };
  const auto row = [](float up_m, float ahead_m) {
    return kHeight / 2 - static_cast<int>((up_m - 1.6f) / ahead_m * kWidth / (2 * std::tan(0.5f)));
  };
  struct Even {
    const char* what;
    int left, right, top, bottom;
    bool of_person;
  };
  const Even surfaces[] = {{"wall", column(-0.8f, 11), column(0.8f, 11), row(3.8f, 11), row(0.3f, 11), false},
                           {"roof", column(2.6f, 10), column(5.2f, 10), row(2.0f, 10.5f), row(1.0f, 9.5f), false},
                           {"ground", 20, kWidth - 20, row(0, 5), kHeight - 2, false},
                           {"person", column(-2.6f, 5.9f), column(-2.4f, 5.9f), row(1.7f, 6), row(0.2f, 6), true}};
  for (const int samples : {1, 4}) {
    Renderer renderer;
    ASSERT_EQ(renderer.Create(pack, {.samples = samples}).message, "");
    for (const float height : {0.1f, 0.7f, 2.0f}) {
      for (const float aside : {-0.5f, 0.0f, 0.5f}) {
        frame.to_sun = Normalized(Vec3{-1, aside, height});
        for (const int level : {0, -1}) {
          frame.people.clear();
          const std::vector<uint8_t> town = DrawWith(frame, &renderer);
          frame.people = {PersonAt(6, 2.5f, level)};
          const std::vector<uint8_t> with_person = DrawWith(frame, &renderer);
          for (const Even& s : surfaces) {
            const std::vector<uint8_t>& rgb = s.of_person ? with_person : town;
            int darkest = 255, brightest = 0;
            for (int y = s.top; y < s.bottom; ++y) {
              for (int x = s.left; x < s.right; ++x) {
                darkest = std::min(darkest, Pixel(rgb, x, y).r), brightest = std::max(brightest, Pixel(rgb, x, y).r);
              }
            }
            EXPECT_LE(brightest - darkest, 12) << s.what << ", sun " << height << " high, " << aside << " aside, level "
                                               << level << ", samples " << samples;
          }
        }
      }
    }
  }
}

// A house 85 m away in a town of 800 m: its shadow's edge is as narrow as a picture of the distance needs, and a fine
// one at the feet.
TEST_F(Drawing, EdgesOfShadowsAreNarrowNearAndFarInALargeTown) {
  TourPack pack = MakePack({});
  pack.materials.push_back({"grey", {0.4f, 0.4f, 0.4f, 1}, -1, false, false, 0.5f});
  pack.meshes.push_back({{BoxPrimitive({-400, -1, -400}, {400, 0, 400}, 1, false)}});
  pack.town.push_back({"ground", 2, {}});
  struct Edge {
    float distance_m, height_m, eye_m, most_m;
  };
  for (const Edge& edge : {Edge{85, 12, 20, 0.3f}, Edge{4, 1.5f, 1.6f, 0.05f}}) {
    TourPack town = pack;
    const float reach_m = edge.height_m / 0.6f, half_m = edge.distance_m / 10;
    town.meshes.push_back({{BoxPrimitive({edge.distance_m - half_m, 0, reach_m},
                                         {edge.distance_m + half_m, edge.height_m, 2 * reach_m}, 1, false)}});
    town.town.push_back({"house", 3, {}});
    FrameInput frame = LookEast();
    frame.eye.z = edge.eye_m;
    frame.pitch_rad = -std::atan(edge.eye_m / edge.distance_m);
    frame.fov_rad = 3 / std::hypot(edge.distance_m, edge.eye_m);  // 3 m wide
    frame.to_sun = Normalized(Vec3{0, -1, 0.6f});
    const std::vector<uint8_t> rgb = Draw(town, frame, {.samples = 1});
    const auto light = [&](int x) { return static_cast<int>(Pixel(rgb, x, kHeight / 2).r); };
    const int left = light(20), right = light(kWidth - 20);
    ASSERT_GT(std::abs(left - right), 40) << edge.distance_m;
    int between = 0;
    for (int x = 20; x < kWidth - 20; ++x) between += std::abs(light(x) - left) > 8 && std::abs(light(x) - right) > 8;
    EXPECT_LE(static_cast<float>(between) * 3 / kWidth, edge.most_m) << edge.distance_m;
  }
}

// Where no sun falls people would float: the ground about their feet is a little darker, on slopes too, and nothing
// else is.
TEST_F(Drawing, FeetShadeTheGroundAboutThem) {
  for (const float rise : {0.0f, 0.25f}) {
    TourPack pack = MakePack({});
    pack.avatars[0].radius_m = 0.35f;
    pack.materials.push_back({"grey", {0.4f, 0.4f, 0.4f, 1}, -1, false, false, 0.5f});
    PackPrimitive ground;
    ground.material = 1;
    ground.positions = {{-30, -30 * rise, -30}, {-30, -30 * rise, 30}, {30, 30 * rise, 30}, {30, 30 * rise, -30}};
    ground.normals.assign(4, Normalized(Vec3{-rise, 1, 0}));
    ground.indices = {0, 1, 2, 0, 2, 3};
    pack.meshes.push_back({{ground}});
    pack.town.push_back({"ground", 2, {}});
    FrameInput frame = LookEast();
    frame.eye.z = 3;
    frame.pitch_rad = -0.4f;
    for (const int samples : {1, 4}) {
      for (const int level : {0, -1}) {
        frame.people = {PersonAt(6, 0, level)};
        frame.people[0].position.z = 6 * rise;
        frame.people[0].slope = {rise, 0};
        frame.people[0].casts_shadow = false;
        frame.contact_shade = 0;
        const std::vector<uint8_t> without = Draw(pack, frame, {.samples = samples});
        frame.contact_shade = 0.3f;
        const std::vector<uint8_t> with = Draw(pack, frame, {.samples = samples});
        int darker = 0, most = 0;
        for (int y = 0; y < kHeight; ++y) {
          for (int x = 0; x < kWidth; ++x) {
            if (IsRed(Pixel(without, x, y))) continue;
            const int by = Pixel(without, x, y).g - Pixel(with, x, y).g;
            darker += by > 8, most = std::max(most, by);
          }
        }
        SCOPED_TRACE(testing::Message() << "rise " << rise << ", samples " << samples << ", level " << level);
        EXPECT_GT(darker, 40);
        EXPECT_LT(darker, 1500);
        EXPECT_LT(most, 80) << "faint";
      }
    }
  }
}

// A made-up row of two houses and a tree on a slope of bare ground, from above: darker at the foot of walls, nowhere
// else, no darker where the houses meet, and not where the ground brings shade of its own.
TEST_F(Drawing, WallsShadeTheGroundAtTheirFeet) {
  for (const float rise : {0.0f, 0.1f}) {
    TourPack pack = MakePack({});
    pack.materials.push_back({"grey", {0.4f, 0.4f, 0.4f, 1}, -1, false, false, 0.5f});
    PackPrimitive ground;
    ground.material = 1;
    ground.positions = {{-30, -30 * rise, -30}, {-30, -30 * rise, 30}, {30, 30 * rise, 30}, {30, 30 * rise, -30}};
    ground.normals.assign(4, Normalized(Vec3{-rise, 1, 0}));
    ground.indices = {0, 1, 2, 0, 2, 3};
    pack.meshes.push_back({{ground}});
    pack.town.push_back({"ground", 2, {}});
    pack.obstacles.polygons = {{{{3, 0}, {6, 0}, {6, 5}, {3, 5}}, {}}, {{{3, -5}, {3, 0}, {6, 0}, {6, -5}}, {}}};
    pack.obstacles.circles = {{{-1, 0}, 0.3f}};
    GroundRaster raster{{-30, -30}, 0.5f, 120, 120, {}, {}};
    raster.kind.assign(120 * 120, 1);
    for (int cell = 0; cell < 120 * 120; ++cell)
      raster.height_m.push_back((-30 + (static_cast<float>(cell % 120) + 0.5f) / 2) * rise);
    pack.ground = Share(raster);
    FrameInput frame;
    frame.eye = {2.5f, 0, 40};
    frame.pitch_rad = -1.55f;
    frame.fov_rad = 0.6f;
    frame.to_sun = Normalized(Vec3{0.2f, 0, 1});
    const Vec3 ahead{std::cos(frame.pitch_rad), 0, std::sin(frame.pitch_rad)}, up{-ahead.z, 0, ahead.x};
    const auto darker = [&](const std::vector<uint8_t>& without, const std::vector<uint8_t>& with, Vec2 at) {
      const Vec3 to = Vec3{at.x, at.y, rise * at.x} - frame.eye;
      const float scale = kWidth / 2 / (Dot(to, ahead) * std::tan(frame.fov_rad / 2));
      const int x = kWidth / 2 + static_cast<int>(std::floor(-to.y * scale));
      const int y = kHeight / 2 - static_cast<int>(std::ceil(Dot(to, up) * scale));
      return Pixel(without, x, y).g - Pixel(with, x, y).g;
    };
    for (const int samples : {1, 4}) {
      SCOPED_TRACE(testing::Message() << "rise " << rise << ", samples " << samples);
      const RenderOptions options{.samples = samples};
      frame.contact_shade = 0;
      const std::vector<uint8_t> without = Draw(pack, frame, options);
      frame.contact_shade = 0.3f;
      const std::vector<uint8_t> with = Draw(pack, frame, options);
      const auto darker_at = [&](float x, float y) { return darker(without, with, {x, y}); };
      const int at_wall = darker_at(2.88f, 2.5f);
      EXPECT_GT(at_wall, 12);
      EXPECT_LT(at_wall, 70) << "faint";
      EXPECT_NEAR(darker_at(2.88f, 0), at_wall, 6) << "where the houses meet";
      EXPECT_NEAR(darker_at(6.12f, -2.5f), at_wall, 8) << "on the other side";
      EXPECT_GT(darker_at(-0.6f, 0), 8) << "the tree";
      EXPECT_LT(darker_at(2.7f, 2.5f), at_wall) << "it ends";
      EXPECT_EQ(darker_at(2.3f, 2.5f), 0) << "0.7 m away";
      EXPECT_EQ(darker_at(1, -3), 0) << "in the open";
      if (samples > 1) continue;
      TourPack shaded = pack;
      shaded.meshes[2].primitives[0].colors = {{1, 1, 1, 1}, {1, 1, 1, 1}, {0.5f, 0.5f, 0.5f, 1}, {1, 1, 1, 1}};
      const std::vector<uint8_t> own = Draw(shaded, frame, options);
      frame.contact_shade = 0;
      EXPECT_EQ(Draw(shaded, frame, options), own) << "the town's own shade";
    }
  }
}

// The face of a clock looks at the eye; its hand is a red board from the middle upwards.
TEST_F(Drawing, PartsOfTheTownTurn) {
  TourPack pack = MakePack({});
  PackPrimitive hand;
  hand.material = 0;
  hand.positions = {{-0.1f, 0, 0}, {0.1f, 0, 0}, {0.1f, 1, 0}, {-0.1f, 1, 0}};
  hand.normals.assign(4, {0, 0, 1});
  hand.indices = {0, 1, 2, 0, 2, 3};
  pack.meshes.push_back({{hand}});
  const Quat to_west{0, -std::sqrt(0.5f), 0, std::sqrt(0.5f)};
  pack.turning = {{TurnsBy::kHourHand, {8, 0, 1.6f}, {-1, 0, 0}, kPi}};
  pack.town.push_back({"hand", 2, FromTranslationRotationScale({8, 1.6f, 0}, to_west, {1, 1, 1}), 0});
  FrameInput frame = LookEast();
  const float metre_px = kWidth / 2 / std::tan(frame.fov_rad / 2) / 8;
  const auto red_at = [&](const std::vector<uint8_t>& rgb, float right_m, float up_m) {
    return IsRed(
        Pixel(rgb, kWidth / 2 + static_cast<int>(right_m * metre_px), kHeight / 2 - static_cast<int>(up_m * metre_px)));
  };
  for (const int samples : {1, 4}) {
    for (const bool cull : {true, false}) {
      const RenderOptions options{.samples = samples, .cull = cull};
      SCOPED_TRACE(testing::Message() << "samples " << samples << ", cull " << cull);
      frame.turns_rad = {};
      EXPECT_TRUE(red_at(Draw(pack, frame, options), 0, 0.7f)) << "as modelled";
      frame.turns_rad = {-kPi / 2};
      const std::vector<uint8_t> at_three = Draw(pack, frame, options);
      EXPECT_TRUE(red_at(at_three, 0.7f, 0)) << "clockwise";
      EXPECT_FALSE(red_at(at_three, 0, 0.7f));
      EXPECT_FALSE(red_at(at_three, -0.7f, 0));
      frame.turns_rad = {-kPi * 1.5f};
      EXPECT_TRUE(red_at(Draw(pack, frame, options), -0.7f, 0));
    }
  }
}

TEST_F(Drawing, WhoIsBeyondTheReachOfShadowsCastsNone) {
  const TourPack pack = MakePack({});
  FrameInput frame = LookEast();
  frame.people = {PersonAt(6, 0, 0), PersonAt(20, 0, 0)};
  Draw(pack, frame);
  const int64_t both = statistics_.people_shadow_triangles;
  frame.shadow_reach_m = 12;
  Draw(pack, frame);
  EXPECT_GT(statistics_.people_shadow_triangles, 0);
  EXPECT_LT(statistics_.people_shadow_triangles, both);
  frame.shadow_reach_m = 0;
  Draw(pack, frame);
  EXPECT_EQ(statistics_.people_shadow_triangles, 0);
}

TEST_F(Drawing, ACaptionStandsAtTheFootAndNowhereElse) {
  const TourPack pack = MakePack({});
  FrameInput frame = LookEast();
  const std::vector<uint8_t> without = Draw(pack, frame);
  frame.caption = "The well has never run dry, so they say: draw from it and see for yourself.";
  const std::vector<uint8_t> with = Draw(pack, frame);
  const size_t upper = static_cast<size_t>(kWidth * kHeight / 2) * 3;
  EXPECT_TRUE(std::equal(with.begin(), with.begin() + static_cast<std::ptrdiff_t>(upper), without.begin()));
  int bright = 0, dark = 0;
  for (int x = 0; x < kWidth; ++x) {
    for (int y = kHeight - 30; y < kHeight; ++y) {
      bright += Pixel(with, x, y).g > 200;
      dark += Pixel(with, x, y).g < Pixel(without, x, y).g / 2 + 20;
    }
  }
  EXPECT_GT(bright, 200);
  EXPECT_GT(dark, 3000);
  frame.caption_share = 0;
  EXPECT_EQ(Draw(pack, frame), without);
}

TEST(Caption, WrapsWordsOverAsManyLinesAsItNeeds) {
  Fonts fonts;
  EXPECT_EQ(LayOutCaption("", {}, 1280, 720, &fonts).height_px, 0);
  EXPECT_EQ(LayOutCaption("well", {}, 40, 30, &fonts).height_px, 0);
  const PackImage one = LayOutCaption("Der Marktplatz: \xC3\xBC\xC3\xA4\xC3\x9F \xFF", {}, 1280, 720, &fonts);
  const PackImage more = LayOutCaption(
      "The market square. The stalls open at six; the well has never run dry, or so they say.", {}, 1280, 720, &fonts);
  EXPECT_EQ(one.width_px, 1280);
  EXPECT_GT(more.height_px, one.height_px * 3 / 2);
  for (const PackImage* image : {&one, &more}) {  // no letter touches the sides
    for (int y = 0; y < image->height_px; ++y) EXPECT_LT(image->rgba[static_cast<size_t>(y * image->width_px) * 4], 64);
  }
}

// The most opaque colour, and how many pixels are letters.
std::pair<Vec3, int> LettersOf(const PackImage& image) {
  std::pair<Vec3, int> found;
  for (size_t k = 0; k < image.rgba.size(); k += 4) {
    if (image.rgba[k] < 200) continue;
    found.first = {static_cast<float>(image.rgba[k]), static_cast<float>(image.rgba[k + 1]),
                   static_cast<float>(image.rgba[k + 2])};
    ++found.second;
  }
  return found;
}

TEST(Caption, IsLargerAndWithoutTranslucencyForWhoeverAsksForIt) {
  Fonts fonts;
  const std::string text = "The market square.";
  const PackImage usual = LayOutCaption(text, {"en", 1, false}, 1280, 720, &fonts);
  const PackImage large = LayOutCaption(text, {"en", 1.6f, true}, 1280, 720, &fonts);
  EXPECT_GT(large.height_px, usual.height_px * 4 / 3);
  EXPECT_GT(LettersOf(large).second, LettersOf(usual).second * 2);
  EXPECT_LT(usual.rgba[3], 255);
  for (size_t k = 3; k < large.rgba.size(); k += 4) ASSERT_EQ(large.rgba[k], 255);
  const Vec3 yellow = LettersOf(large).first;
  EXPECT_GT(yellow.x, 220);
  EXPECT_LT(yellow.z, 100);
}

TEST(Caption, OnOneSideLeavesTheRestOfThePictureFree) {
  Fonts fonts;
  for (const int side : {-1, 1}) {
    for (const char* text :
         {"Next: the well", "The market square. The stalls open at six; the well has never run dry."}) {
      const PackImage image = LayOutCaption(text, {"en", 1, false, side}, 1280, 720, &fonts);
      ASSERT_GT(image.height_px, 0);
      for (int x = 0; x < 1280; ++x) {
        const bool beyond = side < 0 ? x > 1280 * 0.64f : x < 1280 * 0.36f;
        for (int y = 0; y < image.height_px && beyond; ++y)
          ASSERT_EQ(image.rgba[static_cast<size_t>(y * 1280 + x) * 4 + 3], 0) << x << ' ' << text;
      }
      EXPECT_GT(LettersOf(image).second, 100);
    }
  }
}

TEST(Caption, LeavesHalfOfThePictureFreeHoweverMuchItSays) {
  Fonts fonts;
  std::string text;
  for (int k = 0; k < 60; ++k) text += "The stalls open at six; the well has never run dry. ";
  for (const auto& [width_px, height_px] : {std::pair{800, 600}, std::pair{1280, 720}, std::pair{720, 1280}}) {
    const PackImage image = LayOutCaption(text, {"en", 1.65f, false}, width_px, height_px, &fonts);
    EXPECT_LE(image.height_px, height_px * 0.53f) << width_px;
    EXPECT_GT(image.height_px, height_px / 3) << width_px;
  }
}

TEST(Caption, BeginsAtTheRightInArabic) {
  Fonts fonts;
  const std::string text =
      "ساحة السوق. تفتح الأكشاك في الساعة السادسة صباحا، ولم تجف البئر قط منذ أن حفرت في وسط المدينة.\nنعم";
  const PackImage image = LayOutCaption(text, {"ar", 1, false}, 1280, 720, &fonts);
  int left = 0, right = 0;  // of the last line, which is short
  for (int y = image.height_px * 3 / 4; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      const bool letter = image.rgba[static_cast<size_t>(y * image.width_px + x) * 4] > 200;
      (x < image.width_px / 2 ? left : right) += letter;
    }
  }
  EXPECT_EQ(left, 0);
  EXPECT_GT(right, 20);
}

// A wall of 8 x 4 m, 10 m before the eye, and boxes of 1 m beside, above, behind and before it.
TEST(Occlusion, HidesWhatIsBehindAWallAndNothingElse) {
  const Mat4 view = Perspective(1.2f, 16.0f / 9, 0.1f, 500) * LookMatrix({0, 0, 0}, {0, 0, -1}, {0, 1, 0});
  const auto box = [](float x, float y, float z) {
    return Box{{x - 0.5f, y - 0.5f, z - 0.5f}, {x + 0.5f, y + 0.5f, z + 0.5f}};
  };
  const std::vector<Vec3> wall{{-4, -2, -10}, {4, -2, -10}, {4, 2, -10}, {-4, -2, -10}, {4, 2, -10}, {-4, 2, -10}};
  const std::vector<Vec3> from_behind(wall.rbegin(), wall.rend());
  OcclusionMap map;
  ClearOcclusion(view, &map);
  const std::vector<uint32_t> corners{0, 1, 2, 3, 4, 5};
  AddWalls(from_behind, corners, &map);  // not drawn, hides nothing
  FinishOcclusion(&map);
  EXPECT_TRUE(MayBeSeen(map, box(0, 0, -20), true));
  AddWalls(wall, corners, &map);
  FinishOcclusion(&map);
  for (bool finished : {false, true}) {
    EXPECT_FALSE(MayBeSeen(map, box(0, 0, -20), finished));
    EXPECT_FALSE(MayBeSeen(map, box(5, 2, -20), finished));
    EXPECT_TRUE(MayBeSeen(map, box(8, 0, -20), finished));  // looks out at the side: the wall ends at 8 m there
    EXPECT_TRUE(MayBeSeen(map, box(0, 4, -20), finished));  // above it
    EXPECT_TRUE(MayBeSeen(map, box(0, 0, -9), finished));   // before it
    EXPECT_TRUE(MayBeSeen(map, box(0, 0, -10), finished));  // in it
    EXPECT_TRUE(MayBeSeen(map, box(0, 0, 0), finished));    // around the eye
  }
}

TEST(Occlusion, AWallThatTheEyeStandsBesideHidesToo) {
  const Mat4 view = Perspective(1.2f, 16.0f / 9, 0.1f, 500) * LookMatrix({0, 0, 0}, {0, 0, -1}, {0, 1, 0});
  OcclusionMap map;
  ClearOcclusion(view, &map);
  // From 5 m behind the eye to 40 m ahead, 1 m to the left, seen from the right.
  AddWalls(std::vector<Vec3>{{-1, -30, 5}, {-1, -30, -40}, {-1, 30, -40}, {-1, 30, 5}},
           std::vector<uint32_t>{0, 1, 2, 0, 2, 3}, &map);
  FinishOcclusion(&map);
  EXPECT_FALSE(MayBeSeen(map, {{-9, -1, -20}, {-8, 1, -19}}, true));
  EXPECT_TRUE(MayBeSeen(map, {{1, -1, -20}, {2, 1, -19}}, true));
}

// Where the eye at 0 that looks along -z sees a point, in pixels of a picture of 64 x 36.
Vec2 Pixel(const Mat4& view, Vec3 p) {
  const auto row = [&](size_t r) {
    return view.m[0][r] * p.x + view.m[1][r] * p.y + view.m[2][r] * p.z + view.m[3][r];
  };
  return {(row(0) / row(3) + 1) * 32, (row(1) / row(3) + 1) * 18};
}

bool ReachesAMiddle(Vec2 a, Vec2 b, Vec2 c) {
  for (int i = 0; i < 64 * 36; ++i) {
    const Vec2 p{static_cast<float>(i % 64) + 0.5f, static_cast<float>(i / 64) + 0.5f};
    const float u = Cross(b - a, p - a), v = Cross(c - b, p - b), w = Cross(a - c, p - c);
    if ((u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0)) return true;
  }
  return false;
}

TEST(VisibleTriangles, WhatReachesAPixelsMiddleIsSeenAndMostOfTheRestIsNot) {
  const Mat4 view = Perspective(1.2f, 16.0f / 9, 0.1f, 500) * LookMatrix({0, 0, 0}, {0, 0, -1}, {0, 1, 0});
  OcclusionMap map;
  ClearOcclusion(view, &map);
  FinishOcclusion(&map);
  const TriangleSight sight{64, 36, &map};
  std::mt19937 random(5);
  const auto number = [&](float low, float high) {
    return low + (high - low) * static_cast<float>(random() % 10000) / 10000;
  };
  int seen_in_vain = 0, unseen = 0;
  for (int k = 0; k < 4000; ++k) {
    const Vec3 a{number(-12, 12), number(-7, 7), number(-20, -2)};
    const float reach_m = k % 2 == 0 ? 0.2f : 3.0f;
    const auto beside = [&] {
      return a + Vec3{number(-reach_m, reach_m), number(-reach_m, reach_m), number(-0.5f, 0.5f)};
    };
    const std::array<Vec3, 3> t{a, beside(), beside()};
    const bool reaches = ReachesAMiddle(Pixel(view, t[0]), Pixel(view, t[1]), Pixel(view, t[2])),
               seen = MayBeSeen(t, sight);
    EXPECT_TRUE(seen || !reaches) << k;
    unseen += !reaches;
    seen_in_vain += seen && !reaches;
  }
  EXPECT_GT(unseen, 1000);
  EXPECT_LT(seen_in_vain, unseen / 10);
  EXPECT_TRUE(MayBeSeen({{{-1, -1, 1}, {1, -1, 1}, {0, 0, -5}}}, sight));  // from behind the eye
}

TEST(VisibleTriangles, AWallHidesWhatIsBehindItButNotWhatLiesOnIt) {
  const Mat4 view = Perspective(1.2f, 16.0f / 9, 0.1f, 500) * LookMatrix({0, 0, 0}, {0, 0, -1}, {0, 1, 0});
  OcclusionMap map;
  ClearOcclusion(view, &map);
  AddWalls(std::vector<Vec3>{{-4, -2, -10}, {4, -2, -10}, {4, 2, -10}, {-4, 2, -10}},
           std::vector<uint32_t>{0, 1, 2, 0, 2, 3}, &map);
  FinishOcclusion(&map);
  const auto at = [](float x, float z) {
    return std::array<Vec3, 3>{{{x, -0.5f, z}, {x + 1, -0.5f, z}, {x, 0.5f, z}}};
  };
  const TriangleSight sight{1280, 720, &map};
  EXPECT_FALSE(MayBeSeen(at(0, -12), sight));
  EXPECT_TRUE(MayBeSeen(at(0, -10), sight));
  EXPECT_TRUE(MayBeSeen(at(0, -9), sight));
  EXPECT_TRUE(MayBeSeen(at(4.5f, -12), sight));  // looks out at the side
  EXPECT_FALSE(MayBeSeen(at(12, -12), sight));   // beside the view
}

TEST(SurfacePlan, PicturesOfOneSizeShareAnArrayAndSurfacesOfOneKindAGroup) {
  TourPack pack = MakePack({{11, 3}});
  pack.images = {{512, 512, {}}, {300, 512, {}}, {1024, 7, {}}, {9000, 9000, {}}};
  for (int i = 0; i < 4; ++i) {
    pack.materials.push_back({"m", {1, 1, 1, 1}, i, false, false, 0.5f});
    pack.meshes[1].primitives.push_back(BoxPrimitive({0, 0, 0}, {1, 1, 1}, i + 1, false));
  }
  const SurfacePlan plan = PlanSurfaces(pack, {1024, 512});
  ASSERT_EQ(plan.arrays.size(), 2u);
  EXPECT_EQ(plan.arrays[0].side_px, 512);
  EXPECT_EQ(plan.arrays[0].layers, 2);
  EXPECT_EQ(plan.arrays[1].side_px, 1024);
  EXPECT_EQ(plan.groups.size(), 2u);
  EXPECT_NE(plan.pictures[0].layer, plan.pictures[1].layer);
  EXPECT_EQ(SurfaceOf(-1, plan).layer, -1);
  const PackImage wide{2, 1, {0, 0, 0, 255, 255, 255, 255, 255}};
  const std::vector<PackImage> levels = PreparePicture(wide, 64);
  ASSERT_EQ(levels.size(), 7u);
  EXPECT_LT(levels[0].rgba[static_cast<size_t>(32 * 64 + 16) * 4], 40);
  EXPECT_GT(levels[0].rgba[static_cast<size_t>(32 * 64 + 48) * 4], 215);
  EXPECT_EQ(levels.back().width_px, 1);

  PackImage large{128, 128, std::vector<uint8_t>(128 * 128 * 4, 255)};
  for (size_t i = 0; i < 128 * 64 * 4; ++i) large.rgba[i] = 40;
  const std::vector<PackImage> halves = PreparePicture(large, 64);
  ASSERT_EQ(halves.size(), 7u);
  EXPECT_EQ(halves[0].rgba, MakeMipChain(large, true, 1).back().rgba);
  EXPECT_EQ(halves[0].rgba[0], 40);
  EXPECT_EQ(halves[0].rgba[static_cast<size_t>(63 * 64) * 4], 255);
}

TEST(SurfacePlan, PicturesThatCutOutKeepTheirAlphaWhereOthersAreBlocks) {
  TourPack pack = MakePack({});
  pack.images = {{512, 512, {}}, {512, 512, {}}};
  for (int i = 0; i < 2; ++i) pack.materials.push_back({"m", {1, 1, 1, 1}, i, false, i == 1, 0.5f});
  const SurfacePlan plan = PlanSurfaces(pack, {1024, 512, true});
  EXPECT_TRUE(plan.arrays[static_cast<size_t>(plan.pictures[0].array)].blocks);
  EXPECT_FALSE(plan.arrays[static_cast<size_t>(plan.pictures[1].array)].blocks);
}

// A block by its definition: two ends of 5, 6 and 5 bits, and which of four mixtures of them each texel is.
std::array<double, 3> TexelOfBc1(const uint8_t* block, size_t texel) {
  const auto end = [&](size_t k) {
    const int bits = block[2 * k] | block[2 * k + 1] << 8;
    return std::array<double, 3>{(bits >> 11) * 255.0 / 31, (bits >> 5 & 63) * 255.0 / 63, (bits & 31) * 255.0 / 31};
  };
  constexpr double kSecond[] = {0, 1, 1.0 / 3, 2.0 / 3};
  const double second = kSecond[block[4 + texel / 4] >> 2 * (texel % 4) & 3];
  const std::array<double, 3> a = end(0), b = end(1);
  return {a[0] + second * (b[0] - a[0]), a[1] + second * (b[1] - a[1]), a[2] + second * (b[2] - a[2])};
}

TEST(BlockPicture, ColoursStayWithinAFewSteps) {
  PackImage image{6, 5, {}};  // blocks reach beyond it
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 6; ++x)
      image.rgba.insert(image.rgba.end(),
                        {static_cast<uint8_t>(90 + 12 * x), static_cast<uint8_t>(60 + 8 * x), 40, 255});
  }
  const std::vector<uint8_t> blocks = Bc1Blocks(image);
  ASSERT_EQ(blocks.size(), 4u * 8);
  for (size_t y = 0; y < 5; ++y) {
    for (size_t x = 0; x < 6; ++x) {
      const std::array<double, 3> texel = TexelOfBc1(&blocks[8 * (2 * (y / 4) + x / 4)], 4 * (y % 4) + x % 4);
      for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(texel[c], image.rgba[4 * (6 * y + x) + c], 8) << x << ", " << y;
    }
  }
}

TEST(ShadowGeometry, IsMuchSmallerAndStaysInShape) {
  TourPack pack = MakePack({});
  PackPrimitive& p = pack.meshes[0].primitives[0];
  p = {};
  const int around = 64, up = 40;
  for (int j = 0; j <= up; ++j) {
    for (int i = 0; i < around; ++i) {
      const float a = 2 * kPi * static_cast<float>(i) / around;
      p.positions.push_back({0.3f * std::cos(a), 1.8f * static_cast<float>(j) / up, 0.3f * std::sin(a)});
      p.normals.push_back({std::cos(a), 0, std::sin(a)});
      if (j == up) continue;
      const auto at = [&](int x, int y) { return static_cast<uint32_t>(y * around + x % around); };
      for (uint32_t corner : {at(i, j), at(i + 1, j), at(i, j + 1), at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)})
        p.indices.push_back(corner);
    }
  }
  const PersonGeometry whole = BuildPersonGeometry(pack, pack.meshes[0], PlanSurfaces(pack, {})),
                       shadow = ShadowGeometry(whole, 0.16f, 1000);
  EXPECT_LT(shadow.indices.size(), whole.indices.size() / 10);
  EXPECT_LE(ShadowGeometry(whole, 0.01f, 100).indices.size() / 3, 100u) << "whatever the cells";
  Box box;
  for (uint32_t i : shadow.indices) Include(shadow.vertices[i].position, &box);
  EXPECT_NEAR(box.high.y, 1.8f, 0.1f);
  EXPECT_NEAR(box.high.x - box.low.x, 0.6f, 0.1f);
}

// Of legs thinner than its cells nothing was left: people 20 m away stood beside the shadow of their trunk.
TEST(ShadowGeometry, KeepsThinLegsFromWhereverTheSunShines) {
  TourPack pack = MakePack({});
  PackPrimitive& p = pack.meshes[0].primitives[0];
  p = {};
  const auto add_tube = [&p](Vec3 foot, float height_m, float radius_m, uint16_t joint) {
    constexpr int kAround = 12, kUp = 6;
    const auto first = static_cast<uint32_t>(p.positions.size());
    for (int j = 0; j <= kUp; ++j) {
      for (int i = 0; i < kAround; ++i) {
        const float a = 2 * kPi * static_cast<float>(i) / kAround;
        p.positions.push_back(
            foot + Vec3{radius_m * std::cos(a), height_m * static_cast<float>(j) / kUp, radius_m * std::sin(a)});
        p.normals.push_back({std::cos(a), 0, std::sin(a)});
        p.joints.push_back({joint, 0, 0, 0});
        p.weights.push_back({255, 0, 0, 0});
        if (j == kUp) continue;
        const auto at = [&](int x, int y) { return first + static_cast<uint32_t>(y * kAround + x % kAround); };
        for (const uint32_t corner :
             {at(i, j), at(i + 1, j), at(i, j + 1), at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)})
          p.indices.push_back(corner);
      }
    }
  };
  add_tube({0, 0.85f, 0}, 0.9f, 0.2f, 0);
  for (const float side : {-0.1f, 0.1f}) {
    add_tube({side, 0, 0.03f}, 0.43f, 0.05f, side < 0 ? 1 : 2);
    add_tube({side, 0.43f, 0.03f}, 0.42f, 0.07f, side < 0 ? 3 : 4);
  }
  const PersonGeometry whole = BuildPersonGeometry(pack, pack.meshes[0], PlanSurfaces(pack, {})),
                       shadow = ShadowGeometry(whole, 0.34f, 96);
  EXPECT_LE(shadow.indices.size() / 3, 96u);
  for (const uint16_t joint : {1, 2, 3, 4}) {
    const auto area_from = [joint](const PersonGeometry& of, Vec3 sun) {
      float area = 0;
      for (size_t i = 0; i + 2 < of.indices.size(); i += 3) {
        const PersonVertex &a = of.vertices[of.indices[i]], &b = of.vertices[of.indices[i + 1]],
                           &c = of.vertices[of.indices[i + 2]];
        if (a.joints[0] == joint && b.joints[0] == joint && c.joints[0] == joint)
          area += std::abs(Dot(Cross(b.position - a.position, c.position - a.position), sun)) / 2;
      }
      return area;
    };
    for (const float turn_rad : {0.0f, 0.5f, 0.8f, 1.6f}) {
      const Vec3 sun{std::cos(turn_rad), 0, std::sin(turn_rad)};
      EXPECT_GT(area_from(shadow, sun), 0.6f * area_from(whole, sun) / 2) << joint << ": " << turn_rad;  // it is closed
    }
  }
  Box box;
  for (const uint32_t i : shadow.indices) Include(shadow.vertices[i].position, &box);
  EXPECT_NEAR(box.low.y, 0, 0.01f) << "down to the soles";
}

TEST(ShadowGeometry, KeepsTheBrimOfAHat) {
  TourPack pack = MakePack({});
  PackPrimitive& p = pack.meshes[0].primitives[0];
  p = {};
  const int around = 48, rings = 9;  // from the middle of the crown to a brim of 20 cm
  for (int j = 0; j < rings; ++j) {
    for (int i = 0; i < around; ++i) {
      const float a = 2 * kPi * static_cast<float>(i) / around, radius_m = 0.025f * static_cast<float>(j);
      p.positions.push_back({radius_m * std::cos(a), 1.7f + (radius_m < 0.09f ? 0.1f : 0), radius_m * std::sin(a)});
      p.normals.push_back({0, 1, 0});
      if (j + 1 == rings) continue;
      const auto at = [&](int x, int y) { return static_cast<uint32_t>(y * around + x % around); };
      for (uint32_t corner : {at(i, j), at(i + 1, j), at(i, j + 1), at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)})
        p.indices.push_back(corner);
    }
  }
  const PersonGeometry shadow =
      ShadowGeometry(BuildPersonGeometry(pack, pack.meshes[0], PlanSurfaces(pack, {})), 0.1f, 1000);
  Box box;
  for (uint32_t i : shadow.indices) Include(shadow.vertices[i].position, &box);
  EXPECT_GT(box.high.x - box.low.x, 0.38f);
  EXPECT_GT(box.high.z - box.low.z, 0.38f);
}

TEST(TownGeometry, EveryTriangleIsInOneBlockAndItsBox) {
  const TourPack pack = MakePack({{11, 3}, {-14, -4}, {60, 80}});
  const TownGeometry town = BuildTownGeometry(pack, PlanSurfaces(pack, {}));
  uint32_t next = 0;
  int64_t triangles = 0;
  for (const TownBlock& block : town.blocks) {
    for (const TownRange& range : block.ranges) {
      EXPECT_EQ(range.first, next);
      next += range.count;
      for (uint32_t i = range.first; i < next; ++i)
        EXPECT_EQ(Distance(block.box, town.vertices[town.indices[i]].position), 0);
    }
    triangles += block.triangles;
  }
  EXPECT_EQ(next, town.indices.size());
  EXPECT_EQ(triangles, 36);
}

// Opaque houses and trees that are cut out, side by side.
TourPack HousesAndTrees() {
  std::vector<Vec2> houses;
  for (int k = 0; k < 144; ++k)
    houses.push_back({10.0f * static_cast<float>(k % 12), 10.0f * static_cast<float>(k / 12) - 60});
  TourPack pack = MakePack(houses);
  pack.materials.push_back({"leaves", {0.2f, 0.6f, 0.2f, 1}, -1, true, true, 0.5f});
  pack.meshes.push_back({{BoxPrimitive({4, 0, 4}, {6, 3, 6}, static_cast<int>(pack.materials.size()) - 1, false)}});
  for (size_t k = 0, count = pack.town.size(); k < count; ++k)
    pack.town.push_back({"tree", static_cast<int>(pack.meshes.size()) - 1, pack.town[k].world});
  return pack;
}

TEST(TownGeometry, IsBuiltInPartsWhereThereAreManyTriangles) {
  TourPack pack = HousesAndTrees();
  const std::vector<TownInstance> once = pack.town;
  for (int k = 0; k < 6; ++k) pack.town.insert(pack.town.end(), once.begin(), once.end());
  const SurfacePlan plan = PlanSurfaces(pack, {});
  TownBuilder builder(pack, plan);
  int parts = 1;
  while (!builder.Advance()) ++parts;
  EXPECT_GE(parts, 4) << "two that append, two that pack";
  EXPECT_EQ(builder.Take().indices, BuildTownGeometry(pack, plan).indices);
}

TEST(TownGeometry, WhatIsCutOutStandsTogetherBehindWhatIsOpaque) {
  const TourPack pack = HousesAndTrees();
  const SurfacePlan plan = PlanSurfaces(pack, {});
  const TownGeometry town = BuildTownGeometry(pack, plan);
  std::vector<int> group_of(town.indices.size(), -1);
  for (const TownBlock& block : town.blocks) {
    for (const TownRange& range : block.ranges) {
      for (uint32_t i = range.first; i < range.first + range.count; ++i) {
        EXPECT_EQ(group_of[i], -1) << "twice";
        group_of[i] = range.group;
        EXPECT_EQ(Distance(block.box, town.vertices[town.indices[i]].position), 0);
      }
    }
  }
  bool masked = false;
  int last = -1;
  for (int group : group_of) {
    ASSERT_GE(group, 0) << "left out";
    const bool is_masked = plan.groups[static_cast<size_t>(group)].masked;
    EXPECT_TRUE(is_masked || !masked) << "opaque behind what is cut out";
    EXPECT_TRUE(!masked || group >= last);
    masked = is_masked;
    last = group;
  }
  EXPECT_TRUE(masked);
}

TEST_F(Drawing, ATownWithManyTreesThatAreCutOutTakesFewDrawCalls) {
  FrameInput frame = LookEast();
  frame.to_sun = Normalized(Vec3{-0.5f, 0.4f, 0.6f});
  Draw(HousesAndTrees(), frame);
  EXPECT_LE(statistics_.draw_calls, 64) << "all shadows among them";
}

PeopleSight EverywhereSeen() {
  PeopleSight sight;
  sight.eye = {0, 1.6f, 0};
  sight.to_sun = {0, 1, 0};
  for (Vec4& plane : sight.frustum) plane = {0, 0, 0, 1};
  sight.shadow_reach_m = 40;
  return sight;
}

TEST(PeopleBatches, WhatHasNotComeYetIsDrawnByTheNearestLevelThatHas) {
  const AvatarLayout avatar = LayoutOf(BoxPerson());
  const std::vector<DrawnPerson> people{PersonAt(5, 0, 0), PersonAt(9, 0, -1)};
  const auto levels_with = [&](bool fine, bool coarse, bool impostor) {
    PeopleBatches batches;
    batches.pose_width = 3;
    SortPeople(people, {avatar}, {{{fine, coarse}, impostor, false}}, EverywhereSeen(), &batches);
    std::vector<int> levels;
    for (const PeopleBatch& b : batches.seen) levels.insert(levels.end(), b.count, b.level);
    return levels;
  };
  EXPECT_EQ(levels_with(true, true, true), (std::vector<int>{0, -1}));
  EXPECT_EQ(levels_with(false, true, true), (std::vector<int>{1, -1}));
  EXPECT_EQ(levels_with(false, true, false), (std::vector<int>{1, 1}));
  EXPECT_EQ(levels_with(false, false, true), (std::vector<int>{-1, -1}));
  EXPECT_TRUE(levels_with(false, false, false).empty());
}

TEST(PeopleBatches, InACoarsePictureTheMeshThatServesAtItsSizeIsEnough) {
  AvatarLayout avatar = LayoutOf(BoxPerson());
  avatar.height_m = 1.8f;
  avatar.switch_px = {100, 0};
  const std::vector<DrawnPerson> people{PersonAt(5, 0, 0), PersonAt(9, 0, 1), PersonAt(12, 0, -1)};
  const auto levels_at = [&](float focal_px) {
    PeopleSight sight = EverywhereSeen();
    sight.focal_px = focal_px;
    PeopleBatches batches;
    batches.pose_width = 3;
    SortPeople(people, {avatar}, {{{true, true}, true, false}}, sight, &batches);
    std::vector<int> levels;
    for (const PeopleBatch& b : batches.seen) levels.insert(levels.end(), b.count, b.level);
    return levels;
  };
  EXPECT_EQ(levels_at(0), (std::vector<int>{0, 1, -1}));
  EXPECT_EQ(levels_at(400), (std::vector<int>{0, 1, -1})) << "144 px high";
  EXPECT_EQ(levels_at(200), (std::vector<int>{1, 1, -1})) << "72 px high";
}

TEST(PeopleBatches, ShadowsAreThoseOfWhoCanBeSeenOrTheirShadowAndCoarserBeyondTheFineOnes) {
  OcclusionMap map;
  const Mat4 view = Perspective(1.2f, 16.0f / 9, 0.1f, 500) * LookMatrix({0, 1.6f, 0}, {1, 0, 0}, {0, 1, 0});
  ClearOcclusion(view, &map);
  AddWalls(std::vector<Vec3>{{10, 0, -4}, {10, 0, 4}, {10, 5, 4}, {10, 5, -4}}, std::vector<uint32_t>{0, 1, 2, 0, 2, 3},
           &map);
  FinishOcclusion(&map);
  PeopleSight sight{{0, 1.6f, 0}, {0, 1, 0}, FrustumOf(view), &map, 50, 0, 6};
  PeopleBatches batches;
  batches.pose_width = 3;
  const std::vector<DrawnPerson> people{PersonAt(4, 0, 0), PersonAt(8, 0, 0), PersonAt(14, 0, 0)};
  const auto shadows = [&] {
    SortPeople(people, {LayoutOf(BoxPerson())}, {{{true, true}, true, true}}, sight, &batches);
    std::vector<int> levels;
    for (const PeopleBatch& b : batches.shadows[0]) levels.insert(levels.end(), b.count, b.level);
    return levels;
  };
  EXPECT_EQ(shadows(), (std::vector<int>{0, 1})) << "the third is behind the wall";
  sight.to_sun = Normalized(Vec3{1, 0.3f, 0});
  EXPECT_EQ(shadows(), (std::vector<int>{0, 1, 1})) << "but now throws a shadow before it";
  sight.fine_shadow_m = 12;
  EXPECT_EQ(shadows(), (std::vector<int>{0, 0, 1}));
}

TEST(PeopleBatches, ImpostorsShowTheClipThatThePersonIsIn) {
  PackAvatar avatar = BoxPerson();
  avatar.impostor.directions = 4;
  avatar.impostor.elevations_deg = {0};
  avatar.impostor.clips = {{"walk", 0, 8}, {"idle", 8, 2}};
  const auto frame_of = [&](const ClipMoment& moment, const ClipMoment& other, float other_share) {
    DrawnPerson person = PersonAt(9, 0, -1);
    person.moment = moment;
    person.other = other;
    person.other_share = other_share;
    PeopleBatches batches;
    batches.pose_width = 3;
    SortPeople({person}, {LayoutOf(avatar)}, {{{true, true}, true, true}}, EverywhereSeen(), &batches);
    return static_cast<int>(batches.instances.at(0).look.x) / avatar.impostor.directions;
  };
  const ClipMoment walking{ClipKind::kWalk, 0.25f}, standing{ClipKind::kIdle, 0.5f}, talking{ClipKind::kTalk, 0.5f};
  EXPECT_EQ(frame_of(walking, standing, 0.4f), 2) << "walks on until it stands more than walks";
  EXPECT_EQ(frame_of(walking, standing, 0.6f), 9);
  EXPECT_EQ(frame_of(standing, walking, 0), 9);
  EXPECT_EQ(frame_of(talking, walking, 0), 9) << "talks as it stands";
  avatar.impostor.clips.pop_back();
  EXPECT_EQ(frame_of(standing, walking, 0), 0) << "does not walk on the spot";
}

TEST(PeopleBatches, OnlyTheAvatarsWithMostNearImpostorsHaveDrawsOfTheirOwnForThem) {
  constexpr int kAvatars = 11;
  std::vector<AvatarLayout> avatars(kAvatars, LayoutOf(BoxPerson()));
  const std::vector<AvatarReady> ready(kAvatars, {{true, true}, true, false});
  std::vector<DrawnPerson> people;
  for (int a = 0; a < kAvatars; ++a) {
    for (int k = 0; k <= a + 1; ++k) {
      people.push_back(PersonAt(k < a + 1 ? 9 : 30, static_cast<float>(k) * 0.1f, -1));  // one far, a + 1 near
      people.back().avatar = a;
    }
  }
  PeopleBatches batches;
  batches.pose_width = 3;
  SortPeople(people, avatars, ready, EverywhereSeen(), &batches);
  ASSERT_EQ(batches.seen.size(), static_cast<size_t>(5 + kAvatars));
  size_t drawn = 0;
  for (size_t k = 0; k < batches.seen.size(); ++k) {
    drawn += batches.seen[k].count;
    EXPECT_EQ(batches.seen[k].avatar, static_cast<int>(k < 5 ? k + 6 : k - 5)) << "those of 6 to 10, then all";
  }
  EXPECT_EQ(drawn, people.size());
}

TEST(PeopleBatches, MixedPosesStandBetweenTheirClips) {
  PackAvatar avatar = BoxPerson();
  avatar.idle.matrices[0].m[3] = {0, 1, 0, 1};
  DrawnPerson person = PersonAt(5, 0, 0);
  person.other.clip = ClipKind::kIdle;
  person.other_share = 0.25f;
  PeopleBatches batches;
  batches.pose_width = 3;
  SortPeople({person}, {LayoutOf(avatar)}, {{{true, true}, true, true}}, EverywhereSeen(), &batches);
  ASSERT_EQ(batches.pose_rows, 1u);
  EXPECT_NEAR(batches.poses[1].w, 0.25f, 1e-4f);  // how far up
  EXPECT_NEAR(batches.poses[1].y, 1, 1e-4f);
}

}  // namespace
}  // namespace flaneur
