#include "pipeline/io/map_projection.h"

#include <proj.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>

#include "runtime/base/limits.h"

namespace flaneur {
namespace {

constexpr double kPlaceGrain_deg = 0.1;  // to which the place is rounded at which a way is chosen
constexpr double kBesideUse_deg = 0.25;  // towns may reach this far over the border of a system's area

struct Free {
  void operator()(PJ_CONTEXT* context) const { proj_context_destroy(context); }
  void operator()(PJ* object) const { proj_destroy(object); }
};
using Context = std::unique_ptr<PJ_CONTEXT, Free>;
using Object = std::unique_ptr<PJ, Free>;

// Quiet: what goes wrong is said by our own errors. No grids from the network. One for each thread, as each opens
// PROJ's database anew.
PJ_CONTEXT* ThreadsContext() {
  thread_local const Context context = [] {
    Context quiet(proj_context_create());
    proj_log_level(quiet.get(), PJ_LOG_NONE);
    proj_context_set_enable_network(quiet.get(), 0);
    return quiet;
  }();
  return context.get();
}

// The unit's name where it is neither metre nor an angle.
std::string OtherUnit(PJ_CONTEXT* context, const PJ* plane) {
  const Object axes(proj_crs_get_coordinate_system(context, plane));
  double metres = 1;
  const char* name = nullptr;
  if (!axes ||
      !proj_cs_get_axis_info(context, axes.get(), 0, nullptr, nullptr, nullptr, &metres, &name, nullptr, nullptr))
    return {};
  return std::abs(metres - 1) < 1e-9 || !name ? "" : name;
}

bool FirstAxisIsNorth(PJ_CONTEXT* context, const PJ* plane) {
  const Object axes(proj_crs_get_coordinate_system(context, plane));
  const char* direction = nullptr;
  return axes &&
         proj_cs_get_axis_info(context, axes.get(), 0, nullptr, nullptr, &direction, nullptr, nullptr, nullptr,
                               nullptr) &&
         direction && std::string(direction) == "north";
}

// What one of a system's coordinates is, in degrees, and where its longitudes count from.
void FindDegrees(PJ_CONTEXT* context, const PJ* plane, MapSystem* system) {
  constexpr double kDegree = 3.14159265358979323846 / 180;
  const Object axes(proj_crs_get_coordinate_system(context, plane)), meridian(proj_get_prime_meridian(context, plane));
  double unit = kDegree, from = 0, from_unit = kDegree;
  if (axes &&
      proj_cs_get_axis_info(context, axes.get(), 0, nullptr, nullptr, nullptr, &unit, nullptr, nullptr, nullptr))
    system->unit_deg = std::abs(unit / kDegree - 1) < 1e-9 ? 1 : unit / kDegree;
  if (meridian && proj_prime_meridian_get_parameters(context, meridian.get(), &from, &from_unit, nullptr))
    system->meridian_deg = from * from_unit / kDegree;
}

// Those whose area of use holds the place: code and name.
std::vector<std::pair<std::string, std::string>> ProjectedSystemsAt(PJ_CONTEXT* context, Point2 place) {
  PROJ_CRS_LIST_PARAMETERS* const wish = proj_get_crs_list_parameters_create();
  const PJ_TYPE projected = PJ_TYPE_PROJECTED_CRS;
  wish->types = &projected, wish->typesCount = 1;
  wish->bbox_valid = 1, wish->crs_area_of_use_contains_bbox = 1;
  wish->west_lon_degree = wish->east_lon_degree = place.x;
  wish->south_lat_degree = wish->north_lat_degree = place.y;
  int count = 0;
  PROJ_CRS_INFO** const list = proj_get_crs_info_list_from_database(context, "EPSG", wish, &count);
  proj_get_crs_list_parameters_destroy(wish);
  std::vector<std::pair<std::string, std::string>> systems;
  for (int i = 0; list && i < count; ++i) systems.emplace_back(std::string("EPSG:") + list[i]->code, list[i]->name);
  proj_crs_info_list_destroy(list);
  return systems;
}

// "EPSG:25832"; empty where the datum has none there.
std::string UtmZoneAt(PJ_CONTEXT* context, const std::string& datum, Point2 place) {
  const std::string zone = datum + " / UTM zone ";
  for (const auto& [code, name] : ProjectedSystemsAt(context, place))
    if (name.starts_with(zone) && name.find('(', zone.size()) == std::string::npos) return code;
  return {};
}

// The part for the plane of a system with heights of its own.
Object PlaneOf(PJ_CONTEXT* context, Object system) {
  if (!system || proj_get_type(system.get()) != PJ_TYPE_COMPOUND_CRS) return system;
  return Object(proj_crs_get_sub_crs(context, system.get(), 0));
}

Object MakeSystem(PJ_CONTEXT* context, const std::string& name) {
  if (name.size() > kMostText_bytes) return nullptr;
  Object object(proj_create(context, name.c_str()));
  if (object && !proj_is_crs(object.get())) object.reset();
  return object;
}

// A system's way to longitude and latitude. Between many systems PROJ knows several, each good for a part of the world
// and some metres apart: the best one at a place that needs nothing which is not installed. Always asked for in this
// direction and used backwards too, so that there and back meet again.
Object WayToEarth(PJ_CONTEXT* context, const std::string& name, Point2 place) {
  const Object system = PlaneOf(context, MakeSystem(context, name));
  const Object earth = MakeSystem(context, kLongitudeLatitude);
  const std::unique_ptr<PJ_OPERATION_FACTORY_CONTEXT, decltype(&proj_operation_factory_context_destroy)> wish(
      proj_create_operation_factory_context(context, nullptr), &proj_operation_factory_context_destroy);
  if (!system || !earth || !wish) return nullptr;
  const double reach = kPlaceGrain_deg / 2;
  proj_operation_factory_context_set_area_of_interest(context, wish.get(), place.x - reach, place.y - reach,
                                                      place.x + reach, place.y + reach);
  proj_operation_factory_context_set_spatial_criterion(context, wish.get(),
                                                       PROJ_SPATIAL_CRITERION_PARTIAL_INTERSECTION);
  proj_operation_factory_context_set_grid_availability_use(context, wish.get(),
                                                           PROJ_GRID_AVAILABILITY_DISCARD_OPERATION_IF_MISSING_GRID);
  const std::unique_ptr<PJ_OBJ_LIST, decltype(&proj_list_destroy)> ways(
      proj_create_operations(context, system.get(), earth.get(), wish.get()), &proj_list_destroy);
  for (int i = 0; ways && i < proj_list_get_count(ways.get()); ++i) {
    const Object way(proj_list_get(context, ways.get(), i));
    if (way && proj_coordoperation_is_instantiable(context, way.get()))
      return Object(proj_normalize_for_visualization(context, way.get()));
  }
  return nullptr;
}

// To longitude and latitude on a system's own datum, which is some hundred metres off at most; `own` says in which unit
// and from where. Nothing has to be looked for, as it has where the datum changes: that takes most of a second where
// many ways are known.
Object WayToOwnDegrees(PJ_CONTEXT* context, const std::string& name, MapSystem* own) {
  const Object system = PlaneOf(context, MakeSystem(context, name));
  const Object degrees(system ? proj_crs_get_geodetic_crs(context, system.get()) : nullptr);
  if (!degrees) return nullptr;
  FindDegrees(context, degrees.get(), own);
  const Object way(proj_create_crs_to_crs_from_pj(context, system.get(), degrees.get(), nullptr, nullptr));
  return Object(way ? proj_normalize_for_visualization(context, way.get()) : nullptr);
}

// Finding a way takes longer than to transform a town's points, so the last ones are kept.
class Ways {
 public:
  // Null where there is none.
  PJ* ToEarth(const std::string& system, Point2 place) {
    const auto grain = [](double degrees) { return std::round(degrees / kPlaceGrain_deg) * kPlaceGrain_deg; };
    place = {grain(place.x), grain(place.y)};
    for (const Way& way : ways_)
      if (way.system == system && way.place.x == place.x && way.place.y == place.y) return way.transform.get();
    if (ways_.size() == kMaxKeptWays) ways_.erase(ways_.begin());
    ways_.push_back({system, place, WayToEarth(context_, system, place)});
    return ways_.back().transform.get();
  }

  // The way at a point of the system, which becomes its place on earth. The way that its own datum's degrees give first
  // is asked where it leads, and chosen there: whoever comes back from the place finds the same one.
  PJ* FromPoint(const std::string& system, Point2* p) {
    const Point2 point = *p;
    if (!Roughly(system, p)) return nullptr;
    const auto earth = [](Point2 q) { return std::isfinite(q.x) && std::isfinite(q.y) ? q : Point2{}; };
    PJ* const first = ToEarth(system, *p = earth(*p));
    if (!first) return nullptr;
    const PJ_COORD reached = proj_trans(first, PJ_FWD, proj_coord(point.x, point.y, 0, HUGE_VAL));
    return ToEarth(system, *p = earth({reached.xy.x, reached.xy.y}));
  }

  // False where there is none.
  bool Roughly(const std::string& system, Point2* p) {
    if (system == kLongitudeLatitude) return true;
    if (rough_system_ != system) {
      rough_system_ = system;
      rough_degrees_ = {};
      rough_ = WayToOwnDegrees(context_, system, &rough_degrees_);
    }
    if (!rough_) return false;
    const PJ_COORD out = proj_trans(rough_.get(), PJ_FWD, proj_coord(p->x, p->y, 0, HUGE_VAL));
    *p = FromGreenwich(rough_degrees_, {out.xy.x, out.xy.y});
    return true;
  }

 private:
  static constexpr size_t kMaxKeptWays = 8;
  struct Way {
    std::string system;
    Point2 place;
    Object transform;
  };
  PJ_CONTEXT* context_ = ThreadsContext();  // made first, so that it outlives the ways
  std::vector<Way> ways_;
  std::string rough_system_;
  MapSystem rough_degrees_;
  Object rough_;
};

Ways& KnownWays() {
  thread_local Ways ways;
  return ways;
}

// The place that leads to `p`. PROJ's own inverse forgets the height that a change of datum gave, which costs up to
// some millimetres; what is missing then is taken off once.
PJ_COORD Backwards(PJ* way, PJ_COORD p) {
  const PJ_COORD near = proj_trans(way, PJ_INV, p), reached = proj_trans(way, PJ_FWD, near);
  const double dx = p.xy.x - reached.xy.x, dy = p.xy.y - reached.xy.y;
  constexpr double kMost_deg = 1e-3;  // more is no rounding: the other side of the date line
  if (!(std::abs(dx) < kMost_deg && std::abs(dy) < kMost_deg)) return near;
  return proj_trans(way, PJ_INV, proj_coord(p.xy.x + dx, p.xy.y + dy, 0, HUGE_VAL));
}

}  // namespace

Point2 Median(const std::vector<Point2>& points) {
  std::vector<double> x, y;
  for (const Point2& p : points)
    if (std::isfinite(p.x) && std::isfinite(p.y)) x.push_back(p.x), y.push_back(p.y);
  if (x.empty()) return {};
  const auto middle = [](std::vector<double>* values) {
    const auto at = values->begin() + static_cast<std::ptrdiff_t>(values->size() / 2);
    std::nth_element(values->begin(), at, values->end());
    return *at;
  };
  return {middle(&x), middle(&y)};
}

std::string LocalMapSystem(Point2 longitude_latitude) {
  char text[120];
  std::snprintf(text, sizeof text,
                "+proj=tmerc +lat_0=%.2f +lon_0=%.2f +k=1 +x_0=0 +y_0=0 +datum=WGS84 +units=m +type=crs",
                longitude_latitude.y, longitude_latitude.x);
  return text;
}

bool FindRoughPlace(const std::string& system, Point2 at, Point2* longitude_latitude) {
  *longitude_latitude = at;
  return KnownWays().Roughly(system, longitude_latitude) && std::isfinite(longitude_latitude->x) &&
         std::isfinite(longitude_latitude->y);
}

Error TransformPoints(const std::string& from, const std::string& to, std::vector<Point2>* points) {
  Ways& ways = KnownWays();
  if (from == to) return Ok();
  const Error none = Fail("no way from coordinate system '" + from + "' to '" + to + "'");
  Point2 place = Median(*points);
  PJ* const there = from == kLongitudeLatitude ? nullptr : ways.FromPoint(from, &place);
  PJ* const back = to == kLongitudeLatitude ? nullptr : ways.ToEarth(to, place);
  if ((!there && from != kLongitudeLatitude) || (!back && to != kLongitudeLatitude)) return none;
  for (Point2& p : *points) {
    PJ_COORD q = proj_coord(p.x, p.y, 0, HUGE_VAL);
    if (there) q = proj_trans(there, PJ_FWD, q);
    if (back) q = Backwards(back, q);
    const bool found = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(q.xy.x) && std::isfinite(q.xy.y);
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    p = found ? Point2{q.xy.x, q.xy.y} : Point2{kNone, kNone};
  }
  return Ok();
}

Error FindMapSystem(const std::string& name, MapSystem* system) {
  PJ_CONTEXT* const context = ThreadsContext();
  const Object object = MakeSystem(context, name);
  if (!object) return Fail("coordinate system '" + name + "' is not known");
  *system = {};
  Object plane = PlaneOf(context, Object(proj_clone(context, object.get())));
  if (plane && proj_get_type(plane.get()) == PJ_TYPE_BOUND_CRS) plane.reset(proj_get_source_crs(context, plane.get()));
  const PJ_TYPE type = plane ? proj_get_type(plane.get()) : PJ_TYPE_UNKNOWN;
  if (type == PJ_TYPE_UNKNOWN || type == PJ_TYPE_VERTICAL_CRS || type == PJ_TYPE_GEOCENTRIC_CRS)
    return Fail("coordinate system '" + name + "' is none of a map");
  system->degrees = type == PJ_TYPE_GEOGRAPHIC_2D_CRS || type == PJ_TYPE_GEOGRAPHIC_3D_CRS;
  if (system->degrees) FindDegrees(context, plane.get(), system);
  else system->other_unit = OtherUnit(context, plane.get());
  system->north_first = FirstAxisIsNorth(context, plane.get());
  const char* area = nullptr;
  double w = 0, s = 0, e = 0, n = 0;
  if (proj_get_area_of_use(context, object.get(), &w, &s, &e, &n, &area) && w > -1000) {
    system->has_area = true;
    system->west = w, system->south = s, system->east = e, system->north = n;
  }
  return Ok();
}

Point2 FromGreenwich(const MapSystem& system, Point2 p) {
  const double longitude = p.x * system.unit_deg + system.meridian_deg;
  return {system.meridian_deg == 0 ? longitude : std::remainder(longitude, 360.0), p.y * system.unit_deg};
}

std::string MetricSystemAt(const std::string& system, Point2 place) {
  PJ_CONTEXT* const context = ThreadsContext();
  const Object plane = PlaneOf(context, MakeSystem(context, system));
  const Object base(plane ? proj_crs_get_geodetic_crs(context, plane.get()) : nullptr);
  const char* const datum = base ? proj_get_name(base.get()) : nullptr;
  for (const std::string& name : {std::string(datum ? datum : "WGS 84"), std::string("WGS 84")}) {
    const std::string code = UtmZoneAt(context, name, place);
    if (!code.empty()) return code;
  }
  return LocalMapSystem(place);
}

std::vector<std::string> SystemsThatPut(Point2 at, Point2 place, double within_m) {
  constexpr double kDegree_m = 111'000, kRadian = 3.14159265358979323846 / 180;
  PJ_CONTEXT* const context = ThreadsContext();
  std::vector<std::pair<double, std::string>> found;
  for (const auto& [code, name] : ProjectedSystemsAt(context, place)) {
    if (name.find("(N-E)") != std::string::npos) continue;  // another one with its axes turned
    std::vector<Point2> there{at};
    if (TransformPoints(code, kLongitudeLatitude, &there)) continue;
    const double apart_m =
        kDegree_m * std::hypot((there[0].x - place.x) * std::cos(place.y * kRadian), there[0].y - place.y);
    if (apart_m < within_m) found.emplace_back(std::round(apart_m * 100), code);
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> systems;
  for (auto& [apart, code] : found) systems.push_back(std::move(code));
  return systems;
}

bool IsMapOfMetres(const std::string& system, Point2 at_m) {
  constexpr double kSide_m = 100, kStretched = 0.005, kMaxTurn = 0.5;  // the cosine of 60 degrees
  std::vector<Point2> place{at_m}, corners{at_m, {at_m.x + kSide_m, at_m.y}, {at_m.x, at_m.y + kSide_m}};
  if (TransformPoints(system, kLongitudeLatitude, &place)) return true;
  if (TransformPoints(system, LocalMapSystem(place[0]), &corners)) return true;
  const Point2 x{corners[1].x - corners[0].x, corners[1].y - corners[0].y},
      y{corners[2].x - corners[0].x, corners[2].y - corners[0].y};
  const auto stretched = [](Point2 v) { return std::abs(std::hypot(v.x, v.y) / kSide_m - 1) > kStretched; };
  return !stretched(x) && !stretched(y) && x.x > kMaxTurn * kSide_m && y.y > kMaxTurn * kSide_m;
}

bool IsUsedAt(const MapSystem& system, Point2 longitude_latitude, double slack_deg) {
  const auto [x, y] = longitude_latitude;
  const bool above = x > system.west - slack_deg, below = x < system.east + slack_deg;
  const bool over_date_line = system.west > system.east;
  return (over_date_line ? above || below : above && below) && y > system.south - slack_deg &&
         y < system.north + slack_deg;
}

Error CheckMapPlace(const std::string& system, Point2 at_m, std::vector<std::string>* warnings) {
  MapSystem map;
  if (Error error = FindMapSystem(system, &map)) return Fail(error.message + "; use a name such as EPSG:25832");
  const std::string unit = map.degrees ? "degrees" : map.other_unit;
  if (!unit.empty())
    return Fail("coordinate system '" + system + "' has " + unit + "; a town needs one in metres, such as EPSG:25832");
  char at[80];
  std::snprintf(at, sizeof at, "(%.10g, %.10g)", at_m.x, at_m.y);
  if (map.has_area && (at_m.x != 0 || at_m.y != 0) && IsUsedAt(map, at_m))
    return Fail(std::string(at) + " looks like degrees, but '" + system + "' has metres");
  std::vector<Point2> place{at_m};
  if (Error error = TransformPoints(system, kLongitudeLatitude, &place)) return error;
  if (!IsUsedAt(map, place[0]))
    return Fail(std::string(at) + " is outside the area that '" + system +
                "' is for; the coordinates are in another system, or their origin is missing");
  if (warnings && !IsUsedAt(map, place[0], kBesideUse_deg)) {
    char text[160];
    std::snprintf(
        text, sizeof text,
        " is at %.2f degrees east, %.2f north, beside the area that '%s' is for (%g to %g east, %g to %g north)",
        place[0].x, place[0].y, system.c_str(), map.west, map.east, map.south, map.north);
    warnings->push_back(at + std::string(text) + "; are these a neighbouring zone's coordinates?");
  }
  return Ok();
}

}  // namespace flaneur
