#include "pipeline/cli/bake_steps.h"

#include <sys/resource.h>
#include <time.h>

#include <map>

#include "pipeline/core/fingerprint.h"
#include "pipeline/core/interruption.h"
#include "runtime/base/clock.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;

constexpr double kReading_s = 0.05;  // from the store

// Of steps that nobody has done yet on this machine.
const std::map<std::string, StepCost> kTypicalCosts{
    {"source", {8, 500}}, {"town", {1, 300}},   {"footprints", {2, 400}}, {"painting", {0.2, 100}},
    {"check", {2, 400}},  {"avatar", {3, 300}}, {"impostor", {10, 500}},  {"tint", {0.2, 100}},
    {"meshes", {3, 400}}, {"models", {1, 600}}, {"media", {1, 100}},      {"pack", {0.5, 300}}};

double PeakMemory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

// Processor time of this thread alone.
double Work_s() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Sizes and ages: whoever changes a file while it is being read has the result of neither.
std::vector<std::string> StateOf(const std::vector<fs::path>& files) {
  std::vector<std::string> states;
  std::error_code ec;
  for (const fs::path& file : files) {
    const auto age = fs::last_write_time(file, ec).time_since_epoch().count();
    states.push_back(fs::is_directory(file, ec) ? ""
                                                : std::to_string(fs::file_size(file, ec)) + " " + std::to_string(age));
  }
  return states;
}

Error CheckUnchanged(const std::vector<fs::path>& files, const std::vector<std::string>& before) {
  const std::vector<std::string> now = StateOf(files);
  for (size_t i = 0; i < files.size(); ++i) {
    if (now[i] != before[i]) return Fail(files[i].string() + ": was changed while it was being read; bake again");
  }
  return Ok();
}

bool FromStore(const Store& store, Step* step, StageReport* report, Warnings* warnings) {
  if (!step->kept()) return false;
  if (step->is_file) return FindEntry(store, step->known_key, &step->entry);
  std::string content;
  return ReadEntry(store, step->known_key, &step->entry, &content) && step->unpack(content, report, warnings);
}

Error IntoStore(const Store& store, Step* step, StageReport* report, Warnings* warnings) {
  step->entry.step = step->name();
  step->entry.extension = step->extension;
  step->entry.seconds = report->work_s;
  step->entry.memory_mb = report->peak_mb;
  const std::string content = step->is_file ? "" : step->pack(report, warnings);
  if (Error e = PutEntry(store, step->known_key, step->entry, content, step->file)) return e;
  if (FindEntry(store, step->known_key, &step->entry)) return Ok();
  return Fail(store.folder.string() + ": what was written there cannot be read again");
}

Error Make(const Store& store, Step* step, StageReport* report, Warnings* warnings) {
  const std::vector<std::string> before = StateOf(step->inputs);
  step->entry = {};
  const double start_s = Now_s(), work_s = Work_s();
  if (Error e = step->make(report, warnings)) return e;
  report->work_s += Work_s() - work_s;
  report->seconds = Now_s() - start_s;
  if (report->peak_mb == 0) report->peak_mb = PeakMemory_mb();
  if (Error e = CheckUnchanged(step->inputs, before)) return e;
  return step->kept() ? IntoStore(store, step, report, warnings) : Ok();
}

Error Do(const Store& store, Step* step) {
  StageReport report;
  Warnings warnings;
  if (Error e = Interrupted()) return e;
  step->known_key = step->key();
  report.cached = FromStore(store, step, &report, &warnings);
  if (!report.cached) {
    report = {};
    warnings.clear();
    Error error = Make(store, step, &report, &warnings);
    if (Error e = Interrupted()) return e;
    if (error) return error;
  }
  report.stage = step->stage;
  report.item = step->item;
  if (report.cached) {
    report.work_s = step->entry.seconds;
    report.peak_mb = step->entry.memory_mb;
  }
  if (step->then) {
    if (Error e = step->then(&warnings)) return e;
  }
  step->report = std::move(report);
  step->warnings = std::move(warnings);
  step->in_store = step->kept();
  return Ok();
}

}  // namespace

Error DoStep(const Store& store, Step* step) {
  const std::lock_guard lock(step->mutex);
  if (step->done) return Ok();
  if (Error e = Do(store, step)) return e;
  step->done = true;
  return Ok();
}

Error CheckFile(const Store& store, Step* step) {
  const std::lock_guard lock(step->mutex);
  const std::string sha256 = step->entry.sha256;
  if (ReadEntry(store, step->known_key, &step->entry, nullptr)) return Ok();
  if (Error e = Make(store, step, &step->report, &step->warnings)) return e;
  step->report.cached = false;
  if (step->entry.sha256 == sha256) return Ok();
  return Fail(step->name() +
              ": what was kept of it was damaged, and it came out otherwise when made again; bake again");
}

StepCost ExpectedCost(const Store& store, const Step& step) {
  const auto typical = kTypicalCosts.find(step.stage);
  StepCost cost = typical == kTypicalCosts.end() ? StepCost{} : typical->second;
  if (step.in_store) {
    cost.seconds = kReading_s;
    return cost;
  }
  LastTaken(store, step.name(), &cost.seconds, &cost.memory_mb);
  return cost;
}

}  // namespace flaneur
