#include "pipeline/cli/baking.h"
#include "pipeline/cli/stage_inputs.h"
#include "pipeline/cli/title_page.h"

namespace flaneur {

// Of a step that the models stand for.
struct KeptReport {
  StageReport report;
  double work_s = 0, peak_mb = 0;
  Warnings warnings;
};

// For stage_cache.h.
template <typename A>
void Fields(A& a, TourAvatar* v) {
  a(&v->levels, &v->impostor, &v->reach_m, &v->prop_triangles);
}
template <typename A>
void Fields(A& a, KeptReport* v) {
  a(&v->report, &v->work_s, &v->peak_mb, &v->warnings);
}

namespace {

// Its needs may have been left out, because the store had a result that turned out to be damaged.
Error MakeModels(Baking* baking, const Step& step) {
  for (const size_t need : step.needs) {
    if (Error e = DoStep(baking->store, &baking->steps[need])) return e;
  }
  if (Error e = MakeTitlePage(baking->settings.title_page, &baking->parts.title_page)) return e;
  return BuildModels(baking->parts, &baking->models);
}

std::string PackModels(Baking* baking, const Step& step, StageReport* report, Warnings* warnings) {
  std::vector<TourAvatar> avatars;
  for (const TourAvatar& avatar : baking->parts.avatars) avatars.push_back(WithoutBulk(avatar));
  std::vector<KeptReport> reports;
  for (const size_t need : step.needs) {
    const Step& done = baking->steps[need];
    reports.push_back({done.report, done.report.work_s, done.report.peak_mb, done.warnings});
  }
  return Packed(&baking->models, &avatars, &reports, report, warnings);
}

void TakeReport(const KeptReport& kept, Step* step) {
  step->report = kept.report;
  step->report.stage = step->stage;
  step->report.item = step->item;
  step->report.cached = true;
  step->report.work_s = kept.work_s;
  step->report.peak_mb = kept.peak_mb;
  step->warnings = kept.warnings;
}

bool UnpackModels(Baking* baking, const Step& step, const std::string& content, StageReport* report,
                  Warnings* warnings) {
  std::vector<TourAvatar> avatars;
  std::vector<KeptReport> reports;
  if (!Unpacked(content, &baking->models, &avatars, &reports, report, warnings)) return false;
  if (avatars.size() != baking->parts.avatars.size() || reports.size() != step.needs.size()) return false;
  for (size_t i = 0; i < step.needs.size(); ++i) {
    Step* need = &baking->steps[step.needs[i]];
    if (need->left_out) TakeReport(reports[i], need);
  }
  for (size_t i = 0; i < avatars.size(); ++i) {
    TourAvatar& avatar = baking->parts.avatars[i];
    avatar.levels = std::move(avatars[i].levels);
    avatar.impostor = std::move(avatars[i].impostor);
    avatar.reach_m = avatars[i].reach_m;
    avatar.prop_triangles = std::move(avatars[i].prop_triangles);
  }
  return true;
}

}  // namespace

void AddModelsStep(Baking* baking) {
  Step* models = AddStep(baking, "models", baking->settings.name);
  baking->models_step = static_cast<int>(IndexOf(*baking, models));
  for (size_t i = 0; i + 1 < baking->steps.size(); ++i) {
    if (baking->steps[i].stage != "check") models->needs.push_back(i);
  }
  models->inputs = FilesOf(baking->settings.title_page);
  models->stands_for_needs = true;
  models->extension = ".kept";
  models->key = [baking, models] { return ModelsInputs(baking->settings, KeysOfNeeds(*baking, *models)); };
  models->make = [baking, models](StageReport*, Warnings*) { return MakeModels(baking, *models); };
  models->pack = [baking, models](StageReport* r, Warnings* w) { return PackModels(baking, *models, r, w); };
  models->unpack = [baking, models](const std::string& content, StageReport* r, Warnings* w) {
    return UnpackModels(baking, *models, content, r, w);
  };
}

}  // namespace flaneur
