#include "runtime/player/ways_out.h"

#include <algorithm>
#include <cmath>

#include "runtime/player/company.h"
#include "runtime/player/places.h"

namespace flaneur {
namespace {

constexpr float kLookEvery_s = 0.5f;
constexpr float kKeepAway_m = 2.0f;    // people don't like to squeeze past anybody closer
constexpr float kSoon_s = 1.5f;        // the visitor's way is thought on so far
constexpr float kBeyondHigh_m = 12;    // who is cut off within r_high and this counts
constexpr float kReserve = 0.15f;      // share of the limit kept free
constexpr float kNearlyFull = 0.6f;    // share of the limit from which people keep away
constexpr float kAwayFromHigh_m = 6;   // and this far beyond r_high

bool Adapts(const Simulation& s) { return s.camera.present && s.influence.adaptation == Adaptation::kFull; }

bool GoesToGate(size_t i, Simulation* s) {
  const int place = PlaceOfField(s->crowd.field[i], s);
  if (place < 0 || !IsGate(s->places[static_cast<size_t>(place)])) return false;
  return IsCutOff(s->walkable, s->enclosure, s->places[static_cast<size_t>(place)].position_m);
}

// The nearest gate on this side of the visitor, -1 where there is none.
int NearestGate(const Simulation& s, Vec2 p, float* away_m) {
  int best = -1;
  for (int gate : s.place_lists.gates) {
    const Vec2 at = s.places[static_cast<size_t>(gate)].position_m;
    if (!IsCutOff(s.walkable, s.enclosure, at)) continue;
    const float gate_m = Length(at - p);
    if (best < 0 || gate_m < *away_m) best = gate, *away_m = gate_m;
  }
  return best;
}

}  // namespace

void SendEnclosedOut(Simulation* s) {
  const int64_t every = std::max<int64_t>(1, std::lround(kLookEvery_s / s->step_s));
  if (!Adapts(*s) || s->place_lists.gates.empty() || s->frame % every != 0) return;
  const Vec2 visitor = s->camera.view.position;
  const float reach_m = s->influence.r_high_m + kBeyondHigh_m;
  FindEnclosure(s->walkable, visitor, visitor + s->camera.velocity * kSoon_s, kKeepAway_m, reach_m, &s->enclosure);
  const int limit = s->influence.high_limit;
  int room = limit - std::max(1, static_cast<int>(std::lround(kReserve * static_cast<float>(limit))));
  int best = -1, best_gate = -1;
  float best_m = 0;
  for (size_t i = 0; i < s->crowd.size(); ++i) {
    if (!IsCutOff(s->walkable, s->enclosure, s->crowd.position[i]) || GoesToGate(i, s)) continue;
    --room;
    if (s->plans[static_cast<size_t>(s->crowd.id[i])].leaves) continue;  // a scenario's person has goals of their own
    float away_m = 0;
    const int gate = NearestGate(*s, s->crowd.position[i], &away_m);
    if (gate >= 0 && (best < 0 || away_m < best_m)) best = static_cast<int>(i), best_gate = gate, best_m = away_m;
  }
  if (room >= 0 || best < 0) return;
  const int field = FieldFor(s->places[static_cast<size_t>(best_gate)].position_m, &s->crowd);
  SendAll(CompanyOf(s->crowd, static_cast<size_t>(best)), field, s);
}

bool IsFullNear(const Simulation& s, Vec2 p) {
  if (!Adapts(s)) return false;
  if (IsCutOff(s.walkable, s.enclosure, p)) return true;
  if (static_cast<float>(s.levels.high) < kNearlyFull * static_cast<float>(s.influence.high_limit)) return false;
  return Length(p - s.camera.view.position) < s.influence.r_high_m + kAwayFromHigh_m;
}

}  // namespace flaneur
