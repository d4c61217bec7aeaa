// A bake as steps: each made from what earlier ones made and from files, and kept under a key of all that. Internal to
// pipeline/cli.
#pragma once
#include <atomic>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "pipeline/cli/stage_cache.h"
#include "pipeline/core/report.h"
#include "pipeline/core/store.h"
#include "runtime/base/error.h"

namespace flaneur {

using Warnings = std::vector<std::string>;

// Does the work. It may fill in what the report says of it, and warn.
using StepWork = std::function<Error(StageReport*, Warnings*)>;

struct Step {
  std::string stage, item;
  std::vector<size_t> needs;                  // steps of the same bake, all before this one
  std::vector<std::filesystem::path> inputs;  // files and folders of the user's
  std::function<std::string()> key;  // of all that it is made from; the needs have been done, or are in the store
  StepWork make;
  // How its result goes into the store and comes back; no extension: it is made each time. A file: the one that `make`
  // has written and named here; else what `pack` gives and `unpack` takes.
  std::string extension;
  bool is_file = false;
  std::filesystem::path file;
  std::function<std::string(StageReport*, Warnings*)> pack;
  std::function<bool(const std::string&, StageReport*, Warnings*)> unpack;
  std::function<Error(Warnings*)> then;  // after it was made or read; may be empty

  // With its result in the store nobody reads those of its needs: it brings their reports.
  bool stands_for_needs = false;

  // What the run finds out.
  std::string known_key;
  StoreEntry entry;  // where in_store
  bool in_store = false, done = false;
  bool left_out = false;             // nobody asks for its result in this run
  int cores = 1;                     // that it may use: more where nothing else could
  std::atomic<double> progress = 0;  // share, where it tells
  std::mutex mutex;                  // held while it is done
  StageReport report;
  Warnings warnings;

  std::string name() const { return stage + ":" + item; }
  bool kept() const { return !extension.empty(); }
};

// The step's result in the store is all these.
template <typename... Parts>
void Keep(Step* step, Parts*... parts) {
  step->extension = ".kept";
  step->pack = [parts...](StageReport* report, Warnings* warnings) { return Packed(parts..., report, warnings); };
  step->unpack = [parts...](const std::string& content, StageReport* report, Warnings* warnings) {
    return Unpacked(content, parts..., report, warnings);
  };
}

// Takes the result from the store, or makes it and keeps it. Once, whoever asks. Errors: the work's; interrupted.
Error DoStep(const Store& store, Step* step);

// Whether the result of a step that was done with a file is whole, which is made again where it is not.
Error CheckFile(const Store& store, Step* step);

// Seconds of the clock and megabytes that it will probably take.
struct StepCost {
  double seconds = 0, memory_mb = 0;
};
StepCost ExpectedCost(const Store& store, const Step& step);

}  // namespace flaneur
