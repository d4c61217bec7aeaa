// Motion capture in Biovision's BVH: a skeleton and one recording, in text.
#pragma once
#include <filesystem>

#include "pipeline/core/avatar.h"
#include "runtime/base/error.h"

namespace flaneur {

// Joints, end sites among them (named after what they end), and one clip, "motion", at 30 Hz of at most `longest_s`.
// Lengths in the file's unit and axes. Errors name file and line: no hierarchy, unknown channels, too few numbers,
// none.
Error ReadBvh(const std::filesystem::path& path, float longest_s, Avatar* skeleton);

}  // namespace flaneur
