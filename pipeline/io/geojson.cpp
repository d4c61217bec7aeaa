#include "pipeline/io/geojson.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "pipeline/io/map_projection.h"
#include "runtime/base/file.h"

namespace flaneur {
namespace {

using Json = nlohmann::json;

// By hand, so that a feature is a line and numbers are short.

constexpr size_t kPlaces = 5;                           // of obstacles that the collection names in degrees too
constexpr int kMetreDecimals = 4, kDegreeDecimals = 9;  // 0.1 mm

std::string Number(double value, int decimals = kMetreDecimals) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  std::string out = text;
  while (out.back() == '0') out.pop_back();
  if (out.back() == '.') out.pop_back();
  return out == "-0" ? "0" : out;
}

std::string Coordinates(Point2 p, int decimals = kMetreDecimals) {
  return "[" + Number(p.x, decimals) + "," + Number(p.y, decimals) + "]";
}

std::string RingText(const std::vector<Point2>& ring, int decimals) {
  std::string out = "[";
  for (const Point2& p : ring) out += Coordinates(p, decimals) + ",";
  return out + (ring.empty() ? "" : Coordinates(ring[0], decimals)) + "]";
}

std::string FeatureText(const Obstacle& o, int decimals) {
  const bool circle = o.outer.empty();
  std::string out = R"({"type":"Feature","properties":{"name":)" + Json(o.name).dump() + R"(,"kind":")" +
                    ObstacleKindName(o.kind) + R"(","source":)" + Json(o.source).dump() + R"(,"clearance_m":)" +
                    Number(o.clearance_m) + R"(,"ground_z_m":)" + Number(o.ground_z_m);
  if (o.open_shell) out += R"(,"open_shell":true)";
  if (circle) {
    out += R"(,"radius_m":)" + Number(o.radius_m) + R"(},"geometry":{"type":"Point","coordinates":)";
    return out + Coordinates(o.center, decimals) + "}}";
  }
  out += R"(},"geometry":{"type":"Polygon","coordinates":[)" + RingText(o.outer, decimals);
  for (const auto& hole : o.holes) out += "," + RingText(hole, decimals);
  return out + "]}}";
}

// `members` of the collection, then `place` within our own.
std::string CollectionText(const std::string& units, const std::string& members, const std::string& place,
                           const Footprints& footprints, int decimals) {
  std::string out = R"({"type":"FeatureCollection",)" + members + R"("flaneur":{"version":1,"units":")" + units +
                    R"(","clearance_m":)" + Number(footprints.clearance_m) +
                    (footprints.tolerance_m > 0 ? R"(,"tolerance_m":)" + Number(footprints.tolerance_m) : "") +
                    R"(,"band_m":[)" + Number(footprints.band_m[0]) + "," + Number(footprints.band_m[1]) + "]" + place +
                    "},\n\"features\":[\n";
  for (size_t i = 0; i < footprints.obstacles.size(); ++i)
    out += FeatureText(footprints.obstacles[i], decimals) + (i + 1 < footprints.obstacles.size() ? ",\n" : "\n");
  return out + "]}\n";
}

// Where some obstacles' first points lie on earth, so that a wrong crs or origin_m shows itself.
std::string PlacesOnEarth(const Footprints& footprints) {
  const std::vector<Obstacle>& all = footprints.obstacles;
  std::vector<std::string> names;
  std::vector<Point2> places;
  for (size_t k = 0; k < kPlaces && !all.empty(); ++k) {
    const Obstacle& o = all[k * (all.size() - 1) / (kPlaces - 1)];
    if (!names.empty() && names.back() == o.name) continue;
    const Point2 p = o.outer.empty() ? o.center : o.outer[0];
    names.push_back(o.name);
    places.push_back({p.x + footprints.origin_m.x, p.y + footprints.origin_m.y});
  }
  if (footprints.reference_system.empty() || names.empty() ||
      TransformPoints(footprints.reference_system, kLongitudeLatitude, &places))
    return {};
  std::string out;
  for (size_t i = 0; i < names.size(); ++i) {
    if (!std::isfinite(places[i].x)) return {};
    out += (i > 0 ? "," : "") + Json(names[i]).dump() + ":" + Coordinates(places[i], kDegreeDecimals);
  }
  return R"(,"places_deg":{)" + out + "}";
}

std::string BoxText(const std::vector<Point2*>& points) {
  if (points.empty()) return {};
  Point2 min = *points[0], max = min;
  for (const Point2* p : points) {
    min = {std::min(min.x, p->x), std::min(min.y, p->y)};
    max = {std::max(max.x, p->x), std::max(max.y, p->y)};
  }
  std::string out = R"("bbox":[)";
  for (const double v : {min.x, min.y, max.x, max.y}) out += Number(v, kDegreeDecimals) + ",";
  out.back() = ']';
  return out + ",";
}

Error ToLongitudeLatitude(const Footprints& footprints, std::vector<Point2*> points) {
  std::vector<Point2> moved;
  for (const Point2* p : points) moved.push_back({p->x + footprints.origin_m.x, p->y + footprints.origin_m.y});
  if (Error error = CheckMapPlace(footprints.reference_system, moved.empty() ? footprints.origin_m : moved[0]))
    return error;
  if (Error error = TransformPoints(footprints.reference_system, kLongitudeLatitude, &moved)) return error;
  for (size_t i = 0; i < points.size(); ++i) *points[i] = moved[i];
  return Ok();
}

}  // namespace

Error WriteGeoJson(const std::filesystem::path& path, const Footprints& footprints, const std::string& source_system) {
  std::string origin = R"(,"origin_m":)" + Coordinates(footprints.origin_m);
  if (!footprints.reference_system.empty()) origin += R"(,"crs":)" + Json(footprints.reference_system).dump();
  if (!source_system.empty()) origin += R"(,"source_crs":)" + Json(source_system).dump();
  return WriteTextFile(path, CollectionText("m", "", origin + PlacesOnEarth(footprints), footprints, kMetreDecimals));
}

Error WriteLongitudeLatitude(const std::filesystem::path& path, const Footprints& footprints) {
  Footprints on_earth = footprints;
  std::vector<Point2*> points;
  for (Obstacle& o : on_earth.obstacles) {
    for (Point2& p : o.outer) points.push_back(&p);
    for (auto& hole : o.holes)
      for (Point2& p : hole) points.push_back(&p);
    if (o.outer.empty()) points.push_back(&o.center);
  }
  if (Error error = ToLongitudeLatitude(footprints, points)) return error;
  const std::string town = R"(,"town_crs":)" + Json(footprints.reference_system).dump() + R"(,"town_origin_m":)" +
                           Coordinates(footprints.origin_m);
  return WriteTextFile(path, CollectionText("deg", BoxText(points), town, on_earth, kDegreeDecimals));
}

}  // namespace flaneur
