#include "pipeline/core/scene.h"

#include <algorithm>

#include "runtime/base/array.h"

namespace flaneur {

bool ExtentOf(const Scene& scene, Point3* low, Point3* high) {
  *low = {1e300, 1e300, 1e300}, *high = {-1e300, -1e300, -1e300};
  for (const SceneNode& node : scene.nodes) {
    for (const int mesh : node.meshes) {
      for (const Vec3& position : At(scene.meshes, mesh).positions) {
        const Vec3 p = GroundFromGltf(TransformPoint(node.world, position));
        *low = {std::min<double>(low->x, p.x), std::min<double>(low->y, p.y), std::min<double>(low->z, p.z)};
        *high = {std::max<double>(high->x, p.x), std::max<double>(high->y, p.y), std::max<double>(high->z, p.z)};
      }
    }
  }
  return low->x <= high->x;
}

const char* NodeKindName(NodeKind kind) {
  switch (kind) {
    case NodeKind::kUntagged:
      return "untagged";
    case NodeKind::kBuilding:
      return "building";
    case NodeKind::kWall:
      return "wall";
    case NodeKind::kTree:
      return "tree";
    case NodeKind::kLamp:
      return "lamp";
    case NodeKind::kOther:
      return "other";
    case NodeKind::kGround:
      return "ground";
    case NodeKind::kDoor:
      return "door";
    case NodeKind::kExit:
      return "exit";
    case NodeKind::kLoiter:
      return "loiter";
    case NodeKind::kWork:
      return "work";
    case NodeKind::kNone:
      return "none";
  }
  return "untagged";
}

const char* GroundKindName(GroundKind kind) {
  switch (kind) {
    case GroundKind::kNone:
      return "none";
    case GroundKind::kCarriageway:
      return "carriageway";
    case GroundKind::kPavement:
      return "pavement";
    case GroundKind::kSquare:
      return "square";
    case GroundKind::kGrass:
      return "grass";
  }
  return "none";
}

}  // namespace flaneur
