#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "pipeline/cli/arguments.h"
#include "pipeline/cli/verbs.h"
#include "runtime/base/array.h"
#include "runtime/pack/tour_pack.h"

namespace flaneur {
namespace {

using Json = nlohmann::ordered_json;

// As people read them: a float's last digits are noise.
double Rounded(double value) { return std::round(value * 1000) / 1000; }

Json AvatarSummary(const PackAvatar& avatar) {
  Json levels = Json::array();
  for (const PackLevel& level : avatar.levels) {
    levels.push_back({{"triangles", level.triangles},
                      {"posed_error_mm", Rounded(level.posed_error_mm)},
                      {"switch_px", Rounded(level.switch_px)}});
  }
  const PackImpostor& impostor = avatar.impostor;
  return {{"name", avatar.name},
          {"share", Rounded(avatar.share)},
          {"height_m", Rounded(avatar.height_m)},
          {"walk_speed_mps", Rounded(avatar.walk_speed_mps)},
          {"joints", avatar.joints},
          {"levels", levels},
          {"impostor",
           {{"directions", impostor.directions},
            {"frames", impostor.frames},
            {"texel_mm", Rounded(1000.0 * impostor.texel_m)},
            {"atlas_px", {impostor.width_px, impostor.height_px}}}}};
}

Json Summary(const TourPack& pack) {
  Json avatars = Json::array(), places = Json::object();
  for (const PackAvatar& avatar : pack.avatars) avatars.push_back(AvatarSummary(avatar));
  for (const Place& place : pack.places) places[place.kind] = places.value(place.kind, 0) + 1;
  int64_t town_triangles = 0;
  for (const TownInstance& instance : pack.town) {
    for (const PackPrimitive& p : At(pack.meshes, instance.mesh).primitives) {
      town_triangles += static_cast<int64_t>(p.indices.size() / 3);
    }
  }
  return {{"name", pack.name},
          {"version", kTourPackVersion},
          {"town", {{"instances", pack.town.size()}, {"triangles", town_triangles}}},
          {"avatars", avatars},
          {"obstacles", pack.obstacles.polygons.size() + pack.obstacles.circles.size()},
          {"ground",
           {{"columns", pack.ground->columns}, {"rows", pack.ground->rows}, {"cell_m", Rounded(pack.ground->cell_m)}}},
          {"places", places},
          {"path_stops", pack.path.size()},
          {"people", pack.crowd.people},
          {"images", pack.images.size()}};
}

void Print(const Json& json, int depth) {
  for (const auto& [key, value] : json.items()) {
    std::printf("%*s%s", 2 * depth, "", json.is_array() ? "-" : key.c_str());
    if (value.is_structured() && !value.empty() && !(value.is_array() && value[0].is_primitive())) {
      std::printf("\n");
      Print(value, depth + 1);
    } else {
      std::printf(": %s\n", value.is_string() ? value.get<std::string>().c_str() : value.dump().c_str());
    }
  }
}

}  // namespace

int RunInspect(const Arguments& args) {
  CLI::App app{"Says what is in a tour pack, after checking all of it.", "flaneur inspect"};
  std::string path;
  bool as_json = false;
  app.add_option("PACK", path, "A tour pack (.glb)")->required();
  app.add_flag("--json", as_json, "As JSON");
  if (const int status = ParseArguments(&app, args); status >= 0) return status;
  TourPack pack;
  Jobs jobs(ThreadsOfThisMachine());
  if (Error e = LoadTourPack(path, {.jobs = &jobs}, &pack)) return Report(e);
  const Json summary = Summary(pack);
  if (as_json) std::printf("%s\n", summary.dump(1).c_str());
  else Print(summary, 0);
  return 0;
}

}  // namespace flaneur
