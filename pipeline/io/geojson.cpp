#include "pipeline/io/geojson.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "runtime/base/file.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

using Json = nlohmann::json;

constexpr double kFarFromOrigin_m = 10'000;  // coordinates further away are moved near zero

// ---- Writing: by hand, so that a feature is a line and numbers are short. ----

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

// ---- Reading ----

class Reader {
 public:
  Reader(std::string file_name, GeoJsonFile* out) : file_name_(std::move(file_name)), out_(out) {}

  Error Read(const Json& root, const ReadGeoJsonOptions& options) {
    if (!root.is_object() || root.value("type", Json()) != "FeatureCollection" || !root.contains("features") ||
        !root["features"].is_array())
      return Fail(file_name_ + ": not a GeoJSON FeatureCollection");
    if (Error error = ReadMember(root)) return error;
    size_t index = 0;
    for (const Json& feature : root["features"]) {
      where_ = "feature " + std::to_string(index++);
      if (Error error = ReadFeature(feature)) return error;
    }
    if (IsDegrees(root, options)) ProjectDegrees();
    else MoveNearZero();
    return Ok();
  }

 private:
  Error Bad(const std::string& what) const { return Fail(OneLine(file_name_ + ": " + where_ + ": " + what)); }

  Error ReadMember(const Json& root) {
    if (!root.contains("flaneur")) return Ok();
    where_ = "member 'flaneur'";
    const Json& ours = root["flaneur"];
    if (!ours.is_object()) return Bad("must be an object");
    Footprints& f = out_->footprints;
    if (ours.contains("clearance_m") && !ReadNumber(ours["clearance_m"], &f.clearance_m))
      return Bad("'clearance_m' must be a number");
    if (ours.contains("band_m") && !ReadPair(ours["band_m"], &f.band_m[0], &f.band_m[1]))
      return Bad("'band_m' must be two numbers");
    if (ours.contains("origin_m") && !ReadPair(ours["origin_m"], &f.origin_m.x, &f.origin_m.y))
      return Bad("'origin_m' must be two numbers");
    return Ok();
  }

  // JSON has no infinity and no NaN; nulls stand for them.
  static bool ReadNumber(const Json& json, double* out) {
    if (json.is_null()) return *out = std::numeric_limits<double>::quiet_NaN(), true;
    if (!json.is_number()) return false;
    *out = json.get<double>();
    return true;
  }
  static bool ReadPair(const Json& json, double* x, double* y) {
    return json.is_array() && json.size() >= 2 && ReadNumber(json[0], x) && ReadNumber(json[1], y);
  }

  Error ReadFeature(const Json& feature) {
    if (!feature.is_object() || feature.value("type", Json()) != "Feature") return Bad("not a Feature");
    const Json properties = feature.contains("properties") && feature["properties"].is_object() ? feature["properties"]
                                                                                               : Json::object();
    Obstacle blank;
    if (Error error = ReadProperties(feature, properties, &blank)) return error;
    if (!feature.contains("geometry") || !feature["geometry"].is_object()) return ++out_->skipped, Ok();
    const Json& geometry = feature["geometry"];
    const std::string type = geometry.value("type", "");
    const Json coordinates = geometry.contains("coordinates") ? geometry["coordinates"] : Json();
    if (type == "Polygon") return ReadPolygon(blank, coordinates);
    if (type == "Point" && properties.contains("radius_m")) return ReadCircle(blank, properties, coordinates);
    if (type != "MultiPolygon") return ++out_->skipped, Ok();
    if (!coordinates.is_array()) return Bad("coordinates must be a list of polygons");
    for (const Json& polygon : coordinates)
      if (Error error = ReadPolygon(blank, polygon)) return error;
    return Ok();
  }

  static std::string Text(const Json& json) {
    if (json.is_string()) return json.get<std::string>();
    return json.is_number() ? json.dump() : "";
  }

  Error ReadProperties(const Json& feature, const Json& properties, Obstacle* o) {
    const auto text = [&](const char* key) {
      return properties.contains(key) ? Text(properties[key]) : std::string();
    };
    o->name = text("name");
    if (o->name.empty() && feature.contains("id")) o->name = Text(feature["id"]);
    if (o->name.empty()) o->name = text("osm_id");
    if (o->name.empty()) o->name = "obstacle_" + std::to_string(out_->footprints.obstacles.size());
    o->source = text("source");
    o->clearance_m = out_->footprints.clearance_m;
    for (const auto& [key, value] : {std::pair{"clearance_m", &o->clearance_m}, {"ground_z_m", &o->ground_z_m}})
      if (properties.contains(key) && !ReadNumber(properties[key], value))
        return Bad(std::string("'") + key + "' must be a number");
    const std::string kind = text("kind");
    for (const ObstacleKind k : {ObstacleKind::kBuilding, ObstacleKind::kWall, ObstacleKind::kTree,
                                 ObstacleKind::kLamp, ObstacleKind::kOther})
      if (kind == ObstacleKindName(k)) o->kind = k;
    return Ok();
  }

  Error ReadPolygon(const Obstacle& blank, const Json& rings) {
    if (!rings.is_array()) return Bad("a polygon's coordinates must be a list of rings");
    Obstacle o = blank;
    std::vector<int> open;
    for (size_t i = 0; i < rings.size(); ++i) {
      if (!rings[i].is_array()) return Bad("ring " + std::to_string(i) + " must be a list of points");
      std::vector<Point2> ring;
      for (const Json& point : rings[i]) {
        Point2 p;
        if (!ReadPair(point, &p.x, &p.y))
          return Bad("point " + std::to_string(ring.size()) + " of ring " + std::to_string(i) + " must be two numbers");
        ring.push_back(p);
      }
      const bool closed = ring.size() > 1 && ring.front().x == ring.back().x && ring.front().y == ring.back().y;
      if (closed) ring.pop_back();
      else open.push_back(static_cast<int>(i));
      if (i == 0) o.outer = std::move(ring);
      else o.holes.push_back(std::move(ring));
    }
    Add(std::move(o), std::move(open));
    return Ok();
  }

  Error ReadCircle(const Obstacle& blank, const Json& properties, const Json& coordinates) {
    Obstacle o = blank;
    if (!ReadNumber(properties["radius_m"], &o.radius_m)) return Bad("'radius_m' must be a number");
    if (!ReadPair(coordinates, &o.center.x, &o.center.y)) return Bad("a point's coordinates must be two numbers");
    Add(std::move(o), {});
    return Ok();
  }

  void Add(Obstacle o, std::vector<int> open) {
    const std::string wish = o.name;
    for (int i = 2; !names_.insert(o.name).second; ++i) o.name = wish + "_" + std::to_string(i);
    out_->footprints.obstacles.push_back(std::move(o));
    out_->open_rings.push_back(std::move(open));
  }

  template <typename Function>
  void ForEachPoint(const Function& function) {
    for (Obstacle& o : out_->footprints.obstacles) {
      for (Point2& p : o.outer) function(p);
      for (auto& hole : o.holes)
        for (Point2& p : hole) function(p);
      if (o.outer.empty()) function(o.center);
    }
  }

  bool IsDegrees(const Json& root, const ReadGeoJsonOptions& options) {
    if (options.units != GeoJsonUnits::kAuto) return options.units == GeoJsonUnits::kDegrees;
    if (root.contains("flaneur")) return false;
    if (root.contains("crs")) return root["crs"].dump().find("CRS84") != std::string::npos ||
                                     root["crs"].dump().find("4326") != std::string::npos;
    bool degrees = true;
    ForEachPoint([&](Point2& p) { degrees &= !(std::abs(p.x) > 180 || std::abs(p.y) > 90); });
    return degrees;
  }

  Point2 Middle() {
    Point2 min{1e300, 1e300}, max{-1e300, -1e300};
    ForEachPoint([&](Point2& p) {
      if (!std::isfinite(p.x) || !std::isfinite(p.y)) return;
      min = {std::min(min.x, p.x), std::min(min.y, p.y)}, max = {std::max(max.x, p.x), std::max(max.y, p.y)};
    });
    return min.x > max.x ? Point2{} : Point2{(min.x + max.x) / 2, (min.y + max.y) / 2};
  }

  // On the plane that touches the WGS 84 ellipsoid in the middle: true to 1 mm in 100 m over a town of 2 km.
  void ProjectDegrees() {
    const Point2 middle = Middle();
    const double a = 6378137, e2 = 0.00669437999014, radian = 3.14159265358979323846 / 180;
    const double s = std::sin(middle.y * radian), w = std::sqrt(1 - e2 * s * s);
    const double north = a * (1 - e2) / (w * w * w) * radian;
    const double east = a / w * std::cos(middle.y * radian) * radian;
    ForEachPoint([&](Point2& p) { p = {(p.x - middle.x) * east, (p.y - middle.y) * north}; });
    out_->degrees = true;
    out_->footprints.origin_m = middle;
  }

  void MoveNearZero() {
    const Point2 middle = Middle();
    if (std::abs(middle.x) < kFarFromOrigin_m && std::abs(middle.y) < kFarFromOrigin_m) return;
    if (std::abs(middle.x) > 1e8 || std::abs(middle.y) > 1e8) return;
    const Point2 move{std::floor(middle.x / 1000) * 1000, std::floor(middle.y / 1000) * 1000};
    ForEachPoint([&](Point2& p) { p = {p.x - move.x, p.y - move.y}; });
    out_->footprints.origin_m = {out_->footprints.origin_m.x + move.x, out_->footprints.origin_m.y + move.y};
  }

  std::string file_name_, where_;
  GeoJsonFile* out_;
  std::set<std::string> names_;
};

}  // namespace

Error ReadGeoJson(const std::filesystem::path& path, const ReadGeoJsonOptions& options, GeoJsonFile* file) {
  std::string text;
  if (Error error = ReadTextFile(path, &text)) return error;
  *file = {};
  file->footprints.clearance_m = 0;  // unless the file says so
  try {
    return Reader(path.string(), file).Read(Json::parse(text), options);
  } catch (const Json::exception& exception) {
    return Fail(path.string() + ": not valid JSON: " + PlainJsonError(exception.what()));
  }
}

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
