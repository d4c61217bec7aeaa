#include "pipeline/cli/run_steps.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace flaneur {
namespace {

TEST(RunSteps, AStepThatThrowsEndsItsTourWithItsWordsAndNobodyWaitsForIt) {
  Baking baking;
  const auto add = [&](const char* stage, StepWork work) {
    Step* step = AddStep(&baking, stage, "town");
    step->key = [stage] { return std::string(stage); };
    step->make = std::move(work);
    return step;
  };
  add("source", [](StageReport*, Warnings*) -> Error { throw std::runtime_error("a letter is cut in two"); });
  for (const char* stage : {"check", "media", "town"}) add(stage, [](StageReport*, Warnings*) { return Ok(); });
  Step* pack = add("pack", [](StageReport*, Warnings*) { return Ok(); });
  pack->needs = {0, 1, 2, 3};
  std::vector<Error> errors;
  RunSteps({&baking}, {.at_a_time = 2, .memory_mb = 1e6}, &errors);
  EXPECT_EQ(errors[0].message, "source:town: a letter is cut in two");
  EXPECT_FALSE(pack->done);
}

}  // namespace
}  // namespace flaneur
