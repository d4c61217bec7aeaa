#include <algorithm>
#include <cmath>

#include "pipeline/avatar/decimate.h"
#include "pipeline/cli/baking.h"
#include "pipeline/cli/stage_inputs.h"
#include "pipeline/cli/thumbnail.h"
#include "pipeline/cli/tint_reach.h"
#include "pipeline/cli/trust.h"
#include "pipeline/io/gltf.h"
#include "runtime/base/color_text.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;

// Of a small grown-up: all are seen from the same distances, and who is lower is smaller in the picture.
constexpr float kFullHeight_m = 1.5f;
constexpr int kUnseen_px = 16;           // of an impostor that nobody sees
constexpr float kMinTintShare = 0.005f;  // of the surface

Error MakeAvatar(Baking* baking, size_t i, StageReport* report, Warnings* warnings) {
  const AvatarSettings& settings = baking->settings.avatars[i];
  TourAvatar* parts = &baking->parts.avatars[i];
  AvatarLevels* levels = &parts->levels;
  fs::path file;
  if (Error e = SourceFile(baking, i + 1, &file)) return e;
  ReadAvatarOptions read;
  read.name = settings.name;
  read.walk = settings.walk;
  read.idle = settings.idle;
  read.talk = settings.talk;
  read.height_m = settings.height_m;
  read.hide = settings.hide;
  read.scale = settings.scale;
  read.up = settings.up;
  read.forward = settings.forward;
  read.parts = settings.parts;
  for (const auto* clips : {&settings.usual_clips, &settings.clips}) {
    for (const ClipSettings& clip : *clips) read.other_clips.push_back({clip.name, clip.clip, clip.file});
  }
  for (const Prop& prop : settings.props) read.props.push_back(prop.name);
  Avatar avatar;
  if (Error e = CheckFilesOfModel(file)) return BadSource(baking, i + 1, e);
  for (const fs::path& beside : FilesBeside(settings)) {
    if (Error e = CheckFilesOfModel(beside)) return Fail(PlaceOfFile(baking->settings, beside) + e.message);
  }
  if (Error e = ReadAvatar(file, read, &avatar, warnings)) return BadSource(baking, i + 1, e);
  if (Error e = BindTints(settings.tint_materials, &avatar)) return e;
  LevelsOptions options = baking->settings.levels;
  options.jobs = baking->jobs;
  if (Error e = BuildLevels(avatar, options, levels, warnings)) return e;
  if (Error e = EncodeTourAvatar(parts, baking->jobs)) return Fail("avatar '" + settings.name + "': " + e.message);
  for (AvatarLevel level : levels->levels) {
    level.meshes.clear();
    report->levels.push_back(std::move(level));
  }
  report->figures = {{"walk_speed_mps", static_cast<double>(avatar.walk_speed_mps)},
                     {"joints", static_cast<double>(avatar.joints.size())}};
  return Ok();
}

// One of those who walk about the town.
bool WalksAbout(const AvatarSettings& avatar, const Baking& baking) {
  return avatar.share > 0 || avatar.name == baking.settings.guide;
}

bool IsFor(const AvatarSettings& avatar, const Place& place) {
  return std::find(place.avatars.begin(), place.avatars.end(), avatar.name) != place.avatars.end();
}

// Of birds no impostor is ever seen, unless they are people too.
bool IsBirdOnly(const AvatarSettings& avatar, const Baking& baking) {
  const auto works = [&](const Place& place) { return IsFor(avatar, place); };
  if (WalksAbout(avatar, baking) || std::any_of(baking.parts.places.begin(), baking.parts.places.end(), works))
    return false;
  return std::any_of(baking.settings.flocks.begin(), baking.settings.flocks.end(),
                     [&](const Flock& flock) { return flock.avatar == avatar.name; });
}

// Who is nowhere but where they stay, and does nothing there that needs a clip, is never seen to walk.
bool StandsOnly(const AvatarSettings& avatar, const Baking& baking) {
  const auto lets_stand = [&](const Place& place) {
    return !IsFor(avatar, place) || (place.stay_s <= 0 && (place.clip.empty() || place.clip == "idle"));
  };
  return !WalksAbout(avatar, baking) && std::all_of(baking.parts.places.begin(), baking.parts.places.end(), lets_stand);
}

ImpostorOptions OptionsOf(const Baking& baking, size_t i) {
  const AvatarSettings& settings = baking.settings.avatars[i];
  ImpostorOptions options = baking.settings.impostor;
  options.full_height_m = kFullHeight_m;
  for (const ClipSettings& clip : settings.clips)
    options.clips.push_back({clip.name, clip.speed_mps > 0 ? options.clips.front().phases : options.work_phases});
  if (IsBirdOnly(settings, baking)) {
    options.height_px = kUnseen_px;
    options.full_height_m = 0;
    for (ImpostorClipOptions& clip : options.clips) clip.phases = 1;
  } else if (StandsOnly(settings, baking)) {
    for (ImpostorClipOptions& clip : options.clips) clip.phases = clip.name == "idle" ? clip.phases : 1;
  }
  return options;
}

Error MakeImpostor(Baking* baking, size_t i, Step* step, StageReport* report, Warnings* warnings) {
  TourAvatar* avatar = &baking->parts.avatars[i];
  ImpostorOptions options = OptionsOf(*baking, i);
  options.threads = step->cores;
  options.progress = [step](double share) { step->progress = share; };
  ImpostorStatistics statistics;
  if (Error e = BakeImpostor(avatar->levels.avatar, options, &avatar->impostor, &statistics, warnings)) return e;
  report->peak_mb = static_cast<double>(statistics.blender_peak_memory_bytes) / 1e6;
  report->work_s = statistics.blender_cpu_s;
  report->figures = {{"cells", statistics.cells},
                     {"fill_rate", statistics.fill_rate},
                     {"texture_mb", static_cast<double>(statistics.memory_bytes) / 1e6},
                     {"blender_cpu_s", statistics.blender_cpu_s}};
  report->picture_png = ImpostorThumbnail(avatar->impostor);
  return Ok();
}

// What each tint reaches, in figures and as a picture, so that nobody has to guess.
Error CheckTints(const Baking& baking, size_t i, StageReport* report, Warnings* warnings) {
  const TourAvatar& avatar = baking.parts.avatars[i];
  std::vector<float> shares;
  if (Error e = TintReach(avatar.levels.avatar, avatar.tints, &shares)) return e;
  report->picture_png = TintThumbnail(avatar.impostor, avatar.tints);
  for (size_t t = 0; t < shares.size(); ++t) {
    const std::string color = TextFromColor(avatar.tints[t].color);
    report->figures.push_back({color + "_surface_share", std::round(static_cast<double>(shares[t]) * 1e3) / 1e3});
    if (shares[t] >= kMinTintShare) continue;
    warnings->push_back("tint " + color +
                        " reaches almost nothing of the avatar; `flaneur avatar` lists the colours that it has");
  }
  return Ok();
}

void TakeSettings(const AvatarSettings& settings, TourAvatar* avatar) {
  avatar->share = settings.share;
  avatar->height_spread = settings.height_spread;
  avatar->breadth_spread = settings.breadth_spread;
  avatar->tints = settings.tints;
  avatar->props = settings.props;
}

void AddStepsOf(Baking* baking, size_t i) {
  const AvatarSettings& settings = baking->settings.avatars[i];
  TourAvatar* parts = &baking->parts.avatars[i];
  Step* avatar = AddStep(baking, "avatar", settings.name);
  const int source = baking->source_steps[i + 1];
  if (source >= 0) avatar->needs.push_back(static_cast<size_t>(source));
  else avatar->inputs.push_back(settings.source.file);
  for (const fs::path& file : FilesBeside(settings)) avatar->inputs.push_back(file);
  avatar->needs.push_back(static_cast<size_t>(baking->town_step));  // says what people do there
  if (baking->painting_step >= 0) avatar->needs.push_back(static_cast<size_t>(baking->painting_step));
  avatar->key = [baking, i] {
    return AvatarInputs(baking->settings.avatars[i], ContentOf(baking, i + 1), baking->settings.levels);
  };
  avatar->make = [baking, i](StageReport* r, Warnings* w) { return MakeAvatar(baking, i, r, w); };
  Keep(avatar, &parts->levels, &parts->encoded, &parts->reach_m, &parts->prop_triangles);

  Step* impostor = AddStep(baking, "impostor", settings.name);
  impostor->needs = {IndexOf(*baking, avatar)};
  impostor->key = [baking, i] {
    return ImpostorInputs(baking->settings.avatars[i], ContentOf(baking, i + 1), BlenderSha256(baking),
                          baking->settings.levels.max_triangles, OptionsOf(*baking, i));
  };
  impostor->make = [baking, i, impostor](StageReport* r, Warnings* w) {
    return MakeImpostor(baking, i, impostor, r, w);
  };
  Keep(impostor, &parts->impostor);
  if (settings.tints.empty()) return;

  Step* tint = AddStep(baking, "tint", settings.name);
  tint->needs = {IndexOf(*baking, avatar), IndexOf(*baking, impostor)};
  tint->key = [baking, i, avatar, impostor] {
    return TintInputs(baking->settings.avatars[i], avatar->key(), impostor->key());
  };
  tint->make = [baking, i](StageReport* r, Warnings* w) { return CheckTints(*baking, i, r, w); };
  Keep(tint);
}

}  // namespace

void AddPeopleSteps(Baking* baking) {
  baking->parts.avatars.resize(baking->settings.avatars.size());
  for (size_t i = 0; i < baking->parts.avatars.size(); ++i) {
    TakeSettings(baking->settings.avatars[i], &baking->parts.avatars[i]);
    AddStepsOf(baking, i);
  }
}

}  // namespace flaneur
