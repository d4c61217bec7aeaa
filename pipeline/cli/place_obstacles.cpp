#include "pipeline/cli/place_obstacles.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "pipeline/footprint/town_fit.h"

namespace flaneur {
namespace {

struct Reading {
  std::string fault;  // what it means that this one fits
  ReadGeoJsonOptions options;
  bool as_the_towns = false;  // the coordinates are in the town's system
};

std::string Metres(double v) {
  char text[40];
  std::snprintf(text, sizeof text, "%.2f m", std::abs(v));
  return text;
}

// "100.00 m east and 0.30 m north"
std::string Offset(Point2 by) {
  std::string text;
  if (std::abs(by.x) >= 0.005) text = Metres(by.x) + (by.x > 0 ? " east" : " west");
  if (std::abs(by.y) >= 0.005) text += (text.empty() ? "" : " and ") + Metres(by.y) + (by.y > 0 ? " north" : " south");
  return text;
}

bool Elsewhere(const GeoJsonFile& file) {
  for (const GeoJsonFault& fault : file.faults)
    if (fault.kind == GeoJsonFaultKind::kElsewhere) return true;
  return false;
}

void Tell(const std::string& what, GeoJsonFile* file) {
  if (!Elsewhere(*file)) file->faults.push_back({GeoJsonFaultKind::kElsewhere, "", what});
}

class Placing {
 public:
  Placing(const std::filesystem::path& path, const ReadGeoJsonOptions& reading, const PreparedTown& town,
          double tolerance_m, Point2 stated_origin_m)
      : path_(path), reading_(reading), town_(town), tolerance_m_(tolerance_m), stated_origin_m_(stated_origin_m) {}

  Error Run(GeoJsonFile* file, bool* found, std::vector<std::string>* warnings) {
    const std::vector<GeoJsonFault> before = file->faults;
    const GeoJsonFile as_read = *file;
    if (Error error = MoveToTown(System(), Origin(), file)) return error;
    *found = file->faults.size() == before.size();
    const TownFit fit = *found ? FitToTown(file->footprints, town_) : TownFit{};
    if (*found && fit.share >= kFits) return Shift(fit, file), Ok();
    for (const Reading& reading : Readings()) {
      GeoJsonFile other;
      TownFit other_fit;
      if (!Try(reading, as_read, &other, &other_fit) || other_fit.share < std::max(kFits, fit.share)) continue;
      const bool agreed =
          reading.as_the_towns && as_read.place_is_sure && Length(other_fit.shift_m) <= 2 * tolerance_m_;
      other.faults = before;
      if (agreed)
        warnings->push_back(path_.string() + ": the obstacles name " +
                            (as_read.town_system.empty() ? as_read.footprints.reference_system : as_read.town_system) +
                            ", the town " + System() + ", but their coordinates fit; taken for the same");
      else Tell(reading.fault, &other);
      *file = std::move(other);
      *found = true;
      return Shift(other_fit, file), Ok();
    }
    if (*found) Shift(fit, file);
    return Ok();
  }

 private:
  static double Length(Point2 p) { return std::hypot(p.x, p.y); }
  const std::string& System() const { return town_.own.reference_system; }
  Point2 Origin() const { return town_.own.origin_m; }

  void Shift(const TownFit& fit, GeoJsonFile* file) const {
    if (Length(fit.shift_m) <= 2 * tolerance_m_) return;
    const Point2 off{-fit.shift_m.x, -fit.shift_m.y};
    std::string what = "all obstacles stand " + Offset(off) + " of where the town has them";
    const Point2 origin = file->footprints.origin_m;
    if (file->system.empty() && file->has_origin && (origin.x != 0 || origin.y != 0)) {
      char text[120];
      std::snprintf(text, sizeof text, "; the origin_m looks wrong: [%.10g, %.10g] would fit",
                    stated_origin_m_.x - off.x, stated_origin_m_.y - off.y);
      what += text;
    }
    Tell(what, file);
    MoveBy(fit.shift_m, file);
  }

  std::vector<Reading> Readings() const {
    std::vector<Reading> readings;
    Reading swapped{"longitude and latitude (or easting and northing) look swapped: so the obstacles fit the town",
                    reading_};
    swapped.options.swapped = true;
    readings.push_back(swapped);
    if (!System().empty())
      readings.push_back(
          {"the system that the obstacles name looks wrong: they fit the town if their coordinates are in " + System() +
               ", as the town's",
           reading_, true});
    return readings;
  }

  bool Try(const Reading& reading, const GeoJsonFile& as_read, GeoJsonFile* other, TownFit* fit) const {
    std::string towns = System();
    if (reading.as_the_towns && as_read.place_is_sure && !as_read.town_system.empty()) {
      *other = as_read;  // our own file in degrees knows better than the town what the town is in
      towns = as_read.town_system;
    } else if (reading.as_the_towns && as_read.system.empty() && !as_read.footprints.reference_system.empty()) {
      *other = as_read;  // our own file, or a map of metres: only its system's name is another
      other->footprints.reference_system = System();
    } else {
      ReadGeoJsonOptions options = reading.options;
      if (reading.as_the_towns) options.system = System(), options.units = GeoJsonUnits::kAuto;
      if (ReadGeoJson(path_, options, other)) return false;
    }
    other->faults.clear();
    if (MoveToTown(towns, Origin(), other) || !other->faults.empty()) return false;
    *fit = FitToTown(other->footprints, town_);
    return true;
  }

  const std::filesystem::path& path_;
  const ReadGeoJsonOptions& reading_;
  const PreparedTown& town_;
  double tolerance_m_;
  Point2 stated_origin_m_;
};

}  // namespace

Error PlaceObstacles(const std::filesystem::path& path, const ReadGeoJsonOptions& reading, const PreparedTown& town,
                     double tolerance_m, GeoJsonFile* file, bool* found, std::vector<std::string>* warnings) {
  return Placing(path, reading, town, tolerance_m, file->footprints.origin_m).Run(file, found, warnings);
}

}  // namespace flaneur
