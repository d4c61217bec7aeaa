#include "runtime/control/view_volumes.h"

#include <algorithm>
#include <cmath>

namespace flaneur {

float OuterApexBack_m(const MotionLimits& m, float fov_rad) {
  const float motion_m = (m.reach_m * m.yaw_rate_radps + m.camera_speed_mps + m.person_speed_mps) * m.step_s;
  return motion_m / std::sin(fov_rad / 2);
}

bool InWedge(Vec2 p, Vec2 apex, float yaw_rad, float fov_rad) {
  return InWedge(p, apex, VolumesOf({apex, yaw_rad, fov_rad}, 0));
}

ViewVolumes VolumesOf(const ViewCamera& c, float outer_apex_back_m) {
  const Vec2 axis{std::cos(c.yaw_rad), std::sin(c.yaw_rad)};
  return {c.position, c.position - axis * outer_apex_back_m, axis, std::sin(c.fov_rad / 2), std::cos(c.fov_rad / 2)};
}

ViewClass Classify(Vec2 p, const ViewCamera& camera, float outer_apex_back_m) {
  return Classify(p, VolumesOf(camera, outer_apex_back_m));
}

void Smooth(const ViewMotion& motion, float step_s, ViewMotion* smoothed) {
  constexpr float kSmoothing_s = 0.3f;
  const float share = std::min(1.0f, step_s / kSmoothing_s);
  smoothed->velocity = smoothed->velocity + (motion.velocity - smoothed->velocity) * share;
  smoothed->yaw_rate_radps += (motion.yaw_rate_radps - smoothed->yaw_rate_radps) * share;
}

}  // namespace flaneur
