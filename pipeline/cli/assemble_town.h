// One town from several models, and the places that its nodes mark.
#pragma once
#include <vector>

#include "pipeline/core/scene.h"
#include "runtime/pack/tour_pack.h"

namespace flaneur {

// Appends `part` to `town`, scaled, turned anticlockwise and moved on the ground plane.
void AppendScene(Scene part, float scale, float yaw_rad, Vec2 position_m, Scene* town);

// Door, exit and loiter nodes.
std::vector<Place> TaggedPlaces(const Scene& town);

// Ground that is tagged with a street's name, in this language: of each name the long middle line of all its ground.
std::vector<Street> TaggedStreets(const Scene& town, const std::string& language);

// Gives a town that has no ground under most of its things a square through their feet (bare_ground.h), `margin_m`
// wider than the town; else does nothing. Returns whether it did. on_one_level: all stand on one plane.
bool AddGroundWhereNone(bool on_one_level, float margin_m, Scene* town);

}  // namespace flaneur
