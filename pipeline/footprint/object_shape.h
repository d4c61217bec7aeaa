// What of one object blocks, before its clearance. Internal to the extraction.
#pragma once
#include <vector>

#include "pipeline/footprint/roofs.h"
#include "pipeline/footprint/shape.h"
#include "pipeline/footprint/stand.h"

namespace flaneur {

Shape ShapeOf(const Site& site, const TownObject& object, const Neighbours& neighbours);

// What of its ground walls enclose but for some that are missing, as where triangles were lost: a guess. Houses beside
// it need no wall where their grounds meet. Where the town has lost triangles, whole walls and parts of the ground may
// be among them.
void CloseGround(const Site& site, const TownObject& object, const Neighbours& beside, bool has_lost, Shape* shape);

// Closes what neither the building's own walls nor its block's have closed.
void CloseRooms(const Site& site, const TownObject& object, const Neighbours& neighbours, Shape* shape);

// Adds what the lines and what is solid already enclose under a roof, together with each other. Lines that all meet are
// taken exactly; else they are joined where they miss each other by up to reach_m.
void CloseUnderRoofs(std::vector<Segment> lines, double reach_m, const Roofs& is_solid, Shape* shape);

// Leaves of the lines those outside of what is solid: the shape itself, or also what `solid` adds.
void SetLoose(const std::vector<Segment>& lines, Shape* shape);
void SetLoose(const std::vector<Segment>& lines, const Rings& solid, Shape* shape);

// A foundation, or whatever triangles, in plan.
Rings InPlan(const std::vector<Triangle3>& triangles);

}  // namespace flaneur
