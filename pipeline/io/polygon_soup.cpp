#include "pipeline/io/polygon_soup.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/srgb.h"

namespace flaneur {
namespace {

// A town this much wider than high along one axis has that axis upright.
constexpr double kFlatter = 0.5;
// A face stands upright where its normal's share along the axis is below this.
constexpr double kUpright = 0.02;
// Map coordinates: eastings and northings are far larger than heights.
constexpr double kMapCoordinate_m = 10'000;

// Of the faces that stand along each axis: walls stand along the axis that is up, roofs and floors along none or
// another.
Point3 StandingArea_m2(const PolygonSoup& soup) {
  Point3 standing{};
  size_t corner = 0;
  for (const uint32_t size : soup.sizes) {
    Point3 normal{};  // twice the area long
    for (uint32_t i = 0; i < size; ++i) {
      const Point3& a = soup.points[soup.corners[corner + i]];
      const Point3& b = soup.points[soup.corners[corner + (i + 1) % size]];
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

// Of a face's corners, or empty where one of them has none.
std::vector<Vec3> NormalsOf(const PolygonSoup& soup, size_t corner, size_t size, UpAxis up) {
  std::vector<Vec3> normals;
  for (size_t i = 0; i < size; ++i) {
    const uint32_t normal = soup.corner_normals[corner + i];
    if (normal == PolygonSoup::kNone || !(Length(soup.normals[normal]) > 0.5f)) return {};
    normals.push_back(WithZUp(soup.normals[normal], up));
  }
  return normals;
}

// The same of their places in the picture, which glTF counts from the upper edge.
std::vector<Vec2> PlacesOf(const PolygonSoup& soup, size_t corner, size_t size, const FaceLook& look) {
  std::vector<Vec2> places;
  for (size_t i = 0; i < size; ++i) {
    const uint32_t place = soup.corner_places[corner + i];
    if (place == PolygonSoup::kNone) return {};
    const float u = soup.places[place].x * look.uv_scale.x + look.uv_offset.x;
    const float v = 1 - (soup.places[place].y * look.uv_scale.y + look.uv_offset.y);
    if (!std::isfinite(u) || !std::isfinite(v)) return {};
    places.push_back({u, v});
  }
  return places;
}

}  // namespace

UpAxis UpOf(const PolygonSoup& soup, UpAxis up, const std::string& file, const char* format,
            std::vector<std::string>* warnings) {
  if (up != UpAxis::kJudged) return up;
  Point3 min{1e300, 1e300, 1e300}, max{-1e300, -1e300, -1e300};
  for (const uint32_t corner : soup.corners) {
    const Point3& p = soup.points[corner];
    min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
    max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
  }
  const double y = max.y - min.y, z = max.z - min.z;
  const auto far = [](double low, double high) { return std::abs(low + high) / 2 > kMapCoordinate_m; };
  const bool on_map = far(min.x, max.x) && far(min.y, max.y) && !far(min.z, max.z);
  const bool by_extents = z < kFlatter * y || y < kFlatter * z;
  const Point3 standing = StandingArea_m2(soup);
  const bool y_up = !on_map && (by_extents ? y < z : standing.y >= standing.z);
  if (warnings)
    warnings->push_back(file + ": " + format + " does not say which way is up; taken for " + (y_up ? "y" : "z") +
                        (on_map       ? ", as x and y are map coordinates"
                         : by_extents ? ", judging by the extents"
                                      : ", judging by the walls") +
                        "; the option 'up' says otherwise");
  return y_up ? UpAxis::kY : UpAxis::kZ;
}

Vec4 ColorOfPoint(double red, double green, double blue) {
  const auto linear = [](double v) { return LinearFromSrgb(static_cast<float>(std::clamp(v, 0.0, 1.0))); };
  return {linear(red), linear(green), linear(blue), 1};
}

Vec3 UnitNormal(double x, double y, double z) {
  return Normalized(Vec3{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
}

Material WhiteMaterial() {
  Material white;
  white.name = "colored";
  white.double_sided = true;
  return white;
}

void AddFace(const PolygonSoup& soup, size_t corner, size_t size, UpAxis up, const FaceLook& look, int node,
             TownBuilder* builder) {
  std::vector<Point3> ring;
  for (size_t i = 0; i < size; ++i) ring.push_back(WithZUp(soup.points[soup.corners[corner + i]], up));
  PolygonLook polygon{look.material, {}, {}, {}};
  if (auto normals = NormalsOf(soup, corner, size, up); !normals.empty()) polygon.normals = {std::move(normals)};
  if (look.has_picture)
    if (auto places = PlacesOf(soup, corner, size, look); !places.empty()) polygon.uvs = {std::move(places)};
  if (!soup.colors.empty()) {
    std::vector<Vec4>& colors = polygon.colors.emplace_back();
    for (size_t i = 0; i < size; ++i) {
      const uint32_t point = soup.corners[corner + i];
      colors.push_back(point < soup.colors.size() ? soup.colors[point] : Vec4{1, 1, 1, 1});
    }
  }
  builder->AddPolygon(node, SurfaceKind::kWall, {std::move(ring)}, polygon);
}

}  // namespace flaneur
