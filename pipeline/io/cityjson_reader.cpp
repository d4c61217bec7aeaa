#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string_view>

#include "pipeline/io/city_objects.h"
#include "pipeline/io/scene_reader.h"
#include "pipeline/io/town_builder.h"
#include "pipeline/io/town_points.h"
#include "runtime/base/file.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

using Json = nlohmann::json;
using Rings = std::vector<std::vector<Point3>>;

struct Transform {
  Point3 scale{1, 1, 1}, translate;
};

// Of a template: a matrix row by row, then a point.
struct Place {
  std::array<double, 16> matrix{};
  Point3 at;
};

Point3 Placed(const Point3& p, const Place& place) {
  const std::array<double, 16>& m = place.matrix;
  const auto row = [&](size_t i) { return m[i] * p.x + m[i + 1] * p.y + m[i + 2] * p.z + m[i + 3]; };
  return {row(0) + place.at.x, row(4) + place.at.y, row(8) + place.at.z};
}

// Nesting of surfaces in a geometry's boundaries: a MultiSurface is a list of surfaces, a Solid a list of shells, ...
int DepthOf(const std::string& type) {
  if (type == "MultiSurface" || type == "CompositeSurface") return 0;
  if (type == "Solid") return 1;
  if (type == "MultiSolid" || type == "CompositeSolid") return 2;
  return -1;
}

class Reader {
 public:
  Reader(const std::filesystem::path& path, std::vector<std::string>* warnings, const ReadSceneOptions& options,
         SceneSource* source)
      : path_(path), warnings_(warnings), options_(options), source_(*source) {}

  Error Read(Scene* scene) {
    std::string text;
    if (Error e = ReadTextFile(path_, &text)) return e;
    if (NestsTooDeep(text)) return Bad(kNestsTooDeep);
    left_ = TownPoints(text.size());
    // A sequence has a document a line; a document of its own may also be printed over many lines.
    const size_t end = text.find('\n');
    Json first = Json::parse(text.substr(0, end), nullptr, false);
    if (end != std::string::npos && first.is_object() && IsSequence(std::string_view(text).substr(end))) {
      if (Error e = ReadSequence(first, text, end + 1)) return e;
    } else {
      if (first.is_discarded()) first = Json::parse(text);
      text = {};
      if (Error e = ReadHead(first)) return e;
      if (Error e = ReadVertices(first)) return e;
      if (Error e = ReadObjects(first)) return e;
    }
    if (!options_.system.empty()) reference_system_ = PlainReferenceSystem(options_.system);
    return builder_.Finish(path_.string(), {reference_system_, false}, scene, &source_.system, warnings_);
  }

 private:
  Error Bad(const std::string& why) const { return Fail(OneLine(path_.string() + ": " + where_ + why)); }

  static bool IsSequence(std::string_view rest) { return rest.find_first_not_of(" \t\r\n") != std::string_view::npos; }

  Error ReadSequence(const Json& head, const std::string& text, size_t at) {
    if (Error e = ReadHead(head)) return e;
    if (Error e = ReadVertices(head)) return e;
    if (Error e = ReadObjects(head)) return e;
    for (size_t line = 2; at < text.size(); ++line) {
      const size_t end = std::min(text.find('\n', at), text.size());
      where_ = "line " + std::to_string(line) + ": ";
      const std::string_view one = std::string_view(text).substr(at, end - at);
      at = end + 1;
      if (!IsSequence(one)) continue;
      const Json feature = Json::parse(one.begin(), one.end(), nullptr, false);
      if (feature.is_discarded()) return Bad("not valid JSON");
      if (!feature.is_object() || feature.value("type", Json()) != "CityJSONFeature")
        return Bad("not a CityJSONFeature");
      if (Error e = ReadVertices(feature)) return e;
      if (Error e = ReadObjects(feature)) return e;
    }
    return Ok();
  }

  Error ReadHead(const Json& root) {
    if (!root.is_object() || root.value("type", Json()) != "CityJSON") return Bad("not a CityJSON file");
    const std::string version =
        root.contains("version") && root["version"].is_string() ? root["version"].get<std::string>() : "";
    if (version.rfind("1.", 0) != 0 && version.rfind("2.0", 0) != 0)
      return Bad("CityJSON 1.0 to 2.0 is understood, not version '" + version + "'");
    if (root.contains("transform")) {
      const Json& transform = root["transform"];
      if (!transform.is_object() || !ReadPoint(transform.value("scale", Json()), &transform_.scale) ||
          !ReadPoint(transform.value("translate", Json()), &transform_.translate))
        return Bad("'transform' needs 'scale' and 'translate' of three numbers each");
    }
    const Json metadata = root.value("metadata", Json::object());
    if (metadata.is_object() && metadata.contains("referenceSystem") && metadata["referenceSystem"].is_string())
      reference_system_ = PlainReferenceSystem(metadata["referenceSystem"].get<std::string>());
    return ReadTemplates(root);
  }

  static bool ReadPoint(const Json& json, Point3* p) {
    if (!json.is_array() || json.size() < 3) return false;
    for (size_t i = 0; i < 3; ++i)
      if (!json[i].is_number()) return false;
    *p = {json[0].get<double>(), json[1].get<double>(), json[2].get<double>()};
    return std::isfinite(p->x) && std::isfinite(p->y) && std::isfinite(p->z);
  }

  Error ReadPoints(const Json& json, const char* what, const Transform& transform, std::vector<Point3>* points) {
    if (!json.is_array()) return Bad(std::string("'") + what + "' must be a list");
    points->clear();
    points->reserve(json.size());
    for (const Json& each : json) {
      Point3 p;
      if (!ReadPoint(each, &p))
        return Bad(std::string(what) + " " + std::to_string(points->size()) + " is not three numbers");
      const auto& [s, t] = transform;
      points->push_back({p.x * s.x + t.x, p.y * s.y + t.y, p.z * s.z + t.z});
    }
    return Ok();
  }

  Error ReadVertices(const Json& root) {
    if (!root.contains("vertices")) return Bad("has no 'vertices'");
    return ReadPoints(root["vertices"], "vertices", transform_, &vertices_);
  }

  Error ReadTemplates(const Json& root) {
    if (!root.contains("geometry-templates")) return Ok();
    const Json& templates = root["geometry-templates"];
    if (!templates.is_object()) return Bad("'geometry-templates' must be an object");
    templates_ = templates.value("templates", Json::array());
    return ReadPoints(templates.value("vertices-templates", Json::array()), "vertices-templates", {},
                      &template_vertices_);
  }

  Error ReadObjects(const Json& root) {
    const std::string outer = where_;
    const auto found = root.find("CityObjects");
    if (found == root.end() || !found->is_object()) return Bad("has no 'CityObjects'");
    const Json& objects = *found;
    std::map<std::string, int> nodes;
    for (const auto& [id, object] : objects.items()) {
      where_ = outer + "'" + id + "': ";
      if (!object.is_object()) return Bad("must be an object");
      const std::string type = TypeOf(object);
      if (IsIndoors(type)) continue;
      const CityFeature* feature = FeatureOf(type);
      if (!feature) continue;
      const std::string root_id = feature->is_part ? RootOf(objects, id) : id;
      const CityFeature* root_feature = root_id == id ? feature : FeatureOf(TypeOf(objects[root_id]));
      if (!root_feature) root_feature = feature;
      if (!nodes.contains(root_id))
        nodes[root_id] = builder_.AddNode(root_id, root_feature->kind, root_feature->ground);
      if (root_feature->is_bridge || HasBridgeFunction(object)) builder_.MarkBridge(nodes[root_id]);
      const bool has_finer_parts = root_id == id && LevelOf(object) < FinestPart(objects, object);
      if (has_finer_parts) continue;
      if (Error e = ReadGeometry(object, nodes[root_id], *root_feature)) return e;
    }
    where_ = outer;
    return Ok();
  }

  static bool HasBridgeFunction(const Json& object) {
    const auto attributes = object.find("attributes");
    if (attributes == object.end() || !attributes->is_object()) return false;
    const Json function = attributes->value("function", Json());
    const auto is_bridge = [](const Json& f) { return f.is_string() && IsBridgeFunction(f.get<std::string>()); };
    return is_bridge(function) || (function.is_array() && std::any_of(function.begin(), function.end(), is_bridge));
  }

  static std::string TypeOf(const Json& object) {
    return object.is_object() && object.contains("type") && object["type"].is_string()
               ? object["type"].get<std::string>()
               : "";
  }
  static const CityFeature* FeatureOf(const std::string& type) {
    if (const CityFeature* feature = FindCityFeature(type)) return feature;
    return type.rfind('+', 0) == 0 ? FindCityFeature("GenericCityObject") : nullptr;  // an extension's
  }

  // Parents may be missing or stand in a circle.
  static std::string RootOf(const Json& objects, std::string id) {
    for (int generation = 0; generation < 16; ++generation) {
      const Json& object = objects[id];
      const auto parents = object.find("parents");
      if (parents == object.end() || !parents->is_array() || parents->empty() || !(*parents)[0].is_string()) return id;
      const std::string parent = (*parents)[0];
      if (!objects.contains(parent) || !objects[parent].is_object()) return id;
      id = parent;
    }
    return id;
  }

  static double LevelOfGeometry(const Json& geometry) {
    const Json lod = geometry.is_object() ? geometry.value("lod", Json("0")) : Json("0");
    const double level = lod.is_number()   ? lod.get<double>()
                         : lod.is_string() ? std::atof(lod.get<std::string>().c_str())
                                           : 0;
    return level >= 4 ? 0.5 : level;  // about interiors: only where there is no other
  }
  static double LevelOf(const Json& object) {
    double finest = 0;
    const auto geometries = object.find("geometry");
    if (geometries != object.end() && geometries->is_array())
      for (const Json& geometry : *geometries) finest = std::max(finest, LevelOfGeometry(geometry));
    return finest;
  }
  static double FinestPart(const Json& objects, const Json& object) {
    double finest = 0;
    const auto children = object.find("children");
    if (children == object.end() || !children->is_array()) return 0;
    std::set<std::string> seen;  // one child may be named many times
    for (const Json& child : *children) {
      if (!child.is_string() || !seen.insert(child.get<std::string>()).second) continue;
      const auto part = objects.find(child.get<std::string>());
      if (part != objects.end() && FeatureOf(TypeOf(*part))) finest = std::max(finest, LevelOf(*part));
    }
    return finest;
  }

  Error ReadGeometry(const Json& object, int node, const CityFeature& feature) {
    const auto geometries = object.find("geometry");
    if (geometries == object.end() || !geometries->is_array()) return Ok();
    const double finest = LevelOf(object);
    node_ = node, feature_ = feature;
    for (const Json& geometry : *geometries) {
      if (!geometry.is_object()) return Bad("a geometry must be an object");
      const bool is_instance = geometry.value("type", Json()) == "GeometryInstance";
      const bool is_outline =
          finest == 0 && feature.kind != NodeKind::kGround;  // of what lies on the ground it says where
      if (!is_instance && (is_outline || LevelOfGeometry(geometry) != finest)) continue;
      if (Error e = is_instance ? ReadInstance(geometry) : ReadShape(geometry, vertices_)) return e;
    }
    return Ok();
  }

  Error ReadInstance(const Json& instance) {
    const Json which = instance.value("template", Json()), where = instance.value("boundaries", Json());
    const Json matrix = instance.value("transformationMatrix", Json());
    if (!which.is_number_unsigned() || which.get<size_t>() >= templates_.size())
      return Bad("its template is none of the file's");
    if (!where.is_array() || where.empty() || !where[0].is_number_unsigned() ||
        where[0].get<size_t>() >= vertices_.size())
      return Bad("its place is none of the vertices");
    if (!matrix.is_array() || matrix.size() != 16) return Bad("its transformationMatrix needs 16 numbers");
    Place place;
    for (size_t i = 0; i < 16; ++i) {
      if (!matrix[i].is_number()) return Bad("its transformationMatrix needs 16 numbers");
      place.matrix[i] = matrix[i].get<double>();
    }
    place.at = vertices_[where[0].get<size_t>()];
    place_ = place;
    const Error error = ReadShape(templates_[which.get<size_t>()], template_vertices_);
    place_.reset();
    return error;
  }

  Error ReadShape(const Json& geometry, const std::vector<Point3>& points) {
    if (!geometry.is_object()) return Bad("a geometry must be an object");
    const int depth = DepthOf(geometry.value("type", ""));
    if (depth < 0) return Ok();  // points and lines block nobody
    const auto boundaries = geometry.find("boundaries");
    if (boundaries == geometry.end()) return Bad("a geometry has no 'boundaries'");
    const Json none;
    const auto semantics = geometry.find("semantics");
    const bool has = semantics != geometry.end() && semantics->is_object() && semantics->contains("values");
    const auto surfaces = has ? semantics->find("surfaces") : geometry.end();
    surfaces_ = has && surfaces != semantics->end() ? &*surfaces : nullptr;
    points_ = &points;
    return ReadNested(*boundaries, has ? (*semantics)["values"] : none, depth);
  }

  // What stands once in the file needs no count.
  Error TakePoints(const Json& list) {
    if (!place_) return Ok();
    const Error error = left_.Take(list.size());
    return error ? Bad(error.message) : Ok();
  }

  Error ReadNested(const Json& list, const Json& values, int depth) {
    if (!list.is_array()) return Bad("boundaries must be lists");
    if (Error e = TakePoints(list)) return e;
    static const Json none;
    for (size_t i = 0; i < list.size(); ++i) {
      const Json& value = values.is_array() ? (i < values.size() ? values[i] : none) : values;
      if (Error e = depth > 0 ? ReadNested(list[i], value, depth - 1) : ReadSurface(list[i], value)) return e;
    }
    return Ok();
  }

  const CitySurface* SurfaceOf(const Json& value) const {
    if (!value.is_number_unsigned() || surfaces_ == nullptr || !surfaces_->is_array()) return nullptr;
    if (value.get<size_t>() >= surfaces_->size()) return nullptr;
    return FindCitySurface(TypeOf((*surfaces_)[value.get<size_t>()]));
  }

  Error ReadSurface(const Json& surface, const Json& value) {
    if (!surface.is_array()) return Bad("a surface must be a list of rings");
    const CitySurface* meaning = SurfaceOf(value);
    if (meaning && meaning->is_virtual) return Ok();
    Rings rings;
    for (const Json& ring : surface) {
      if (!ring.is_array()) return Bad("a ring must be a list of vertices");
      if (Error e = TakePoints(ring)) return e;
      std::vector<Point3> points;
      for (const Json& index : ring) {
        if (!index.is_number_integer() || index.get<int64_t>() < 0 || index.get<uint64_t>() >= points_->size())
          return Bad("vertex " + index.dump().substr(0, 20) + " is none of the " + std::to_string(points_->size()));
        const Point3& point = (*points_)[index.get<size_t>()];
        points.push_back(place_ ? Placed(point, *place_) : point);
      }
      if (points.size() >= 3 || rings.empty()) rings.push_back(std::move(points));
    }
    const bool foundation = meaning && meaning->is_foundation && feature_.kind == NodeKind::kBuilding;
    builder_.AddPolygon(foundation ? builder_.FoundationOf(node_) : node_,
                        meaning ? meaning->surface : feature_.surface, rings);
    return Ok();
  }

  std::filesystem::path path_;
  std::vector<std::string>* warnings_;
  const ReadSceneOptions& options_;
  SceneSource& source_;
  std::string where_, reference_system_;
  Transform transform_;
  std::vector<Point3> vertices_, template_vertices_;
  Json templates_ = Json::array();
  const Json* surfaces_ = nullptr;  // of what is read; null: none
  const std::vector<Point3>* points_ = nullptr;
  std::optional<Place> place_;  // of what is read, where it is a template
  TownPoints left_{0};
  int node_ = 0;
  CityFeature feature_{};
  TownBuilder builder_;
};

}  // namespace

Error ReadCityJson(const std::filesystem::path& path, Scene* scene, std::vector<std::string>* warnings,
                   const ReadSceneOptions& options, SceneSource* source) {
  try {
    return Reader(path, warnings, options, source).Read(scene);
  } catch (const Json::exception& exception) {
    return Fail(path.string() + ": not valid JSON: " + PlainJsonError(exception.what()));
  }
}

}  // namespace flaneur
