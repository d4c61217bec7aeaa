#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "pipeline/cli/arguments.h"
#include "pipeline/cli/bake.h"
#include "pipeline/cli/bake_options.h"
#include "pipeline/cli/verbs.h"

namespace flaneur {
namespace {

void PrintJson(const std::vector<PlannedStep>& plan) {
  nlohmann::ordered_json json{{"version", 1}};
  json["steps"] = nlohmann::ordered_json::array();
  for (const PlannedStep& step : plan) {
    json["steps"].push_back({{"name", step.name},
                             {"needs", step.needs},
                             {"inputs", step.inputs},
                             {"outputs", step.outputs},
                             {"key", step.key},
                             {"done", step.in_store},
                             {"provisional", step.provisional},
                             {"seconds", std::round(step.seconds * 100) / 100},
                             {"memory_mb", std::round(step.memory_mb)}});
  }
  std::printf("%s\n", json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
}

void PrintTable(const std::vector<PlannedStep>& plan) {
  std::printf("%-28s %8s %8s  %-8s %s\n", "step", "seconds", "MB", "key", "needs");
  for (const PlannedStep& step : plan) {
    std::string needs;
    for (const std::string& need : step.needs) needs += (needs.empty() ? "" : ", ") + need;
    const std::string seconds = std::to_string(std::lround(step.seconds));
    std::printf("%-28s %8s %8.0f  %.8s %s\n", step.name.c_str(), step.in_store ? "done" : seconds.c_str(),
                step.memory_mb, step.key.c_str(), needs.c_str());
  }
}

}  // namespace

int RunPlan(const Arguments& args) {
  CLI::App app{
      "Lists the steps of a bake: what each needs, from which files it is made, where its result goes, its key, and "
      "what "
      "it will probably take.\n`flaneur step` does one of them, on any machine that shares the cache.",
      "flaneur plan"};
  std::filesystem::path tour;
  BakeOptions options;
  bool json = false;
  app.add_option("TOUR", tour, "tour.toml")->required();
  app.add_flag("--json", json, "As JSON");
  AddPlaces(&app, &options);
  if (const int status = ParseArguments(&app, args); status >= 0) return status;
  std::vector<PlannedStep> plan;
  if (Error e = PlanBake(tour, options, &plan)) return Report(e);
  json ? PrintJson(plan) : PrintTable(plan);
  return 0;
}

}  // namespace flaneur
