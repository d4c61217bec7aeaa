// Portraits side by side, to be looked at.
#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/likeness/compare.h"

namespace flaneur {

struct SheetPair {
  Portrait full, other;
};

// Three rows for each row of pairs: full geometry, the other, and their difference dE*ab (black 0, white 20 and more).
// All pairs of a row have the same size. Errors: as for WriteFile.
Error WriteContactSheet(const std::filesystem::path& path, const std::vector<std::vector<SheetPair>>& rows);

}  // namespace flaneur
