#include "runtime/show/smoke.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/show/looks.h"
#include "runtime/show/wind.h"

namespace flaneur {
namespace {

constexpr float kLife_s = 16;
constexpr float kRise_mps = 0.8f, kCools_s = 4, kDrift_mps = 0.2f;  // at the mouth, how fast that ends, and for good
constexpr float kWidens_mps = 0.13f;                                // of the radius
constexpr float kFadeOut = 0.25f;                                   // of the reach, over which smoke thins out
constexpr float kBeforeEye_m = 5;  // nearer puffs thin out too: they would fill the view

// Unit, and the same number for the same puff.
float Chance(size_t chimney, int puff, float salt) {
  return Fraction(
      std::sin(static_cast<float>(chimney % 1000) * 12.9898f + static_cast<float>(puff % 1000) * 78.233f + salt) *
      4375.85f);
}

SmokePuff PuffOf(const Smoke& smoke, size_t chimney, int which, const WindSettings& wind, float time_s) {
  const float turns = time_s / kLife_s + static_cast<float>(which) / static_cast<float>(kPuffs) + Chance(chimney, 0, 5);
  const float part = Fraction(turns), age_s = part * kLife_s;
  const int number = which + kPuffs * static_cast<int>(std::floor(turns));
  const float cooled_s = kCools_s * (1 - std::exp(-age_s / kCools_s));
  // Near the mouth the chimney and its own heat keep it from the wind.
  const Vec2 drift = WindAt(wind, time_s - age_s) * (age_s - cooled_s / 2);
  const Vec2 own = {Chance(chimney, number, 1) - 0.5f, Chance(chimney, number, 2) - 0.5f};
  SmokePuff puff;
  puff.position =
      smoke.position_m + Vec3{drift.x + own.x * 0.15f * age_s, drift.y + own.y * 0.15f * age_s,
                              kRise_mps * cooled_s + kDrift_mps * age_s * (0.7f + 0.6f * Chance(chimney, number, 3))};
  puff.radius_m = smoke.width_m * 0.7f + kWidens_mps * age_s * (0.8f + 0.4f * Chance(chimney, number, 4));
  puff.density = smoke.density * std::min(1.0f, 16 * part) * std::pow(1 - part, 1.6f);
  puff.turn_rad = 2 * kPi * Chance(chimney, number, 6) + 0.1f * age_s;
  return puff;
}

}  // namespace

void AddSmoke(const TourData& tour, float time_s, FrameInput* frame) {
  frame->smoke.clear();
  std::array<std::pair<float, size_t>, kMostSmokes + 1> near;  // and the next one, where they end
  size_t found = 0;
  for (size_t k = 0; k < tour.smokes.size(); ++k) {
    const float away_m = Length(tour.smokes[k].position_m - frame->eye);
    if (away_m >= kSmokeReach_m || (found == near.size() && away_m >= near.back().first)) continue;
    found = std::min(found + 1, near.size());
    size_t at = found - 1;
    for (; at > 0 && near[at - 1].first > away_m; --at) near[at] = near[at - 1];
    near[at] = {away_m, k};
  }
  const float reach_m = found == near.size() ? near.back().first : kSmokeReach_m;
  for (size_t n = 0; n < std::min(found, kMostSmokes); ++n) {
    const auto [away_m, k] = near[n];
    const float seen = std::min(1.0f, (reach_m - away_m) / (kFadeOut * reach_m));
    for (int which = 0; which < kPuffs; ++which) {
      SmokePuff puff = PuffOf(tour.smokes[k], k, which, tour.wind, time_s);
      const float clear_m = Length(puff.position - frame->eye) - puff.radius_m;
      puff.density *= seen * std::clamp(clear_m / kBeforeEye_m, 0.0f, 1.0f);
      if (puff.density > 0.004f) frame->smoke.push_back(puff);
    }
  }
  const auto away = [&](const SmokePuff& puff) { return Length(puff.position - frame->eye); };
  std::sort(frame->smoke.begin(), frame->smoke.end(),
            [&](const SmokePuff& a, const SmokePuff& b) { return away(a) > away(b); });
}

}  // namespace flaneur
