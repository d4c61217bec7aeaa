// An editable static scene: a town. Metres, glTF axes (Y up).
#pragma once
#include <array>
#include <string>
#include <vector>

#include "pipeline/core/footprint.h"
#include "pipeline/core/mesh.h"
#include "runtime/base/math.h"
#include "runtime/tour_data/turning_part.h"

namespace flaneur {

// What a node stands for in the town; see docs/town-convention.md.
enum class NodeKind { kUntagged, kBuilding, kWall, kTree, kLamp, kOther, kGround, kDoor, kExit, kLoiter, kWork, kNone };
enum class GroundKind : uint8_t { kNone = 0, kCarriageway = 1, kPavement = 2, kSquare = 3, kGrass = 4 };

const char* NodeKindName(NodeKind kind);      // "building", ...
const char* GroundKindName(GroundKind kind);  // "carriageway", ...

struct SceneNode {
  std::string name;
  int parent = -1;
  Mat4 world;                             // to scene space
  std::vector<int> meshes;                // indices into Scene::meshes
  NodeKind kind = NodeKind::kUntagged;    // own tag or the nearest ancestor's
  GroundKind ground = GroundKind::kNone;  // likewise, where kind is kGround
  std::string street = {};            // what visitors call this ground, own or the nearest ancestor's; empty: nothing
  TurnsBy turns = TurnsBy::kNothing;  // its own meshes
  float radius_m = 0;                 // 0: not given
  float width_m = 0;                  // 0: not given
  // Of kWork, as Place has them:
  std::string clip = {};
  std::vector<std::string> avatars = {};
  float seat_m = 0, stay_s = 0;
  // The ground under the parent building as its model has it. Nobody walks on it and it blocks nobody; it tells how
  // high the local ground lies in a town without terrain.
  bool is_foundation = false;
  bool is_bridge = false;  // people walk over it, and under it where there is room
};

struct Scene {
  std::vector<SceneNode> nodes;
  std::vector<Mesh> meshes;
  std::vector<Material> materials;
  std::vector<Image> images;
  Point2 origin_m;               // x east, y north: add to a coordinate to get the source's own
  std::string reference_system;  // of the source's coordinates: "EPSG:25832"; empty: not known
};

// Of all vertices, x east, y north, z up. False where there are none.
bool ExtentOf(const Scene& scene, Point3* low, Point3* high);

}  // namespace flaneur
