#include "runtime/walk/wander.h"

#include "runtime/crowd/fast_math.h"

namespace flaneur {
namespace {

constexpr int kTries = 60;
constexpr float kWay_m[] = {4, 20}, kStroll_mps[] = {0.7f, 1.7f}, kHurry_mps[] = {2.0f, kWanderMost_mps};
constexpr float kWalks = 0.6f, kTurns = 0.15f, kStands = 0.17f;  // else follows
constexpr float kHurries = 0.15f, kLooksElsewhere = 0.3f;
constexpr float kFacing_deg[] = {35, -35, 60, -60, 90, -90, 180};

bool WalkSomewhere(const VisitorInTown& v, Random* random, CameraLeg* leg) {
  const Vec2 p = v.visitor.camera.view.position;
  for (int k = 0; k < kTries; ++k) {
    const Vec2 to = p + DirectionOf(random->Uniform(-kPi, kPi)) * random->Uniform(kWay_m[0], kWay_m[1]);
    if (!IsFree(v.town.walkable, to) || !StraightWay(v.town.walkable, p, to)) continue;
    leg->kind = CameraLeg::Kind::kWalk;
    leg->to_m = to;
    const bool hurries = random->Uniform() < kHurries;
    leg->speed_mps =
        hurries ? random->Uniform(kHurry_mps[0], kHurry_mps[1]) : random->Uniform(kStroll_mps[0], kStroll_mps[1]);
    if (!hurries && random->Uniform() < kLooksElsewhere) leg->facing_deg = kFacing_deg[random->Below(7)];
    return true;
  }
  return false;
}

}  // namespace

CameraLeg DrawLeg(const VisitorInTown& v, Random* random) {
  CameraLeg leg;
  const float what = random->Uniform();
  if (what < kWalks && WalkSomewhere(v, random, &leg)) return leg;
  if (what < kWalks + kTurns) {
    leg.kind = CameraLeg::Kind::kTurn;
    leg.turn_deg = random->Uniform(-200, 200);
    leg.rate_dps = random->Uniform(30, kWanderMost_dps);
  } else if (what < kWalks + kTurns + kStands) {
    leg.kind = CameraLeg::Kind::kWait;
    leg.wait_s = random->Uniform(2, 9);
    if (random->Uniform() < 0.5f) leg.look_about_deg = random->Uniform(20, 80);
    leg.rate_dps = random->Uniform(15, 60);
  } else {
    leg.kind = CameraLeg::Kind::kFollow;
    leg.follow_s = random->Uniform(5, 15);
    leg.behind_m = random->Uniform(1.8f, 4);
  }
  return leg;
}

}  // namespace flaneur
