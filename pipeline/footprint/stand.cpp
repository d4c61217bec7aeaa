#include "pipeline/footprint/stand.h"

namespace flaneur {

BandParts PartsInBand(const Site& site, const Stand& stand, const std::vector<Triangle3>& triangles) {
  BandParts parts = CutToBand(triangles, stand.ground(0), site.options.band_m);
  for (size_t i = 1; i < stand.count(); ++i) {
    const BandParts more = CutToBand(triangles, stand.ground(i), site.options.band_m);
    parts.walls.insert(parts.walls.end(), more.walls.begin(), more.walls.end());
    parts.areas = Union(parts.areas, more.areas);
  }
  return parts;
}

bool AnyInBand(const Site& site, const Stand& stand, const std::vector<Triangle3>& triangles) {
  for (size_t i = 0; i < stand.count(); ++i)
    if (AnyInBand(triangles, stand.ground(i), site.options.band_m)) return true;
  return false;
}

double GroundInTheMiddle(const Stand& stand, const TownObject& object) {
  return stand.ground(0).Height((object.min_m.x + object.max_m.x) / 2, (object.min_m.y + object.max_m.y) / 2);
}

}  // namespace flaneur
