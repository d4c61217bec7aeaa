// In which system a GeoJSON file's coordinates are; see geojson.h.
#pragma once
#include <array>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/io/geojson.h"

namespace flaneur {

struct StatedSystem {
  GeoJsonUnits units = GeoJsonUnits::kAuto;  // kAuto: `system`, or longitude and latitude where that is empty
  std::string system;
  bool local = false;  // metres near zero already: what lies far away is a fault to be found
};

// What a file says of its place besides its coordinates and their system. NaN and empty: nothing.
struct StatedPlace {
  std::string other_crs;                                  // the member "crs" of one of our own files, which has its own
  std::array<double, 4> box{kNone, kNone, kNone, kNone};  // bbox: west, south, east, north
  std::vector<std::pair<std::string, Point2>> places_deg;  // where a corner of these obstacles lies
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
};

// Adds one fault (kElsewhere) where the file contradicts itself: longitude and latitude swapped, `crs` or `origin_m`
// wrong; it says what that looks like. Swapped coordinates are set right, so that all else is checked.
Error FindMisplacement(const StatedSystem& stated, const StatedPlace& place, GeoJsonFile* file);

void ForEachPoint(GeoJsonFile* file, const std::function<void(Point2&)>& function);

// Turns all points of the file into local metres; adds a fault where they cannot be in the system stated.
Error ToLocalMetres(const StatedSystem& stated, GeoJsonFile* file);

}  // namespace flaneur
