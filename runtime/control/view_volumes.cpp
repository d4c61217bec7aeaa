#include "runtime/control/view_volumes.h"

#include <cmath>

namespace flaneur {

float OuterApexBack_m(const MotionLimits& m, float fov_rad) {
  const float motion_m = (m.reach_m * m.yaw_rate_radps + m.camera_speed_mps + m.person_speed_mps) * m.step_s;
  return (motion_m + m.reach_grows_m) / std::sin(fov_rad / 2);
}

ViewVolumes VolumesOf(const ViewCamera& c, float outer_apex_back_m) {
  const Vec2 axis{std::cos(c.yaw_rad), std::sin(c.yaw_rad)};
  return {c.position, c.position - axis * outer_apex_back_m, axis, std::sin(c.fov_rad / 2), std::cos(c.fov_rad / 2)};
}

ViewClass Classify(Vec2 p, float reach_m, const ViewCamera& camera, float outer_apex_back_m) {
  return Classify(p, reach_m, VolumesOf(camera, outer_apex_back_m));
}

// A plane a metre below or above the eye shows within the four corners of the picture, or within two and the horizon,
// whose directions lie within the wedge; so whatever of it lies farthest from the wedge is a corner.
ViewTilt TiltOf(float pitch_rad, float fov_rad, float aspect) {
  constexpr float kLevel = 1e-4f;
  ViewTilt tilt;
  const float right = std::tan(fov_rad / 2), sine = std::sin(fov_rad / 2), cosine = std::cos(fov_rad / 2);
  for (const float up : {-right / aspect, right / aspect}) {
    const float ahead = std::cos(pitch_rad) - up * std::sin(pitch_rad);
    const float rise = std::sin(pitch_rad) + up * std::cos(pitch_rad);
    if (std::abs(rise) < kLevel) continue;
    const bool before_apex = ahead * cosine + right * sine >= 0;
    const float beyond = before_apex ? right * cosine - ahead * sine : std::hypot(right, ahead);
    float& most = rise < 0 ? tilt.below : tilt.above;
    most = std::max(most, beyond / std::abs(rise));
  }
  return tilt;
}

// Straight down a corner is farthest aside.
float MostTilt(float fov_rad, float aspect) {
  const float right = std::tan(fov_rad / 2);
  return std::hypot(right, right / aspect);
}

void Smooth(const ViewMotion& motion, float step_s, ViewMotion* smoothed) {
  constexpr float kSmoothing_s = 0.3f;
  const float share = std::min(1.0f, step_s / kSmoothing_s);
  smoothed->velocity = smoothed->velocity + (motion.velocity - smoothed->velocity) * share;
  smoothed->yaw_rate_radps += (motion.yaw_rate_radps - smoothed->yaw_rate_radps) * share;
}

}  // namespace flaneur
