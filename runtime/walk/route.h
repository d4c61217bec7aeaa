// A way over the walkable ground as a line of corners, measured from its start. Internal to runtime/walk.
#pragma once
#include <vector>

#include "runtime/crowd/walkable.h"
#include "runtime/crowd/way_search.h"

namespace flaneur {

struct Route {
  std::vector<Vec2> points;  // from one to the next one can walk straight
  std::vector<float> at_m;   // way from the start to each point
};

inline float LengthOf_m(const Route& route) { return route.at_m.empty() ? 0 : route.at_m.back(); }

// The route's next part, to `goal`. Without a way there it ends where it did; false then.
bool ExtendRoute(const Walkable& w, Vec2 goal, WaySearch* search, Route* route);

// Bends the route's part from this point on off walls and posts, as one walks who looks about: not round corners by the
// shortest way, but where there is room with room to either side. Its ends stay, and all of it can be walked as before.
void MakeRoomOnRoute(const Walkable& w, size_t first, Route* route);

// The point so far along the route, or its nearer end.
Vec2 PointAt(const Route& route, float way_m);

// How far along the route its nearest point to p is, between least_m and most_m.
float WayTo(const Route& route, Vec2 p, float least_m, float most_m);

// Whether one can walk straight from p to q, whatever the ground.
bool FreeLine(const Walkable& w, Vec2 p, Vec2 q);

// Unit vector from p towards a point that is near: straight, or round what stands between; zero where there is no way.
Vec2 WayStraightOrRound(const Walkable& w, Vec2 p, Vec2 point, Corner* corner, WaySearch* search);

// Unit vector for somebody at p who follows the route and has come so far; back to it where they are off it.
Vec2 WayAlong(const Walkable& w, const Route& route, float way_m, Vec2 p, Corner* corner, WaySearch* search);

}  // namespace flaneur
