// One material with one picture for what had several: the coarser levels of a person become one
// draw each.
#pragma once
#include <string>
#include <vector>

#include "pipeline/core/avatar.h"

namespace flaneur {

// Merges the materials of all levels that are shown at 600 px of the person's height or less. Base
// colours are multiplied in; pictures are as fine as the first of these levels shows them, repeats
// are written out. Materials of two sides stay apart from those of one, blended from others; masks
// join opaque ones with the alpha cutoff 0.5. Normal maps, too fine to be seen there, and second
// uvs go. A material whose picture cannot be decoded or repeats more than four times keeps apart,
// with a warning. The new materials and images stand behind the avatar's own.
void MergeMaterials(AvatarLevels* levels, std::vector<std::string>* warnings);

}  // namespace flaneur
