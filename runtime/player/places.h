// The places of a tour, by what they are for. Internal to runtime/player.
#pragma once
#include "runtime/player/simulation.h"

namespace flaneur {

// The connected walkable area with the most cells, -1 where there is none.
int LargestComponent(const Walkable& walkable);
// A cell of the largest connected walkable area, -1 where there is none.
int BestFreeCell(const Walkable& walkable);
// The walkable cells where people may live.
std::vector<int> HomeCells(const Simulation& simulation);

// Drops places nobody can get to, with a warning. A town without any gets some made up, and so does a crowd's own area.
void PreparePlaces(Simulation* simulation);

inline bool IsGate(const PackPlace& place) { return place.kind == "door" || place.kind == "exit"; }

// The place that a field leads to, an index into Simulation::places; -1 for a scenario's own goal and for `field` -1.
int PlaceOfField(int field, Simulation* simulation);
// A field of somewhere worth walking to from there, -1 where there is nowhere.
int PickDestination(Vec2 from, bool may_loiter, Simulation* simulation);

}  // namespace flaneur
