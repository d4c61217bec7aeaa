// A whole city: extraction and check of many buildings, their processor time and memory, and whether the bytes are the
// same for any number of threads. Buildings are those of the city models given, set side by side until there are
// enough, else made up. bench_whole_city [BUILDINGS] [MODEL]...
#include <sys/resource.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>

#include "pipeline/core/temporary_folder.h"
#include "pipeline/footprint/check.h"
#include "pipeline/footprint/extract_footprints.h"
#include "pipeline/io/geojson.h"
#include "pipeline/io/scene_reader.h"
#include "runtime/base/array.h"
#include "runtime/base/file.h"

namespace flaneur {
namespace {

double Cpu_s() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](timeval t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double Peak_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

// A house of four walls, a floor and a flat roof; its neighbours adjoin.
void AddHouse(int number, Vec2 at, Scene* scene) {
  SceneNode node;
  node.name = "house_" + std::to_string(number);
  node.kind = NodeKind::kBuilding;
  node.meshes = {Count(scene->meshes)};
  const float w = 9, d = 8 + static_cast<float>(number % 5), h = 6;
  const Vec2 plan[4] = {{at.x, at.y}, {at.x + w, at.y}, {at.x + w, at.y + d}, {at.x, at.y + d}};
  Mesh mesh;
  const auto add = [&](Vec3 p) {
    mesh.positions.push_back(GltfFromGround(p));
    mesh.normals.push_back({0, 1, 0});
    mesh.indices.push_back(static_cast<uint32_t>(mesh.positions.size() - 1));
  };
  const auto quad = [&](Vec3 a, Vec3 b, Vec3 c, Vec3 e) {
    for (const Vec3& p : {a, b, c, a, c, e}) add(p);
  };
  for (int i = 0; i < 4; ++i) {
    const Vec2 a = plan[i], b = plan[(i + 1) % 4];
    quad({a.x, a.y, 0}, {b.x, b.y, 0}, {b.x, b.y, h}, {a.x, a.y, h});
  }
  for (const float z : {0.0f, h})
    quad({plan[0].x, plan[0].y, z}, {plan[1].x, plan[1].y, z}, {plan[2].x, plan[2].y, z}, {plan[3].x, plan[3].y, z});
  scene->meshes.push_back(std::move(mesh));
  scene->nodes.push_back(std::move(node));
}

Scene MadeUp(int buildings) {
  Scene scene;
  const int rows = std::max(1, static_cast<int>(std::sqrt(buildings / 10.0)));
  for (int i = 0; i < buildings; ++i) {
    const int block = i / 10, place = i % 10;
    AddHouse(i,
             {static_cast<float>(60 * (block % rows) + 9 * (place % 5)),
              static_cast<float>(50 * (block / rows) + 22 * (place / 5))},
             &scene);
  }
  return scene;
}

int Buildings(const Scene& scene) {
  int count = 0;
  for (const SceneNode& node : scene.nodes) count += node.parent < 0 && node.kind == NodeKind::kBuilding;
  return count;
}

// Copies of the models, a raster of them.
Scene SideBySide(const std::vector<Scene>& models, int buildings) {
  Scene city;
  city.materials = models[0].materials;
  double wide = 0;
  for (const Scene& model : models)
    for (const Mesh& mesh : model.meshes)
      for (const Vec3& p : mesh.positions)
        wide = std::max({wide, std::abs(2.0 * static_cast<double>(p.x)), std::abs(2.0 * static_cast<double>(p.z))});
  int of_all = 0;
  for (const Scene& model : models) of_all += Buildings(model);
  const int copies = buildings / std::max(1, of_all / Count(models)) + 1;
  const int across = static_cast<int>(std::ceil(std::sqrt(copies)));
  for (int copy = 0, made = 0; made < buildings; ++copy) {
    const Scene& model = models[static_cast<size_t>(copy) % models.size()];
    const auto step = [&](int k) { return static_cast<float>((k - across / 2) * (wide + 20)); };
    const Mat4 place =
        FromTranslationRotationScale({step(copy % across), 0, step(copy / across)}, {0, 0, 0, 1}, {1, 1, 1});
    const int nodes = Count(city.nodes), meshes = Count(city.meshes);
    for (SceneNode node : model.nodes) {
      node.name += "_" + std::to_string(copy);
      if (node.parent >= 0) node.parent += nodes;
      for (int& mesh : node.meshes) mesh += meshes;
      node.world = place * node.world;
      city.nodes.push_back(std::move(node));
    }
    city.meshes.insert(city.meshes.end(), model.meshes.begin(), model.meshes.end());
    made += Buildings(model);
  }
  return city;
}

std::string Written(const std::filesystem::path& path, const Footprints& footprints) {
  std::string text;
  if (WriteGeoJson(path, footprints) || ReadTextFile(path, &text)) return {};
  return text;
}

int Run(int buildings, const std::vector<std::string>& files) {
  std::vector<Scene> models;
  for (const std::string& file : files)
    if (Error e = ReadScene(file, &models.emplace_back())) return std::puts(e.message.c_str()), 1;
  const Scene city = models.empty() ? MadeUp(buildings) : SideBySide(models, buildings);
  std::printf("%d buildings; %.0f MB before anything is done\n", Buildings(city), Peak_mb());
  TemporaryFolder folder;
  if (Error e = folder.Create("flaneur_city_", std::filesystem::temp_directory_path())) return 1;
  std::map<int, std::string> texts, findings_of;
  for (const int threads : {1, 3}) {
    FootprintOptions options;
    options.threads = threads;
    Footprints footprints;
    double start = Cpu_s();
    if (Error e = ExtractFootprints(city, options, &footprints)) return std::puts(e.message.c_str()), 1;
    std::printf("%d threads: extraction %.1f CPU s, %.0f MB at most\n", threads, Cpu_s() - start, Peak_mb());
    texts[threads] = Written(folder.path() / "o.geojson", footprints);
    for (const bool with_town : {false, true}) {
      CheckOptions check;
      check.threads = threads;
      std::vector<Finding> findings;
      start = Cpu_s();
      if (Error e = Check(footprints, with_town ? &city : nullptr, check, &findings))
        return std::puts(e.message.c_str()), 1;
      std::printf("%d threads: check %s %.1f CPU s, %.0f MB at most, %zu findings\n", threads,
                  with_town ? "with the town" : "alone", Cpu_s() - start, Peak_mb(), findings.size());
      findings_of[threads] += FindingsJson(findings);
    }
  }
  std::printf("same bytes: obstacles %s, findings %s\n", texts[1] == texts[3] ? "yes" : "NO",
              findings_of[1] == findings_of[3] ? "yes" : "NO");
  return 0;
}

}  // namespace
}  // namespace flaneur

int main(int argc, char** argv) {
  return flaneur::Run(argc > 1 ? std::atoi(argv[1]) : 100'000, {argv + std::min(argc, 2), argv + argc});
}
