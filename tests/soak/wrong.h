// What must hold whatever anybody does.
#pragma once
#include <cmath>
#include <string>

#include "runtime/simulation/simulation.h"

namespace flaneur {

// Empty: nothing is wrong.
inline std::string WhatIsWrong(const Simulation& s) {
  const CameraState& c = s.visitor.camera;
  for (float value : {c.view.position.x, c.view.position.y, c.view.yaw_rad, c.pitch_rad, c.velocity.x, c.velocity.y,
                      c.view.fov_rad}) {
    if (!std::isfinite(value)) return "the camera's state is not finite";
  }
  if (InsideObstacle(s.town.walkable, c.view.position)) return "the visitor stands in an obstacle";
  if (std::abs(c.yaw_rate_radps) > MaxYawRate_radps(s.control.settings) * 1.001f)
    return "the view turns faster than the crowd allows";
  if (c.view.fov_rad < 0.3f || c.view.fov_rad > 2.2f) return "the field of view left its range";
  for (size_t i = 0; i < s.town.crowd.size(); ++i) {
    if (!std::isfinite(s.town.crowd.position[i].x) || !std::isfinite(s.town.crowd.position[i].y))
      return "a person is nowhere";
  }
  return "";
}

}  // namespace flaneur
