#include <CLI/CLI.hpp>
#include <cstdio>

#include "pipeline/cli/arguments.h"
#include "pipeline/cli/bake.h"
#include "pipeline/cli/verbs.h"
#include "pipeline/core/interruption.h"

namespace flaneur {

int RunBake(const Arguments& args) {
  CLI::App app{
      "Makes a tour pack from a town, avatars and one tour.toml.\n"
      "Writes DIR/NAME.glb, DIR/report.html, DIR/report.json and DIR/footprints.geojson.",
      "flaneur bake"};
  std::string tour, output;
  app.add_option("TOUR", tour, "tour.toml; assets_src/reference/tour.toml explains every setting")->required();
  app.add_option("-o,--output", output, "Folder for the results, made where missing (default: build_assets/NAME)");
  if (const int status = ParseArguments(&app, args); status >= 0) return status;
  CatchInterruptions();
  const int status = Report(Bake(tour, output));
  EndAsInterrupted();
  return status;
}

}  // namespace flaneur
