// Obstacles as GeoJSON: our own files and other people's.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/core/footprint.h"
#include "runtime/base/error.h"

namespace flaneur {

enum class GeoJsonUnits { kAuto, kMetres, kDegrees };

struct ReadGeoJsonOptions {
  // kAuto: metres where the file has our member "flaneur"; else what its "crs" says; else degrees where every
  // coordinate can be a longitude and latitude, as the standard has it.
  GeoJsonUnits units = GeoJsonUnits::kAuto;
};

struct GeoJsonFile {
  Footprints footprints;
  // Obstacle i's rings that end without coming back to their first point: 0 the outer one, then the holes.
  std::vector<std::vector<int>> open_rings;
  bool degrees = false;            // was turned into local metres, x east, y north of origin_m = (longitude, latitude)
  int skipped = 0;                 // features that are neither polygons nor circles
};

// Polygons, multipolygons (one obstacle each part) and points with `radius_m`. Rings come as they stand, only the
// repeated last point is dropped: broken rings are for the check to find. Names that are missing are made up, names that
// repeat get a number. Origins of projected coordinates are moved near zero (`origin_m`).
// Errors: unreadable, not JSON, not a FeatureCollection, a coordinate that is no number (each names file and feature).
Error ReadGeoJson(const std::filesystem::path& path, const ReadGeoJsonOptions& options, GeoJsonFile* file);

// Coordinates to 0.1 mm. Errors: as for WriteFile.
Error WriteGeoJson(const std::filesystem::path& path, const Footprints& footprints);

}  // namespace flaneur
