#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "pipeline/avatar/decimate.h"
#include "pipeline/cli/arguments.h"
#include "pipeline/cli/avatar_sheet.h"
#include "pipeline/cli/tint_reach.h"
#include "pipeline/cli/verbs.h"
#include "pipeline/io/describe_file.h"
#include "pipeline/io/gltf.h"
#include "runtime/base/color_text.h"
#include "runtime/base/file.h"
#include "runtime/base/option_range.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;

struct AvatarArguments {
  std::vector<fs::path> inputs;
  fs::path output, json, sheet;
  bool list = false;
  ReadAvatarOptions read;
  LevelsOptions levels;
  DracoOptions draco;
  bool plain = false;
};

void AddFiles(CLI::App* app, AvatarArguments* a) {
  app->add_option("IN", a->inputs, "The people: files with a skin, of any format that docs/avatars.md names")
      ->required();
  app->add_option(
      "-o,--output", a->output,
      "The glTF binary to write; of several people, or without an ending, a folder for one each, with a contact "
      "sheet index.html");
  app->add_option("--json", a->json, "Also write the levels' numbers of one person to this JSON file");
  app->add_option("--sheet", a->sheet, "Also draw one person's levels and clips into this PNG");
  app->add_flag("--list", a->list, "Say what the files hold: nodes, bones, clips, up and facing; write nothing");
  app->option_defaults()->always_capture_default();
}

void AddPerson(CLI::App* app, AvatarArguments* a) {
  const std::string person = "Person";
  app->add_option("--name", a->read.name, "Name of the person; empty: the file's")->group(person);
  app->add_option("--walk", a->read.walk, "Name of the walk clip in the file; empty: found by itself")->group(person);
  app->add_option("--idle", a->read.idle, "Name of the idle clip")->group(person);
  app->add_option("--talk", a->read.talk, "Name of the talk clip")->group(person);
  app->add_option("--clips", a->read.clip_files,
                  "A file whose clips the person moves by, also of another skeleton: glTF, FBX, BVH, VRMA, .blend, "
                  ".dae; more than once")
      ->allow_extra_args(false)
      ->group(person);
  app->add_option("--height", a->read.height_m,
                  "Metres to scale the person to; 0: as it is, or 1.75 where that is no person's height")
      ->check(NumberFrom(0.0, 10.0))
      ->group(person);
  const std::string axes = "x, y, z, -x, -y or -z; empty: by the skeleton";
  app->add_option("--scale", a->read.scale, "Metres per unit of the file; 0: by the height")
      ->check(NumberFrom(0.0, 1e6))
      ->group(person);
  app->add_option("--up", a->read.up, "Where the figure's head is in the file: " + axes)->group(person);
  app->add_option("--forward", a->read.forward, "Where the figure faces in the file: " + axes)->group(person);
  app->add_option("--part", a->read.parts, "A further file on the person's skeleton: outfit, hair; more than once")
      ->allow_extra_args(false)
      ->group(person);
  app->add_option("--hide", a->read.hide, "Names of nodes left out with what hangs on them, separated by commas")
      ->delimiter(',')
      ->group(person);
}

void AddLevels(CLI::App* app, AvatarArguments* a) {
  const std::string levels = "Levels";
  app->add_option("--ratios", a->levels.ratios,
                  "Share of the triangles in each level, falling, separated by commas; empty: as "
                  "the levels' errors say")
      ->delimiter(',')
      ->check(NumberFrom(0.0, 1.0))
      ->group(levels);
  app->add_option("--error-px", a->levels.error_px,
                  "Pixels that a level's error may span on the screen where it is shown")
      ->check(NumberFrom(1e-3, 1e6))
      ->group(levels);
  app->add_option("--max-triangles", a->levels.max_triangles, "Most triangles of the finest level; 0: no limit")
      ->check(CLI::NonNegativeNumber)
      ->group(levels);
  app->add_option("--min-triangles", a->levels.min_triangles, "Fewest triangles of a level")
      ->check(CLI::PositiveNumber)
      ->group(levels);
}

void AddCompression(CLI::App* app, AvatarArguments* a) {
  const std::string compression = "Compression";
  app->add_flag("--plain,--no-draco", a->plain, "Write plain meshes and clips, for programs that know no compression")
      ->group(compression);
  app->add_option("--position-bits", a->draco.position_bits,
                  "Bits of a position's component, 8 to 24; 0: 14, in coarser levels by their error")
      ->check(CLI::IsMember({0}) | CLI::Range(8, 24))
      ->group(compression);
  app->add_option("--normal-bits", a->draco.normal_bits, "Bits of a normal")
      ->check(CLI::Range(4, 16))
      ->group(compression);
  app->add_option("--uv-bits", a->draco.uv_bits, "Bits of a texture coordinate's component")
      ->check(CLI::Range(6, 20))
      ->group(compression);
}

nlohmann::json Statistics(const AvatarLevels& levels, const std::vector<MainColor>& colors, double seconds) {
  nlohmann::json list = nlohmann::json::array();
  for (const AvatarLevel& level : levels.levels) {
    list.push_back({{"triangles", level.triangles},
                    {"error_mm", level.error_mm},
                    {"posed_error_mm", level.posed_error_mm},
                    {"switch_px", level.switch_px},
                    {"normal_deg", level.normal_deg},
                    {"joints", level.joints},
                    {"draws", level.meshes.size()}});
  }
  nlohmann::json main_colors = nlohmann::json::array();
  for (const MainColor& c : colors) main_colors.push_back({{"color", TextFromColor(c.color)}, {"share", c.share}});
  const Avatar& avatar = levels.avatar;
  nlohmann::json clips = nlohmann::json::array();
  for (const Clip& clip : avatar.clips) {
    clips.push_back({{"name", clip.name}, {"duration_s", clip.duration_s}});
  }
  return {{"version", 1},
          {"item", avatar.name},
          {"seconds", seconds},
          {"height_m", avatar.height_m},
          {"radius_m", avatar.radius_m},
          {"walk_speed_mps", avatar.walk_speed_mps},
          {"joints", avatar.joints.size()},
          {"clips", clips},
          {"colors", main_colors},
          {"levels", list}};
}

Error Run(AvatarArguments a, const fs::path& input, AvatarLevels* levels, std::vector<MainColor>* colors,
          std::vector<std::string>* warnings) {
  const auto start = std::chrono::steady_clock::now();
  for (const auto* path : {&a.output, &a.json, &a.sheet}) {
    if (path->empty()) continue;
    if (Error e = CheckWritable(*path)) return e;
  }
  Avatar avatar;
  if (Error e = ReadAvatar(input, a.read, &avatar, warnings)) return e;
  Jobs jobs(OtherThreads(0));
  a.levels.jobs = &jobs;
  if (Error e = BuildLevels(avatar, a.levels, levels, warnings)) return e;
  if (Error e = MainColors(avatar, colors)) return e;
  a.draco.compress = !a.plain;
  if (Error e = WriteAvatarGlb(a.output, *levels, a.draco, &jobs)) return e;
  if (!a.sheet.empty()) {
    if (Error e = WriteFile(a.sheet, AvatarSheet(*levels))) return e;
  }
  if (a.json.empty()) return Ok();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  return WriteTextFile(a.json, Statistics(*levels, *colors, seconds.count()).dump(2) + "\n");
}

void PrintSummary(const AvatarArguments& a, const AvatarLevels& levels, const std::vector<MainColor>& colors) {
  const Avatar& avatar = levels.avatar;
  std::printf("%s: %.2f m high, %zu joints, walks at %.2f m/s\n", a.output.c_str(),
              static_cast<double>(avatar.height_m), avatar.joints.size(), static_cast<double>(avatar.walk_speed_mps));
  std::printf("materials:");
  for (const Material& material : avatar.materials) std::printf(" %s", OneLine(material.name).c_str());
  std::printf("\ncolours for tints, and their share of the surface:");
  for (const MainColor& c : colors)
    std::printf(" %s %.0f %%", TextFromColor(c.color).c_str(), 100 * static_cast<double>(c.share));
  std::printf("\nlevel  triangles  draws  joints  error mm  posed mm  needed from px\n");
  for (size_t k = 0; k < levels.levels.size(); ++k) {
    const AvatarLevel& level = levels.levels[k];
    std::printf("%5zu  %9d  %5zu  %6d  %8.2f  %8.2f  %14.0f\n", k, level.triangles, level.meshes.size(), level.joints,
                static_cast<double>(level.error_mm), static_cast<double>(level.posed_error_mm),
                static_cast<double>(level.switch_px));
  }
}

int MakeOne(const AvatarArguments& a, const fs::path& input, SheetEntry* entry) {
  AvatarLevels levels;
  std::vector<MainColor> colors;
  std::vector<std::string> warnings;
  const Error error = Run(a, input, &levels, &colors, &warnings);
  for (const std::string& warning : warnings) {
    std::fprintf(stderr, "flaneur: warning: %s\n", warning.c_str());
  }
  if (entry != nullptr) *entry = {input, levels.avatar, a.sheet, a.output, warnings, error.message};
  if (error) return Report(error);
  PrintSummary(a, levels, colors);
  return 0;
}

int List(const std::vector<fs::path>& inputs) {
  int status = 0;
  for (const fs::path& input : inputs) {
    std::string text;
    if (const Error e = DescribePersonFile(input, &text)) status = Report(e);
    else std::fputs(text.c_str(), stdout);
  }
  return status;
}

// A name without an ending is a folder's, unless a device or pipe has it.
bool IsFolder(const fs::path& output) {
  return fs::is_directory(output) || (!output.has_extension() && !fs::exists(output));
}

// One file a person, and a page of all of them; who cannot be read keeps nobody else from it.
int MakeAll(const AvatarArguments& all) {
  if (!all.json.empty() || !all.sheet.empty())
    return Report(Fail("--json and --sheet are for one person and -o FILE.glb; a folder has a sheet of all"));
  std::error_code ec;
  fs::create_directories(all.output, ec);
  if (ec) return Report(Fail(all.output.string() + ": cannot be made: " + ec.message()));
  std::vector<SheetEntry> entries;
  std::set<std::string> taken;
  int status = 0;
  for (const fs::path& input : all.inputs) {
    AvatarArguments one = all;
    std::string stem = input.stem().string();
    for (int n = 2; !taken.insert(stem).second; ++n) stem = input.stem().string() + "_" + std::to_string(n);
    one.output = all.output / (stem + ".glb");
    one.sheet = all.output / (stem + ".png");
    const int own = MakeOne(one, input, &entries.emplace_back());
    status = std::max(status, own);
  }
  const Error e = WriteTextFile(all.output / "index.html", SheetPage(entries));
  return e ? Report(e) : status;
}

}  // namespace

int RunAvatar(const Arguments& args) {
  CLI::App app(
      "Reduces a person to a chain of levels of detail and writes them as one compressed "
      "glTF binary with skeleton and clips.",
      "flaneur avatar");
  AvatarArguments arguments;
  AddFiles(&app, &arguments);
  AddPerson(&app, &arguments);
  AddLevels(&app, &arguments);
  AddCompression(&app, &arguments);
  if (const int status = ParseArguments(&app, args); status >= 0) return status;
  if (arguments.list) return List(arguments.inputs);
  if (arguments.output.empty()) return Report(Fail("-o is missing: say where to write"));
  return arguments.inputs.size() > 1 || IsFolder(arguments.output) ? MakeAll(arguments)
                                                                   : MakeOne(arguments, arguments.inputs[0], nullptr);
}

}  // namespace flaneur
