// The skeleton of a file that was made for its clips.
#pragma once
#include <string>
#include <vector>

#include "pipeline/rig/rig.h"

namespace flaneur {

// As MakeRig, of a skeleton with a figure or without. What it rests in may be any pose: FBX files without a skin rest
// in the moment they were saved at, recordings with all bones along one axis. Where the legs don't hang alike at rest,
// the figure's soles say how they stand; without a figure `clip` does: each leg as it is in the key where it hangs
// straightest, the rest as in the key that looks ahead most. Of a figure that stands only arms of one bone are used,
// which say nothing of where they point.
bool MakeClipRig(const Avatar& skeleton, const std::vector<NamedBone>& told, const Clip& clip, Rig* rig,
                 std::string* why);

}  // namespace flaneur
