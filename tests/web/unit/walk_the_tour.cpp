// walk_the_tour PACK SECONDS TRAJECTORIES: what flaneur-player does with --headless --no-draw, as a page's code.
#include <cstdio>
#include <cstdlib>

#include "runtime/show/guide_figure.h"
#include "runtime/simulation/records.h"
#include "runtime/simulation/simulation.h"

namespace flaneur {
namespace {

Error Walk(const char* path, float seconds, const char* trajectories) {
  PackFile file;
  TourPack pack;
  if (Error e = file.Open(path, &pack)) return e;
  AddGuideFigure(&pack);
  Simulation simulation;
  if (Error e = StartSimulation(&pack, ScenarioOf(pack), &simulation)) return e;
  Records records;
  records.keep_trajectories = true;
  Record(simulation, {}, &records);
  const auto steps = static_cast<int64_t>(static_cast<double>(seconds) / static_cast<double>(Step_s(simulation)) + 0.5);
  while (simulation.town.step < steps && !simulation.visitor.finished) {
    StepSimulation({}, FrameTimeByModel_ms(simulation), &simulation);
    Record(simulation, {}, &records);
  }
  return WriteRecords(records, "", trajectories);
}

}  // namespace
}  // namespace flaneur

int main(int count, char** arguments) {
  if (count != 4) {
    std::fprintf(stderr, "usage: walk_the_tour PACK SECONDS TRAJECTORIES\n");
    return 2;
  }
  const flaneur::Error e = flaneur::Walk(arguments[1], static_cast<float>(std::atof(arguments[2])), arguments[3]);
  if (!e) return 0;
  std::fprintf(stderr, "walk_the_tour: error: %s\n", e.message.c_str());
  return 2;
}
