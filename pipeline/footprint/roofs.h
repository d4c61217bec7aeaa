// Tells yards from what a roof covers. Internal to the extraction.
#pragma once
#include <vector>

#include "pipeline/footprint/enclosed_regions.h"
#include "pipeline/footprint/overhead.h"
#include "pipeline/footprint/stand.h"

namespace flaneur {

// Whether a region is solid: too small for a yard, or most of it under something.
class Roofs {
 public:
  Roofs(const Site& site, const LocalGround& ground, const Overhead& overhead)
      : site_(site), ground_(ground), overhead_(overhead) {}

  bool operator()(double area_m2, const std::vector<RegionSample>& samples) const;
  bool operator()(const Rings& region) const;

 private:
  const Site& site_;
  const LocalGround& ground_;
  const Overhead& overhead_;
};

}  // namespace flaneur
