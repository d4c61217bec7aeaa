#include "runtime/show/looks.h"

#include <algorithm>

namespace flaneur {

// The same person wears the same all day, and people who came one after the other, as those of a group, wear different
// colours.
std::array<uint8_t, 3> TintsOf(const PackAvatar& avatar, int id) {
  constexpr float kLowDiscrepancySteps[] = {0.618034f, 0.754878f,
                                            0.569840f};  // fractions whose multiples spread evenly (Roberts 2018)
  std::array<uint8_t, 3> tints{};
  for (size_t t = 0; t < std::min(avatar.tints.size(), kMaxTints); ++t) {
    const auto count = static_cast<float>(avatar.tints[t].colors.size() + 1);
    tints[t] = static_cast<uint8_t>(Fraction(static_cast<float>(id % 4096 + 1) * kLowDiscrepancySteps[t]) * count);
  }
  return tints;
}

// Likewise for life; evenly over the avatar's spread.
float SizeOf(const PackAvatar& avatar, int id) {
  constexpr float kLowDiscrepancyStep = 0.438579f;
  const float at = Fraction(static_cast<float>(id % 4096 + 1) * kLowDiscrepancyStep);
  return 1 + avatar.height_spread * (2 * at - 1);
}

}  // namespace flaneur
