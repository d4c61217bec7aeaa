// The ground under an object, and what of the object stands in the band over it. Internal to the extraction.
#pragma once
#include <vector>

#include "pipeline/footprint/band.h"
#include "pipeline/footprint/base_ground.h"
#include "pipeline/footprint/extract_footprints.h"
#include "pipeline/footprint/rasterize_ground.h"
#include "pipeline/footprint/town_objects.h"

namespace flaneur {

struct Site {
  const FootprintOptions& options;
  const LocalGround* ground;  // the town's; null where it has none
};

// What an object stands on: one ground, or where it stands on terraces several, the lowest first.
class Stand {
 public:
  Stand(const Site& site, const TownObject& object, const Neighbours& neighbours = {}) : town_(site.ground) {
    if (!town_) own_ = GroundsUnder(object, neighbours);
  }
  size_t count() const { return town_ ? 1 : own_.size(); }
  const LocalGround& ground(size_t i) const { return town_ ? *town_ : own_[i]; }

 private:
  const LocalGround* town_;
  std::vector<LocalGround> own_;
};

// Of all grounds under it.
BandParts PartsInBand(const Site& site, const Stand& stand, const std::vector<Triangle3>& triangles);
bool AnyInBand(const Site& site, const Stand& stand, const std::vector<Triangle3>& triangles);

double GroundInTheMiddle(const Stand& stand, const TownObject& object);

}  // namespace flaneur
