// Pictures of a small made-up tour.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "runtime/render/mip_chain.h"
#include "runtime/render/projection.h"
#include "runtime/render/textures.h"
#include "tests/soak/drivers_stay_loaded.h"
#include "tests/unit/runtime/render/made_up_tour.h"

namespace flaneur {
namespace {

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

// Where the town has no ground: whoever looks out of it sees land that fades into the haze.
TEST_F(Drawing, BelowTheHorizonLiesLand) {
  TourPack pack = MakePack({});
  pack.town.clear();
  const std::vector<uint8_t> rgb = Draw(pack, LookEast());
  const Rgb haze = Pixel(rgb, kWidth / 2, kHeight / 2), half = Pixel(rgb, kWidth / 2, kHeight * 5 / 8),
            near = Pixel(rgb, kWidth / 2, kHeight - 2);
  EXPECT_GT(haze.b, haze.r) << "as the sky's";
  EXPECT_GT(near.g, near.b + 20);
  EXPECT_GT(haze.r, half.r + 10);
  EXPECT_GT(half.r, near.r);
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

class SizedPeople : public Drawing {
 protected:
  // Of somebody whose part is 1.1 and 0.9 of the model's, mesh and impostor, against the model's own.
  void ExpectAreas(float DrawnPerson::*part, double of_larger, double of_smaller, double tolerance) {
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
};

TEST_F(SizedPeople, WhoIsLargerIsDrawnLargerAtEveryLevel) { ExpectAreas(&DrawnPerson::size, 1.21, 0.81, 0.05); }

TEST_F(SizedPeople, WhoIsBroaderIsDrawnBroaderAndNoHigherAtEveryLevel) {
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

}  // namespace
}  // namespace flaneur
