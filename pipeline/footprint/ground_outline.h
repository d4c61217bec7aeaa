// A raster's ground as an area.
#pragma once
#include "pipeline/core/footprint.h"
#include "pipeline/footprint/polygon_sets.h"

namespace flaneur {

// Straightened within a cell; holes up to 1 m2 are filled.
Rings OutlineOf(const GroundRaster& raster);

}  // namespace flaneur
