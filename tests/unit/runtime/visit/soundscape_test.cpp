// What is heard in the town, and from where.
#include "runtime/visit/soundscape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "runtime/show/hour.h"
#include "runtime/simulation/scenario.h"

namespace flaneur {
namespace {

constexpr float kPicture_s = 1.0f / 30;

// A square with so many people who stand and talk around the visitor, and whoever walks.
struct Square {
  TourPack pack;
  Simulation s;
  Soundscape scape;
  FrameInput frame;
  float round_gain = 0;
  std::vector<HeardSound> once;

  explicit Square(int talking, std::vector<SoundPlace> places = {}) {
    pack.sound_places = std::move(places);
    Scenario scenario;
    scenario.has_ground = scenario.has_camera = true;
    scenario.ground_min_m = {-40, -40};
    scenario.ground_max_m = {40, 40};
    scenario.obstacles.polygons = {{{{10, -15}, {14, -15}, {14, 15}, {10, 15}}, {}}};
    for (int k = 0; k < talking; ++k) {
      const float angle = 2 * kPi * static_cast<float>(k) / static_cast<float>(talking);
      ScenarioPerson person;
      person.position_m = {5 * std::cos(angle), 5 * std::sin(angle)};
      scenario.persons.push_back(person);
    }
    EXPECT_EQ(StartSimulation(nullptr, scenario, &s).message, "");
    for (Activity& activity : s.town.crowd.activity) activity = Activity::kTalking;
    PrepareSoundscape(pack, s.town.walkable, &scape);
    frame.eye = {0, 0, 1.65f};
    frame.to_sun = {0, -0.7f, 0.7f};
  }
  void Pass(float seconds, bool speaks = false, bool holds = false) {
    for (float t = 0; t < seconds; t += kPicture_s) {
      FollowSoundscape(pack, s, frame, kPicture_s, speaks, holds, &scape);
      once.insert(once.end(), scape.heard.once.begin(), scape.heard.once.end());
    }
    round_gain = 0;
    for (const HeardSound& sound : scape.heard.round) round_gain += sound.gain;
  }
  int OnceOf(SoundKind kind) const {
    int count = 0;
    for (const HeardSound& sound : once) count += scape.recordings[static_cast<size_t>(sound.recording)].kind == kind;
    return count;
  }
};

TEST(Soundscape, TheMurmurFollowsHowManyPeopleAreNear) {
  float before = 0;
  for (const int people : {1, 6, 20}) {
    Square square(people);
    square.Pass(5);
    EXPECT_GT(square.round_gain, before + 0.02f) << people;
    before = square.round_gain;
    square.frame.eye.x = -38;
    square.Pass(5);
    EXPECT_LT(square.round_gain, 0.02f) << "nobody is near there";
  }
  Square alone(0);
  alone.Pass(5);
  EXPECT_EQ(alone.round_gain, 0);
}

TEST(Soundscape, TheMurmurComesFromWherePeopleAre) {
  Square square(12);
  for (Vec2& p : square.s.town.crowd.position) p = {6, std::abs(p.y) / 4 + 1};
  square.Pass(3);
  ASSERT_FALSE(square.scape.heard.round.empty());
  for (const HeardSound& sound : square.scape.heard.round) EXPECT_GT(sound.place.x, 4);
}

TEST(Soundscape, AFootComesDownWithEveryHalfOfTheWalk) {
  Square square(1);
  square.s.town.crowd.position[0] = {3, 0};
  square.Pass(0.2f);
  for (int k = 0; k < 300; ++k) {
    square.s.town.crowd.walked_m[0] += 1.4f * kPicture_s;
    square.Pass(kPicture_s / 2);
  }
  EXPECT_NEAR(square.OnceOf(SoundKind::kSteps), 14 / 0.7f, 1);
  for (const HeardSound& sound : square.once) EXPECT_NEAR(sound.place.x, 3, 0.01f);
}

TEST(Soundscape, OnesOwnStepsAreHeardAndStandingIsSilent) {
  Square square(0);
  square.Pass(2);
  EXPECT_EQ(square.OnceOf(SoundKind::kSteps), 0);
  square.s.visitor.camera.actual_mps = 1.4f;
  square.Pass(5);
  EXPECT_NEAR(square.OnceOf(SoundKind::kSteps), 10, 1);
}

TEST(Soundscape, WaterFadesWithDistanceAndBehindWalls) {
  Square square(0, {{SoundKind::kWater, {6, 0}, 1, 25, 1, -1}});
  square.Pass(4);
  const float near = square.round_gain;
  square.frame.eye.x = -6;
  square.Pass(4);
  const float far = square.round_gain;
  EXPECT_GT(near, 1.5f * far);
  EXPECT_GT(far, 0.02f);
  square.frame.eye.x = 18;  // as far away, behind a house
  square.Pass(4);
  EXPECT_LT(square.round_gain, 0.6f * far);
  square.frame.eye.x = -20;
  square.Pass(4);
  EXPECT_EQ(square.round_gain, 0) << "beyond its radius";
}

TEST(Soundscape, ItGivesWayToWordsAndNothingStepsWhileEverythingStands) {
  Square square(10);
  square.Pass(4);
  const float before = square.round_gain;
  square.Pass(4, true);
  EXPECT_LT(square.round_gain, 0.6f * before);
  square.once.clear();
  square.s.visitor.camera.actual_mps = 1.4f;
  square.Pass(4, false, true);
  EXPECT_EQ(square.OnceOf(SoundKind::kSteps), 0);
}

TEST(Soundscape, TheSunTellsTheHour) {
  EXPECT_NEAR(HourOfSun({0, -0.5f, 0.8f}), 12, 1e-4f);
  EXPECT_NEAR(HourOfSun({1, 0, 0.1f}), 6, 1e-4f);
  EXPECT_NEAR(HourOfSun({-1, 0, 0.1f}), 18, 1e-4f);
}

// The sun from a quarter to three on, an hour in `hour_s`.
int StrokesAt(float hour_s) {
  Square square(0, {{SoundKind::kBell, {20, 0}, 20, 200, 1, -1}});
  for (float t = 0; t < 0.5f * hour_s + 20; t += kPicture_s) {
    const float angle = (std::min(14.75f + t / hour_s, 15.2f) - 12) * kPi / 12;
    square.frame.to_sun = {-std::sin(angle), -std::cos(angle), 0.7f};
    square.Pass(kPicture_s / 2);
  }
  return square.OnceOf(SoundKind::kBell);
}

TEST(Soundscape, TheBellStrikesTheHourAndOnceWhereHoursFly) {
  EXPECT_EQ(StrokesAt(600), 3);
  EXPECT_EQ(StrokesAt(50), 1);
}

TEST(Soundscape, HoursThatFlyDoNotKeepTheBellRinging) {
  Square square(0, {{SoundKind::kBell, {20, 0}, 20, 200, 1, -1}});
  for (float t = 0; t < 300; t += kPicture_s) {  // an hour in 25 s, as where a day lasts 10 minutes
    const float angle = t / 25 * kPi / 12 - 1;
    square.frame.to_sun = {-std::sin(angle), -std::cos(angle), 0.7f};
    square.Pass(kPicture_s / 2);
  }
  EXPECT_GE(square.OnceOf(SoundKind::kBell), 2);
  EXPECT_LE(square.OnceOf(SoundKind::kBell), 3);
}

TEST(Soundscape, BirdsSingByDayAndSleepByNight) {
  Square square(0, {{SoundKind::kBirds, {5, 5}, 6, 45, 1, -1}});
  square.Pass(60);
  EXPECT_GT(square.OnceOf(SoundKind::kBirds), 5);
  square.once.clear();
  square.frame.to_sun = {-1, 0, 0.01f};
  square.Pass(60);
  EXPECT_EQ(square.OnceOf(SoundKind::kBirds), 0);
}

TEST(Soundscape, ATourMaySilenceStepsAndMurmur) {
  Square square(20, {{SoundKind::kSteps, {}, 0, 25, 0, -1}, {SoundKind::kMurmur, {}, 0, 25, 0, -1}});
  square.s.visitor.camera.actual_mps = 1.4f;
  square.Pass(6);
  EXPECT_EQ(square.round_gain, 0);
  EXPECT_EQ(square.OnceOf(SoundKind::kSteps), 0);
}

TEST(Synthesis, SoundsAreLoudEnoughAndNeverClip) {
  for (SoundKind kind :
       {SoundKind::kSteps, SoundKind::kMurmur, SoundKind::kWater, SoundKind::kBirds, SoundKind::kBell}) {
    for (int variant = 0; variant < kVariants; ++variant) {
      const std::vector<int16_t> samples = Synthesize(kind, variant);
      ASSERT_GT(samples.size(), 3000u);
      int peak = 0;
      double sum = 0;
      for (int16_t s : samples) peak = std::max(peak, std::abs(static_cast<int>(s))), sum += s;
      EXPECT_GT(peak, 20000);
      EXPECT_LT(peak, 32000);
      EXPECT_LT(std::abs(sum / static_cast<double>(samples.size())), 600) << "no constant part";
      if (kind == SoundKind::kMurmur || kind == SoundKind::kWater || kind == SoundKind::kBell) break;
    }
  }
  EXPECT_TRUE(Synthesize(SoundKind::kLoop).empty());
}

// From the last sample to the first no farther than from one to the next elsewhere.
TEST(Synthesis, WhatGoesRoundHasNoSeam) {
  for (SoundKind kind : {SoundKind::kMurmur, SoundKind::kWater}) {
    const std::vector<int16_t> s = Synthesize(kind);
    int most = 0;
    for (size_t k = 0; k + 1 < s.size(); ++k) most = std::max(most, std::abs(s[k + 1] - s[k]));
    EXPECT_LE(std::abs(s.front() - s.back()), most / 2 + 500);
  }
  for (SoundKind kind : {SoundKind::kSteps, SoundKind::kBirds, SoundKind::kBell}) {
    const std::vector<int16_t> s = Synthesize(kind);
    EXPECT_LT(std::abs(s.front()), 700);
    EXPECT_LT(std::abs(s.back()), 700);
  }
}

}  // namespace
}  // namespace flaneur
