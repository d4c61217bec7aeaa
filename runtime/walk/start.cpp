#include "runtime/walk/start.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "runtime/crowd/walkable.h"
#include "runtime/walk/visitor.h"

namespace flaneur {
namespace {

// What one sees best is a facade across a square: farther than this, so that it is whole, and no farther than that.
constexpr float kWhole_m = 28, kNear_m = 80, kFarthest_m = 200;
constexpr float kNothing = 0.3f;     // worth of a ray that meets nothing, where one that meets such a facade has 1
constexpr float kTownCounts = 0.1f;  // of a direction's worth, for one that leads to the town's middle
constexpr float kSmall_m = 3;  // a post, a cart, a trunk: one looks past it, but for what is right before the eyes
constexpr float kRightBefore_m = 4;
constexpr int kRays = 96, kInView = 8;  // of the circle; to either side of a direction: 60 degrees in all

using Distances = std::array<float, kRays>;

float AngleOfRay(int ray) { return WrapAngle(2 * kPi * static_cast<float>(ray) / kRays); }

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

// Rays end where they meet the line from a to b, both seen from where they start, and no farther than most_m.
void EndRays(Vec2 a, Vec2 b, float most_m, Distances* far_m) {
  const float from = std::atan2(a.y, a.x), turn = WrapAngle(std::atan2(b.y, b.x) - from), step = 2 * kPi / kRays;
  const float low = turn < 0 ? from + turn : from, high = turn < 0 ? from : from + turn;
  for (int k = static_cast<int>(std::ceil(low / step)); static_cast<float>(k) * step <= high; ++k) {
    const size_t ray = static_cast<size_t>((k % kRays + kRays) % kRays);
    const float across = Cross(DirectionOf(AngleOfRay(static_cast<int>(ray))), b - a);
    const float at_m = across == 0 ? Length(a) : Cross(a, b - a) / across;
    if (at_m > 0 && at_m < most_m) far_m->at(ray) = std::min(far_m->at(ray), at_m);
  }
}

void EndAtRing(const std::vector<Vec2>& ring, Vec2 p, float most_m, Distances* far_m) {
  for (size_t i = 0; i < ring.size(); ++i) EndRays(ring[i] - p, ring[(i + 1) % ring.size()] - p, most_m, far_m);
}

// Along each ray from p to what stands there.
Distances OpenAround(const Walkable& w, Vec2 p) {
  Distances far_m;
  far_m.fill(kFarthest_m);
  for (size_t k = 0; k < w.polygons.size(); ++k) {
    const Walkable::Box& box = w.polygon_boxes[k];
    const Vec2 aside{std::max({box.low.x - p.x, p.x - box.high.x, 0.0f}),
                     std::max({box.low.y - p.y, p.y - box.high.y, 0.0f})};
    const Vec2 size = box.high - box.low;
    const float most_m = std::max(size.x, size.y) < kSmall_m ? kRightBefore_m : kFarthest_m;
    if (Length(aside) > most_m) continue;
    EndAtRing(w.polygons[k].outer, p, most_m, &far_m);
    for (const std::vector<Vec2>& yard : w.polygons[k].holes) EndAtRing(yard, p, most_m, &far_m);
  }
  return far_m;
}

float WorthOfRay(float far_m) {
  if (far_m >= kFarthest_m) return kNothing;
  const float lost = std::max(far_m - kNear_m, 0.0f) / (kFarthest_m - kNear_m);
  return std::min(far_m / kWhole_m, 1.0f) * (1 - lost * (1 - kNothing));
}

}  // namespace

float BestView_rad(const Walkable& w, Vec2 p) {
  const Vec2 to_town = Unit(MiddleOfTown(w, p) - p);
  const Distances far_m = OpenAround(w, p);
  float best_rad = 0, best = -1;
  for (int k = 0; k < kRays; ++k) {
    float worth = 0;
    for (int to = -kInView; to <= kInView; ++to) {
      const float middle = static_cast<float>(kInView + 1 - std::abs(to));  // what is in the middle counts more
      worth += middle * WorthOfRay(far_m[static_cast<size_t>((k + to + kRays) % kRays)]);
    }
    worth *= 1 + kTownCounts * Dot(DirectionOf(AngleOfRay(k)), to_town);
    if (worth > best) best_rad = AngleOfRay(k), best = worth;
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
