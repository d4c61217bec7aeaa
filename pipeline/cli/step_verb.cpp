#include <CLI/CLI.hpp>

#include "pipeline/cli/arguments.h"
#include "pipeline/cli/bake.h"
#include "pipeline/cli/bake_options.h"
#include "pipeline/cli/verbs.h"
#include "pipeline/core/interruption.h"

namespace flaneur {

int RunStep(const Arguments& args) {
  CLI::App app{
      "Does one step of a bake, as `flaneur plan` names it; what it needs is taken from the cache, or made where it is "
      "not there.",
      "flaneur step"};
  std::filesystem::path tour;
  std::string name;
  BakeOptions options;
  app.add_option("TOUR", tour, "tour.toml")->required();
  app.add_option("NAME", name, "The step, such as avatar:monk")->required();
  AddPlaces(&app, &options);
  AddLimits(&app, &options);
  if (const int status = ParseArguments(&app, args); status >= 0) return status;
  CatchInterruptions();
  const int status = Report(BakeStep(tour, options, name));
  EndAsInterrupted();
  return status;
}

}  // namespace flaneur
