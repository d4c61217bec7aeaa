// Speed against density in a periodic corridor of 30 x 4 m, everybody walking the same way, against Weidmann's curve
// v = 1.34 (1 - exp(-1.913 (1 / density - 1 / 5.4))) m/s (Weidmann 1993, Transporttechnik der Fussgaenger). Also
// RiMEA's case 4.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/unit/runtime/crowd/corridor.h"

namespace flaneur {
namespace {

constexpr int kWarmUp_steps = 600, kSteps = 600;

float Weidmann_mps(float density_pm2) {
  return kCorridorFree_mps * (1 - std::exp(-1.913f * (1 / density_pm2 - 1 / 5.4f)));
}

float Speed_mps(float density_pm2) {
  Corridor corridor = MakeCorridor(4, density_pm2, 0, 1);
  float sum_mps = 0;
  for (int step = 0; step < kWarmUp_steps + kSteps; ++step) {
    StepCorridor({}, &corridor);
    if (step >= kWarmUp_steps) sum_mps += SpeedAlong_mps(corridor);
  }
  return sum_mps / kSteps;
}

TEST(Weidmann, SpeedFallsWithDensityAsMeasured) {
  double sum2 = 0;
  int count = 0;
  for (float density_pm2 : {0.3f, 0.6f, 1.0f, 1.5f, 2.0f, 2.5f, 3.0f, 3.5f, 4.0f}) {
    const float speed_mps = Speed_mps(density_pm2), wanted_mps = Weidmann_mps(density_pm2);
    std::printf("%.1f people/m2: %.3f m/s, Weidmann %.3f m/s\n", density_pm2, speed_mps, wanted_mps);
    sum2 += (speed_mps - wanted_mps) * (speed_mps - wanted_mps);
    ++count;
  }
  const double deviation_mps = std::sqrt(sum2 / count);
  std::printf("RMS deviation from Weidmann's curve %.3f m/s\n", deviation_mps);
  EXPECT_LE(deviation_mps, 0.10);
}

}  // namespace
}  // namespace flaneur
