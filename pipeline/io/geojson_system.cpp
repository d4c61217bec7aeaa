#include "pipeline/io/geojson_system.h"

#include <algorithm>
#include <cmath>

#include "pipeline/io/map_projection.h"
#include "pipeline/io/town_builder.h"

namespace flaneur {
namespace {

constexpr double kFarFromOrigin_m = 10'000;  // coordinates further away are moved near zero
constexpr double kNullIsland_deg = 1;        // nobody's town is that near to longitude and latitude zero
constexpr double kHouse_deg = 5e-4;          // houses are smaller than this (50 m), and no house is in metres

constexpr double kElsewhere_m = 100'000;  // no town is as wide as that

using Points = std::vector<Point2>;

class Systems {
 public:
  Systems(const StatedSystem& stated, GeoJsonFile* file) : stated_(stated), file_(*file) {
    ForEachPoint(&file_, [&](Point2& p) { points_.push_back(p); });
  }

  Error Run() {
    if (points_.empty()) return Ok();
    FindMiddle();
    if (stated_.units == GeoJsonUnits::kDegrees || (stated_.units == GeoJsonUnits::kAuto && stated_.system.empty()))
      return Degrees(kLongitudeLatitude, "longitude and latitude");
    if (stated_.units == GeoJsonUnits::kAuto) return Named();
    if (LooksLikeDegrees()) return Other("metres", "longitudes and latitudes", kLongitudeLatitude);
    if (!stated_.local) MoveNearZero();
    return Ok();
  }

 private:
  void FindMiddle() { middle_ = Median(points_); }

  static bool OnEarth(Point2 p, double unit_deg = 1) {
    return std::abs(p.x) * unit_deg <= 180 && std::abs(p.y) * unit_deg <= 90;
  }

  bool MostlyOffEarth(double unit_deg = 1) const {
    size_t finite = 0, off = 0;
    for (const Point2& p : points_)
      if (std::isfinite(p.x) && std::isfinite(p.y)) ++finite, off += !OnEarth(p, unit_deg);
    return 2 * off > finite;
  }

  // Metres would make houses of a tenth of a millimetre.
  bool LooksLikeDegrees() const {
    if (std::hypot(middle_.x, middle_.y) < kNullIsland_deg || !OnEarth(middle_)) return false;
    size_t small = 0, rings = 0;
    for (const Obstacle& o : file_.footprints.obstacles) {
      if (o.outer.size() < 3) continue;
      Point2 min = o.outer[0], max = o.outer[0];
      for (const Point2& p : o.outer) {
        min = {std::min(min.x, p.x), std::min(min.y, p.y)};
        max = {std::max(max.x, p.x), std::max(max.y, p.y)};
      }
      ++rings;
      small += max.x - min.x < kHouse_deg && max.y - min.y < kHouse_deg;
    }
    return rings > 0 && 2 * small > rings;
  }

  Error Other(const std::string& stated, const std::string& seen, const std::string& as) {
    file_.faults.push_back(
        {GeoJsonFaultKind::kOtherSystem, "", "stated are " + stated + ", but the coordinates are " + seen});
    if (!as.empty()) return Transform(as);
    MoveNearZero();
    return Ok();
  }

  Error Degrees(const std::string& system, const std::string& stated, double unit_deg = 1) {
    if (MostlyOffEarth(unit_deg)) return Other(stated, "beyond 180 and 90 degrees; read as metres", "");
    return Transform(system);
  }

  Error Named() {
    MapSystem system;
    if (Error error = FindMapSystem(stated_.system, &system)) {
      file_.faults.push_back({GeoJsonFaultKind::kUnknownSystem, "", error.message});
      return MostlyOffEarth() ? (MoveNearZero(), Ok()) : Transform(kLongitudeLatitude);
    }
    if (system.degrees) return Degrees(stated_.system, "degrees of " + stated_.system, system.unit_deg);
    if (LooksLikeDegrees()) return Other(stated_.system, "longitudes and latitudes", kLongitudeLatitude);
    Points place{middle_};
    if (Error error = TransformPoints(stated_.system, kLongitudeLatitude, &place)) return error;
    if (!IsUsedAt(system, place[0]))
      return Other(stated_.system, "outside the area that it is for; read as metres", "");
    if (!IsMapOfMetres(stated_.system, middle_)) return Transform(stated_.system);
    file_.footprints.reference_system = PlainReferenceSystem(stated_.system);
    MoveNearZero();
    return Ok();
  }

  Error Transform(const std::string& system) {
    Points place{middle_};
    if (Error error = TransformPoints(system, kLongitudeLatitude, &place)) return error;
    file_.system = system;
    file_.local_system = LocalMapSystem(place[0]);
    if (Error error = TransformPoints(system, file_.local_system, &points_)) return error;
    size_t next = 0;
    ForEachPoint(&file_, [&](Point2& p) { p = points_[next++]; });
    return Ok();
  }

  void MoveNearZero() {
    if (std::abs(middle_.x) < kFarFromOrigin_m && std::abs(middle_.y) < kFarFromOrigin_m) return;
    if (std::abs(middle_.x) > 1e8 || std::abs(middle_.y) > 1e8) return;
    const Point2 move{std::floor(middle_.x / 1000) * 1000, std::floor(middle_.y / 1000) * 1000};
    ForEachPoint(&file_, [&](Point2& p) { p = {p.x - move.x, p.y - move.y}; });
    Point2& origin = file_.footprints.origin_m;
    origin = {origin.x + move.x, origin.y + move.y};
    file_.moved_m = move;
  }

  const StatedSystem& stated_;
  GeoJsonFile& file_;
  Points points_;
  Point2 middle_;
};

}  // namespace

void ForEachPoint(GeoJsonFile* file, const std::function<void(Point2&)>& function) {
  for (Obstacle& o : file->footprints.obstacles) {
    for (Point2& p : o.outer) function(p);
    for (auto& hole : o.holes)
      for (Point2& p : hole) function(p);
    if (o.outer.empty()) function(o.center);
  }
  for (GatePoint& place : file->places) function(place.at);
  for (Way& way : file->ways)
    for (Point2& p : way.points) function(p);
}

void MoveBy(Point2 shift_m, GeoJsonFile* file) {
  ForEachPoint(file, [&](Point2& p) { p = {p.x + shift_m.x, p.y + shift_m.y}; });
  Point2& from = file->system.empty() ? file->moved_m : file->local_origin_m;
  from = {from.x - shift_m.x, from.y - shift_m.y};
}

Error ToLocalMetres(const StatedSystem& stated, GeoJsonFile* file) { return Systems(stated, file).Run(); }

Error MoveToTown(const std::string& town_system, Point2 origin_m, GeoJsonFile* file) {
  std::string reference_system = town_system;
  if (reference_system.empty() && !file->system.empty() && !file->town_system.empty()) {
    reference_system = file->town_system;
    if (origin_m.x == 0 && origin_m.y == 0) origin_m = file->town_origin_m;
  }
  const bool placed = !reference_system.empty() || origin_m.x != 0 || origin_m.y != 0;
  if (!placed || !file->has_origin) return Ok();
  const auto elsewhere = [&](const std::string& why) {
    file->faults.push_back({GeoJsonFaultKind::kElsewhere, "", why});
    return Ok();
  };
  const bool transformed = !file->system.empty();
  MapSystem map;
  const bool named = !reference_system.empty() && !FindMapSystem(reference_system, &map) && !map.degrees;
  if (transformed && !named)
    return elsewhere("the obstacles are in " + file->system + ", the town is in " +
                     (reference_system.empty() ? "a system that it does not name" : "'" + reference_system + "'"));
  const std::string from = transformed ? file->local_system : file->footprints.reference_system;
  const Point2 old = transformed ? file->local_origin_m : file->footprints.origin_m;
  Points points;
  ForEachPoint(file, [&](const Point2& p) { points.push_back({p.x + old.x, p.y + old.y}); });
  const bool other_system = named && !from.empty() && from != reference_system;
  if (other_system)
    if (Error error = TransformPoints(from, reference_system, &points)) return error;
  const auto far = [&](Point2 p) { return std::hypot(p.x - origin_m.x, p.y - origin_m.y) > kElsewhere_m; };
  if (2 * std::count_if(points.begin(), points.end(), far) > static_cast<std::ptrdiff_t>(points.size()))
    return elsewhere("most obstacles are more than 100 km from the town");
  size_t next = 0;
  ForEachPoint(file, [&](Point2& p) { p = {points[next].x - origin_m.x, points[next].y - origin_m.y}, ++next; });
  Point2& moved = file->moved_m;
  if (other_system) {
    if (!transformed) file->system = from, moved = {moved.x - old.x, moved.y - old.y};
    file->local_system = reference_system;
    file->local_origin_m = origin_m;
  } else {
    moved = {moved.x + origin_m.x - old.x, moved.y + origin_m.y - old.y};
  }
  file->footprints.origin_m = origin_m;
  file->footprints.reference_system = reference_system;
  return Ok();
}

std::vector<Point2> ToFileCoordinates(const GeoJsonFile& file, std::vector<Point2> points) {
  for (Point2& p : points) p = {p.x + file.local_origin_m.x, p.y + file.local_origin_m.y};
  if (!file.system.empty() && !TransformPoints(file.local_system, file.system, &points)) return points;
  for (Point2& p : points) p = {p.x + file.moved_m.x, p.y + file.moved_m.y};
  return points;
}

}  // namespace flaneur
