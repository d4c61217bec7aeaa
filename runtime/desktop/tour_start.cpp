#include "runtime/desktop/tour_start.h"

#include <algorithm>

#include "runtime/desktop/warn.h"
#include "runtime/show/guide_figure.h"
#include "runtime/simulation/scenario.h"

namespace flaneur {
namespace {

// The scenario's file, and over it what the command line says.
Error TakeOptions(const PlayerOptions& options, Scenario* scenario) {
  if (!options.scenario.empty()) {
    if (Error e = ReadScenario(options.scenario, scenario)) return e;
  }
  if (options.people) scenario->crowd.people = *options.people;
  if (options.seed) scenario->crowd.seed = *options.seed;
  if (options.hour) scenario->hour = *options.hour;
  if (options.adaptation) TakeNamed(*options.adaptation, kAdaptationNames, &scenario->control.adaptation);
  if (options.discretion) scenario->control.discretion = *options.discretion;
  scenario->language = options.language;
  scenario->screen_width_px = options.width_px / static_cast<int>(std::max<size_t>(1, options.compare.size()));
  scenario->screen_height_px = options.height_px;
  return Ok();
}

}  // namespace

StartingTour::StartingTour(const PlayerOptions& options)
    : jobs(options.threads ? static_cast<size_t>(*options.threads) : ThreadsOfThisMachine()),
      loader(&jobs),
      simulations(std::max<size_t>(1, options.compare.size())) {}

Error OpenTour(const PlayerOptions& options, StartingTour* tour) {
  if (!options.pack.empty()) {
    const uint64_t most_bytes = static_cast<uint64_t>(options.pack_memory_mib) * kBytesAMebibyte;
    if (Error e = tour->file.Open(options.pack, &tour->pack, {most_bytes, most_bytes})) return e;
    AddGuideFigure(&tour->pack);
    tour->scenario = ScenarioOf(tour->pack);
  }
  return TakeOptions(options, &tour->scenario);
}

Error StartSimulations(const PlayerOptions& options, StartingTour* tour) {
  const TourPack* pack = options.pack.empty() ? nullptr : &tour->pack;
  for (size_t k = 0; k < tour->simulations.size(); ++k) {
    if (!options.compare.empty()) TakeNamed(options.compare[k], kAdaptationNames, &tour->scenario.control.adaptation);
    if (Error e = StartSimulation(pack, tour->scenario, &tour->simulations[k], &tour->jobs)) {
      const auto& source = options.scenario.empty() ? options.pack : options.scenario;
      return Fail(source.string() + ": " + e.message);
    }
  }
  return Ok();
}

void WarnOfTour(const StartingTour& tour) {
  for (const std::string& warning : tour.simulations.front().town.warnings) Warn(warning);
}

}  // namespace flaneur
