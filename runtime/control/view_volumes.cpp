#include "runtime/control/view_volumes.h"

#include <cmath>

namespace flaneur {

float OuterApexBack_m(const MotionLimits& m, float fov_rad) {
  const float motion_m =
      (m.reach_m * m.yaw_rate_radps + m.camera_speed_mps + m.person_speed_mps) * m.step_s;
  return motion_m / std::sin(fov_rad / 2);
}

bool InWedge(Vec2 p, Vec2 apex, float yaw_rad, float fov_rad) {
  const Vec2 off = p - apex;
  const Vec2 axis{std::cos(yaw_rad), std::sin(yaw_rad)};
  const float along = Dot(off, axis), across = std::abs(Cross(axis, off));
  return along * std::sin(fov_rad / 2) >= across * std::cos(fov_rad / 2);
}

ViewClass Classify(Vec2 p, const ViewCamera& c, float outer_apex_back_m) {
  if (InWedge(p, c.position, c.yaw_rad, c.fov_rad)) return ViewClass::kVisible;
  const Vec2 back = c.position - Vec2{std::cos(c.yaw_rad), std::sin(c.yaw_rad)} * outer_apex_back_m;
  return InWedge(p, back, c.yaw_rad, c.fov_rad) ? ViewClass::kBoundary : ViewClass::kOutside;
}

}  // namespace flaneur
