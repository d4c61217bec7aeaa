// Rooms full of people with one door, drawn at random: whether everybody gets out. Shared by tests and benchmarks.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "runtime/base/random.h"
#include "runtime/crowd/constants.h"
#include "runtime/crowd/crowd.h"

namespace flaneur {

inline constexpr float kRoomStep_s = 1.0f / 30, kRoomGround_m = 72;

struct RoomPlan {
  float width_m = 12, depth_m = 12, wall_m = 0.2f;
  float door_m = 1, door_at_m = 0;  // its width, and its middle along the wall from the wall's own
  float turned_rad = 0;             // the whole room
  std::vector<float> radius_m;      // of the people
  std::vector<CircleObstacle> pillars;
  bool own_goals = false;  // else all have the same
  uint64_t seed = 1;
};

struct Room {
  Walkable walkable;
  Crowd crowd;
  CrowdScratch scratch;
};

inline float LargestOf(const RoomPlan& plan) { return *std::max_element(plan.radius_m.begin(), plan.radius_m.end()); }

// The door is in the wall at x = 0; the room lies before it, at negative x.
inline Room MakeRoom(const RoomPlan& plan) {
  Room room;
  const Vec2 ahead{std::cos(plan.turned_rad), std::sin(plan.turned_rad)}, left{-ahead.y, ahead.x};
  const auto at = [&](float x, float y) { return ahead * x + left * y; };
  const auto box = [&](float x0, float y0, float x1, float y1) {
    room.walkable.polygons.push_back({{at(x0, y0), at(x1, y0), at(x1, y1), at(x0, y1)}, {}});
  };
  const float half_m = 0.5f * plan.width_m, door0_m = plan.door_at_m - 0.5f * plan.door_m,
              door1_m = plan.door_at_m + 0.5f * plan.door_m, wall_m = plan.wall_m;
  const int cells = static_cast<int>(2 * kRoomGround_m);
  const size_t all = static_cast<size_t>(cells) * static_cast<size_t>(cells);
  room.walkable.ground = Share({{-kRoomGround_m / 2, -kRoomGround_m / 2},
                                0.5f,
                                cells,
                                cells,
                                std::vector<float>(all, 0),
                                std::vector<uint8_t>(all, 3)});
  box(0, -half_m - wall_m, wall_m, door0_m);
  box(0, door1_m, wall_m, half_m + wall_m);
  box(-plan.depth_m - wall_m, -half_m - wall_m, -plan.depth_m, half_m + wall_m);
  box(-plan.depth_m, -half_m - wall_m, 0, -half_m);
  box(-plan.depth_m, half_m, 0, half_m + wall_m);
  for (const CircleObstacle& p : plan.pillars)
    room.walkable.circles.push_back({at(p.center.x, p.center.y), p.radius_m});
  const float largest_m = LargestOf(plan);
  BuildWalkable(largest_m + kByChoice_m, &room.walkable, largest_m);
  Random random{plan.seed};
  for (const float radius_m : plan.radius_m) {
    for (int attempt = 0; attempt < 2000; ++attempt) {
      Person p;
      const float off_m = radius_m + 0.01f;
      p.position = at(random.Uniform(-plan.depth_m + off_m, -off_m), random.Uniform(-half_m + off_m, half_m - off_m));
      const auto touches = [&](Vec2 other, float other_m) { return Length(p.position - other) < other_m + off_m; };
      bool free = true;
      for (size_t j = 0; j < room.crowd.size(); ++j)
        free = free && !touches(room.crowd.position[j], room.crowd.radius_m[j]);
      for (const CircleObstacle& c : room.walkable.circles) free = free && !touches(c.center, c.radius_m);
      if (!free) continue;
      p.radius_m = radius_m;
      p.preferred_mps = random.Uniform(0.9f, 1.6f);
      const float beyond_m = plan.own_goals ? random.Uniform(3, 9) : 6.0f;
      p.field = FieldFor(at(beyond_m, plan.door_at_m + (plan.own_goals ? random.Uniform(-5, 5) : 1.0f)), &room.crowd);
      p.heading_rad = random.Uniform(-3, 3);
      AddPerson(p, &room.crowd);
      room.crowd.view.back() = ViewClass::kVisible;
      break;
    }
  }
  return room;
}

// Radii 0.2 to 0.5 m, alike or mixed; the door from 1.05 to 2.5 times as wide as the largest.
inline RoomPlan RandomRoom(uint64_t seed, int people = 100) {
  Random random{seed * 7919 + 13};
  RoomPlan plan;
  plan.seed = seed;
  const bool mixed = random.Uniform() < 0.3f, tight = random.Uniform() < 0.5f;
  const float radius_m = random.Uniform(0.2f, 0.5f);
  float bodies_m2 = 0;
  for (int k = 0; k < people; ++k) {
    plan.radius_m.push_back(mixed ? random.Uniform(0.2f, 0.5f) : radius_m);
    bodies_m2 += kPi * plan.radius_m.back() * plan.radius_m.back();
  }
  const float area_m2 = bodies_m2 / random.Uniform(0.12f, 0.4f), shape = random.Uniform(0.6f, 1.6f);
  plan.width_m = std::sqrt(area_m2 * shape), plan.depth_m = area_m2 / plan.width_m;
  plan.wall_m = random.Uniform(0.1f, 0.6f);
  plan.door_m = 2 * LargestOf(plan) * random.Uniform(1.05f, tight ? 1.25f : 2.5f);
  const float most_m = 0.5f * (plan.width_m - plan.door_m);
  plan.door_at_m = random.Uniform(-most_m, most_m);
  if (random.Uniform() < 0.6f) plan.turned_rad = random.Uniform(-kPi, kPi);
  for (int k = random.Below(4); k > 0; --k) {  // far enough from walls and each other to be passed
    const CircleObstacle c{{random.Uniform(-plan.depth_m, 0), random.Uniform(-0.5f, 0.5f) * plan.width_m},
                           random.Uniform(0.2f, 0.6f)};
    const float room_m = 2 * LargestOf(plan) + 0.5f + c.radius_m;
    bool fits = -c.center.x > room_m && plan.depth_m + c.center.x > room_m &&
                0.5f * plan.width_m - std::abs(c.center.y) > room_m;
    for (const CircleObstacle& other : plan.pillars)
      fits = fits && Length(c.center - other.center) > room_m + other.radius_m;
    if (fits) plan.pillars.push_back(c);
  }
  plan.own_goals = random.Uniform() < 0.3f;
  return plan;
}

inline std::string Described(const RoomPlan& plan) {
  char text[160];
  std::snprintf(
      text, sizeof text, "room %d: door of %.2f m (%.2f bodies), radius up to %.2f m, %.1f x %.1f m, turned %.2f",
      static_cast<int>(plan.seed), static_cast<double>(plan.door_m),
      static_cast<double>(plan.door_m / (2 * LargestOf(plan))), static_cast<double>(LargestOf(plan)),
      static_cast<double>(plan.width_m), static_cast<double>(plan.depth_m), static_cast<double>(plan.turned_rad));
  return text;
}

struct RoomOutcome {
  int people = 0, left = 0;  // left inside at the end
  float empty_s = 0;         // when the last one arrived, or the time given
  float longest_s = 0;       // for which nobody arrived
};

inline RoomOutcome EmptyRoom(Room* room, float most_s) {
  Crowd& c = room->crowd;
  RoomOutcome o;
  o.people = static_cast<int>(c.size());
  float last_s = 0;
  for (int step = 0; c.size() > 0 && o.empty_s < most_s; ++step) {
    StepCrowd(room->walkable, {}, kRoomStep_s, &room->scratch, &c);
    o.empty_s = static_cast<float>(step + 1) * kRoomStep_s;
    const size_t before = c.size();
    for (size_t i = c.size(); i-- > 0;) {
      if (c.arrived[i] == Arrival::kThere) RemovePerson(i, &c);
    }
    if (c.size() < before) last_s = o.empty_s;
    o.longest_s = std::max(o.longest_s, o.empty_s - last_s);
  }
  o.left = static_cast<int>(c.size());
  return o;
}

}  // namespace flaneur
