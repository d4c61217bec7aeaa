#include "runtime/crowd/crowd.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/base/fetch.h"
#include "runtime/crowd/constants.h"
#include "runtime/crowd/contacts.h"
#include "runtime/crowd/fast_math.h"
#include "runtime/crowd/steering.h"
#include "runtime/crowd/walls.h"

namespace flaneur {
namespace {

constexpr float kHardly_mps = 0.2f;  // slower, at a wall, they look for the door beside them

// People decide one after the other, each in a step of their own; neighbours, who often have ids in a row, in no
// regular pattern.
bool IsTurn(const Crowd& c, size_t i, int every_steps) {
  const uint32_t phase = static_cast<uint32_t>(c.id[i]) * 2654435769u >> 16;
  return (static_cast<uint32_t>(c.step) + phase) % static_cast<uint32_t>(every_steps) == 0;
}

bool IsLost(const Crowd& c, size_t i) { return c.way[i].x == 0 && c.way[i].y == 0; }

// Straight to the goal where it is in sight, else as the flow field says.
Vec2 WayOn(const Walkable& w, size_t i, bool roughly, Crowd* c) {
  const FlowField& field = c->fields[static_cast<size_t>(c->field[i])];
  if (c->sees_goal[i]) {
    const Vec2 way = field.goal - c->position[i];
    const float way_m = Length(way);
    return way_m > 1e-3f ? way * (1 / way_m) : Vec2{};
  }
  if (roughly && IsBuilt(field)) return RoughWayAt(w, field, c->position[i]);
  return WayToGoal(w, c->field[i], c->position[i], IsTurn(*c, i, kSightEvery_steps), &c->corner[i], c);
}

void RenewWay(const Walkable& w, size_t i, bool look, bool roughly, Crowd* c) {
  const Vec2 goal = c->fields[static_cast<size_t>(c->field[i])].goal;
  if (look) c->sees_goal[i] = StraightWay(w, c->position[i], goal) ? 1 : 0;
  c->way[i] = WayOn(w, i, roughly, c);
  if (Dot(c->velocity[i], c->velocity[i]) < kHardly_mps * kHardly_mps)
    c->way[i] = AlongToDoor(w, c->position[i], c->radius_m[i], c->way[i]);
}

// How many steps the person can walk straight on without coming near a wall, the goal or somebody's private disc.
int CoastSteps(const std::vector<MovingObstacle>& moving, float step_s, const Crowd& c, size_t i) {
  const float step_m = Length(c.wanted[i]) * step_s;
  const float clear_m = std::min(c.mind[i].clear_m - c.radius_m[i],
                                 0.5f * Length(c.fields[static_cast<size_t>(c.field[i])].goal - c.position[i]));
  const float most = std::min(clear_m / std::max(step_m, 1e-6f), static_cast<float>(kMaxCoast_steps));
  const int steps = static_cast<int>(most) / kTurnEvery_steps * kTurnEvery_steps;
  if (steps <= 0) return 0;
  const float run_s = static_cast<float>(steps) * step_s;
  const bool free = std::none_of(moving.begin(), moving.end(), [&](const MovingObstacle& m) {
    const float reach_m = m.radius_m + c.radius_m[i] + (Length(c.wanted[i]) + Length(m.velocity)) * run_s;
    const Vec2 off = m.center - c.position[i];
    return m.everyone && Dot(off, off) < reach_m * reach_m;
  });
  return free ? steps : 0;
}

// What people out of sight want: along their way, or as the control asks.
void FollowWay(const Walkable& w, const std::vector<MovingObstacle>& moving, float step_s, size_t i, Crowd* c) {
  Mind& mind = c->mind[i];
  mind.push = {};
  if (c->detour_s[i] > 0 || c->activity[i] != Activity::kWalking || c->field[i] < 0) {
    if (c->turn[i] && c->field[i] >= 0) RenewWay(w, i, false, true, c);
    const Vec2 still = c->activity[i] == Activity::kWorking ? ToPost_mps(i, *c) : Vec2{};
    c->wanted[i] = c->detour_s[i] > 0 ? c->detour[i] : still;
    return;
  }
  const bool lost = IsLost(*c, i);
  if (!c->turn[i] && !lost) return;
  c->sees_goal[i] = 0;
  RenewWay(w, i, false, true, c);
  const int cell = CellAt(w, c->position[i]);
  const float alone_mps = std::min(c->preferred_mps[i], c->top_mps[i]);
  mind.clear_from = c->position[i];
  mind.clear_m = ClearAround_m(w, cell);
  c->wanted[i] = c->way[i] * SpeedOnSlope(w, cell, alone_mps);
  if (!c->turn[i]) return;
  c->coast[i] = static_cast<uint8_t>(std::max(0, CoastSteps(moving, step_s, *c, i) - 1));
  if (c->coast[i] > 0) c->velocity[i] = c->wanted[i];
}

// Those who decide soon ask for ground all over the town. GCC 12 leaves out a call that does nothing but fetch.
[[gnu::always_inline]] inline void FetchGround(const Walkable& w, size_t i, const Crowd& c) {
  if (c.field[i] < 0) return;
  const FlowField& field = c.fields[static_cast<size_t>(c.field[i])];
  const GridPlace at = PlaceAt(w, c.position[i]);
  if (at.x < 0 || !IsBuilt(field)) return;
  Fetch(&w.cells[static_cast<size_t>(at.y * w.columns + at.x)]);
  Fetch(&DirectionAt(field, DirectionIndex(w, at.x, at.y)));
}

// A search remembers what it found, and who asks for a field may have it built: such people come one after the other,
// in the order of their indices.
bool HasToSearch(const Crowd& c, size_t i) {
  return c.field[i] >= 0 && !IsBuilt(c.fields[static_cast<size_t>(c.field[i])]);
}

void RenewOwnWay(const Walkable& w, size_t i, Crowd* c) {
  const bool lost = IsLost(*c, i);
  if (!lost && !c->turn[i]) return;
  const int every = c->sees_goal[i] ? 2 * kSightEvery_steps : kSightEvery_steps;
  RenewWay(w, i, lost || IsTurn(*c, i, every), false, c);
}

// Where those who take care go next, and what they have in mind; some of them look around in this step.
void RenewWays(const Walkable& w, Jobs* jobs, CrowdScratch* s, Crowd* c) {
  const std::vector<int>& caring = s->caring;
  const auto fetch = [&](size_t k) {
    if (const size_t i = static_cast<size_t>(caring[k]); c->turn[i]) FetchGround(w, i, *c);
  };
  const auto renew = [&](size_t k) {
    const size_t i = static_cast<size_t>(caring[k]);
    c->coast[i] = 0;
    if (c->turn[i]) {
      Mind& mind = c->mind[i];
      const bool on_detour = c->detour_s[i] > 0;
      mind.alone_mps = on_detour ? Length(c->detour[i]) : c->preferred_mps[i];
      mind.ahead = DirectionOf(c->heading_rad[i]);
      mind.stands = c->activity[i] != Activity::kWalking && !on_detour;
      mind.avoids_camera = c->avoids_camera[i] != 0;
    }
    s->waits[i] = HasToSearch(*c, i);
    if (c->field[i] >= 0 && !s->waits[i]) RenewOwnWay(w, i, c);
  };
  InBlocks(jobs, caring.size(), kFewPeople, [&](size_t first, size_t end) { FetchAndVisit(first, end, fetch, renew); });
  for (int who : caring) {
    if (s->waits[static_cast<size_t>(who)]) RenewOwnWay(w, static_cast<size_t>(who), c);
  }
}

bool IsClearFor(const Mind& mind, Vec2 p, float radius_m) {
  const Vec2 off = p - mind.clear_from;
  const float reach_m = mind.clear_m - radius_m;
  return reach_m > 0 && Dot(off, off) < reach_m * reach_m;
}

bool OutOfDiscs(const std::vector<MovingObstacle>& moving, Vec2 p, float radius_m) {
  for (const MovingObstacle& m : moving) {
    const Vec2 off = p - m.center;
    const float reach_m = m.radius_m + radius_m;
    if (m.everyone && Dot(off, off) < reach_m * reach_m) return false;
  }
  return true;
}

// Where the step that the person wants takes them.
Vec2 Stepped(const Walkable& w, const std::vector<MovingObstacle>& moving, float step_s, size_t i, const Crowd& c) {
  const Vec2 to = c.position[i] + c.wanted[i] * step_s;
  const bool free = IsClearFor(c.mind[i], to, c.radius_m[i]) && OutOfDiscs(moving, to, c.radius_m[i]);
  return free ? to : WalkTowards(w, moving, step_s, c, i, to);
}

void Move(const Walkable& w, const std::vector<MovingObstacle>& moving, float step_s, Jobs* jobs, CrowdScratch* s,
          Crowd* c) {
  s->moved.resize(c->size());
  InBlocks(jobs, s->caring.size(), kFewPeople, [&](size_t first, size_t end) {
    for (size_t k = first; k < end; ++k) {
      const size_t i = static_cast<size_t>(s->caring[k]);
      ChooseVelocity(step_s, i, c);
      s->moved[i] = Stepped(w, moving, step_s, i, *c);
    }
  });
}

void TurnTo(Vec2 direction, float most_rad, float* now_rad) {
  *now_rad = WrapAngle(*now_rad + std::clamp(WrapAngle(AngleOf(direction) - *now_rad), -most_rad, most_rad));
}

// The same where the turn is small, from the unit vector of the present heading: without an arc tangent.
bool TurnALittle(Vec2 direction, float length, Vec2* ahead, float most_rad, float* now_rad) {
  const Vec2 unit = direction * (1 / length);
  const float sine = Cross(*ahead, unit);
  if (Dot(*ahead, unit) < 0.5f || std::abs(sine) > 0.25f) return false;
  const float turn_rad = sine * (1 + sine * sine * (1.0f / 6 + sine * sine * (3.0f / 40)));
  if (std::abs(turn_rad) > most_rad) return false;
  *ahead = unit;
  *now_rad = WrapAngle(*now_rad + turn_rad);
  return true;
}

// The body turns the way it walks; who stands turns to what they look at.
void Turn(Vec2 step, float walked_m, float step_s, size_t i, Crowd* c) {
  const float most_rad = kMaxTurnRate_radps * step_s;
  if (walked_m > kTurnsAbove_mps * step_s) {
    if (TurnALittle(step, walked_m, &c->mind[i].ahead, most_rad, &c->heading_rad[i])) return;
    TurnTo(step, most_rad, &c->heading_rad[i]);
  } else if (c->facing[i].x != 0 || c->facing[i].y != 0) {
    TurnTo(c->facing[i], 0.5f * most_rad, &c->heading_rad[i]);
  } else {
    return;
  }
  c->mind[i].ahead = DirectionOf(c->heading_rad[i]);
}

Arrival ArrivalAt(Vec2 goal, size_t i, const Crowd& c) {
  const Vec2 left = goal - c.position[i];
  const float left2_m2 = Dot(left, left);
  if (left2_m2 < kArrival_m * kArrival_m) return Arrival::kThere;
  const float slow_mps = kHeldUp * c.preferred_mps[i];
  const bool held_up =
      left2_m2 < kNearArrival_m * kNearArrival_m && Dot(c.velocity[i], c.velocity[i]) < slow_mps * slow_mps;
  return held_up ? Arrival::kNear : Arrival::kNot;
}

// The person is now at `to`.
void Arrive(Vec2 to, float step_s, size_t i, Crowd* c) {
  const Vec2 step = to - c->position[i];
  const float walked_m = Length(step);
  c->position[i] = to;
  c->walked_m[i] += walked_m;
  if (c->wait_s[i] > 0) c->wait_s[i] -= step_s;
  if (c->detour_s[i] > 0) c->detour_s[i] -= step_s;
  if (c->coast[i] == 0) c->velocity[i] = step * (1 / step_s);
  c->arrived[i] = c->field[i] >= 0 ? ArrivalAt(c->fields[static_cast<size_t>(c->field[i])].goal, i, *c) : Arrival::kNot;
  if (c->coast[i] > 0) return;  // the heading stays
  Turn(step, walked_m, step_s, i, c);
}

// The whole step of somebody who takes no care of anybody.
void FollowAndArrive(const Walkable& w, const std::vector<MovingObstacle>& moving, float step_s, size_t i, Crowd* c) {
  c->turn[i] = IsTurn(*c, i, kTurnEvery_steps);
  c->coast[i] = 0;
  FollowWay(w, moving, step_s, i, c);
  const bool coasts = c->coast[i] > 0;
  Arrive(coasts ? c->position[i] + c->wanted[i] * step_s : Stepped(w, moving, step_s, i, *c), step_s, i, c);
}

// Whether they take care, or else their step, unless they have to search: true, then it is still to be taken.
bool FollowOrCare(const Walkable& w, const std::vector<MovingObstacle>& moving, float step_s, size_t i, Crowd* c) {
  const float far2_m2 = c->r_far_m * c->r_far_m, unimportant2_m2 = c->r_unimportant_m * c->r_unimportant_m;
  const Vec2 off = c->position[i] - c->viewer;
  const float distance2_m2 = Dot(off, off);
  c->cares[i] = c->view[i] != ViewClass::kOutside && distance2_m2 <= far2_m2;
  if (c->cares[i]) {
    const int every = distance2_m2 <= unimportant2_m2       ? kTurnEvery_steps
                      : distance2_m2 <= 4 * unimportant2_m2 ? kFarTurnEvery_steps
                                                            : kFarthestTurnEvery_steps;
    c->turn[i] = IsTurn(*c, i, every);
  } else if (c->coast[i] > 0 && c->detour_s[i] <= 0) {
    const Vec2 step = c->wanted[i] * step_s;
    c->position[i] = c->position[i] + step;
    c->walked_m[i] += Length(step);
    --c->coast[i];
  } else if (HasToSearch(*c, i)) {
    return true;
  } else {
    FollowAndArrive(w, moving, step_s, i, c);
  }
  return false;
}

// The whole step of those who take no care of anybody, and a list of those who do.
void FollowOrCare(const Walkable& w, const std::vector<MovingObstacle>& moving, float step_s, Jobs* jobs,
                  CrowdScratch* s, Crowd* c) {
  s->waits.resize(c->size());
  const auto fetch = [&](size_t i) {
    if (!c->cares[i] && c->coast[i] == 0 && IsTurn(*c, i, kTurnEvery_steps)) FetchGround(w, i, *c);
  };
  const auto follow = [&](size_t i) { s->waits[i] = FollowOrCare(w, moving, step_s, i, c); };
  InBlocks(jobs, c->size(), kFewPeople, [&](size_t first, size_t end) { FetchAndVisit(first, end, fetch, follow); });
  s->caring.clear();
  s->caring.reserve(c->size());
  for (size_t i = 0; i < c->size(); ++i) {
    if (c->cares[i]) s->caring.push_back(static_cast<int>(i));
    else if (s->waits[i]) FollowAndArrive(w, moving, step_s, i, c);
  }
}

// What was asked for and is still being built is left to its builder.
void LetGo(FlowField* f) {
  f->deserted = 0;
  if (!IsBuilt(*f) && f->questions >= kSharedGoal) return;
  std::vector<DirectionTile>().swap(f->tiles);
  f->questions = 0;
}

void LetGoOfDesertedFields(CrowdScratch* s, Crowd* c) {
  if (c->step % kFieldLook_steps != 0) return;
  s->field_is_used.assign(c->fields.size(), 0);
  for (const int field : c->field) {
    if (field >= 0) s->field_is_used[static_cast<size_t>(field)] = 1;
  }
  for (size_t f = 0; f < c->fields.size(); ++f) {
    FlowField& field = c->fields[f];
    field.deserted = s->field_is_used[f] ? 0 : field.deserted + 1;
    if (field.deserted >= kDesertedLooks) LetGo(&field);
  }
}

}  // namespace

void SetGoal(size_t i, int field, Crowd* c) {
  c->field[i] = field;
  c->way[i] = {};
  c->corner[i] = {};
  c->sees_goal[i] = c->coast[i] = 0;
  c->arrived[i] = Arrival::kNot;
  c->activity[i] = field >= 0 ? Activity::kWalking : Activity::kStanding;
  c->doing[i] = -1;
  c->sits[i] = 0;
}

int FieldFor(Vec2 goal, Crowd* c) {
  for (size_t f = 0; f < c->fields.size(); ++f) {
    if (c->fields[f].goal.x == goal.x && c->fields[f].goal.y == goal.y) return static_cast<int>(f);
  }
  c->fields.push_back({goal, {}});
  return static_cast<int>(c->fields.size()) - 1;
}

void BuildField(const Walkable& w, int field, Crowd* c) {
  FlowField& f = c->fields[static_cast<size_t>(field)];
  if (!IsBuilt(f)) f = BuildFlowField(w, f.goal);
}

Vec2 WayToGoal(const Walkable& w, int field, Vec2 p, bool look, Corner* corner, Crowd* c) {
  FlowField& f = c->fields[static_cast<size_t>(field)];
  if (!IsBuilt(f) && !corner->known && ++f.questions == kSharedGoal) {
    c->fields_come_later ? c->asked_fields.push_back(field) : BuildField(w, field, c);
  }
  if (IsBuilt(f)) return WayAt(w, f, p);
  return WayByCorners(w, p, f.goal, look, corner, &c->search);
}

// A pass writes only what belongs to its person or group, and reads of others what no pass beside it writes: so its
// blocks may be done side by side.
void StepCrowd(const Walkable& w, const std::vector<MovingObstacle>& moving, float step_s, CrowdScratch* s, Crowd* c,
               Jobs* jobs) {
  LetGoOfDesertedFields(s, c);
  FollowOrCare(w, moving, step_s, jobs, s, c);
  RenewWays(w, jobs, s, c);
  SortIntoGrid(s->caring, c->position, c->velocity, c->radius_m, kGridCell_m, &s->neighbours);
  Decide(w, moving, s->neighbours, step_s, jobs, c);
  WalkTogether(w, jobs, c);
  FindContacts(*c, step_s, jobs, s);
  Move(w, moving, step_s, jobs, s, c);
  ResolveContacts(w, moving, step_s, *c, s);
  InBlocks(jobs, s->caring.size(), kFewPeople, [&](size_t first, size_t end) {
    for (size_t k = first; k < end; ++k) {
      const size_t i = static_cast<size_t>(s->caring[k]);
      Arrive(s->moved[i], step_s, i, c);
    }
  });
  ++c->step;
}

uint64_t StateHash(const Crowd& c) {
  uint64_t hash = 14695981039346656037ull;
  const auto mix = [&](float value) {
    uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    hash = (hash ^ bits) * 1099511628211ull;
  };
  for (size_t i = 0; i < c.size(); ++i) {
    mix(c.position[i].x), mix(c.position[i].y), mix(c.heading_rad[i]);
  }
  return hash;
}

}  // namespace flaneur
