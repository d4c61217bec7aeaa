#include "pipeline/io/map_projection.h"

#include <proj.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>

namespace flaneur {
namespace {

constexpr double kBesideUse_deg = 0.25;  // towns may reach this far over the border of a system's area

struct Free {
  void operator()(PJ_CONTEXT* context) const { proj_context_destroy(context); }
  void operator()(PJ* object) const { proj_destroy(object); }
};
using Context = std::unique_ptr<PJ_CONTEXT, Free>;
using Object = std::unique_ptr<PJ, Free>;

// Quiet: what goes wrong is said by our own errors. No grids from the network.
Context MakeContext() {
  Context context(proj_context_create());
  proj_log_level(context.get(), PJ_LOG_NONE);
  proj_context_set_enable_network(context.get(), 0);
  return context;
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

// Finding the way between two systems takes longer than to transform a town's points, so the last ones are kept.
class Ways {
 public:
  // Null where there is none.
  PJ* Find(const std::string& from, const std::string& to) {
    for (const Way& way : ways_)
      if (way.from == from && way.to == to) return way.transform.get();
    const Object raw(proj_create_crs_to_crs(context_.get(), from.c_str(), to.c_str(), nullptr));
    Object transform(raw ? proj_normalize_for_visualization(context_.get(), raw.get()) : nullptr);
    if (ways_.size() == kMaxKeptWays) ways_.erase(ways_.begin());
    ways_.push_back({from, to, std::move(transform)});
    return ways_.back().transform.get();
  }

 private:
  static constexpr size_t kMaxKeptWays = 8;
  struct Way {
    std::string from, to;
    Object transform;
  };
  Context context_ = MakeContext();  // outlives the ways
  std::vector<Way> ways_;
};

}  // namespace

std::string LocalMapSystem(Point2 longitude_latitude) {
  char text[120];
  std::snprintf(text, sizeof text,
                "+proj=tmerc +lat_0=%.2f +lon_0=%.2f +k=1 +x_0=0 +y_0=0 +ellps=WGS84 +units=m +type=crs",
                longitude_latitude.y, longitude_latitude.x);
  return text;
}

Error TransformPoints(const std::string& from, const std::string& to, std::vector<Point2>* points) {
  thread_local Ways ways;
  PJ* const transform = ways.Find(from, to);
  if (!transform) return Fail("no way from coordinate system '" + from + "' to '" + to + "'");
  for (Point2& p : *points) {
    const PJ_COORD out = proj_trans(transform, PJ_FWD, proj_coord(p.x, p.y, 0, HUGE_VAL));
    const bool found = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(out.xy.x) && std::isfinite(out.xy.y);
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    p = found ? Point2{out.xy.x, out.xy.y} : Point2{kNone, kNone};
  }
  return Ok();
}

Error FindMapSystem(const std::string& name, MapSystem* system) {
  const Context context = MakeContext();
  const Object object(proj_create(context.get(), name.c_str()));
  if (!object || !proj_is_crs(object.get())) return Fail("coordinate system '" + name + "' is not known");
  *system = {};
  // Of a system with heights of its own, the part for the plane.
  const bool compound = proj_get_type(object.get()) == PJ_TYPE_COMPOUND_CRS;
  const Object plane(compound ? proj_crs_get_sub_crs(context.get(), object.get(), 0) : nullptr);
  const PJ_TYPE type = proj_get_type(plane ? plane.get() : object.get());
  system->degrees = type == PJ_TYPE_GEOGRAPHIC_2D_CRS || type == PJ_TYPE_GEOGRAPHIC_3D_CRS;
  if (!system->degrees) system->other_unit = OtherUnit(context.get(), plane ? plane.get() : object.get());
  const char* area = nullptr;
  double w = 0, s = 0, e = 0, n = 0;
  if (proj_get_area_of_use(context.get(), object.get(), &w, &s, &e, &n, &area) && w > -1000) {
    system->has_area = true;
    system->west = w, system->south = s, system->east = e, system->north = n;
  }
  return Ok();
}

bool IsUsedAt(const MapSystem& system, Point2 longitude_latitude, double slack_deg) {
  const auto [x, y] = longitude_latitude;
  return x > system.west - slack_deg && x < system.east + slack_deg && y > system.south - slack_deg &&
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
