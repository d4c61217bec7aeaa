#include "runtime/crowd/crowd.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/crowd/constants.h"

namespace flaneur {
namespace {

constexpr int kWaypointEvery_steps = 8;
constexpr float kGridCell_m = kNeighbourRadius_m;
constexpr int kOverlapPasses = 4;

float WrapAngle(float a) {
  while (a > kPi) a -= 2 * kPi;
  while (a < -kPi) a += 2 * kPi;
  return a;
}

Vec2 ClampLength(Vec2 v, float most) {
  const float length = Length(v);
  return length > most ? v * (most / length) : v;
}

void RenewWaypoints(const Walkable& w, Crowd* c) {
  for (size_t i = 0; i < c->size(); ++i) {
    if (c->field[i] < 0) continue;
    const bool due = (c->step + c->id[i]) % kWaypointEvery_steps == 0 || Length(c->waypoint[i] - c->position[i]) < 0.6f;
    if (due) c->waypoint[i] = Waypoint(w, c->fields[static_cast<size_t>(c->field[i])], c->position[i]);
  }
}

// A uniform grid over the navigation area; people sorted by cell (counting sort).
struct NeighbourGrid { Vec2 min_m; int columns, rows; };

NeighbourGrid SortIntoGrid(const Walkable& w, Crowd* c) {
  NeighbourGrid g{w.min_m, 0, 0};
  g.columns = static_cast<int>(static_cast<float>(w.columns) * w.cell_m / kGridCell_m) + 1;
  g.rows = static_cast<int>(static_cast<float>(w.rows) * w.cell_m / kGridCell_m) + 1;
  c->grid_start.assign(static_cast<size_t>(g.columns * g.rows) + 1, 0);
  c->grid_cell.resize(c->size());
  c->grid_people.resize(c->size());
  for (size_t i = 0; i < c->size(); ++i) {
    const int x = std::clamp(static_cast<int>((c->position[i].x - g.min_m.x) / kGridCell_m), 0, g.columns - 1);
    const int y = std::clamp(static_cast<int>((c->position[i].y - g.min_m.y) / kGridCell_m), 0, g.rows - 1);
    c->grid_cell[i] = y * g.columns + x;
    ++c->grid_start[static_cast<size_t>(c->grid_cell[i]) + 1];
  }
  for (size_t i = 1; i < c->grid_start.size(); ++i) c->grid_start[i] += c->grid_start[i - 1];
  for (size_t i = c->size(); i-- > 0;) {  // backwards: stable once start is decremented
    c->grid_people[static_cast<size_t>(--c->grid_start[static_cast<size_t>(c->grid_cell[i]) + 1])] = static_cast<int>(i);
  }
  // After the loop start[k + 1] is the first of cell k: shift back.
  for (size_t k = 0; k + 1 < c->grid_start.size(); ++k) c->grid_start[k] = c->grid_start[k + 1];
  c->grid_start.back() = static_cast<int>(c->size());
  return g;
}

template <typename Visit>
void VisitNeighbours(const NeighbourGrid& g, const Crowd& c, size_t i, Visit visit) {
  const int x = c.grid_cell[i] % g.columns, y = c.grid_cell[i] / g.columns;
  for (int ny = std::max(0, y - 1); ny <= std::min(g.rows - 1, y + 1); ++ny) {
    for (int nx = std::max(0, x - 1); nx <= std::min(g.columns - 1, x + 1); ++nx) {
      const size_t cell = static_cast<size_t>(ny * g.columns + nx);
      for (int k = c.grid_start[cell]; k < c.grid_start[cell + 1]; ++k) {
        const size_t j = static_cast<size_t>(c.grid_people[static_cast<size_t>(k)]);
        if (j != i) visit(j);
      }
    }
  }
}

bool Cares(const Crowd& c, size_t i) { return c.view[i] != ViewClass::kOutside; }

// Acceleration from a predicted collision, the gradient of the energy k tau^-2 exp(-tau / tau0) over the time to collision tau
// (Karamouzas, Skinner, Guy 2014, eq. 3). `apart`: from the other to me; `closing`: my velocity less the other's.
Vec2 Anticipation(Vec2 apart, Vec2 closing, float reach_m) {
  const float a = Dot(closing, closing);
  const float b = -Dot(apart, closing);
  const float gap = Dot(apart, apart) - reach_m * reach_m;
  const float discriminant = b * b - a * gap;
  if (gap <= 0 || a < 1e-6f || discriminant <= 0 || b <= 0) return {};
  const float root = std::sqrt(discriminant);
  const float tau = (b - root) / a;
  if (!(tau > 0) || tau > kAnticipation_s) return {};
  const float strength = kInteraction_k * std::exp(-tau / kInteraction_tau0_s) * (2 / tau + 1 / kInteraction_tau0_s) / (a * tau * tau);
  const Vec2 direction = closing * -1.0f + (closing * b * -1.0f - apart * a) * (-1.0f / root);
  return ClampLength(direction * strength, 8.0f);
}

struct Surroundings { Vec2 push; float density_pm2 = 0; };

Surroundings LookAround(const NeighbourGrid& g, const Crowd& c, size_t i) {
  Surroundings s;
  const Vec2 ahead{std::cos(c.heading_rad[i]), std::sin(c.heading_rad[i])};
  float near_people = 0;
  VisitNeighbours(g, c, i, [&](size_t j) {
    if (!Cares(c, j)) return;
    const Vec2 apart = c.position[i] - c.position[j];
    const float distance_m = Length(apart);
    if (distance_m > kNeighbourRadius_m || distance_m < 1e-6f) return;
    const float reach_m = c.radius_m[i] + c.radius_m[j];
    // Someone at one's back is felt, not foreseen.
    const float attention = Dot(apart, ahead) < 0.2f * distance_m ? 1.0f : 0.25f;
    s.push = s.push + Anticipation(apart, c.velocity[i] - c.velocity[j], reach_m + kComfort_m * 0.5f) * attention;
    const float gap_m = distance_m - reach_m;
    if (gap_m < kComfort_m) s.push = s.push + apart * (kSeparation_mps2 * (1 - gap_m / kComfort_m) / distance_m);
    if (distance_m < 2.0f) near_people += 1;
  });
  s.density_pm2 = near_people / (kPi * 4.0f);
  return s;
}

float WeidmannFactor(float density_pm2) {
  if (density_pm2 < 0.05f) return 1;
  return std::clamp(1 - std::exp(-kWeidmannGamma * (1 / density_pm2 - 1 / kWeidmannMaxDensity_pm2)), 0.15f, 1.0f);
}

Vec2 WallPush(const Walkable& w, Vec2 p, float radius_m) {
  const int cell = CellAt(w, p);
  if (cell < 0) return {};
  constexpr float kReach_m = 0.35f;
  Vec2 push;
  for (int k = w.wall_start[static_cast<size_t>(cell)]; k < w.wall_start[static_cast<size_t>(cell) + 1]; ++k) {
    const auto& e = w.edges[static_cast<size_t>(w.wall_edges[static_cast<size_t>(k)])];
    const Vec2 ab = e.b - e.a;
    const float length2 = Dot(ab, ab);
    const float t = length2 > 0 ? std::clamp(Dot(p - e.a, ab) / length2, 0.0f, 1.0f) : 0.0f;
    const Vec2 off = p - (e.a + ab * t);
    const float distance_m = Length(off);
    const float gap_m = distance_m - radius_m;
    if (gap_m < kReach_m && distance_m > 1e-4f) push = push + off * (3.0f * (1 - gap_m / kReach_m) / distance_m);
  }
  for (int k = w.circle_start[static_cast<size_t>(cell)]; k < w.circle_start[static_cast<size_t>(cell) + 1]; ++k) {
    const auto& c = w.circles[static_cast<size_t>(w.wall_circles[static_cast<size_t>(k)])];
    const Vec2 off = p - c.center;
    const float distance_m = Length(off);
    const float gap_m = distance_m - radius_m - c.radius_m;
    if (gap_m < kReach_m && distance_m > 1e-4f) push = push + off * (3.0f * (1 - gap_m / kReach_m) / distance_m);
  }
  return ClampLength(push, 5.0f);
}

Vec2 AvoidMoving(const std::vector<MovingObstacle>& moving, const Crowd& c, size_t i) {
  Vec2 push;
  for (const MovingObstacle& m : moving) {
    if (!m.everyone && !c.avoids_camera[i]) continue;
    const Vec2 off = c.position[i] - m.center;
    const float distance_m = Length(off), reach_m = m.radius_m + c.radius_m[i];
    if (distance_m < 1e-4f) continue;
    push = push + Anticipation(off, c.velocity[i], reach_m);
    if (distance_m < reach_m + 0.3f) push = push + off * (4.0f * std::min(1.0f, (reach_m + 0.3f - distance_m)) / distance_m);
  }
  return ClampLength(push, 6.0f);
}

void ChooseVelocities(const Walkable& w, const std::vector<MovingObstacle>& moving, const NeighbourGrid& g, float step_s,
                      Crowd* c) {
  for (size_t i = 0; i < c->size(); ++i) {
    Vec2 preferred;
    const bool walks = c->activity[i] == Activity::kWalking && c->field[i] >= 0;
    const Vec2 way = c->waypoint[i] - c->position[i];
    const float way_m = Length(way);
    Surroundings around;
    if (Cares(*c, i)) around = LookAround(g, *c, i);
    if (walks && way_m > 1e-3f) {
      const float speed = c->preferred_mps[i] * c->pace[i] * WeidmannFactor(around.density_pm2);
      preferred = way * (speed / way_m);
    }
    Vec2 acceleration = (preferred - c->velocity[i]) * (1 / kRelaxation_s);
    if (Cares(*c, i)) {
      acceleration = acceleration + around.push + WallPush(w, c->position[i], c->radius_m[i]) + AvoidMoving(moving, *c, i);
    }
    if (!walks) {  // people who stand only give way when pressed
      const float pressed = Length(around.push + AvoidMoving(moving, *c, i));
      if (pressed < 1.0f) acceleration = c->velocity[i] * (-1 / kRelaxation_s);
    }
    acceleration = ClampLength(acceleration, kMaxAcceleration_mps2);
    c->wanted[i] = ClampLength(c->velocity[i] + acceleration * step_s, c->top_mps[i]);
  }
}

// Nobody walks into a disc that is for everyone: a step that would goes along its rim or not at all.
Vec2 KeepOut(const std::vector<MovingObstacle>& moving, Vec2 from, Vec2 to, float radius_m) {
  for (const MovingObstacle& m : moving) {
    if (!m.everyone) continue;
    const float reach_m = m.radius_m + radius_m, before_m = Length(from - m.center);
    const Vec2 off = to - m.center;
    const float after_m = Length(off);
    if (after_m >= reach_m || after_m >= before_m || after_m < 1e-5f) continue;
    const Vec2 rim = m.center + off * (std::min(reach_m, before_m) / after_m);
    to = from + ClampLength(rim - from, Length(to - from));
  }
  return to;
}

void Move(const Walkable& w, const std::vector<MovingObstacle>& moving, float step_s, Crowd* c) {
  for (size_t i = 0; i < c->size(); ++i) {
    const Vec2 to = KeepOut(moving, c->position[i], c->position[i] + c->wanted[i] * step_s, c->radius_m[i]);
    c->moved[i] = KeepOffWalls(w, c->position[i], to, c->radius_m[i]);
  }
}

// Pairs that would overlap share the correction; nobody is carried farther than they could have walked.
void ResolveOverlaps(const Walkable& w, const NeighbourGrid& g, float step_s, Crowd* c) {
  for (int pass = 0; pass < kOverlapPasses; ++pass) {
    bool any = false;
    for (size_t i = 0; i < c->size(); ++i) {
      if (!Cares(*c, i)) continue;
      Vec2 correction;
      VisitNeighbours(g, *c, i, [&](size_t j) {
        if (!Cares(*c, j)) return;
        const Vec2 apart = c->moved[i] - c->moved[j];
        const float reach_m = c->radius_m[i] + c->radius_m[j], distance2 = Dot(apart, apart);
        if (distance2 >= reach_m * reach_m) return;
        const float distance_m = std::sqrt(distance2);
        const Vec2 normal = distance_m > 1e-5f ? apart * (1 / distance_m) : Vec2{c->id[i] < c->id[j] ? 1.0f : -1.0f, 0};
        correction = correction + normal * (0.5f * (reach_m - distance_m));
      });
      if (Dot(correction, correction) == 0) continue;
      any = true;
      const Vec2 step = ClampLength(c->moved[i] + correction - c->position[i], c->top_mps[i] * step_s);
      c->moved[i] = KeepOffWalls(w, c->position[i], c->position[i] + step, c->radius_m[i]);
    }
    if (!any) return;
  }
}

void Arrive(float step_s, Crowd* c) {
  for (size_t i = 0; i < c->size(); ++i) {
    const Vec2 step = c->moved[i] - c->position[i];
    c->velocity[i] = step * (1 / step_s);
    c->position[i] = c->moved[i];
    const float walked_m = Length(step);
    c->walked_m[i] += walked_m;
    const float speed = walked_m / step_s;
    if (speed > 0.15f) {
      const float turn = WrapAngle(std::atan2(step.y, step.x) - c->heading_rad[i]);
      const float most = kMaxTurnRate_radps * step_s * 1.5f;
      c->heading_rad[i] = WrapAngle(c->heading_rad[i] + std::clamp(turn, -most, most));
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
  c->waypoint.push_back(p.position);
  c->activity.push_back(p.field >= 0 ? Activity::kWalking : Activity::kStanding);
  c->wait_s.push_back(0);
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
  drop(&c->preferred_mps), drop(&c->top_mps), drop(&c->field), drop(&c->waypoint), drop(&c->activity), drop(&c->wait_s);
  drop(&c->view), drop(&c->avoids_camera), drop(&c->arrived), drop(&c->pace), drop(&c->walked_m);
  drop(&c->wanted), drop(&c->moved);
}

int FieldFor(const Walkable& w, Vec2 goal, Crowd* c) {
  for (size_t f = 0; f < c->fields.size(); ++f) {
    if (c->fields[f].goal.x == goal.x && c->fields[f].goal.y == goal.y) return static_cast<int>(f);
  }
  c->fields.push_back(BuildFlowField(w, goal));
  return static_cast<int>(c->fields.size()) - 1;
}

void StepCrowd(const Walkable& w, const std::vector<MovingObstacle>& moving, float step_s, Crowd* c) {
  RenewWaypoints(w, c);
  const NeighbourGrid g = SortIntoGrid(w, c);
  ChooseVelocities(w, moving, g, step_s, c);
  Move(w, moving, step_s, c);
  ResolveOverlaps(w, g, step_s, c);
  Arrive(step_s, c);
  ++c->step;
}

void SeparateBoundary(const Walkable& w, bool (*keep_out)(Vec2, const void*), const void* volume, Crowd* c) {
  const NeighbourGrid g = SortIntoGrid(w, c);
  for (size_t i = 0; i < c->size(); ++i) {
    if (c->view[i] != ViewClass::kBoundary) continue;
    const Vec2 start = c->position[i];
    const auto overlaps = [&](Vec2 p) {
      bool any = false;
      VisitNeighbours(g, *c, i, [&](size_t j) {
        const float reach_m = c->radius_m[i] + c->radius_m[j];
        const Vec2 apart = p - c->position[j];
        any = any || (Cares(*c, j) && Dot(apart, apart) < reach_m * reach_m);
      });
      return any;
    };
    if (!overlaps(start)) continue;
    // The nearest free spot on growing rings; nobody sees it.
    bool placed = false;
    for (int ring = 1; ring <= 12 && !placed; ++ring) {
      for (int k = 0; k < 16 && !placed; ++k) {
        const float angle = 2 * kPi * static_cast<float>(k) / 16, reach_m = 0.15f * static_cast<float>(ring);
        const Vec2 p = start + Vec2{std::cos(angle), std::sin(angle)} * reach_m;
        if (keep_out(p, volume) || !IsFree(w, p) || overlaps(p)) continue;
        const int a = CellAt(w, p), b = CellAt(w, start);
        if (b >= 0 && w.component[static_cast<size_t>(b)] >= 0 &&
            w.component[static_cast<size_t>(a)] != w.component[static_cast<size_t>(b)]) {
          continue;
        }
        c->position[i] = p;
        placed = true;
      }
    }
  }
}

uint64_t StateHash(const Crowd& c) {
  uint64_t hash = 14695981039346656037ull;
  const auto mix = [&](float value) {
    uint32_t bits;
    std::memcpy(&bits, &value, 4);
    hash = (hash ^ bits) * 1099511628211ull;
  };
  for (size_t i = 0; i < c.size(); ++i) {
    mix(c.position[i].x);
    mix(c.position[i].y);
    mix(c.heading_rad[i]);
  }
  return hash;
}

}  // namespace flaneur
