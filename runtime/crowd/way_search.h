// The way of one person to a goal that few others have: searched for from here to there, without a flow field of the
// whole town.
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "runtime/crowd/regions.h"
#include "runtime/crowd/walkable.h"

namespace flaneur {

// Nodes and what a search has found out about them; kept between searches, so that only what a search reaches is
// touched.
struct SearchTable {
  std::vector<uint32_t> round_of;           // by node: the round in which cost and from mean something
  std::vector<float> cost;                  // weighted metres from the start
  std::vector<int> from;                    // node before
  std::vector<std::pair<float, int>> open;  // heap
  std::vector<int> way;                     // nodes of the way found, from the start
  uint32_t round = 0;
};

struct WaySearch {
  Regions regions;           // of the walkable ground; built by the first search
  SearchTable far, near;     // over regions, over cells
  std::vector<Vec2> points;  // of the way
};

// Where somebody is heading for on the way; unknown after a new goal.
struct Corner {
  Vec2 point, from;  // from: where it was chosen
  bool known = false;
};

// Unit vector from p to the next corner of a good way to the goal: A* over the regions, then straight to the farthest
// of their points that is in sight; over the cells where none is. A corner is kept until it is reached, passed or,
// where `look`, out of sight. Zero where there is no way.
Vec2 WayByCorners(const Walkable& w, Vec2 p, Vec2 goal, bool look, Corner* corner, WaySearch* search);

}  // namespace flaneur
