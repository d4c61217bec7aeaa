// Steps of several tours, side by side. Internal to pipeline/cli.
#pragma once
#include <cstddef>
#include <vector>

#include "pipeline/cli/baking.h"
#include "runtime/base/error.h"

namespace flaneur {

struct RunLimits {
  size_t at_a_time = 1;
  double memory_mb = 0;  // of all that run together; a single one may take more
};

// Does all steps of these tours, those first on which most of the rest waits; of tours, the first ones first. Steps of
// the same key are done once, whoever's they are. errors[i] is the first of tour i, whose other steps are then left
// out. Shows on stderr what is done and what is left.
void RunSteps(const std::vector<Baking*>& bakings, const RunLimits& limits, std::vector<Error>* errors);

}  // namespace flaneur
