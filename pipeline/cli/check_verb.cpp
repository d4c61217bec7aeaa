#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "pipeline/cli/arguments.h"
#include "pipeline/cli/far_town.h"
#include "pipeline/cli/place_obstacles.h"
#include "pipeline/cli/up_option.h"
#include "pipeline/cli/verbs.h"
#include "pipeline/footprint/check.h"
#include "pipeline/footprint/map.h"
#include "pipeline/io/geojson.h"
#include "pipeline/io/scene_tiles.h"
#include "runtime/base/file.h"
#include "runtime/base/option_range.h"

namespace flaneur {
namespace {

struct CheckArguments {
  std::filesystem::path obstacles, json, geojson, map, page;
  std::vector<std::filesystem::path> towns;  // tiles of one
  CheckOptions options;
  ReadGeoJsonOptions reading;
  UpAxis up = UpAxis::kJudged;
  bool warnings_as_errors = false;
  size_t most_listed = 10;
};

void AddOptions(CLI::App* app, CheckArguments* a) {
  app->add_option("OBSTACLES", a->obstacles, "GeoJSON file of obstacles, Flaneur's or any other")->required();
  app->add_option("--town", a->towns,
                  "The town they stand for, in any format that footprints reads: walls, ground, doors and exits are "
                  "checked too. Once for each tile of a city")
      ->allow_extra_args(false);
  app->add_option("--json", a->json, "Write the findings as JSON");
  app->add_option("--geojson", a->geojson, "Write the findings as GeoJSON points, in the file's own coordinates");
  app->add_option("--map", a->map, "Draw a plan with the findings as SVG");
  app->add_option("--html", a->page, "Write a page with a plan that zooms and a list of the findings");
  app->add_flag("--warnings-as-errors", a->warnings_as_errors, "Exit with 1 on warnings too");
  const std::map<std::string, GeoJsonUnits> units{
      {"auto", GeoJsonUnits::kAuto}, {"metres", GeoJsonUnits::kMetres}, {"degrees", GeoJsonUnits::kDegrees}};
  app->add_option("--units", a->reading.units, "Of the coordinates: auto, metres or degrees")
      ->transform(CLI::CheckedTransformer(units, CLI::ignore_case));
  app->add_option("--crs", a->reading.system, "The coordinates' system, such as EPSG:25832, whatever the file says");
  AddUp(app, &a->up);
  app->add_option("--clearance-m", a->options.clearance_m, "Least distance from wall to outline [default: the file's]")
      ->check(NumberFrom(0.0, 10.0));
  app->option_defaults()->always_capture_default();
  app->add_option("--threads", a->options.threads, "0: one a core; the result is the same")->check(CLI::Range(0, 1024));
  app->add_option("--most-points", a->options.most_points, "In a ring; more are reported (108)");
  for (const CheckNumber& number : CheckNumbers())
    app->add_option(std::string("--") + number.name, a->options.*number.value, number.help);
  app->add_option("--most-listed", a->most_listed, "Findings of one kind that are listed on the screen");
}

// Kinds one after the other, each with its advice once.
void Print(const std::vector<Finding>& findings, size_t most_listed, FILE* to) {
  for (size_t i = 0; i < findings.size();) {
    size_t end = i;
    size_t count = 0;
    for (; end < findings.size() && findings[end].code == findings[i].code; ++end) count += findings[end].Count();
    const FindingKind& kind = KindOf(findings[i].code);
    std::fprintf(to, "%d %s: %zu\n    %s\n", kind.code, kind.title, count, kind.advice);
    for (size_t k = i; k < std::min(end, i + most_listed); ++k) {
      const Finding& f = findings[k];
      std::fprintf(to, "  %s at (%.2f, %.2f)%s%s: %s\n", SeverityName(f.severity), f.at_m.x, f.at_m.y,
                   f.feature.empty() ? "" : " ", f.feature.c_str(), f.message.c_str());
    }
    if (end - i > most_listed)
      std::fprintf(to, "  and %zu more (--json, --html or --most-listed shows them)\n", end - i - most_listed);
    i = end;
  }
  const auto errors = static_cast<size_t>(
      std::count_if(findings.begin(), findings.end(), [](const Finding& f) { return f.severity == Severity::kError; }));
  std::fprintf(to, "%zu errors, %zu warnings\n", errors, findings.size() - errors);
}

Finding FaultOf(int code, const std::string& feature, const std::string& message) {
  Finding finding;
  finding.code = code, finding.severity = KindOf(code).severity, finding.feature = feature;
  finding.message = std::string(KindOf(code).title) + ": " + message;
  return finding;
}

Error WriteFindings(const CheckArguments& a, const GeoJsonFile& file, const std::vector<Finding>& findings) {
  std::vector<Point2> places;
  for (const Finding& f : findings) places.push_back(f.at_m);
  places = ToFileCoordinates(file, places);
  if (!a.json.empty())
    if (Error error = WriteTextFile(a.json, FindingsJson(findings, places))) return error;
  if (a.geojson.empty()) return Ok();
  return WriteTextFile(a.geojson, FindingsGeoJson(findings, places, !file.system.empty()));
}

// What makes checking impossible is a finding too.
Error ReportFault(const CheckArguments& a, int code, const Error& error, std::vector<Finding> findings = {}) {
  findings.push_back(FaultOf(code, "", error.message));
  SortFindings(&findings);
  if (Error e = WriteFindings(a, {}, findings)) return e;
  return error;
}

void AddFaults(const std::vector<GeoJsonFault>& faults, std::vector<Finding>* findings) {
  for (const GeoJsonFault& fault : faults) {
    const std::map<GeoJsonFaultKind, int> codes{{GeoJsonFaultKind::kBrokenFeature, 904},
                                                {GeoJsonFaultKind::kOtherSystem, 903},
                                                {GeoJsonFaultKind::kUnknownSystem, 906},
                                                {GeoJsonFaultKind::kElsewhere, 907}};
    findings->push_back(FaultOf(codes.at(fault.kind), fault.feature, fault.message));
  }
}

struct TownToCheck {
  Scene scene;
  PreparedTown prepared;
  bool found = true;  // the obstacles are in its coordinates
};

// In the town's own coordinates, one for all of them.
Point2 PlaceOf(const GeoJsonFile& file) {
  const Obstacle& first = file.footprints.obstacles.front();
  const Point2 p = first.outer.empty() ? first.center : first.outer.front();
  if (file.system.empty() || file.town_system.empty()) return p;
  return {p.x + file.local_origin_m.x - file.town_origin_m.x, p.y + file.local_origin_m.y - file.town_origin_m.y};
}

// A bake moves a town near zero that its file has far away, and its obstacles are as it stands then.
void MoveAsBaked(const GeoJsonFile& file, Scene* town) {
  if (town->origin_m.x != 0 || town->origin_m.y != 0) return;
  const Point2 by = FarFromZero(kFarToDraw_m, 1, *town), at = PlaceOf(file);
  if (std::hypot(at.x, at.y) >= std::hypot(at.x - by.x, at.y - by.y)) return;
  MoveNearZero(by, town);
  town->origin_m = {};
}

// The town, with the obstacles moved to where it stands.
Error ReadTown(const CheckArguments& a, GeoJsonFile* file, std::vector<Finding>* faults, TownToCheck* town) {
  std::vector<std::string> warnings;
  SceneSource source;
  if (Error error = ReadTiles(a.towns, {"", a.up}, &town->scene, &source, &warnings)) return error;
  MoveAsBaked(*file, &town->scene);
  if (Error error = PrepareTown(town->scene, file->footprints, a.options, &town->prepared))
    return Fail(a.towns.front().string() + ": " + error.message);
  const Error error =
      PlaceObstacles(a.obstacles, a.reading, town->prepared, a.options.tolerance_m, file, &town->found, &warnings);
  for (const std::string& warning : warnings) std::fprintf(stderr, "flaneur: warning: %s\n", warning.c_str());
  if (error) return error;
  faults->clear();
  AddFaults(file->faults, faults);
  return Ok();
}

CheckOptions WithStreetsAndGates(CheckOptions options, const GeoJsonFile& file) {
  options.open_rings = file.open_rings;
  for (const Way& way : file.ways) options.streets.push_back({way.name, way.points});
  for (const GatePoint& place : file.places) options.gates.push_back({place.name, place.at, {}, place.is_exit});
  return options;
}

Error DrawMaps(const CheckArguments& a, const GeoJsonFile& file, const GroundRaster* ground,
               const std::vector<Finding>& findings) {
  MapOptions map{a.obstacles.filename().string(), ground, findings, {}};
  for (const Way& way : file.ways) map.streets.push_back(way.points);
  if (!a.map.empty())
    if (Error error = WriteMap(a.map, file.footprints, map)) return error;
  return a.page.empty() ? Ok() : WriteMapPage(a.page, file.footprints, map);
}

Error Run(const CheckArguments& a, int* status) {
  if (Error error = Validate(a.options)) return ReportFault(a, 905, error);
  GeoJsonFile file;
  if (Error error = ReadGeoJson(a.obstacles, a.reading, &file)) return ReportFault(a, 901, error);
  std::vector<Finding> faults;
  AddFaults(file.faults, &faults);
  if (file.footprints.obstacles.empty()) {
    const std::string why = faults.empty() ? "" : "; " + faults[0].feature + ": " + faults[0].message;
    return ReportFault(a, 902, Fail(a.obstacles.string() + ": holds no polygon and no circle" + why), faults);
  }
  if (file.skipped > 0)
    std::fprintf(stderr, "flaneur: warning: %s: %d features are no obstacles, streets or doors; left out\n",
                 a.obstacles.c_str(), file.skipped);
  TownToCheck town;
  if (!a.towns.empty())
    if (Error error = ReadTown(a, &file, &faults, &town)) return ReportFault(a, 901, error, faults);
  const PreparedTown* const prepared = a.towns.empty() || !town.found ? nullptr : &town.prepared;
  std::vector<Finding> findings;
  if (Error error = CheckPrepared(file.footprints, prepared, WithStreetsAndGates(a.options, file), &findings))
    return ReportFault(a, 901, error, faults);
  const auto elsewhere = [](const Finding& f) { return f.code == 907; };
  if (std::any_of(faults.begin(), faults.end(), elsewhere)) std::erase_if(findings, elsewhere);  // said already
  findings.insert(findings.end(), faults.begin(), faults.end());
  SortFindings(&findings);
  Print(findings, a.most_listed, IsStandardOutput(a.json) || IsStandardOutput(a.geojson) ? stderr : stdout);
  if (Error error = WriteFindings(a, file, findings)) return error;
  const bool errors =
      std::any_of(findings.begin(), findings.end(), [](const Finding& f) { return f.severity == Severity::kError; });
  *status = errors || (a.warnings_as_errors && !findings.empty()) ? 1 : 0;
  return DrawMaps(a, file, prepared ? &prepared->ground : nullptr, findings);
}

}  // namespace

int RunCheck(const Arguments& args) {
  CLI::App app(
      "Checks obstacles for a crowd: broken rings, overlaps, narrow gaps, dead ends and traps, streets; against a "
      "town also walls, passages, doors and exits. Exit status 1 where errors are found, 2 where nothing can be "
      "checked.",
      "flaneur check");
  CheckArguments arguments;
  AddOptions(&app, &arguments);
  if (const int status = ParseArguments(&app, args); status >= 0) return status;
  int status = 0;
  const Error error = Run(arguments, &status);
  return error ? Report(error) : status;
}

}  // namespace flaneur
