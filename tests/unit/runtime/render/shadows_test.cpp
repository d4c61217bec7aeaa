// What shades what in pictures of a small made-up tour.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "runtime/render/projection.h"
#include "tests/unit/runtime/render/made_up_tour.h"

namespace flaneur {
namespace {

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

}  // namespace
}  // namespace flaneur
