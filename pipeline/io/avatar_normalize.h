// Puts a person as read from any file into the shape that everything after relies on.
#pragma once
#include <string>
#include <vector>

#include "pipeline/core/avatar.h"
#include "pipeline/rig/humanoid.h"
#include "runtime/base/error.h"

namespace flaneur {

struct NormalizeOptions {
  float height_m = 0;           // 0: as it is where 0.5 to 2.3 m, else in another unit, else 1.75
  float scale = 0;              // metres per unit of the file, whatever height that makes; 0: by the height
  std::string up, forward;      // the figure's in the file: "z", "-y", ...; empty: by its skeleton and walk
  std::vector<NamedBone> told;  // by the file, of the avatar's joints
  float walk_speed = 0;         // known from the source, in metres or in units of the file a second; 0: measure
};

// Stands the figure up where it lies, removes travel from the clips, makes them loop, turns the figure so that it walks
// towards +Z (by quarters, or by any angle of more than 10 degrees that its skeleton shows), scales, sets the feet on y
// = 0 (lowest point over each clip) and the hips, or the trunk of who has no legs, over x = z = 0, then measures
// height, radius and walking speed. `body`: the part of the surface that can touch the ground and that gives the
// trunk's width, without what is carried; on the avatar's joints. Errors: a figure without height, numbers beyond
// reason.
Error NormalizeAvatar(const NormalizeOptions& options, const Mesh& body, Avatar* avatar,
                      std::vector<std::string>* warnings);

// Velocity over the ground, m/s, at which the soles of a walk on the spot do not slide: against the
// median velocity of the points near the ground. Zero where nothing tells.
Vec3 MeasureWalk(const Avatar& avatar, const Clip& walk, const Mesh& body);

}  // namespace flaneur
