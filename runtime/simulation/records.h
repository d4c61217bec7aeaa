// Metrics and trajectories of a run as CSV: one row a frame, one row a person a frame.
#pragma once
#include <filesystem>
#include <string>

#include "runtime/simulation/simulation.h"

namespace flaneur {

struct FrameCosts {
  int64_t town_triangles = 0, shadow_triangles = 0;
  double draw_ms = 0;
};

struct Records {
  std::string metrics, trajectories;  // text so far; written at the end, whole
  bool keep_metrics = false, keep_trajectories = false;
};

void Record(const Simulation& simulation, const FrameCosts& costs, Records* records);
Error WriteRecords(const Records& records, const std::filesystem::path& metrics,
                   const std::filesystem::path& trajectories);

}  // namespace flaneur
