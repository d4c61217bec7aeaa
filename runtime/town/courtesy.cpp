#include "runtime/town/courtesy.h"

namespace flaneur {
namespace {

constexpr float kFillsView_m = 3;   // so near somebody fills the view,
constexpr float kBody_m = 0.4f;     // with a body as wide as this to each side
constexpr float kAtElbow_m = 1.5f;  // and so near they are felt in any direction
constexpr float kHeldUpWithin_m = 2.5f;
constexpr float kStands_mps = 0.25f;
constexpr float kPatience_s = 1.5f;

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
  const bool waits = viewer.present && c.activity[i] == Activity::kWalking && c.field[i] >= 0 && c.detour_s[i] <= 0 &&
                     Dot(off, off) < kHeldUpWithin_m * kHeldUpWithin_m &&
                     Dot(c.velocity[i], c.velocity[i]) < kStands_mps * kStands_mps;
  plan.held_up_s = waits ? plan.held_up_s + Step_s(viewer.settings) : 0;
  if (plan.held_up_s < kPatience_s || !plan.goals.empty() || plan.stay || plan.leaves) return false;
  plan.held_up_s = 0;
  return true;
}

}  // namespace flaneur
