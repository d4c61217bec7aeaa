// The places of a tour, by what they are for. Internal to runtime/town.
#pragma once
#include "runtime/town/town.h"

namespace flaneur {

// The connected walkable area with the most cells, -1 where there is none.
int LargestComponent(const Walkable& walkable);
// A cell of the largest connected walkable area, -1 where there is none.
int BestFreeCell(const Walkable& walkable);
// The walkable cells where people may live.
std::vector<int> HomeCells(const Town& town);

// Drops places nobody can get to, with a warning. A town without any gets some made up, and so does a crowd's own area.
void PreparePlaces(Town* town);

inline bool IsGate(const Place& place) { return place.kind == "door" || place.kind == "exit"; }

// The place that a field leads to, an index into Town::places; -1 for a scenario's own goal and for `field` -1.
int PlaceOfField(int field, Town* town);
// A field of somewhere worth walking to from there, -1 where there is nowhere.
int PickDestination(const Viewer& viewer, Vec2 from, bool may_loiter, Town* town);

// Any of them, -1 where the one that was drawn is not worth it.
int AnyDestination(Vec2 from, Town* town);

}  // namespace flaneur
