// In which system a GeoJSON file's coordinates are; see geojson.h.
#pragma once
#include <string>

#include "pipeline/io/geojson.h"

namespace flaneur {

struct StatedSystem {
  GeoJsonUnits units = GeoJsonUnits::kAuto;  // kAuto: `system`, or longitude and latitude where that is empty
  std::string system;
  bool local = false;  // metres near zero already: what lies far away is a fault to be found
};

// Turns all points of the file into local metres; adds a fault where they cannot be in the system stated.
Error ToLocalMetres(const StatedSystem& stated, GeoJsonFile* file);

}  // namespace flaneur
