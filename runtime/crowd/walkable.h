// Where people can walk: obstacles as shapes, the ground as a grid of heights and costs.
#pragma once
#include <cstdint>
#include <vector>

#include "runtime/base/math.h"
#include "runtime/tour_data/tour_data.h"

namespace flaneur {

struct Walkable : Obstacles {
  SharedGround ground = Share({});

  // Derived by BuildWalkable: a navigation grid whose cells are free where a person of person_radius_m fits.
  float person_radius_m = 0.3f;
  Vec2 min_m;
  float cell_m = 0.5f, cells_per_m = 2;
  int columns = 0, rows = 0;
  std::vector<float> cost;     // a metre; 0: not walkable
  float least_cost = 1;        // of all that are walkable
  std::vector<int> component;  // connected free cells share a number; -1: not free
  // What walkers ask of the cell they are in, kept small: people all over a town read it in every step.
  struct Cell {
    uint8_t clear_cm = 0;  // from every point of the cell at least so far to anything that stops people
    uint8_t same = 0;      // so many cells around, in rows and columns, are level and cost the same as this one
    uint8_t slope = 0;     // rise over run in units of kSlopeUnit, not negative
    uint8_t open = 0;      // of the disc that density is measured in, the share that is ground, in 1/255
  };
  static constexpr float kSlopeUnit = 0.6f / 255;
  std::vector<Cell> cells;
  struct Edge {
    Vec2 a, b;
  };
  std::vector<Edge> edges;  // of all polygons
  struct Box {
    Vec2 low, high;
  };
  std::vector<Box> polygon_boxes;  // about their outer rings
  // What a person in a cell, or stepping out of it, can touch: ranges [start[cell], start[cell + 1]) of the lists.
  std::vector<int> wall_start, wall_edges;
  std::vector<int> circle_start, wall_circles;
};

// Fills the derived members. Free cells: ground of a kind, farther than person_radius_m from every obstacle.
// most_radius_m: of the largest person there will be.
void BuildWalkable(float person_radius_m, Walkable* walkable, float most_radius_m = 0.5f);

// Column and row of the navigation grid; x is -1 outside of it.
struct GridPlace {
  int x = -1, y = -1;
};
inline GridPlace PlaceAt(const Walkable& w, Vec2 p) {
  const float fx = (p.x - w.min_m.x) * w.cells_per_m, fy = (p.y - w.min_m.y) * w.cells_per_m;
  if (!(fx >= 0 && fy >= 0 && fx < static_cast<float>(w.columns) && fy < static_cast<float>(w.rows))) return {};
  return {static_cast<int>(fx), static_cast<int>(fy)};
}
// The cell at p, -1 outside the grid.
inline int CellAt(const Walkable& w, Vec2 p) {
  const GridPlace at = PlaceAt(w, p);
  return at.x < 0 ? -1 : at.y * w.columns + at.x;
}
inline float SlopeOf(const Walkable& w, int cell) {
  return static_cast<float>(w.cells[static_cast<size_t>(cell)].slope) * Walkable::kSlopeUnit;
}
Vec2 CellCenter(const Walkable& w, int cell);
bool IsFree(const Walkable& w, Vec2 p);          // the cell at p is walkable
bool OnGround(const Walkable& w, Vec2 p);        // ground of a kind, whatever stands on it
float HeightAt(const Walkable& w, Vec2 p);       // bilinear; 0 where there is no ground raster
bool InsideObstacle(const Walkable& w, Vec2 p);  // exact, by the shapes
// The free cell nearest to p within reach_m, -1 if none.
int NearestFreeCell(const Walkable& w, Vec2 p, float reach_m);
// The cell where somebody who starts or ends at p walks: the one at p if free, else the nearest free one within
// kPlaceReach_m.
inline constexpr float kPlaceReach_m = 3;
int FreeCellFor(const Walkable& w, Vec2 p);

}  // namespace flaneur
