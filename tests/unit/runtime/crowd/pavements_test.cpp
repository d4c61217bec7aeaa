// People walk as evenly, and as unevenly, as real ones do: means over made-up pavements and a campus beside those of
// recordings (ETH and UCY, by pavements.h).
#include <gtest/gtest.h>

#include <cstdio>

#include "runtime/crowd/variation.h"
#include "tests/unit/runtime/crowd/pavements.h"

namespace flaneur {
namespace {

constexpr double kLeast = 0.75, kMost = 1.3;  // of real people; two minutes of each situation differ by 5 %

TEST(Pavements, PeopleWalkLikePeople) {
  double ours[3] = {}, real[3] = {};
  std::vector<double> ahead_m;
  for (const PavementPlan& plan : Pavements()) {
    Pavement p = MakePavement(plan, 17);
    RunPavement(120, &p);
    const WalkMeasures m = MeasureWalks(p);
    ASSERT_GT(m.windows, 50) << plan.name;
    const double of[] = {m.speed_deviation_mps, m.acceleration_mps2, m.turn_dps};
    const float there[] = {plan.real.speed_deviation_mps, plan.real.acceleration_mps2, plan.real.turn_dps};
    for (int k = 0; k < 3; ++k) {
      ours[k] += static_cast<double>(plan.weight) * of[k];
      real[k] += static_cast<double>(plan.weight * there[k]);
    }
    ahead_m.insert(ahead_m.end(), m.ahead_m.begin(), m.ahead_m.end());
  }
  const char* names[] = {"speed deviation", "acceleration", "turning"};
  for (int k = 0; k < 3; ++k) {
    std::printf("%s %.2f of real people's\n", names[k], ours[k] / real[k]);
    EXPECT_GE(ours[k], kLeast * real[k]) << names[k];
    EXPECT_LE(ours[k], kMost * real[k]) << names[k];
  }
  EXPECT_NEAR(QuantileOf(ahead_m, 0.5), 0.21, 0.06) << "one of a pair is ahead of the other";
}

// As real people's pace does: alike half a second later, no more so after some seconds.
TEST(Pavements, PaceSwingsAndComesBack) {
  constexpr double kReal[] = {0.82, 0.56, 0.30, -0.09, -0.36};  // after 0.4, 0.8, 1.6, 3.2, 6.4 s
  double mean[5] = {};
  const std::vector<PavementPlan> plans = Pavements();
  for (const PavementPlan& plan : plans) {
    for (const uint64_t seed : {1, 2}) {
      Pavement p = MakePavement(plan, seed);
      RunPavement(300, &p);
      const WalkMeasures m = MeasureWalks(p);
      for (size_t k = 0; k < 5; ++k) mean[k] += m.correlation[k] / (2 * static_cast<double>(plans.size()));
    }
  }
  for (size_t k = 0; k < 5; ++k) EXPECT_NEAR(mean[k], kReal[k], 0.3) << "after lag " << k;
}

TEST(Variation, IsEachPersonsOwnAndAlwaysTheSame) {
  constexpr int kPeople = 200, kMoments = 3000;
  constexpr uint32_t kMoment = static_cast<uint32_t>(kClock_ps) / 10;
  double mean = 0, square = 0, alike = 0;
  for (int who = 0; who < kPeople; ++who) {
    for (uint32_t k = 0; k < kMoments; ++k) {
      const Variation v = VariationAt(k * kMoment, who), other = VariationAt(k * kMoment, who + 1);
      ASSERT_EQ(v.slow_pace, VariationAt(k * kMoment, who).slow_pace);
      mean += static_cast<double>(v.slow_pace + v.quick_pace) / 2,
          alike += static_cast<double>(v.slow_pace * other.slow_pace);
      square += static_cast<double>(v.slow_pace * v.slow_pace);
    }
  }
  constexpr double kAll = 1.0 * kPeople * kMoments;
  EXPECT_NEAR(mean / kAll, 0, 0.03);
  EXPECT_NEAR(square / kAll, 1.1, 0.35) << "some vary more than others";
  EXPECT_NEAR(alike / kAll, 0, 0.15) << "nobody varies with their neighbour";
}

}  // namespace
}  // namespace flaneur
