// The way to one destination from everywhere: travel costs over the navigation grid, shared by all who go there.
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "runtime/crowd/walkable.h"

namespace flaneur {

// Of a metre there, whichever way one walks; 0 where nobody can.
float CostOfGround(const Walkable& w, int cell);

// Directions lie in tiles of 8 x 8 cells, one to a cache line, and those in squares of 64 x 64 cells, one to a page of
// memory: whoever walks on, or comes next to here, finds them there.
struct alignas(64) DirectionTile {
  uint8_t direction[64];
};

struct FlowField {
  Vec2 goal;
  std::vector<DirectionTile>
      tiles;          // of the best way, in 1/255 turns anticlockwise from +x; 255: none. Empty until built
  int questions = 0;  // asked for ways before it was built
  int deserted = 0;   // looks in a row at which nobody was on the way there
};

// Index of the direction of the cell at column x and row y, over all tiles: what the row gives and what the column
// gives.
inline size_t DirectionRow(const Walkable& w, int y) {
  const int squares = (y >> 6) * ((w.columns + 63) >> 6);
  return static_cast<size_t>(squares * 4096 + (y >> 3 & 7) * 512 + (y & 7) * 8);
}
inline size_t DirectionColumn(int x) { return static_cast<size_t>((x >> 6) * 4096 + (x >> 3 & 7) * 64 + (x & 7)); }
inline size_t DirectionIndex(const Walkable& w, int x, int y) { return DirectionRow(w, y) + DirectionColumn(x); }
inline const uint8_t& DirectionAt(const FlowField& field, size_t index) {
  return field.tiles[index >> 6].direction[index & 63];
}

inline bool IsBuilt(const FlowField& field) { return !field.tiles.empty(); }

// Solves |grad T| = cost by fast marching (Sethian 1996), exact around the goal. Slopes cost more (constants.h). The
// goal's nearest free cell within 3 m is the destination.
FlowField BuildFlowField(const Walkable& w, Vec2 goal);

// The same in slices. A slice goes over at most so many cells; the field is the same whatever they are.
struct FieldBuild {
  FlowField field;
  std::vector<float> distance;  // weighted metres by cell; infinity where there is no way
  std::vector<std::pair<float, int>>
      open;            // heap, least first: distances from which the march goes on, and their cells
  int described = -1;  // cells that have their direction; -1: the march has not begun
};
// What all slices together go over at most, whatever the goal.
int64_t CellsToGoOver(const Walkable& w);
// True: the field is done.
bool BuildFurther(const Walkable& w, int64_t cells, FieldBuild* build);

// By connected areas: costs nothing, also for a field that isn't built yet.
bool Reachable(const Walkable& w, const FlowField& field, Vec2 from);

// Unit vector along the best way, zero where there is none. The field must be built.
Vec2 WayAt(const Walkable& w, const FlowField& field, Vec2 p);

// The same at the nearest cell, for those whom nobody sees: one look into memory instead of four.
Vec2 RoughWayAt(const Walkable& w, const FlowField& field, Vec2 p);

// True where one can walk straight from p to q over ground that is nowhere costlier than at p.
bool StraightWay(const Walkable& w, Vec2 p, Vec2 q);

}  // namespace flaneur
