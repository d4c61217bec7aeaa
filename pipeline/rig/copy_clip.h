// A clip of one skeleton taken to another by joint names alone.
#pragma once
#include <string>
#include <vector>

#include "pipeline/core/avatar.h"

namespace flaneur {

// A joint's name without what stands before it for the rig's own: "mixamorig:Hips" is "Hips".
std::string BareName(const std::string& name);

// Whether nearly every joint of `target` has one of its name, parent and rest in `source`, so that clips fit as they
// are. `scale`: of the target's lengths against the source's.
bool SameSkeleton(const std::vector<Joint>& source, const std::vector<Joint>& target, float* scale);

// A clip by joint names alone: each joint turns and moves from its own rest as the source's does from its. For figures
// that are no humans. Joints that the source lacks keep their rest. Returns how many joints were found.
int CopyClip(const std::vector<Joint>& source, const Clip& clip, const std::vector<Joint>& target, Clip* copied);

}  // namespace flaneur
