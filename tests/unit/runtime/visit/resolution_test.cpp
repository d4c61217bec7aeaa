// The rule that chooses how coarsely the picture is drawn, on made-up machines: what stays, what each pixel takes, and
// noise.
#include "runtime/visit/resolution.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "runtime/control/level_control.h"

namespace flaneur {
namespace {

struct Machine {
  float fixed_ms = 10, pixels_ms = 100;  // the latter at full scale
  float noise = 0.1f;                    // share by which a picture may take longer; one in 50 takes twice as long
  float people_ms = 0;                   // with all their detail
};

float Took_ms(const Machine& m, float scale, std::mt19937* random, float detail = 1) {
  std::uniform_real_distribution<float> share(0, 1);
  const float hiccup = m.noise > 0 && share(*random) < 0.02f ? 2.0f : 1.0f;
  return (m.fixed_ms + m.pixels_ms * scale * scale + m.people_ms * detail * detail) * (1 + m.noise * share(*random)) *
         hiccup;
}

// The scale of every picture.
std::vector<float> Play(const Machine& machine, const ResolutionSettings& settings, int pictures, Resolution* r,
                        std::mt19937* random, bool moves = false) {
  std::vector<float> scales;
  for (int k = 0; k < pictures; ++k) {
    const float took_ms = Took_ms(machine, ScaleNow(settings, *r), random, DetailNow(settings, *r));
    FollowPictureTime(took_ms, moves, settings, r);
    scales.push_back(r->scale);
  }
  return scales;
}

int Changes(const std::vector<float>& scales) {
  int changes = 0;
  for (size_t k = 1; k < scales.size(); ++k) changes += scales[k] != scales[k - 1];
  return changes;
}

// A finer scale that had to be given up again.
bool IsUndone(const std::vector<float>& scales) {
  bool rose = false, undone = false;
  for (size_t k = 1; k < scales.size(); ++k) {
    undone = undone || (rose && scales[k] < scales[k - 1]);
    rose = rose || scales[k] > scales[k - 1];
  }
  return undone;
}

float Settled(const Machine& machine, const ResolutionSettings& settings) {
  Resolution r;
  std::mt19937 random(7);
  return Play(machine, settings, 3000, &r, &random).back();
}

TEST(ResolutionRule, WhereTheViewMovesIntoADearSightThePicturesAreCoarserAtOnceAndFineAgainAfterIt) {
  const Machine usual{5, 110, 0}, slow{5, 190, 0};
  const ResolutionSettings settings{40, 0.35f};
  for (const bool moves : {true, false}) {
    SCOPED_TRACE(moves);
    Resolution r;
    std::mt19937 random(3);
    Play(usual, settings, 300, &r, &random, moves);
    const float scale = r.scale;
    EXPECT_EQ(ScaleNow(settings, r), scale);
    Play(slow, settings, 2, &r, &random, moves);
    const float took_ms = Took_ms(slow, ScaleNow(settings, r), &random);
    if (moves) EXPECT_LT(took_ms, 1.1f * settings.frame_ms);
    else EXPECT_EQ(ScaleNow(settings, r), scale);
    EXPECT_EQ(r.scale, scale) << "two pictures are not for long";
    Play(usual, settings, 6, &r, &random, moves);
    EXPECT_EQ(ScaleNow(settings, r), scale);
  }
}

TEST(ResolutionRule, NoMomentIsCoarserThanItMay) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> fixed_ms(1, 200), pixels_ms(1, 900), least(0.25f, 1);
  for (int k = 0; k < 300; ++k) {
    const ResolutionSettings settings{40, least(random)};
    Resolution r;
    for (int picture = 0; picture < 60; ++picture) {
      Play({fixed_ms(random), pixels_ms(random)}, settings, 1, &r, &random, random() % 3 != 0);
      ASSERT_GE(ScaleNow(settings, r), settings.least_scale - 1e-5f);
      ASSERT_LE(ScaleNow(settings, r), r.scale);
      ASSERT_GT(DetailNow(settings, r), 0.3f);
      ASSERT_LE(DetailNow(settings, r), 1 + 1e-5f);
    }
  }
}

TEST(ResolutionRule, WhereTheLeastScaleDoesNotDoPeopleAreLessFineAndFineAgainLater) {
  const Machine crowded{20, 40, 0.02f, 30}, empty{20, 40, 0.02f, 5};
  const ResolutionSettings settings{45, 0.5f};
  Resolution r;
  std::mt19937 random(11);
  Play(crowded, settings, 400, &r, &random);
  EXPECT_FLOAT_EQ(ScaleNow(settings, r), 0.5f);
  const float detail = r.detail;
  EXPECT_LT(detail, 0.95f);
  EXPECT_LT(Took_ms(crowded, 0.5f, &random, detail), 1.1f * settings.frame_ms);
  Play(crowded, settings, 2000, &r, &random);
  EXPECT_FLOAT_EQ(r.detail, detail) << "never to and fro";
  Play(empty, settings, 3000, &r, &random);
  EXPECT_EQ(r.detail, 1);
}

TEST(ResolutionRule, HoldsTheTimeOrIsAtItsLeastAndComesToRest) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> fixed_ms(1, 60), pixels_ms(1, 250), noise(0, 0.15f), frame_ms(8, 60),
      least(0.3f, 1);
  for (int k = 0; k < 500; ++k) {
    const Machine machine{fixed_ms(random), pixels_ms(random), noise(random)};
    const ResolutionSettings settings{frame_ms(random), least(random)};
    SCOPED_TRACE(testing::Message() << machine.fixed_ms << " + " << machine.pixels_ms << " ms, noise " << machine.noise
                                    << ", wished " << settings.frame_ms << " ms at " << settings.least_scale);
    Resolution r;
    const std::vector<float> arrival = Play(machine, settings, 200, &r, &random),
                             later = Play(machine, settings, 3000, &r, &random);
    for (float scale : arrival) ASSERT_GE(scale, settings.least_scale);
    EXPECT_LE(Changes(arrival), 7);
    const float typical_ms = (machine.fixed_ms + machine.pixels_ms * r.scale * r.scale) * (1 + machine.noise / 2);
    if (r.scale > settings.least_scale) {
      EXPECT_LT(typical_ms, 1.1f * settings.frame_ms);
    }
    EXPECT_LE(Changes(later), 5) << "rests, but for a finer scale that it grows into";
    EXPECT_FALSE(IsUndone(later)) << "never to and fro";
  }
}

TEST(ResolutionRule, AFastMachineDrawsAsFineAsTheWindow) {
  Resolution r;
  std::mt19937 random(1);
  for (float scale : Play({2, 12, 0.2f}, {}, 1000, &r, &random)) EXPECT_EQ(scale, 1);
}

TEST(ResolutionRule, WhereTheProcessorDrawsNoFirstPictureTakesLongerThanTheLaterOnes) {
  const Machine slow{20, 200, 0.05f};
  const ResolutionSettings settings{40, 0.5f};
  EXPECT_FLOAT_EQ(ScaleNow(settings, FirstResolution(settings, false)), 1);
  Resolution r = FirstResolution(settings, true);
  std::mt19937 random(1);
  EXPECT_FLOAT_EQ(ScaleNow(settings, r), 0.5f);
  for (float scale : Play(slow, settings, 200, &r, &random)) EXPECT_FLOAT_EQ(scale, 0.5f);
}

TEST(ResolutionRule, WhereAFastProcessorDrawsPicturesAreSoonAsFineAsItCan) {
  const ResolutionSettings settings{40, 0.5f};
  std::mt19937 random(1);
  Resolution quick = FirstResolution(settings, true), middling = quick;
  Play({2, 20, 0}, settings, 11, &quick, &random);
  EXPECT_EQ(quick.scale, 1);
  const Machine machine{4, 50, 0};
  Play(machine, settings, 11, &middling, &random);
  EXPECT_GT(middling.scale, 0.65f);
  EXPECT_LT(Took_ms(machine, middling.scale, &random), settings.frame_ms);
}

TEST(ResolutionRule, WhoeverWishesNoCoarserPictureGetsNone) {
  Resolution r;
  std::mt19937 random(1);
  for (float scale : Play({80, 200}, {40, 1}, 300, &r, &random)) EXPECT_EQ(scale, 1);
}

TEST(ResolutionRule, MoreWorkIsNeverDrawnFinerAndMoreTimeNeverCoarser) {
  const auto settled = [](float fixed_ms, float pixels_ms, float frame_ms) {
    return Settled({fixed_ms, pixels_ms, 0}, {frame_ms, 0.4f});
  };
  for (float pixels_ms = 5; pixels_ms < 250; pixels_ms += 7) {
    EXPECT_LE(settled(12, pixels_ms + 7, 40), settled(12, pixels_ms, 40)) << pixels_ms;
    EXPECT_LE(settled(22, pixels_ms, 40), settled(12, pixels_ms, 40)) << pixels_ms;
    EXPECT_GE(settled(12, pixels_ms, 50), settled(12, pixels_ms, 40)) << pixels_ms;
  }
}

TEST(ResolutionRule, IsThereWithinASecondAndComesBackWhenThereIsTime) {
  Resolution r;
  std::mt19937 random(3);
  Play({10, 90}, {40, 0.4f}, 25, &r, &random);
  EXPECT_LT(r.scale, 0.65f);
  Play({4, 15}, {40, 0.4f}, 600, &r, &random);
  EXPECT_EQ(r.scale, 1);
}

// As when somebody looks to and fro between the sky and the market.
TEST(ResolutionRule, WaitsLongerWhereTheLoadItselfGoesToAndFro) {
  Resolution r;
  std::mt19937 random(3);
  std::vector<float> scales;
  for (int turn = 0; turn < 60; ++turn) {
    const std::vector<float> more = Play(turn % 2 == 0 ? Machine{8, 60} : Machine{6, 25}, {40, 0.4f}, 100, &r, &random);
    scales.insert(scales.end(), more.begin(), more.end());
  }
  EXPECT_LE(Changes({scales.begin() + 3000, scales.end()}), 20) << "in 30 turns";
}

TEST(ResolutionRule, LeavesATimeOfItsOwnToABudgetThatFollowsTheFrameTime) {
  ControlSettings control;
  control.target_ms = 40;
  EXPECT_FLOAT_EQ(ResolutionFor(25, 0.5f, control).frame_ms, 40);
  control.method = LimitMethod::kFrameTime;
  EXPECT_FLOAT_EQ(ResolutionFor(25, 0.5f, control).frame_ms, 48);
  control.target_ms = 16.7f;
  EXPECT_FLOAT_EQ(ResolutionFor(25, 0.5f, control).frame_ms, 40);
}

}  // namespace
}  // namespace flaneur
