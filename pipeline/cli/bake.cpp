#include "pipeline/cli/bake.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

#include "pipeline/avatar/decimate.h"
#include "pipeline/cli/assemble_town.h"
#include "pipeline/cli/bake_steps.h"
#include "pipeline/cli/check_words.h"
#include "pipeline/cli/stage_inputs.h"
#include "pipeline/cli/thumbnail.h"
#include "pipeline/cli/tint_reach.h"
#include "pipeline/cli/tour_settings.h"
#include "pipeline/cli/visitor_media.h"
#include "pipeline/cli/work_clips.h"
#include "pipeline/core/subprocess.h"
#include "pipeline/core/temporary_folder.h"
#include "pipeline/footprint/check.h"
#include "pipeline/footprint/map.h"
#include "pipeline/footprint/polygon_sets.h"
#include "pipeline/io/geojson.h"
#include "pipeline/io/gltf.h"
#include "pipeline/pack/write_tour_pack.h"
#include "runtime/base/array.h"
#include "runtime/base/color_text.h"
#include "runtime/base/file.h"
#include "runtime/text/system_fonts.h"

namespace flaneur {
namespace fs = std::filesystem;
namespace {

constexpr float kBareGroundMargin_m = 15;
constexpr int kUnseen_px = 16;           // of an impostor that nobody sees
constexpr float kMinTintShare = 0.005f;  // of the surface

struct Baking {
  TourSettings settings;
  fs::path output;
  std::vector<fs::path> sources;  // the town's file (may be empty), then one an avatar
  TourParts parts;
  BakeSteps steps;
  Jobs jobs{ThreadsOfThisMachine() - 1};  // beside the caller's

  fs::path Cache(const std::string& name) const { return steps.cache / name; }
};

Error RequireFile(const fs::path& file) {
  std::error_code ec;
  if (fs::is_regular_file(file, ec)) return Ok();
  return Fail(file.string() + ": no such file");
}

Error RunSourceScript(const SourceSettings& source, const fs::path& output, const fs::path& log, StageReport* report) {
  nlohmann::json settings{{"output", fs::absolute(output).string()}, {"seed", source.seed}};
  settings["options"] = nlohmann::json::parse(source.options_json, nullptr, false);
  BlenderOptions options;
  options.log_file = log;
  ProcessResult result;
  if (Error e = RunBlenderScript(fs::absolute(source.file), settings.dump(), options, &result)) return e;
  report->peak_mb = static_cast<double>(result.peak_memory_bytes) / 1e6;
  return RequireFile(output);
}

// All of them before the first minute of work.
Error RequireFiles(const TourSettings& s) {
  if (!s.town.file.empty()) {
    if (Error e = RequireFile(s.town.file)) return e;
  }
  for (const TownPart& part : s.parts) {
    if (Error e = RequireFile(part.file)) return e;
  }
  for (const AvatarSettings& avatar : s.avatars) {
    if (Error e = RequireFile(avatar.source.file)) return e;
    for (const fs::path& file : FilesBeside(avatar)) {
      if (Error e = RequireFile(file)) return e;
    }
  }
  for (const fs::path& file : FilesOf(s.title_page)) {
    if (Error e = RequireFile(file)) return e;
  }
  for (const fs::path& file : FilesOf(s.visitor_files)) {
    if (Error e = RequireFile(file)) return e;
  }
  return s.painting_file.file.empty() ? Ok() : RequireFile(s.painting_file.file);
}

// Where the source's glTF is: the file itself, or what its script makes.
Error MakeSource(Baking* baking, const SourceSettings& source, const std::string& item, fs::path* file) {
  if (!IsScript(source.file)) {
    *file = source.file;
    return Ok();
  }
  const std::string stem = &source == &baking->settings.town ? "town" : "source_" + item;
  *file = baking->Cache(stem + ".glb");
  const std::string inputs = ScriptInputs(source);
  return RunStep(&baking->steps, "source", item, [&](StageReport* report, std::vector<std::string>*) -> Error {
    std::string known;
    const fs::path key = file->string() + ".fingerprint";
    report->cached = !ReadTextFile(key, &known) && known == inputs && !RequireFile(*file);
    if (report->cached) return Ok();
    TemporaryFolder folder;  // of a script that fails or is interrupted nothing stays
    if (Error e = folder.Create(".flaneur_source_", baking->steps.cache)) return e;
    const fs::path made = folder.path() / file->filename();
    if (Error e = RunSourceScript(source, made, baking->Cache(stem + ".log"), report)) return e;
    std::error_code ec;
    fs::remove(key, ec);
    fs::rename(made, *file, ec);
    if (ec) return Fail(file->string() + ": cannot be written: " + ec.message());
    return WriteTextFile(key, inputs);
  });
}

Error MakeSources(Baking* baking) {
  const TourSettings& s = baking->settings;
  baking->sources.resize(1 + s.avatars.size());
  return RunParallel(&baking->jobs, baking->sources.size(), [&](size_t i) -> Error {
    if (i == 0) return s.town.file.empty() ? Ok() : MakeSource(baking, s.town, "town", &baking->sources[0]);
    const AvatarSettings& avatar = s.avatars[i - 1];
    return MakeSource(baking, avatar.source, avatar.name, &baking->sources[i]);
  });
}

Error ReadTown(Baking* baking, Scene* town, std::vector<std::string>* warnings) {
  const std::string& crs = baking->settings.georeference.crs;
  bool brought = false;  // from degrees into metres, as the reader knew the wish
  const auto append = [&](const fs::path& file, float scale, float yaw_deg, Vec2 position_m) -> Error {
    Scene part;
    SceneSource source;
    if (Error e = ReadScene(file, &part, warnings, {crs == "none" || file != baking->sources[0] ? "" : crs}, &source))
      return e;
    if (file == baking->sources[0]) {
      town->origin_m = {part.origin_m.x * scale, part.origin_m.y * scale};
      town->reference_system = part.reference_system;
      brought = !source.system.empty();
    }
    AppendScene(std::move(part), scale, yaw_deg * kPi / 180, position_m, town);
    return Ok();
  };
  if (!baking->sources[0].empty()) {
    if (Error e = append(baking->sources[0], baking->settings.town_scale, 0, {})) return e;
  }
  for (const TownPart& part : baking->settings.parts) {
    if (Error e = append(part.file, part.scale, part.yaw_deg, part.position_m)) return e;
  }
  Georeference georeference = baking->settings.georeference;
  if (georeference.crs.empty()) town->reference_system.clear();
  if (brought) georeference.crs.clear();
  if (Error e = SetGeoreference(georeference, 1, town, warnings)) return Fail("town.georeference: " + e.message);
  if (AddGroundWhereNone(kBareGroundMargin_m, town)) {
    warnings->push_back("most of the town has no ground under it; a flat square was added");
  }
  return Ok();
}

// Streets of tour.toml stand for those of the same name in the town.
void AddUnlessNamed(Street street, TourData* tour) {
  const std::string name = TextIn(street.names, tour->language, tour->language);
  const auto same = [&](const Street& s) { return TextIn(s.names, tour->language, tour->language) == name; };
  if (std::none_of(tour->streets.begin(), tour->streets.end(), same)) tour->streets.push_back(std::move(street));
}

Error MakeTown(Baking* baking) {
  const std::string& name = baking->settings.name;
  return RunStep(&baking->steps, "town", name, [&](StageReport* report, std::vector<std::string>* warnings) -> Error {
    if (Error e = ReadTown(baking, &baking->parts.town, warnings)) return e;
    baking->parts.places = TaggedPlaces(baking->parts.town);
    baking->parts.places.insert(baking->parts.places.end(), baking->settings.places.begin(),
                                baking->settings.places.end());
    for (Street& street : TaggedStreets(baking->parts.town, baking->settings.language))
      AddUnlessNamed(std::move(street), &baking->parts);
    if (Error e = ChooseWorkClips(baking->parts.places, baking->settings.flocks, &baking->settings.avatars, warnings))
      return e;
    double triangles = 0;
    for (const SceneNode& node : baking->parts.town.nodes) {
      for (int m : node.meshes) triangles += TriangleCount(At(baking->parts.town.meshes, m));
    }
    report->figures = {{"triangles", triangles}, {"places", static_cast<double>(baking->parts.places.size())}};
    return Ok();
  });
}

Error MakeAvatar(Baking* baking, size_t i) {
  const AvatarSettings& settings = baking->settings.avatars[i];
  const fs::path& file = baking->sources[i + 1];
  AvatarLevels* levels = &baking->parts.avatars[i].levels;
  const auto make = [&](StageReport* report, std::vector<std::string>* warnings) -> Error {
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
    if (Error e = ReadAvatar(file, read, &avatar, warnings)) return e;
    if (Error e = BindTints(settings.tint_materials, &avatar)) return e;
    LevelsOptions options = baking->settings.levels;
    options.jobs = &baking->jobs;
    if (Error e = BuildLevels(avatar, options, levels, warnings)) return e;
    for (AvatarLevel level : levels->levels) {
      level.meshes.clear();
      report->levels.push_back(std::move(level));
    }
    report->figures = {{"walk_speed_mps", static_cast<double>(avatar.walk_speed_mps)},
                       {"joints", static_cast<double>(avatar.joints.size())}};
    return Ok();
  };
  return RunKeptStep(&baking->steps, "avatar", settings.name, AvatarInputs(settings, file, baking->settings.levels),
                     make, levels);
}

// Of birds no impostor is ever seen, unless they are people too.
bool IsBirdOnly(const AvatarSettings& avatar, const Baking& baking) {
  if (avatar.share > 0 || avatar.name == baking.settings.guide) return false;
  const auto works = [&](const Place& place) {
    return std::find(place.avatars.begin(), place.avatars.end(), avatar.name) != place.avatars.end();
  };
  if (std::any_of(baking.parts.places.begin(), baking.parts.places.end(), works)) return false;
  return std::any_of(baking.settings.flocks.begin(), baking.settings.flocks.end(),
                     [&](const Flock& flock) { return flock.avatar == avatar.name; });
}

Error MakeImpostor(Baking* baking, size_t i) {
  const AvatarSettings& settings = baking->settings.avatars[i];
  TourAvatar* avatar = &baking->parts.avatars[i];
  ImpostorOptions options = baking->settings.impostor;
  options.threads = 1;  // one avatar a core
  for (const ClipSettings& clip : settings.clips)
    options.clips.push_back({clip.name, clip.speed_mps > 0 ? options.clips.front().phases : options.work_phases});
  if (IsBirdOnly(settings, *baking)) {
    options.height_px = kUnseen_px;
    for (ImpostorClipOptions& clip : options.clips) clip.phases = 1;
  }
  const auto make = [&](StageReport* report, std::vector<std::string>* warnings) -> Error {
    ImpostorStatistics statistics;
    if (Error e = BakeImpostor(avatar->levels.avatar, options, &avatar->impostor, &statistics, warnings)) return e;
    report->peak_mb = static_cast<double>(statistics.blender_peak_memory_bytes) / 1e6;
    report->figures = {{"cells", statistics.cells},
                       {"fill_rate", statistics.fill_rate},
                       {"texture_mb", static_cast<double>(statistics.memory_bytes) / 1e6},
                       {"blender_cpu_s", statistics.blender_cpu_s}};
    report->picture_png = ImpostorThumbnail(avatar->impostor);
    return Ok();
  };
  const std::string inputs =
      ImpostorInputs(settings, baking->sources[i + 1], baking->settings.levels.max_triangles, options);
  return RunKeptStep(&baking->steps, "impostor", settings.name, inputs, make, &avatar->impostor);
}

// What each tint reaches, in figures and as a picture, so that nobody has to guess.
Error CheckTints(Baking* baking, size_t i) {
  const TourAvatar& avatar = baking->parts.avatars[i];
  const std::string& name = baking->settings.avatars[i].name;
  if (avatar.tints.empty()) return Ok();
  return RunStep(&baking->steps, "tint", name, [&](StageReport* report, std::vector<std::string>* warnings) -> Error {
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
  });
}

Error MakePeople(Baking* baking) {
  const size_t count = baking->settings.avatars.size();
  baking->parts.avatars.resize(count);
  for (size_t i = 0; i < count; ++i) {
    baking->parts.avatars[i].share = baking->settings.avatars[i].share;
    baking->parts.avatars[i].height_spread = baking->settings.avatars[i].height_spread;
    baking->parts.avatars[i].tints = baking->settings.avatars[i].tints;
    baking->parts.avatars[i].props = baking->settings.avatars[i].props;
    for (const ClipSettings& clip : baking->settings.avatars[i].clips)
      baking->parts.avatars[i].clips.push_back({clip.name, clip.seat_m, clip.speed_mps});
  }
  if (Error e = RunParallel(&baking->jobs, count, [&](size_t i) { return MakeAvatar(baking, i); })) return e;
  if (Error e = RunParallel(&baking->jobs, count, [&](size_t i) { return MakeImpostor(baking, i); })) return e;
  for (size_t i = 0; i < count; ++i) {
    if (Error e = CheckTints(baking, i)) return e;
  }
  return Ok();
}

bool Covers(const Obstacle& o, Point2 p) {
  if (o.outer.empty()) return std::hypot(p.x - o.center.x, p.y - o.center.y) <= o.radius_m;
  return Contains(o.outer, p) &&
         std::none_of(o.holes.begin(), o.holes.end(), [&](const auto& hole) { return Contains(hole, p); });
}

// Somewhere there must be ground that nothing stands on.
bool AnywhereToWalk(const GroundRaster& ground, const Footprints& footprints) {
  const double cell_m = static_cast<double>(ground.cell_m);
  for (size_t k = 0; k < ground.kind.size(); ++k) {
    if (ground.kind[k] == 0) continue;
    const size_t columns = static_cast<size_t>(ground.columns), row = k / columns;
    const Point2 p{static_cast<double>(ground.min_m.x) + (static_cast<double>(k % columns) + 0.5) * cell_m,
                   static_cast<double>(ground.min_m.y) + (static_cast<double>(row) + 0.5) * cell_m};
    const auto& obstacles = footprints.obstacles;
    if (std::none_of(obstacles.begin(), obstacles.end(), [&](const Obstacle& o) { return Covers(o, p); })) return true;
  }
  return false;
}

Error MakeFootprints(Baking* baking) {
  const TourSettings& s = baking->settings;
  TourParts* parts = &baking->parts;
  const auto make = [&](StageReport* report, std::vector<std::string>* warnings) -> Error {
    if (Error e = RasterizeGround(parts->town, s.ground, &parts->ground)) return e;
    FootprintStats stats;
    if (Error e = ExtractFootprints(parts->town, s.footprints, &parts->footprints, &stats, warnings)) return e;
    if (!AnywhereToWalk(parts->ground, parts->footprints)) {
      return Fail(
          "the town has no walkable ground: obstacles cover all of it; mark the ground's nodes with flaneur_kind "
          "\"ground\"");
    }
    report->figures = {{"obstacles", stats.obstacles}, {"covered_m2", stats.covered_m2}};
    return Ok();
  };
  return RunKeptStep(&baking->steps, "footprints", s.name, FootprintsInputs(s, baking->sources[0]), make,
                     &parts->footprints, &parts->ground);
}

Error MakePainting(Baking* baking) {
  const PaintingSettings& painting = baking->settings.painting_file;
  return painting.file.empty() ? Ok() : ReadPainting(painting, baking->parts.ground, &baking->parts.painting);
}

// The doors and exits of tour.toml; the check finds the town's own by itself.
std::vector<Gate> GatesOfSettings(const TourSettings& settings) {
  std::vector<Gate> gates;
  for (const Place& place : settings.places) {
    if (place.kind != "door" && place.kind != "exit") continue;
    const Point2 at{static_cast<double>(place.position_m.x), static_cast<double>(place.position_m.y)};
    gates.push_back({place.name, at, {}, place.kind == "exit"});
  }
  return gates;
}

// One line for each kind of error: how often, and the first place.
void SummarizeErrors(const std::vector<Finding>& findings, std::vector<std::string>* warnings) {
  std::map<int, std::pair<int, const Finding*>> by_code;
  for (const Finding& f : findings) {
    if (f.severity != Severity::kError) continue;
    auto& [count, first] = by_code[f.code];
    if (count++ == 0) first = &f;
  }
  for (const auto& [code, entry] : by_code) {
    char place[64];
    std::snprintf(place, sizeof place, " at (%.1f, %.1f): ", entry.second->at_m.x, entry.second->at_m.y);
    warnings->push_back(std::to_string(code) + " " + KindOf(code).title + ", " + std::to_string(entry.first) +
                        (entry.first == 1 ? " time: " : " times, first: ") + entry.second->feature + place +
                        entry.second->message);
  }
}

void ReportFindings(const std::vector<Finding>& findings, StageReport* stage, BakeReport* report) {
  double errors = 0, warnings = 0;
  for (const Finding& f : findings) {
    const FindingKind& kind = KindOf(f.code);
    errors += f.severity == Severity::kError ? 1 : 0;
    warnings += f.severity == Severity::kWarning ? 1 : 0;
    report->findings.push_back({f.code,
                                SeverityName(f.severity),
                                kind.title,
                                f.feature,
                                f.reason.empty() ? f.message : f.message + " (accepted: " + f.reason + ")",
                                kind.advice,
                                {static_cast<float>(f.at_m.x), static_cast<float>(f.at_m.y)}});
  }
  stage->figures = {{"errors", errors}, {"warnings", warnings}};
}

// Findings do not stop a bake: the designer reads them in the report and decides.
Error CheckTown(Baking* baking) {
  const TourSettings& s = baking->settings;
  BakeReport* whole = &baking->steps.report;
  const auto make = [&](StageReport* report, std::vector<std::string>* warnings) -> Error {
    CheckOptions options;
    options.gates = GatesOfSettings(s);
    MapOptions map;
    map.title = s.name;
    map.ground = &baking->parts.ground;
    if (Error e = Check(baking->parts.footprints, &baking->parts.town, options, &map.findings)) return e;
    for (const size_t idle : AcceptFindings(s.accepted, &map.findings))
      warnings->push_back("footprints.accept " + std::to_string(s.accepted[idle].code) + " (" +
                          s.accepted[idle].reason + ") meets no finding any more; remove it, or correct its at_m");
    SummarizeErrors(map.findings, warnings);
    ReportFindings(map.findings, report, whole);
    if (Error e = WriteTextFile(baking->Cache("findings.json"), FindingsJson(map.findings))) return e;
    const fs::path svg = baking->Cache("map.svg");
    if (Error e = WriteMap(svg, baking->parts.footprints, map)) return e;
    return ReadTextFile(svg, &whole->map_svg);
  };
  return RunKeptStep(&baking->steps, "check", s.name, CheckInputs(s, FootprintsInputs(s, baking->sources[0])), make,
                     &whole->findings, &whole->map_svg);
}

// Into the folder `staging`.
Error WritePack(Baking* baking, const fs::path& staging) {
  const std::string& name = baking->settings.name;
  return RunStep(&baking->steps, "pack", name, [&](StageReport* report, std::vector<std::string>* warnings) -> Error {
    Fonts fonts(SystemFonts());
    *warnings = WarningsOfWords(baking->parts, &fonts);
    TourParts& parts = baking->parts;
    parts.footprints.origin_m = parts.town.origin_m;  // kept ones may have another
    parts.footprints.reference_system = parts.town.reference_system;
    BakeReport& whole = baking->steps.report;
    const fs::path footprints = staging / "footprints.geojson";
    if (Error e = WriteGeoJson(footprints, parts.footprints)) return e;
    if (!parts.footprints.reference_system.empty()) {
      if (Error e = WriteLongitudeLatitude(LongitudeLatitudePath(footprints), parts.footprints)) return e;
    }
    if (Error e = WritePlan(staging / "plan.png", parts.ground, parts.footprints)) return e;
    if (Error e = WriteTourPack(staging / (name + ".glb"), parts, &baking->jobs, &whole.pack_bytes)) return e;
    whole.pack_path = (baking->output / (name + ".glb")).string();
    report->figures = {{"bytes", static_cast<double>(whole.pack_bytes)}};
    return Ok();
  });
}

// All results appear together, once all are there.
Error WriteResults(Baking* baking) {
  std::error_code ec;
  TemporaryFolder staging;
  if (Error e = staging.Create(".flaneur_results_", baking->output)) return e;
  if (Error e = WritePack(baking, staging.path())) return e;
  if (Error e = WriteReport(staging.path(), baking->steps.report)) return e;
  fs::remove(baking->Cache("fingerprint"), ec);
  const std::string on_earth = LongitudeLatitudePath("footprints.geojson");
  std::vector<std::string> names{baking->settings.name + ".glb", "footprints.geojson", "plan.png", "report.html",
                                 "report.json"};
  if (fs::exists(staging.path() / on_earth, ec)) names.push_back(on_earth);
  else fs::remove(baking->output / on_earth, ec);  // of a georeference that is gone
  for (const std::string& name : names) {
    fs::rename(staging.path() / name, baking->output / name, ec);
    if (ec) return Fail((baking->output / name).string() + ": cannot be written: " + ec.message());
  }
  return Ok();
}

int CountSteps(const TourSettings& s) {
  int more = IsScript(s.town.file) ? 1 : 0;  // scripts and tints
  for (const AvatarSettings& avatar : s.avatars)
    more += (IsScript(avatar.source.file) ? 1 : 0) + (avatar.tints.empty() ? 0 : 1);
  return more + 2 * Count(s.avatars) + 4;  // town, footprints, check, pack
}

// Nothing changed since the last bake: the report says so, nothing else is touched.
bool ReportUnchanged(const Baking& baking, const std::string& inputs) {
  const fs::path &output = baking.output, pack = output / (baking.settings.name + ".glb");
  std::string known, text;
  std::error_code ec;
  if (ReadTextFile(baking.Cache("fingerprint"), &known) || known != inputs || !fs::exists(pack, ec) ||
      !fs::exists(output / "report.html", ec) || !fs::exists(output / "footprints.geojson", ec) ||
      !fs::exists(output / "plan.png", ec) ||
      (!baking.settings.georeference.crs.empty() && baking.settings.georeference.crs != "none" &&
       !fs::exists(LongitudeLatitudePath(output / "footprints.geojson"), ec)) ||
      ReadTextFile(output / "report.json", &text)) {
    return false;
  }
  auto report = nlohmann::ordered_json::parse(text, nullptr, false);
  if (!report.is_object() || !report.contains("stages") || !report.contains("pack")) return false;
  if (report["pack"].value("bytes", uintmax_t{0}) != fs::file_size(pack, ec)) return false;
  for (auto& stage : report["stages"]) {
    stage["cached"] = true;
    stage["seconds"] = 0;
  }
  return !WriteTextFile(output / "report.json", report.dump(1) + "\n");
}

}  // namespace

Error Bake(const fs::path& tour, const fs::path& output) {
  Baking baking;
  if (Error e = ReadTourSettings(tour, &baking.settings)) return e;
  const std::string& name = baking.settings.name;
  baking.output = output.empty() ? fs::path("build_assets") / name : output;
  baking.steps.cache = baking.output / "cache";
  baking.steps.report.tour = name;
  baking.steps.count = CountSteps(baking.settings);
  const std::string inputs = TourInputs(tour, baking.settings);
  if (ReportUnchanged(baking, inputs)) {
    std::fprintf(stderr, "nothing changed since the last bake\n");
    return Ok();
  }
  if (Error e = RequireFiles(baking.settings)) return e;
  std::error_code ec;
  fs::create_directories(baking.steps.cache, ec);
  if (ec) return Fail(baking.steps.cache.string() + ": cannot make this folder: " + ec.message());
  static_cast<TourData&>(baking.parts) = baking.settings;
  if (Error e = MakeVisitorMedia(baking.settings, baking.steps.cache, &baking.parts)) return e;
  if (Error e = MakeTitlePage(baking.settings.title_page, &baking.parts.title_page)) return e;
  if (Error e = MakeSources(&baking)) return e;
  if (Error e = MakeTown(&baking)) return e;
  if (Error e = MakeFootprints(&baking)) return e;
  if (Error e = MakePainting(&baking)) return e;
  if (Error e = MakePeople(&baking)) return e;
  if (Error e = CheckTown(&baking)) return e;
  if (Error e = WriteResults(&baking)) return e;
  return WriteTextFile(baking.Cache("fingerprint"), inputs);
}

}  // namespace flaneur
