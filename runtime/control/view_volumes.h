// Inner and outer view volume on the ground plane (paper, section 3.1).
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "runtime/base/math.h"
#include "runtime/crowd/crowd.h"

namespace flaneur {

struct ViewCamera {
  Vec2 position;
  float yaw_rad = 0;
  float fov_rad = 1.0472f;  // horizontal, below pi
};

// Of a camera.
struct ViewMotion {
  Vec2 velocity;
  float yaw_rate_radps = 0;
};

// Brings `smoothed` nearer to the motion in this step: an average over about 0.3 s.
void Smooth(const ViewMotion& motion, float step_s, ViewMotion* smoothed);

struct MotionLimits {
  float yaw_rate_radps = 2.1f;
  float camera_speed_mps = 3;
  float person_speed_mps = 2;
  float step_s = 1.0f / 30;
  float reach_m = 300;      // nobody is farther from the camera than this
  float reach_grows_m = 0;  // a person's reach into the view grows by no more in a step, as the camera pitches
};

// How far the outer volume's apex must lie behind the camera so that nobody becomes visible without having been in the
// boundary in the step before (paper, section 4.3.1).
//
// Seen from the camera, in one step a person moves by at most
//   d = reach * yaw_rate * step          (the turn, an arc at the distance `reach`)
//     + (camera_speed + person_speed) * step,
// and their reach grows by `reach_grows` at most. The outer wedge's edges are parallel to the inner one's at the
// distance b sin(fov / 2), and its apex is b >= b sin(fov / 2) away from the inner apex; so it holds every point within
// b sin(fov / 2) of the inner wedge. Whose reach r meets the inner wedge after the step was within r + d of it before,
// and therefore within r - reach_grows of the outer wedge where b sin(fov / 2) >= d + reach_grows.
float OuterApexBack_m(const MotionLimits& limits, float fov_rad);

// reach_m: how far the person reaches from p, where they stand; of whom any part lies in a volume is in it.
ViewClass Classify(Vec2 p, float reach_m, const ViewCamera& camera, float outer_apex_back_m);

// Both volumes with their sines and cosines, to class many people at once.
struct ViewVolumes {
  Vec2 inner_apex, outer_apex, axis;
  float sine = 0, cosine = 1;  // of half the field of view
};
ViewVolumes VolumesOf(const ViewCamera& camera, float outer_apex_back_m);

// Whether the disc of this radius about p meets the wedge. Seen from an apex that lies outside it, the disc widens the
// half angle by asin(reach / distance).
inline bool Meets(Vec2 p, float reach_m, Vec2 apex, const ViewVolumes& v) {
  const Vec2 off = p - apex;
  const float ahead = Dot(off, v.axis), aside = std::abs(Cross(v.axis, off));
  const float beyond_m = aside * v.cosine - ahead * v.sine;  // the nearer edge's line
  if (beyond_m <= 0) return true;
  return beyond_m <= reach_m && (ahead * v.cosine + aside * v.sine >= 0 || Dot(off, off) <= reach_m * reach_m);
}
// The inner volume lies within the outer one.
inline ViewClass Classify(Vec2 p, float reach_m, const ViewVolumes& v) {
  return static_cast<ViewClass>(Meets(p, reach_m, v.inner_apex, v) + Meets(p, reach_m, v.outer_apex, v));
}

// The wedge is exact for a level camera. One that is pitched sees farther aside near its feet or over its head: of what
// is so many metres below or above the eye, so much per metre more than the wedge.
struct ViewTilt {
  float below = 0, above = 0;
};
ViewTilt TiltOf(float pitch_rad, float fov_rad, float aspect);
// At any pitch.
float MostTilt(float fov_rad, float aspect);
// Of somebody whose feet and head are so high above the eye.
inline float TiltReach_m(const ViewTilt& tilt, float feet_m, float head_m) {
  return std::max({0.0f, -feet_m * tilt.below, head_m * tilt.above});
}

}  // namespace flaneur
