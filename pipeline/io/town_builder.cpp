#include "pipeline/io/town_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <regex>

#include "pipeline/io/triangulate_polygon.h"
#include "runtime/base/array.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

constexpr double kFarFromOrigin_m = 10'000;  // floats there are coarser than a millimetre
constexpr double kFarthest_m = 1e8;
constexpr double kOriginStep_m = 100;

// A house in degrees is narrower than 50 m are, and yet higher than this; nobody's town lies at longitude and latitude
// zero.
constexpr double kHouse_deg = 5e-4, kHouseHeight_m = 0.5, kNullIsland_deg = 1;

struct Extent {
  Point3 min{1e300, 1e300, 1e300}, max{-1e300, -1e300, -1e300};
  void Add(const Point3& p) {
    min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
    max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
  }
  Point2 Middle() const { return {(min.x + max.x) / 2, (min.y + max.y) / 2}; }
};

bool IsHouseInDegrees(const Extent& e) {
  const Point2 middle = e.Middle();
  return e.max.x - e.min.x < kHouse_deg && e.max.y - e.min.y < kHouse_deg && e.max.z - e.min.z > kHouseHeight_m &&
         std::hypot(middle.x, middle.y) > kNullIsland_deg && std::abs(middle.x) <= 180 && std::abs(middle.y) <= 180;
}

struct SurfaceLook {
  const char* name;
  Vec4 color;
};
constexpr std::array<SurfaceLook, 4> kLooks{{{"other", {0.55f, 0.53f, 0.50f, 1}},
                                             {"wall", {0.72f, 0.66f, 0.55f, 1}},
                                             {"roof", {0.36f, 0.13f, 0.08f, 1}},
                                             {"ground", {0.30f, 0.27f, 0.22f, 1}}}};

std::vector<Material> Looks() {
  std::vector<Material> materials;
  for (const SurfaceLook& look : kLooks) {
    Material material;
    material.name = look.name;
    material.base_color = look.color;
    material.double_sided = true;
    materials.push_back(material);
  }
  return materials;
}

void AddTriangle(const std::array<Point3, 3>& corners, Point2 origin, Mesh* mesh) {
  std::array<Vec3, 3> p;
  for (size_t i = 0; i < 3; ++i)
    p[i] = GltfFromGround({static_cast<float>(corners[i].x - origin.x), static_cast<float>(corners[i].y - origin.y),
                           static_cast<float>(corners[i].z)});
  const Vec3 normal = Normalized(Cross(p[1] - p[0], p[2] - p[0]));
  for (const Vec3& corner : p) {
    mesh->indices.push_back(static_cast<uint32_t>(mesh->positions.size()));
    mesh->positions.push_back(corner);
    mesh->normals.push_back(Length(normal) > 0 ? normal : Vec3{0, 1, 0});
  }
}

double Step(double value) { return std::floor(value / kOriginStep_m) * kOriginStep_m; }

}  // namespace

int TownBuilder::AddNode(const std::string& name, NodeKind kind, GroundKind ground, int parent) {
  SceneNode node;
  node.name = name;
  node.kind = kind;
  node.ground = ground;
  node.parent = parent;
  nodes_.push_back(std::move(node));
  foundations_.push_back(-1);
  return Count(nodes_) - 1;
}

int TownBuilder::FoundationOf(int building) {
  const auto at = static_cast<size_t>(building);
  if (foundations_[at] >= 0) return foundations_[at];
  const int node = AddNode(nodes_[at].name, NodeKind::kNone, GroundKind::kNone, building);
  nodes_.back().is_foundation = true;
  return foundations_[at] = node;
}

void TownBuilder::MarkBridge(int node) { At(nodes_, node).is_bridge = true; }

int TownBuilder::AddMaterial(Material material, const Image* image) {
  if (image) {
    material.base_color_image = Count(images_);
    images_.push_back(*image);
  }
  materials_.push_back(std::move(material));
  return Count(kLooks) + Count(materials_) - 1;
}

void TownBuilder::AddPolygon(int node, SurfaceKind surface, const std::vector<std::vector<Point3>>& rings,
                             const PolygonLook& look) {
  std::vector<Point3> points;
  for (const auto& ring : rings) points.insert(points.end(), ring.begin(), ring.end());
  const std::vector<std::array<uint32_t, 3>> triangles = TriangulatePolygon(rings);
  if (triangles.empty()) ++without_area_;
  std::vector<Vec2> uvs;
  for (const auto& ring : look.uvs) uvs.insert(uvs.end(), ring.begin(), ring.end());
  const int material = look.material < 0 ? static_cast<int>(surface) : look.material;
  for (const auto& [a, b, c] : triangles) {
    const bool textured = uvs.size() == points.size();
    triangles_.push_back({node, material, points[a], points[b], points[c], textured ? Count(uvs_) : -1});
    if (textured) uvs_.insert(uvs_.end(), {uvs[a], uvs[b], uvs[c]});
  }
}

bool TownBuilder::IsInDegrees() const {
  std::map<int, Extent> extents;  // by node
  for (const Triangle& t : triangles_)
    for (const Point3& p : {t.a, t.b, t.c}) extents[t.node].Add(p);
  const auto in_degrees =
      std::count_if(extents.begin(), extents.end(), [](const auto& e) { return IsHouseInDegrees(e.second); });
  return 2 * static_cast<size_t>(in_degrees) > extents.size();
}

Error TownBuilder::Finish(const std::string& file, const std::string& reference_system, Scene* scene,
                          std::vector<std::string>* warnings) {
  if (without_area_ > 0 && warnings)
    warnings->push_back(file + ": " + std::to_string(without_area_) +
                        " faces have fewer than three corners or no area; they were left out");
  if (triangles_.empty()) return Fail(OneLine(file + ": holds no face with an area, so there is no town in it"));
  for (const Triangle& t : triangles_)
    for (const Point3& p : {t.a, t.b, t.c})
      if (!(std::abs(p.x) < kFarthest_m && std::abs(p.y) < kFarthest_m && std::abs(p.z) < kFarthest_m))
        return Fail(OneLine(file + ": '" + At(nodes_, t.node).name +
                            "' reaches farther than any map: a coordinate is beyond 100,000 km"));
  if (IsInDegrees())
    return Fail(OneLine(
        file + ": the coordinates are degrees; bring them into a map system in metres, such as EPSG:25832, first"));
  *scene = {};
  scene->reference_system = reference_system;
  Point2 min{1e300, 1e300}, max{-1e300, -1e300};
  for (const Triangle& t : triangles_) {
    min = {std::min(min.x, t.a.x), std::min(min.y, t.a.y)};
    max = {std::max(max.x, t.a.x), std::max(max.y, t.a.y)};
  }
  const Point2 middle{(min.x + max.x) / 2, (min.y + max.y) / 2};
  if (std::abs(middle.x) > kFarFromOrigin_m || std::abs(middle.y) > kFarFromOrigin_m)
    scene->origin_m = {Step(middle.x), Step(middle.y)};
  scene->materials = Looks();
  scene->materials.insert(scene->materials.end(), materials_.begin(), materials_.end());
  scene->images = std::move(images_);
  scene->nodes = std::move(nodes_);
  AddTriangles(scene);
  return Ok();
}

void TownBuilder::AddTriangles(Scene* scene) {
  std::stable_sort(triangles_.begin(), triangles_.end(), [](const Triangle& a, const Triangle& b) {
    return a.node != b.node ? a.node < b.node : a.material < b.material;
  });
  for (size_t i = 0; i < triangles_.size(); ++i) {
    const Triangle& t = triangles_[i];
    if (i == 0 || t.node != triangles_[i - 1].node || t.material != triangles_[i - 1].material) {
      SceneNode& node = At(scene->nodes, t.node);
      node.meshes.push_back(Count(scene->meshes));
      scene->meshes.emplace_back();
      scene->meshes.back().name = node.name;
      scene->meshes.back().material = t.material;
    }
    Mesh& mesh = scene->meshes.back();
    AddTriangle({t.a, t.b, t.c}, scene->origin_m, &mesh);
    if (At(scene->materials, t.material).base_color_image < 0) continue;
    for (int k = 0; k < 3; ++k) mesh.uvs.push_back(t.first_uv < 0 ? Vec2{} : At(uvs_, t.first_uv + k));
  }
  triangles_ = {};
}

std::string PlainReferenceSystem(const std::string& text) {
  std::smatch found;
  // EPSG:25832, urn:ogc:def:crs:EPSG::25832, urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::5783, .../crs/EPSG/0/7415
  if (std::regex_search(text, found, std::regex("EPSG(?:[:/][0-9.]*)?[:/]([0-9]{4,6})", std::regex::icase)))
    return "EPSG:" + found[1].str();
  if (std::regex_search(text, found, std::regex("ETRS89_UTM([0-9]{2})"))) return "EPSG:258" + found[1].str();
  if (std::regex_search(text, found, std::regex("DE_DHDN_3GK([2-5])")))
    return "EPSG:3146" + std::to_string(std::stoi(found[1]) + 4);
  return OneLine(text);
}

}  // namespace flaneur
