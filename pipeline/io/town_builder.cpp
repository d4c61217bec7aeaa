#include "pipeline/io/town_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <regex>

#include "pipeline/io/axis_order.h"
#include "pipeline/io/map_projection.h"
#include "pipeline/io/triangulate_polygon.h"
#include "runtime/base/array.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

constexpr double kFarFromOrigin_m = 10'000;  // floats there are coarser than a millimetre
constexpr double kFarthest = 1e11;           // of any unit: 100,000 km in millimetres
constexpr double kMost_deg = 360;
constexpr double kBesideArea_deg = 1;      // a town may lie so far beside the area of its system
constexpr size_t kMaxRingsAsked = 20'000;  // for their right angles
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
constexpr std::array<SurfaceLook, 8> kLooks{{{"other", {0.40f, 0.385f, 0.36f, 1}},
                                             {"wall", {0.48f, 0.42f, 0.33f, 1}},
                                             {"roof", {0.36f, 0.13f, 0.08f, 1}},
                                             {"ground", {0.30f, 0.27f, 0.22f, 1}},
                                             {"grass", {0.13f, 0.15f, 0.07f, 1}},
                                             {"paving", {0.17f, 0.16f, 0.15f, 1}},
                                             {"plants", {0.10f, 0.15f, 0.05f, 1}},
                                             {"water", {0.08f, 0.13f, 0.15f, 1}}}};
static_assert(kLooks.size() == static_cast<size_t>(SurfaceKind::kNotSaid));
constexpr int kUntold = -1;  // a triangle's material

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

// Which of two coordinates in degrees is the longitude: where the system is used, then the houses' right angles, then
// as it was said (`swapped`).
Error ChooseAxes(const std::string& name, const MapSystem& system, Point2 middle, const std::vector<PlanRing>& rings,
                 bool* swapped, std::vector<std::string>* notes) {
  const bool said = *swapped;
  const auto possible = [&](Point2 p) {
    p = FromGreenwich(system, p);
    return std::abs(p.y) <= 90 && (!system.has_area || IsUsedAt(system, p, kBesideArea_deg));
  };
  const bool given = possible(middle), turned = possible({middle.y, middle.x});
  char at[80];
  std::snprintf(at, sizeof at, "(%.6g, %.6g)", middle.x, middle.y);
  if (!given && !turned)
    return Fail(std::string(at) + " is outside the area that '" + name + "' is for; are the degrees another system's?");
  const AxisEvidence evidence = AxesByRightAngles(rings, system.unit_deg);
  if (given != turned) *swapped = turned;
  else if (evidence != AxisEvidence::kNone) *swapped = evidence == AxisEvidence::kSwapped;
  if (*swapped != said)
    notes->push_back(std::string("the first coordinate was taken for the ") + (*swapped ? "latitude" : "longitude") +
                     ": so the town lies " + (given != turned ? "where the system is used" : "with right angles"));
  return Ok();
}

template <typename T>
std::vector<T> Joined(const std::vector<std::vector<T>>& rings) {
  std::vector<T> joined;
  for (const std::vector<T>& ring : rings) joined.insert(joined.end(), ring.begin(), ring.end());
  return joined;
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

int TownBuilder::ImageOf(int material) const { return At(materials_, material - Count(kLooks)).base_color_image; }

void TownBuilder::AddPolygon(int node, SurfaceKind surface, const std::vector<std::vector<Point3>>& rings,
                             const PolygonLook& look) {
  for (const auto& ring : rings)
    for (const Point3& p : ring) may_be_degrees_ &= std::abs(p.x) <= kMost_deg && std::abs(p.y) <= kMost_deg;
  const int kind = surface == SurfaceKind::kNotSaid ? kUntold : static_cast<int>(surface);
  const int material = look.material < 0 ? kind : look.material;
  if (may_be_degrees_) return waiting_.push_back({node, material, rings, look});
  TriangulateWaiting();
  Triangulate({node, material, rings, look});
}

void TownBuilder::TriangulateWaiting() {
  for (const WaitingPolygon& polygon : waiting_) Triangulate(polygon);
  waiting_ = {};
}

void TownBuilder::Triangulate(const WaitingPolygon& polygon) {
  std::vector<Point3> points;
  for (const auto& ring : polygon.rings) points.insert(points.end(), ring.begin(), ring.end());
  const std::vector<std::array<uint32_t, 3>> triangles = TriangulatePolygon(polygon.rings);
  if (triangles.empty()) ++without_area_;
  const std::vector<Vec2> uvs = Joined(polygon.look.uvs);
  const std::vector<Vec4> colors = Joined(polygon.look.colors);
  const std::vector<Vec3> normals = Joined(polygon.look.normals);
  const bool textured = uvs.size() == points.size(), colored = colors.size() == points.size();
  const bool smooth = normals.size() == points.size();
  for (const auto& [a, b, c] : triangles) {
    triangles_.push_back({polygon.node, polygon.material, points[a], points[b], points[c], textured ? Count(uvs_) : -1,
                          colored ? Count(colors_) : -1, smooth ? Count(normals_) : -1});
    if (textured) uvs_.insert(uvs_.end(), {uvs[a], uvs[b], uvs[c]});
    if (colored) colors_.insert(colors_.end(), {colors[a], colors[b], colors[c]});
    if (smooth) normals_.insert(normals_.end(), {normals[a], normals[b], normals[c]});
  }
}

bool TownBuilder::IsInDegrees() const {
  std::map<int, Extent> extents;  // by node
  for (const WaitingPolygon& polygon : waiting_)
    for (const auto& ring : polygon.rings)
      for (const Point3& p : ring) extents[polygon.node].Add(p);
  const auto in_degrees =
      std::count_if(extents.begin(), extents.end(), [](const auto& e) { return IsHouseInDegrees(e.second); });
  return 2 * static_cast<size_t>(in_degrees) > extents.size();
}

Error TownBuilder::DegreesToMetres(const CityCoordinates& coordinates, std::string* from, std::string* to,
                                   std::vector<std::string>* notes) {
  MapSystem system;
  const bool known = !coordinates.system.empty() && !FindMapSystem(coordinates.system, &system);
  if (known && !system.degrees)
    return Fail("the coordinates are degrees, but '" + coordinates.system +
                "' has metres; say which degrees they are: --crs EPSG:4326");
  *from = known ? coordinates.system : "EPSG:4326";
  if (!known && FindMapSystem(*from, &system)) return Fail("PROJ lacks its database; install proj-data");
  std::vector<Point2> points;
  std::vector<PlanRing> rings;
  for (const WaitingPolygon& polygon : waiting_) {
    for (const auto& ring : polygon.rings) {
      const size_t first = points.size();
      for (const Point3& p : ring) points.push_back({p.x, p.y});
      if (rings.size() < kMaxRingsAsked) rings.emplace_back(points.begin() + static_cast<long>(first), points.end());
    }
  }
  bool swapped = coordinates.axes_as_named && system.north_first;
  if (Error error = ChooseAxes(*from, system, Median(points), rings, &swapped, notes)) return error;
  if (!known)
    notes->push_back("the coordinates look like degrees and were taken for " + *from + "; --crs says otherwise");
  if (swapped)
    for (Point2& p : points) std::swap(p.x, p.y);
  std::vector<Point2> place{Median(points)};
  if (Error error = TransformPoints(*from, kLongitudeLatitude, &place)) return error;
  *to = MetricSystemAt(*from, place[0]);
  if (Error error = TransformPoints(*from, *to, &points)) return error;
  size_t next = 0;
  for (WaitingPolygon& polygon : waiting_)
    for (auto& ring : polygon.rings)
      for (Point3& p : ring) p.x = points[next].x, p.y = points[next].y, ++next;
  return Ok();
}

// Read with its axes swapped a town is its own mirror image, and its houses are inside out: their volumes are negative.
AxisEvidence TownBuilder::AxesByFaces() const {
  constexpr double kClearly = 0.5;  // of all that they enclose
  std::map<int, Extent> extents;    // by node
  for (const Triangle& t : triangles_)
    for (const Point3& p : {t.a, t.b, t.c}) extents[t.node].Add(p);
  std::map<int, double> volumes_m3;
  for (const Triangle& t : triangles_) {
    if (At(nodes_, t.node).kind != NodeKind::kBuilding) continue;
    const Extent& extent = extents.at(t.node);  // over its base, so that none is missing where that has no faces
    const auto from_base = [&](const Point3& p) {
      return Point3{p.x - extent.Middle().x, p.y - extent.Middle().y, p.z - extent.min.z};
    };
    const Point3 a = from_base(t.a), b = from_base(t.b), c = from_base(t.c);
    volumes_m3[t.node] +=
        (a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x)) / 6;
  }
  double sum_m3 = 0, all_m3 = 0;
  for (const auto& [_, volume_m3] : volumes_m3) sum_m3 += volume_m3, all_m3 += std::abs(volume_m3);
  if (!(std::abs(sum_m3) > kClearly * all_m3)) return AxisEvidence::kNone;
  return sum_m3 > 0 ? AxisEvidence::kAsGiven : AxisEvidence::kSwapped;
}

// Maps of metres stay, but where the authority's axes are the other way round.
Error TownBuilder::MapToMetres(const CityCoordinates& coordinates, std::string* from, std::string* to,
                               std::vector<std::string>* notes) {
  MapSystem system;
  *to = coordinates.system;
  if (coordinates.system.empty() || FindMapSystem(coordinates.system, &system) || !system.other_unit.empty() ||
      system.degrees || !system.has_area)
    return Ok();
  std::vector<Point2> points;
  for (const Triangle& t : triangles_)
    for (const Point3& p : {t.a, t.b, t.c}) points.push_back({p.x, p.y});
  Point2 middle = Median(points);
  const auto lies_there = [&](Point2 p) {
    Point2 place;
    return FindRoughPlace(coordinates.system, p, &place) && IsUsedAt(system, place, kBesideArea_deg);
  };
  const bool given = lies_there(middle), turned = lies_there({middle.y, middle.x});
  const bool said = coordinates.axes_as_named && system.north_first;
  const AxisEvidence evidence = given && turned ? AxesByFaces() : AxisEvidence::kNone;
  const bool swapped = given != turned                   ? turned
                       : evidence == AxisEvidence::kNone ? said && given
                                                         : evidence == AxisEvidence::kSwapped;
  if (given && turned && swapped != said)
    notes->push_back(std::string("the first coordinate was taken for the ") + (swapped ? "northing" : "easting") +
                     ": so the houses' faces look outwards");
  if (swapped) {
    middle = {middle.y, middle.x};
    for (Point2& p : points) std::swap(p.x, p.y);
    if (!given && !said)
      notes->push_back("northings stand before eastings: the coordinates lie in the area of '" + coordinates.system +
                       "' only so; they were swapped");
  } else if (!given) {
    return Ok();  // said elsewhere
  }
  if (!IsMapOfMetres(coordinates.system, middle)) {
    std::vector<Point2> place{middle};
    if (Error error = TransformPoints(coordinates.system, kLongitudeLatitude, &place)) return error;
    *from = coordinates.system;
    *to = MetricSystemAt(*from, place[0]);
    if (Error error = TransformPoints(*from, *to, &points)) return error;
  } else if (!swapped) {
    return Ok();
  }
  size_t next = 0;
  for (Triangle& t : triangles_)
    for (Point3* p : {&t.a, &t.b, &t.c}) p->x = points[next].x, p->y = points[next].y, ++next;
  return Ok();
}

Error TownBuilder::CheckReach() const {
  for (const Triangle& t : triangles_)
    for (const Point3& p : {t.a, t.b, t.c})
      if (!(std::abs(p.x) < kFarthest && std::abs(p.y) < kFarthest && std::abs(p.z) < kFarthest))
        return Fail("'" + At(nodes_, t.node).name +
                    "' reaches farther than any map: a coordinate is beyond 100,000 km in millimetres");
  return Ok();
}

std::string TownBuilder::TellWithoutFaces() const {
  std::vector<bool> has_faces(nodes_.size(), false);
  for (const Triangle& t : triangles_)
    for (int node = t.node; node >= 0 && !has_faces[static_cast<size_t>(node)]; node = At(nodes_, node).parent)
      has_faces[static_cast<size_t>(node)] = true;
  std::vector<std::string> names;
  for (size_t i = 0; i < nodes_.size(); ++i)
    if (nodes_[i].kind == NodeKind::kBuilding && !has_faces[i]) names.push_back(nodes_[i].name);
  if (names.empty()) return {};
  const std::string few = names.size() == 1 ? "" : " and " + std::to_string(names.size() - 1) + " more buildings";
  return "'" + names[0] + "'" + few + (few.empty() ? " has" : " have") +
         " no faces in the levels of detail from 1 to 3";
}

Error TownBuilder::Finish(const std::string& file, const CityCoordinates& coordinates, Scene* scene,
                          std::string* source_system, std::vector<std::string>* warnings) {
  std::string from, to = coordinates.system;
  std::vector<std::string> notes;
  const auto named = [&](const Error& error) { return Fail(OneLine(file + ": " + error.message)); };
  MapSystem system;
  const bool stated = !to.empty() && !FindMapSystem(to, &system) && system.degrees;
  if (!waiting_.empty() && (stated || IsInDegrees()))
    if (Error error = DegreesToMetres(coordinates, &from, &to, &notes)) return named(error);
  TriangulateWaiting();
  if (without_area_ > 0)
    notes.push_back(std::to_string(without_area_) +
                    " faces have fewer than three corners or no area; they were left out");
  const std::string without_faces = TellWithoutFaces();
  if (triangles_.empty())
    return named(Fail("holds no face with an area, so there is no town in it" +
                      (without_faces.empty() ? "" : ": " + without_faces)));
  if (!without_faces.empty()) notes.push_back(without_faces + "; left out");
  if (Error error = CheckReach()) return named(error);
  if (from.empty() && stated)
    return named(
        Fail("'" + to + "' has degrees, but the coordinates are beyond 180; say what they are: --crs EPSG:25832"));
  if (from.empty())
    if (Error error = MapToMetres(coordinates, &from, &to, &notes)) return named(error);
  if (warnings)
    for (const std::string& note : notes) warnings->push_back(OneLine(file + ": " + note));
  *scene = {};
  scene->reference_system = to;
  if (source_system) *source_system = from;
  Build(scene);
  return Ok();
}

// Flat roofs have no tiles.
void TownBuilder::TellSurfaces() {
  constexpr double kSteep = 0.3, kFlat = 0.985;  // of a unit normal's height
  for (Triangle& t : triangles_) {
    if (t.material != kUntold) continue;
    const Point3 u{t.b.x - t.a.x, t.b.y - t.a.y, t.b.z - t.a.z}, v{t.c.x - t.a.x, t.c.y - t.a.y, t.c.z - t.a.z};
    const double x = u.y * v.z - u.z * v.y, y = u.z * v.x - u.x * v.z, z = u.x * v.y - u.y * v.x;
    const double up = std::abs(z) / std::max(std::hypot(x, y, z), 1e-12);
    t.material = static_cast<int>(up > kFlat    ? SurfaceKind::kOther
                                  : up > kSteep ? SurfaceKind::kRoof
                                                : SurfaceKind::kWall);
  }
}

void TownBuilder::Build(Scene* scene) {
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
  TellSurfaces();
  AddTriangles(scene);
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
    for (int k = 0; k < 3 && t.first_normal >= 0; ++k)
      mesh.normals[mesh.normals.size() - 3 + static_cast<size_t>(k)] = GltfFromGround(At(normals_, t.first_normal + k));
    if (t.first_color >= 0) mesh.colors.resize(mesh.positions.size() - 3, {1, 1, 1, 1});
    for (int k = 0; k < 3 && t.first_color >= 0; ++k) mesh.colors.push_back(At(colors_, t.first_color + k));
    if (t.first_color < 0 && !mesh.colors.empty()) mesh.colors.resize(mesh.positions.size(), {1, 1, 1, 1});
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
