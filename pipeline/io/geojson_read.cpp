#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "pipeline/io/geojson.h"
#include "pipeline/io/geojson_system.h"
#include "runtime/base/file.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

using Json = nlohmann::json;

constexpr int kMaxCollectionDepth = 8;

// JSON has no infinity and no NaN, but programs write them: nulls stand for them from here on.
std::string WithoutNonNumbers(const std::string& text) {
  std::string out;
  bool in_string = false;
  size_t kept = 0;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string && c == '\\') ++i;
    else if (c == '"') in_string = !in_string;
    else if (!in_string && (c == 'N' || c == 'I')) {
      const std::string_view word = c == 'N' ? "NaN" : "Infinity";
      if (text.compare(i, word.size(), word) != 0) continue;
      const size_t start = i > kept && text[i - 1] == '-' ? i - 1 : i;
      out.append(text, kept, start - kept);
      out += "null";
      i += word.size() - 1;
      kept = i + 1;
    }
  }
  return kept == 0 ? text : out.append(text, kept);
}

bool ReadNumber(const Json& json, double* out) {
  if (json.is_null()) return *out = std::numeric_limits<double>::quiet_NaN(), true;
  if (!json.is_number()) return false;
  *out = json.get<double>();
  return true;
}

bool ReadPair(const Json& json, double* x, double* y) {
  return json.is_array() && json.size() >= 2 && ReadNumber(json[0], x) && ReadNumber(json[1], y);
}

std::string Text(const Json& json) {
  if (json.is_string()) return json.get<std::string>();
  return json.is_number() ? json.dump() : "";
}

const Json& Member(const Json& object, const char* key) {
  static const Json none;
  const auto found = object.is_object() ? object.find(key) : object.end();
  return object.is_object() && found != object.end() ? *found : none;
}

std::string TextOf(const Json& object, const char* key) { return Text(Member(object, key)); }

// Lines of a map that nobody is meant to walk along.
bool IsStreet(const Json& properties) {
  if (!TextOf(properties, "highway").empty())
    return (TextOf(properties, "tunnel").empty() || TextOf(properties, "tunnel") == "no") &&
           !TextOf(properties, "layer").starts_with("-");
  for (const char* other : {"barrier", "waterway", "railway", "power", "boundary", "natural", "landuse", "aerialway"})
    if (properties.is_object() && properties.contains(other)) return false;
  const std::string kind = TextOf(properties, "kind");
  return kind.empty() || kind == "street" || kind == "road" || kind == "way" || kind == "path";
}

class Reader {
 public:
  Reader(std::string file_name, GeoJsonFile* out) : file_name_(std::move(file_name)), out_(out) {}

  Error Read(const Json& root, const ReadGeoJsonOptions& options) {
    const std::string type = TextOf(root, "type");
    if (Error error = ReadMember(root)) return error;
    if (type == "FeatureCollection") {
      if (!Member(root, "features").is_array())
        return Fail(file_name_ + ": a FeatureCollection needs a list 'features'");
      for (const Json& feature : root["features"]) KeepFault(ReadFeature(feature));
    } else if (type == "Feature") {
      KeepFault(ReadFeature(root));
    } else if (root.is_object() && (root.contains("coordinates") || root.contains("geometries"))) {
      KeepFault(ReadFeature({{"type", "Feature"}, {"properties", Json::object()}, {"geometry", root}}));
    } else {
      return Fail(file_name_ + ": not GeoJSON (a FeatureCollection, Feature or geometry)");
    }
    StatedSystem stated;
    stated.units = options.units, stated.system = options.system;
    if (stated.units == GeoJsonUnits::kAuto && stated.system.empty()) {
      const Json& crs = Member(root, "crs");
      if (root.contains("flaneur")) {
        const Json& ours = Member(root, "flaneur");
        stated.local = TextOf(ours, "units") != "deg";
        stated.units = stated.local ? GeoJsonUnits::kMetres : GeoJsonUnits::kDegrees;
        out_->has_origin = !stated.local || ours.contains("origin_m");
      } else if (crs.is_object()) {
        stated.system = TextOf(Member(crs, "properties"), "name");
      }
    }
    if (options.swapped) ForEachPoint(out_, [](Point2& p) { std::swap(p.x, p.y); });
    else if (Error error = FindMisplacement(stated, PlaceOf(root, stated), out_))
      return Fail(file_name_ + ": " + error.message);
    if (Error error = ToLocalMetres(stated, out_)) return Fail(OneLine(file_name_ + ": " + error.message));
    return Ok();
  }

 private:
  StatedPlace PlaceOf(const Json& root, const StatedSystem& stated) {
    StatedPlace place;
    const Json &ours = Member(root, "flaneur"), &box = Member(root, "bbox");
    // The plain order, or with heights between.
    if (box.is_array() && (box.size() == 4 || box.size() == 6))
      for (size_t i = 0; i < 4; ++i) ReadNumber(box[i < 2 ? i : i + box.size() / 2 - 2], &place.box[i]);
    if (const Json& places = Member(ours, "places_deg"); places.is_object())
      for (const auto& [name, at] : places.items())
        if (Point2 p; ReadPair(at, &p.x, &p.y)) place.places_deg.emplace_back(name, p);
    if (root.contains("flaneur") && stated.system.empty())
      place.other_crs = TextOf(Member(Member(root, "crs"), "properties"), "name");
    out_->town_system = TextOf(ours, "town_crs");
    ReadPair(Member(ours, "town_origin_m"), &out_->town_origin_m.x, &out_->town_origin_m.y);
    return place;
  }

  // A broken feature is left out, the others are read all the same.
  void KeepFault(const Error& error) {
    if (error) out_->faults.push_back({GeoJsonFaultKind::kBrokenFeature, where_, OneLine(error.message)});
    ++index_;
  }

  Error ReadMember(const Json& root) {
    const Json& ours = Member(root, "flaneur");
    if (ours.is_null()) return Ok();
    Footprints& f = out_->footprints;
    const auto bad = [&](const char* what) { return Fail(file_name_ + ": member 'flaneur': " + what); };
    if (!ours.is_object()) return bad("must be an object");
    if (ours.contains("clearance_m") && !(ReadNumber(ours["clearance_m"], &f.clearance_m) && f.clearance_m >= 0))
      return bad("'clearance_m' must be a number from 0");
    if (ours.contains("tolerance_m") && !(ReadNumber(ours["tolerance_m"], &f.tolerance_m) && f.tolerance_m >= 0))
      return bad("'tolerance_m' must be a number from 0");
    if (ours.contains("band_m") && !(ReadPair(ours["band_m"], &f.band_m[0], &f.band_m[1]) && f.band_m[0] < f.band_m[1]))
      return bad("'band_m' must be two ascending numbers");
    if (ours.contains("origin_m") && !ReadPair(ours["origin_m"], &f.origin_m.x, &f.origin_m.y))
      return bad("'origin_m' must be two numbers");
    f.reference_system = TextOf(ours, "crs");
    return Ok();
  }

  Error ReadFeature(const Json& feature) {
    where_ = "feature_" + std::to_string(index_);
    if (TextOf(feature, "type") != "Feature") return Fail("not a Feature");
    const Json& properties = Member(feature, "properties");
    Obstacle blank;
    if (Error error = ReadProperties(feature, properties, &blank)) return error;
    where_ = blank.name;
    return ReadGeometry(blank, properties, Member(feature, "geometry"), 0);
  }

  Error ReadGeometry(const Obstacle& blank, const Json& properties, const Json& geometry, int depth) {
    if (geometry.is_null()) return ++out_->skipped, Ok();
    if (!geometry.is_object()) return Fail("'geometry' must be an object");
    const std::string type = TextOf(geometry, "type");
    const Json& coordinates = Member(geometry, "coordinates");
    if (type == "Polygon") return ReadPolygon(blank, coordinates);
    if (type == "MultiPolygon") return ReadEach(coordinates, [&](const Json& j) { return ReadPolygon(blank, j); });
    if (type == "Point") return ReadCircle(blank, properties, coordinates);
    if (type == "LineString") return ReadWay(blank, properties, coordinates);
    if (type == "MultiLineString")
      return ReadEach(coordinates, [&](const Json& j) { return ReadWay(blank, properties, j); });
    if (type == "GeometryCollection" && depth < kMaxCollectionDepth)
      return ReadEach(Member(geometry, "geometries"),
                      [&](const Json& j) { return ReadGeometry(blank, properties, j, depth + 1); });
    if (type == "MultiPoint") return ++out_->skipped, Ok();
    return Fail("geometry of an unknown type '" + type + "'");
  }

  template <typename Function>
  static Error ReadEach(const Json& list, const Function& read) {
    if (!list.is_array()) return Fail("coordinates must be a list");
    for (const Json& part : list)
      if (Error error = read(part)) return error;
    return Ok();
  }

  Error ReadProperties(const Json& feature, const Json& properties, Obstacle* o) {
    o->name = TextOf(properties, "name");
    if (o->name.empty()) o->name = TextOf(feature, "id");
    for (const char* key : {"osm_id", "osm_way", "gml_id", "id"})
      if (o->name.empty()) o->name = TextOf(properties, key);
    if (o->name.empty()) o->name = where_;
    o->source = TextOf(properties, "source");
    o->clearance_m = out_->footprints.clearance_m;
    for (const auto& [key, value] : {std::pair{"clearance_m", &o->clearance_m}, {"ground_z_m", &o->ground_z_m}})
      if (!Member(properties, key).is_null() && !ReadNumber(properties[key], value))
        return Fail(std::string("'") + key + "' must be a number");
    o->open_shell = Member(properties, "open_shell") == true;
    const std::string kind = TextOf(properties, "kind");
    for (const ObstacleKind k :
         {ObstacleKind::kBuilding, ObstacleKind::kWall, ObstacleKind::kTree, ObstacleKind::kLamp, ObstacleKind::kOther})
      if (kind == ObstacleKindName(k)) o->kind = k;
    return Ok();
  }

  static Error ReadPoints(const Json& list, const std::string& name, std::vector<Point2>* points) {
    if (!list.is_array()) return Fail(name + " must be a list of points");
    for (const Json& point : list) {
      Point2 p;
      if (!ReadPair(point, &p.x, &p.y))
        return Fail("point " + std::to_string(points->size()) + " of " + name + " must be two numbers");
      points->push_back(p);
    }
    return Ok();
  }

  Error ReadPolygon(const Obstacle& blank, const Json& rings) {
    if (!rings.is_array()) return Fail("a polygon's coordinates must be a list of rings");
    Obstacle o = blank;
    std::vector<int> open;
    if (rings.empty()) open.push_back(0);
    for (size_t i = 0; i < rings.size(); ++i) {
      std::vector<Point2> ring;
      if (Error error = ReadPoints(rings[i], "ring " + std::to_string(i), &ring)) return error;
      const bool closed = ring.size() > 1 && ring.front().x == ring.back().x && ring.front().y == ring.back().y;
      if (closed) ring.pop_back();
      else open.push_back(static_cast<int>(i));
      if (i == 0) o.outer = std::move(ring);
      else o.holes.push_back(std::move(ring));
    }
    Add(std::move(o), std::move(open));
    return Ok();
  }

  // A tree or lamp without a radius is an obstacle to be found fault with; any other point is none.
  Error ReadCircle(const Obstacle& blank, const Json& properties, const Json& coordinates) {
    const std::string kind = TextOf(properties, "kind");
    if (kind == "door" || kind == "exit" || kind == "spawn") {
      GatePoint place{blank.name, {}, kind == "exit"};
      if (!ReadPair(coordinates, &place.at.x, &place.at.y)) return Fail("a point's coordinates must be two numbers");
      return out_->places.push_back(std::move(place)), Ok();
    }
    Obstacle o = blank;
    const Json& radius = Member(properties, "radius_m");
    const bool asked = properties.is_object() && properties.contains("radius_m");
    if (!asked && o.kind != ObstacleKind::kTree && o.kind != ObstacleKind::kLamp) return ++out_->skipped, Ok();
    o.radius_m = radius.is_number() ? radius.get<double>() : std::numeric_limits<double>::quiet_NaN();
    if (!ReadPair(coordinates, &o.center.x, &o.center.y)) return Fail("a point's coordinates must be two numbers");
    Add(std::move(o), {});
    return Ok();
  }

  Error ReadWay(const Obstacle& blank, const Json& properties, const Json& coordinates) {
    if (!IsStreet(properties)) return ++out_->skipped, Ok();
    Way way{blank.name, {}};
    if (Error error = ReadPoints(coordinates, "a line", &way.points)) return error;
    out_->ways.push_back(std::move(way));
    return Ok();
  }

  void Add(Obstacle o, std::vector<int> open) {
    const std::string wish = o.name;
    for (int i = ++repeats_[wish]; !names_.insert(o.name).second; i = ++repeats_[wish])
      o.name = wish + "_" + std::to_string(i);
    out_->footprints.obstacles.push_back(std::move(o));
    out_->open_rings.push_back(std::move(open));
  }

  std::string file_name_, where_;
  GeoJsonFile* out_;
  int index_ = 0;
  std::set<std::string> names_;
  std::map<std::string, int> repeats_;
};

}  // namespace

Error ReadGeoJson(const std::filesystem::path& path, const ReadGeoJsonOptions& options, GeoJsonFile* file) {
  std::string text;
  if (Error error = ReadTextFile(path, &text)) return error;
  *file = {};
  if (NestsTooDeep(text)) return Fail(path.string() + ": " + kNestsTooDeep);
  file->footprints.clearance_m = 0;  // unless the file says so
  try {
    return Reader(path.string(), file).Read(Json::parse(WithoutNonNumbers(text)), options);
  } catch (const Json::exception& exception) {
    return Fail(path.string() + ": not valid JSON: " + PlainJsonError(exception.what()));
  }
}

}  // namespace flaneur
