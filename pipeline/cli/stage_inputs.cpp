#include "pipeline/cli/stage_inputs.h"

#include "pipeline/core/fingerprint.h"
#include "pipeline/core/subprocess.h"
#include "pipeline/io/motion_reader.h"

namespace flaneur {
namespace fs = std::filesystem;
namespace {

// Of what Blender makes for minutes: changed by hand when it comes out otherwise from the same input.
constexpr const char* kBlenderStagesVersion = "2";

// The same for impostors alone.
constexpr const char* kImpostorVersion = "6";

// Of what this program computes in seconds: any other build of it may compute something else.
const std::string& ThisProgram() {
  static const std::string hex = Fingerprint().AddFile("/proc/self/exe").Hex();
  return hex;
}

template <typename Values>
void AddAll(const Values& values, Fingerprint* print) {
  print->Add(static_cast<double>(values.size()));
  for (const auto& value : values) print->Add(value);
}

// Of its own settings; the program's own clips stand beside them.
std::vector<fs::path> ClipFiles(const AvatarSettings& a) {
  std::vector<fs::path> files;
  for (const auto* clips : {&a.clips, &a.usual_clips}) {
    for (const ClipSettings& clip : *clips) {
      if (!clip.file.empty() && clip.file != "flaneur") files.push_back(clip.file);
    }
  }
  return files;
}

void AddReading(const AvatarSettings& a, const fs::path& file, Fingerprint* print) {
  print->AddFile(file).Add(a.walk).Add(a.idle).Add(a.talk).Add(a.height_m);
  AddAll(a.hide, print);
  for (const Prop& prop : a.props) print->Add(prop.name);
  for (const auto& materials : a.tint_materials) AddAll(materials, print);
  for (const ClipSettings& clip : a.clips) print->Add(clip.name).Add(clip.clip);
  if (!a.up.empty() || !a.forward.empty() || a.scale > 0) print->Add(a.up).Add(a.forward).Add(a.scale);
  for (const fs::path& part : a.parts) print->AddFile(part);
  for (const ClipSettings& clip : a.usual_clips) print->Add(clip.name).Add(clip.clip);
  for (const fs::path& clips : ClipFiles(a)) print->AddFile(clips);
  if (!IsScript(a.source.file)) print->AddFile(ShippedClips());  // our own scripts bring all clips
}

}  // namespace

std::vector<fs::path> FilesBeside(const AvatarSettings& avatar) {
  std::vector<fs::path> files = ClipFiles(avatar);
  files.insert(files.end(), avatar.parts.begin(), avatar.parts.end());
  return files;
}

bool IsScript(const fs::path& file) { return file.extension() == ".py"; }

std::string ScriptInputs(const SourceSettings& source) {
  Fingerprint print;
  print.Add(kBlenderStagesVersion).AddFile(source.file.parent_path()).AddFile(BlenderScriptsFolder() / "common");
  return print.Add(source.file.filename().string()).Add(source.seed).Add(source.options_json).Hex();
}

// The structured bindings below name every option: one that is added has to be added here too.
std::string AvatarInputs(const AvatarSettings& avatar, const fs::path& file, const LevelsOptions& levels) {
  Fingerprint print;
  print.Add(ThisProgram()).Add(avatar.name);
  AddReading(avatar, file, &print);
  const auto& [ratios, error_px, max_triangles, min_triangles, error_samples, walk_poses, max_joints, jobs] = levels;
  AddAll(ratios, &print);
  return print.Add(error_px)
      .Add(max_triangles)
      .Add(min_triangles)
      .Add(error_samples)
      .Add(walk_poses)
      .Add(max_joints)
      .Hex();
}

std::string ImpostorInputs(const AvatarSettings& avatar, const fs::path& file, int max_triangles,
                           const ImpostorOptions& impostor) {
  Fingerprint print;
  print.Add(kImpostorVersion).AddFile(BlenderScriptsFolder() / "bake").AddFile(BlenderScriptsFolder() / "common");
  AddReading(avatar, file, &print);
  const auto& [directions, elevations_deg, clips, work_phases, height_px, border_px, memory_kb, samples, seed, threads,
               log_file] = impostor;
  AddAll(elevations_deg, &print);
  for (const ImpostorClipOptions& clip : clips) print.Add(clip.name).Add(clip.phases);
  return print.Add(max_triangles)
      .Add(directions)
      .Add(height_px)
      .Add(border_px)
      .Add(memory_kb)
      .Add(samples)
      .Add(seed)
      .Hex();
}

std::string FootprintsInputs(const TourSettings& s, const fs::path& town) {
  Fingerprint print;
  print.Add(ThisProgram()).Add(s.town_scale);
  if (!town.empty()) print.AddFile(town);
  for (const TownPart& part : s.parts) {
    print.AddFile(part.file).Add(part.position_m.x).Add(part.position_m.y).Add(part.yaw_deg).Add(part.scale);
  }
  const auto& [clearance_m, band_m, tolerance_m, bridge_m, open_yard_m2, scale, merge_blocks, threads] = s.footprints;
  AddAll(band_m, &print);
  print.Add(clearance_m).Add(tolerance_m).Add(bridge_m).Add(open_yard_m2).Add(scale).Add(merge_blocks);
  const auto& [cell_m, max_cells, ground_scale, bare_margin_m] = s.ground;
  return print.Add(cell_m).Add(max_cells).Add(ground_scale).Add(bare_margin_m).Hex();
}

std::string CheckInputs(const TourSettings& s, const std::string& footprints_inputs) {
  Fingerprint print;
  print.Add(footprints_inputs).Add(s.name);
  for (const Place& place : s.places) {
    print.Add(place.name).Add(place.kind).Add(place.position_m.x).Add(place.position_m.y).Add(place.width_m);
  }
  for (const AcceptedFinding& a : s.accepted)
    print.Add(a.code).Add(a.at_m.x).Add(a.at_m.y).Add(a.within_m).Add(a.reason);
  return print.Hex();
}

std::string TourInputs(const fs::path& tour, const TourSettings& s) {
  Fingerprint print;
  print.AddFile(tour).Add(ThisProgram()).AddFile(BlenderScriptsFolder());
  const auto add = [&](const fs::path& file) { print.AddFile(IsScript(file) ? file.parent_path() : file); };
  add(s.town.file);
  if (!s.painting_file.file.empty()) print.AddFile(s.painting_file.file);
  for (const fs::path& file : FilesOf(s.title_page)) print.AddFile(file);
  for (const fs::path& file : FilesOf(s.visitor_files)) print.AddFile(file);
  for (const FilesByLanguage& sounds : s.sounds) {
    for (const auto& [language, file] : sounds) print.AddFile(file);
  }
  for (const TownPart& part : s.parts) add(part.file);
  for (const AvatarSettings& avatar : s.avatars) {
    add(avatar.source.file);
    for (const fs::path& file : FilesBeside(avatar)) add(file);
  }
  return print.Hex();
}

}  // namespace flaneur
