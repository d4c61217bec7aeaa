#include "runtime/crowd/steering.h"

#include <algorithm>
#include <cmath>

#include "runtime/crowd/constants.h"
#include "runtime/crowd/walls.h"

namespace flaneur {
namespace {

Vec2 ClampLength(Vec2 v, float most) {
  const float length2 = Dot(v, v);
  return length2 > most * most ? v * (most / std::sqrt(length2)) : v;
}

// exp(-x) for x in [0, 1] to half a percent, without a call.
float Decay(float x) { return 1 / (1 + x * (1 + x * (0.5f + x * (1.0f / 6)))); }

// Acceleration from a predicted collision: the gradient of k tau^-2 exp(-tau / tau0) over the time to collision tau
// (Karamouzas, Skinner and Guy 2014, eq. 3). `towards` points from me to the other, `closing` is my velocity less the other's.
Vec2 Anticipation(Vec2 towards, Vec2 closing, float reach_m) {
  const float b = Dot(towards, closing);
  if (b <= 0) return {};
  const float a = Dot(closing, closing);
  const float gap = Dot(towards, towards) - reach_m * reach_m;
  const float discriminant = b * b - a * gap;
  if (gap <= 0 || a < 1e-6f || discriminant <= 1e-9f) return {};
  const float root = std::sqrt(discriminant);
  const float tau = std::max((b - root) / a, 0.02f);
  if (tau > kAnticipation_s) return {};
  const float strength =
      kInteraction_k * Decay(tau / kInteraction_tau0_s) * (2 / tau + 1 / kInteraction_tau0_s) / (a * tau * tau);
  const Vec2 aside = (closing * b - towards * a) * (1 / root) - closing;
  return ClampLength(aside * strength, kMostPush_mps2);
}

struct Surroundings { Vec2 push; float density_pm2 = 0; };

Surroundings LookAround(const Walkable& w, size_t i, float contact_m, Crowd* c) {
  Surroundings s;
  const Vec2 position = c->position[i], velocity = c->velocity[i];
  const Vec2 ahead{std::cos(c->heading_rad[i]), std::sin(c->heading_rad[i])};
  const float radius_m = c->radius_m[i];
  const int self = static_cast<int>(i);
  float crowding = 0;
  VisitNear(c->neighbours, position, kNeighbourRadius_m, [&](const Neighbour& other) {
    const Vec2 towards = other.position - position;
    const float distance2 = Dot(towards, towards);
    if (distance2 > kNeighbourRadius_m * kNeighbourRadius_m || other.person == self) return;
    const float reach_m = radius_m + other.radius_m;
    const float distance_m = std::sqrt(std::max(distance2, 1e-8f));
    const float cosine = Dot(towards, ahead) / distance_m;
    const float attention = cosine > -0.2f ? 1.0f : kAttentionBehind;
    const Vec2 seen{towards.x - kPassOnTheRight_rad * towards.y, towards.y + kPassOnTheRight_rad * towards.x};
    s.push = s.push + Anticipation(seen, velocity - other.velocity, reach_m + 0.5f * kComfort_m) * attention;
    const float gap_m = distance_m - reach_m;
    if (gap_m < kComfort_m) s.push = s.push - towards * (kSeparation_mps2 * (1 - gap_m / kComfort_m) / distance_m);
    if (distance2 < kDensityRadius_m * kDensityRadius_m) {
      crowding += (1 - distance2 / (kDensityRadius_m * kDensityRadius_m)) * (1 + cosine);
    }
    if (gap_m < contact_m && other.person > self) c->contacts.push_back({self, other.person});
  });
  const int cell = CellAt(w, position);
  const float open = cell >= 0 ? std::max(0.2f, w.open_share[static_cast<size_t>(cell)]) : 1.0f;
  // The weights of a full disc sum to half its area.
  s.density_pm2 = crowding * 2 / (kPi * kDensityRadius_m * kDensityRadius_m * open);
  return s;
}

Vec2 AvoidMoving(const std::vector<MovingObstacle>& moving, const Crowd& c, size_t i) {
  Vec2 push;
  for (const MovingObstacle& m : moving) {
    if (!m.everyone && !c.avoids_camera[i]) continue;
    const Vec2 towards = m.center - c.position[i];
    const float distance_m = std::max(Length(towards), 1e-4f), reach_m = m.radius_m + c.radius_m[i];
    push = push + Anticipation(towards, c.velocity[i] - m.velocity, reach_m + 2 * kComfort_m);
    const float gap_m = distance_m - reach_m;
    if (gap_m < 2 * kComfort_m) {
      push = push - towards * (kSeparation_mps2 * std::min(1.0f, 1 - gap_m / (2 * kComfort_m)) / distance_m);
    }
  }
  return ClampLength(push, kMostPush_mps2);
}

// What the person would do alone: walk on, slower uphill and down.
Vec2 Preferred(const Walkable& w, const Crowd& c, size_t i) {
  if (c.activity[i] != Activity::kWalking || c.field[i] < 0) return {};
  const int cell = CellAt(w, c.position[i]);
  const float slope = cell >= 0 ? w.slope[static_cast<size_t>(cell)] : 0;
  return c.way[i] * (c.preferred_mps[i] * c.pace[i] / (1 + kSlopeSlows * slope));
}

}  // namespace

float SpeedInDensity(float density_pm2) {
  if (density_pm2 < 0.05f) return 1;
  const float exponent = kWeidmannGamma_pm2 * (1 / density_pm2 - 1 / kWeidmannMostDensity_pm2);
  return std::clamp(1 - std::exp(-exponent), kLeastDensitySpeed, 1.0f);
}

void ChooseVelocities(const Walkable& w, const std::vector<MovingObstacle>& moving, float step_s, Crowd* c) {
  c->contacts.clear();
  for (size_t i = 0; i < c->size(); ++i) {
    const Vec2 preferred = Preferred(w, *c, i);
    if (c->view[i] == ViewClass::kOutside) {
      c->wanted[i] = preferred;
      continue;
    }
    const Surroundings around = LookAround(w, i, 2.2f * c->top_mps[i] * step_s + 0.02f, c);
    const Vec2 goal_pull = (preferred * SpeedInDensity(around.density_pm2) - c->velocity[i]) * (1 / kRelaxation_s);
    Vec2 push = around.push + AvoidMoving(moving, *c, i);
    const bool stands = c->activity[i] != Activity::kWalking;
    if (stands && Dot(push, push) < 1) push = {};  // people who stand give way only when pressed
    const Vec2 acceleration =
        ClampLength(goal_pull + push + WallPush(w, c->position[i], c->radius_m[i]), kMaxAcceleration_mps2);
    c->wanted[i] = ClampLength(c->velocity[i] + acceleration * step_s, c->top_mps[i]);
  }
}

}  // namespace flaneur
