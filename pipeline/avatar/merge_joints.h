// Joints that nobody can tell from their parents: fingers that never bend, toes seen from afar.
#pragma once
#include <vector>

#include "pipeline/core/avatar.h"

namespace flaneur {

// Lets vertices follow a joint's parent instead of it wherever no vertex of `meshes` is then
// farther than `bound_m` from where it was, in any of some poses of every clip. Returns the
// greatest of these distances, in metres.
float MergeJoints(const Avatar& avatar, float bound_m, std::vector<Mesh>* meshes);

// Takes joints out of skeleton, clips and meshes that move no vertex and no other joint that stays.
void DropIdleJoints(Avatar* avatar);

// How many joints move a vertex.
int CountJoints(const std::vector<Mesh>& meshes);

}  // namespace flaneur
