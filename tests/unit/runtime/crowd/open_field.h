// The open field that crowds are compared on: 0.3 people to the square metre, 36 round obstacles of 1 to 2 m radius,
// everybody on the way from place to place. Shared by tests and benchmarks.
#pragma once
#include <cmath>
#include <vector>

#include "runtime/base/random.h"
#include "runtime/crowd/crowd.h"

namespace flaneur {

inline constexpr float kOpenFieldStep_s = 1.0f / 30;

struct OpenField {
  Walkable walkable;
  Crowd crowd;
  CrowdScratch scratch;
  std::vector<Vec2> places;
  std::vector<int> fields;  // of the places
  Random random{1};
  float side_m = 0, turn_round_m = 0;
};

inline int SomePlace(OpenField* f) {
  return f->fields[static_cast<size_t>(f->random.Below(static_cast<int>(f->fields.size())))];
}

// Everybody visible, nobody touching anybody. places_aside^2 places people go to, spread evenly.
inline OpenField MakeOpenField(int people, int places_aside = 8, uint64_t seed = 1, float density_pm2 = 0.3f) {
  OpenField f;
  f.random.state = static_cast<decltype(f.random.state)>(seed);
  f.side_m = std::sqrt(static_cast<float>(people) / density_pm2);
  const int cells = static_cast<int>(std::ceil(f.side_m));
  const size_t all = static_cast<size_t>(cells) * static_cast<size_t>(cells);
  f.walkable.ground = Share({{0, 0}, 1, cells, cells, std::vector<float>(all, 0), std::vector<uint8_t>(all, 3)});
  for (int k = 0; k < 36; ++k) {
    f.walkable.circles.push_back(
        {{f.random.Uniform(0, f.side_m), f.random.Uniform(0, f.side_m)}, f.random.Uniform(1, 2)});
  }
  BuildWalkable(0.3f, &f.walkable, 0.25f);
  f.turn_round_m = 0.12f * f.side_m / static_cast<float>(places_aside);
  for (int k = 0; k < places_aside * places_aside; ++k) {
    const float pitch_m = f.side_m / static_cast<float>(places_aside);
    const Vec2 near{(static_cast<float>(k % places_aside) + 0.5f) * pitch_m,
                    (static_cast<float>(k / places_aside) + 0.5f) * pitch_m};
    const int cell = NearestFreeCell(f.walkable, near, 3);
    if (cell < 0) continue;
    f.places.push_back(CellCenter(f.walkable, cell));
    f.fields.push_back(FieldFor(f.places.back(), &f.crowd));
  }
  // One person to a square of the lattice keeps starting linear in people.
  const int aside = static_cast<int>(f.side_m / 0.6f);
  std::vector<char> taken(static_cast<size_t>(aside) * static_cast<size_t>(aside), 0);
  while (static_cast<int>(f.crowd.size()) < people) {
    const size_t square = static_cast<size_t>(f.random.Below(aside * aside));
    Person p;
    p.position = {(static_cast<float>(static_cast<int>(square) % aside) + 0.5f) * 0.6f,
                  (static_cast<float>(static_cast<int>(square) / aside) + 0.5f) * 0.6f};
    if (taken[square] || !IsFree(f.walkable, p.position)) continue;
    taken[square] = 1;
    p.preferred_mps = f.random.Uniform(1.1f, 1.5f);
    p.field = SomePlace(&f);
    const Vec2 way = f.crowd.fields[static_cast<size_t>(p.field)].goal - p.position;
    p.heading_rad = std::atan2(way.y, way.x);
    AddPerson(p, &f.crowd);
    f.crowd.view.back() = ViewClass::kVisible;
  }
  return f;
}

// Who comes near a place goes on to another, so that the field stays evenly full.
inline void StepOpenField(OpenField* f, Jobs* jobs = nullptr) {
  Crowd& c = f->crowd;
  StepCrowd(f->walkable, {}, kOpenFieldStep_s, &f->scratch, &c, jobs);
  for (size_t i = 0; i < c.size(); ++i) {
    const Vec2 left = c.fields[static_cast<size_t>(c.field[i])].goal - c.position[i];
    if (c.arrived[i] == Arrival::kThere || Dot(left, left) < f->turn_round_m * f->turn_round_m)
      SetGoal(i, SomePlace(f), &c);
  }
}

}  // namespace flaneur
