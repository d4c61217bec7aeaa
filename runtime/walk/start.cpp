#include "runtime/walk/start.h"

#include <algorithm>
#include <cmath>

#include "runtime/crowd/walkable.h"
#include "runtime/walk/visitor.h"

namespace flaneur {
namespace {

constexpr float kOpen_m = 30;        // a view is open enough
constexpr float kTownCounts = 0.5f;  // of a direction's length, for one that leads to the town
constexpr float kInTown_m = 20;      // and less for who is so near its middle

// The middle of what stands there; p where nothing does.
Vec2 MiddleOfTown(const Walkable& w, Vec2 p) {
  Vec2 sum;
  float weight = 0;
  for (const Walkable::Box& box : w.polygon_boxes) {
    const float area_m2 = (box.high.x - box.low.x) * (box.high.y - box.low.y);
    sum = sum + (box.low + box.high) * (0.5f * area_m2);
    weight += area_m2;
  }
  return weight > 0 ? sum * (1 / weight) : p;
}

}  // namespace

float OpenestView_rad(const Walkable& w, Vec2 p) {
  constexpr int kDirections = 32;
  const Vec2 to_town = MiddleOfTown(w, p) - p;
  const float counts = kTownCounts / std::max(Length(to_town), kInTown_m);
  float best_rad = 0, best = 0;
  for (int k = 0; k < kDirections; ++k) {
    const float yaw_rad = WrapAngle(2 * kPi * static_cast<float>(k) / kDirections);
    const Vec2 ahead{std::cos(yaw_rad), std::sin(yaw_rad)};
    float open_m = 0;
    while (open_m < kOpen_m && IsFree(w, p + ahead * open_m)) open_m += w.cell_m;
    const float worth = open_m * (1 + counts * Dot(ahead, to_town));
    if (worth > best) best_rad = yaw_rad, best = worth;
  }
  return best_rad;
}

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
