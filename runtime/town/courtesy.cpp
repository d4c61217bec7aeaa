#include "runtime/town/courtesy.h"

#include "runtime/crowd/walls.h"
#include "runtime/town/places.h"

namespace flaneur {
namespace {

constexpr float kFillsView_m = 3;   // so near somebody fills the view,
constexpr float kBody_m = 0.4f;     // with a body as wide as this to each side
constexpr float kAtElbow_m = 1.5f;  // and so near they are felt in any direction
constexpr float kHeldUpWithin_m = 2.5f;
constexpr float kGetsOn_m = 1.0f;  // who stays within this for so long does not get on
constexpr float kPatience_s = 2.5f;
constexpr float kSees_m = 5;        // that there is no way past the visitor
constexpr float kMindChanges = 6;   // so many times as fast as who only does not get on
constexpr float kTowards = 0.8f;    // cosine of a way that leads to the visitor
constexpr float kPasses_m = 0.06f;  // beyond touching
constexpr int kTries = 5;           // to find somewhere to go that is not behind the visitor

// Coming towards the visitor where it is too narrow for both, whichever way each steps aside.
bool FindsNoWay(size_t i, const Viewer& viewer, const Town& town) {
  const Crowd& c = town.crowd;
  const Walkable& w = town.walkable;
  const Vec2 at = viewer.camera.position, off = at - c.position[i];
  const float away_m = Length(off);
  if (away_m > kSees_m || Dot(c.way[i], off) < kTowards * away_m) return false;
  const Vec2 left{-c.way[i].y, c.way[i].x};
  const float radius_m = c.radius_m[i], reach_m = viewer.settings.r_personal_m + radius_m + kPasses_m;
  if (ClearAround_m(w, CellAt(w, at)) >= reach_m + radius_m) return false;
  for (const float side : {-1.0f, 1.0f}) {
    const float theirs_m = RoomAlong_m(w, at, left * side, radius_m, reach_m);
    if (theirs_m + RoomAlong_m(w, at, left * -side, CameraRadius_m(w), reach_m) >= reach_m) return false;
  }
  return true;
}

}  // namespace

bool IsBeforeEyes(const Viewer& viewer, Vec2 p) {
  if (!viewer.present) return false;
  const Vec2 off = p - viewer.camera.position;
  const float away2_m2 = Dot(off, off);
  if (away2_m2 < kAtElbow_m * kAtElbow_m) return true;
  return away2_m2 < kFillsView_m * kFillsView_m && Classify(p, kBody_m, viewer.camera, 0) == ViewClass::kVisible;
}

bool IsHeldUpByVisitor(size_t i, const Viewer& viewer, Town* town) {
  const Crowd& c = town->crowd;
  PersonPlan& plan = PlanOf(i, town);
  const Vec2 off = c.position[i] - viewer.camera.position;
  const bool walks = viewer.present && c.activity[i] == Activity::kWalking && c.field[i] >= 0;
  const bool no_way = walks && FindsNoWay(i, viewer, *town);
  const bool near = walks && Dot(off, off) < kHeldUpWithin_m * kHeldUpWithin_m;
  const bool gets_on = !no_way && (!near || Dot(c.position[i] - plan.held_up_at, c.way[i]) > kGetsOn_m);
  if (gets_on) plan.held_up_at = c.position[i];
  plan.held_up_s = gets_on ? 0 : plan.held_up_s + (no_way ? kMindChanges : 1) * Step_s(viewer.settings);
  if (plan.held_up_s < kPatience_s || !plan.goals.empty() || plan.stay || plan.leaves) return false;
  plan.held_up_s = 0;
  return true;
}

int DestinationAway(size_t i, const Viewer& viewer, Town* town) {
  const Vec2 p = town->crowd.position[i], visitor = viewer.camera.position - p;
  int field = -1;
  for (int k = 0; k < kTries; ++k) {
    field = PickDestination(viewer, p, false, town);
    if (field < 0 || Dot(town->crowd.fields[static_cast<size_t>(field)].goal - p, visitor) < 0) break;
  }
  return field;
}

}  // namespace flaneur
