#include "runtime/visit/attract.h"

#include <algorithm>
#include <cmath>

#include "runtime/crowd/fast_math.h"

namespace flaneur {
namespace {

constexpr float kSpeed_mps = 0.8f, kTurn_radps = 0.14f;
constexpr float kRests_s = 9, kRestsAnywhere_s = 5, kThere_m = 1.5f;
constexpr float kNearest_m = 12, kFarthest_m = 45;  // of a place anywhere
constexpr int kTries = 60;

// Somewhere that one can walk to, and as far as can be seen with as much room about it as on a street.
std::optional<Vec2> PlaceAnywhere(const Simulation& s, Random* random) {
  const Walkable& w = s.town.walkable;
  const Vec2 from = s.visitor.camera.view.position;
  const int here = FreeCellFor(w, from);
  if (here < 0) return std::nullopt;
  for (int k = 0; k < kTries; ++k) {
    const Vec2 p = from + DirectionOf(random->Uniform(0, 2 * kPi)) * random->Uniform(kNearest_m, kFarthest_m);
    const int cell = CellAt(w, p);
    if (cell >= 0 && w.component[static_cast<size_t>(cell)] == w.component[static_cast<size_t>(here)]) return p;
  }
  return std::nullopt;
}

void Rest(const Simulation& s, Attract* a) {
  a->on_the_way = false;
  a->look_rad.reset();
  a->turn = a->random.Uniform() < 0.5f ? 1.0f : -1.0f;
  a->rests_s = kRestsAnywhere_s;
  if (a->stops.empty()) return;
  if (Length(a->stops[a->next] - s.visitor.camera.view.position) < kThere_m) {
    a->look_rad = a->looks_rad[a->next];
    a->rests_s = kRests_s;
  }
  a->next = (a->next + 1) % a->stops.size();
}

float TurnWhileResting_radps(const Simulation& s, const Attract& a) {
  if (!a.look_rad) return a.turn * kTurn_radps;
  const float left_rad = WrapAngle(*a.look_rad - s.visitor.camera.view.yaw_rad);
  return std::clamp(left_rad, -3 * kTurn_radps, 3 * kTurn_radps);
}

}  // namespace

void BeginAttract(const Simulation& s, Attract* a) {
  const Random random = a->random;
  *a = {};
  a->random = random;
  const GuidedTour& tour = s.visitor.tour;
  for (size_t k = 0; k < tour.stops.size(); ++k) {
    a->stops.push_back(tour.stops[k].position_m);
    a->looks_rad.push_back(LookAt_rad(tour, k));
  }
  const auto far_m = [&](size_t k) { return Length(a->stops[k] - s.visitor.camera.view.position); };
  for (size_t k = 0; k < a->stops.size(); ++k) {
    if (far_m(k) < far_m(a->next)) a->next = k;
  }
  a->rests_s = kRestsAnywhere_s;
}

CameraInput NextOfAttract(const Simulation& s, Attract* a) {
  CameraInput input;
  input.active = true;
  input.walk_to_mps = kSpeed_mps;
  input.pitch_rad = 0.0f;
  if (a->on_the_way) {
    if (s.visitor.point_walk.route.points.empty()) Rest(s, a);  // there, or the way is barred
    return input;
  }
  a->rests_s -= Step_s(s);
  if (a->rests_s > 0) {
    input.yaw_rate_radps = TurnWhileResting_radps(s, *a);
    return input;
  }
  input.walk_to = a->stops.empty() ? PlaceAnywhere(s, &a->random) : std::optional(a->stops[a->next]);
  a->on_the_way = input.walk_to.has_value();
  if (!a->on_the_way) a->rests_s = kRestsAnywhere_s;
  return input;
}

}  // namespace flaneur
