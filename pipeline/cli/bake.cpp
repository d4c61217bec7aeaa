#include "pipeline/cli/bake.h"

#include <algorithm>
#include <cstdlib>
#include <deque>
#include <map>
#include <sstream>

#include "pipeline/cli/baking.h"
#include "pipeline/cli/draft.h"
#include "pipeline/cli/run_steps.h"
#include "pipeline/cli/stage_inputs.h"
#include "pipeline/core/child_policy.h"
#include "pipeline/core/interruption.h"
#include "pipeline/core/results.h"
#include "pipeline/core/temporary_folder.h"
#include "runtime/base/array.h"
#include "runtime/base/file.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;

constexpr double kShareOfFreeMemory = 0.8;

Error RequireFile(const TourSettings& s, const fs::path& file) {
  std::error_code ec;
  if (file.empty() || fs::is_regular_file(file, ec)) return Ok();
  const bool there = fs::exists(file, ec), is_windows = file.string().find('\\') != std::string::npos;
  return Fail(PlaceOfFile(s, file) + file.string() + (there ? ": a folder or device, no file" : ": no such file") +
              (is_windows ? "; between folders stands /" : ""));
}

// Where tour.toml names the file that it is about.
Error WithPlace(const Baking& baking, Error error) {
  return error ? Fail(PlaceOfMessage(baking.settings, error.message) + error.message) : error;
}

// All of them before the first minute of work.
Error RequireFiles(const TourSettings& s) {
  std::vector<fs::path> files{s.town.file};
  for (const TownPart& part : s.parts) files.push_back(part.file);
  for (const AvatarSettings& avatar : s.avatars) {
    files.push_back(avatar.source.file);
    for (const fs::path& file : FilesBeside(avatar)) files.push_back(file);
  }
  for (const fs::path& file : MediaFiles(s)) files.push_back(file);
  for (const fs::path& file : files) {
    if (Error e = RequireFile(s, file)) return e;
  }
  return Ok();
}

fs::path CacheOf(const BakeOptions& options, const fs::path& beside) {
  const char* named = std::getenv("FLANEUR_CACHE");
  if (!options.cache.empty()) return options.cache;
  return named && *named ? fs::path(named) : beside / "cache";
}

double FreeMemory_mb() {
  std::string text, word;
  double kilobytes = 0;
  if (ReadTextFile("/proc/meminfo", &text)) return 4000;
  std::istringstream words(text.substr(std::min(text.find("MemAvailable:"), text.size())));
  words >> word >> kilobytes;
  return kilobytes / 1024;
}

// What the tour's settings and the store say; nothing is made but what is known from the store already.
Error Open(const fs::path& tour, const BakeOptions& options, bool several, Jobs* jobs, Baking* baking) {
  baking->tour = tour;
  baking->jobs = jobs;
  if (Error e = ReadTourSettings(tour, &baking->settings)) return e;
  if (options.draft) MakeDraft(&baking->settings);
  const fs::path folder = options.output.empty() ? fs::path("build_assets") : options.output;
  baking->output = several || options.output.empty() ? folder / baking->settings.name : folder;
  baking->store.folder = CacheOf(options, several ? folder : baking->output);
  static_cast<TourData&>(baking->parts) = baking->settings;
  if (Error e = RequireFiles(baking->settings)) return e;
  if (Error e = CheckTrust(tour, baking->settings, options.trust)) return e;
  AddSourceSteps(baking);
  AddTownSteps(baking);
  AddPeopleSteps(baking);
  AddCheckStep(baking);
  AddModelsStep(baking);
  AddPackSteps(baking);
  return Ok();
}

// With what it needs, and what that needs: all of it as long as nobody has looked what is in the store.
std::vector<bool> NeededFor(const Baking& baking, size_t wanted) {
  std::vector<bool> needed(baking.steps.size(), false);
  needed[wanted] = true;
  for (size_t i = wanted + 1; i-- > 0;) {  // needs stand before those that need them
    const Step& step = baking.steps[i];
    if (!needed[i] || (step.stands_for_needs && step.in_store)) continue;
    for (const size_t need : step.needs) needed[need] = true;
  }
  return needed;
}

// Which of these results are in the store. What the town is has to be read to know what people do there.
Error Resolve(const std::vector<bool>& asked, Baking* baking) {
  for (Step& step : baking->steps) {
    if (!asked[IndexOf(*baking, &step)]) continue;
    step.known_key = step.key();
    if (!step.kept()) continue;
    step.in_store = FindEntry(baking->store, step.known_key, &step.entry);
    if (!step.in_store || IndexOf(*baking, &step) != static_cast<size_t>(baking->town_step)) continue;
    if (Error e = DoStep(baking->store, &step)) return e;
  }
  return Ok();
}

Error Resolve(Baking* baking) { return Resolve(std::vector<bool>(baking->steps.size(), true), baking); }

void SetPolicy(const std::vector<fs::path>& tours, const BakeOptions& options) {
  ChildPolicy policy;
  policy.time_limit_s = options.time_limit_s;
  std::error_code ec;
  if (!options.trust.outside) {
    for (const fs::path& tour : tours) policy.roots.push_back(fs::absolute(tour, ec).parent_path());
  }
  SetChildPolicy(std::move(policy));
}

Error MakeFolders(Baking* baking, FolderLock* lock) {
  for (const fs::path& folder : {baking->output, baking->store.folder}) {
    std::error_code ec;
    fs::create_directories(folder, ec);
    if (ec) return Fail(folder.string() + ": cannot make this folder: " + ec.message());
  }
  if (Error e = lock->Take(baking->output)) return e;
  RecoverResults(baking->output);
  SweepLeftovers(baking->store.folder);
  std::error_code none;
  SweepLeftovers(fs::temp_directory_path(none));
  return Ok();
}

size_t JobsOf(const BakeOptions& options) { return options.jobs > 0 ? options.jobs : ThreadsOfThisMachine(); }

// One tour of a bake.
struct Ordered {
  Baking baking;
  FolderLock lock;
  bool unchanged = false;
};

Error Begin(Ordered* ordered) {
  Baking* baking = &ordered->baking;
  if (Error e = MakeFolders(baking, &ordered->lock)) return e;
  if (Error e = Resolve(baking)) return e;
  ordered->unchanged = ResultsAreUpToDate(baking);
  return Ok();
}

BakedTour Told(const fs::path& tour, const Ordered& ordered) {
  const Baking& baking = ordered.baking;
  BakedTour told;
  told.tour = tour;
  told.name = baking.settings.name;
  told.pack = baking.output / (baking.settings.name + ".glb");
  told.report = baking.output / "report.html";
  told.unchanged = ordered.unchanged;
  told.warnings = baking.report.warnings.size();
  for (const StageReport& stage : baking.report.stages) told.work_s += stage.cached ? 0 : stage.work_s;
  for (const ReportFinding& finding : baking.report.findings)
    told.errors_found += finding.severity == "error" ? 1u : 0u;
  return told;
}

// Two tours of a name would write the same files.
Error CheckDistinct(const std::deque<Ordered>& all) {
  std::map<fs::path, fs::path> outputs;
  for (const Ordered& ordered : all) {
    const auto [other, fresh] = outputs.try_emplace(ordered.baking.output, ordered.baking.tour);
    if (!fresh && !ordered.baking.output.empty()) {
      return Fail(ordered.baking.tour.string() + " and " + other->second.string() + " have one name, '" +
                  ordered.baking.settings.name + "'; give one of them another tour.name");
    }
  }
  return Ok();
}

}  // namespace

Error Bake(const std::vector<fs::path>& tours, const BakeOptions& options, std::vector<BakedTour>* baked) {
  SetPolicy(tours, options);
  const size_t at_a_time = JobsOf(options);
  Jobs jobs(at_a_time - 1);
  std::deque<Ordered> all;
  std::vector<Error> errors;
  std::vector<Baking*> bakings;
  std::vector<size_t> places;  // of each of these among all
  for (const fs::path& tour : tours) {
    all.emplace_back();
    errors.push_back(Open(tour, options, tours.size() > 1, &jobs, &all.back().baking));
    if (Error e = CheckDistinct(all)) return e;  // before a second lock on one folder
    if (!errors.back()) errors.back() = Begin(&all.back());
    if (Error e = Interrupted()) return e;
    if (errors.back() || all.back().unchanged) continue;
    LeaveOutUnneeded(&all.back().baking, static_cast<size_t>(all.back().baking.pack_step));
    bakings.push_back(&all.back().baking);
    places.push_back(all.size() - 1);
  }
  std::vector<Error> of_steps;
  const double memory_mb = options.memory_mb > 0 ? options.memory_mb : kShareOfFreeMemory * FreeMemory_mb();
  if (!bakings.empty()) RunSteps(bakings, {at_a_time, memory_mb}, &of_steps);
  for (size_t i = 0; i < of_steps.size(); ++i) errors[places[i]] = WithPlace(*bakings[i], std::move(of_steps[i]));
  Error first;
  for (size_t i = 0; i < all.size(); ++i) {
    baked->push_back(Told(tours[i], all[i]));
    baked->back().error = errors[i];
    if (errors[i] && !first) first = errors[i];
  }
  return first;
}

Error PlanBake(const fs::path& tour, const BakeOptions& options, std::vector<PlannedStep>* plan) {
  SetPolicy({tour}, options);
  Baking baking;
  if (Error e = Open(tour, options, false, nullptr, &baking)) return e;
  if (Error e = Resolve(&baking)) return e;
  for (const Step& step : baking.steps) {
    PlannedStep planned;
    planned.name = step.name();
    planned.key = step.known_key;
    planned.in_store = step.in_store;
    const StepCost cost = ExpectedCost(baking.store, step);
    planned.seconds = cost.seconds;
    planned.memory_mb = cost.memory_mb;
    for (const size_t need : step.needs) {
      planned.needs.push_back(baking.steps[need].name());
      planned.inputs.insert(planned.inputs.end(), (*plan)[need].outputs.begin(), (*plan)[need].outputs.end());
      const bool undone_script = baking.steps[need].stage == "source" && !baking.steps[need].in_store;
      planned.provisional = planned.provisional || undone_script || (*plan)[need].provisional;
    }
    for (const fs::path& input : step.inputs) planned.inputs.push_back(input.string());
    if (step.kept()) planned.outputs.push_back(EntryFile(baking.store, step.known_key, step.extension).string());
    if (step.stage == "pack") {
      planned.in_store = ResultsAreWhole(baking.output, step.known_key);
      for (const char* name : {"report.html", "report.json", "footprints.geojson", "plan.png", kManifest})
        planned.outputs.push_back((baking.output / name).string());
      planned.outputs.insert(planned.outputs.begin(), (baking.output / (baking.settings.name + ".glb")).string());
    }
    plan->push_back(std::move(planned));
  }
  return Ok();
}

Error BakeStep(const fs::path& tour, const BakeOptions& options, const std::string& name) {
  SetPolicy({tour}, options);
  Jobs jobs(JobsOf(options) - 1);
  Baking baking;
  if (Error e = Open(tour, options, false, &jobs, &baking)) return e;
  std::vector<std::string> names;
  for (const Step& step : baking.steps) names.push_back(step.name());
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    return Fail(tour.string() + " has no step '" + OneLine(name) + "'" + DidYouMean(name, names) +
                "; flaneur plan lists them");
  }
  const size_t wanted = static_cast<size_t>(found - names.begin());
  FolderLock lock;
  std::error_code ec;
  fs::create_directories(baking.store.folder, ec);
  if (baking.steps[wanted].stage == "pack") {
    if (Error e = MakeFolders(&baking, &lock)) return e;
  }
  if (Error e = Resolve(NeededFor(baking, wanted), &baking)) return e;
  if (baking.steps[wanted].stage == "pack" && ResultsAreUpToDate(&baking)) return Ok();
  const std::vector<bool> needed = LeaveOutUnneeded(&baking, wanted);
  for (size_t i = 0; i <= wanted; ++i) {
    const bool there = i != wanted && baking.steps[i].in_store && baking.steps[i].is_file;
    if (!needed[i] || there) continue;
    if (Error e = DoStep(baking.store, &baking.steps[i])) return WithPlace(baking, std::move(e));
  }
  return Ok();
}

Error FilesOfTour(const fs::path& tour, std::vector<fs::path>* files) {
  BakeOptions options;
  options.trust = {true, true};
  Baking baking;
  files->push_back(tour);
  if (Error e = Open(tour, options, false, nullptr, &baking)) return e;
  for (const Step& step : baking.steps) {
    for (const fs::path& input : step.inputs) files->push_back(input);
  }
  return Ok();
}

std::vector<bool> LeaveOutUnneeded(Baking* baking, size_t wanted) {
  std::vector<bool> needed = NeededFor(*baking, wanted);
  for (size_t i = 0; i < needed.size(); ++i) baking->steps[i].left_out = !needed[i];
  return needed;
}

std::vector<std::string> KeysOfNeeds(const Baking& baking, const Step& step) {
  std::vector<std::string> keys;
  for (const size_t need : step.needs) {
    if (baking.steps[need].stage != "source") keys.push_back(baking.steps[need].key());
  }
  return keys;
}

Step* AddStep(Baking* baking, const std::string& stage, const std::string& item) {
  Step* step = &baking->steps.emplace_back();
  step->stage = stage;
  step->item = item;
  return step;
}

size_t IndexOf(const Baking& baking, const Step* step) {
  for (size_t i = 0; i < baking.steps.size(); ++i) {
    if (&baking.steps[i] == step) return i;
  }
  return baking.steps.size();
}

}  // namespace flaneur
