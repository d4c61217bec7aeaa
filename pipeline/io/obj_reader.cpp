#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "pipeline/core/obj_files.h"
#include "pipeline/io/obj_materials.h"
#include "pipeline/io/scene_reader.h"
#include "pipeline/io/town_builder.h"
#include "runtime/base/file.h"
#include "runtime/base/srgb.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

// A town this much wider than high along one axis has that axis upright.
constexpr double kFlatter = 0.5;
// A face stands upright where its normal's share along the axis is below this.
constexpr double kUpright = 0.02;
// Map coordinates: eastings and northings are far larger than heights.
constexpr double kMapCoordinate_m = 10'000;
constexpr uint32_t kNone = ~0u;  // of a corner's texture coordinates or normal

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
    if (key == "usemtl") by_material_.push_back({std::string(Trimmed(line)), sizes_.size()});
    if (key == "o") by_object_.push_back({std::string(Trimmed(line)), sizes_.size()});
    if (key == "g") by_group_.push_back({std::string(Trimmed(line)), sizes_.size()});
    return Ok();
  }

  static bool ReadNumber(std::string_view word, double* value) {
    if (!word.empty() && word[0] == '+') word.remove_prefix(1);
    const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), *value);
    return problem == std::errc() && end == word.data() + word.size() && std::isfinite(*value);
  }

  // A place, and behind it a colour where the program that wrote it has one for each vertex.
  Error TakeVertex(std::string_view line) {
    Point3 p;
    for (double* value : {&p.x, &p.y, &p.z}) {
      const std::string_view word = NextWord(&line);
      if (!ReadNumber(word, value))
        return Bad("'" + std::string(word.substr(0, 20)) + "' is no coordinate; a vertex needs three numbers");
    }
    std::array<double, 3> rgb{};
    const bool colored =
        std::all_of(rgb.begin(), rgb.end(), [&](double& v) { return ReadNumber(NextWord(&line), &v); });
    if (colored) {
      const auto linear = [](double v) { return LinearFromSrgb(static_cast<float>(std::clamp(v, 0.0, 1.0))); };
      colors_.resize(points_.size(), {1, 1, 1, 1});
      colors_.push_back({linear(rgb[0]), linear(rgb[1]), linear(rgb[2]), 1});
    }
    points_.push_back(p);
    return Ok();
  }

  Error TakeTexturePlace(std::string_view line) {
    double u = 0, v = 0;
    std::string_view word = NextWord(&line);
    if (!ReadNumber(word, &u)) return Bad("'" + std::string(word.substr(0, 20)) + "' is no texture coordinate");
    word = NextWord(&line);
    if (!word.empty() && !ReadNumber(word, &v))
      return Bad("'" + std::string(word.substr(0, 20)) + "' is no texture coordinate");
    places_.push_back({static_cast<float>(u), static_cast<float>(v)});
    return Ok();
  }

  Error TakeNormal(std::string_view line) {
    std::array<double, 3> n{};
    for (double& value : n) {
      const std::string_view word = NextWord(&line);
      if (!ReadNumber(word, &value)) return Bad("'" + std::string(word.substr(0, 20)) + "' is no part of a normal");
    }
    normals_.push_back(Normalized(Vec3{static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2])}));
    return Ok();
  }

  // A number of a face's corner, from 1 on, or counted back from the last.
  static bool ReadIndex(std::string_view word, size_t known, uint32_t* index) {
    int64_t value = 0;
    const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (value < 0) value += static_cast<int64_t>(known) + 1;
    if (problem != std::errc() || end != word.data() + word.size() || value < 1 || value > static_cast<int64_t>(known))
      return false;
    *index = static_cast<uint32_t>(value - 1);
    return true;
  }

  Error TakeFace(std::string_view line) {
    uint32_t count = 0;
    for (std::string_view word = NextWord(&line); !word.empty(); word = NextWord(&line), ++count) {
      const size_t slash = std::min(word.find('/'), word.size());
      uint32_t corner = 0, place = kNone, normal = kNone;
      if (!ReadIndex(word.substr(0, slash), points_.size(), &corner))
        return Bad("'" + std::string(word.substr(0, 20)) + "' is none of the " + std::to_string(points_.size()) +
                   " vertices so far");
      const std::string_view rest = word.substr(std::min(slash + 1, word.size()));
      const size_t next = std::min(rest.find('/'), rest.size());
      const std::string_view second = rest.substr(0, next), third = rest.substr(std::min(next + 1, rest.size()));
      if (!second.empty() && !ReadIndex(second, places_.size(), &place)) ++lost_places_;
      corners_.push_back(corner);
      if (!third.empty()) ReadIndex(third, normals_.size(), &normal);  // what has none is as its face lies
      corner_places_.push_back(place);
      corner_normals_.push_back(normal);
    }
    sizes_.push_back(count);
    return Ok();
  }

  // Of the faces that stand along each axis: walls stand along the axis that is up, roofs and floors along none or
  // another.
  Point3 StandingArea_m2() const {
    Point3 standing{};
    size_t corner = 0;
    for (const uint32_t size : sizes_) {
      Point3 normal{};  // twice the area long
      for (uint32_t i = 0; i < size; ++i) {
        const Point3 &a = points_[corners_[corner + i]], &b = points_[corners_[corner + (i + 1) % size]];
        normal = {normal.x + (a.y - b.y) * (a.z + b.z), normal.y + (a.z - b.z) * (a.x + b.x),
                  normal.z + (a.x - b.x) * (a.y + b.y)};
      }
      corner += size;
      const double length = std::sqrt(normal.x * normal.x + normal.y * normal.y + normal.z * normal.z);
      if (std::abs(normal.y) < kUpright * length) standing.y += length / 2;
      if (std::abs(normal.z) < kUpright * length) standing.z += length / 2;
    }
    return standing;
  }

  // OBJ does not say which axis is up.
  bool YIsUp(std::vector<std::string>* warnings) const {
    Point3 min{1e300, 1e300, 1e300}, max{-1e300, -1e300, -1e300};
    for (const uint32_t corner : corners_) {
      const Point3& p = points_[corner];
      min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
      max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
    }
    const double y = max.y - min.y, z = max.z - min.z;
    const auto far = [](double low, double high) { return std::abs(low + high) / 2 > kMapCoordinate_m; };
    const bool on_map = far(min.x, max.x) && far(min.y, max.y) && !far(min.z, max.z);
    const bool by_extents = z < kFlatter * y || y < kFlatter * z;
    const Point3 standing = StandingArea_m2();
    const bool y_up = !on_map && (by_extents ? y < z : standing.y >= standing.z);
    if (warnings)
      warnings->push_back(path_.string() + ": OBJ does not say which way is up; taken for " + (y_up ? "y" : "z") +
                          (on_map       ? ", as x and y are map coordinates"
                           : by_extents ? ", judging by the extents"
                                        : ", judging by the walls") +
                          "; --obj-up says otherwise");
    return y_up;
  }

  std::vector<Point3> RingOf(size_t corner, size_t size, bool y_up) const {
    std::vector<Point3> ring;
    for (size_t i = 0; i < size; ++i) {
      const Point3& p = points_[corners_[corner + i]];
      ring.push_back(y_up ? Point3{p.x, -p.z, p.y} : p);
    }
    return ring;
  }

  // Of a face's corners, or empty where one of them has none.
  std::vector<Vec3> NormalsOf(size_t corner, size_t size, bool y_up) const {
    std::vector<Vec3> normals;
    for (size_t i = 0; i < size; ++i) {
      const uint32_t normal = corner_normals_[corner + i];
      if (normal == kNone || !(Length(normals_[normal]) > 0.5f)) return {};
      const Vec3 n = normals_[normal];
      normals.push_back(y_up ? Vec3{n.x, -n.z, n.y} : n);
    }
    return normals;
  }

  PolygonLook LookOf(const ObjLook& look, size_t corner, size_t size, bool y_up) const {
    PolygonLook polygon{look.material < 0 && !colors_.empty() ? white_ : look.material, {}, {}, {}};
    if (std::vector<Vec3> normals = NormalsOf(corner, size, y_up); !normals.empty())
      polygon.normals.push_back(std::move(normals));
    std::vector<Vec2> places;
    for (size_t i = 0; i < size && look.has_picture; ++i) {
      const uint32_t place = corner_places_[corner + i];
      if (place == kNone) break;
      const float u = places_[place].x * look.uv_scale.x + look.uv_offset.x;
      const float v = 1 - (places_[place].y * look.uv_scale.y + look.uv_offset.y);
      if (!std::isfinite(u) || !std::isfinite(v)) break;
      places.push_back({u, v});
    }
    if (places.size() == size) polygon.uvs.push_back(std::move(places));
    if (colors_.empty()) return polygon;
    std::vector<Vec4>& colors = polygon.colors.emplace_back();
    for (size_t i = 0; i < size; ++i) {
      const uint32_t point = corners_[corner + i];
      colors.push_back(point < colors_.size() ? colors_[point] : Vec4{1, 1, 1, 1});
    }
    return polygon;
  }

  Error Build(Scene* scene, std::vector<std::string>* warnings) {
    const bool y_up = up_ == UpAxis::kJudged ? YIsUp(warnings) : up_ == UpAxis::kY;
    TownBuilder builder;
    std::vector<Object> objects = by_object_.empty() ? by_group_ : by_object_;
    if (objects.empty() || objects[0].first_face > 0) objects.insert(objects.begin(), {path_.stem().string(), 0});
    if (!colors_.empty()) {
      Material white;
      white.name = "colored";
      white.double_sided = true;
      white_ = builder.AddMaterial(white, nullptr);
    }
    size_t corner = 0, material = 0;
    ObjLook look;
    for (size_t k = 0; k < objects.size(); ++k) {
      const size_t last = k + 1 < objects.size() ? objects[k + 1].first_face : sizes_.size();
      if (last == objects[k].first_face) continue;
      const int node = builder.AddNode(objects[k].name, NodeKind::kUntagged);
      for (size_t face = objects[k].first_face; face < last; corner += sizes_[face++]) {
        while (material < by_material_.size() && by_material_[material].first_face <= face)
          look = materials_.Use(by_material_[material++].name, &builder);
        builder.AddPolygon(node, SurfaceKind::kWall, {RingOf(corner, sizes_[face], y_up)},
                           LookOf(look, corner, sizes_[face], y_up));
      }
    }
    materials_.Warn(path_, warnings);
    if (lost_places_ > 0 && !places_.empty() && warnings)
      warnings->push_back(path_.string() + ": " + std::to_string(lost_places_) +
                          " corners name texture coordinates that are not there; their faces are plain");
    return builder.Finish(path_.string(), {"", false}, scene, nullptr, warnings);
  }

  std::filesystem::path path_;
  UpAxis up_;
  int line_ = 1;
  std::vector<Point3> points_;
  std::vector<Vec4> colors_;  // of the points, linear; as many as had one, or fewer
  std::vector<Vec2> places_;  // in a picture
  std::vector<Vec3> normals_;
  std::vector<uint32_t> corners_, corner_places_, corner_normals_, sizes_;
  std::vector<Object> by_object_, by_group_, by_material_;
  size_t lost_places_ = 0;
  int white_ = -1;  // the builder's material of what has colours of its own alone
  ObjMaterials materials_;
};

}  // namespace

Error ReadObj(const std::filesystem::path& path, Scene* scene, std::vector<std::string>* warnings, UpAxis up) {
  return Reader(path, up).Read(scene, warnings);
}

}  // namespace flaneur
