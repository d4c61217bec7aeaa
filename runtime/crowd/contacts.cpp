#include "runtime/crowd/contacts.h"

#include <algorithm>
#include <cmath>

#include "runtime/crowd/constants.h"
#include "runtime/crowd/fast_math.h"
#include "runtime/crowd/walls.h"

namespace flaneur {
namespace {

constexpr float kAheadOf = 0.5f;  // cosine from the way to who is walked into
constexpr float kStepsBack_mps = 0.1f;
constexpr size_t kMaxContacts = 6;  // pairs a person: as many as fit around

// How near to the disc's middle somebody may come in this step.
float Least_m(const MovingObstacle& m, Vec2 from, float radius_m) {
  return std::min(m.radius_m + radius_m, Length(from - m.center));
}

// Nobody walks into a disc that is for everyone: a step that would goes along its rim or not at all.
Vec2 KeepOut(const std::vector<MovingObstacle>& moving, Vec2 from, Vec2 to, float radius_m) {
  bool turned = false;
  for (const MovingObstacle& m : moving) {
    const Vec2 off = to - m.center;
    const float after2 = Dot(off, off), reach_m = m.radius_m + radius_m;
    if (!m.everyone || after2 >= reach_m * reach_m) continue;
    const float least_m = Least_m(m, from, radius_m);
    const float after_m = std::sqrt(after2);
    if (after_m >= least_m || after_m < 1e-5f) continue;
    const Vec2 rim = m.center + off * (least_m / after_m);
    const Vec2 along = from + ClampLength(rim - from, Length(to - from));
    to = Length(along - m.center) >= least_m - 1e-4f ? along : from;
    turned = true;
  }
  const auto is_in = [&](const MovingObstacle& m) {  // along the rim of another
    return m.everyone && Length(to - m.center) < Least_m(m, from, radius_m) - 1e-4f;
  };
  return turned && std::any_of(moving.begin(), moving.end(), is_in) ? from : to;
}

// They walk, and towards there.
bool WalksTowards(const Crowd& c, size_t i, Vec2 direction) {
  return c.activity[i] == Activity::kWalking && c.field[i] >= 0 && Dot(c.way[i], direction) > kAheadOf;
}

bool Works(const Crowd& c, size_t i) { return c.activity[i] == Activity::kWorking; }

// Of the correction of two who would touch, i's share; `normal` points from j to i. Who works gives nothing but to
// those who would be held up for long. Who walks into the back of somebody who is held up takes all of it, as long as
// they only step back: else the many behind press those before a door into an arch that nobody leaves.
float ShareOf(const Crowd& c, const std::vector<Vec2>& moved, float step_s, size_t i, size_t j, Vec2 normal) {
  if (Works(c, i) != Works(c, j)) {
    const float insists = 0.5f * IsHeldUp(c.mind[Works(c, i) ? j : i]);
    return Works(c, i) ? insists : 1 - insists;
  }
  const bool i_follows = WalksTowards(c, i, normal * -1), j_follows = WalksTowards(c, j, normal);
  if (i_follows == j_follows) return 0.5f;
  const size_t follows = i_follows ? i : j, held_up = i_follows ? j : i;
  if (Dot(moved[follows] - c.position[follows], c.way[follows]) < -kStepsBack_mps * step_s) return 0.5f;
  const float spared = 0.5f * IsHeldUp(c.mind[held_up]);
  return i_follows ? 0.5f + spared : 0.5f - spared;
}

// Everybody with who comes later in the row of cells, and with the three cells of the next row.
void FindContacts(const NeighbourGrid& g, int first_row, int end_row, float margin_m,
                  std::vector<std::pair<int, int>>* contacts) {
  const auto test = [&](const Neighbour& a, int first, int end) {
    for (int k = first; k < end; ++k) {
      const Neighbour& b = g.people[static_cast<size_t>(k)];
      const Vec2 apart = a.position - b.position;
      const float reach_m = a.radius_m + b.radius_m + margin_m;
      if (Dot(apart, apart) < reach_m * reach_m) contacts->push_back({a.person, b.person});
    }
  };
  for (int y = first_row; y < end_row; ++y) {
    const int* row = &g.start[static_cast<size_t>(y * g.columns)];
    const int* next = y + 1 < g.rows ? row + g.columns : nullptr;
    for (int x = 0; x < g.columns; ++x) {
      const int before = std::max(x - 1, 0), after = std::min(x + 2, g.columns);
      for (int k = row[x]; k < row[x + 1]; ++k) {
        const Neighbour a = g.people[static_cast<size_t>(k)];  // a copy: the list that grows cannot change it
        test(a, k + 1, row[after]);
        if (next) test(a, next[before], next[after]);
      }
    }
  }
}

}  // namespace

Vec2 WalkTowards(const Walkable& w, const std::vector<MovingObstacle>& moving, float step_s, const Crowd& c, size_t i,
                 Vec2 to) {
  const Vec2 from = c.position[i];
  const Vec2 step = ClampLength(to - from, c.top_mps[i] * step_s);
  const Vec2 off_walls = KeepOffWalls(w, from, from + step, c.radius_m[i]);
  const Vec2 out = KeepOut(moving, from, off_walls, c.radius_m[i]);
  const bool turned = out.x != off_walls.x || out.y != off_walls.y;
  return turned ? KeepOut(moving, from, KeepOffWalls(w, from, out, c.radius_m[i]), c.radius_m[i]) : out;
}

void FindContacts(const Crowd& c, float step_s, Jobs* jobs, CrowdScratch* s) {
  s->contacts.clear();
  s->contacts.reserve(kMaxContacts * c.size());
  float most_mps = 0;
  for (int i : s->caring) most_mps = std::max(most_mps, c.top_mps[static_cast<size_t>(i)]);
  const float margin_m = 2 * most_mps * step_s + kContactMargin_m;
  const NeighbourGrid& g = s->neighbours;
  const size_t blocks = BlocksFor(jobs, s->caring.size(), kFewPeople);
  if (blocks == 1) return FindContacts(g, 0, g.rows, margin_m, &s->contacts);
  s->contacts_of_block.resize(blocks);
  const auto row = [&](size_t block) { return static_cast<int>(static_cast<size_t>(g.rows) * block / blocks); };
  ParallelFor(jobs, blocks, [&](size_t b) {
    s->contacts_of_block[b].clear();
    FindContacts(g, row(b), row(b + 1), margin_m, &s->contacts_of_block[b]);
  });
  for (const auto& some : s->contacts_of_block) s->contacts.insert(s->contacts.end(), some.begin(), some.end());
}

void ResolveContacts(const Walkable& w, const std::vector<MovingObstacle>& moving, float step_s, const Crowd& c,
                     CrowdScratch* s) {
  s->pushed_in.assign(c.size(), 0);
  for (uint8_t pass = 1; pass <= kContactPasses; ++pass) {
    bool any = false;
    for (const auto& [a, b] : s->contacts) {
      const size_t i = static_cast<size_t>(a), j = static_cast<size_t>(b);
      if (std::max(s->pushed_in[i], s->pushed_in[j]) + 1 < pass)
        continue;  // neither was moved since they were last looked at
      const Vec2 apart = s->moved[i] - s->moved[j];
      const float reach_m = c.radius_m[i] + c.radius_m[j], distance2 = Dot(apart, apart);
      if (distance2 >= reach_m * reach_m) continue;
      any = true;
      s->pushed_in[i] = s->pushed_in[j] = pass;
      const float distance_m = std::sqrt(distance2);
      const Vec2 normal = distance_m > 1e-5f ? apart * (1 / distance_m) : Vec2{1, 0};
      const Vec2 whole = normal * (reach_m - distance_m + 2e-4f);
      const float share = ShareOf(c, s->moved, step_s, i, j, normal);
      // Who gives more goes first: what one cannot give, the other does.
      const bool j_first = share < 0.5f;
      const size_t first = j_first ? j : i, other = j_first ? i : j;
      const Vec2 first_gives = whole * (j_first ? share - 1 : share);
      const Vec2 before = s->moved[first];
      s->moved[first] = WalkTowards(w, moving, step_s, c, first, before + first_gives);
      const Vec2 given = s->moved[first] - before, rest = j_first ? whole + given : given - whole;
      // The walker tries again, along the wall that is in the way.
      if ((share == 0 || share == 1) && Works(c, other) && pass <= kContactPasses / 2) continue;
      s->moved[other] = WalkTowards(w, moving, step_s, c, other, s->moved[other] + rest);
    }
    if (!any) return;
  }
}

}  // namespace flaneur
