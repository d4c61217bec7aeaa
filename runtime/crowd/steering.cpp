#include "runtime/crowd/steering.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/fetch.h"
#include "runtime/crowd/constants.h"
#include "runtime/crowd/fast_math.h"
#include "runtime/crowd/go_round.h"
#include "runtime/crowd/variation.h"
#include "runtime/crowd/walls.h"

namespace flaneur {
namespace {

constexpr int kBlock = 64;                     // people looked at together
constexpr float kMinAcceleration_mps2 = 0.5f;  // a turn ends, and doesn't fade away
constexpr int kReturnDecisions = 45;           // after which a line is forgotten;
constexpr int kPassing = 7;                    // and the first of them, while the visitor passes, change nothing
constexpr float kReturn_s = 1.0f, kMaxReturn_mps = 0.5f, kOnLine_m = 0.1f;
constexpr float kToPost_s = 1.0f, kMaxToPost_mps = 0.35f;  // a little aside they do not turn to walk
constexpr float kStuck = 0.05f, kLetGo = 0.7f;
constexpr float kLately = 0.05f;  // of the mean, each decision
constexpr float kStuckFilled =
    0.156f;  // of the ground, by bodies over pi: 2.5 people of 0.25 m radius to the square metre
constexpr int kLetsGo_steps = 30;
constexpr float kSidestepGain = 2.4f;  // than the last moment
constexpr float kMinTime_s = 0.3f;     // no stepping aside is quicker

// exp(-x) for x in [0, 1] to half a percent, without a call.
float RoughDecay(float x) { return 1 / (1 + x * (1 + x * (0.5f + x * (1.0f / 6)))); }

// Acceleration from a predicted collision: the gradient of k tau^-2 exp(-tau / tau0) over the time to collision tau
// (Karamouzas, Skinner and Guy 2014, eq. 3). `towards` points from me to the other, `closing` is my velocity less the
// other's.
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
      kInteraction_k * RoughDecay(tau / kInteraction_tau0_s) * (2 / tau + 1 / kInteraction_tau0_s) / (a * tau * tau);
  const Vec2 aside = (closing * b - towards * a) * (1 / root) - closing;
  return ClampLength(aside * strength, kMaxPush_mps2);
}

struct Looking {
  Vec2 position, velocity, ahead;
  float radius_m = 0;
  int person = 0;
};

// Of the predicted collisions only the foremost counts: sums of many pushes stop people who could pass one after the
// other.
struct Surroundings {
  Vec2 foremost, separation;
  float foremost2 = 0;
  float crowding = 0, filling = 0;  // people, and the squares of their radii in m2, by how much they crowd
};

// Those of a row of the grid who are within the neighbour radius, as arrays by field.
struct Block {
  int count = 0;
  alignas(32) float x[kBlock], y[kBlock], distance2[kBlock];  // from me to the other
  alignas(32) float closing_x[kBlock], closing_y[kBlock], reach_m[kBlock];
  alignas(32) float cosine[kBlock], weight[kBlock], gap_m[kBlock];
  alignas(32) int meets[kBlock];
};

// Without branches: who is out of reach is overwritten by the next. Returns whom it did not get to.
const Neighbour* Gather(const Looking& me, const Neighbour* first, const Neighbour* end, Block* b) {
  int n = b->count;
  for (; first < end && n < kBlock; ++first) {
    const Vec2 towards = first->position - me.position, closing = me.velocity - first->velocity;
    const float distance2 = Dot(towards, towards);
    b->x[n] = towards.x;
    b->y[n] = towards.y;
    b->distance2[n] = distance2;
    b->closing_x[n] = closing.x;
    b->closing_y[n] = closing.y;
    b->reach_m[n] = me.radius_m + first->radius_m;
    n += (distance2 < kNeighbourRadius_m * kNeighbourRadius_m) & (first->person != me.person);
  }
  b->count = n;
  return first;
}

// What is cheap for everybody near, side by side: how much they crowd me, and whether they could matter at all. Who
// walks my way or stands crowds me in full, who crosses half as much, and who comes towards me will be gone.
void Weigh(const Looking& me, Block* block) {
  constexpr float kPerRadius2 = 1 / (kDensityRadius_m * kDensityRadius_m);
  const int rounded = std::min(kBlock, (block->count + 3) & ~3);
  Block& b = *block;
  for (int k = b.count; k < rounded; ++k) {
    b.x[k] = b.y[k] = b.distance2[k] = b.closing_x[k] = b.closing_y[k] = b.reach_m[k] = 0;
  }
  for (int k = 0; k < rounded; ++k) {
    const float x = b.x[k], y = b.y[k], closing_x = b.closing_x[k], closing_y = b.closing_y[k];
    const float distance2 = b.distance2[k] > 1e-8f ? b.distance2[k] : 1e-8f;
    const float distance_m = std::sqrt(distance2);
    const float cosine = (x * me.ahead.x + y * me.ahead.y) / distance_m;
    const float share = 1 - distance2 * kPerRadius2;
    const float other_x = me.velocity.x - closing_x, other_y = me.velocity.y - closing_y;
    const float other_mps = std::sqrt(other_x * other_x + other_y * other_y);
    const float stays =
        1 - 0.5f * (other_mps - other_x * me.ahead.x - other_y * me.ahead.y) / (other_mps + kTurnsAbove_mps);
    const float reach_m = b.reach_m[k] + kPassing_m;
    const float seen_x = x - kPassOnTheRight_rad * y, seen_y = y + kPassOnTheRight_rad * x;
    const float along = seen_x * closing_x + seen_y * closing_y;
    const float closing2 = closing_x * closing_x + closing_y * closing_y;
    const float room = seen_x * seen_x + seen_y * seen_y - reach_m * reach_m;
    const float discriminant = along * along - closing2 * room;
    b.cosine[k] = cosine;
    b.weight[k] = (share > 0 ? share : 0) * (1 + cosine) * stays;
    b.gap_m[k] = distance_m - b.reach_m[k];
    b.meets[k] = (along > 0 ? 1 : 0) & (discriminant > 1e-9f ? 1 : 0);
  }
}

// People pass each other sideways and keep walking: slowing down is left to the density around, but for those who cross
// from the right.
Vec2 WithoutBraking(const Looking& me, Vec2 towards, Vec2 other, Vec2 push) {
  const float along = Dot(push, me.velocity), speed2 = Dot(me.velocity, me.velocity);
  if (along >= 0 || speed2 <= kTurnsAbove_mps * kTurnsAbove_mps) return push;
  const float leftwards = Cross(me.ahead, other);
  const bool crosses = leftwards > 0 && leftwards * leftwards > kCrossing * kCrossing * Dot(other, other);
  const bool first = crosses && Cross(me.ahead, towards) < 0;
  return push - me.velocity * ((first ? 1 - kGiveWay : 1) * along / speed2);
}

void AddInteractions(const Looking& me, Block* block, Surroundings* s) {
  Weigh(me, block);
  const Block& b = *block;
  for (int k = 0; k < b.count; ++k) {
    const float radius_m = b.reach_m[k] - me.radius_m;
    s->crowding += b.weight[k], s->filling += b.weight[k] * radius_m * radius_m;
    if (b.meets[k] == 0 && b.gap_m[k] >= kComfort_m) continue;
    const Vec2 towards{b.x[k], b.y[k]};
    const float attention = b.cosine[k] > -0.2f ? 1.0f : kAttentionBehind;
    const Vec2 seen{towards.x - kPassOnTheRight_rad * towards.y, towards.y + kPassOnTheRight_rad * towards.x};
    const Vec2 closing{b.closing_x[k], b.closing_y[k]};
    const Vec2 foreseen = Anticipation(seen, closing, b.reach_m[k] + kPassing_m) * attention;
    const Vec2 push = WithoutBraking(me, towards, me.velocity - closing, foreseen);
    if (const float size2 = Dot(push, push); size2 > s->foremost2) s->foremost = push, s->foremost2 = size2;
    if (b.gap_m[k] < kComfort_m) {
      const float distance_m = b.gap_m[k] + b.reach_m[k];
      s->separation = s->separation - towards * (kSeparation_mps2 * (1 - b.gap_m[k] / kComfort_m) / distance_m);
    }
  }
  block->count = 0;
}

Surroundings LookAround(const NeighbourGrid& grid, const Looking& me) {
  Surroundings s;
  Block block;
  VisitRows(grid, me.position, kNeighbourRadius_m, [&](const Neighbour* first, const Neighbour* end) {
    while (first < end) {
      first = Gather(me, first, end, &block);
      if (block.count == kBlock) AddInteractions(me, &block, &s);
    }
  });
  AddInteractions(me, &block, &s);
  return s;
}

// Room for somebody who may come faster than people walk: the sideways speed that just clears their way in the time
// left.
Vec2 StepAside(Vec2 towards, Vec2 closing, float reach_m) {
  const float speed2 = Dot(closing, closing), along = Dot(towards, closing);
  if (along <= 0 || along > kAnticipation_s * speed2) return {};
  const float time_s = std::max(along / speed2, kMinTime_s);
  const Vec2 missed = closing * (along / speed2) - towards;  // from where they pass to me
  const float miss_m = Length(missed);
  if (miss_m >= reach_m) return {};
  const Vec2 side = miss_m > 0.05f ? missed * (1 / miss_m) : Vec2{-closing.y, closing.x} * (-1 / std::sqrt(speed2));
  return side * (kSidestepGain * (reach_m - miss_m) / (time_s * kRelaxation_s));
}

// Between walls and the disc, at once and a step on.
bool HasRoom(const Walkable& w, const Looking& me, const MovingObstacle& m, Vec2 direction) {
  const float least_m = std::min(m.radius_m + me.radius_m, Length(m.center - me.position)) - 0.001f;
  for (const float probe_m : {0.05f, 0.15f}) {
    const Vec2 to = KeepOffWalls(w, me.position, me.position + direction * probe_m, me.radius_m);
    if (Dot(to - me.position, direction) < 0.7f * probe_m || Length(to - m.center) < least_m) return false;
  }
  return true;
}

// Whoever cannot get through on that side goes round the disc on the other: nobody is pinned to a wall.
Vec2 WhereThereIsRoom(const Walkable& w, const Looking& me, const MovingObstacle& m, Vec2 aside) {
  const float size = Length(aside);
  if (size <= 0) return aside;
  const Vec2 towards = Unit(m.center - me.position), left{-towards.y, towards.x};
  const Vec2 other = left * (Dot(left, aside) > 0 ? -1.0f : 1.0f);
  const bool pressed = Length(m.center - me.position) < m.radius_m + me.radius_m + 2 * kComfort_m;
  const bool turned = pressed && Dot(me.velocity, other) > kTurnsAbove_mps;
  if (!turned && HasRoom(w, me, m, aside * (1 / size))) return aside;
  return HasRoom(w, me, m, other) ? other * size : aside;
}

Vec2 AvoidMoving(const Walkable& w, const std::vector<MovingObstacle>& moving, const Looking& me, bool avoids_camera) {
  Vec2 push;
  for (const MovingObstacle& m : moving) {
    if (!m.everyone && !avoids_camera) continue;
    const Vec2 towards = m.center - me.position, closing = me.velocity - m.velocity;
    const float distance_m = std::max(Length(towards), 1e-4f), reach_m = m.radius_m + me.radius_m;
    const float room_m = reach_m + 2 * kComfort_m;
    push = push + (m.everyone ? WhereThereIsRoom(w, me, m, StepAside(towards, closing, room_m))
                              : Anticipation(towards, closing, room_m) * kDiscMinded);
    const float gap_m = distance_m - reach_m;
    if (gap_m < 2 * kComfort_m) {
      push =
          push - towards * (kDiscMinded * kSeparation_mps2 * std::min(1.0f, 1 - gap_m / (2 * kComfort_m)) / distance_m);
    }
  }
  return ClampLength(push, kDiscMinded * kMaxPush_mps2);
}

// Who made room for the visitor comes back to the line they walked on, so that the crowd closes again behind.
Vec2 BackToLine(bool pushed, Vec2 position, Vec2 way, Mind* mind) {
  if (pushed) {
    if (mind->returns == 0) mind->left_line = position;
    mind->returns = kReturnDecisions;
    return {};
  }
  if (mind->returns == 0) return {};
  if (--mind->returns > kReturnDecisions - kPassing) return {};
  const Vec2 off = mind->left_line - position, aside = off - way * Dot(off, way);
  if (Dot(aside, aside) < kOnLine_m * kOnLine_m) mind->returns = 0;
  return ClampLength(aside * (1 / kReturn_s), kMaxReturn_mps) * (1 / kRelaxation_s);
}

// The person means to walk there, with whatever is in the way.
Vec2 GoingTo(const Crowd& c, size_t i) {
  if (c.detour_s[i] > 0) return Unit(c.detour[i]);
  return c.activity[i] == Activity::kWalking && c.field[i] >= 0 ? c.way[i] : Vec2{};
}

void BendWay(const Walkable& w, const std::vector<MovingObstacle>& moving, size_t i, Crowd* c) {
  Mind& mind = c->mind[i];
  mind.round = {};
  const Vec2 way = GoingTo(*c, i);
  if (way.x == 0 && way.y == 0) return;
  const bool straight = c->detour_s[i] <= 0 && c->sees_goal[i] != 0;
  const float goal_m = straight ? Length(c->fields[static_cast<size_t>(c->field[i])].goal - c->position[i]) : 1e9f;
  const Walking me{c->position[i], way, c->radius_m[i], std::max(mind.alone_mps, 0.3f), goal_m};
  const Vec2 round = WayRound(w, moving, me, &mind.side);
  if (round.x != way.x || round.y != way.y) mind.round = round;
}

// The weights of a full disc sum to half its area; walls leave less of it to people.
float DensityFrom(const Walkable& w, int cell, float crowding) {
  const float open =
      cell >= 0 ? std::max(0.2f, static_cast<float>(w.cells[static_cast<size_t>(cell)].open) * (1.0f / 255)) : 1.0f;
  return crowding * 2 / (kPi * kDensityRadius_m * kDensityRadius_m * open);
}

// Where a dense crowd stands before a door, every second another seven in ten of those who are stuck let the others go:
// else arches of people who all want through at once hold for a minute.
bool LetsOthersGo(float filled, Vec2 velocity, int id, int64_t step, const Mind& mind) {
  const float stuck_mps = kStuck * mind.alone_mps;
  if (Dot(velocity, velocity) > stuck_mps * stuck_mps) return false;
  if (filled < kStuckFilled && IsHeldUp(mind) < 1) return false;
  uint32_t hash = static_cast<uint32_t>(id) * 0x9e3779b9u ^ static_cast<uint32_t>(step / kLetsGo_steps) * 0x85ebca6bu;
  hash = (hash ^ hash >> 15) * 0x2c1b3c6du;
  hash = (hash ^ hash >> 12) * 0x297a2d39u;
  return static_cast<float>(hash >> 16) < kLetGo * 65536;
}

// From 0 to 1, while the value goes from one to the other.
float Grown(float value, float from, float to) { return std::clamp((value - from) / (to - from), 0.0f, 1.0f); }
float Grown(float value, const float (&between)[2]) { return Grown(value, between[0], between[1]); }

// How freely somebody who walks varies, 0 to 1.
float Ease(float clear_m, size_t i, const Crowd& c) {
  const Mind& mind = c.mind[i];
  if (mind.stands || c.field[i] < 0) return 0;
  float ease = Grown(clear_m - c.radius_m[i], kVariesFromWall_m) * Grown(mind.lately, kVariesGettingOn);
  if (!c.sees_goal[i]) return ease;
  const float goal_m = Length(c.fields[static_cast<size_t>(c.field[i])].goal - c.position[i]);
  return ease * Grown(goal_m, kVariesFromGoal_m);
}

// Who walks together varies together.
void Vary(float density_pm2, float clear_m, float step_s, size_t i, Crowd* c) {
  const float ease = Ease(clear_m, i, *c) * (1 - Grown(density_pm2, kThrong_pm2));
  if (ease <= 0) return;
  const int group = c->group[i];
  const size_t who = group >= 0 ? static_cast<size_t>(c->groups[static_cast<size_t>(group)].member[0]) : i;
  const Variation v = VariationAt(ClockAt(c->step, step_s), c->id[who]);
  Mind& mind = c->mind[i];
  const float company = Grown(density_pm2, kCompany_pm2), some = kAlone + (1 - kAlone) * company;
  const float strolls = company * (1 - Grown(mind.asked_mps, kStrolls_mps, kHurries_mps));
  const auto amount = [strolls](const float(&most)[2]) { return most[0] + (most[1] - most[0]) * strolls; };
  const float pace = company * amount(kSlowPace) * v.slow_pace + some * amount(kQuickPace) * v.quick_pace;
  const float course_rad = some * (amount(kSlowCourse_rad) * v.slow_course + amount(kQuickCourse_rad) * v.quick_course);
  mind.asked_mps *= 1 + ease * pace;
  const Vec2 way = GoingTo(*c, i);
  mind.push = mind.push + Vec2{-way.y, way.x} * (ease * course_rad * mind.asked_mps / kRelaxation_s);
}

void Decide(const Walkable& w, const std::vector<MovingObstacle>& moving, const NeighbourGrid& neighbours,
            const Neighbour& self, float step_s, Crowd* c) {
  const size_t i = static_cast<size_t>(self.person);
  Mind& mind = c->mind[i];
  const Looking me{self.position, self.velocity, mind.ahead, self.radius_m, self.person};
  const Surroundings around = LookAround(neighbours, me);
  const int cell = CellAt(w, me.position);
  const float density_pm2 = DensityFrom(w, cell, around.crowding);
  const float filled = DensityFrom(w, cell, around.filling);
  const float asked_mps = SpeedOnSlope(w, cell, mind.alone_mps) * SpeedInDensity(density_pm2);
  const float along = asked_mps > 0 && !mind.stands ? Dot(me.velocity, GoingTo(*c, i)) / asked_mps : 1;
  mind.lately += (along - mind.lately) * kLately;
  const bool lets_go = LetsOthersGo(filled, me.velocity, c->id[i], c->step, mind);
  mind.asked_mps = lets_go ? 0 : asked_mps;
  Vec2 push = around.foremost + around.separation;
  const bool works = c->activity[i] == Activity::kWorking && mind.stands;
  if (works || (mind.stands && Dot(push, push) < 1)) push = {};  // people who stand give way only when pressed
  const Vec2 room = c->sits[i] ? Vec2{} : AvoidMoving(w, moving, me, mind.avoids_camera);
  push = push + room;
  if (!mind.stands) push = push + BackToLine(Dot(room, room) > 0, me.position, c->way[i], &mind);
  mind.push = works ? push : push + WallPush(w, me.position, me.radius_m);  // a counter is near by choice
  BendWay(w, moving, i, c);
  mind.clear_from = me.position;
  mind.clear_m = ClearAround_m(w, cell);
  const bool makes_room = Dot(room, room) > 0 || mind.round.x != 0 || mind.round.y != 0;
  if (!lets_go && !makes_room) Vary(density_pm2, mind.clear_m, step_s, i, c);
}

}  // namespace

float SpeedInDensity(float density_pm2) {
  if (density_pm2 < 0.05f) return 1;
  const float exponent = kWeidmannGamma_pm2 * (1 / density_pm2 - 1 / kWeidmannMaxDensity_pm2);
  return exponent > 0 ? std::clamp(1 - DecayOf(exponent), kMinDensitySpeed, 1.0f) : kMinDensitySpeed;
}

float SpeedOnSlope(const Walkable& w, int cell, float level_mps) {
  return cell >= 0 ? level_mps / (1 + kSlopeSlows * SlopeOf(w, cell)) : level_mps;
}

void Decide(const Walkable& w, const std::vector<MovingObstacle>& moving, const NeighbourGrid& neighbours, float step_s,
            Jobs* jobs, Crowd* c) {
  const std::vector<Neighbour>& people = neighbours.people;
  const auto fetch = [&](size_t k) {
    if (!c->turn[static_cast<size_t>(people[k].person)]) return;
    Fetch(&c->mind[static_cast<size_t>(people[k].person)]);
    if (const int cell = CellAt(w, people[k].position); cell >= 0) Fetch(&w.cells[static_cast<size_t>(cell)]);
  };
  const auto decide = [&](size_t k) {
    if (c->turn[static_cast<size_t>(people[k].person)]) Decide(w, moving, neighbours, people[k], step_s, c);
  };
  InBlocks(jobs, people.size(), kFewPeople,
           [&](size_t first, size_t end) { FetchAndVisit(first, end, fetch, decide); });
}

Vec2 ToPost_mps(size_t i, const Crowd& c) {
  return ClampLength((c.post[i] - c.position[i]) * (1 / kToPost_s), kMaxToPost_mps);
}

void ChooseVelocity(float step_s, size_t i, Crowd* c) {
  const Mind& mind = c->mind[i];
  Vec2 preferred;
  if (c->detour_s[i] > 0) preferred = c->detour[i] * (mind.alone_mps > 0 ? mind.asked_mps / mind.alone_mps : 1.0f);
  else if (c->activity[i] == Activity::kWalking && c->field[i] >= 0) preferred = c->way[i] * mind.asked_mps;
  else if (c->activity[i] == Activity::kWorking) preferred = ToPost_mps(i, *c);
  if (mind.round.x != 0 || mind.round.y != 0) preferred = mind.round * Length(preferred);
  const Vec2 change = preferred + mind.push * kRelaxation_s - c->velocity[i];
  const float change_mps = Length(change);
  const float most_mps2 = std::min(kMaxAcceleration_mps2, std::max(change_mps / kRelaxation_s, kMinAcceleration_mps2));
  const Vec2 acceleration = ClampLength(change * (1 / step_s), most_mps2);
  c->wanted[i] = ClampLength(c->velocity[i] + acceleration * step_s, c->top_mps[i]);
}

}  // namespace flaneur
