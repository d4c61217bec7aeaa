#include "pipeline/cli/visit_places.h"

#include "runtime/crowd/constants.h"
#include "runtime/town/places.h"
#include "runtime/walk/guided_tour.h"
#include "runtime/walk/visitor.h"

namespace flaneur {
namespace {

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

}  // namespace

std::vector<std::string> PlacesNobodyReaches(const Footprints& footprints, const GroundRaster& ground,
                                             const std::vector<TourStop>& stops, const std::vector<Place>& places,
                                             float person_radius_m) {
  Town town;
  for (const Obstacle& o : footprints.obstacles) AddObstacle(o, &town.walkable);
  town.walkable.ground = Share(ground);
  BuildWalkable(person_radius_m + kByChoice_m, &town.walkable);
  if (BestFreeCell(town.walkable) < 0)
    return {"there is no ground where a person has room; nobody can visit this town"};
  town.places = places;
  PreparePlaces(&town);
  Visitor visitor;
  TakeStops(stops, {}, &visitor.tour);
  PlaceStops({{}, town, visitor});
  return town.warnings;
}

}  // namespace flaneur
