#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "pipeline/core/obj_files.h"
#include "pipeline/io/obj_materials.h"
#include "pipeline/io/polygon_soup.h"
#include "pipeline/io/scene_reader.h"
#include "pipeline/io/town_builder.h"
#include "runtime/base/file.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

constexpr uint32_t kNone = PolygonSoup::kNone;

class Reader {
 public:
  Reader(const std::filesystem::path& path, UpAxis up) : path_(path), up_(up) {}

  Error Read(Scene* scene, std::vector<std::string>* warnings) {
    std::string text;
    if (Error e = ReadTextFile(path_, &text)) return e;
    for (std::string_view rest = text; !rest.empty(); ++line_) {
      const size_t end = std::min(rest.find('\n'), rest.size());
      if (Error e = TakeLine(rest.substr(0, end))) return e;
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return Build(scene, warnings);
  }

 private:
  struct Object {
    std::string name;
    size_t first_face;
  };

  Error Bad(const std::string& why) const {
    return Fail(OneLine(path_.string() + ":" + std::to_string(line_) + ": " + why));
  }

  Error TakeLine(std::string_view line) {
    const std::string_view key = NextWord(&line);
    if (key == "v") return TakeVertex(line);
    if (key == "vt") return TakeTexturePlace(line);
    if (key == "vn") return TakeNormal(line);
    if (key == "f") return TakeFace(line);
    if (key == "mtllib") materials_.AddLibraries(path_, Trimmed(line));
    if (key == "usemtl") by_material_.push_back({std::string(Trimmed(line)), soup_.sizes.size()});
    if (key == "o") by_object_.push_back({std::string(Trimmed(line)), soup_.sizes.size()});
    if (key == "g") by_group_.push_back({std::string(Trimmed(line)), soup_.sizes.size()});
    return Ok();
  }

  static bool ReadFinite(std::string_view word, double* value) {
    if (!word.empty() && word[0] == '+') word.remove_prefix(1);
    return ReadNumber(word, value) && std::isfinite(*value);
  }

  // A place, and behind it a colour where the program that wrote it has one for each vertex.
  Error TakeVertex(std::string_view line) {
    Point3 p;
    for (double* value : {&p.x, &p.y, &p.z}) {
      const std::string_view word = NextWord(&line);
      if (!ReadFinite(word, value))
        return Bad("'" + std::string(word.substr(0, 20)) + "' is no coordinate; a vertex needs three numbers");
    }
    std::array<double, 3> rgb{};
    const bool colored =
        std::all_of(rgb.begin(), rgb.end(), [&](double& v) { return ReadFinite(NextWord(&line), &v); });
    if (colored) {
      soup_.colors.resize(soup_.points.size(), {1, 1, 1, 1});
      soup_.colors.push_back(ColorOfPoint(rgb[0], rgb[1], rgb[2]));
    }
    soup_.points.push_back(p);
    return Ok();
  }

  Error TakeTexturePlace(std::string_view line) {
    double u = 0, v = 0;
    std::string_view word = NextWord(&line);
    if (!ReadFinite(word, &u)) return Bad("'" + std::string(word.substr(0, 20)) + "' is no texture coordinate");
    word = NextWord(&line);
    if (!word.empty() && !ReadFinite(word, &v))
      return Bad("'" + std::string(word.substr(0, 20)) + "' is no texture coordinate");
    soup_.places.push_back({static_cast<float>(u), static_cast<float>(v)});
    return Ok();
  }

  Error TakeNormal(std::string_view line) {
    std::array<double, 3> n{};
    for (double& value : n) {
      const std::string_view word = NextWord(&line);
      if (!ReadFinite(word, &value)) return Bad("'" + std::string(word.substr(0, 20)) + "' is no part of a normal");
    }
    soup_.normals.push_back(UnitNormal(n[0], n[1], n[2]));
    return Ok();
  }

  // A number of a face's corner, from 1 on, or counted back from the last.
  static bool ReadIndex(std::string_view word, size_t known, uint32_t* index) {
    int64_t value = 0;
    if (!ReadNumber(word, &value)) return false;
    if (value < 0) value += static_cast<int64_t>(known) + 1;
    if (value < 1 || value > static_cast<int64_t>(known)) return false;
    *index = static_cast<uint32_t>(value - 1);
    return true;
  }

  Error TakeFace(std::string_view line) {
    uint32_t count = 0;
    for (std::string_view word = NextWord(&line); !word.empty(); word = NextWord(&line), ++count) {
      const size_t slash = std::min(word.find('/'), word.size());
      uint32_t corner = 0, place = kNone, normal = kNone;
      if (!ReadIndex(word.substr(0, slash), soup_.points.size(), &corner))
        return Bad("'" + std::string(word.substr(0, 20)) + "' is none of the " + std::to_string(soup_.points.size()) +
                   " vertices so far");
      const std::string_view rest = word.substr(std::min(slash + 1, word.size()));
      const size_t next = std::min(rest.find('/'), rest.size());
      const std::string_view second = rest.substr(0, next), third = rest.substr(std::min(next + 1, rest.size()));
      if (!second.empty() && !ReadIndex(second, soup_.places.size(), &place)) ++lost_places_;
      soup_.corners.push_back(corner);
      if (!third.empty()) ReadIndex(third, soup_.normals.size(), &normal);  // what has none is as its face lies
      soup_.corner_places.push_back(place);
      soup_.corner_normals.push_back(normal);
    }
    soup_.sizes.push_back(count);
    return Ok();
  }

  Error Build(Scene* scene, std::vector<std::string>* warnings) {
    const UpAxis up = UpOf(soup_, up_, path_.string(), "OBJ", warnings);
    TownBuilder builder;
    std::vector<Object> objects = by_object_.empty() ? by_group_ : by_object_;
    if (objects.empty() || objects[0].first_face > 0) objects.insert(objects.begin(), {path_.stem().string(), 0});
    const int white = soup_.colors.empty() ? -1 : builder.AddMaterial(WhiteMaterial(), nullptr);
    size_t corner = 0, material = 0;
    FaceLook look;
    for (size_t k = 0; k < objects.size(); ++k) {
      const size_t last = k + 1 < objects.size() ? objects[k + 1].first_face : soup_.sizes.size();
      if (last == objects[k].first_face) continue;
      const int node = builder.AddNode(objects[k].name, NodeKind::kUntagged);
      for (size_t face = objects[k].first_face; face < last; corner += soup_.sizes[face++]) {
        while (material < by_material_.size() && by_material_[material].first_face <= face)
          look = materials_.Use(by_material_[material++].name, &builder);
        FaceLook face_look = look;
        if (face_look.material < 0) face_look.material = white;  // of colours of its own alone
        AddFace(soup_, corner, soup_.sizes[face], up, face_look, node, &builder);
      }
    }
    materials_.Warn(path_, warnings);
    if (lost_places_ > 0 && !soup_.places.empty() && warnings)
      warnings->push_back(path_.string() + ": " + std::to_string(lost_places_) +
                          " corners name texture coordinates that are not there; their faces are plain");
    return builder.Finish(path_.string(), {"", false}, scene, nullptr, warnings);
  }

  std::filesystem::path path_;
  UpAxis up_;
  int line_ = 1;
  PolygonSoup soup_;
  std::vector<Object> by_object_, by_group_, by_material_;
  size_t lost_places_ = 0;
  ObjMaterials materials_;
};

}  // namespace

Error ReadObj(const std::filesystem::path& path, Scene* scene, std::vector<std::string>* warnings, UpAxis up) {
  return Reader(path, up).Read(scene, warnings);
}

}  // namespace flaneur
