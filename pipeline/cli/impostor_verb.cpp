#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/cli/arguments.h"
#include "pipeline/cli/verbs.h"
#include "pipeline/core/interruption.h"
#include "pipeline/impostor/bake_impostor.h"
#include "pipeline/io/gltf.h"
#include "runtime/base/array.h"
#include "runtime/base/file.h"
#include "runtime/base/option_range.h"

namespace flaneur {
namespace {

struct ImpostorArguments {
  std::filesystem::path input, output;
  ReadAvatarOptions read;
  ImpostorOptions impostor;
  int walk_phases = 8, idle_phases = 2, talk_phases = 2;
};

void AddOptions(CLI::App* app, ImpostorArguments* a) {
  app->add_option("IN", a->input, "The person: a glTF file with a skin and a walk clip")->required();
  app->add_option("-o,--output", a->output,
                  "Folder for the pictures (KTX2 and PNG) and impostor.json; made where missing")
      ->required();
  app->option_defaults()->always_capture_default();
  const std::string views = "Views";
  app->add_option("--directions", a->impostor.directions, "Directions around the person")
      ->check(CLI::Range(1, 64))
      ->group(views);
  app->add_option("--elevations", a->impostor.elevations_deg,
                  "Camera's heights above the horizon in degrees, separated by commas")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(NumberFrom(-89.0, 89.0))
      ->group(views);
  app->add_option("--walk-phases", a->walk_phases, "Pictures of the walk, evenly spaced")
      ->check(CLI::Range(1, 256))
      ->group(views);
  app->add_option("--idle-phases", a->idle_phases, "The same of the idle clip; 0 leaves it out")
      ->check(CLI::Range(0, 256))
      ->group(views);
  app->add_option("--talk-phases", a->talk_phases, "The same of the talk clip; 0 leaves it out")
      ->check(CLI::Range(0, 256))
      ->group(views);
  const std::string picture = "Picture";
  app->add_option("--cell-height", a->impostor.height_px, "Height of a cell in pixels")
      ->check(CLI::Range(16, 1024))
      ->group(picture);
  app->add_option("--memory", a->impostor.memory_kb,
                  "Most kB on the graphics card: where more is needed, cells are lower; 0: no limit")
      ->check(CLI::Range(0, 1000000))
      ->group(picture);
  app->add_option("--border", a->impostor.border_px, "Pixels left empty around the person")
      ->check(CLI::Range(1, 16))
      ->group(picture);
  app->add_option("--samples", a->impostor.samples, "Samples a pixel")->check(CLI::Range(1, 4096))->group(picture);
  app->add_option("--seed", a->impostor.seed, "Seed of the sample pattern")
      ->check(CLI::NonNegativeNumber)
      ->group(picture);
  app->add_option("--threads", a->impostor.threads,
                  "Threads of Blender, 0: one a core; the pictures do not depend on it")
      ->check(CLI::Range(0, 1024))
      ->group(picture);
  app->add_option("--log", a->impostor.log_file, "Keep in this file what Blender prints")->group(picture);
}

void AddPersonOptions(CLI::App* app, ImpostorArguments* a) {
  const std::string person = "Person";
  app->add_option("--walk", a->read.walk, "Name of the walk clip, where not found by itself")->group(person);
  app->add_option("--idle", a->read.idle, "Name of the idle clip")->group(person);
  app->add_option("--talk", a->read.talk, "Name of the talk clip")->group(person);
  app->add_option("--height", a->read.height_m,
                  "Metres to scale the person to; 0: as it is, or 1.75 where that is no "
                  "person's height")
      ->check(NumberFrom(0.0, 10.0))
      ->group(person);
  app->add_option("--hide", a->read.hide, "Names of nodes left out, separated by commas")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->group(person);
}

Error Bake(const ImpostorArguments& a, ImpostorAtlas* atlas, ImpostorStatistics* statistics,
           std::vector<std::string>* warnings) {
  if (Error error = CheckWritable(a.output / "impostor.json")) return error;
  Avatar avatar;
  if (Error error = ReadAvatar(a.input, a.read, &avatar, warnings)) return error;
  ImpostorOptions options = a.impostor;
  options.clips = {{"walk", a.walk_phases}};
  if (a.idle_phases > 0) options.clips.push_back({"idle", a.idle_phases});
  if (a.talk_phases > 0) options.clips.push_back({"talk", a.talk_phases});
  if (Error error = BakeImpostor(avatar, options, atlas, statistics, warnings)) return error;
  return WriteImpostor(a.output, *atlas);
}

void PrintSummary(const ImpostorArguments& a, const ImpostorAtlas& atlas, const ImpostorStatistics& statistics) {
  std::printf(
      "%s: %d directions x %d frames, %.1f mm a texel, atlas %d x %d px, %.0f %% filled, %.2f MB on "
      "the graphics card\n",
      a.output.c_str(), atlas.directions, atlas.frames * Count(atlas.elevations_deg),
      1000 * static_cast<double>(atlas.texel_m), statistics.width_px, statistics.height_px, 100 * statistics.fill_rate,
      static_cast<double>(statistics.memory_bytes) / 1e6);
  std::printf("%d triangles, Blender: %.1f CPU seconds, %.0f MB\n", statistics.triangles, statistics.blender_cpu_s,
              static_cast<double>(statistics.blender_peak_memory_bytes) / 1e6);
}

}  // namespace

int RunImpostor(const Arguments& args) {
  CLI::App app(
      "Draws a person from every side at every phase of the walk into one atlas: colour with "
      "coverage, normals, depth and motion.",
      "flaneur impostor");
  ImpostorArguments arguments;
  AddOptions(&app, &arguments);
  AddPersonOptions(&app, &arguments);
  if (const int status = ParseArguments(&app, args); status >= 0) return status;
  CatchInterruptions();
  ImpostorAtlas atlas;
  ImpostorStatistics statistics;
  std::vector<std::string> warnings;
  const Error error = Bake(arguments, &atlas, &statistics, &warnings);
  for (const std::string& warning : warnings) {
    std::fprintf(stderr, "flaneur: warning: %s\n", warning.c_str());
  }
  if (error) {
    const int status = Report(error);
    EndAsInterrupted();
    return status;
  }
  PrintSummary(arguments, atlas, statistics);
  return 0;
}

}  // namespace flaneur
