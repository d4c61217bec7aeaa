// Moving beside walls and trees without ever entering them.
#pragma once
#include "runtime/crowd/walkable.h"

namespace flaneur {

Vec2 NearestOnSegment(Vec2 p, Vec2 a, Vec2 b);

// From p, in or next to `cell`, to the nearest wall or tree; 1e9 where none is near. Not negative inside polygons.
float Clearance(const Walkable& w, int cell, Vec2 p);

// The point near p that is radius_m from the walls and trees near the cell, if a few pushes find one.
Vec2 PushedOff(const Walkable& w, int cell, Vec2 p, float radius_m);

// What may push people in one cell, for many questions about it: four edges are looked at at a time.
class NearEdges {
 public:
  // Before anything else; w stays as it is meanwhile.
  void LookAt(const Walkable& w, int cell);
  Vec2 PushedOff(Vec2 p, float radius_m) const;  // the same place as above, bit for bit

 private:
  using Lanes = float __attribute__((vector_size(16)));
  struct Four {
    Lanes ax = Lanes{} + 1e6f, ay = ax, along_x{}, along_y{}, per_length2{};
    const Walkable::Edge* edges[4] = {};
  };
  static bool Reaches(const Four& four, Vec2 p, float reach_m2);
  const Walkable* w_ = nullptr;
  int cell_ = -1;
  std::vector<Four> fours_;
};

// From the nearest wall or tree near the cell to p; zero where none is.
Vec2 AwayFromNearest(const Walkable& w, int cell, Vec2 p);

// Something stops people within reach_m of p on one side and within reach_m on the other.
bool HasWallsOnEitherSide(const Walkable& w, int cell, Vec2 p, float reach_m);

// From every point of the cell (-1: off the ground) at least so far to anything that stops people; 0 where that isn't
// known.
inline float ClearAround_m(const Walkable& w, int cell) {
  return cell >= 0 ? 0.01f * static_cast<float>(w.cells[static_cast<size_t>(cell)].clear_cm) : 0.0f;
}

// Where a step from `from` towards `to` ends: along walls where they are in the way, never nearer to one than radius_m
// (or than `from` is, for somebody who starts closer), never off the ground, and never farther from `from` than `to`
// is.
Vec2 KeepOffWalls(const Walkable& w, Vec2 from, Vec2 to, float radius_m);

// How far somebody of this radius gets from p along the unit vector `out`, at most most_m.
float RoomAlong_m(const Walkable& w, Vec2 p, Vec2 out, float radius_m, float most_m);

// For somebody who stands at a wall and wishes to walk along the unit vector `way`, into it: along the wall to where
// they fit through, where a door is as near as that; else `way`.
Vec2 AlongToDoor(const Walkable& w, Vec2 p, float radius_m, Vec2 way);

// Sum of gentle pushes away from walls within kWallComfort_m beyond touching, metres per second squared.
Vec2 WallPush(const Walkable& w, Vec2 p, float radius_m);

}  // namespace flaneur
