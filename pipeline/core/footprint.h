// Obstacles on the ground plane: metres, x east, y north.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "runtime/base/math.h"
#include "runtime/tour_data/tour_data.h"

namespace flaneur {

// Doubles: towns in a map projection keep millimetres.
struct Point2 {
  double x = 0, y = 0;
};
struct Point3 {
  double x = 0, y = 0, z = 0;
};  // z up

enum class ObstacleKind { kBuilding, kWall, kTree, kLamp, kOther };
const char* ObstacleKindName(ObstacleKind kind);

// A polygon with holes, or a circle (outer empty, radius_m > 0).
struct Obstacle {
  std::string name;  // unique in a collection
  ObstacleKind kind = ObstacleKind::kBuilding;
  std::string source;  // node or object id it was made from
  double clearance_m = 0;
  double ground_z_m = 0;
  bool open_shell = false;                 // its walls do not close, or had to be closed: the outline is a guess (306)
  std::vector<Point2> outer;               // anticlockwise, first point not repeated
  std::vector<std::vector<Point2>> holes;  // clockwise
  Point2 center;
  double radius_m = 0;
};

struct Footprints {
  double clearance_m = 0.05;
  double tolerance_m = 0;                  // outlines were simplified outwards by at most this; 0: not known
  std::array<double, 2> band_m{0.1, 2.0};  // height over the local ground that blocks
  Point2 origin_m;                         // add to a coordinate to get the source's own
  std::string reference_system;            // of the source's coordinates: "EPSG:25832"; empty: not known
  std::vector<Obstacle> obstacles;
};

}  // namespace flaneur
