// Prints how well and how fast obstacles are found in random towns whose footprints are known, and in city models by
// their own ground surfaces, tagged and as untagged triangles, clean and spoilt on purpose:
// bench_made_up_towns [--seed N] [--blocks N] [--only MIX] [--worst] [CITY_MODEL...]
#include <sys/resource.h>

#include <cstdio>
#include <cstring>

#include "tests/unit/pipeline/footprint/figures.h"
#include "tests/unit/pipeline/footprint/made_up_town.h"

namespace flaneur::figures {
namespace {

const made_up::Mix kMixes[] = {
    {"rows", made_up::PartyWalls::kBoth, true, false, false, false, false, false},
    {"rows without party walls", made_up::PartyWalls::kNone, true, false, false, false, false, false},
    {"rows, walls of one owner", made_up::PartyWalls::kOneOwner, true, false, false, false, false, false},
    {"yards", made_up::PartyWalls::kBoth, false, true, false, false, false, false},
    {"yards without party walls", made_up::PartyWalls::kNone, false, true, false, false, false, false},
    {"yards, walls of one owner", made_up::PartyWalls::kOneOwner, false, true, false, false, false, false},
    {"huge", made_up::PartyWalls::kBoth, false, false, true, false, false, false},
    {"towers", made_up::PartyWalls::kBoth, false, false, false, true, false, false},
    {"basins", made_up::PartyWalls::kBoth, false, false, false, false, true, false},
    {"terraces", made_up::PartyWalls::kBoth, false, false, false, false, false, true},
};

struct Way {
  Spoiling spoiling;
  bool tagged;
};
const Way kWays[] = {
    {{.name = "clean"}, true},
    {{.name = "clean, untagged"}, false},
    {{.name = "flipped, untagged", .flip = true}, false},
    {{.name = "doubled, untagged", .repeat = true}, false},
    {{.name = "no ground, untagged", .no_ground = true}, false},
    {{.name = "jittered 1 cm, untagged", .jitter = true}, false},
    {{.name = "5 % dropped, untagged", .drop = true}, false},
    {{.name = "5 % dropped", .drop = true}, true},
};

struct Arguments {
  unsigned seed = 1;
  int blocks = 12;
  bool worst = false;
  std::string only, way;
  std::vector<std::string> files;
};

double Cpu_s() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](timeval t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

void PrintWorst(std::vector<BuildingFit> fits) {
  std::sort(fits.begin(), fits.end(), [](const BuildingFit& a, const BuildingFit& b) { return a.iou < b.iou; });
  for (size_t i = 0; i < std::min<size_t>(5, fits.size()); ++i)
    std::printf("    %-24s IoU %7.4f  Hausdorff %8.3f m  %8.1f m2%s\n", fits[i].name.c_str(), fits[i].iou,
                std::min(fits[i].hausdorff_m, 9999.0), fits[i].area_m2, fits[i].flagged ? "  flagged" : "");
}

Error PrintWay(const Scene& town, const Way& way, bool worst) {
  FootprintOptions exactly;
  exactly.clearance_m = exactly.tolerance_m = 0;
  const Scene spoilt = Spoilt(town, way.spoiling), scene = way.tagged ? spoilt : Untagged(spoilt);
  Footprints footprints;
  FootprintStats stats;
  const double start_s = Cpu_s();
  if (Error e = ExtractFootprints(scene, exactly, &footprints, &stats)) return e;
  const double cpu_s = Cpu_s() - start_s;
  const std::vector<BuildingFit> fits = Fits(town, footprints, stats);
  const auto count = [&](auto test) { return static_cast<int>(std::count_if(fits.begin(), fits.end(), test)); };
  Rings all, truth;
  for (const Obstacle& o : footprints.obstacles) {
    all.push_back(o.outer);
    all.insert(all.end(), o.holes.begin(), o.holes.end());
  }
  all = UnionOfAreas(all);
  for (const SceneNode& node : town.nodes) {
    if (!node.is_foundation) continue;
    const Rings one = GroundSurface(town, node);
    truth.insert(truth.end(), one.begin(), one.end());
  }
  truth = UnionOfAreas(truth);
  std::printf("  %-26s %8.5f %7.1f %% %8d %9d %9.1f %9.1f %8.2f\n", way.spoiling.name, MeanIou(fits),
              100 * ShareWithin2cm(fits), count([](const BuildingFit& f) { return f.flagged; }),
              count([](const BuildingFit& f) { return !f.flagged && f.iou < 0.97; }), Area(Difference(truth, all)),
              Area(Difference(all, truth)), 1e6 * cpu_s / stats.triangles);
  if (worst) PrintWorst(fits);
  return Ok();
}

Error PrintTown(const std::string& name, const Scene& town, const Arguments& arguments) {
  std::printf("%s: %d buildings\n", name.c_str(), static_cast<int>(town.nodes.size() / 2));
  std::printf("  %-26s %8s %9s %8s %9s %9s %9s %8s\n", "", "mean IoU", "<= 2 cm", "flagged", "unflagged", "missing",
              "beyond", "CPU s/M");
  for (const Way& way : kWays)
    if (arguments.way.empty() || arguments.way == way.spoiling.name)
      if (Error e = PrintWay(town, way, arguments.worst)) return e;
  return Ok();
}

Error Run(const Arguments& arguments) {
  for (const std::string& file : arguments.files) {
    Scene town;
    if (Error e = ReadScene(file, &town)) return e;
    if (Error e = PrintTown(file, town, arguments)) return e;
  }
  if (!arguments.files.empty()) return Ok();
  for (const made_up::Mix& mix : kMixes) {
    if (!arguments.only.empty() && arguments.only != mix.name) continue;
    const made_up::Town town = made_up::Build(mix, arguments.blocks, arguments.seed);
    if (Error e = PrintTown(mix.name, ToScene(town, made_up::Tags::kCityModel), arguments)) return e;
  }
  return Ok();
}

}  // namespace
}  // namespace flaneur::figures

int main(int count, char** arguments) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  flaneur::figures::Arguments a;
  for (int i = 1; i < count; ++i) {
    const auto value = [&](const char* option) { return std::strcmp(arguments[i], option) == 0 && i + 1 < count; };
    if (std::strcmp(arguments[i], "--worst") == 0) a.worst = true;
    else if (value("--seed")) a.seed = static_cast<unsigned>(std::atoi(arguments[++i]));
    else if (value("--blocks")) a.blocks = std::atoi(arguments[++i]);
    else if (value("--only")) a.only = arguments[++i];
    else if (value("--way")) a.way = arguments[++i];
    else a.files.emplace_back(arguments[i]);
  }
  const flaneur::Error error = flaneur::figures::Run(a);
  if (error) std::fprintf(stderr, "bench_made_up_towns: %s\n", error.message.c_str());
  return error ? 1 : 0;
}
