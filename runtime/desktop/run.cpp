#include "runtime/desktop/run.h"

#include <algorithm>

#include "runtime/simulation/records.h"

namespace flaneur {
namespace {

constexpr float kDefaultLength_s = 60;
constexpr float kLongest_s = 1e6f;

}  // namespace

float RunLength_s(const PlayerOptions& options, const Scenario& scenario, const Simulation& simulation) {
  if (options.seconds) return *options.seconds;
  if (!options.at_s.empty()) return *std::max_element(options.at_s.begin(), options.at_s.end());
  if (scenario.seconds) return *scenario.seconds;
  const bool ends_by_itself = !simulation.visitor.legs.empty() || !simulation.visitor.tour.stops.empty();
  return ends_by_itself ? kLongest_s : kDefaultLength_s;
}

Error RunWithoutDrawing(const PlayerOptions& options, float seconds, Simulation* simulation) {
  Records records;
  records.keep_metrics = !options.metrics.empty();
  records.keep_trajectories = !options.trajectories.empty();
  const auto record = [&] {
    Record(*simulation, {0, 0, static_cast<double>(FrameTimeByModel_ms(*simulation))}, &records);
  };
  record();
  const auto steps =
      static_cast<int64_t>(static_cast<double>(seconds) / static_cast<double>(Step_s(*simulation)) + 0.5);
  while (simulation->town.step < steps && !simulation->visitor.finished) {
    StepSimulation({}, FrameTimeByModel_ms(*simulation), simulation);
    record();
  }
  return WriteRecords(records, options.metrics, options.trajectories);
}

}  // namespace flaneur
