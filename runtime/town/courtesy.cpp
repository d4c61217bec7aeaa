#include "runtime/town/courtesy.h"

#include "runtime/town/places.h"

namespace flaneur {
namespace {

constexpr float kFillsView_m = 3;   // so near somebody fills the view,
constexpr float kBody_m = 0.4f;     // with a body as wide as this to each side
constexpr float kAtElbow_m = 1.5f;  // and so near they are felt in any direction
constexpr float kHeldUpWithin_m = 2.5f;
constexpr float kGetsOn_m = 1.0f;  // who stays within this for so long does not get on
constexpr float kPatience_s = 2.5f;
constexpr int kTries = 5;  // to find somewhere to go that is not behind the visitor

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
  const bool near = viewer.present && c.activity[i] == Activity::kWalking && c.field[i] >= 0 &&
                    Dot(off, off) < kHeldUpWithin_m * kHeldUpWithin_m;
  const Vec2 way = c.position[i] - plan.held_up_at;
  const bool gets_on = !near || Dot(way, way) > kGetsOn_m * kGetsOn_m;
  if (gets_on) plan.held_up_at = c.position[i];
  plan.held_up_s = gets_on ? 0 : plan.held_up_s + Step_s(viewer.settings);
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
