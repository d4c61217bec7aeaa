#include "pipeline/cli/georeference.h"

#include <cmath>
#include <cstdio>

#include "pipeline/io/map_projection.h"
#include "pipeline/io/town_builder.h"

namespace flaneur {
namespace {

constexpr double kSameOrigin_m = 1e-4;

bool IsZero(Point2 p) { return p.x == 0 && p.y == 0; }

std::string Text(Point2 p) {
  char text[80];
  std::snprintf(text, sizeof text, "(%.10g, %.10g)", p.x, p.y);
  return text;
}

Error SetOrigin(Point2 wish_m, double scale, Scene* town) {
  if (IsZero(wish_m)) return Ok();
  const Point2 own_m{town->origin_m.x * scale, town->origin_m.y * scale};
  if (!IsZero(own_m) && std::hypot(own_m.x - wish_m.x, own_m.y - wish_m.y) > kSameOrigin_m)
    return Fail("the origin is said to be " + Text(wish_m) + ", but the town's file has map coordinates, moved by " +
                Text(own_m) + "; leave the origin out");
  town->origin_m = {wish_m.x / scale, wish_m.y / scale};
  return Ok();
}

}  // namespace

Error SetGeoreference(const Georeference& wish, double scale, Scene* town, std::vector<std::string>* warnings) {
  if (Error error = SetOrigin(wish.origin_m, scale, town)) return error;
  const bool asked = !wish.crs.empty();
  if (asked) town->reference_system = wish.crs == "none" ? "" : PlainReferenceSystem(wish.crs);
  if (town->reference_system.empty()) return Ok();
  const Point2 origin_m{town->origin_m.x * scale, town->origin_m.y * scale};
  Error error = CheckMapPlace(town->reference_system, origin_m, warnings);
  if (!error) return Ok();
  MapSystem system;
  const bool usable = !FindMapSystem(town->reference_system, &system) && !system.degrees && !IsZero(origin_m);
  if (asked || usable) return error;
  warnings->push_back("longitudes and latitudes are not known: " + error.message);
  town->reference_system.clear();
  return Ok();
}

std::filesystem::path LongitudeLatitudePath(const std::filesystem::path& local) {
  std::filesystem::path path = local;
  return path.replace_filename(local.stem().string() + "_wgs84.geojson");
}

}  // namespace flaneur
