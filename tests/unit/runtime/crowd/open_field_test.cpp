// The open field of open_field.h with 1,000 people: nobody overlaps, and people get on. Everybody goes from place to
// place of a lattice of 8 x 8 over the field, drawn anew at each arrival, all alike likely: ways cross everywhere, most
// of all in the middle, where it is about twice as dense as on average. Overlapping: closer than 0.45 m from centre to
// centre. Progress: metres nearer to the goal as the crow flies, over the metres that the preferred speed would have
// made in the time, of everybody (0.95 of somebody alone: the obstacles stand in the way).
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/unit/runtime/crowd/open_field.h"

namespace flaneur {
namespace {

constexpr float kOverlap_m = 0.45f;
constexpr int kWarmUp_steps = 300, kSteps = 900, kLookEvery_steps = 30;

int OverlappingPairs(const Crowd& c) {
  int pairs = 0;
  for (size_t i = 0; i < c.size(); ++i) {
    for (size_t j = 0; j < i; ++j) {
      const Vec2 apart = c.position[i] - c.position[j];
      pairs += Dot(apart, apart) < kOverlap_m * kOverlap_m ? 1 : 0;
    }
  }
  return pairs;
}

TEST(OpenField, NobodyOverlapsAndPeopleGetOn) {
  double progress_m = 0, preferred_m = 0;
  int overlapping = 0;
  for (uint64_t seed : {1, 2}) {
    OpenField field = MakeOpenField(1000, 8, seed);
    Crowd& c = field.crowd;
    for (int step = 0; step < kWarmUp_steps + kSteps; ++step) {
      const std::vector<Vec2> before = c.position;
      const std::vector<int> heading_for = c.field;
      StepOpenField(&field);
      if (step < kWarmUp_steps) continue;
      if (step % kLookEvery_steps == 0) overlapping += OverlappingPairs(c);
      for (size_t i = 0; i < c.size(); ++i) {
        const Vec2 goal = c.fields[static_cast<size_t>(heading_for[i])].goal;
        progress_m += Length(goal - before[i]) - Length(goal - c.position[i]);
        preferred_m += c.preferred_mps[i] * kOpenFieldStep_s;
      }
    }
  }
  const double progress = progress_m / preferred_m;
  std::printf("open field, 1,000 people: %d overlapping pairs in all looks, progress %.3f\n", overlapping, progress);
  EXPECT_EQ(overlapping, 0);
  EXPECT_GE(progress, 0.80);
}

}  // namespace
}  // namespace flaneur
