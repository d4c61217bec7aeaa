// A head in a headset, as people are classed by: one wedge on the ground that holds what both eyes see.
#pragma once
#include <span>

#include "runtime/control/view_volumes.h"

namespace flaneur {

// What one eye sees; it may roll, and look past its own middle. Ground axes, unit vectors; tangents of the angles from
// `ahead` to each side, the right and the upper one positive.
struct EyeFrustum {
  Vec3 place;
  Vec3 ahead{1, 0, 0}, right{0, -1, 0}, up{0, 0, 1};
  float left_tangent = -1, right_tangent = 1, lower_tangent = -1, upper_tangent = 1;
};

// Heads turn by up to 600 degrees a second when gaze leaps to the side, and some athletes' faster. With this as the
// limits' yaw rate the outer volume holds for a head as it does for hands (OuterApexBack_m): a turn about any axis
// moves what is level with the eye, as people are, by no more than the same turn about the vertical.
inline constexpr float kHeadTurn_radps = 800 * kPi / 180;
// From the body on, nearer than which nobody comes who should be seen at the edge of an eye's picture.
inline constexpr float kNearestToHead_m = 0.5f;

struct HeadView {
  bool is_bounded = false;         // else an eye looks straight up or down, and sees to all sides
  float yaw_rad = 0, fov_rad = 1;  // of the wedge
  float pitch_rad = 0;
};

// `place`: of the body, beside which the head may lean a little. Whatever an eye sees farther than kNearestToHead_m
// from it lies within the wedge from the place with that yaw and field of view.
HeadView ViewOfHead(Vec2 place, std::span<const EyeFrustum> eyes);
// The same as a camera's, also of a head that is not bounded: then as wide as a wedge can be, and pitched.
inline constexpr float kWidestHead_rad = 170 * kPi / 180;

}  // namespace flaneur
