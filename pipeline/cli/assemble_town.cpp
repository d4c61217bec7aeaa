#include "pipeline/cli/assemble_town.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "pipeline/cli/bare_ground.h"
#include "pipeline/footprint/town_objects.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

template <typename T>
void Append(std::vector<T>* to, std::vector<T>& from) {
  to->insert(to->end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

// Through the points' middle, along where they lie farthest apart, from end to end.
std::vector<Vec2> LongAxis(const std::vector<Vec2>& points) {
  Vec2 low = points.front(), high = low;
  for (const Vec2& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const Vec2 middle = (low + high) * 0.5f;
  float xx = 0, xy = 0, yy = 0;
  for (const Vec2& p : points) {
    const Vec2 off = p - middle;
    xx += off.x * off.x, xy += off.x * off.y, yy += off.y * off.y;
  }
  const float angle = 0.5f * std::atan2(2 * xy, xx - yy);
  const Vec2 along{std::cos(angle), std::sin(angle)};
  float least_m = 0, most_m = 0;
  for (const Vec2& p : points) {
    least_m = std::min(least_m, Dot(p - middle, along));
    most_m = std::max(most_m, Dot(p - middle, along));
  }
  return {middle + along * least_m, middle + along * most_m};
}

// Whether most things in the town stand over ground. A single meadow of many models is not the ground of the others.
bool StandsOnGround(const TownObjects& town) {
  if (town.ground.empty()) return false;
  Point3 low = town.ground.front().triangles.front()[0], high = low;
  for (const auto& ground : town.ground) {
    for (const Triangle3& triangle : ground.triangles) {
      for (const Point3& p : triangle) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), 0};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), 0};
      }
    }
  }
  const auto over = std::count_if(town.obstacles.begin(), town.obstacles.end(), [&](const TownObject& o) {
    const double x = (o.min_m.x + o.max_m.x) / 2, y = (o.min_m.y + o.max_m.y) / 2;
    return low.x <= x && x <= high.x && low.y <= y && y <= high.y;
  });
  return 2 * static_cast<size_t>(over) > town.obstacles.size();
}

void Shift(int* index, size_t by) {
  if (*index >= 0) *index += static_cast<int>(by);
}

}  // namespace

void AppendScene(Scene part, float scale, float yaw_rad, Vec2 position_m, Scene* town) {
  const Quat turn{0, std::sin(yaw_rad / 2), 0, std::cos(yaw_rad / 2)};
  const Mat4 place =
      FromTranslationRotationScale(GltfFromGround({position_m.x, position_m.y, 0}), turn, {scale, scale, scale});
  const size_t nodes = town->nodes.size(), meshes = town->meshes.size();
  const size_t materials = town->materials.size(), images = town->images.size();
  for (SceneNode& node : part.nodes) {
    Shift(&node.parent, nodes);
    for (int& mesh : node.meshes) Shift(&mesh, meshes);
    node.world = place * node.world;
    node.radius_m *= scale;
    node.width_m *= scale;
    node.seat_m *= scale;
  }
  for (Mesh& mesh : part.meshes) Shift(&mesh.material, materials);
  for (Material& material : part.materials) {
    Shift(&material.base_color_image, images);
    Shift(&material.normal_image, images);
  }
  Append(&town->nodes, part.nodes);
  Append(&town->meshes, part.meshes);
  Append(&town->materials, part.materials);
  Append(&town->images, part.images);
}

std::vector<Place> TaggedPlaces(const Scene& town) {
  std::vector<Place> places;
  for (const SceneNode& node : town.nodes) {
    const bool place = node.kind == NodeKind::kDoor || node.kind == NodeKind::kExit || node.kind == NodeKind::kLoiter ||
                       node.kind == NodeKind::kWork;
    if (!place || !node.meshes.empty()) continue;
    const Vec3 p = GroundFromGltf({node.world.m[3][0], node.world.m[3][1], node.world.m[3][2]});
    places.push_back({node.name, NodeKindName(node.kind), {p.x, p.y}, node.width_m > 0 ? node.width_m : 1});
    places.back().clip = node.clip;
    places.back().avatars = node.avatars;
    places.back().seat_m = std::clamp(node.seat_m, 0.0f, kMaxSeat_m);
    places.back().stay_s = std::clamp(node.stay_s, 0.0f, kMaxStay_s);
    const Vec2 ahead{node.world.m[2][0], -node.world.m[2][2]};  // local +Z
    if (Length(ahead) > 1e-6f) places.back().yaw_rad = std::atan2(ahead.y, ahead.x);
  }
  return places;
}

std::vector<Street> TaggedStreets(const Scene& town, const std::string& language) {
  std::map<std::string, std::vector<Vec2>> corners;
  for (const SceneNode& node : town.nodes) {
    if (node.street.empty() || node.kind != NodeKind::kGround) continue;
    for (int mesh : node.meshes) {
      for (const Vec3& p : At(town.meshes, mesh).positions) {
        const Vec3 on = GroundFromGltf(TransformPoint(node.world, p));
        corners[node.street].push_back({on.x, on.y});
      }
    }
  }
  std::vector<Street> streets;
  for (const auto& [name, points] : corners) {
    if (!points.empty()) streets.push_back({{{language, name}}, LongAxis(points)});
  }
  return streets;
}

bool AddGroundWhereNone(bool on_one_level, float margin_m, Scene* town) {
  const TownObjects objects = SortTown(*town, 1);
  if (objects.obstacles.empty() || StandsOnGround(objects)) return false;
  Mesh mesh = BareGround(objects.obstacles, on_one_level, margin_m);
  mesh.material = Count(town->materials);
  Material material;
  material.name = "ground";
  material.base_color = {0.30f, 0.27f, 0.22f, 1};
  SceneNode node;
  node.name = "ground";
  node.meshes = {Count(town->meshes)};
  node.kind = NodeKind::kGround;
  node.ground = GroundKind::kSquare;
  town->materials.push_back(material);
  town->meshes.push_back(std::move(mesh));
  town->nodes.push_back(node);
  return true;
}

}  // namespace flaneur
