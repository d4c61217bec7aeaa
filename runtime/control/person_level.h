// How a person is drawn in this step: what the control decides, and all that a picture needs to know of it.
#pragma once
#include <algorithm>

#include "runtime/tour_data/level.h"

namespace flaneur {

inline constexpr float kFade_s = 0.3f;
inline constexpr float kLongAgo_s = 1e6f;

// Who changes their level is drawn with both for a moment, so that nobody pops; the triangle budget is about both.
struct PersonLevel {
  Level level, from;
  float age_s = kLongAgo_s;  // since the change. `from` is kept for a step beyond kFade_s, for pictures between that
                             // step and the one before

  bool operator==(const PersonLevel&) const = default;
};

// Share of the change that was over so long before this step, 0 to 1.
inline float ShareOf(const PersonLevel& p, float before_s) {
  return std::clamp((p.age_s - before_s) / kFade_s, 0.0f, 1.0f);
}
// With either level.
inline bool IsDrawn(const PersonLevel& p) { return IsDrawn(p.level) || IsDrawn(p.from); }

}  // namespace flaneur
