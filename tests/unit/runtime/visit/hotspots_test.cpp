// Which hotspots one sees, and when they tell.
#include "runtime/visit/hotspots.h"

#include <gtest/gtest.h>

namespace flaneur {
namespace {

constexpr float kAspect = 16.0f / 9;

struct HotspotsSeen : ::testing::Test {
  Walkable walkable;
  std::vector<Hotspot> all{{{10, 0}, 1.65f, 15}};
  FrameInput frame;
  Hotspots h;

  HotspotsSeen() {
    GroundRaster g{{-20, -20}, 1, 60, 40, std::vector<float>(2400, 2), std::vector<uint8_t>(2400, 3)};
    walkable.ground = Share(std::move(g));
    frame.eye = {0, 0, 3.65f};
    frame.fov_rad = 1.0472f;
  }
  void Begin() {
    BuildWalkable(0.3f, &walkable);
    PrepareHotspots(all, walkable, &h);
  }
  void Pass(float seconds, bool opens = true, const IsHidden& hidden = {}) {
    for (float t = 0; t < seconds; t += 0.05f) LookForHotspots(all, frame, kAspect, opens, 0.05f, hidden, &h);
  }
  void AddHouse(float x, float half_m, float deep_m) {
    walkable.polygons.push_back({{{x, -half_m}, {x + deep_m, -half_m}, {x + deep_m, half_m}, {x, half_m}}, {}});
  }
};

TEST_F(HotspotsSeen, APointIsWhereItsRayMeetsThePicture) {
  Begin();
  const Vec2 middle = PlaceInPicture(frame, kAspect, {10, 0, 3.65f}).value_or(Vec2{-9, -9});
  EXPECT_NEAR(middle.x, 0.5f, 1e-5f);
  EXPECT_NEAR(middle.y, 0.5f, 1e-5f);
  const float right_m = 10 * std::tan(frame.fov_rad / 2);
  EXPECT_NEAR(PlaceInPicture(frame, kAspect, {10, -right_m, 3.65f})->x, 1, 1e-4f) << "the right edge";
  EXPECT_NEAR(PlaceInPicture(frame, kAspect, {10, 0, 3.65f + right_m / kAspect})->y, 0, 1e-4f) << "the upper edge";
  EXPECT_FALSE(PlaceInPicture(frame, kAspect, {-10, 0, 3.65f}));
  frame.yaw_rad = kPi / 2;
  frame.pitch_rad = 0.3f;
  const Vec2 up = *PlaceInPicture(frame, kAspect, {0, 10, 3.65f + 10 * std::tan(0.3f)});
  EXPECT_NEAR(up.x, 0.5f, 1e-4f);
  EXPECT_NEAR(up.y, 0.5f, 1e-4f);
}

TEST_F(HotspotsSeen, LookingAtItForAWhileMakesItTell) {
  Begin();
  Pass(0.5f);
  ASSERT_EQ(h.seen.size(), 1u);
  EXPECT_GT(h.seen[0].interest, 0.2f);
  EXPECT_LT(h.open, 0);
  Pass(1);
  EXPECT_EQ(h.open, 0);
}

TEST_F(HotspotsSeen, WhoOnlyPassesByItWithTheEyesIsNotDisturbed) {
  Begin();
  for (int k = 0; k < 20; ++k) {
    frame.yaw_rad = 0;
    Pass(0.3f);
    frame.yaw_rad = 0.4f;
    Pass(0.3f);
  }
  EXPECT_LT(h.open, 0);
}

TEST_F(HotspotsSeen, ItEndsWhenOneLooksOrWalksAway) {
  Begin();
  Pass(2);
  ASSERT_EQ(h.open, 0);
  frame.yaw_rad = 0.3f;
  Pass(2);
  EXPECT_EQ(h.open, 0) << "still beside the middle";
  frame.yaw_rad = 1.2f;
  Pass(0.4f);
  EXPECT_EQ(h.open, 0) << "a glance";
  Pass(1);
  EXPECT_LT(h.open, 0);
  frame.yaw_rad = 0;
  Pass(2);
  ASSERT_EQ(h.open, 0);
  frame.eye.x = -8;
  Pass(1.5f);
  EXPECT_LT(h.open, 0) << "18 m away from what is found within 15";
}

TEST_F(HotspotsSeen, TooFarAwayItIsNotSeen) {
  Begin();
  frame.eye.x = -5.5f;
  Pass(2);
  EXPECT_TRUE(h.seen.empty());
  EXPECT_LT(h.open, 0);
}

TEST_F(HotspotsSeen, HousesHideItAndStallsDoNot) {
  AddHouse(4, 4, 3);
  Begin();
  Pass(2);
  EXPECT_TRUE(h.seen.empty());
  walkable.polygons.clear();
  AddHouse(4, 1, 1.5f);
  Begin();
  Pass(2);
  EXPECT_EQ(h.open, 0);
}

TEST_F(HotspotsSeen, WhatIsAtAWallIsSeenFromThatSideOnly) {
  AddHouse(10, 5, 6);
  Begin();
  Pass(0.1f);
  EXPECT_EQ(h.seen.size(), 1u);
  frame.eye.x = 20;
  frame.yaw_rad = kPi;
  Pass(0.1f);
  EXPECT_TRUE(h.seen.empty());
}

TEST_F(HotspotsSeen, WhatIsHighIsSeenOverHouses) {
  all[0].height_m = 12;
  AddHouse(4, 4, 3);
  Begin();
  frame.pitch_rad = 0.8f;
  Pass(0.1f);
  EXPECT_EQ(h.seen.size(), 1u);
}

TEST_F(HotspotsSeen, WhatThePictureHidesIsNotSeen) {
  Begin();
  Pass(2, true, [](Vec3 p) { return p.z > 3; });
  EXPECT_TRUE(h.seen.empty());
}

TEST_F(HotspotsSeen, ATapAndAKeyOpenAndClose) {
  Begin();
  Pass(0.1f, false);
  EXPECT_FALSE(TapHotspot({0.3f, 0.5f}, kAspect, 0.045f, &h));
  EXPECT_TRUE(TapHotspot({0.51f, 0.52f}, kAspect, 0.045f, &h));
  EXPECT_EQ(h.open, 0);
  EXPECT_TRUE(TapHotspot({0.5f, 0.5f}, kAspect, 0.045f, &h));
  EXPECT_LT(h.open, 0);
  Pass(3);
  EXPECT_LT(h.open, 0) << "closed by hand, it stays so while one looks on";
  frame.yaw_rad = 0.4f;
  Pass(2);
  frame.yaw_rad = 0;
  Pass(2);
  EXPECT_EQ(h.open, 0);
  AskHotspot(&h);
  EXPECT_LT(h.open, 0);
  AskHotspot(&h);
  EXPECT_EQ(h.open, 0);
}

TEST_F(HotspotsSeen, WhereTheTourLeadsNothingOpensByItself) {
  Begin();
  Pass(5, false);
  EXPECT_LT(h.open, 0);
  EXPECT_GT(h.seen[0].interest, 0.3f);
}

}  // namespace
}  // namespace flaneur
