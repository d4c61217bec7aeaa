// Where people can walk: obstacles as shapes, the ground as a grid of heights and costs.
#pragma once
#include <cstdint>
#include <vector>

#include "runtime/base/math.h"

namespace flaneur {

struct CircleObstacle { Vec2 center; float radius_m = 0; };
struct PolygonObstacle {
  std::vector<Vec2> outer;               // either orientation
  std::vector<std::vector<Vec2>> holes;  // inside a hole is outside the obstacle
};

// A raster of heights and ground kinds (0: none); layout as in the tour pack.
struct GroundGrid {
  Vec2 min_m;
  float cell_m = 1;
  int columns = 0, rows = 0;
  std::vector<float> height_m;
  std::vector<uint8_t> kind;
};

struct Walkable {
  GroundGrid ground;
  std::vector<CircleObstacle> circles;
  std::vector<PolygonObstacle> polygons;

  // Derived by BuildWalkable: a navigation grid whose cells are free where a person of person_radius_m fits.
  float person_radius_m = 0.3f;
  Vec2 min_m;
  float cell_m = 0.5f;
  int columns = 0, rows = 0;
  std::vector<float> cost;        // a metre; 0: not walkable
  std::vector<float> slope;       // rise over run, not negative
  std::vector<float> open_share;  // of the disc that density is measured in, the share that is ground: 0..1
  std::vector<int> component;     // connected free cells share a number; -1: not free
  struct Edge { Vec2 a, b; };
  std::vector<Edge> edges;        // of all polygons
  // What a person in a cell, or stepping out of it, can touch: ranges [start[cell], start[cell + 1]) of the lists.
  std::vector<int> wall_start, wall_edges;
  std::vector<int> circle_start, wall_circles;
};

// Fills the derived members. Free cells: ground of a kind, farther than person_radius_m from every obstacle.
// most_radius_m: of the largest person there will be.
void BuildWalkable(float person_radius_m, Walkable* walkable, float most_radius_m = 0.5f);

int CellAt(const Walkable& w, Vec2 p);             // -1 outside the grid
Vec2 CellCenter(const Walkable& w, int cell);
bool IsFree(const Walkable& w, Vec2 p);            // the cell at p is walkable
bool OnGround(const Walkable& w, Vec2 p);          // ground of a kind, whatever stands on it
float HeightAt(const Walkable& w, Vec2 p);         // bilinear; 0 where there is no ground raster
bool InsideObstacle(const Walkable& w, Vec2 p);    // exact, by the shapes
// The free cell nearest to p within reach_m, -1 if none.
int NearestFreeCell(const Walkable& w, Vec2 p, float reach_m);

}  // namespace flaneur
