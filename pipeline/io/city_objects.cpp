#include "pipeline/io/city_objects.h"

#include <algorithm>
#include <array>
#include <utility>

namespace flaneur {
namespace {

using Feature = std::pair<std::string_view, CityFeature>;
constexpr auto kNoGround = GroundKind::kNone;
constexpr std::array<Feature, 37> kFeatures{{
    {"Building", {NodeKind::kBuilding, kNoGround, false, false, SurfaceKind::kNotSaid}},
    {"BuildingPart", {NodeKind::kBuilding, kNoGround, true, false, SurfaceKind::kNotSaid}},
    {"BuildingInstallation", {NodeKind::kBuilding, kNoGround, true, false, SurfaceKind::kNotSaid}},
    {"BuildingConstructiveElement", {NodeKind::kBuilding, kNoGround, true, false, SurfaceKind::kNotSaid}},
    {"Bridge", {NodeKind::kOther, kNoGround, false, true}},
    {"BridgePart", {NodeKind::kOther, kNoGround, true, true}},
    {"BridgeInstallation", {NodeKind::kOther, kNoGround, true, true}},
    {"BridgeConstructionElement", {NodeKind::kOther, kNoGround, true, true}},
    {"BridgeConstructiveElement", {NodeKind::kOther, kNoGround, true, true}},
    {"OtherConstruction", {NodeKind::kOther, kNoGround, false}},
    {"CityFurniture", {NodeKind::kOther, kNoGround, false}},
    {"GenericCityObject", {NodeKind::kOther, kNoGround, false}},
    {"+GenericCityObject", {NodeKind::kOther, kNoGround, false}},
    {"SolitaryVegetationObject", {NodeKind::kTree, kNoGround, false, false, SurfaceKind::kPlants}},
    {"PlantCover", {NodeKind::kNone, kNoGround, false, false, SurfaceKind::kPlants}},
    {"WaterBody", {NodeKind::kNone, kNoGround, false, false, SurfaceKind::kWater}},
    {"Tunnel", {NodeKind::kNone, kNoGround, false}},
    {"TunnelPart", {NodeKind::kNone, kNoGround, true}},
    {"TunnelInstallation", {NodeKind::kNone, kNoGround, true}},
    {"ReliefFeature", {NodeKind::kGround, GroundKind::kPavement, false, false, SurfaceKind::kGround}},
    {"TINRelief", {NodeKind::kGround, GroundKind::kPavement, false, false, SurfaceKind::kGround}},
    {"BreaklineRelief", {NodeKind::kNone, kNoGround, false}},
    {"MassPointRelief", {NodeKind::kNone, kNoGround, false}},
    {"RasterRelief", {NodeKind::kNone, kNoGround, false}},
    {"LandUse", {NodeKind::kGround, GroundKind::kGrass, false, false, SurfaceKind::kGrass}},
    {"Road", {NodeKind::kGround, GroundKind::kCarriageway, false, false, SurfaceKind::kPaving}},
    {"Railway", {NodeKind::kGround, GroundKind::kCarriageway, false, false, SurfaceKind::kPaving}},
    {"TransportationComplex", {NodeKind::kGround, GroundKind::kCarriageway, false, false, SurfaceKind::kPaving}},
    {"TransportSquare", {NodeKind::kGround, GroundKind::kSquare, false, false, SurfaceKind::kPaving}},
    {"Square", {NodeKind::kGround, GroundKind::kSquare, false, false, SurfaceKind::kPaving}},
    {"Track", {NodeKind::kGround, GroundKind::kPavement, false, false, SurfaceKind::kPaving}},
    {"Waterway", {NodeKind::kNone, kNoGround, false, false, SurfaceKind::kWater}},
    {"CityObjectGroup", {NodeKind::kNone, kNoGround, false}},
    {"BuildingUnit", {NodeKind::kNone, kNoGround, true}},
    {"BuildingStorey", {NodeKind::kNone, kNoGround, true}},
    {"Storey", {NodeKind::kNone, kNoGround, true}},
    {"TunnelConstructiveElement", {NodeKind::kNone, kNoGround, true}},
}};

using Surface = std::pair<std::string_view, CitySurface>;
constexpr std::array<Surface, 19> kSurfaces{{
    {"WallSurface", {SurfaceKind::kWall, false, false}},
    {"RoofSurface", {SurfaceKind::kRoof, false, false}},
    {"GroundSurface", {SurfaceKind::kGround, false, true}},
    {"ClosureSurface", {SurfaceKind::kOther, true, false}},
    {"OuterCeilingSurface", {SurfaceKind::kOther, false, false}},
    {"OuterFloorSurface", {SurfaceKind::kOther, false, false}},
    {"InteriorWallSurface", {SurfaceKind::kOther, true, false}},
    {"FloorSurface", {SurfaceKind::kOther, true, false}},
    {"CeilingSurface", {SurfaceKind::kOther, true, false}},
    {"Window", {SurfaceKind::kOther, false, false}},
    {"Door", {SurfaceKind::kOther, false, false}},
    {"WindowSurface", {SurfaceKind::kOther, false, false}},
    {"DoorSurface", {SurfaceKind::kOther, false, false}},
    {"WaterSurface", {SurfaceKind::kWater, false, false}},
    {"TrafficArea", {SurfaceKind::kGround, false, false}},
    {"AuxiliaryTrafficArea", {SurfaceKind::kGround, false, false}},
    {"TrafficSpace", {SurfaceKind::kOther, true, false}},  // the air over it
    {"AuxiliaryTrafficSpace", {SurfaceKind::kOther, true, false}},
    {"ClearanceSpace", {SurfaceKind::kOther, true, false}},
}};

template <typename Table>
auto FindIn(const Table& table, std::string_view type) {
  const auto found = std::find_if(table.begin(), table.end(), [&](const auto& entry) { return entry.first == type; });
  return found == table.end() ? nullptr : &found->second;
}

}  // namespace

const CityFeature* FindCityFeature(std::string_view type) { return FindIn(kFeatures, type); }
const CitySurface* FindCitySurface(std::string_view type) { return FindIn(kSurfaces, type); }

bool IsBridgeFunction(std::string_view function) { return function.rfind("53001_18", 0) == 0; }

bool IsIndoors(std::string_view type) {
  constexpr std::array<std::string_view, 8> kIndoors{"Room",
                                                     "BuildingRoom",
                                                     "IntBuildingInstallation",
                                                     "BuildingFurniture",
                                                     "BridgeRoom",
                                                     "IntBridgeInstallation",
                                                     "TunnelHollow",
                                                     "HollowSpace"};
  return std::find(kIndoors.begin(), kIndoors.end(), type) != kIndoors.end();
}

}  // namespace flaneur
