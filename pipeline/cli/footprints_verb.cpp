#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/cli/arguments.h"
#include "pipeline/cli/far_town.h"
#include "pipeline/cli/georeference.h"
#include "pipeline/cli/up_option.h"
#include "pipeline/cli/verbs.h"
#include "pipeline/footprint/extract_footprints.h"
#include "pipeline/footprint/map.h"
#include "pipeline/footprint/rasterize_ground.h"
#include "pipeline/io/geojson.h"
#include "pipeline/io/scene_tiles.h"
#include "runtime/base/file.h"
#include "runtime/base/option_range.h"

namespace flaneur {
namespace {

struct FootprintsArguments {
  std::vector<std::filesystem::path> towns;
  std::filesystem::path output, map;
  FootprintOptions options;
  Georeference georeference;
  std::array<double, 2> origin_m{};
  UpAxis up = UpAxis::kJudged;
};

void AddOptions(CLI::App* app, FootprintsArguments* a) {
  app->add_option("TOWN", a->towns,
                  "The town: glTF, tagged by the town convention or not; OBJ, PLY, STL; CityJSON, CityGML; .blend, "
                  ".fbx, .dae, .x3d. Several: tiles of one city, of which what stands in two counts once")
      ->required();
  app->add_option("-o,--output", a->output, "GeoJSON file to write")->required();
  app->add_option("--map", a->map, "Also draw a plan as SVG");
  app->add_option(
      "--crs", a->georeference.crs,
      "Map system of the town's coordinates, in metres, such as EPSG:25832, whatever its file says; where it is known, "
      "longitudes and latitudes are written too, beside the output: NAME_wgs84.geojson. none: it is not known");
  app->add_option("--origin-m", a->origin_m,
                  "Add to the town's coordinates to get those of the map: EAST NORTH; for glTF, "
                  "city models have their own");
  AddUp(app, &a->up);
  app->option_defaults()->always_capture_default();
  app->add_option("--clearance-m", a->options.clearance_m, "Enlarge obstacles by this")->check(NumberFrom(0.0, 10.0));
  app->add_option("--band", a->options.band_m,
                  "Heights over the local ground between which things block, in metres: LOW HIGH")
      ->check(NumberFrom(0.0, 100.0));
  app->add_option("--tolerance-m", a->options.tolerance_m, "Simplification moves outlines outwards by at most this")
      ->check(NumberFrom(0.0, 1.0));
  app->add_option("--bridge-m", a->options.bridge_m, "Walls that miss each other by less are joined")
      ->check(NumberFrom(0.0, 1.0));
  app->add_option("--threads", a->options.threads, "0: one a core; the result is the same")->check(CLI::Range(0, 1024));
  app->add_option("--scale", a->options.scale, "Metres per unit of the file")->check(NumberFrom(1e-6, 1e6));
  app->add_flag("--merge-blocks", a->options.merge_blocks, "Make one obstacle of houses that adjoin");
}

// "town.gml", or "town.gml and 3 more".
std::string NameOf(const std::vector<std::filesystem::path>& towns) {
  return towns[0].string() + (towns.size() > 1 ? " and " + std::to_string(towns.size() - 1) + " more" : "");
}

Error Run(const FootprintsArguments& a) {
  Scene scene;
  SceneSource source;
  Footprints footprints;
  FootprintStats stats;
  std::vector<std::string> warnings;
  const std::string towns = NameOf(a.towns);
  const ReadSceneOptions reading{a.georeference.crs == "none" ? "" : a.georeference.crs, a.up};
  if (Error error = ReadTiles(a.towns, reading, &scene, &source, &warnings)) return error;
  Georeference georeference = a.georeference;
  if (!source.system.empty()) georeference.crs.clear();  // done by the reader
  georeference.origin_m = {a.origin_m[0], a.origin_m[1]};
  if (Error error = PlaceTown(georeference, kFarForOthers_m, a.options.scale, &scene, nullptr, &warnings))
    return Fail(towns + ": " + error.message);
  if (Error error = ExtractFootprints(scene, a.options, &footprints, &stats, &warnings))
    return Fail(towns + ": " + error.message);
  for (const std::string& warning : warnings) std::fprintf(stderr, "flaneur: warning: %s\n", warning.c_str());
  if (!footprints.reference_system.empty() && !IsStream(a.output))
    if (Error error = WriteLongitudeLatitude(LongitudeLatitudePath(a.output), footprints)) return error;
  if (Error error = WriteGeoJson(a.output, footprints, source.system)) return error;
  FILE* told = IsStandardOutput(a.output) ? stderr : stdout;
  std::fprintf(told, "%s: %d obstacles from %d objects, %d triangles; %.1f m2 covered\n", a.output.c_str(),
               stats.obstacles, stats.objects, stats.triangles, stats.covered_m2);
  for (const std::string& name : stats.open_shells)
    std::fprintf(told, "open shell: '%s' has walls that enclose nothing; look whether its obstacle is right\n",
                 name.c_str());
  if (!source.system.empty())
    std::fprintf(told, "the town is in %s; its obstacles are in %s, in metres\n", source.system.c_str(),
                 footprints.reference_system.c_str());
  if (a.map.empty()) return Ok();
  GroundRaster ground;
  GroundRasterOptions options;
  options.scale = a.options.scale;
  if (Error error = RasterizeGround(scene, options, &ground)) return error;
  return WriteMap(a.map, footprints, {a.towns[0].filename().string(), &ground, {}});
}

}  // namespace

int RunFootprints(const Arguments& args) {
  CLI::App app("Finds what stands in a walker's way in a town model, as polygons with holes and circles (GeoJSON).",
               "flaneur footprints");
  FootprintsArguments arguments;
  AddOptions(&app, &arguments);
  if (const int status = ParseArguments(&app, args); status >= 0) return status;
  return Report(Run(arguments));
}

}  // namespace flaneur
