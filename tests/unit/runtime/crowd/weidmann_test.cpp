// Speed against density in a corridor of 30 x 4 m whose ends are one (periodic), everybody walking the same way, against
// Weidmann's curve v = 1.34 (1 - exp(-1.913 (1 / density - 1 / 5.4))) m/s (Weidmann 1993, Transporttechnik der Fussgaenger).
// The ends are joined by doubles: everybody has one, 30 m before or behind, that moves as they do.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "runtime/base/random.h"
#include "runtime/crowd/crowd.h"

namespace flaneur {
namespace {

constexpr float kStep_s = 1.0f / 30, kLength_m = 30, kWidth_m = 4, kFree_mps = 1.34f;
constexpr int kWarmUp_steps = 600, kSteps = 600;

float Weidmann_mps(float density_pm2) {
  return kFree_mps * (1 - std::exp(-1.913f * (1 / density_pm2 - 1 / 5.4f)));
}

// x from -20 to 50 m; people live in 0 ... 30, doubles up to 15 m beyond.
Walkable Corridor() {
  Walkable w;
  const int columns = 220, rows = 8;
  w.ground = {{-20, 0}, 0.5f, columns, rows, std::vector<float>(columns * rows, 0), std::vector<uint8_t>(columns * rows, 3)};
  w.polygons.push_back({{{-30, -1}, {100, -1}, {100, 0}, {-30, 0}}, {}});
  w.polygons.push_back({{{-30, kWidth_m}, {100, kWidth_m}, {100, kWidth_m + 1}, {-30, kWidth_m + 1}}, {}});
  BuildWalkable(0.26f, &w, 0.25f);
  return w;
}

Person Walker(Vec2 position, int field) {
  Person p;
  p.position = position;
  p.preferred_mps = kFree_mps;
  p.field = field;
  return p;
}

void Join(size_t people, Crowd* c) {
  for (size_t i = 0; i < people; ++i) {
    if (c->position[i].x >= kLength_m) c->position[i].x -= kLength_m;
    const size_t other = people + i;
    c->position[other] = c->position[i] + Vec2{c->position[i].x < kLength_m / 2 ? kLength_m : -kLength_m, 0};
    c->velocity[other] = c->velocity[i];
    c->heading_rad[other] = c->heading_rad[i];
  }
}

Crowd Fill(int people, uint64_t seed) {
  Crowd c;
  Random random{seed};
  const int field = FieldFor({85, kWidth_m / 2}, &c);  // far ahead, so that everybody walks along the corridor
  // A lattice with some disorder: random places don't fit where it is dense.
  const float margin_m = 0.27f;
  const int rows = std::max(2, std::min(7, static_cast<int>(std::round(std::sqrt(static_cast<float>(people) * kWidth_m / kLength_m)))));
  const int columns = (people + rows - 1) / rows;
  for (int k = 0; k < people; ++k) {
    const int row = k % rows, column = k / rows;
    const float pitch_m = kLength_m / static_cast<float>(columns), jitter_m = 0.3f * std::max(0.0f, pitch_m - 0.5f);
    const Vec2 p{(static_cast<float>(column) + 0.25f + (row % 2 ? 0.5f : 0)) * pitch_m + random.Uniform(-jitter_m, jitter_m),
                 margin_m + static_cast<float>(row) * (kWidth_m - 2 * margin_m) / static_cast<float>(rows - 1)};
    AddPerson(Walker(p, field), &c);
  }
  for (int k = 0; k < people; ++k) AddPerson(Walker(c.position[static_cast<size_t>(k)], field), &c);
  for (ViewClass& view : c.view) view = ViewClass::kVisible;
  Join(static_cast<size_t>(people), &c);
  return c;
}

float Speed_mps(const Walkable& w, float density_pm2, uint64_t seed) {
  const size_t people = static_cast<size_t>(std::lround(density_pm2 * kLength_m * kWidth_m));
  Crowd c = Fill(static_cast<int>(people), seed);
  double walked_m = 0;
  for (int step = 0; step < kWarmUp_steps + kSteps; ++step) {
    StepCrowd(w, {}, kStep_s, &c);
    for (size_t i = 0; i < people && step >= kWarmUp_steps; ++i) walked_m += c.velocity[i].x * kStep_s;
    Join(people, &c);
  }
  return static_cast<float>(walked_m / (static_cast<double>(people) * kSteps * kStep_s));
}

TEST(Weidmann, SpeedFallsWithDensityAsMeasured) {
  const Walkable w = Corridor();
  double sum2 = 0;
  int count = 0;
  for (float density_pm2 : {0.3f, 0.6f, 1.0f, 1.5f, 2.0f, 2.5f, 3.0f, 3.5f, 4.0f}) {
    const float speed_mps = Speed_mps(w, density_pm2, 1), wanted_mps = Weidmann_mps(density_pm2);
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
