// Whether a file's own words about where it lies agree; see geojson_system.h.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "pipeline/io/axis_order.h"
#include "pipeline/io/geojson_system.h"
#include "pipeline/io/map_projection.h"
#include "pipeline/io/town_builder.h"

namespace flaneur {
namespace {

constexpr double kSamePlace_m = 5;         // by other grids of PROJ, a place may move by some metres
constexpr double kSameTown_m = 100'000;    // no town is as wide as that
constexpr double kWrongOrigin_m = 20'000;  // farther off, the system is wrong rather than the origin
constexpr size_t kMaxRingsAsked = 20'000;  // for their right angles
constexpr double kRadian = 3.14159265358979323846 / 180, kEarth_m = 6'371'000;

std::string Text(Point2 p, const char* format) {
  char text[80];
  std::snprintf(text, sizeof text, format, p.x, p.y);
  return text;
}
std::string Metres(Point2 p) { return Text(p, "[%.10g, %.10g]"); }
std::string Degrees(Point2 p) { return Text(p, "%.4f east, %.4f north"); }

double Apart_m(Point2 a, Point2 b) {
  const double dx = std::remainder(a.x - b.x, 360.0) * std::cos((a.y + b.y) / 2 * kRadian);
  return std::hypot(dx, a.y - b.y) * kRadian * kEarth_m;
}

std::vector<Point2> PointsOf(GeoJsonFile* file) {
  std::vector<Point2> points;
  ForEachPoint(file, [&](Point2& p) { points.push_back(p); });
  return points;
}

std::vector<PlanRing> RingsOf(const GeoJsonFile& file) {
  std::vector<PlanRing> rings;
  for (const Obstacle& o : file.footprints.obstacles)
    if (!o.outer.empty() && rings.size() < kMaxRingsAsked) rings.push_back(o.outer);
  return rings;
}

bool Known(Point2 p) { return std::isfinite(p.x) && std::isfinite(p.y); }

class Misplacement {
 public:
  Misplacement(const StatedSystem& stated, const StatedPlace& place, GeoJsonFile* file)
      : stated_(stated), place_(place), file_(*file), middle_(Median(PointsOf(file))) {}

  Error Run() {
    if (Error error = OtherCrs()) return error;
    if (told_) return Ok();
    if (stated_.units == GeoJsonUnits::kMetres) return stated_.local ? LocalMetres() : Ok();
    MapSystem system;
    std::string name = stated_.system;
    if (stated_.units == GeoJsonUnits::kDegrees || name.empty()) name = kLongitudeLatitude;
    if (FindMapSystem(name, &system)) return Ok();  // said elsewhere
    if (IsSwapped(name, system)) {
      Tell(std::string(system.degrees ? "longitude and latitude" : "easting and northing") +
           " look swapped: read as they stand they give " + Where(name, middle_) + ", the other way round " +
           Where(name, {middle_.y, middle_.x}) + (why_.empty() ? "" : "; " + why_) +
           "; write longitude or easting first");
      ForEachPoint(&file_, [](Point2& p) { std::swap(p.x, p.y); });
      middle_ = {middle_.y, middle_.x};
      return Ok();
    }
    if (system.degrees && InOneBox(middle_) == 0)
      Tell("its bbox does not hold most of it, which lies at " + Degrees(middle_) +
           "; was it moved, or is the bbox old?");
    return system.degrees ? TownsPlace(FromGreenwich(system, middle_)) : Ok();
  }

 private:
  void Tell(const std::string& what) {
    if (!told_) file_.faults.push_back({GeoJsonFaultKind::kElsewhere, "", what});
    told_ = true;
  }

  static std::string Where(const std::string& name, Point2 p) {
    std::vector<Point2> place{p};
    if (name != kLongitudeLatitude && TransformPoints(name, kLongitudeLatitude, &place)) return Metres(p);
    return Known(place[0]) ? Degrees(place[0]) : "no place";
  }

  // 1: in the stated box, 0: not, -1: there is none.
  int InOneBox(Point2 p) const {
    const auto& [west, south, east, north] = place_.box;
    if (!(west <= east && south <= north)) return -1;
    const double slack = 1e-3;
    return p.x > west - slack && p.x < east + slack && p.y > south - slack && p.y < north + slack;
  }

  bool IsSwapped(const std::string& name, const MapSystem& system) {
    const Point2 turned{middle_.y, middle_.x};
    if (!system.degrees) {
      Point2 given, other;
      why_ = "only so it is where " + name + " is used";
      return system.has_area && !(FindRoughPlace(name, middle_, &given) && IsUsedAt(system, given)) &&
             FindRoughPlace(name, turned, &other) && IsUsedAt(system, other, 0.25);
    }
    const double right = 90 / system.unit_deg;
    if (std::abs(turned.x) > 2 * right || std::abs(turned.y) > right) return false;
    if (std::abs(middle_.y) > right && std::abs(middle_.x) <= right && std::abs(middle_.y) <= 2 * right) return true;
    if (InOneBox(middle_) == 0 && InOneBox(turned) == 1) return why_ = "the second is in its bbox", true;
    if (!file_.town_system.empty()) {
      std::vector<Point2> town{file_.town_origin_m};
      if (!TransformPoints(file_.town_system, kLongitudeLatitude, &town) && Known(town[0])) {
        const double given_m = Apart_m(FromGreenwich(system, middle_), town[0]);
        const double turned_m = Apart_m(FromGreenwich(system, turned), town[0]);
        if (given_m > kSameTown_m && turned_m < kSameTown_m)
          return why_ = "there the town is, by its town_origin_m", true;
        if (given_m < kSameTown_m) return false;
      }
    }
    why_ = "only so houses have right angles";
    return AxesByRightAngles(RingsOf(file_), system.unit_deg) == AxisEvidence::kSwapped;
  }

  // Besides our own member: the two must not contradict each other.
  Error OtherCrs() {
    if (place_.other_crs.empty()) return Ok();
    const std::string other = PlainReferenceSystem(place_.other_crs);
    const std::string own =
        stated_.local ? PlainReferenceSystem(file_.footprints.reference_system) : "longitude and latitude";
    MapSystem system;
    if (!stated_.local && !FindMapSystem(other, &system) && system.degrees) return Ok();
    if (stated_.local && (own.empty() || own == other)) return Ok();
    Tell("its member crs says " + other + ", its member flaneur says " + own +
         (stated_.local ? "" : ", and so the coordinates look") + "; remove or correct the wrong one");
    return Ok();
  }

  // Of our own file in degrees.
  Error TownsPlace(Point2 middle_deg) {
    if (file_.town_system.empty()) return Ok();
    std::vector<Point2> town{file_.town_origin_m};
    MapSystem system;
    if (FindMapSystem(file_.town_system, &system))
      return Tell("its town_crs '" + file_.town_system + "' is not known"), Ok();
    if (Error error = TransformPoints(file_.town_system, kLongitudeLatitude, &town)) return error;
    if (Known(town[0]) && Apart_m(town[0], middle_deg) < kSameTown_m) return file_.place_is_sure = true, Ok();
    Tell("its town_crs " + file_.town_system + " and town_origin_m put the town at " +
         (Known(town[0]) ? Degrees(town[0]) : "no place") + ", but its coordinates are at " + Degrees(middle_deg) +
         Looks(SystemsThatPut(file_.town_origin_m, middle_deg, kSameTown_m), "town_crs"));
    return Ok();
  }

  // Where the stated places are by the file's own coordinates: at the corner of their obstacle that is there, however
  // its ring was turned since; where none is, at the first, of which it was said.
  struct Witness {
    Point2 stated_deg, stated_m, own_m;
  };
  std::vector<Witness> Witnesses() const {
    const Footprints& f = file_.footprints;
    std::vector<Witness> all;
    std::vector<Point2> stated;
    for (const auto& [name, at] : place_.places_deg) stated.push_back(at);
    if (stated.empty() || TransformPoints(kLongitudeLatitude, f.reference_system, &stated)) return all;
    for (size_t i = 0; i < stated.size(); ++i) {
      const std::string& name = place_.places_deg[i].first;
      const auto found =
          std::find_if(f.obstacles.begin(), f.obstacles.end(), [&](const Obstacle& o) { return o.name == name; });
      if (found == f.obstacles.end()) continue;
      std::vector<Point2> corners = found->outer.empty() ? std::vector<Point2>{found->center} : found->outer;
      for (Point2& p : corners) p = {p.x + f.origin_m.x, p.y + f.origin_m.y};
      const auto far = [&](Point2 p) { return std::hypot(p.x - stated[i].x, p.y - stated[i].y); };
      std::erase_if(corners, [](Point2 p) { return !Known(p); });
      if (corners.empty()) continue;
      const Point2 nearest =
          *std::min_element(corners.begin(), corners.end(), [&](Point2 a, Point2 b) { return far(a) < far(b); });
      const bool there = Known(stated[i]) && far(nearest) < kSamePlace_m;
      all.push_back({place_.places_deg[i].second, stated[i], there ? nearest : corners[0]});
    }
    return all;
  }

  // Of our own file in metres: places_deg says where some obstacles are.
  Error LocalMetres() {
    const Footprints& f = file_.footprints;
    if (f.reference_system.empty()) return Ok();
    MapSystem system;
    if (FindMapSystem(f.reference_system, &system)) {
      file_.faults.push_back(
          {GeoJsonFaultKind::kUnknownSystem, "", "its crs '" + f.reference_system + "' is not known"});
      return Ok();
    }
    std::vector<Point2> place{{middle_.x + f.origin_m.x, middle_.y + f.origin_m.y}};
    const bool there = !TransformPoints(f.reference_system, kLongitudeLatitude, &place) && Known(place[0]);
    const std::string says = "its crs " + f.reference_system + " and origin_m " + Metres(f.origin_m) + " put it at " +
                             (there ? Degrees(place[0]) : "no place");
    const std::vector<Witness> witnesses = Witnesses();
    if (witnesses.empty()) {
      if (!there || !IsUsedAt(system, place[0]))
        Tell(says + ", outside the area that " + f.reference_system + " is for; the crs or origin_m looks wrong");
      return Ok();
    }
    std::vector<Point2> offs;
    for (const Witness& w : witnesses) offs.push_back({w.own_m.x - w.stated_m.x, w.own_m.y - w.stated_m.y});
    const Point2 off = Median(offs);
    const bool known = std::all_of(offs.begin(), offs.end(), Known);
    if (known && std::hypot(off.x, off.y) < kSamePlace_m) return file_.place_is_sure = true, Ok();
    Tell(
        says + ", its places_deg at " + Degrees(witnesses[0].stated_deg) +
        (known && std::hypot(off.x, off.y) < kWrongOrigin_m ? WrongOrigin(off, witnesses[0]) : WrongCrs(witnesses[0])));
    return Ok();
  }

  // What fits is taken, so that all else is checked.
  std::string WrongCrs(const Witness& witness) {
    const std::vector<std::string> systems = SystemsThatPut(witness.own_m, witness.stated_deg, kSamePlace_m);
    if (!systems.empty()) file_.footprints.reference_system = systems[0];
    return Looks(systems, "crs");
  }

  std::string WrongOrigin(Point2 off, const Witness& witness) {
    // In another datum's system of the same kind a town lies some hundred metres off, in no round number.
    const auto round = [](double v) { return std::abs(v - std::round(v)) < 0.02; };
    if (!(round(off.x) && round(off.y))) {
      const std::string before = file_.footprints.reference_system, other = WrongCrs(witness);
      if (file_.footprints.reference_system != before) return other;
    }
    const auto millimetres = [](double v) { return std::round(v * 1000) / 1000; };
    Point2& origin = file_.footprints.origin_m;
    origin = {millimetres(origin.x - off.x), millimetres(origin.y - off.y)};
    char text[120];
    std::snprintf(text, sizeof text, "; origin_m looks wrong by %.1f m east and %.1f m north: ", off.x, off.y);
    return text + Metres(origin) + " would fit";
  }

  static std::string Looks(const std::vector<std::string>& systems, const char* what) {
    const std::string wrong = std::string("; ") + what + " looks wrong";
    if (systems.empty()) return wrong;
    return wrong + ", the coordinates look like " + systems[0] + (systems.size() > 1 ? " or " + systems[1] : "");
  }

  const StatedSystem& stated_;
  const StatedPlace& place_;
  GeoJsonFile& file_;
  Point2 middle_;
  std::string why_;
  bool told_ = false;
};

}  // namespace

Error FindMisplacement(const StatedSystem& stated, const StatedPlace& place, GeoJsonFile* file) {
  return Misplacement(stated, place, file).Run();
}

}  // namespace flaneur
