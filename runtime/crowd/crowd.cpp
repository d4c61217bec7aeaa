#include "runtime/crowd/crowd.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/crowd/constants.h"
#include "runtime/crowd/steering.h"
#include "runtime/crowd/walls.h"

namespace flaneur {
namespace {

float WrapAngle(float a) {
  while (a > kPi) a -= 2 * kPi;
  while (a < -kPi) a += 2 * kPi;
  return a;
}

Vec2 ClampLength(Vec2 v, float most) {
  const float length = Length(v);
  return length > most ? v * (most / length) : v;
}

void RenewWays(const Walkable& w, Crowd* c) {
  for (size_t i = 0; i < c->size(); ++i) {
    if (c->field[i] < 0) continue;
    const int64_t turn = c->step + c->id[i];
    const bool lost = c->way[i].x == 0 && c->way[i].y == 0;
    const Vec2 goal = c->fields[static_cast<size_t>(c->field[i])].goal;
    if (lost || turn % kSightEvery_steps == 0) c->sees_goal[i] = StraightWay(w, c->position[i], goal) ? 1 : 0;
    if (c->sees_goal[i]) {
      const Vec2 way = goal - c->position[i];
      const float way_m = Length(way);
      c->way[i] = way_m > 1e-3f ? way * (1 / way_m) : Vec2{};
    } else if (lost || turn % kWayEvery_steps == 0) {
      c->way[i] = WayToGoal(w, c->field[i], c->position[i], c);
    }
  }
}

void SortPeople(const Walkable& w, Crowd* c) {
  c->cares.resize(c->size());
  for (size_t i = 0; i < c->size(); ++i) c->cares[i] = c->view[i] != ViewClass::kOutside;
  SortIntoGrid(w, c->position, c->velocity, c->radius_m, c->cares, kNeighbourRadius_m / 2, &c->neighbours);
}

// Nobody walks into a disc that is for everyone: a step that would goes along its rim or not at all.
Vec2 KeepOut(const std::vector<MovingObstacle>& moving, Vec2 from, Vec2 to, float radius_m) {
  for (const MovingObstacle& m : moving) {
    if (!m.everyone) continue;
    const float least_m = std::min(m.radius_m + radius_m, Length(from - m.center));
    const Vec2 off = to - m.center;
    const float after_m = Length(off);
    if (after_m >= least_m || after_m < 1e-5f) continue;
    const Vec2 rim = m.center + off * (least_m / after_m);
    const Vec2 along = from + ClampLength(rim - from, Length(to - from));
    to = Length(along - m.center) >= least_m - 1e-4f ? along : from;
  }
  return to;
}

// Where person i gets who heads for `to`: off walls, off the visitor, no farther than walking allows.
Vec2 WalkTowards(const Walkable& w, const std::vector<MovingObstacle>& moving, float step_s, const Crowd& c, size_t i, Vec2 to) {
  const Vec2 from = c.position[i];
  const Vec2 step = ClampLength(to - from, c.top_mps[i] * step_s);
  const Vec2 off_walls = KeepOffWalls(w, from, from + step, c.radius_m[i]);
  const Vec2 out = KeepOut(moving, from, off_walls, c.radius_m[i]);
  const bool turned = out.x != off_walls.x || out.y != off_walls.y;
  return turned ? KeepOut(moving, from, KeepOffWalls(w, from, out, c.radius_m[i]), c.radius_m[i]) : out;
}

void Move(const Walkable& w, const std::vector<MovingObstacle>& moving, float step_s, Crowd* c) {
  for (size_t i = 0; i < c->size(); ++i) {
    c->moved[i] = WalkTowards(w, moving, step_s, *c, i, c->position[i] + c->wanted[i] * step_s);
  }
}

// Pairs that would overlap share the correction (as in Weiss et al. 2019, position-based crowds), within what walking allows.
void ResolveContacts(const Walkable& w, const std::vector<MovingObstacle>& moving, float step_s, Crowd* c) {
  for (int pass = 0; pass < kContactPasses; ++pass) {
    bool any = false;
    for (const auto& [a, b] : c->contacts) {
      const size_t i = static_cast<size_t>(a), j = static_cast<size_t>(b);
      const Vec2 apart = c->moved[i] - c->moved[j];
      const float reach_m = c->radius_m[i] + c->radius_m[j], distance2 = Dot(apart, apart);
      if (distance2 >= reach_m * reach_m) continue;
      any = true;
      const float distance_m = std::sqrt(distance2);
      const Vec2 normal = distance_m > 1e-5f ? apart * (1 / distance_m) : Vec2{1, 0};
      const Vec2 half = normal * (0.5f * (reach_m - distance_m) + 1e-4f);
      const Vec2 before = c->moved[i];
      c->moved[i] = WalkTowards(w, moving, step_s, *c, i, before + half);
      const Vec2 rest = half * 2 - (c->moved[i] - before);  // what one cannot give, the other does
      c->moved[j] = WalkTowards(w, moving, step_s, *c, j, c->moved[j] - rest);
    }
    if (!any) return;
  }
}

void TurnTo(float heading_rad, float most_rad, float* now_rad) {
  *now_rad = WrapAngle(*now_rad + std::clamp(WrapAngle(heading_rad - *now_rad), -most_rad, most_rad));
}

void Arrive(float step_s, Crowd* c) {
  for (size_t i = 0; i < c->size(); ++i) {
    const Vec2 step = c->moved[i] - c->position[i];
    c->velocity[i] = step * (1 / step_s);
    c->position[i] = c->moved[i];
    const float walked_m = Length(step);
    c->walked_m[i] += walked_m;
    if (walked_m > kTurnsAbove_mps * step_s) {
      TurnTo(std::atan2(step.y, step.x), kMaxTurnRate_radps * step_s, &c->heading_rad[i]);
    } else if (c->facing[i].x != 0 || c->facing[i].y != 0) {
      TurnTo(std::atan2(c->facing[i].y, c->facing[i].x), 0.5f * kMaxTurnRate_radps * step_s, &c->heading_rad[i]);
    }
    const bool there = c->field[i] >= 0 &&
                       Length(c->fields[static_cast<size_t>(c->field[i])].goal - c->position[i]) < kArrival_m;
    c->arrived[i] = there ? 1 : 0;
    if (c->wait_s[i] > 0) c->wait_s[i] -= step_s;
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
  c->pace.push_back(1);
  c->walked_m.push_back(static_cast<float>(c->next_id % 16) * 0.1f);  // not all on the same foot
  c->wanted.push_back({});
  c->moved.push_back(p.position);
  return c->next_id++;
}

void RemovePerson(size_t i, Crowd* c) {
  const auto drop = [i](auto* values) {
    (*values)[i] = values->back();
    values->pop_back();
  };
  drop(&c->id), drop(&c->avatar), drop(&c->position), drop(&c->velocity), drop(&c->heading_rad), drop(&c->radius_m);
  drop(&c->preferred_mps), drop(&c->top_mps), drop(&c->field), drop(&c->way), drop(&c->sees_goal), drop(&c->activity);
  drop(&c->wait_s), drop(&c->facing), drop(&c->view), drop(&c->avoids_camera), drop(&c->arrived), drop(&c->pace);
  drop(&c->walked_m), drop(&c->wanted), drop(&c->moved);
}

void SetGoal(size_t i, int field, Crowd* c) {
  c->field[i] = field;
  c->way[i] = {};
  c->sees_goal[i] = c->arrived[i] = 0;
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
  RenewWays(w, c);
  SortPeople(w, c);
  ChooseVelocities(w, moving, step_s, c);
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
