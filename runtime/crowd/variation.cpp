#include "runtime/crowd/variation.h"

namespace flaneur {
namespace {

constexpr int kSwings = 4;
constexpr uint32_t kMix[kSwings] = {0x9e3779b1u, 0x85ebca77u, 0xc2b2ae3du, 0x27d4eb2fu};

constexpr uint32_t FrequencyOf(float swings_ps) {
  return static_cast<uint32_t>(swings_ps * (4294967296.0f / kClock_ps));
}
constexpr uint32_t kSlowest[kSwings] = {FrequencyOf(kSlowSwing_ps[0]), FrequencyOf(kQuickSwing_ps[0]),
                                        FrequencyOf(kSlowSwing_ps[0]), FrequencyOf(kQuickSwing_ps[0])};
constexpr uint32_t kSpan[kSwings] = {
    FrequencyOf(kSlowSwing_ps[1] - kSlowSwing_ps[0]), FrequencyOf(kQuickSwing_ps[1] - kQuickSwing_ps[0]),
    FrequencyOf(kSlowSwing_ps[1] - kSlowSwing_ps[0]), FrequencyOf(kQuickSwing_ps[1] - kQuickSwing_ps[0])};
constexpr float kDeviation = 1.3693064f;  // over a swing of two parabolas up to 1: sqrt(15 / 8)

}  // namespace

Variation VariationAt(uint32_t clock, int number) {
  float swing[kSwings];
  const float own = static_cast<float>((static_cast<uint32_t>(number) + 1) * 0x9e3779b1u >> 16) * 0x1p-16f;
  const float height = kVariesLeast + (kVariesMost - kVariesLeast) * own * own;
  for (int k = 0; k < kSwings; ++k) {  // side by side
    uint32_t hash = (static_cast<uint32_t>(number) + 1) * kMix[k];
    hash = (hash ^ hash >> 15) * 0x2c1b3c6du;
    hash = (hash ^ hash >> 12) * 0x297a2d39u;
    hash ^= hash >> 15;
    const uint32_t frequency = kSlowest[k] + (kSpan[k] * (hash & 0xff) >> 8);
    const float turn = static_cast<float>(static_cast<int32_t>(clock * frequency + hash)) * 0x1p-31f;
    swing[k] = 4 * kDeviation * height * turn * (1 - (turn < 0 ? -turn : turn));
  }
  return {swing[0], swing[1], swing[2], swing[3]};
}

}  // namespace flaneur
