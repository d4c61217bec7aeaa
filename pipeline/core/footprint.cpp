#include "pipeline/core/footprint.h"

namespace flaneur {

const char* ObstacleKindName(ObstacleKind kind) {
  switch (kind) {
    case ObstacleKind::kBuilding:
      return "building";
    case ObstacleKind::kWall:
      return "wall";
    case ObstacleKind::kTree:
      return "tree";
    case ObstacleKind::kLamp:
      return "lamp";
    case ObstacleKind::kOther:
      return "other";
  }
  return "other";
}

}  // namespace flaneur
