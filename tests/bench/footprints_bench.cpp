// Prints how well and how fast obstacles are found in real city models: bench_footprints [DATA_FOLDER] [--worst]
// [--only ROW]
#include <sys/resource.h>

#include <cstdio>
#include <cstring>
#include <fstream>
#include <thread>

#include "runtime/base/clock.h"
#include "tests/unit/pipeline/footprint/figures.h"

namespace flaneur::figures {
namespace {

constexpr double kExactly = 0;  // clearance and tolerance where outlines are compared

const Spoiling kSpoilings[] = {
    {.name = "clean"},
    {.name = "flipped", .flip = true},
    {.name = "doubled", .repeat = true},
    {.name = "jittered 1 cm", .jitter = true},
    {.name = "each corner jittered 1 mm", .apart_m = 0.001f},
    {.name = "each corner jittered 1 cm", .apart_m = 0.01f},
    {.name = "eaves added", .eaves = true},
    {.name = "no ground faces", .no_ground = true},
    {.name = "5 % of triangles dropped", .drop = true},
    {.name = "all but dropping", .flip = true, .repeat = true, .jitter = true, .eaves = true, .no_ground = true}};

double Cpu_s() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](timeval t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}
// Of the whole process since the last call of ForgetPeak.
double Peak_mb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) / 1024;
  return 0;
}
void ForgetPeak() { std::ofstream("/proc/self/clear_refs") << "5"; }

Error PrintFit(const std::vector<Scene>& towns, const Spoiling& how, bool worst) {
  FootprintOptions exactly;
  exactly.clearance_m = exactly.tolerance_m = kExactly;
  std::vector<BuildingFit> all;
  for (const Scene& town : towns) {
    Footprints footprints;
    FootprintStats stats;
    if (Error e = ExtractFootprints(Spoilt(town, how), exactly, &footprints, &stats)) return e;
    const std::vector<BuildingFit> fits = Fits(town, footprints, stats);
    all.insert(all.end(), fits.begin(), fits.end());
  }
  const auto count = [&](auto test) { return static_cast<int>(std::count_if(all.begin(), all.end(), test)); };
  std::printf("%-27s %9.5f %8.1f %% %11d %9d\n", how.name, MeanIou(all), 100 * ShareWithin2cm(all),
              count([](const BuildingFit& f) { return f.flagged; }),
              count([](const BuildingFit& f) { return !f.flagged && f.iou < 0.97; }));
  const auto print = [&](const char* what) {
    for (size_t i = 0; worst && i < std::min<size_t>(5, all.size()); ++i)
      std::printf("    %s %-20s %7.4f  %8.3f m  %8.1f m2%s\n", what, all[i].name.c_str(), all[i].iou,
                  all[i].hausdorff_m, all[i].area_m2, all[i].flagged ? "  flagged" : "");
  };
  std::sort(all.begin(), all.end(), [](const BuildingFit& a, const BuildingFit& b) { return a.iou < b.iou; });
  print("IoU");
  std::sort(all.begin(), all.end(),
            [](const BuildingFit& a, const BuildingFit& b) { return a.hausdorff_m > b.hausdorff_m; });
  print("Hausdorff");
  return Ok();
}

Error PrintCover(const std::vector<Scene>& towns) {
  Cover sum;
  const FootprintOptions options;
  for (const Scene& town : towns) {
    Footprints footprints;
    if (Error e = ExtractFootprints(town, options, &footprints)) return e;
    const Cover cover = MeasureCover(town, footprints, options);
    sum.walls_m += cover.walls_m, sum.uncovered_m += cover.uncovered_m;
    sum.truth_m2 += cover.truth_m2, sum.over_m2 += cover.over_m2;
  }
  std::printf("walls in the band %.0f m, uncovered by more than 1 cm %.2f m\n", sum.walls_m, sum.uncovered_m);
  std::printf("covered beyond clearance and tolerance %.2f m2 of %.0f m2 = %.3f %%\n", sum.over_m2, sum.truth_m2,
              100 * sum.over_m2 / sum.truth_m2);
  return Ok();
}

Error PrintSpeed(const char* name, const Scene& town, int repeats) {
  ForgetPeak();
  const double before_mb = Peak_mb();
  FootprintStats stats;
  double wall_s = 1e9, used_s = 1e9;
  for (int i = 0; i < repeats; ++i) {
    const double cpu_s = Cpu_s(), start_s = Now_s();
    Footprints footprints;
    if (Error e = ExtractFootprints(town, {}, &footprints, &stats)) return e;
    wall_s = std::min(wall_s, Now_s() - start_s), used_s = std::min(used_s, Cpu_s() - cpu_s);
  }
  const double millions = 1e-6 * stats.triangles, more_mb = Peak_mb() - before_mb;
  std::printf("%-24s %8d triangles %7.2f s %7.2f CPU s %6.0f MB; a million %6.1f s %6.1f CPU s %6.0f MB\n", name,
              stats.triangles, wall_s, used_s, more_mb, wall_s / millions, used_s / millions, more_mb / millions);
  return Ok();
}

// From the file to its obstacles, each by a thread of its own: nothing is kept from the one before.
Error PrintFiles(const std::filesystem::path& folder) {
  for (const std::filesystem::path& file : CityGmlIn(folder)) {
    Scene town;
    Footprints footprints;
    FootprintStats stats;
    Error error;
    const double cpu_s = Cpu_s();
    std::thread([&] {
      error = ReadScene(file, &town);
      if (!error) error = ExtractFootprints(town, {}, &footprints, &stats);
    }).join();
    if (error) return error;
    const double used_s = Cpu_s() - cpu_s;
    std::printf("%-31s %6d triangles, read and extracted %5.2f CPU s; a million %6.1f CPU s\n",
                file.filename().string().c_str(), stats.triangles, used_s, 1e6 * used_s / stats.triangles);
  }
  return Ok();
}

// All towns of a folder as one, some distance apart, several times.
Scene Large(const std::vector<Scene>& towns, int copies) {
  Scene all;
  for (size_t k = 0; k < towns.size(); ++k) {
    const auto nodes = static_cast<int>(all.nodes.size()), meshes = static_cast<int>(all.meshes.size());
    for (SceneNode node : towns[k].nodes) {
      if (node.parent >= 0) node.parent += nodes;
      for (int& mesh : node.meshes) mesh += meshes;
      node.world.m[3][0] += static_cast<float>(1200 * k);
      all.nodes.push_back(node);
    }
    all.meshes.insert(all.meshes.end(), towns[k].meshes.begin(), towns[k].meshes.end());
  }
  return Copies(all, copies, 1200.0 * static_cast<double>(towns.size()));
}

// A single building of a million triangles.
struct HeavyObject {
  const char* name;
  float noise_m;
  bool soup;
};
const HeavyObject kHeavyObjects[] = {
    {"one house, fine mesh", 0, false}, {"one house, scanned", 0.01f, false}, {"one heap of triangles", 0, true}};

// A wall or roof of squares of two triangles each, every point moved a little.
void AddSheet(Vec3 corner, Vec3 along, Vec3 across, int squares, float noise_m, std::mt19937* random, Mesh* mesh) {
  const auto first = static_cast<uint32_t>(mesh->positions.size()), row = static_cast<uint32_t>(squares + 1);
  const auto noise = [&] { return noise_m * (static_cast<float>((*random)() % 2001) / 1000 - 1); };
  for (int i = 0; i <= squares; ++i)
    for (int k = 0; k <= squares; ++k)
      mesh->positions.push_back(corner + along * (static_cast<float>(i) / static_cast<float>(squares)) +
                                across * (static_cast<float>(k) / static_cast<float>(squares)) +
                                Vec3{noise(), noise(), noise()});
  for (uint32_t i = 0; i + 1 < row; ++i)
    for (uint32_t k = 0; k + 1 < row; ++k)
      for (const uint32_t corner_at : {0u, row, row + 1, 0u, row + 1, 1u})
        mesh->indices.push_back(first + i * row + k + corner_at);
}

Scene Heavy(const HeavyObject& heavy) {
  constexpr int kSquares = 316;
  std::mt19937 random(1);
  Mesh mesh;
  const float w = 12, h = 8;
  for (int i = 0; heavy.soup && i < 1'000'000; ++i) {
    const auto in = [&](float from, float to) {
      return from + (to - from) * static_cast<float>(random() % 10'000) / 10'000;
    };
    const Vec3 at{in(0, w), in(0, h), in(0, w)};
    for (uint32_t k = 0; k < 3; ++k) {
      mesh.indices.push_back(static_cast<uint32_t>(mesh.positions.size()));
      mesh.positions.push_back(at + Vec3{in(-0.5f, 0.5f), in(-0.5f, 0.5f), in(-0.5f, 0.5f)});
    }
  }
  if (!heavy.soup) {
    const auto add = [&](Vec3 a, Vec3 u, Vec3 v) { AddSheet(a, u, v, kSquares, heavy.noise_m, &random, &mesh); };
    add({0, 0, 0}, {w, 0, 0}, {0, h, 0}), add({w, 0, 0}, {0, 0, w}, {0, h, 0});
    add({w, 0, w}, {-w, 0, 0}, {0, h, 0}), add({0, 0, w}, {0, 0, -w}, {0, h, 0});
    add({0, h, 0}, {w, 0, 0}, {0, 0, w});
  }
  Scene scene;
  scene.materials.emplace_back();
  mesh.material = 0;
  scene.meshes.push_back(std::move(mesh));
  SceneNode node;
  node.name = "house", node.kind = NodeKind::kBuilding, node.meshes = {0};
  scene.nodes.push_back(node);
  return scene;
}

Error Run(const std::filesystem::path& data, bool worst, const std::string& only) {
  std::vector<Scene> lod2, lod3;
  if (Error e = ReadFolder(data / "towns" / "nrw-lod2", &lod2)) return e;
  if (Error e = ReadFolder(data / "towns" / "ingolstadt-lod3", &lod3)) return e;
  std::printf("%-27s %9s %10s %11s %9s\n", "LoD2", "mean IoU", "<= 2 cm", "306 flagged", "unflagged");
  for (const Spoiling& how : kSpoilings)
    if (only.empty() || only == how.name)
      if (Error e = PrintFit(lod2, how, worst)) return e;
  if (only.empty() || only == "cover")
    if (Error e = PrintCover(lod2)) return e;
  const auto wanted = [&](const char* name) { return only.empty() || only == "speed" || only == name; };
  if (wanted("files"))
    if (Error e = PrintFiles(data / "towns" / "nrw-lod2")) return e;
  if (wanted("LoD2"))
    if (Error e = PrintSpeed("LoD2", Large(lod2, 4), 5)) return e;
  if (wanted("LoD3"))
    if (Error e = PrintSpeed("LoD3", Large(lod3, 1), 5)) return e;
  for (const HeavyObject& heavy : kHeavyObjects)
    if (wanted(heavy.name))
      if (Error e = PrintSpeed(heavy.name, Heavy(heavy), 1)) return e;
  return Ok();
}

}  // namespace
}  // namespace flaneur::figures

int main(int count, char** arguments) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  std::filesystem::path data = flaneur::figures::SharedData();
  bool worst = false;
  std::string only;
  for (int i = 1; i < count; ++i) {
    if (std::strcmp(arguments[i], "--worst") == 0) worst = true;
    else if (std::strcmp(arguments[i], "--only") == 0 && i + 1 < count) only = arguments[++i];
    else data = arguments[i];
  }
  if (data.empty()) {
    std::fprintf(stderr, "bench_footprints: name the folder that holds towns/nrw-lod2, or set FLANEUR_SHARED_DIR\n");
    return 1;
  }
  const flaneur::Error error = flaneur::figures::Run(data, worst, only);
  if (error) std::fprintf(stderr, "bench_footprints: %s\n", error.message.c_str());
  return error ? 1 : 0;
}
