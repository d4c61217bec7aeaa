// The atlas as the pictures that its users read. Internal to pipeline/impostor.
#pragma once
#include <vector>

#include "pipeline/core/impostor.h"
#include "pipeline/impostor/atlas_layers.h"
#include "runtime/base/error.h"
#include "runtime/base/jobs.h"

namespace flaneur {

// Two channels on the unit square for a direction of the half space z >= 0 (a hemi-octahedron turned by 45 degrees, as
// in Cigolle et al. 2014, A Survey of Efficient Representations for Independent Unit Vectors); others are bent to its
// rim.
Vec2 SquareFromNormal(Vec3 normal);

// Fills in the KTX2 files from levels as FillGutters and KeepCoverage leave them. `jobs` share the work; the same
// bytes.
void CompressAtlas(const std::vector<AtlasLevel>& levels, Jobs* jobs, ImpostorAtlas* atlas);

// The PNG files from the finest level, side by side. Errors: what OpenImageIO says.
Error EncodeAtlas(const AtlasLevel& finest, Jobs* jobs, ImpostorAtlas* atlas);

}  // namespace flaneur
