// Whether obstacles stand where a town has what they stand for, or all of them beside it.
#pragma once
#include "pipeline/footprint/check.h"

namespace flaneur {

inline constexpr double kFits = 0.6;  // of the obstacles: they belong to the town

struct TownFit {
  double share = 0;  // of the obstacles that stand where the town has something, once all are moved
  Point2 shift_m;    // by which all must be moved
};

// The shift is told by boxes of the same size: exact where the obstacles were extracted from this town, else (0, 0).
TownFit FitToTown(const Footprints& footprints, const PreparedTown& town);

}  // namespace flaneur
