// What many people do together without being told: lanes in counterflow, room for a visitor, and none left behind.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/unit/runtime/crowd/corridor.h"

namespace flaneur {
namespace {

constexpr float kWidth_m = 6, kBand_m = 0.6f, kVisitor_mps = 1.2f, kPersonal_m = 0.6f;
constexpr uint64_t kSeeds = 3;

// Of the people in each band along the corridor, the surplus of those who walk one way, summed over the bands, over all
// people: 0 where both ways are as many in every band, 1 where no band is shared (after Yamori 1998, Going with the
// flow).
double BandIndex(const Corridor& corridor) {
  const Crowd& c = corridor.crowd;
  std::vector<int> surplus(static_cast<size_t>(kWidth_m / kBand_m) + 1, 0);
  for (size_t i = 0; i < corridor.people; ++i) {
    const bool east = c.fields[static_cast<size_t>(c.field[i])].goal.x > 0;
    surplus[static_cast<size_t>(c.position[i].y / kBand_m)] += east ? 1 : -1;
  }
  int sum = 0;
  for (int s : surplus) sum += std::abs(s);
  return static_cast<double>(sum) / static_cast<double>(corridor.people);
}

TEST(Flows, LanesFormInCounterflow) {
  double mixed = 0, late = 0, speed_mps = 0;
  for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Corridor corridor = MakeCorridor(kWidth_m, 0.75f, 0.5f, seed);
    mixed += BandIndex(corridor) / kSeeds;
    for (int step = 0; step < 1800; ++step) {
      StepCorridor({}, &corridor);
      if (step >= 1500)
        late += BandIndex(corridor) / (300 * kSeeds), speed_mps += SpeedAlong_mps(corridor) / (300 * kSeeds);
    }
  }
  std::printf("lanes at 0.75 people/m2: band index %.2f mixed at the start, %.2f after 50 s; %.2f m/s\n", mixed, late,
              speed_mps);
  EXPECT_GE(late, 0.6);
  EXPECT_GE(late, 2 * mixed);
}

// People in a box about p, to the square metre.
double Density_pm2(const Corridor& corridor, Vec2 p) {
  constexpr float kHalf_m = 0.9f;
  int inside = 0;
  for (Vec2 q : corridor.crowd.position)
    inside += std::abs(q.x - p.x) < kHalf_m && std::abs(q.y - p.y) < kHalf_m ? 1 : 0;
  return inside / (4.0 * kHalf_m * kHalf_m);
}

// Somebody walks through the middle of a crowd that walks both ways, straight on, whoever is there.
TEST(Flows, ACrowdPartsForAVisitorAndClosesAgain) {
  double ahead_pm2 = 0, at_pm2 = 0, behind_pm2 = 0;
  int looks = 0, entered = 0;
  for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Corridor corridor = MakeCorridor(kWidth_m, 0.75f, 0.5f, seed);
    for (int step = 0; step < 300; ++step) StepCorridor({}, &corridor);
    MovingObstacle visitor{{2, kWidth_m / 2}, kPersonal_m, true, {kVisitor_mps, 0}};
    while (visitor.center.x < kCorridorLength_m - 5) {
      visitor.center = visitor.center + visitor.velocity * kCorridorStep_s;
      StepCorridor({visitor}, &corridor);
      if (visitor.center.x < 6) continue;
      for (Vec2 p : corridor.crowd.position) entered += Length(p - visitor.center) < kPersonal_m ? 1 : 0;
      ahead_pm2 += Density_pm2(corridor, visitor.center + Vec2{4, 0});
      at_pm2 += Density_pm2(corridor, visitor.center);
      behind_pm2 += Density_pm2(corridor, visitor.center - Vec2{4, 0});
      ++looks;
    }
  }
  std::printf(
      "visitor in 0.75 people/m2: %.2f people/m2 4 m ahead, %.2f around the visitor, %.2f 4 m behind; %d steps of "
      "anybody "
      "within %.1f m\n",
      ahead_pm2 / looks, at_pm2 / looks, behind_pm2 / looks, entered, static_cast<double>(kPersonal_m));
  EXPECT_EQ(entered, 0);
  EXPECT_LE(at_pm2, 0.5 * ahead_pm2);
  EXPECT_GE(behind_pm2, 0.6 * ahead_pm2);
}

}  // namespace
}  // namespace flaneur
