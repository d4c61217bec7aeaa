// A town for tests of the guided tour: a square, a lane through a wall, houses and a yard. 60 m x 40 m.
#pragma once
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "runtime/simulation/simulation.h"
#include "tests/unit/runtime/simulation/box_obstacle.h"

namespace flaneur {

inline PackAvatar Figure(const char* name, float share) {
  PackAvatar avatar;
  avatar.name = name;
  avatar.share = share;
  avatar.levels = {{0, 9000, 0, 0, 200}, {0, 2000, 0, 0, 0}};
  avatar.impostor.texel_m = 0.014f;
  return avatar;
}

inline TourStop Halt(Vec2 position, float yaw_rad, float pause_s) {
  TourStop stop;
  stop.position_m = position;
  stop.yaw_rad = yaw_rad;
  stop.pause_s = pause_s;
  stop.caption = "Something to see.";
  return stop;
}

inline TourStop Waypoint(Vec2 position) {
  TourStop stop;
  stop.position_m = position;
  return stop;
}

// The tour leads over the square, through the lane of 3 m and round a house. A wall runs across the town at x = 30.
inline TourPack TourTown(int people) {
  TourPack pack;
  pack.ground = Share({{0, 0}, 0.5f, 120, 80, std::vector<float>(9600, 0), std::vector<uint8_t>(9600, 3)});
  pack.obstacles.polygons = {Box({29, 0}, {31, 18}), Box({29, 21}, {31, 40}), Box({12, 12}, {18, 18}),
                             Box({42, 14}, {48, 26})};
  pack.avatars = {Figure("maid", 1), Figure("monk", 0)};
  pack.places = {{"west", "exit", {1, 20}, 2},
                 {"east", "exit", {59, 20}, 2},
                 {"well", "goal", {22, 8}, 1},
                 {"tree", "goal", {52, 32}, 1}};
  pack.path = {Waypoint({4, 6}),        Halt({20, 6}, kPi / 2, 3), Waypoint({24, 19.5f}),
               Halt({36, 19.5f}, 0, 3), Waypoint({45, 30}),        Halt({54, 12}, kPi, 3)};
  pack.guide = "monk";
  pack.crowd.people = people;
  pack.crowd.seed = 5;
  return pack;
}

inline Simulation Started(const TourPack& pack) {
  Simulation s;
  const Error e = StartSimulation(&pack, ScenarioOf(pack), &s);
  EXPECT_FALSE(e) << e.message;
  return s;
}

}  // namespace flaneur
