// Which of two coordinates in degrees is the longitude, told by the right angles of houses.
#pragma once
#include <vector>

#include "pipeline/core/footprint.h"

namespace flaneur {

using PlanRing = std::vector<Point2>;

// Of corners between edges longer than half a metre.
struct Corners {
  int all = 0, right = 0;  // right: to 0.6 degrees
};

// Of rings whose points are longitude (x) and latitude (y) in units of so many degrees.
Corners CornersOf(const std::vector<PlanRing>& rings, double unit_deg = 1);

enum class AxisEvidence { kNone, kAsGiven, kSwapped };

// Of rings whose points are longitude and latitude as given, or the other way round. A degree is not as long in both
// directions, so that houses lose their right angles when read the wrong way; towns at the equator and houses that
// stand along the meridian tell nothing.
AxisEvidence AxesByRightAngles(const std::vector<PlanRing>& rings, double unit_deg = 1);

}  // namespace flaneur
