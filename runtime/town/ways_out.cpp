#include "runtime/town/ways_out.h"

#include <algorithm>
#include <cmath>

#include "runtime/town/company.h"
#include "runtime/town/places.h"

namespace flaneur {
namespace {

constexpr float kLookEvery_s = 0.5f;
constexpr float kKeepAway_m = 2.0f;  // people don't like to squeeze past anybody closer
constexpr float kSoon_s = 1.5f;      // the visitor's way is thought on so far
constexpr float kBeyondHigh_m = 12;  // who is cut off within r_high and this counts
constexpr float kReserve = 0.15f;    // share of the limit kept free

bool GoesToGate(size_t i, Town* town) {
  const int place = PlaceOfField(town->crowd.field[i], town);
  if (place < 0 || !IsGate(town->places[static_cast<size_t>(place)])) return false;
  return IsCutOff(town->walkable, town->enclosure, town->places[static_cast<size_t>(place)].position_m);
}

// The nearest gate on this side of the visitor, -1 where there is none.
int NearestGate(const Town& town, Vec2 p, float* away_m) {
  int best = -1;
  for (int gate : town.place_lists.gates) {
    const Vec2 at = town.places[static_cast<size_t>(gate)].position_m;
    if (!IsCutOff(town.walkable, town.enclosure, at)) continue;
    const float gate_m = Length(at - p);
    if (best < 0 || gate_m < *away_m) best = gate, *away_m = gate_m;
  }
  return best;
}

}  // namespace

void SendEnclosedOut(const Viewer& viewer, Town* town) {
  const int64_t every = std::max<int64_t>(1, std::lround(kLookEvery_s / Step_s(viewer.settings)));
  if (!Adapts(viewer) || town->place_lists.gates.empty() || town->step % every != 0) return;
  const Vec2 visitor = viewer.camera.position;
  const float reach_m = viewer.settings.r_high_m + kBeyondHigh_m;
  FindEnclosure(town->walkable, visitor, visitor + viewer.velocity * kSoon_s, kKeepAway_m, reach_m, &town->enclosure);
  const int limit = viewer.limit;
  int room = limit - std::max(1, static_cast<int>(std::lround(kReserve * static_cast<float>(limit))));
  int best = -1, best_gate = -1;
  float best_m = 0;
  for (size_t i = 0; i < town->crowd.size(); ++i) {
    if (!IsCutOff(town->walkable, town->enclosure, town->crowd.position[i]) || GoesToGate(i, town)) continue;
    --room;
    const PersonPlan& plan = PlanOf(i, town);
    if (plan.leaves || plan.work >= 0) continue;  // a scenario's person has goals of their own, and who works stays
    float away_m = 0;
    const int gate = NearestGate(*town, town->crowd.position[i], &away_m);
    if (gate >= 0 && (best < 0 || away_m < best_m)) best = static_cast<int>(i), best_gate = gate, best_m = away_m;
  }
  if (room >= 0 || best < 0) return;
  const int field = FieldFor(town->places[static_cast<size_t>(best_gate)].position_m, &town->crowd);
  SendAll(CompanyOf(town->crowd, static_cast<size_t>(best)), field, town);
}

bool IsFullNear(const Viewer& viewer, const Town& town, Vec2 p) {
  if (!Adapts(viewer)) return false;
  if (IsCutOff(town.walkable, town.enclosure, p)) return true;
  return IsFullAt(viewer, town, p);
}

}  // namespace flaneur
