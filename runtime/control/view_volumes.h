// Inner and outer view volume on the ground plane (paper, section 3.1).
#pragma once
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
  float reach_m = 300;  // nobody is farther from the camera than this
};

// How far the outer volume's apex must lie behind the camera so that nobody becomes visible without having been in the
// boundary in the step before (paper, section 4.3.1).
//
// Seen from the camera, in one step a person moves by at most
//   d = reach * yaw_rate * step          (the turn, an arc at the distance `reach`)
//     + (camera_speed + person_speed) * step.
// The outer wedge's edges are parallel to the inner one's at the distance b sin(fov / 2), and its apex is b >= b
// sin(fov / 2) away from the inner apex; so it holds every point within b sin(fov / 2) of the inner wedge. Whoever is
// inside the inner wedge after the step was within d of it before, and therefore in the outer wedge where b sin(fov /
// 2) >= d.
float OuterApexBack_m(const MotionLimits& limits, float fov_rad);

bool InWedge(Vec2 p, Vec2 apex, float yaw_rad, float fov_rad);
ViewClass Classify(Vec2 p, const ViewCamera& camera, float outer_apex_back_m);

// Both volumes with their sines and cosines, to class many people at once.
struct ViewVolumes {
  Vec2 inner_apex, outer_apex, axis;
  float sine = 0, cosine = 1;  // of half the field of view
};
ViewVolumes VolumesOf(const ViewCamera& camera, float outer_apex_back_m);

inline bool InWedge(Vec2 p, Vec2 apex, const ViewVolumes& v) {
  const Vec2 off = p - apex;
  return Dot(off, v.axis) * v.sine >= std::abs(Cross(v.axis, off)) * v.cosine;
}
// The inner volume lies within the outer one.
inline ViewClass Classify(Vec2 p, const ViewVolumes& v) {
  return static_cast<ViewClass>(InWedge(p, v.inner_apex, v) + InWedge(p, v.outer_apex, v));
}

}  // namespace flaneur
