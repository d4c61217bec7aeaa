#include "runtime/player/frame_from_simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace flaneur {
namespace {

// One person 10 m ahead of a camera that looks east.
struct Stage {
  Stage() {
    PackAvatar avatar;
    avatar.walk.duration_s = avatar.idle.duration_s = avatar.talk.duration_s = 1;
    pack.avatars = {avatar};
    s.walkable.ground = {{-50, -50}, 100, 1, 1, {0}, {3}};
    Person person;
    person.position = {10, 0};
    AddPerson(person, &s.crowd);
    s.crowd.view = {ViewClass::kVisible};
    s.levels.level = {0};
  }
  // The pictures so far have been at 30 a second.
  std::vector<DrawnPerson> Next() {
    ++s.frame;
    FrameFromSimulation(pack, s, &looks, &frame);
    return frame.people;
  }

  TourPack pack;
  Simulation s;
  PersonLooks looks;
  FrameInput frame;
};

float WholeShare(const std::vector<DrawnPerson>& people) {
  float sum = 0;
  for (const DrawnPerson& p : people) sum += p.share_to - p.share_from;
  return sum;
}

TEST(FrameFromSimulation, ALevelIsExchangedBitByBit) {
  Stage stage;
  ASSERT_EQ(stage.Next().size(), 1u);
  stage.s.levels.level = {-1};
  float share = 0;
  int pictures = 0;
  for (; share < 1 && pictures < 30; ++pictures) {
    const auto people = stage.Next();
    EXPECT_NEAR(WholeShare(people), 1, 1e-5f);
    float now = 0;
    for (const DrawnPerson& p : people) now += p.level == -1 ? p.share_to - p.share_from : 0;
    EXPECT_GE(now, share);
    EXPECT_LT(now - share, 0.2f);
    share = now;
  }
  EXPECT_NEAR(static_cast<float>(pictures) / 30, kFade_s, 0.1f);
  EXPECT_EQ(stage.Next().size(), 1u);
}

TEST(FrameFromSimulation, WhoGoesWithinTheViewFadesAwayWhereTheyWere) {
  Stage stage;
  stage.Next();
  RemovePerson(0, &stage.s.crowd);
  stage.s.levels.level.clear();
  float share = 1;
  for (int k = 0; k < 12; ++k) {
    const auto people = stage.Next();
    const float now = WholeShare(people);
    EXPECT_LE(now, share);
    EXPECT_LT(share - now, 0.2f);
    for (const DrawnPerson& p : people) EXPECT_EQ(p.position.x, 10);
    share = now;
  }
  EXPECT_EQ(share, 0);
}

TEST(FrameFromSimulation, WhoAppearsWithinTheViewFadesInAndWhoComesFromOutsideIsThereAtOnce) {
  Stage stage;
  stage.Next();
  Person person;
  person.position = {12, 1};
  AddPerson(person, &stage.s.crowd);
  stage.s.crowd.view = {ViewClass::kVisible, ViewClass::kVisible};
  stage.s.levels.level = {0, 0};
  EXPECT_NEAR(WholeShare(stage.Next()), 1, 1e-5f);
  EXPECT_LT(WholeShare(stage.Next()), 1.2f);
  stage.s.camera.view.yaw_rad = kPi;  // looks the other way, and back
  stage.s.crowd.view = {ViewClass::kOutside, ViewClass::kOutside};
  stage.s.levels.level = {kNotDrawn, kNotDrawn};
  EXPECT_TRUE(stage.Next().empty());
  stage.s.camera.view.yaw_rad = 0;
  stage.s.crowd.view = {ViewClass::kVisible, ViewClass::kVisible};
  stage.s.levels.level = {0, 0};
  EXPECT_NEAR(WholeShare(stage.Next()), 2, 1e-5f);
}

TEST(FrameFromSimulation, WhoseMiddleIsBeyondTheViewsEdgeIsStillDrawn) {
  Stage stage;
  const float half_rad = stage.s.camera.view.fov_rad / 2;
  stage.s.crowd.position = {{5 * std::cos(half_rad + 0.05f), 5 * std::sin(half_rad + 0.05f)}};
  stage.s.crowd.view = {ViewClass::kBoundary};
  stage.s.levels.level = {kNotDrawn};
  EXPECT_EQ(stage.Next().size(), 1u);
  stage.s.crowd.position = {{5 * std::cos(half_rad + 0.5f), 5 * std::sin(half_rad + 0.5f)}};
  EXPECT_TRUE(stage.Next().empty());
}

TEST(FrameFromSimulation, AWalkEndsByMixing) {
  Stage stage;
  stage.s.crowd.velocity = {{1.3f, 0}};
  ASSERT_EQ(stage.Next()[0].moment.clip, ClipKind::kWalk);
  stage.s.crowd.velocity = {{0, 0}};
  float last = 1;
  for (int k = 0; k < 8; ++k) {
    const DrawnPerson p = stage.Next()[0];
    EXPECT_NE(p.moment.clip, ClipKind::kWalk);
    EXPECT_TRUE(p.other_share == 0 || p.other.clip == ClipKind::kWalk);
    EXPECT_LT(last - p.other_share, 0.25f);
    last = p.other_share;
  }
  EXPECT_EQ(last, 0);
}

TEST(FrameFromSimulation, TheSameMomentTwiceIsTheSamePicture) {
  Stage stage;
  stage.Next();
  stage.s.levels.level = {-1};
  const auto people = stage.Next();
  FrameFromSimulation(stage.pack, stage.s, &stage.looks, &stage.frame);
  ASSERT_EQ(stage.frame.people.size(), people.size());
  for (size_t i = 0; i < people.size(); ++i) EXPECT_EQ(stage.frame.people[i].share_to, people[i].share_to);
}

TEST(FrameFromSimulation, TheSunRisesInTheEastStandsHighInTheSouthAndSetsInTheWest) {
  Stage stage;
  const auto sun_at = [&](float hour) {
    stage.s.hour = hour;
    stage.Next();
    EXPECT_NEAR(Length(stage.frame.to_sun), 1, 1e-4f);
    return stage.frame.to_sun;
  };
  const Vec3 morning = sun_at(7), noon = sun_at(12), evening = sun_at(17), night = sun_at(0);
  EXPECT_GT(morning.x, 0.5f);
  EXPECT_LT(evening.x, -0.5f);
  EXPECT_NEAR(morning.z, evening.z, 0.01f);
  EXPECT_LT(noon.y, -0.4f);
  EXPECT_GT(noon.z, morning.z + 0.2f);
  EXPECT_GT(morning.z, 0.1f);
  EXPECT_LT(night.z, -0.1f);
}

}  // namespace
}  // namespace flaneur
