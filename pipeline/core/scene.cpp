#include "pipeline/core/scene.h"

namespace flaneur {

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
