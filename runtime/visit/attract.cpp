#include "runtime/visit/attract.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/crowd/fast_math.h"

namespace flaneur {
namespace {

constexpr float kRestTurn_radps = 0.12f;  // where there is nothing to look at
constexpr float kTurn_radps = 0.32f, kTurns_radps2 = 0.25f, kTurnsIn_s = 1.6f;
constexpr float kRise_mps = 0.7f, kRises_mps2 = 0.5f, kRisesIn_s = 1.2f;
constexpr float kLooksAhead_m = 7;                                    // along the way
constexpr float kLooksThere_m = 5;                                    // before a stop, at what there is to see
constexpr float kLooksDown_rad = -0.02f, kLooksDown_radpm = -0.055f;  // and by each metre above people's eyes
constexpr float kRests_s = 9, kPassesBy_s = 0.2f, kRestsAnywhere_s = 5, kThere_m = 1.5f;
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
  a->flight = {};
  a->look_rad.reset();
  a->turn = a->random.Uniform() < 0.5f ? 1.0f : -1.0f;
  a->rests_s = kRestsAnywhere_s;
  if (a->stops.empty()) return;
  if (Length(a->stops[a->next] - s.visitor.camera.view.position) < kThere_m) {
    a->look_rad = a->looks_rad[a->next];
    a->rests_s = RestOf_s(s.visitor.tour, a->next) > 0 ? kRests_s : kPassesBy_s;
  }
  a->next = (a->next + 1) % a->stops.size();
}

// Where to look: along the way, and in good time at what there is to see.
std::optional<float> LookOf(const Simulation& s, const Attract& a) {
  if (a.flight.points.empty()) return a.look_rad;
  const float left_m = a.flight.at_m.back() - a.flight.way_m;
  if (!a.stops.empty() && left_m < kLooksThere_m) return a.looks_rad[a.next];
  const Vec2 ahead = PlaceAt(a.flight, a.flight.way_m + kLooksAhead_m).position - s.visitor.camera.view.position;
  return Length(ahead) > 1 ? std::optional(AngleOf(ahead)) : std::nullopt;
}

// Begins to turn and stops turning gently.
float TurnOf(const Simulation& s, Attract* a) {
  const auto look_rad = LookOf(s, *a);
  float wanted_radps = a->flight.points.empty() ? a->turn * kRestTurn_radps : 0;
  if (look_rad) {
    wanted_radps = WrapAngle(*look_rad - s.visitor.camera.view.yaw_rad) / kTurnsIn_s;
    wanted_radps = std::clamp(wanted_radps, -kTurn_radps, kTurn_radps);
  }
  const float most = kTurns_radps2 * Step_s(s);
  a->turns_radps += std::clamp(wanted_radps - a->turns_radps, -most, most);
  return a->turns_radps;
}

// No motion but the crowd's: the next stop, or the way on, is there at once.
CameraInput Stand(const Simulation& s, Attract* a, CameraInput input) {
  input.flies->eye_height_m = kLowestFlight_m;
  if (a->rests_s > 0) return input;
  const auto place = a->stops.empty() ? PlaceAnywhere(s, &a->random) : std::optional(a->stops[a->next]);
  a->rests_s = kRests_s;
  if (!place) return input;
  input.flies->yaw_rad = a->stops.empty() ? a->random.Uniform(0, 2 * kPi) : a->looks_rad[a->next];
  input.flies->position = *place;
  a->leapt = true;
  if (!a->stops.empty()) a->next = (a->next + 1) % a->stops.size();
  return input;
}

}  // namespace

void BeginAttract(const Simulation& s, bool still, Attract* a) {
  const Random random = a->random;
  WaySearch search = std::move(a->search);  // what it knows of the town
  *a = {};
  a->random = random;
  a->search = std::move(search);
  a->still = still;
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
  const CameraState& camera = s.visitor.camera;
  CameraInput input;
  input.active = true;
  input.flies = {camera.view.position, camera.eye_height_m, std::nullopt};
  a->leapt = false;
  a->rests_s -= Step_s(s);
  input.pitch_rad = kLooksDown_rad;
  if (a->still) return Stand(s, a, input);
  if (a->flight.points.empty() && a->rests_s <= 0) {
    const auto place = a->stops.empty() ? PlaceAnywhere(s, &a->random) : std::optional(a->stops[a->next]);
    if (place) a->flight = PlanFlight(s.town.walkable, camera.view.position, *place, &a->search);
    if (a->flight.points.empty()) Rest(s, a);  // the way is barred
  }
  float height_m = FlightHeight_m(s.town.walkable, camera.view.position);
  if (!a->flight.points.empty()) {
    FlyOn(Step_s(s), &a->flight);
    const FlightPlace at = PlaceAt(a->flight, a->flight.way_m);
    input.flies->position = at.position;
    height_m = at.eye_height_m;
  }
  const float rise_mps = std::clamp((height_m - camera.eye_height_m) / kRisesIn_s, -kRise_mps, kRise_mps);
  const float most_mps = kRises_mps2 * Step_s(s);
  a->rises_mps += std::clamp(rise_mps - a->rises_mps, -most_mps, most_mps);
  input.flies->eye_height_m += a->rises_mps * Step_s(s);
  input.pitch_rad = kLooksDown_rad + kLooksDown_radpm * std::max(0.0f, input.flies->eye_height_m - kEyeHeight_m);
  input.yaw_rate_radps = TurnOf(s, a);
  if (!a->flight.points.empty() && IsOver(a->flight)) Rest(s, a);
  return input;
}

}  // namespace flaneur
