// The steps of a bake as its user sees them: reported, timed, shown as they end, side by side where they do not depend
// on each other, and kept for the next bake. Internal to pipeline/cli.
#pragma once
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "pipeline/cli/stage_cache.h"
#include "pipeline/core/report.h"
#include "runtime/base/error.h"
#include "runtime/base/jobs.h"

namespace flaneur {

struct BakeSteps {
  std::filesystem::path cache;  // folder
  BakeReport report;
  std::mutex mutex;  // guards report and the progress line
  int done = 0, count = 0;
};

// One item of a stage. It may fill in what the report says of it, and warn.
using StepWork = std::function<Error(StageReport*, std::vector<std::string>*)>;

// Errors: the work's; interrupted.
Error RunStep(BakeSteps* steps, const std::string& stage, const std::string& item, const StepWork& work);

// The same for work that makes `parts` and depends on `inputs` (a fingerprint) alone: where the last bake had the same
// inputs its parts, figures and warnings are taken.
template <typename... Parts>
Error RunKeptStep(BakeSteps* steps, const std::string& stage, const std::string& item, const std::string& inputs,
                  const StepWork& work, Parts*... parts) {
  return RunStep(steps, stage, item, [&](StageReport* report, std::vector<std::string>* warnings) -> Error {
    const std::filesystem::path file = steps->cache / (stage + "_" + item + ".kept");
    report->cached = ReadKept(file, inputs, parts..., report, warnings);
    if (report->cached) return Ok();
    if (Error e = work(report, warnings)) return e;
    return WriteKept(file, inputs, parts..., report, warnings);
  });
}

// Runs work(0) ... work(count - 1), several at a time; the error of the lowest index counts.
Error RunParallel(Jobs* jobs, size_t count, const std::function<Error(size_t)>& work);

}  // namespace flaneur
