#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "pipeline/cli/baking.h"
#include "pipeline/cli/check_words.h"
#include "pipeline/cli/stage_inputs.h"
#include "pipeline/cli/visitor_media.h"
#include "pipeline/cli/work_clips.h"
#include "pipeline/core/interruption.h"
#include "pipeline/core/results.h"
#include "pipeline/core/temporary_folder.h"
#include "pipeline/io/geojson.h"
#include "runtime/base/array.h"
#include "runtime/base/clock.h"
#include "runtime/base/color_text.h"
#include "runtime/base/file.h"
#include "runtime/text/system_fonts.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFootprints = "footprints.geojson";

// Into the folder `staging`; the names of what is there then.
Error WritePack(Baking* baking, const fs::path& staging, std::vector<std::string>* names, StageReport* report,
                Warnings* warnings) {
  Fonts fonts(SystemFonts());
  TourParts& parts = baking->parts;
  *warnings = WarningsOfWords(parts, &fonts);
  for (std::string& nobody : WarningsOfWork(parts)) warnings->push_back(std::move(nobody));
  parts.footprints.origin_m = baking->town.origin_m;  // kept ones may have another
  parts.footprints.reference_system = baking->town.reference_system;
  for (Obstacle& o : parts.footprints.obstacles) o.ground_z_m += baking->town.lowered_m;  // as the town's file has it
  parts.title_page.background = baking->settings.title_page.background;
  const std::string pack = baking->settings.name + ".glb";
  BakeReport& whole = baking->report;
  if (Error e = WriteGeoJson(staging / kFootprints, parts.footprints)) return e;
  *names = {pack, kFootprints, "plan.png"};
  if (!parts.footprints.reference_system.empty()) {
    names->push_back(LongitudeLatitudePath(kFootprints));
    if (Error e = WriteLongitudeLatitude(staging / names->back(), parts.footprints)) return e;
  }
  if (Error e = WritePlan(staging / "plan.png", parts.ground, parts.footprints)) return e;
  if (Error e = WriteTourPack(staging / pack, parts, std::move(baking->models), &whole.pack_bytes)) return e;
  whole.pack_path = (baking->output / pack).string();
  report->figures = {{"bytes", static_cast<double>(whole.pack_bytes)}};
  return Ok();
}

Error MakeMedia(Baking* baking) {
  std::call_once(baking->media_read_once,
                 [&] { baking->media_read = MakeVisitorMedia(baking->settings, baking->store, &baking->parts); });
  return baking->media_read;
}

// The names of an earlier bake that this one does not make any more go.
void AddEarlierNames(const Baking& baking, std::vector<std::string>* names) {
  for (const std::string& name : ResultNames(baking.output)) {
    if (std::find(names->begin(), names->end(), name) == names->end()) names->push_back(name);
  }
}

// All results appear together, once all are there.
Error MakePack(Baking* baking, Step* step, StageReport* report, Warnings* warnings) {
  const double start_s = Now_s();
  if (Error e = MakeMedia(baking)) return e;
  TemporaryFolder staging;
  if (Error e = staging.Create(".flaneur_results_", baking->output)) return e;
  std::vector<std::string> names;
  if (Error e = WritePack(baking, staging.path(), &names, report, warnings)) return e;
  step->report = *report;  // of which its report tells too
  step->report.stage = step->stage;
  step->report.item = step->item;
  step->report.seconds = Now_s() - start_s;
  const StageReport& models = At(baking->steps, baking->models_step).report;  // which the report counts as the pack's
  if (!models.cached) {
    step->report.seconds += models.seconds;
    step->report.work_s += models.work_s;
  }
  step->warnings = *warnings;
  FillReport(baking);
  if (Error e = WriteReport(staging.path(), baking->report)) return e;
  names.insert(names.end(), {"report.html", "report.json"});
  if (Error e = WriteManifest(staging.path(), step->known_key, names)) return e;
  if (Error e = Interrupted()) return e;
  AddEarlierNames(*baking, &names);
  names.push_back(kManifest);
  return ReplaceTogether(baking->output, &staging, names);
}

// The pack's models stand for all others.
bool IsOfPack(const std::string& stage) {
  constexpr const char* kStages[] = {"town", "footprints", "meshes", "painting", "check", "models", "media"};
  return std::find(std::begin(kStages), std::end(kStages), stage) != std::end(kStages);
}

// Steps that the report does not list.
bool IsUntold(const std::string& stage) {
  return stage == "media" || stage == "painting" || stage == "meshes" || stage == "models";
}

// As if it had been baked anew from the store: no seconds, all cached.
bool SaysAllCached(std::string* text) {
  auto report = nlohmann::ordered_json::parse(*text, nullptr, false);
  if (!report.is_object() || !report.contains("stages") || !report["stages"].is_array()) return false;
  for (auto& stage : report["stages"]) {
    if (!stage.is_object()) return false;
    stage["cached"] = true;
    stage["seconds"] = 0;
  }
  *text = report.dump(1) + "\n";
  return true;
}

// What a person can do and wear.
std::vector<std::pair<std::string, std::string>> NotesOf(const Baking& baking, const std::string& avatar) {
  std::string clips, tints;
  for (size_t i = 0; i < baking.settings.avatars.size(); ++i) {
    if (baking.settings.avatars[i].name != avatar) continue;
    for (const Clip& clip : baking.parts.avatars[i].levels.avatar.clips)
      clips += (clips.empty() ? "" : ", ") + clip.name;
    for (const Tint& tint : baking.parts.avatars[i].tints) {
      tints += (tints.empty() ? "" : "; ") + TextFromColor(tint.color) + " as";
      for (const Vec3& color : tint.colors) tints += " " + TextFromColor(color);
    }
  }
  std::vector<std::pair<std::string, std::string>> notes{{"clips", clips}};
  if (!tints.empty()) notes.emplace_back("tints", tints);
  return notes;
}

}  // namespace

void AddPackSteps(Baking* baking) {
  const std::string& name = baking->settings.name;
  Step* media = AddStep(baking, "media", name);
  media->inputs = MediaFiles(baking->settings);
  media->key = [baking] { return PackInputs(baking->tour, baking->settings, {"media"}); };
  media->make = [baking](StageReport*, Warnings*) { return MakeMedia(baking); };

  Step* pack = AddStep(baking, "pack", name);
  baking->pack_step = static_cast<int>(IndexOf(*baking, pack));
  for (size_t i = 0; i + 1 < baking->steps.size(); ++i) {
    if (IsOfPack(baking->steps[i].stage)) pack->needs.push_back(i);
  }
  pack->inputs = {baking->tour};
  pack->key = [baking, pack] { return PackInputs(baking->tour, baking->settings, KeysOfNeeds(*baking, *pack)); };
  pack->make = [baking, pack](StageReport* r, Warnings* w) { return MakePack(baking, pack, r, w); };
}

void FillReport(Baking* baking) {
  baking->report.stops.clear();
  for (const TourStop& stop : baking->parts.path) {
    ReportStop told{stop.position_m, stop.captions};
    if (!stop.caption.empty()) told.captions[baking->settings.language] = stop.caption;
    baking->report.stops.push_back(std::move(told));
  }
  baking->report.tour = baking->settings.name;
  baking->report.stages.clear();
  baking->report.warnings.clear();
  for (const Step& step : baking->steps) {
    if (step.report.stage.empty() || IsUntold(step.stage)) continue;
    baking->report.stages.push_back(step.report);
    if (step.stage == "avatar") baking->report.stages.back().notes = NotesOf(*baking, step.item);
    for (const std::string& warning : step.warnings)
      baking->report.warnings.push_back(step.stage + " " + step.item + ": " + warning);
  }
}

bool ResultsAreUpToDate(Baking* baking) {
  const std::string& key = At(baking->steps, baking->pack_step).known_key;
  if (!ResultsAreWhole(baking->output, key)) return false;
  std::string text;
  if (ReadTextFile(baking->output / "report.json", &text)) return false;
  const std::string before = text;
  if (!SaysAllCached(&text)) return false;
  if (text == before) return true;
  TemporaryFolder staging;
  if (staging.Create(".flaneur_results_", baking->output)) return false;
  if (WriteTextFile(staging.path() / "report.json", text)) return false;
  if (UpdateManifest(baking->output, staging.path(), {"report.json"})) return false;
  return !ReplaceTogether(baking->output, &staging, {"report.json", kManifest});
}

}  // namespace flaneur
