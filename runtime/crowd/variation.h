// How a person's pace and course vary on their own: nobody walks as evenly as a machine. Internal to runtime/crowd.
#pragma once
#include <cstdint>

namespace flaneur {

// Of time, for what swings slowly: no rounding grows, and it may wrap.
inline constexpr float kClock_ps = 65536;
inline uint32_t ClockAt(int64_t step, float step_s) {
  return static_cast<uint32_t>(step) * static_cast<uint32_t>(kClock_ps * step_s + 0.5f);
}

// Pace and course vary on their own, by so much of the pace and so many radians (standard deviations): who hurries
// walks evenly, who strolls does not. Amounts and frequencies by recordings of pavements and a campus (ETH, UCY):
// bench_walking.
inline constexpr float kSlowSwing_ps[] = {0.05f, 0.13f}, kQuickSwing_ps[] = {0.15f, 0.55f};
inline constexpr float kHurries_mps = 1.1f, kStrolls_mps = 0.7f;
inline constexpr float kSlowPace[] = {0.09f, 0.17f}, kQuickPace[] = {0.03f, 0.36f};  // who hurries, who strolls
inline constexpr float kSlowCourse_rad[] = {0.03f, 0.06f}, kQuickCourse_rad[] = {0.035f, 0.19f};
// Most of it comes with others near, but in a throng they leave no choice (people a square metre).
inline constexpr float kCompany_pm2[] = {0, 0.05f}, kAlone = 0.3f;  // share of it that is left to who walks alone
inline constexpr float kThrong_pm2[] = {0.35f, 0.75f};
// They end near the goal, beside walls, and for whoever is held up.
inline constexpr float kVariesFromGoal_m[] = {1.5f, 3.0f}, kVariesFromWall_m[] = {0.05f, 0.4f};
inline constexpr float kVariesGettingOn[] = {0.2f, 0.6f};  // share of the speed that they want, of late
// Some vary less, some more: from the least to the most by the square of a number from 0 to 1; 1 in the mean.
inline constexpr float kVariesLeast = 0.6f, kVariesMost = 1.8f;

// Each a mean of zero and a standard deviation of one over some minutes; two swings each, a slow one and a quick one.
struct Variation {
  float slow_pace = 0, quick_pace = 0, slow_course = 0, quick_course = 0;
};

// At this moment for whoever has the number; the same number swings alike.
Variation VariationAt(uint32_t clock, int number);

// From 0 to 1, all alike likely: what somebody with the number has of their own, of several such things.
inline float OwnShare(int number, uint32_t which) {
  uint32_t hash = static_cast<uint32_t>(number) * 0x9e3779b9u ^ which * 0x85ebca6bu;
  hash = (hash ^ hash >> 15) * 0x2c1b3c6du;
  hash = (hash ^ hash >> 12) * 0x297a2d39u;
  return static_cast<float>((hash ^ hash >> 15) >> 8) * 0x1p-24f;
}

}  // namespace flaneur
