#include "pipeline/io/scene_tiles.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <set>

#include "pipeline/io/map_projection.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

constexpr double kSamePlace_m = 0.02;  // two tiles may be rounded otherwise
constexpr double kFarTile_m = 100'000;

void Shift(int* index, int by) {
  if (*index >= 0) *index += by;
}

// The topmost node above, which stands for the whole thing.
int RootOf(const Scene& scene, int node) {
  while (At(scene.nodes, node).parent >= 0) node = At(scene.nodes, node).parent;
  return node;
}

// Enough of a thing's shape to know it again. Metres of the map.
struct Shape {
  Point3 min{1e300, 1e300, 1e300}, max{-1e300, -1e300, -1e300}, mean;
  size_t corners = 0;
};

bool Near(const Point3& a, const Point3& b) {
  return std::abs(a.x - b.x) < kSamePlace_m && std::abs(a.y - b.y) < kSamePlace_m && std::abs(a.z - b.z) < kSamePlace_m;
}
bool Same(const Shape& a, const Shape& b) {
  return a.corners == b.corners && Near(a.min, b.min) && Near(a.max, b.max) && Near(a.mean, b.mean);
}

// By root.
std::map<int, Shape> Shapes(const Scene& scene) {
  std::map<int, Shape> shapes;
  for (int i = 0; i < Count(scene.nodes); ++i) {
    const SceneNode& node = At(scene.nodes, i);
    Shape& shape = shapes[RootOf(scene, i)];
    for (const int mesh : node.meshes) {
      for (const Vec3& local : At(scene.meshes, mesh).positions) {
        const Vec3 p = GroundFromGltf(TransformPoint(node.world, local));
        const Point3 q{p.x + scene.origin_m.x, p.y + scene.origin_m.y, p.z};
        shape.min = {std::min(shape.min.x, q.x), std::min(shape.min.y, q.y), std::min(shape.min.z, q.z)};
        shape.max = {std::max(shape.max.x, q.x), std::max(shape.max.y, q.y), std::max(shape.max.z, q.z)};
        shape.mean = {shape.mean.x + q.x, shape.mean.y + q.y, shape.mean.z + q.z};
        ++shape.corners;
      }
    }
  }
  for (auto& [root, shape] : shapes) {
    const double n = std::max(1.0, static_cast<double>(shape.corners));
    shape.mean = {shape.mean.x / n, shape.mean.y / n, shape.mean.z / n};
  }
  return shapes;
}

// The shapes so far, by the cells that their middles lie in.
class KnownShapes {
 public:
  // False where it is known already.
  bool Insert(const Shape& shape) {
    const auto x = Cell(shape.mean.x), y = Cell(shape.mean.y);
    for (int64_t dx = -1; dx <= 1; ++dx)
      for (int64_t dy = -1; dy <= 1; ++dy)
        if (const auto found = cells_.find({x + dx, y + dy}); found != cells_.end())
          if (std::any_of(found->second.begin(), found->second.end(), [&](const Shape& s) { return Same(s, shape); }))
            return false;
    cells_[{x, y}].push_back(shape);
    return true;
  }

 private:
  static int64_t Cell(double v) { return std::abs(v) < 1e15 ? static_cast<int64_t>(std::floor(v)) : 0; }
  std::map<std::pair<int64_t, int64_t>, std::vector<Shape>> cells_;
};

// All points into another system. Heights stay.
Error Bring(const std::string& to, Scene* scene) {
  std::vector<Point2> points;
  for (const SceneNode& node : scene->nodes)
    for (const int mesh : node.meshes)
      for (const Vec3& local : At(scene->meshes, mesh).positions) {
        const Vec3 p = GroundFromGltf(TransformPoint(node.world, local));
        points.push_back({p.x + scene->origin_m.x, p.y + scene->origin_m.y});
      }
  if (points.empty()) return Ok();
  if (Error error = TransformPoints(scene->reference_system, to, &points)) return error;
  const Point2 origin{std::floor(points[0].x / 100) * 100, std::floor(points[0].y / 100) * 100};
  size_t next = 0;
  for (const SceneNode& node : scene->nodes)
    for (const int mesh : node.meshes)
      for (Vec3& local : At(scene->meshes, mesh).positions) {
        const Vec3 p = GroundFromGltf(TransformPoint(node.world, local));
        const Point2 moved = points[next++];
        local = GltfFromGround({static_cast<float>(moved.x - origin.x), static_cast<float>(moved.y - origin.y), p.z});
      }
  for (SceneNode& node : scene->nodes) node.world = Mat4{};
  scene->origin_m = origin;
  scene->reference_system = to;
  return Ok();
}

}  // namespace

struct TileJoiner::Known {
  Scene& whole;
  std::filesystem::path first;  // tile; empty: none yet
  KnownShapes shapes;
  std::set<std::string> names;
  std::map<std::string, int> numbers;  // the last that was tried behind a name
  int twice = 0;

  std::string Unique(const std::string& wish) {
    std::string name = wish;
    while (!names.insert(name).second) name = wish + "_" + std::to_string(++numbers.try_emplace(wish, 1).first->second);
    return name;
  }

  void Append(Scene tile) {
    std::set<int> left_out;
    for (const auto& [root, shape] : Shapes(tile)) {
      if (shape.corners > 0 && !shapes.Insert(shape)) left_out.insert(root), ++twice;
    }
    const Vec3 move = GltfFromGround({static_cast<float>(tile.origin_m.x - whole.origin_m.x),
                                      static_cast<float>(tile.origin_m.y - whole.origin_m.y), 0});
    const Mat4 place = FromTranslationRotationScale(move, {0, 0, 0, 1}, {1, 1, 1});
    const int meshes = Count(whole.meshes), materials = Count(whole.materials), images = Count(whole.images);
    std::vector<int> number(tile.nodes.size(), -1);
    int kept = 0;
    for (int i = 0; i < Count(tile.nodes); ++i)
      if (!left_out.contains(RootOf(tile, i))) At(number, i) = Count(whole.nodes) + kept++;
    for (int i = 0; i < Count(tile.nodes); ++i) {
      if (At(number, i) < 0) continue;
      SceneNode& node = At(tile.nodes, i);
      if (node.parent < 0) node.name = Unique(node.name);
      else node.parent = At(number, node.parent);
      for (int& mesh : node.meshes) Shift(&mesh, meshes);
      node.world = place * node.world;
    }
    for (Mesh& mesh : tile.meshes) Shift(&mesh.material, materials);
    for (Material& material : tile.materials) {
      Shift(&material.base_color_image, images);
      Shift(&material.normal_image, images);
    }
    for (int i = 0; i < Count(tile.nodes); ++i) {
      if (At(number, i) >= 0) whole.nodes.push_back(std::move(At(tile.nodes, i)));
      else
        for (const int mesh : At(tile.nodes, i).meshes) At(tile.meshes, mesh) = {};  // keeps the numbers of the others
    }
    whole.meshes.insert(whole.meshes.end(), std::make_move_iterator(tile.meshes.begin()),
                        std::make_move_iterator(tile.meshes.end()));
    whole.materials.insert(whole.materials.end(), tile.materials.begin(), tile.materials.end());
    whole.images.insert(whole.images.end(), tile.images.begin(), tile.images.end());
  }
};

TileJoiner::TileJoiner(Scene* whole) : known_(new Known{*whole, {}, {}, {}, {}}) {}
TileJoiner::~TileJoiner() = default;

Error TileJoiner::Add(const std::filesystem::path& file, Scene tile) {
  Scene& whole = known_->whole;
  if (known_->first.empty()) {
    known_->first = file;
    whole.origin_m = tile.origin_m, whole.reference_system = tile.reference_system;
  }
  const std::string& system = whole.reference_system;
  if (!system.empty() && !tile.reference_system.empty() && tile.reference_system != system)
    if (Error error = Bring(system, &tile)) return Fail(file.string() + ": " + error.message);
  if (IsOnMap(tile) != IsOnMap(whole))
    return Fail(file.string() + ": has " + (IsOnMap(tile) ? "" : "no ") + "map coordinates, " + known_->first.string() +
                " has " + (IsOnMap(whole) ? "some" : "none") + "; tiles of one city need the same");
  if (std::hypot(tile.origin_m.x - whole.origin_m.x, tile.origin_m.y - whole.origin_m.y) > kFarTile_m)
    return Fail(file.string() + ": lies more than 100 km from " + known_->first.string() +
                "; these are not of one city");
  known_->Append(std::move(tile));
  return Ok();
}

bool IsOnMap(const Scene& scene) { return scene.origin_m.x != 0 || scene.origin_m.y != 0; }

void TileJoiner::WarnOfTwice(std::vector<std::string>* warnings) const {
  if (known_->twice > 0 && warnings)
    warnings->push_back(std::to_string(known_->twice) + " things stand in two tiles with the same shape; taken once");
}

Error ReadTiles(const std::vector<std::filesystem::path>& files, const ReadSceneOptions& options, Scene* scene,
                SceneSource* source, std::vector<std::string>* warnings) {
  if (files.size() == 1) return ReadScene(files[0], scene, warnings, options, source);
  *scene = {};
  std::set<std::filesystem::path> seen;
  TileJoiner joiner(scene);
  for (const std::filesystem::path& file : files) {
    if (!seen.insert(file).second) return Fail(file.string() + ": is named twice; name each tile once");
    Scene tile;
    SceneSource own;
    if (Error error = ReadScene(file, &tile, warnings, options, &own)) return error;
    if (seen.size() == 1) *source = own;
    if (Error error = joiner.Add(file, std::move(tile))) return error;
  }
  joiner.WarnOfTwice(warnings);
  return Ok();
}

}  // namespace flaneur
