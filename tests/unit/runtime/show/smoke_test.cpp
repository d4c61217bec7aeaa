// Smoke that rises over chimneys.
#include "runtime/show/smoke.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace flaneur {
namespace {

TourData Chimneys(int count, float apart_m) {
  TourData tour;
  for (int k = 0; k < count; ++k) tour.smokes.push_back({{apart_m * static_cast<float>(k), 0, 10}});
  return tour;
}

FrameInput Seen(const TourData& tour, Vec3 eye, float time_s) {
  FrameInput frame;
  frame.eye = eye;
  AddSmoke(tour, time_s, &frame);
  return frame;
}

TEST(SmokeOverChimneys, RisesAndDriftsWithTheWindAndWidens) {
  TourData tour = Chimneys(1, 0);
  tour.wind = {kPi / 2, 2};
  for (float time_s = 0; time_s < 40; time_s += 3.7f) {
    const FrameInput frame = Seen(tour, {0, -30, 1.7f}, time_s);
    ASSERT_GT(frame.smoke.size(), 5u);
    for (const SmokePuff& puff : frame.smoke) {
      EXPECT_GE(puff.position.z, 10);
      EXPECT_LE(puff.density, tour.smokes[0].density);
      if (puff.position.z < 13) continue;
      EXPECT_GT(puff.position.y, 1) << "to the north, where the wind blows to";
      EXPECT_GT(puff.radius_m, tour.smokes[0].width_m);
    }
  }
}

TEST(SmokeOverChimneys, MovesWithoutALeapAndComesAndGoesUnseen) {
  const TourData tour = Chimneys(1, 0);
  for (float time_s = 0; time_s < 20; time_s += 0.033f) {
    const auto before = Seen(tour, {0, -30, 1.7f}, time_s).smoke,
               now = Seen(tour, {0, -30, 1.7f}, time_s + 0.033f).smoke;
    for (const SmokePuff& puff : now) {
      const bool known = std::any_of(before.begin(), before.end(), [&](const SmokePuff& b) {
        return Length(b.position - puff.position) < 0.15f && std::abs(b.density - puff.density) < 0.03f;
      });
      EXPECT_TRUE(known || puff.density < 0.03f) << time_s << " " << puff.density;
    }
  }
}

TEST(SmokeOverChimneys, IsDrawnFarthestFirstAndOfTheNearestChimneysAlone) {
  const FrameInput frame = Seen(Chimneys(200, 3), {100, -5, 1.7f}, 9);
  EXPECT_LE(frame.smoke.size(), kPuffs * kMostSmokes);
  float last_m = 1e9f;
  for (const SmokePuff& puff : frame.smoke) {
    const float away_m = Length(puff.position - frame.eye);
    EXPECT_LE(away_m, last_m);
    last_m = away_m;
  }
  EXPECT_TRUE(Seen(Chimneys(3, 5), {0, 500, 1.7f}, 9).smoke.empty());
}

// Whoever walks past two hundred chimneys sees none light up at once.
TEST(SmokeOverChimneys, NoChimneyBeginsToSmokeAtOnceAsOneWalks) {
  const TourData tour = Chimneys(200, 3);
  const auto thickest = [&](float x) {
    std::map<int, float> by_place;  // by chimney, roughly: the wind is the same for all
    for (const SmokePuff& puff : Seen(tour, {x, -5, 1.7f}, 4).smoke) {
      float& most = by_place[static_cast<int>(std::lround(puff.position.x * 20))];
      most = std::max(most, puff.density);
    }
    return by_place;
  };
  for (float x = 100; x < 130; x += 0.1f) {
    const auto before = thickest(x), now = thickest(x + 0.1f);
    for (const auto& [place, density] : now) {
      const auto same = before.find(place);
      EXPECT_LT(std::abs(density - (same == before.end() ? 0 : same->second)), 0.05f) << x;
    }
  }
}

TEST(SmokeOverChimneys, FillsNobodysView) {
  TourData tour = Chimneys(1, 0);
  tour.smokes[0].density = 1;
  for (float time_s = 0; time_s < 20; time_s += 0.9f) {
    for (const SmokePuff& puff : Seen(tour, {0.5f, 0, 12}, time_s).smoke) {
      if (Length(puff.position - Vec3{0.5f, 0, 12}) < puff.radius_m) {
        ADD_FAILURE() << "the eye is in a puff";
      }
    }
  }
}

}  // namespace
}  // namespace flaneur
