#include "runtime/crowd/crowd.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/crowd/constants.h"
#include "runtime/crowd/contacts.h"
#include "runtime/crowd/fast_math.h"
#include "runtime/crowd/steering.h"
#include "runtime/crowd/walls.h"

namespace flaneur {
namespace {

bool IsLost(const Crowd& c, size_t i) { return c.way[i].x == 0 && c.way[i].y == 0; }

// Straight to the goal where it is in sight, else as the flow field says.
void RenewWay(const Walkable& w, size_t i, bool look, bool roughly, Crowd* c) {
  const Vec2 goal = c->fields[static_cast<size_t>(c->field[i])].goal;
  if (look) c->sees_goal[i] = StraightWay(w, c->position[i], goal) ? 1 : 0;
  if (!c->sees_goal[i]) {
    const FlowField& field = c->fields[static_cast<size_t>(c->field[i])];
    const bool rough = roughly && !field.distance.empty();
    c->way[i] = rough ? RoughWayAt(w, field, c->position[i]) : WayToGoal(w, c->field[i], c->position[i], c);
    return;
  }
  const Vec2 way = goal - c->position[i];
  const float way_m = Length(way);
  c->way[i] = way_m > 1e-3f ? way * (1 / way_m) : Vec2{};
}

// How many steps the person can walk straight on without coming near a wall, the goal or somebody's private disc.
int CoastSteps(const Walkable& w, const std::vector<MovingObstacle>& moving, float step_s, const Crowd& c, size_t i, int cell) {
  const float step_m = Length(c.wanted[i]) * step_s;
  const Vec2 left = c.fields[static_cast<size_t>(c.field[i])].goal - c.position[i];
  const float clear_m = ClearAround_m(w, cell) - c.radius_m[i];
  for (int steps = kMostCoast_steps; steps >= kTurnEvery_steps; steps -= kTurnEvery_steps) {
    const float run_m = static_cast<float>(steps) * step_m;
    if (clear_m < run_m || Dot(left, left) < 4 * run_m * run_m) continue;
    const bool free = std::none_of(moving.begin(), moving.end(), [&](const MovingObstacle& m) {
      const float reach_m = m.radius_m + c.radius_m[i] + run_m + Length(m.velocity) * static_cast<float>(steps) * step_s;
      const Vec2 off = m.center - c.position[i];
      return m.everyone && Dot(off, off) < reach_m * reach_m;
    });
    if (free) return steps;
  }
  return 0;
}

// People out of sight only follow their way.
void FollowWay(const Walkable& w, const std::vector<MovingObstacle>& moving, float step_s, size_t i, Crowd* c) {
  if (c->detour_s[i] > 0) {
    c->coast[i] = 0;
    c->mind[i].push = {};
    c->wanted[i] = c->detour[i];
    return;
  }
  if (c->coast[i] > 0) {
    --c->coast[i];
    return;
  }
  const bool walks = c->activity[i] == Activity::kWalking && c->field[i] >= 0;
  if (!walks) {
    c->wanted[i] = {};
    return;
  }
  const bool lost = IsLost(*c, i), turn = IsTurn(*c, i);
  if (!turn && !lost) return;
  const int64_t phase = (c->step + static_cast<int64_t>(i)) % (2 * kSightEvery_steps);
  RenewWay(w, i, lost || phase < kMostCoast_steps, true, c);
  const int cell = CellAt(w, c->position[i]);
  const float alone_mps = std::min(c->preferred_mps[i], c->top_mps[i]);
  Mind& mind = c->mind[i];
  mind.push = {};
  mind.clear_from = c->position[i];
  mind.clear_m = ClearAround_m(w, cell);
  c->wanted[i] = c->way[i] * SpeedOnSlope(w, cell, alone_mps);
  if (!turn) return;
  c->coast[i] = static_cast<uint8_t>(std::max(0, CoastSteps(w, moving, step_s, *c, i, cell) - 1));
  if (c->coast[i] > 0) c->velocity[i] = c->wanted[i];
}

void RenewWays(const Walkable& w, const std::vector<MovingObstacle>& moving, float step_s, Crowd* c) {
  for (size_t i = 0; i < c->size(); ++i) {
    c->cares[i] = c->view[i] != ViewClass::kOutside;
    if (!c->cares[i]) {
      FollowWay(w, moving, step_s, i, c);
      continue;
    }
    c->coast[i] = 0;
    if (IsTurn(*c, i)) {
      Mind& mind = c->mind[i];
      const bool on_detour = c->detour_s[i] > 0;
      mind.alone_mps = on_detour ? Length(c->detour[i]) : c->preferred_mps[i];
      mind.ahead = DirectionOf(c->heading_rad[i]);
      mind.stands = c->activity[i] != Activity::kWalking && !on_detour;
      mind.avoids_camera = c->avoids_camera[i] != 0;
    }
    if (c->field[i] < 0) continue;
    const bool lost = IsLost(*c, i);
    if (lost || IsTurn(*c, i)) {
      const int64_t every = c->sees_goal[i] ? 2 * kSightEvery_steps : kSightEvery_steps;
      RenewWay(w, i, lost || (c->step + static_cast<int64_t>(i)) % every == 0, false, c);
    }
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

void Move(const Walkable& w, const std::vector<MovingObstacle>& moving, float step_s, Crowd* c) {
  for (size_t i = 0; i < c->size(); ++i) {
    if (c->cares[i]) ChooseVelocity(step_s, i, c);
    const Vec2 to = c->position[i] + c->wanted[i] * step_s;
    const bool free = c->coast[i] > 0 || (IsClearFor(c->mind[i], to, c->radius_m[i]) && OutOfDiscs(moving, to, c->radius_m[i]));
    c->moved[i] = free ? to : WalkTowards(w, moving, step_s, *c, i, to);
  }
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

void Arrive(float step_s, Crowd* c) {
  const float per_step = 1 / step_s;
  for (size_t i = 0; i < c->size(); ++i) {
    const Vec2 step = c->moved[i] - c->position[i];
    const float walked_m = Length(step);
    c->position[i] = c->moved[i];
    c->walked_m[i] += walked_m;
    if (c->wait_s[i] > 0) c->wait_s[i] -= step_s;
    if (c->detour_s[i] > 0) c->detour_s[i] -= step_s;
    c->arrived[i] = 0;
    if (c->coast[i] > 0) continue;  // velocity and heading stay
    c->velocity[i] = step * per_step;
    if (c->field[i] >= 0) {
      const Vec2 left = c->fields[static_cast<size_t>(c->field[i])].goal - c->position[i];
      c->arrived[i] = Dot(left, left) < kArrival_m * kArrival_m ? 1 : 0;
    }
    Turn(step, walked_m, step_s, i, c);
  }
}

}  // namespace

int AddPerson(const Person& p, Crowd* c) {
  c->id.push_back(c->next_id);
  c->avatar.push_back(p.avatar);
  c->position.push_back(p.position);
  c->velocity.push_back({});
  c->heading_rad.push_back(p.heading_rad);
  c->radius_m.push_back(p.radius_m);
  c->preferred_mps.push_back(p.preferred_mps);
  c->top_mps.push_back(p.top_mps);
  c->field.push_back(p.field);
  c->way.push_back({});
  c->sees_goal.push_back(0);
  c->activity.push_back(p.field >= 0 ? Activity::kWalking : Activity::kStanding);
  c->wait_s.push_back(0);
  c->facing.push_back({});
  c->view.push_back(ViewClass::kOutside);
  c->avoids_camera.push_back(0);
  c->arrived.push_back(0);
  c->detour.push_back({});
  c->detour_s.push_back(0);
  c->walked_m.push_back(static_cast<float>(c->next_id % 16) * 0.1f);  // not all on the same foot
  c->mind.push_back({});
  c->mind.back().ahead = DirectionOf(p.heading_rad);
  c->coast.push_back(0);
  c->group.push_back(-1);
  c->cares.push_back(0);
  c->wanted.push_back({});
  c->moved.push_back(p.position);
  return c->next_id++;
}

void RemovePerson(size_t i, Crowd* c) {
  LeaveGroup(i, c);
  const int last = static_cast<int>(c->size()) - 1, of_last = c->group.back();
  if (of_last >= 0) {
    Group& g = c->groups[static_cast<size_t>(of_last)];
    std::replace(g.member, g.member + g.size, last, static_cast<int>(i));
  }
  const auto drop = [i](auto* values) {
    (*values)[i] = values->back();
    values->pop_back();
  };
  drop(&c->id), drop(&c->avatar), drop(&c->position), drop(&c->velocity), drop(&c->heading_rad), drop(&c->radius_m);
  drop(&c->preferred_mps), drop(&c->top_mps), drop(&c->field), drop(&c->way), drop(&c->sees_goal), drop(&c->activity);
  drop(&c->wait_s), drop(&c->facing), drop(&c->view), drop(&c->avoids_camera), drop(&c->arrived);
  drop(&c->detour), drop(&c->detour_s);
  drop(&c->walked_m), drop(&c->mind), drop(&c->coast), drop(&c->group), drop(&c->cares), drop(&c->wanted), drop(&c->moved);
}

void SetGoal(size_t i, int field, Crowd* c) {
  c->field[i] = field;
  c->way[i] = {};
  c->sees_goal[i] = c->arrived[i] = c->coast[i] = 0;
  c->activity[i] = field >= 0 ? Activity::kWalking : Activity::kStanding;
}

int FieldFor(Vec2 goal, Crowd* c) {
  for (size_t f = 0; f < c->fields.size(); ++f) {
    if (c->fields[f].goal.x == goal.x && c->fields[f].goal.y == goal.y) return static_cast<int>(f);
  }
  c->fields.push_back({goal, {}, {}});
  return static_cast<int>(c->fields.size()) - 1;
}

Vec2 WayToGoal(const Walkable& w, int field, Vec2 p, Crowd* c) {
  FlowField& f = c->fields[static_cast<size_t>(field)];
  if (f.distance.empty()) f = BuildFlowField(w, f.goal);
  return WayAt(w, f, p);
}

void StepCrowd(const Walkable& w, const std::vector<MovingObstacle>& moving, float step_s, Crowd* c) {
  RenewWays(w, moving, step_s, c);
  SortIntoGrid(w, c->position, c->velocity, c->radius_m, c->cares, kNeighbourRadius_m / 2, &c->neighbours);
  Decide(w, moving, c);
  WalkTogether(w, c);
  FindContacts(step_s, c);
  Move(w, moving, step_s, c);
  ResolveContacts(w, moving, step_s, c);
  Arrive(step_s, c);
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
