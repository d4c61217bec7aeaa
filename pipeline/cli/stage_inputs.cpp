#include "pipeline/cli/stage_inputs.h"

#include "pipeline/core/blender.h"
#include "pipeline/core/fingerprint.h"
#include "pipeline/io/motion_reader.h"

namespace flaneur {
namespace fs = std::filesystem;
namespace {

// Of what Blender makes for minutes: changed by hand when it comes out otherwise from the same input.
constexpr const char* kBlenderStagesVersion = "2";

// The same for impostors alone.
constexpr const char* kImpostorVersion = "11";

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

void AddReading(const AvatarSettings& a, const std::string& content, Fingerprint* print) {
  print->Add(content).Add(a.walk).Add(a.idle).Add(a.talk).Add(a.height_m);
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

std::string ScriptInputs(const SourceSettings& source, const std::string& blender) {
  Fingerprint print;
  print.Add("source").Add(kBlenderStagesVersion).Add(blender);
  print.AddFile(source.file.parent_path()).AddFile(BlenderScriptsFolder() / "common");
  return print.Add(source.file.filename().string()).Add(source.seed).Add(source.options_json).Hex();
}

std::string TownShapeInputs(const TourSettings& s, const std::vector<std::string>& contents) {
  Fingerprint print;
  print.Add("shape").Add(ThisProgram()).Add(s.town_scale).Add(s.town_up).Add(s.georeference.crs);
  AddAll(contents, &print);
  for (const TownPart& part : s.parts)
    print.Add(part.position_m.x).Add(part.position_m.y).Add(part.yaw_deg).Add(part.scale).Add(part.up);
  return print.Hex();
}

// The structured bindings below name every option: one that is added has to be added here too.
std::string AvatarInputs(const AvatarSettings& avatar, const std::string& content, const LevelsOptions& levels) {
  Fingerprint print;
  print.Add("avatar").Add(ThisProgram()).Add(avatar.name);
  AddReading(avatar, content, &print);
  for (const Prop& prop : avatar.props) print.Add(prop.clip);
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

std::string ImpostorInputs(const AvatarSettings& avatar, const std::string& content, const std::string& blender,
                           int max_triangles, const ImpostorOptions& impostor) {
  Fingerprint print;
  print.Add("impostor")
      .Add(kImpostorVersion)
      .Add(blender)
      .AddFile(BlenderScriptsFolder() / "bake")
      .AddFile(BlenderScriptsFolder() / "common");
  AddReading(avatar, content, &print);
  const auto& [directions, elevations_deg, clips, work_phases, height_px, full_height_m, border_px, memory_kb, samples,
               seed, threads, log_file, progress] = impostor;
  AddAll(elevations_deg, &print);
  for (const ImpostorClipOptions& clip : clips) print.Add(clip.name).Add(clip.phases);
  return print.Add(max_triangles)
      .Add(directions)
      .Add(height_px)
      .Add(full_height_m)
      .Add(border_px)
      .Add(memory_kb)
      .Add(samples)
      .Add(seed)
      .Hex();
}

std::string TintInputs(const AvatarSettings& avatar, const std::string& avatar_inputs,
                       const std::string& impostor_inputs) {
  Fingerprint print;
  print.Add("tint2").Add(avatar_inputs).Add(impostor_inputs);
  for (const Tint& tint : avatar.tints) {
    print.Add(tint.color.x).Add(tint.color.y).Add(tint.color.z).Add(tint.reach);
    for (const Vec3& color : tint.colors) print.Add(color.x).Add(color.y).Add(color.z);
  }
  return print.Hex();
}

std::string TownInputs(const TourSettings& s, const std::string& shape_inputs) {
  Fingerprint print;
  print.Add("town").Add(shape_inputs).Add(s.language).Add(s.georeference.crs);
  return print.Add(s.georeference.origin_m.x).Add(s.georeference.origin_m.y).Hex();
}

std::string TownMeshesInputs(const std::string& shape_inputs) {
  return Fingerprint().Add("meshes").Add(shape_inputs).Hex();
}

std::string FootprintsInputs(const TourSettings& s, const std::string& shape_inputs) {
  Fingerprint print;
  print.Add("footprints").Add(shape_inputs);
  const auto& [clearance_m, band_m, tolerance_m, bridge_m, open_yard_m2, scale, merge_blocks, threads] = s.footprints;
  AddAll(band_m, &print);
  print.Add(clearance_m).Add(tolerance_m).Add(bridge_m).Add(open_yard_m2).Add(scale).Add(merge_blocks);
  const auto& [cell_m, max_cells, ground_scale, bare_margin_m, with_decks] = s.ground;
  return print.Add(cell_m).Add(max_cells).Add(ground_scale).Add(bare_margin_m).Add(with_decks).Hex();
}

std::string CheckInputs(const TourSettings& s, const std::string& footprints_inputs) {
  Fingerprint print;
  print.Add("check").Add(footprints_inputs).Add(s.name).Add(s.crowd.people).Add(s.painting_file.file.empty());
  for (const Place& place : s.places) {
    print.Add(place.name).Add(place.kind).Add(place.position_m.x).Add(place.position_m.y).Add(place.width_m);
  }
  for (const AcceptedFinding& a : s.accepted)
    print.Add(a.code).Add(a.at_m.x).Add(a.at_m.y).Add(a.within_m).Add(a.reason);
  for (const TourStop& stop : s.path) print.Add(stop.position_m.x).Add(stop.position_m.y);
  return print.Hex();
}

std::string ModelsInputs(const TourSettings& s, const std::vector<std::string>& needs) {
  Fingerprint print;
  print.Add("models").Add(ThisProgram());
  AddAll(needs, &print);
  for (const fs::path& file : FilesOf(s.title_page)) print.AddFile(file);
  return print.Hex();
}

std::string PackInputs(const fs::path& tour, const TourSettings& s, const std::vector<std::string>& needs) {
  Fingerprint print;
  print.Add("pack").Add(ThisProgram()).AddFile(tour).Add(s.name);
  AddAll(needs, &print);
  for (const fs::path& file : MediaFiles(s)) print.AddFile(file);
  return print.Hex();
}

std::vector<fs::path> MediaFiles(const TourSettings& s) {
  std::vector<fs::path> files = FilesOf(s.title_page);
  for (const fs::path& file : FilesOf(s.visitor_files)) files.push_back(file);
  for (const FilesByLanguage& sounds : s.sounds) {
    for (const auto& [language, file] : sounds) files.push_back(file);
  }
  if (!s.painting_file.file.empty()) files.push_back(s.painting_file.file);
  return files;
}

}  // namespace flaneur
