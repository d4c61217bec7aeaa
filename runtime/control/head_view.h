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

// Heads turn by up to 600 degrees a second when gaze leaps to the side, and some athletes' faster; they lean and step
// beside the body's walk.
inline constexpr float kHeadTurn_radps = 800 * kPi / 180, kHeadSpeed_mps = 2;
// A turn about any axis moves what is above or below the eye as if it were farther away than on the ground, by no more
// than it is above or below.
inline constexpr float kHeadReach_m = 3;

struct HeadView {
  bool is_bounded = false;         // else an eye looks straight up or down, and sees to all sides
  float yaw_rad = 0, fov_rad = 1;  // of the wedge
  float aside_m = 0;               // how far an eye is from the place at most, on the ground
};

// `place`: of the body. The pictures of all eyes lie within the wedge of that yaw and field of view whose apex is
// `Behind` the place by aside_m.
HeadView ViewOfHead(Vec2 place, std::span<const EyeFrustum> eyes);

// A wedge that holds the one of the camera from every apex within aside_m of it.
ViewCamera Behind(const ViewCamera& camera, float aside_m);

// The same limits for a head instead of hands, see OuterApexBack_m.
MotionLimits WithHead(MotionLimits limits);

}  // namespace flaneur
