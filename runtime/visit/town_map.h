// The town from above, north at its top, for visitors: drawn from where one can walk and what stands there. Knows
// nothing of the page around it.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "runtime/crowd/walkable.h"
#include "runtime/simulation/simulation.h"

namespace flaneur {

// What a picture of so many pixels shows.
struct MapView {
  Vec2 center_m;
  float px_per_m = 1;
  int width_px = 0, height_px = 0;
};

// Pixels from the picture's upper left corner, y down.
Vec2 OnMap(const MapView& view, Vec2 ground_m);
Vec2 FromMap(const MapView& view, Vec2 place_px);

// All ground that is there, with a margin.
MapView WholeTown(const Walkable& walkable, int width_px, int height_px);
// The same picture, so many times as large around the place, and never beside the town.
MapView Enlarged(const MapView& whole, float times, Vec2 center_m);

// RGBA, top row first. Ways by their kind, houses and what else stands there, trees.
std::vector<uint8_t> DrawTownMap(const Walkable& walkable, const MapView& view);

// Where the tour stops, in its order, by its number among those where one rests.
struct MapStop {
  size_t stop = 0;  // of the tour
  int number = 1;
};
std::vector<MapStop> StopsOnMap(const GuidedTour& tour);

// The street that passes nearest, at most kNearStreet_m away; -1: none.
inline constexpr float kNearStreet_m = 8;
int StreetAt(const std::vector<Street>& streets, Vec2 p);
// Halfway along.
Vec2 MiddleOf(const Street& street);

}  // namespace flaneur
