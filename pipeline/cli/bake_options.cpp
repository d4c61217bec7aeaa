#include "pipeline/cli/bake_options.h"

#include <CLI/CLI.hpp>

#include "runtime/base/option_range.h"

namespace flaneur {

void AddPlaces(CLI::App* app, BakeOptions* options) {
  app->add_option(
      "-o,--output", options->output,
      "Folder for the results, made where missing (default: build_assets/NAME); of several tours: for their "
      "folders");
  app->add_option("--cache", options->cache,
                  "Folder for what steps have made, which tours, machines and users may share (default: what "
                  "FLANEUR_CACHE names, else the output's cache)");
  app->add_flag("--draft", options->draft, "Everything, coarsely, in a fraction of the time");
  app->add_flag("--allow-scripts", options->trust.scripts,
                "Run the .py sources of this tour, which can do what you can, though in a sandbox where bubblewrap is "
                "installed");
  app->add_flag("--allow-outside", options->trust.outside, "Read files outside the tour's folder");
}

void AddLimits(CLI::App* app, BakeOptions* options) {
  app->add_option("-j,--jobs", options->jobs, "Steps at a time (default: one a core)")->check(CLI::Range(1, 1024));
  app->add_option("--memory", options->memory_mb,
                  "Megabytes that steps may take together (default: four fifths of what is free)")
      ->check(NumberFrom(1.0, 1e9));
  app->add_option("--time-limit", options->time_limit_s,
                  "Seconds for each program that a step starts, such as Blender; 0: none")
      ->check(NumberFrom(0.0, 1e9))
      ->capture_default_str();
}

}  // namespace flaneur
