// How far levels of detail lie from the original, in the bind pose and walking.
#pragma once
#include <vector>

#include "pipeline/core/avatar.h"

namespace flaneur {

// Sets error_mm and posed_error_mm of each level: the greatest of the distances of `samples` points
// and up to 6,000 vertices of each surface from the other, over `walk_poses` moments of the walk.
// The same result on any number of threads.
void MeasureLevels(const Avatar& original, int samples, int walk_poses,
                   std::vector<AvatarLevel>* levels);

// Sets normal_deg of each level, at `samples` places of it whose nearest place of the original faces the same way.
void MeasureNormals(const Avatar& original, int samples, std::vector<AvatarLevel>* levels);

}  // namespace flaneur
