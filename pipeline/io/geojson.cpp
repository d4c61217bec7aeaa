#include "pipeline/io/geojson.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "runtime/base/file.h"

namespace flaneur {
namespace {

using Json = nlohmann::json;

// By hand, so that a feature is a line and numbers are short.

std::string Number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.4f", value);
  std::string out = text;
  while (out.back() == '0') out.pop_back();
  if (out.back() == '.') out.pop_back();
  return out == "-0" ? "0" : out;
}

std::string Coordinates(Point2 p) { return "[" + Number(p.x) + "," + Number(p.y) + "]"; }

std::string RingText(const std::vector<Point2>& ring) {
  std::string out = "[";
  for (const Point2& p : ring) out += Coordinates(p) + ",";
  return out + (ring.empty() ? "" : Coordinates(ring[0])) + "]";
}

std::string FeatureText(const Obstacle& o) {
  const bool circle = o.outer.empty();
  std::string out = R"({"type":"Feature","properties":{"name":)" + Json(o.name).dump() + R"(,"kind":")" +
                    ObstacleKindName(o.kind) + R"(","source":)" + Json(o.source).dump() + R"(,"clearance_m":)" +
                    Number(o.clearance_m) + R"(,"ground_z_m":)" + Number(o.ground_z_m);
  if (circle) {
    out += R"(,"radius_m":)" + Number(o.radius_m) + R"(},"geometry":{"type":"Point","coordinates":)";
    return out + Coordinates(o.center) + "}}";
  }
  out += R"(},"geometry":{"type":"Polygon","coordinates":[)" + RingText(o.outer);
  for (const auto& hole : o.holes) out += "," + RingText(hole);
  return out + "]}}";
}

}  // namespace

Error WriteGeoJson(const std::filesystem::path& path, const Footprints& footprints) {
  std::string out = R"({"type":"FeatureCollection","flaneur":{"version":1,"units":"m","clearance_m":)" +
                    Number(footprints.clearance_m) + R"(,"band_m":[)" + Number(footprints.band_m[0]) + "," +
                    Number(footprints.band_m[1]) + R"(],"origin_m":)" + Coordinates(footprints.origin_m) +
                    "},\n\"features\":[\n";
  for (size_t i = 0; i < footprints.obstacles.size(); ++i)
    out += FeatureText(footprints.obstacles[i]) + (i + 1 < footprints.obstacles.size() ? ",\n" : "\n");
  return WriteTextFile(path, out + "]}\n");
}

}  // namespace flaneur
