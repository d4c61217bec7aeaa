#include "runtime/show/looks.h"

#include <algorithm>

namespace flaneur {
namespace {

// From 0 to 1, by the multiples of a fraction that spread evenly.
float EvenlySpread(int id, float step) { return Fraction(static_cast<float>(id % 4096 + 1) * step); }

float Varied(float spread, int id, float step) { return 1 + spread * (2 * EvenlySpread(id, step) - 1); }

}  // namespace

// The same person wears the same all day, and people who came one after the other, as those of a group, wear different
// colours.
std::array<uint8_t, 3> TintsOf(const PackAvatar& avatar, int id) {
  constexpr float kLowDiscrepancySteps[] = {0.618034f, 0.754878f,
                                            0.569840f};  // fractions whose multiples spread evenly (Roberts 2018)
  std::array<uint8_t, 3> tints{};
  for (size_t t = 0; t < std::min(avatar.tints.size(), kMaxTints); ++t) {
    const auto count = static_cast<float>(avatar.tints[t].colors.size() + 1);
    tints[t] = static_cast<uint8_t>(EvenlySpread(id, kLowDiscrepancySteps[t]) * count);
  }
  return tints;
}

// Likewise for life; evenly over the avatar's spreads, and whether tall or not.
float SizeOf(const PackAvatar& avatar, int id) { return Varied(avatar.height_spread, id, 0.438579f); }
float BreadthOf(const PackAvatar& avatar, int id) { return Varied(avatar.breadth_spread, id, 0.671044f); }

}  // namespace flaneur
