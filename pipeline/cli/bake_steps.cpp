#include "pipeline/cli/bake_steps.h"

#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <cstdio>

#include "pipeline/core/interruption.h"
#include "runtime/base/clock.h"

namespace flaneur {
namespace {

constexpr size_t kMaxWarningsShown = 8;  // of a step on the terminal; the report has all

double PeakMemory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

void ShowProgress(int done, int count, const StageReport& report, const std::vector<std::string>& warnings) {
  std::fprintf(stderr, "[%*d/%d] %-10s %s ... ", count > 9 ? 2 : 1, done, count, report.stage.c_str(),
               report.item.c_str());
  if (report.cached) std::fprintf(stderr, "cached\n");
  else std::fprintf(stderr, "%.1f s\n", report.seconds);
  for (size_t i = 0; i < std::min(warnings.size(), kMaxWarningsShown); ++i) {
    std::fprintf(stderr, "        warning: %s\n", warnings[i].c_str());
  }
  if (warnings.size() > kMaxWarningsShown) {
    std::fprintf(stderr, "        and %zu more warnings, see report.html\n", warnings.size() - kMaxWarningsShown);
  }
}

}  // namespace

Error RunStep(BakeSteps* steps, const std::string& stage, const std::string& item, const StepWork& work) {
  StageReport report;
  std::vector<std::string> warnings;
  const double start_s = Now_s();
  if (Error e = Interrupted()) return e;
  Error error = work(&report, &warnings);
  if (Error e = Interrupted()) return e;
  if (error) return error;
  report.stage = stage;
  report.item = item;
  report.seconds = Now_s() - start_s;
  if (report.peak_mb == 0) report.peak_mb = PeakMemory_mb();
  const std::lock_guard lock(steps->mutex);
  ShowProgress(++steps->done, steps->count, report, warnings);
  for (const std::string& warning : warnings) steps->report.warnings.push_back(stage + " " + item + ": " + warning);
  steps->report.stages.push_back(std::move(report));
  return Ok();
}

Error RunParallel(Jobs* jobs, size_t count, const std::function<Error(size_t)>& work) {
  std::vector<Error> errors(count);
  std::atomic<bool> failed{false};
  ParallelFor(jobs, count, [&](size_t i) {
    if (failed) return;
    errors[i] = work(i);
    if (errors[i]) failed = true;
  });
  for (Error& error : errors) {
    if (error) return std::move(error);
  }
  return Ok();
}

}  // namespace flaneur
