#include <CLI/CLI.hpp>
#include <cstdio>

#include "pipeline/cli/arguments.h"
#include "pipeline/cli/bake.h"
#include "pipeline/cli/bake_options.h"
#include "pipeline/cli/tours_report.h"
#include "pipeline/cli/verbs.h"
#include "pipeline/cli/watch.h"
#include "pipeline/core/interruption.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;

void PrintResults(const std::vector<BakedTour>& baked) {
  for (const BakedTour& tour : baked) {
    if (tour.error) continue;
    std::error_code ec;
    if (tour.unchanged) std::fprintf(stderr, "nothing changed since the last bake\n");
    std::printf("pack    %s (%.1f MB)\n", tour.pack.c_str(), static_cast<double>(fs::file_size(tour.pack, ec)) / 1e6);
    std::printf("report  %s", tour.report.c_str());
    if (tour.warnings > 0) std::printf(" (%zu warnings)", tour.warnings);
    std::printf("\nplay    flaneur-player %s\n", tour.pack.c_str());
  }
  std::fflush(stdout);
}

int BakeOnce(const std::vector<fs::path>& tours, const BakeOptions& options) {
  std::vector<BakedTour> baked;
  const Error first = Bake(tours, options, &baked);
  int status = 0;
  for (const BakedTour& tour : baked) status = std::max(status, Interrupted() ? 0 : Report(tour.error));
  if (Interrupted() || (first && status == 0)) status = Report(first);
  PrintResults(baked);
  if (tours.size() < 2 || baked.size() != tours.size()) return status;
  const fs::path folder = options.output.empty() ? fs::path("build_assets") : options.output;
  if (Error e = WriteToursReport(folder, baked)) return Report(e);
  std::printf("all     %s\n", (folder / "report.html").c_str());
  return status;
}

}  // namespace

int RunBake(const Arguments& args) {
  CLI::App app{
      "Makes a tour pack from a town, avatars and one tour.toml, or several such packs.\n"
      "Writes DIR/NAME.glb, DIR/report.html, DIR/report.json, DIR/footprints.geojson, DIR/plan.png and\n"
      "DIR/manifest.json; of several tours into DIR/NAME, and DIR/report.html over all.",
      "flaneur bake"};
  std::vector<fs::path> tours;
  BakeOptions options;
  bool watch = false;
  app.add_option("TOUR", tours, "tour.toml, one or several; assets_src/reference/tour.toml explains every setting")
      ->required();
  AddPlaces(&app, &options);
  AddLimits(&app, &options);
  app.add_flag("--watch", watch, "Bake again whenever a file changes, until interrupted");
  if (const int status = ParseArguments(&app, args); status >= 0) return status;
  CatchInterruptions();
  if (watch) BeginWatching(tours);
  int status = BakeOnce(tours, options);
  while (watch && AwaitChange(tours)) status = BakeOnce(tours, options);
  EndAsInterrupted();
  return status;
}

}  // namespace flaneur
