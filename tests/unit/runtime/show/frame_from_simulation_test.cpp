#include "runtime/show/frame_from_simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "runtime/crowd/fast_math.h"
#include "runtime/visit/controls.h"

namespace flaneur {
namespace {

// One person 10 m ahead of a camera that looks east, drawn as the control decides.
struct Stage {
  Stage() {
    PackAvatar avatar;
    avatar.walk.duration_s = avatar.idle.duration_s = avatar.talk.duration_s = 1;
    pack.avatars = {avatar};
    s.town.walkable.ground = Share({{-50, -50}, 100, 1, 1, {0}, {3}});
    Person person;
    person.position = {10, 0};
    AddPerson(person, &s.town.crowd);
    s.town.crowd.view = {ViewClass::kVisible};
    s.control.avatars = {{{{1000, 0}}, 1.75f, 128}};
  }
  // A step of the control alone.
  void Step() {
    ++s.town.step;
    ChooseLevels(s.town.crowd, s.control.avatars, s.control.settings, {s.visitor.camera.view, {}, 0},
                 &s.control.levels);
    for (size_t i = 0; i < s.town.crowd.size(); ++i)
      s.town.crowd.was_visible[i] = s.town.crowd.view[i] == ViewClass::kVisible;
  }
  // The pictures so far have been at 30 a second.
  std::vector<DrawnPerson> Next() {
    Step();
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

TEST(FrameFromSimulation, PeopleOfOneModelWearDifferentColoursAndKeepThem) {
  Stage stage;
  stage.pack.avatars[0].tints = {{{0, 0, 1}, 0.1f, {{1, 0, 0}, {0, 1, 0}, {1, 1, 0}}}, {{1, 1, 1}, 0.1f, {{0, 0, 0}}}};
  constexpr int kPeople = 400;
  for (int k = 1; k < kPeople; ++k) {
    Person person;
    person.position = {10, static_cast<float>(k) * 0.1f};
    AddPerson(person, &stage.s.town.crowd);
  }
  stage.s.town.crowd.view.assign(kPeople, ViewClass::kVisible);
  const auto people = stage.Next();
  ASSERT_EQ(people.size(), static_cast<size_t>(kPeople));
  std::map<std::array<uint8_t, 3>, int> wearers;
  int like_the_one_before = 0;
  for (size_t k = 0; k < people.size(); ++k) {
    ++wearers[people[k].tints];
    if (k > 0 && people[k].tints == people[k - 1].tints) ++like_the_one_before;
  }
  EXPECT_EQ(wearers.size(), 8u) << "every colour of the one with every colour of the other";
  for (const auto& [tints, count] : wearers) EXPECT_NEAR(count, kPeople / 8, kPeople / 16);
  EXPECT_EQ(like_the_one_before, 0) << "of who came one after the other, as the members of a group";
  const auto later = stage.Next();
  for (size_t k = 0; k < people.size(); ++k) EXPECT_EQ(later[k].tints, people[k].tints);
}

TEST(FrameFromSimulation, PeopleOfOneModelAreOfSeveralSizesAndKeepThem) {
  Stage stage;
  constexpr int kPeople = 100;
  for (int k = 1; k < kPeople; ++k) {
    Person person;
    person.position = {10, static_cast<float>(k) * 0.1f};
    AddPerson(person, &stage.s.town.crowd);
  }
  stage.s.town.crowd.view.assign(kPeople, ViewClass::kVisible);
  for (const DrawnPerson& person : stage.Next()) EXPECT_EQ(person.size, 1) << "a pack without a spread";
  stage.looks = {};
  stage.pack.avatars[0].height_spread = stage.pack.avatars[0].breadth_spread = 0.05f;
  const auto people = stage.Next();
  float least = 1, most = 1, sum = 0;
  for (const DrawnPerson& person : people) {
    least = std::min(least, person.size);
    most = std::max(most, person.size);
    sum += person.size / kPeople;
  }
  EXPECT_NEAR(least, 0.95f, 0.005f);
  EXPECT_NEAR(most, 1.05f, 0.005f);
  EXPECT_NEAR(sum, 1, 0.005f);
  int tall_and_narrow = 0;
  for (const DrawnPerson& person : people) {
    EXPECT_NEAR(person.breadth, 1, 0.0501f);
    tall_and_narrow += person.size > 1.02f && person.breadth < 0.98f;
  }
  EXPECT_NEAR(tall_and_narrow, 0.09 * kPeople, 0.03 * kPeople) << "as often as chance has it";
  const auto later = stage.Next();
  for (size_t k = 0; k < people.size(); ++k) EXPECT_EQ(later[k].size, people[k].size);
}

TEST(FrameFromSimulation, PropsAreDrawnOnceAndFadeWithTheirBearerAndFarOff) {
  Stage stage;
  stage.s.control.avatars[0].props = {{"hat", 1, "head", 10}, {"bag", 1, "hand", 10}};
  const auto share = [&] {
    float sum = 0;
    for (const DrawnPerson& p : stage.frame.people) sum += p.props != 0 ? p.props_share : 0;
    return sum;
  };
  const auto next_share = [&] {
    stage.Next();
    return share();
  };
  EXPECT_EQ(next_share(), 1);
  EXPECT_EQ(stage.frame.people[0].props, 3);
  stage.s.control.settings.high_limit = 0;
  for (int k = 0; k < 15; ++k) EXPECT_NEAR(next_share(), 1, 1e-5f) << "while the level changes";
  const auto at = [&](float x) {
    stage.s.town.crowd.position[0].x = x;
    return next_share();
  };
  EXPECT_EQ(at(kPropReach_m - kPropFade_m - 0.5f), 1);
  EXPECT_NEAR(at(kPropReach_m - kPropFade_m / 2), 0.5f, 0.05f);
  EXPECT_EQ(at(kPropReach_m + 0.5f), 0);
}

TEST(FrameFromSimulation, ALevelIsExchangedBitByBit) {
  Stage stage;
  ASSERT_EQ(stage.Next().size(), 1u);
  stage.s.control.settings.high_limit = 0;
  float share = 0;
  int pictures = 0;
  for (; share < 1 && pictures < 30; ++pictures) {
    const auto people = stage.Next();
    EXPECT_NEAR(WholeShare(people), 1, 1e-5f);
    float now = 0;
    for (const DrawnPerson& p : people) now += p.level == kImpostor ? p.share_to - p.share_from : 0;
    EXPECT_GE(now, share);
    EXPECT_LT(now - share, 0.2f);
    share = now;
  }
  EXPECT_NEAR(static_cast<float>(pictures) / 30, kFade_s, 0.1f);
  EXPECT_EQ(stage.Next().size(), 1u);
}

// Between two steps as well.
TEST(FrameFromSimulation, ALevelGoesOnBeingExchangedBetweenTheSteps) {
  Stage stage;
  stage.Next();
  stage.s.control.settings.high_limit = 0;
  stage.Next();
  float last = 0;
  for (int k = 0; k < 40; ++k) {
    if (k % 4 == 0) stage.Step();
    FrameFromSimulation(stage.pack, stage.s, &stage.looks, &stage.frame, {static_cast<float>(k % 4) / 4});
    const DrawnPerson& p = stage.frame.people[0];
    const float now = p.level == kImpostor ? p.share_to - p.share_from : 0;
    EXPECT_GE(now, last - 1e-5f) << k;
    EXPECT_LT(now - last, 0.05f) << k;
    last = now;
  }
  EXPECT_EQ(last, 1);
}

TEST(FrameFromSimulation, WhoGoesWithinTheViewFadesAwayWhereTheyWere) {
  Stage stage;
  stage.Next();
  RemovePerson(0, &stage.s.town.crowd);
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
  AddPerson(person, &stage.s.town.crowd);
  stage.s.town.crowd.view = {ViewClass::kVisible, ViewClass::kVisible};
  stage.s.town.crowd.was_visible = {1, 1};
  EXPECT_NEAR(WholeShare(stage.Next()), 1, 1e-5f);
  EXPECT_LT(WholeShare(stage.Next()), 1.2f);
  stage.s.visitor.camera.view.yaw_rad = kPi;  // looks the other way, and back
  stage.s.town.crowd.view = {ViewClass::kOutside, ViewClass::kOutside};
  stage.Next();  // on the way there
  EXPECT_TRUE(stage.Next().empty());
  stage.s.visitor.camera.view.yaw_rad = 0;
  stage.s.town.crowd.view = {ViewClass::kVisible, ViewClass::kVisible};
  EXPECT_NEAR(WholeShare(stage.Next()), 2, 1e-5f);
}

TEST(FrameFromSimulation, WhoIsJustBeyondTheViewsEdgeIsDrawnLikeEverybody) {
  Stage stage;
  const float half_rad = stage.s.visitor.camera.view.fov_rad / 2;
  stage.s.town.crowd.position = {{5 * std::cos(half_rad + 0.05f), 5 * std::sin(half_rad + 0.05f)}};
  stage.s.town.crowd.view = {ViewClass::kBoundary};
  const auto people = stage.Next();
  ASSERT_EQ(people.size(), 1u);
  EXPECT_TRUE(IsMesh(people[0].level));
  stage.s.town.crowd.position = {{5 * std::cos(half_rad + 0.5f), 5 * std::sin(half_rad + 0.5f)}};
  EXPECT_TRUE(stage.Next().empty());
}

TEST(FrameFromSimulation, AWalkEndsByMixing) {
  Stage stage;
  stage.s.town.crowd.velocity = {{1.3f, 0}};
  ASSERT_EQ(stage.Next()[0].moment.clip, ClipKind::kWalk);
  stage.s.town.crowd.velocity = {{0, 0}};
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
  stage.s.control.settings.high_limit = 0;
  const auto people = stage.Next();
  FrameFromSimulation(stage.pack, stage.s, &stage.looks, &stage.frame);
  ASSERT_EQ(stage.frame.people.size(), people.size());
  for (size_t i = 0; i < people.size(); ++i) EXPECT_EQ(stage.frame.people[i].share_to, people[i].share_to);
}

TEST(FrameFromSimulation, BetweenTwoStepsEverythingIsOnItsWay) {
  Stage stage;
  stage.s.town.crowd.velocity = {{1.3f, 0}};
  stage.s.visitor.camera.view.yaw_rad = 3.1f;
  stage.s.town.crowd.position = {{-10, 0}};
  stage.Next();
  const FrameInput before = stage.frame;
  stage.s.town.crowd.position = {{-9.95f, 0.02f}};
  stage.s.town.crowd.heading_rad = {-0.2f};
  stage.s.town.crowd.walked_m = {0.05f};
  stage.s.visitor.camera.view.position = {0.06f, 0.03f};
  stage.s.visitor.camera.view.yaw_rad = -3.12f;
  stage.Next();
  const FrameInput now = stage.frame;
  ASSERT_EQ(now.people.size(), 1u);
  for (const float share : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f}) {
    FrameFromSimulation(stage.pack, stage.s, &stage.looks, &stage.frame, {share});
    const auto mix = [share](float a, float b) { return a + share * (b - a); };
    EXPECT_NEAR(stage.frame.eye.x, mix(before.eye.x, now.eye.x), 1e-5f);
    EXPECT_NEAR(stage.frame.eye.y, mix(before.eye.y, now.eye.y), 1e-5f);
    EXPECT_NEAR(std::remainder(stage.frame.yaw_rad - mix(3.1f, 2 * kPi - 3.12f), 2 * kPi), 0, 1e-5f);
    const DrawnPerson &p = stage.frame.people[0], &p0 = before.people[0], &p1 = now.people[0];
    EXPECT_NEAR(p.position.x, mix(p0.position.x, p1.position.x), 1e-5f);
    EXPECT_NEAR(p.heading_rad, mix(p0.heading_rad, p1.heading_rad), 1e-5f);
    EXPECT_NEAR(p.moment.phase, mix(p0.moment.phase, p1.moment.phase), 1e-5f) << "feet don't slide";
  }
}

// Two steps in one picture, as on a slow machine: pictures go on evenly from where the last one's step stood.
TEST(FrameFromSimulation, AfterTwoStepsAtOnceTheWayIsAsLong) {
  Stage stage;
  stage.Next();
  stage.Step();
  stage.s.town.crowd.position = {{10.1f, 0}};
  stage.Next();
  FrameFromSimulation(stage.pack, stage.s, &stage.looks, &stage.frame, {0.5f});
  EXPECT_NEAR(stage.frame.people[0].position.x, 10.075f, 1e-5f);
}

TEST(FrameFromSimulation, WhoIsPutElsewhereDoesNotFly) {
  Stage stage;
  stage.Next();
  stage.s.town.crowd.position = {{20, 5}};
  stage.s.visitor.camera.view.position = {8, 0};
  stage.Next();
  FrameFromSimulation(stage.pack, stage.s, &stage.looks, &stage.frame, {0.5f});
  EXPECT_EQ(stage.frame.people[0].position.x, 20);
  EXPECT_EQ(stage.frame.eye.x, 8);
}

// The view's yaw in every picture while a hand turns it evenly; the simulation does it in steps of 33 ms, pictures come
// every 7 ms.
std::vector<float> YawsWhileTurning(float rate_radps, float picture_s) {
  Stage stage;
  stage.Step();
  Controls controls;
  controls.follows_tour = false;
  float owed_s = 0;
  std::vector<float> yaws;
  for (int picture = 0; picture < 300; ++picture) {
    controls.to_turn_rad += rate_radps * picture_s;
    owed_s += picture_s;
    if (owed_s >= Step_s(stage.s)) {
      controls.turned_rad = 0;
      const CameraInput step = NextStep({}, stage.s, &controls);
      stage.s.visitor.camera.view.yaw_rad =
          WrapAngle(stage.s.visitor.camera.view.yaw_rad + step.yaw_rate_radps * Step_s(stage.s));
      stage.Step();
      owed_s -= Step_s(stage.s);
    }
    const float share = owed_s / Step_s(stage.s);
    FrameFromSimulation(stage.pack, stage.s, &stage.looks, &stage.frame,
                        {share, TurnUntil(share, stage.s, controls), controls.turned_rad, 0});
    yaws.push_back(stage.frame.yaw_rad);
  }
  return yaws;
}

TEST(FrameFromSimulation, TheViewFollowsTheHandAtOnceAndEvenly) {
  constexpr float kRate_radps = 1.2f, kPicture_s = 0.007f;
  const std::vector<float> yaws = YawsWhileTurning(kRate_radps, kPicture_s);
  for (size_t k = 0; k < yaws.size(); ++k) {
    const float hand_rad = kRate_radps * kPicture_s * static_cast<float>(k + 1);
    EXPECT_NEAR(std::remainder(yaws[k] - hand_rad, 2 * kPi), 0, 0.02f) << k;
  }
}

// Some of what a hand asks for that turns much faster than the view may is forgotten; the view goes on evenly all the
// same.
TEST(FrameFromSimulation, AFasterHandTurnsTheViewEvenlyToo) {
  constexpr float kPicture_s = 0.007f;
  const std::vector<float> yaws = YawsWhileTurning(12, kPicture_s);
  for (size_t k = 1; k < yaws.size(); ++k) {
    EXPECT_NEAR(std::remainder(yaws[k] - yaws[k - 1], 2 * kPi), MaxYawRate_radps(kPlainControl) * kPicture_s, 0.002f)
        << k;
  }
}

// Whom the view leaves with the last step is in the pictures on the way there.
TEST(FrameFromSimulation, NobodyIsMissingBetweenTheSteps) {
  Stage stage;
  stage.Next();
  const float half_rad = stage.s.visitor.camera.view.fov_rad / 2;
  stage.s.visitor.camera.view.yaw_rad = half_rad + 0.2f;
  stage.s.town.crowd.view = {ViewClass::kBoundary};
  EXPECT_EQ(stage.Next().size(), 1u);
  EXPECT_TRUE(stage.Next().empty());
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
