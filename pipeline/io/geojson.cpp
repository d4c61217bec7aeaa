#include "pipeline/io/geojson.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "pipeline/io/map_projection.h"
#include "runtime/base/file.h"

namespace flaneur {
namespace {

using Json = nlohmann::json;

// By hand, so that a feature is a line and numbers are short.

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

std::string CollectionText(const std::string& units, const std::string& origin, const Footprints& footprints,
                           int decimals) {
  std::string out = R"({"type":"FeatureCollection","flaneur":{"version":1,"units":")" + units + R"(","clearance_m":)" +
                    Number(footprints.clearance_m) + R"(,"band_m":[)" + Number(footprints.band_m[0]) + "," +
                    Number(footprints.band_m[1]) + "]" + origin + "},\n\"features\":[\n";
  for (size_t i = 0; i < footprints.obstacles.size(); ++i)
    out += FeatureText(footprints.obstacles[i], decimals) + (i + 1 < footprints.obstacles.size() ? ",\n" : "\n");
  return out + "]}\n";
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

Error WriteGeoJson(const std::filesystem::path& path, const Footprints& footprints) {
  std::string origin = R"(,"origin_m":)" + Coordinates(footprints.origin_m);
  if (!footprints.reference_system.empty()) origin += R"(,"crs":)" + Json(footprints.reference_system).dump();
  return WriteTextFile(path, CollectionText("m", origin, footprints, kMetreDecimals));
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
  return WriteTextFile(path, CollectionText("deg", "", on_earth, kDegreeDecimals));
}

}  // namespace flaneur
