#include "pipeline/cli/visit_places.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/text.h"
#include "runtime/crowd/constants.h"
#include "runtime/town/places.h"
#include "runtime/walk/guided_tour.h"
#include "runtime/walk/visitor.h"

namespace flaneur {
namespace {

constexpr float kMostRoom_m2 = 1500;  // to a person: within 30 m one still sees somebody
constexpr float kUsualRoom_m2 = 200;  // of a lively town
constexpr int kFewest = 10;

Vec2 Metres(Point2 p) { return {static_cast<float>(p.x), static_cast<float>(p.y)}; }

std::vector<Vec2> Metres(const std::vector<Point2>& ring) {
  std::vector<Vec2> points;
  for (const Point2& p : ring) points.push_back(Metres(p));
  return points;
}

void AddObstacle(const Obstacle& from, Obstacles* to) {
  if (from.outer.empty()) {
    to->circles.push_back({Metres(from.center), static_cast<float>(from.radius_m)});
    return;
  }
  PolygonObstacle polygon;
  polygon.outer = Metres(from.outer);
  for (const auto& hole : from.holes) polygon.holes.push_back(Metres(hole));
  to->polygons.push_back(std::move(polygon));
}

Town WalkableTown(const Footprints& footprints, const GroundRaster& ground, float person_radius_m) {
  Town town;
  for (const Obstacle& o : footprints.obstacles) AddObstacle(o, &town.walkable);
  town.walkable.ground = Share(ground);
  BuildWalkable(person_radius_m + kByChoice_m, &town.walkable);
  return town;
}

bool TellsWhereToGo(const Place& place) { return place.kind != "play" && place.kind != "exit"; }

}  // namespace

std::vector<std::string> PlacesNobodyReaches(const Footprints& footprints, const GroundRaster& ground,
                                             const std::vector<TourStop>& stops, const std::vector<Place>& places,
                                             float person_radius_m) {
  Town town = WalkableTown(footprints, ground, person_radius_m);
  if (BestFreeCell(town.walkable) < 0)
    return {"there is no ground where a person has room; nobody can visit this town"};
  town.places = places;
  PreparePlaces(&town);
  Visitor visitor;
  TakeStops(stops, {}, &visitor.tour);
  PlaceStops({{}, town, visitor});
  return town.warnings;
}

std::string DoubtOfThinCrowd(const Footprints& footprints, const GroundRaster& ground, const std::vector<Place>& places,
                             int people, float person_radius_m) {
  if (people < kFewest || std::any_of(places.begin(), places.end(), TellsWhereToGo)) return {};
  const Walkable walkable = WalkableTown(footprints, ground, person_radius_m).walkable;
  const int town = LargestComponent(walkable);
  const auto cells = std::count(walkable.component.begin(), walkable.component.end(), town);
  const float area_m2 = static_cast<float>(cells) * walkable.cell_m * walkable.cell_m;
  if (town < 0 || area_m2 < kMostRoom_m2 * static_cast<float>(people)) return {};
  return Compact(std::round(area_m2 / 1e4f)) + " ha to walk on are a lot for " + std::to_string(people) +
         " people: one hardly meets anybody; set places where they go near the tour, or crowd.people: " +
         Compact(std::ceil(area_m2 / kUsualRoom_m2 / 100) * 100) + " make a lively town";
}

}  // namespace flaneur
