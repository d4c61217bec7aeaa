#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "pipeline/cli/arguments.h"
#include "pipeline/cli/verbs.h"
#include "pipeline/footprint/check.h"
#include "pipeline/footprint/map.h"
#include "pipeline/footprint/rasterize_ground.h"
#include "pipeline/io/geojson.h"
#include "pipeline/io/gltf.h"
#include "runtime/base/file.h"

namespace flaneur {
namespace {

struct CheckArguments {
  std::filesystem::path obstacles, town, json, map;
  CheckOptions options;
  GeoJsonUnits units = GeoJsonUnits::kAuto;
  bool warnings_as_errors = false;
};

void AddOptions(CLI::App* app, CheckArguments* a) {
  app->add_option("OBSTACLES", a->obstacles, "GeoJSON file of obstacles, Flaneur's or any other")->required();
  app->add_option("--town", a->town, "The town they stand for (glTF): walls, ground, doors and exits are checked too");
  app->add_option("--json", a->json, "Write the findings as JSON");
  app->add_option("--map", a->map, "Draw a plan with the findings as SVG");
  app->add_flag("--warnings-as-errors", a->warnings_as_errors, "Exit with 1 on warnings too");
  const std::map<std::string, GeoJsonUnits> units{
      {"auto", GeoJsonUnits::kAuto}, {"metres", GeoJsonUnits::kMetres}, {"degrees", GeoJsonUnits::kDegrees}};
  app->add_option("--units", a->units, "Of the coordinates: auto, metres or degrees")
      ->transform(CLI::CheckedTransformer(units, CLI::ignore_case));
  app->add_option("--clearance-m", a->options.clearance_m, "Least distance from wall to outline [default: the file's]")
      ->check(CLI::Range(0.0, 10.0));
  app->option_defaults()->always_capture_default();
  app->add_option("--tolerance-m", a->options.tolerance_m, "Distances may be off by this")->check(CLI::PositiveNumber);
  app->add_option("--person-radius-m", a->options.person_radius_m, "Of the people who are to pass")
      ->check(CLI::PositiveNumber);
  app->add_option("--scale", a->options.scale, "Metres per unit of the town's file")->check(CLI::PositiveNumber);
}

void Print(const std::vector<Finding>& findings, int errors) {
  for (const Finding& f : findings) {
    std::printf("%s %d at (%.2f, %.2f)%s%s: %s\n", SeverityName(f.severity), f.code, f.at_m.x, f.at_m.y,
                f.feature.empty() ? "" : " ", f.feature.c_str(), f.message.c_str());
    std::printf("    %s\n", KindOf(f.code).advice);
  }
  std::printf("%d errors, %d warnings\n", errors, static_cast<int>(findings.size()) - errors);
}

Error Run(const CheckArguments& a, int* status) {
  GeoJsonFile file;
  if (Error error = ReadGeoJson(a.obstacles, {a.units}, &file)) return error;
  if (file.footprints.obstacles.empty()) return Fail(a.obstacles.string() + ": holds no polygon and no circle");
  if (file.skipped > 0)
    std::fprintf(stderr, "flaneur: warning: %s: %d features are neither polygons nor circles; left out\n",
                 a.obstacles.c_str(), file.skipped);
  const bool with_town = !a.town.empty();
  Scene town;
  GroundRaster ground;
  if (with_town) {
    if (Error error = ReadScene(a.town, &town)) return error;
    GroundRasterOptions options;
    options.scale = a.options.scale;
    if (Error error = RasterizeGround(town, options, &ground)) return error;
  }
  CheckOptions options = a.options;
  options.open_rings = file.open_rings;
  std::vector<Finding> findings;
  if (Error error = Check(file.footprints, with_town ? &town : nullptr, options, &findings)) return error;
  const int errors = static_cast<int>(std::count_if(
      findings.begin(), findings.end(), [](const Finding& f) { return f.severity == Severity::kError; }));
  Print(findings, errors);
  if (!a.json.empty())
    if (Error error = WriteTextFile(a.json, FindingsJson(findings))) return error;
  *status = errors > 0 || (a.warnings_as_errors && !findings.empty()) ? 1 : 0;
  if (a.map.empty()) return Ok();
  return WriteMap(a.map, file.footprints, {a.obstacles.filename().string(), with_town ? &ground : nullptr, findings});
}

}  // namespace

int RunCheck(const Arguments& args) {
  CLI::App app("Checks obstacles for a crowd: broken rings, overlaps, narrow gaps; against a town also walls, passages "
               "and ways. Exit status 1 where errors are found.",
               "flaneur check");
  CheckArguments arguments;
  AddOptions(&app, &arguments);
  if (const int status = ParseArguments(&app, args); status >= 0) return status;
  int status = 0;
  const Error error = Run(arguments, &status);
  return error ? Report(error) : status;
}

}  // namespace flaneur
