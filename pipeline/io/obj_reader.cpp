#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "pipeline/io/scene_reader.h"
#include "pipeline/io/town_builder.h"
#include "runtime/base/file.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

// A town this much wider than high along one axis has that axis upright.
constexpr double kFlatter = 0.5;
// A face stands upright where its normal's share along the axis is below this.
constexpr double kUpright = 0.02;
// Map coordinates: eastings and northings are far larger than heights.
constexpr double kMapCoordinate_m = 10'000;

std::string_view NextWord(std::string_view* line) {
  const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!line->empty() && is_space(line->front())) line->remove_prefix(1);
  size_t end = 0;
  while (end < line->size() && !is_space((*line)[end])) ++end;
  const std::string_view word = line->substr(0, end);
  line->remove_prefix(end);
  return word;
}

std::string_view Rest(std::string_view line) {
  while (!line.empty() && static_cast<unsigned char>(line.front()) <= ' ') line.remove_prefix(1);
  while (!line.empty() && static_cast<unsigned char>(line.back()) <= ' ') line.remove_suffix(1);
  return line;
}

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
    if (key == "f") return TakeFace(line);
    if (key == "o") by_object_.push_back({std::string(Rest(line)), sizes_.size()});
    if (key == "g") by_group_.push_back({std::string(Rest(line)), sizes_.size()});
    return Ok();
  }

  Error TakeVertex(std::string_view line) {
    Point3 p;
    for (double* value : {&p.x, &p.y, &p.z}) {
      std::string_view word = NextWord(&line);
      if (!word.empty() && word[0] == '+') word.remove_prefix(1);
      const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), *value);
      if (problem != std::errc() || end != word.data() + word.size() || !std::isfinite(*value))
        return Bad("'" + std::string(word.substr(0, 20)) + "' is no coordinate; a vertex needs three numbers");
    }
    points_.push_back(p);
    return Ok();
  }

  Error TakeFace(std::string_view line) {
    uint32_t count = 0;
    for (std::string_view word = NextWord(&line); !word.empty(); word = NextWord(&line), ++count) {
      const std::string_view index = word.substr(0, word.find('/'));
      int64_t value = 0;
      const auto [end, problem] = std::from_chars(index.data(), index.data() + index.size(), value);
      const auto known = static_cast<int64_t>(points_.size());
      if (value < 0) value += known + 1;
      if (problem != std::errc() || end != index.data() + index.size() || value < 1 || value > known)
        return Bad("'" + std::string(word.substr(0, 20)) + "' is none of the " + std::to_string(known) +
                   " vertices so far");
      corners_.push_back(static_cast<uint32_t>(value - 1));
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

  Error Build(Scene* scene, std::vector<std::string>* warnings) {
    const bool y_up = up_ == UpAxis::kJudged ? YIsUp(warnings) : up_ == UpAxis::kY;
    TownBuilder builder;
    std::vector<Object> objects = by_object_.empty() ? by_group_ : by_object_;
    if (objects.empty() || objects[0].first_face > 0) objects.insert(objects.begin(), {path_.stem().string(), 0});
    size_t corner = 0;
    for (size_t k = 0; k < objects.size(); ++k) {
      const size_t last = k + 1 < objects.size() ? objects[k + 1].first_face : sizes_.size();
      if (last == objects[k].first_face) continue;
      const int node = builder.AddNode(objects[k].name, NodeKind::kUntagged);
      for (size_t face = objects[k].first_face; face < last; corner += sizes_[face++]) {
        std::vector<Point3> ring;
        for (size_t i = 0; i < sizes_[face]; ++i) {
          const Point3& p = points_[corners_[corner + i]];
          ring.push_back(y_up ? Point3{p.x, -p.z, p.y} : p);
        }
        builder.AddPolygon(node, SurfaceKind::kWall, {ring});
      }
    }
    return builder.Finish(path_.string(), {"", false}, scene, nullptr, warnings);
  }

  std::filesystem::path path_;
  UpAxis up_;
  int line_ = 1;
  std::vector<Point3> points_;
  std::vector<uint32_t> corners_, sizes_;
  std::vector<Object> by_object_, by_group_;
};

}  // namespace

Error ReadObj(const std::filesystem::path& path, Scene* scene, std::vector<std::string>* warnings, UpAxis up) {
  return Reader(path, up).Read(scene, warnings);
}

}  // namespace flaneur
