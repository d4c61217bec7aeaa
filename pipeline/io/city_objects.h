// What the objects and surfaces of CityGML, and of CityJSON alike, mean for a person on foot.
#pragma once
#include <string>
#include <string_view>

#include "pipeline/core/scene.h"
#include "pipeline/io/town_builder.h"

namespace flaneur {

// A feature that stands for itself: Building, SolitaryVegetationObject, Road, ... BuildingPart and BuildingInstallation
// are parts of the building that holds them.
struct CityFeature {
  NodeKind kind;
  GroundKind ground;
  bool is_part;
  bool is_bridge = false;
  SurfaceKind surface = SurfaceKind::kOther;  // of its surfaces that do not say what they are
};

// Whether a feature's function, by the AdV's code list, is that of a bridge: 53001_1800 and its kinds.
bool IsBridgeFunction(std::string_view function);

// Null for anything else.
const CityFeature* FindCityFeature(std::string_view type);
// Rooms and furniture inside of buildings.
bool IsIndoors(std::string_view type);

struct CitySurface {
  SurfaceKind surface;
  bool is_virtual;
  bool is_foundation;
};

// WallSurface, RoofSurface, ...; null for anything else. A ClosureSurface is where the model has no wall.
const CitySurface* FindCitySurface(std::string_view type);

}  // namespace flaneur
