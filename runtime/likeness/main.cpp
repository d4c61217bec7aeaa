#include <CLI/CLI.hpp>
#include <cstdio>

#include "runtime/base/file.h"
#include "runtime/base/option_range.h"
#include "runtime/base/text.h"
#include "runtime/desktop/context.h"
#include "runtime/likeness/measure.h"

namespace flaneur {
namespace {

struct LikenessArguments {
  std::filesystem::path pack, output;
  std::vector<std::string> avatars;
  std::string clip = "walk";
  int supersampling = 1;
  MeasureOptions measure;
};

// -1: go on; else the exit status.
int Parse(int argc, char** argv, LikenessArguments* a) {
  CLI::App app(
      "Draws every person of a tour pack once with full geometry and once as each coarser level and as impostor, each "
      "at its "
      "switch distance, and says how much the pictures differ.\nExit status: 0 done, 2 bad usage or input.",
      "flaneur-likeness");
  app.option_defaults()->always_capture_default();
  app.add_option("PACK", a->pack, "Tour pack (.glb)")->required();
  app.add_option("-o,--output", a->output, "Folder for a contact sheet (PNG) of each person and likeness.csv")
      ->required();
  app.add_option("--avatar", a->avatars, "Only these persons, separated by commas")
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_option("--headings", a->measure.headings, "Headings around the circle")->check(CLI::Range(1, 360));
  app.add_option("--phases", a->measure.phases, "Moments of the clip")->check(CLI::Range(1, 256));
  app.add_option("--suns", a->measure.suns, "Directions of the sun")->check(CLI::Range(1, 3));
  app.add_option("--between", a->measure.between, "Moves headings and phases on by so much of their spacing")
      ->check(NumberFrom(0.0, 1.0));
  app.add_option("--person-px", a->measure.person_px,
                 "Height on screen where all are compared; 0: each at its switch distance")
      ->check(NumberFrom(0.0, 2000.0));
  app.add_option("--supersampling", a->supersampling,
                 "Pixels a pixel and side: 1 keeps the player's own noise in both pictures")
      ->check(CLI::Range(1, 8));
  app.add_flag("--impostors", a->measure.impostors_only, "Leave the coarser levels out");
  app.add_option("--clip", a->clip, "Which clip")->check(CLI::IsMember({"walk", "idle", "talk"}));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);
    std::fprintf(stderr, "flaneur-likeness: error: %s; see flaneur-likeness --help\n", OneLine(e.what()).c_str());
    return 2;
  }
  a->measure.clip = a->clip == "walk" ? ClipKind::kWalk : a->clip == "idle" ? ClipKind::kIdle : ClipKind::kTalk;
  return -1;
}

std::string LevelName(Level level) { return IsMesh(level) ? std::to_string(level.mesh) : "impostor"; }

void Print(const AvatarLikeness& avatar, std::string* csv) {
  for (const LevelLikeness& l : avatar.levels) {
    std::printf("%-14s %-9s %5.0f %8.2f %7.2f %8.2f %8.4f %8.4f %8.2f\n", avatar.name.c_str(),
                LevelName(l.level).c_str(), static_cast<double>(l.person_px), l.mean.delta_e, l.worst.delta_e,
                l.mean.delta_e_whole, l.mean.overlap, l.worst.overlap, l.mean.normal_deg);
    char line[256];
    std::snprintf(line, sizeof line, "%s,%s,%.1f,%.4f,%.4f,%.4f,%.4f,%.5f,%.5f,%.4f,%.4f\n", avatar.name.c_str(),
                  LevelName(l.level).c_str(), static_cast<double>(l.person_px), l.mean.delta_e, l.worst.delta_e,
                  l.mean.delta_e_whole, l.worst.delta_e_whole, l.mean.overlap, l.worst.overlap, l.mean.normal_deg,
                  l.worst.normal_deg);
    *csv += line;
  }
  std::fflush(stdout);
}

Error CheckNames(const LikenessArguments& a, const TourPack& pack) {
  for (const std::string& name : a.avatars) {
    const auto is_it = [&](const PackAvatar& avatar) { return avatar.name == name; };
    if (std::none_of(pack.avatars.begin(), pack.avatars.end(), is_it))
      return Fail(a.pack.string() + " has no avatar '" + name + "'");
  }
  return Ok();
}

Error Run(const LikenessArguments& a) {
  if (Error e = CheckWritable(a.output / "likeness.csv")) return e;
  Jobs jobs(ThreadsOfThisMachine());
  TourPack pack;
  if (Error e = LoadTourPack(a.pack, {.jobs = &jobs}, &pack)) return e;
  if (Error e = CheckNames(a, pack)) return e;
  HeadlessContext context;
  if (Error e = context.Create()) return e;
  PortraitStudio studio;
  if (Error e = studio.Create(std::move(pack), a.supersampling, &jobs)) return e;
  std::printf("avatar         level        px dE mean   worst    whole IoU mean    worst  normal\n");
  std::string csv =
      "avatar,level,person_px,delta_e_mean,delta_e_worst,delta_e_whole_mean,delta_e_whole_worst,iou_mean,iou_worst,"
      "normal_deg_mean,normal_deg_worst\n";
  for (size_t i = 0; i < studio.pack().avatars.size(); ++i) {
    const std::string& name = studio.pack().avatars[i].name;
    if (!a.avatars.empty() && std::find(a.avatars.begin(), a.avatars.end(), name) == a.avatars.end()) continue;
    const AvatarLikeness avatar = Measure(a.measure, static_cast<int>(i), &studio);
    Print(avatar, &csv);
    if (Error e = WriteContactSheet(a.output / (name + ".png"), avatar.sheet)) return e;
  }
  return WriteTextFile(a.output / "likeness.csv", csv);
}

}  // namespace
}  // namespace flaneur

int main(int argc, char** argv) {
  flaneur::LikenessArguments arguments;
  if (const int status = flaneur::Parse(argc, argv, &arguments); status >= 0) return status;
  const flaneur::Error error = flaneur::Run(arguments);
  if (!error) return 0;
  std::fprintf(stderr, "flaneur-likeness: error: %s\n", flaneur::OneLine(error.message).c_str());
  return 2;
}
