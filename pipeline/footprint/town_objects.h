// A scene sorted by what it means for a person on foot: ground and things in the way.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/core/footprint.h"
#include "pipeline/core/scene.h"

namespace flaneur {

using Triangle3 = std::array<Point3, 3>;

double PlanArea(const Triangle3& triangle);  // seen from above
double PlanArea(const std::vector<Triangle3>& triangles);
void Grow(const std::vector<Triangle3>& triangles, Point3* min, Point3* max);

struct TownObject {
  std::string name;  // of the topmost node that carries the tag
  ObstacleKind kind = ObstacleKind::kBuilding;
  double radius_m = 0;  // 0: measure it
  std::vector<Triangle3> triangles;
  std::vector<Triangle3> foundation;  // the ground under it, where the model has that; none of `triangles`
  Point3 min_m, max_m;                // of `triangles`
  bool is_bridge = false;
  bool foundation_is_given = false;      // by the model; else it is found among `triangles`
  bool is_roof = false;                  // a flat roof and nothing else
  bool has_no_floor = false;             // looked for among `triangles`, and not found
  std::optional<double> level_feet_m{};  // of one without a floor, where it and the houses beside it stand level
};

struct GroundPatch {
  GroundKind kind = GroundKind::kPavement;
  std::vector<Triangle3> triangles;
};

struct TownObjects {
  std::vector<TownObject> obstacles;
  std::vector<GroundPatch> ground;
  std::vector<std::string> flat;    // untagged objects that are ground only because they are flat
  std::vector<std::string> untold;  // untagged objects that hold ground by their shape, wholly or in part
};
bool HasBridge(const TownObjects& town);

// Parts of one tagged node are one object. Untagged nodes are told by the words of their names (tree; lamp, lantern;
// road, street, grass, square, ground, terrain, floor, hex, path and the like, in other languages too, unless too high
// for ground), flat ones are ground (where a town has no other, only if they are large beside its houses, and not those
// high within another object: flat roofs), and the rest are buildings, but for the ground that they hold where the town
// has no other (untold_ground.h). Nodes tagged none, door, exit or loiter are left out. `scale` turns the scene's units
// into metres. Degenerate triangles are kept.
TownObjects SortTown(const Scene& scene, double scale);

}  // namespace flaneur
