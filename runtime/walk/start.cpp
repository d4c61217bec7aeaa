#include "runtime/walk/start.h"

#include "runtime/walk/visitor.h"

namespace flaneur {

void RememberStart(const VisitorInTown& v) {
  const CameraState& camera = v.visitor.camera;
  v.visitor.start = {camera.view.position, camera.view.yaw_rad, camera.pitch_rad};
}

void GoToStart(const VisitorInTown& v) {
  Visitor& visitor = v.visitor;
  visitor.leg = 0;
  visitor.leg_done = 0;
  visitor.point_walk = {};
  visitor.finished = false;
  visitor.camera.view.position = visitor.stuck_at = visitor.start.position_m;
  visitor.camera.view.yaw_rad = visitor.start.yaw_rad;
  visitor.camera.pitch_rad = visitor.start.pitch_rad;
  visitor.looks_about_s = visitor.stuck_s = 0;
  visitor.tour.paused = visitor.tour.holds = false;
  BeginTour(v);
  BringGuide(v);
  visitor.tour.begun = visitor.tour.stops.empty();
}

}  // namespace flaneur
