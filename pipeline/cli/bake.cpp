#include "pipeline/cli/bake.h"

#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <functional>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "pipeline/avatar/decimate.h"
#include "pipeline/cli/assemble_town.h"
#include "pipeline/cli/bake_impostor.h"
#include "pipeline/cli/thumbnail.h"
#include "pipeline/cli/tour_settings.h"
#include "pipeline/core/fingerprint.h"
#include "pipeline/core/report.h"
#include "pipeline/core/subprocess.h"
#include "pipeline/footprint/check.h"
#include "pipeline/footprint/map.h"
#include "pipeline/io/geojson.h"
#include "pipeline/io/gltf.h"
#include "pipeline/pack/write_tour_pack.h"
#include "runtime/base/file.h"

namespace flaneur {
namespace fs = std::filesystem;
namespace {

constexpr float kBareGroundMargin_m = 15;
constexpr size_t kMostWarningsShown = 8;  // of a step on the terminal; the report has all
// Part of every fingerprint: changed when a stage makes something else of the same input.
constexpr const char* kStagesVersion = "1";

struct Baking {
  TourSettings settings;
  fs::path tour_file, output;
  std::vector<fs::path> sources;  // the town's file (may be empty), then one an avatar
  TourParts parts;
  BakeReport report;
  std::mutex mutex;               // guards report and the progress line
  std::atomic<int> done{0};
  int steps = 0;

  fs::path Cache(const std::string& name) const { return output / "cache" / name; }
};

double Now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double PeakMemory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

void ShowProgress(int done, int steps, const StageReport& report, const std::vector<std::string>& warnings) {
  std::fprintf(stderr, "[%*d/%d] %-10s %s ... ", steps > 9 ? 2 : 1, done, steps, report.stage.c_str(), report.item.c_str());
  if (report.cached) std::fprintf(stderr, "cached\n");
  else std::fprintf(stderr, "%.1f s\n", report.seconds);
  for (size_t i = 0; i < std::min(warnings.size(), kMostWarningsShown); ++i) {
    std::fprintf(stderr, "        warning: %s\n", warnings[i].c_str());
  }
  if (warnings.size() > kMostWarningsShown) {
    std::fprintf(stderr, "        and %zu more warnings, see report.html\n", warnings.size() - kMostWarningsShown);
  }
}

// Runs one item of a stage, reports it and shows progress.
Error RunStep(Baking* baking, const std::string& stage, const std::string& item,
              const std::function<Error(StageReport*, std::vector<std::string>*)>& work) {
  StageReport report;
  report.stage = stage;
  report.item = item;
  std::vector<std::string> warnings;
  const double start_s = Now_s();
  const Error error = work(&report, &warnings);
  report.seconds = Now_s() - start_s;
  if (report.peak_mb == 0) report.peak_mb = PeakMemory_mb();
  const std::lock_guard lock(baking->mutex);
  if (error) return error;
  ShowProgress(++baking->done, baking->steps, report, warnings);
  for (const std::string& warning : warnings) baking->report.warnings.push_back(stage + " " + item + ": " + warning);
  baking->report.stages.push_back(std::move(report));
  return Ok();
}

// Runs work(0) ... work(count - 1) on up to one thread a core; the error of the lowest index counts.
Error RunParallel(size_t count, const std::function<Error(size_t)>& work) {
  std::vector<Error> errors(count);
  std::atomic<size_t> next{0};
  std::atomic<bool> failed{false};
  const auto worker = [&] {
    for (size_t i = next++; i < count && !failed; i = next++) {
      errors[i] = work(i);
      if (errors[i]) failed = true;
    }
  };
  {
    std::vector<std::jthread> threads;
    const size_t cores = std::max(1u, std::thread::hardware_concurrency());
    for (size_t t = 0; t < std::min(count, cores); ++t) threads.emplace_back(worker);
  }
  for (Error& error : errors) {
    if (error) return std::move(error);
  }
  return Ok();
}

bool IsScript(const fs::path& file) { return file.extension() == ".py"; }

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

// Where the source's glTF is: the file itself, or what its script makes.
Error MakeSource(Baking* baking, const SourceSettings& source, const std::string& item, fs::path* file) {
  if (Error e = RequireFile(source.file)) return e;
  if (!IsScript(source.file)) {
    *file = source.file;
    return Ok();
  }
  *file = baking->Cache("source_" + item + ".glb");
  const std::string fingerprint = Fingerprint()
                                      .Add(kStagesVersion)
                                      .AddFile(source.file.parent_path())
                                      .AddFile(BlenderScriptsFolder() / "common")
                                      .Add(source.seed)
                                      .Add(source.options_json)
                                      .Hex();
  return RunStep(baking, "source", item, [&](StageReport* report, std::vector<std::string>*) -> Error {
    std::string known;
    const fs::path key = file->string() + ".fingerprint";
    if (!ReadTextFile(key, &known) && known == fingerprint && !RequireFile(*file)) {
      report->cached = true;
      return Ok();
    }
    std::error_code ec;
    fs::create_directories(file->parent_path(), ec);
    fs::remove(key, ec);
    if (Error e = RunSourceScript(source, *file, baking->Cache("source_" + item + ".log"), report)) return e;
    return WriteTextFile(key, fingerprint);
  });
}

Error MakeSources(Baking* baking) {
  const TourSettings& s = baking->settings;
  baking->sources.resize(1 + s.avatars.size());
  return RunParallel(baking->sources.size(), [&](size_t i) -> Error {
    if (i == 0) return s.town.file.empty() ? Ok() : MakeSource(baking, s.town, "town", &baking->sources[0]);
    const AvatarSettings& avatar = s.avatars[i - 1];
    return MakeSource(baking, avatar.source, avatar.name, &baking->sources[i]);
  });
}

Error ReadTown(Baking* baking, Scene* town, std::vector<std::string>* warnings) {
  const auto append = [&](const fs::path& file, float scale, float yaw_deg, Vec2 position_m) -> Error {
    Scene part;
    if (Error e = ReadScene(file, &part, warnings)) return e;
    AppendScene(std::move(part), scale, yaw_deg * kPi / 180, position_m, town);
    return Ok();
  };
  if (!baking->sources[0].empty()) {
    if (Error e = append(baking->sources[0], baking->settings.town_scale, 0, {})) return e;
  }
  for (const TownPart& part : baking->settings.parts) {
    if (Error e = append(part.file, part.scale, part.yaw_deg, part.position_m)) return e;
  }
  if (AddGroundWhereNone(kBareGroundMargin_m, town)) {
    warnings->push_back("the town has no ground; it stands on a flat square");
  }
  return Ok();
}

Error MakeTown(Baking* baking) {
  return RunStep(baking, "town", baking->settings.name, [&](StageReport* report, std::vector<std::string>* warnings) -> Error {
    if (Error e = ReadTown(baking, &baking->parts.town, warnings)) return e;
    baking->parts.places = TaggedPlaces(baking->parts.town);
    baking->parts.places.insert(baking->parts.places.end(), baking->settings.places.begin(),
                                baking->settings.places.end());
    double triangles = 0;
    for (const SceneNode& node : baking->parts.town.nodes) {
      for (int m : node.meshes) triangles += TriangleCount(baking->parts.town.meshes[static_cast<size_t>(m)]);
    }
    report->figures = {{"triangles", triangles}, {"places", static_cast<double>(baking->parts.places.size())}};
    return Ok();
  });
}

Error MakeAvatar(Baking* baking, size_t i) {
  const AvatarSettings& settings = baking->settings.avatars[i];
  return RunStep(baking, "avatar", settings.name, [&](StageReport* report, std::vector<std::string>* warnings) -> Error {
    ReadAvatarOptions read;
    read.name = settings.name;
    read.walk = settings.walk;
    read.idle = settings.idle;
    read.talk = settings.talk;
    read.height_m = settings.height_m;
    read.hide = settings.hide;
    Avatar avatar;
    if (Error e = ReadAvatar(baking->sources[i + 1], read, &avatar, warnings)) return e;
    AvatarLevels& levels = baking->parts.avatars[i].levels;
    if (Error e = BuildLevels(avatar, baking->settings.levels, &levels, warnings)) return e;
    baking->parts.avatars[i].share = settings.share;
    for (AvatarLevel level : levels.levels) {
      level.meshes.clear();
      report->levels.push_back(std::move(level));
    }
    report->figures = {{"walk_speed_mps", static_cast<double>(avatar.walk_speed_mps)},
                       {"joints", static_cast<double>(avatar.joints.size())}};
    return Ok();
  });
}

std::string ImpostorFingerprint(const Baking& baking, size_t i) {
  const AvatarSettings& a = baking.settings.avatars[i];
  const ImpostorOptions& o = baking.settings.impostor;
  Fingerprint print;
  print.Add(kStagesVersion).AddFile(baking.sources[i + 1]).AddFile(BlenderScriptsFolder() / "bake");
  print.AddFile(BlenderScriptsFolder() / "common").Add(a.walk).Add(a.idle).Add(a.talk).Add(a.height_m);
  print.Add(baking.settings.levels.max_triangles);
  for (const std::string& hidden : a.hide) print.Add(hidden);
  for (float e : o.elevations_deg) print.Add(e);
  for (const ImpostorClipOptions& clip : o.clips) print.Add(clip.name).Add(clip.phases);
  return print.Add(o.directions).Add(o.height_px).Add(o.border_px).Add(o.samples).Add(o.seed).Hex();
}

Error MakeImpostor(Baking* baking, size_t i) {
  const std::string& name = baking->settings.avatars[i].name;
  return RunStep(baking, "impostor", name, [&](StageReport* report, std::vector<std::string>* warnings) -> Error {
    TourAvatar& avatar = baking->parts.avatars[i];
    const fs::path folder = baking->Cache("impostor_" + name);
    const std::string fingerprint = ImpostorFingerprint(*baking, i);
    if (ReadCachedImpostor(folder, fingerprint, &avatar.impostor)) {
      report->cached = true;
      report->picture_png = ImpostorThumbnail(avatar.impostor);
      return Ok();
    }
    ImpostorOptions options = baking->settings.impostor;
    options.threads = 1;  // one avatar a core
    ImpostorStatistics statistics;
    if (Error e = BakeImpostor(avatar.levels.avatar, options, &avatar.impostor, &statistics, warnings)) return e;
    report->peak_mb = static_cast<double>(statistics.blender_peak_memory_bytes) / 1e6;
    report->figures = {{"cells", statistics.cells},
                       {"fill_rate", statistics.fill_rate},
                       {"blender_cpu_s", statistics.blender_cpu_s}};
    report->picture_png = ImpostorThumbnail(avatar.impostor);
    return WriteCachedImpostor(folder, fingerprint, avatar.impostor);
  });
}

Error MakePeople(Baking* baking) {
  const size_t count = baking->settings.avatars.size();
  baking->parts.avatars.resize(count);
  if (Error e = RunParallel(count, [&](size_t i) { return MakeAvatar(baking, i); })) return e;
  return RunParallel(count, [&](size_t i) { return MakeImpostor(baking, i); });
}

Error MakeFootprints(Baking* baking) {
  const std::string& name = baking->settings.name;
  return RunStep(baking, "footprints", name, [&](StageReport* report, std::vector<std::string>* warnings) -> Error {
    if (Error e = RasterizeGround(baking->parts.town, baking->settings.ground, &baking->parts.ground)) return e;
    FootprintStats stats;
    if (Error e = ExtractFootprints(baking->parts.town, baking->settings.footprints, &baking->parts.footprints, &stats,
                                    warnings)) {
      return e;
    }
    report->figures = {{"obstacles", stats.obstacles}, {"covered_m2", stats.covered_m2}};
    return Ok();
  });
}

// The doors and exits of tour.toml; the check finds the town's own by itself.
std::vector<Gate> GatesOfSettings(const TourSettings& settings) {
  std::vector<Gate> gates;
  for (const PackPlace& place : settings.places) {
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
    if (KindOf(f.code).severity != Severity::kError) continue;
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
  double errors = 0;
  for (const Finding& f : findings) {
    const FindingKind& kind = KindOf(f.code);
    errors += kind.severity == Severity::kError ? 1 : 0;
    report->findings.push_back({f.code, SeverityName(kind.severity), kind.title, f.feature, f.message, kind.advice,
                                {static_cast<float>(f.at_m.x), static_cast<float>(f.at_m.y)}});
  }
  stage->figures = {{"errors", errors}, {"warnings", static_cast<double>(findings.size()) - errors}};
}

// Findings do not stop a bake: the designer reads them in the report and decides.
Error CheckTown(Baking* baking) {
  const std::string& name = baking->settings.name;
  return RunStep(baking, "check", name, [&](StageReport* report, std::vector<std::string>* warnings) -> Error {
    CheckOptions options;
    options.gates = GatesOfSettings(baking->settings);
    MapOptions map;
    map.title = name;
    map.ground = &baking->parts.ground;
    if (Error e = Check(baking->parts.footprints, &baking->parts.town, options, &map.findings)) return e;
    SummarizeErrors(map.findings, warnings);
    ReportFindings(map.findings, report, &baking->report);
    if (Error e = WriteTextFile(baking->Cache("findings.json"), FindingsJson(map.findings))) return e;
    const fs::path svg = baking->Cache("map.svg");
    if (Error e = WriteMap(svg, baking->parts.footprints, map)) return e;
    return ReadTextFile(svg, &baking->report.map_svg);
  });
}

Error WritePack(Baking* baking) {
  return RunStep(baking, "pack", baking->settings.name, [&](StageReport* report, std::vector<std::string>*) -> Error {
    TourParts& parts = baking->parts;
    parts.name = baking->settings.name;
    parts.path = baking->settings.path;
    parts.crowd = baking->settings.crowd;
    parts.control = baking->settings.control;
    parts.light = baking->settings.light;
    const fs::path pack = baking->output / (parts.name + ".glb");
    if (Error e = WriteGeoJson(baking->output / "footprints.geojson", parts.footprints)) return e;
    if (Error e = WriteTourPack(pack, parts, &baking->report.pack_bytes)) return e;
    baking->report.pack_path = pack.string();
    report->figures = {{"bytes", static_cast<double>(baking->report.pack_bytes)}};
    return Ok();
  });
}

int CountSteps(const TourSettings& s) {
  int scripts = IsScript(s.town.file) ? 1 : 0;
  for (const AvatarSettings& avatar : s.avatars) scripts += IsScript(avatar.source.file) ? 1 : 0;
  return scripts + 2 * static_cast<int>(s.avatars.size()) + 4;  // town, footprints, check, pack
}

// Of all that the result depends on: settings, sources, scripts and this program itself.
std::string TourFingerprint(const fs::path& tour, const TourSettings& s) {
  Fingerprint print;
  print.AddFile(tour).AddFile("/proc/self/exe").AddFile(BlenderScriptsFolder());
  const auto add = [&](const fs::path& file) { print.AddFile(IsScript(file) ? file.parent_path() : file); };
  add(s.town.file);
  for (const TownPart& part : s.parts) add(part.file);
  for (const AvatarSettings& avatar : s.avatars) add(avatar.source.file);
  return print.Hex();
}

// Nothing changed since the last bake: the report says so, nothing else is touched.
bool ReportUnchanged(const fs::path& output, const std::string& name, const std::string& fingerprint) {
  std::string known, text;
  std::error_code ec;
  if (ReadTextFile(output / "cache" / "fingerprint", &known) || known != fingerprint ||
      !fs::exists(output / (name + ".glb"), ec) || !fs::exists(output / "report.html", ec) ||
      ReadTextFile(output / "report.json", &text)) {
    return false;
  }
  auto report = nlohmann::ordered_json::parse(text, nullptr, false);
  if (!report.is_object() || !report.contains("stages") || !report.contains("pack")) return false;
  if (report["pack"].value("bytes", uintmax_t{0}) != fs::file_size(output / (name + ".glb"), ec)) return false;
  for (auto& stage : report["stages"]) {
    stage["cached"] = true;
    stage["seconds"] = 0;
  }
  return !WriteTextFile(output / "report.json", report.dump(1) + "\n");
}

}  // namespace

Error Bake(const fs::path& tour, const fs::path& output) {
  Baking baking;
  baking.tour_file = tour;
  if (Error e = ReadTourSettings(tour, &baking.settings)) return e;
  const std::string& name = baking.settings.name;
  baking.output = output.empty() ? fs::path("build_assets") / name : output;
  baking.report.tour = name;
  baking.steps = CountSteps(baking.settings);
  const std::string fingerprint = TourFingerprint(tour, baking.settings);
  if (ReportUnchanged(baking.output, name, fingerprint)) {
    std::fprintf(stderr, "nothing changed since the last bake\n");
    return Ok();
  }
  if (Error e = MakeSources(&baking)) return e;
  if (Error e = MakeTown(&baking)) return e;
  if (Error e = MakePeople(&baking)) return e;
  if (Error e = MakeFootprints(&baking)) return e;
  if (Error e = CheckTown(&baking)) return e;
  if (Error e = WritePack(&baking)) return e;
  if (Error e = WriteReport(baking.output, baking.report)) return e;
  return WriteTextFile(baking.Cache("fingerprint"), fingerprint);
}

}  // namespace flaneur
