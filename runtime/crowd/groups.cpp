#include "runtime/crowd/groups.h"

#include <algorithm>
#include <cmath>

#include "runtime/crowd/constants.h"
#include "runtime/crowd/crowd.h"
#include "runtime/crowd/fast_math.h"
#include "runtime/crowd/steering.h"
#include "runtime/crowd/variation.h"

namespace flaneur {
namespace {

constexpr float kElbowRoom_m = 0.35f;  // between bodies in a row
constexpr float kMinElbowRoom_m = 0.1f;
// Of two: between bodies, and how far one walks ahead of the other, from pair to pair. By recordings (ETH,
// UCY): 0.73 m apart and 0.21 m ahead are the medians.
constexpr float kPairElbowRoom_m[] = {0.26f, 0.37f};
constexpr float kStagger_m = 0.75f;
constexpr float kRowGap_m = 0.95f;  // from row to row
constexpr float kInnerBack_m = 0.2f;
constexpr float kWider_m = 0.35f;  // more room than needed before a row grows again: nobody wavers
constexpr float kLook_m = 0.8f;    // between the points ahead where room is looked for
constexpr int kLooks = 4;
constexpr int kLookEvery_turns = 4;
constexpr float kMaxElbowRoom_m = 2.4f;  // to each side
constexpr float kTurnsWithWay = 0.25f;   // of the common way, each time it is looked at
constexpr float kCatchUp_pm = 0.5f;      // change of pace by a metre ahead or behind
constexpr float kMinPace = 0.3f, kMaxPace = 1.25f;
constexpr float kAside_ps = 0.9f;  // share of the offset made good in a second
constexpr float kMaxAside_mps = 0.4f;
constexpr float kGoalOwn_m = 1.5f, kGoalFades_m = 1.5f;  // close to the goal everybody walks for themselves

struct Formation {
  int count = 0;
  int who[kMaxGroupSize];        // indices of Group::member, of those who walk, by place
  size_t person[kMaxGroupSize];  // by member
  Vec2 place[kMaxGroupSize];     // x ahead, y to the left of the centre
  Vec2 center, ahead, left;
};

bool Walks(const Crowd& c, size_t i) {
  return c.activity[i] == Activity::kWalking && c.field[i] >= 0 && c.cares[i] && c.detour_s[i] <= 0;
}

// How far people can stand from p in this direction.
float Room_m(const Walkable& w, Vec2 p, Vec2 direction) {
  const float step_m = 0.5f * w.cell_m;
  float room_m = 0;
  while (room_m < kMaxElbowRoom_m) {
    const int cell = CellAt(w, p + direction * (room_m + step_m));
    if (cell < 0 || w.cost[static_cast<size_t>(cell)] <= 0) break;
    room_m +=
        std::max(step_m, w.cell_m * static_cast<float>(w.cells[static_cast<size_t>(cell)].same));  // all of it free
  }
  return std::min(room_m, kMaxElbowRoom_m);
}

// The least room across the way, from here to where the group will soon be.
float RoomAhead_m(const Walkable& w, const Formation& f, Crowd* c) {
  const size_t leader = f.person[f.who[0]];
  const Vec2 goal = c->fields[static_cast<size_t>(c->field[leader])].goal;
  float least_m = 2 * kMaxElbowRoom_m;
  Vec2 p = f.center, way = f.ahead;
  for (int k = 0; k < kLooks; ++k) {
    const Vec2 left{-way.y, way.x};
    if (IsFree(w, p)) least_m = std::min(least_m, Room_m(w, p, left) + Room_m(w, p, left * -1));
    if (Length(goal - p) < kLook_m) break;
    p = p + way * kLook_m;
    const FlowField& field = c->fields[static_cast<size_t>(c->field[leader])];
    way = c->sees_goal[leader] ? Unit(goal - p)
          : IsBuilt(field)     ? WayAt(w, field, p)
                               : Unit(c->corner[leader].point - p);
    if (way.x == 0 && way.y == 0) break;
  }
  return least_m;
}

bool Gather(Group* g, const Crowd& c, Formation* f) {
  Vec2 way;
  for (int k = 0; k < g->size; ++k) {
    const size_t i = f->person[k] = static_cast<size_t>(g->member[k]);
    if (!Walks(c, i) || (f->count > 0 && c.field[i] != c.field[f->person[f->who[0]]])) continue;
    f->who[f->count++] = k;
    f->center = f->center + c.position[i];
    way = way + c.way[i];
  }
  if (f->count < 2) return false;
  const float share = 1 / static_cast<float>(f->count);
  f->center = f->center * share;
  const Vec2 ahead =
      Unit(g->ahead.x == 0 && g->ahead.y == 0 ? way : g->ahead + (way * share - g->ahead) * kTurnsWithWay);
  if (ahead.x == 0 && ahead.y == 0) return false;
  f->ahead = g->ahead = ahead;
  f->left = {-ahead.y, ahead.x};
  return true;
}

void SortBy(Vec2 axis, int first, int end, const Crowd& c, Formation* f) {
  const auto along_m = [&](int k) { return Dot(c.position[f->person[f->who[k]]], axis); };
  for (int k = first + 1; k < end; ++k) {
    for (int j = k; j > first && along_m(j) > along_m(j - 1); --j) std::swap(f->who[j], f->who[j - 1]);
  }
}

float Radius_m(const Crowd& c, const Formation& f, int k) { return c.radius_m[f.person[f.who[k]]]; }

// Places of one row, side by side about its middle, the leftmost first.
void PlaceRow(const Crowd& c, int first, int end, float along_m, float room_m, float most_elbow_m, Formation* f) {
  float bodies_m = 0;
  for (int k = first; k + 1 < end; ++k) bodies_m += Radius_m(c, *f, k) + Radius_m(c, *f, k + 1);
  const float gaps = static_cast<float>(std::max(1, end - first - 1));
  const float elbow_m = std::clamp((room_m - bodies_m) / gaps, kMinElbowRoom_m, most_elbow_m);
  float across_m = 0.5f * (bodies_m + elbow_m * static_cast<float>(end - first - 1));
  for (int k = first; k < end; ++k) {
    const bool inner = k > first && k + 1 < end;
    f->place[k] = {along_m - (inner ? kInnerBack_m : 0), across_m};
    if (k + 1 < end) across_m -= Radius_m(c, *f, k) + Radius_m(c, *f, k + 1) + elbow_m;
  }
}

// How many walk in a row; one more than now only where there is room to spare.
int Abreast(const Crowd& c, const Formation& f, float room_m, int now) {
  const float need_m = 2 * Radius_m(c, f, 0) + kElbowRoom_m;
  const auto fit = [&](float room) {
    return std::clamp(1 + static_cast<int>(std::max(0.0f, room) / need_m), 1, f.count);
  };
  const int most = fit(room_m);
  return now > 0 && most > now ? std::max(now, fit(room_m - kWider_m)) : most;
}

// One of two is a little ahead, always the same one.
void Stagger(int number, Formation* f) {
  const float share = OwnShare(number, 1), first = OwnShare(number, 2) < 0.5f ? 0.5f : -0.5f;
  for (int k = 0; k < 2; ++k) f->place[k].x += (f->who[k] == 0 ? first : -first) * kStagger_m * share * share;
}

void Arrange(const Crowd& c, const Group& g, Formation* f) {
  const bool pair = g.size == 2;
  const int number = c.id[static_cast<size_t>(g.member[0])];
  const float share = pair ? OwnShare(number, 3) : 0;
  const float elbow_m = pair ? kPairElbowRoom_m[0] + (kPairElbowRoom_m[1] - kPairElbowRoom_m[0]) * share : kElbowRoom_m;
  SortBy(f->ahead, 0, f->count, c, f);
  Vec2 mean;
  for (int first = 0, row = 0; first < f->count; first += g.abreast, ++row) {
    const int end = std::min(f->count, first + g.abreast);
    SortBy(f->left, first, end, c, f);
    PlaceRow(c, first, end, -kRowGap_m * static_cast<float>(row), g.room_m, elbow_m, f);
    for (int k = first; k < end; ++k) mean = mean + f->place[k];
  }
  mean = mean * (1 / static_cast<float>(f->count));
  for (int k = 0; k < f->count; ++k) f->place[k] = f->place[k] - mean;
  if (pair && g.abreast == 2) Stagger(number, f);
}

// Away from walls that stand where somebody should walk.
void KeepPlacesFree(const Walkable& w, Formation* f) {
  float leftmost_m = 0, rightmost_m = 0;
  for (int k = 0; k < f->count; ++k) {
    leftmost_m = std::max(leftmost_m, f->place[k].y);
    rightmost_m = std::min(rightmost_m, f->place[k].y);
  }
  if (!IsFree(w, f->center)) return;
  const float off_left_m = std::max(0.0f, leftmost_m - Room_m(w, f->center, f->left));
  const float off_right_m = std::max(0.0f, -rightmost_m - Room_m(w, f->center, f->left * -1));
  for (int k = 0; k < f->count; ++k) f->place[k].y += off_right_m - off_left_m;
}

// What takes the person of place k there.
void Ask(const Walkable& w, const Crowd& c, const Formation& f, int k, Group* g) {
  const size_t i = f.person[f.who[k]];
  const Vec2 p = c.position[i], place = f.center + f.ahead * f.place[k].x + f.left * f.place[k].y;
  const float to_goal_m = Length(c.fields[static_cast<size_t>(c.field[i])].goal - p);
  const float share = std::clamp((to_goal_m - kGoalOwn_m) / kGoalFades_m, 0.0f, 1.0f);
  const float behind_m = Dot(place - p, f.ahead), aside_m = Dot(place - p, f.left);
  g->pace[f.who[k]] = 1 + share * (std::clamp(1 + kCatchUp_pm * behind_m, kMinPace, kMaxPace) - 1);
  if (!IsFree(w, place) || !IsFree(w, (p + place) * 0.5f)) return;  // round a corner
  const float aside_mps = std::clamp(kAside_ps * aside_m, -kMaxAside_mps, kMaxAside_mps);
  g->push[f.who[k]] = f.left * (share * aside_mps / kRelaxation_s);
}

void Plan(const Walkable& w, bool look, Group* g, Crowd* c) {
  std::fill(g->pace, g->pace + kMaxGroupSize, 0.0f);
  std::fill(g->push, g->push + kMaxGroupSize, Vec2{});
  Formation f;
  if (!Gather(g, *c, &f)) return;
  if (look || g->abreast == 0) {
    g->room_m = RoomAhead_m(w, f, c);
    g->abreast = Abreast(*c, f, g->room_m, g->abreast);
  }
  Arrange(*c, *g, &f);
  KeepPlacesFree(w, &f);
  for (int k = 0; k < f.count; ++k) Ask(w, *c, f, k, g);
}

void WalkTogether(const Walkable& w, size_t which, Crowd* c) {
  Group& g = c->groups[which];
  for (int k = 0; k < g.size; ++k) {
    const size_t i = static_cast<size_t>(g.member[k]);
    if (!c->turn[i]) continue;
    const int64_t turn = c->step / kTurnEvery_steps + static_cast<int64_t>(which);
    if (k == 0) Plan(w, turn % kLookEvery_turns == 0, &g, c);
    if (g.pace[k] <= 0 || !Walks(*c, i)) continue;
    c->mind[i].asked_mps *= g.pace[k];
    c->mind[i].push = c->mind[i].push + g.push[k];
  }
}

void Drop(int which, Crowd* c) {
  const size_t g = static_cast<size_t>(which);
  c->groups[g] = c->groups.back();
  c->groups.pop_back();
  if (g == c->groups.size()) return;
  for (int k = 0; k < c->groups[g].size; ++k) c->group[static_cast<size_t>(c->groups[g].member[k])] = which;
}

}  // namespace

void AddGroup(const std::vector<int>& members, Crowd* c) {
  Group g;
  float slowest_mps = 1e9f;
  for (int i : members) {
    g.member[g.size++] = i;
    c->group[static_cast<size_t>(i)] = static_cast<int>(c->groups.size());
    slowest_mps = std::min(slowest_mps, c->preferred_mps[static_cast<size_t>(i)]);
  }
  for (int i : members) c->preferred_mps[static_cast<size_t>(i)] = slowest_mps;
  c->groups.push_back(g);
}

void LeaveGroup(size_t index, Crowd* c) {
  const int which = c->group[index];
  if (which < 0) return;
  Group& g = c->groups[static_cast<size_t>(which)];
  g.size = static_cast<int>(std::remove(g.member, g.member + g.size, static_cast<int>(index)) - g.member);
  std::fill(g.pace, g.pace + kMaxGroupSize, 0.0f);
  c->group[index] = -1;
  if (g.size > 1) return;
  c->group[static_cast<size_t>(g.member[0])] = -1;
  Drop(which, c);
}

void WalkTogether(const Walkable& w, Jobs* jobs, Crowd* c) {
  InBlocks(jobs, c->groups.size(), kFewPeople / kMaxGroupSize, [&](size_t first, size_t end) {
    for (size_t which = first; which < end; ++which) WalkTogether(w, which, c);
  });
}

}  // namespace flaneur
