// How well obstacles fit a city model that knows its own ground surfaces, clean and spoilt on purpose.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "pipeline/footprint/band.h"
#include "pipeline/footprint/base_ground.h"
#include "pipeline/footprint/extract_footprints.h"
#include "pipeline/footprint/polygon_sets.h"
#include "pipeline/io/scene_reader.h"

namespace flaneur::figures {

// Where the data of this project's measurements is; empty where it is not at hand.
inline std::filesystem::path SharedData() {
  if (const char* folder = std::getenv("FLANEUR_SHARED_DIR")) return std::filesystem::path(folder) / "data";
  const std::filesystem::path beside = std::filesystem::path(FLANEUR_SOURCE_DIR) / ".." / "shared" / "data";
  return std::filesystem::exists(beside) ? beside : std::filesystem::path();
}

// The town of all .gml files in a folder, in the first one's coordinates.
inline std::vector<std::filesystem::path> CityGmlIn(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".gml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

inline Error ReadFolder(const std::filesystem::path& folder, std::vector<Scene>* scenes) {
  for (const auto& file : CityGmlIn(folder))
    if (Error e = ReadScene(file, &scenes->emplace_back())) return e;
  return Ok();
}

// ---- Spoiling ----

struct Spoiling {
  const char* name;
  bool flip = false, repeat = false, jitter = false, eaves = false, no_ground = false, drop = false;
  float apart_m = 0;  // each corner of each triangle by so much at most
};

template <typename Function>
void ForCorners(Mesh* mesh, const Function& function) {
  for (size_t i = 0; i + 2 < mesh->indices.size(); i += 3) function(&mesh->indices[i]);
}

// Every corner of a triangle has a vertex of its own.
inline void Unweld(Mesh* mesh) {
  Mesh out;
  out.name = mesh->name, out.material = mesh->material;
  for (const uint32_t i : mesh->indices) {
    out.indices.push_back(static_cast<uint32_t>(out.positions.size()));
    out.positions.push_back(mesh->positions[i]);
  }
  *mesh = std::move(out);
}

inline void Jitter(float most_m, bool apart, std::mt19937* random,
                   std::map<std::tuple<float, float, float>, Vec3>* moves, Mesh* mesh) {
  const auto step = [&] { return most_m * (static_cast<float>((*random)() % 2001) * 1e-3f - 1); };
  for (Vec3& p : mesh->positions) {
    Vec3 move{step(), step(), step()};
    if (!apart) move = moves->try_emplace({p.x, p.y, p.z}, move).first->second;
    p = p + move;
  }
}

constexpr double kSlit_m = 0.0005;  // between triangles of one surface on the grid

inline Rings GroundSurface(const Scene& scene, const SceneNode& foundation) {
  Rings rings;
  for (const int m : foundation.meshes) {
    const Mesh& mesh = scene.meshes[static_cast<size_t>(m)];
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      Ring ring;
      for (size_t k = 0; k < 3; ++k) {
        const Vec3 p = GroundFromGltf(mesh.positions[mesh.indices[i + k]]);
        ring.push_back({p.x, p.y});
      }
      if (std::abs(SignedArea(ring)) > 1e-9) rings.push_back(ring);
    }
  }
  return Offset(Offset(UnionOfRings(rings), kSlit_m), -kSlit_m);
}

inline Rings GroundSurface(const Scene& scene, const std::string& name) {
  for (const SceneNode& node : scene.nodes)
    if (node.is_foundation && node.name == name) return GroundSurface(scene, node);
  return {};
}

// Half a metre of eaves round the building, at the lowest point of its roof, but over people's heads.
inline void AddEaves(const Rings& outline, float base, Scene* scene, SceneNode* node) {
  float eaves = 1e9f;
  for (const int m : node->meshes)
    if (scene->materials[static_cast<size_t>(scene->meshes[static_cast<size_t>(m)].material)].name == "roof")
      for (const Vec3& p : scene->meshes[static_cast<size_t>(m)].positions) eaves = std::min(eaves, p.y);
  if (eaves > 1e8f) return;
  Mesh mesh;
  mesh.material = 0;
  const float z = std::max(eaves, base + 2.2f);
  for (const Ring& ring : outline) {
    for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      const double dx = ring[i].x - ring[j].x, dy = ring[i].y - ring[j].y, length = std::hypot(dx, dy);
      const double nx = 0.5 * dy / length, ny = -0.5 * dx / length;
      const auto add = [&](double x, double y) {
        mesh.positions.push_back(GltfFromGround({static_cast<float>(x), static_cast<float>(y), z}));
      };
      const auto first = static_cast<uint32_t>(mesh.positions.size());
      add(ring[j].x, ring[j].y), add(ring[i].x, ring[i].y), add(ring[i].x + nx, ring[i].y + ny),
          add(ring[j].x + nx, ring[j].y + ny);
      for (const uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + k);
    }
  }
  node->meshes.push_back(static_cast<int>(scene->meshes.size()));
  scene->meshes.push_back(std::move(mesh));
}

inline float BaseHeight(const Scene& scene, const SceneNode& foundation) {
  return scene.meshes[static_cast<size_t>(foundation.meshes[0])].positions[0].y;
}

inline Scene Spoilt(const Scene& clean, const Spoiling& how) {
  Scene scene = clean;
  std::mt19937 random(1);
  if (how.eaves)
    for (const SceneNode& node : clean.nodes)
      if (node.is_foundation && !node.meshes.empty())
        AddEaves(GroundSurface(clean, node), BaseHeight(clean, node), &scene,
                 &scene.nodes[static_cast<size_t>(node.parent)]);
  std::map<std::tuple<float, float, float>, Vec3> moves;
  for (Mesh& mesh : scene.meshes) {
    Unweld(&mesh);
    if (how.jitter) Jitter(0.01f, false, &random, &moves, &mesh);
    if (how.apart_m > 0) Jitter(how.apart_m, true, &random, &moves, &mesh);
    if (how.flip)
      ForCorners(&mesh, [&](uint32_t* t) {
        if (random() % 2) std::swap(t[1], t[2]);
      });
    if (how.repeat) {
      const std::vector<uint32_t> all = mesh.indices;
      mesh.indices.insert(mesh.indices.end(), all.begin(), all.end());
    }
    if (!how.drop) continue;
    std::vector<uint32_t> kept;
    ForCorners(&mesh, [&](uint32_t* t) {
      if (random() % 20) kept.insert(kept.end(), t, t + 3);
    });
    mesh.indices = std::move(kept);
  }
  if (how.no_ground)
    for (SceneNode& node : scene.nodes)
      if (node.is_foundation) node.meshes.clear();
  return scene;
}

// What an OBJ keeps: ground surfaces are triangles of their building.
inline Scene Untagged(const Scene& scene) {
  Scene out = scene;
  for (SceneNode& node : out.nodes) {
    if (node.kind == NodeKind::kBuilding) node.kind = NodeKind::kUntagged;
    if (!node.is_foundation) continue;
    SceneNode& parent = out.nodes[static_cast<size_t>(node.parent)];
    parent.meshes.insert(parent.meshes.end(), node.meshes.begin(), node.meshes.end());
    node.meshes.clear();
    node.is_foundation = false;
  }
  return out;
}

// ---- Measuring ----

struct BuildingFit {
  std::string name;
  double iou = 0, hausdorff_m = 0, area_m2 = 0;
  bool flagged = false;
};

inline double FarthestFrom(const Rings& from, const Rings& to) {
  double farthest = 0;
  for (const Ring& ring : from) {
    for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      const double length = std::hypot(ring[i].x - ring[j].x, ring[i].y - ring[j].y);
      const int steps = std::max(1, static_cast<int>(std::ceil(length / 0.1)));
      for (int k = 0; k < steps; ++k) {
        const double s = static_cast<double>(k) / steps;
        farthest = std::max(farthest, DistanceToBoundary(to, {ring[j].x + s * (ring[i].x - ring[j].x),
                                                              ring[j].y + s * (ring[i].y - ring[j].y)}));
      }
    }
  }
  return farthest;
}

inline std::map<std::string, Rings> AreasBySource(const Footprints& footprints) {
  std::map<std::string, Rings> areas;
  for (const Obstacle& o : footprints.obstacles) {
    Rings& rings = areas[o.source];
    rings.push_back(o.outer);
    rings.insert(rings.end(), o.holes.begin(), o.holes.end());
  }
  return areas;
}

// Each building of the clean town against its ground surface.
inline std::vector<BuildingFit> Fits(const Scene& clean, const Footprints& footprints, const FootprintStats& stats) {
  const std::map<std::string, Rings> areas = AreasBySource(footprints);
  std::vector<BuildingFit> fits;
  for (const SceneNode& node : clean.nodes) {
    if (!node.is_foundation || node.meshes.empty()) continue;
    const Rings truth = GroundSurface(clean, node);
    BuildingFit fit;
    fit.name = node.name;
    fit.area_m2 = Area(truth);
    fit.flagged = std::find(stats.open_shells.begin(), stats.open_shells.end(), node.name) != stats.open_shells.end();
    fit.hausdorff_m = 1e9;
    const auto found = areas.find(node.name);
    if (found != areas.end()) {
      fit.iou = Area(Intersection(truth, found->second)) / Area(Union(truth, found->second));
      fit.hausdorff_m = std::max(FarthestFrom(truth, found->second), FarthestFrom(found->second, truth));
    }
    fits.push_back(fit);
  }
  return fits;
}

inline double MeanIou(const std::vector<BuildingFit>& fits) {
  double sum = 0;
  for (const BuildingFit& fit : fits) sum += fit.iou;
  return fits.empty() ? 0 : sum / static_cast<double>(fits.size());
}

// Of buildings whose outline lies within 2 cm of the ground surface's.
inline double ShareWithin2cm(const std::vector<BuildingFit>& fits) {
  const auto good =
      std::count_if(fits.begin(), fits.end(), [](const BuildingFit& fit) { return fit.hausdorff_m <= 0.02; });
  return fits.empty() ? 0 : static_cast<double>(good) / static_cast<double>(fits.size());
}

struct Cover {
  double walls_m = 0, uncovered_m = 0, truth_m2 = 0, over_m2 = 0;
};

// Walls in the band that stand out by more than 1 cm, and ground covered farther from the ground surfaces than
// clearance and tolerance.
inline Cover MeasureCover(const Scene& clean, const Footprints& footprints, const FootprintOptions& options) {
  Rings obstacles, truth;
  for (const Obstacle& o : footprints.obstacles) {
    obstacles.push_back(o.outer);
    obstacles.insert(obstacles.end(), o.holes.begin(), o.holes.end());
  }
  obstacles = UnionOfAreas(obstacles);
  const AreaIndex index(obstacles, 0.5);
  Cover cover;
  const TownObjects town = SortTown(clean, 1);
  for (const TownObject& object : town.obstacles) {
    const Rings ground = GroundSurface(clean, object.name);
    truth.insert(truth.end(), ground.begin(), ground.end());
    const BandParts parts = CutToBand(object.triangles, GroundsUnder(object)[0], options.band_m);
    for (const Segment& s : Lines(parts)) {
      const double length = std::hypot(s.b.x - s.a.x, s.b.y - s.a.y);
      const int steps = std::max(1, static_cast<int>(std::ceil(length / 0.05)));
      for (int k = 0; k < steps; ++k) {
        const double t = (k + 0.5) / steps;
        cover.walls_m += length / steps;
        if (index.Depth({s.a.x + t * (s.b.x - s.a.x), s.a.y + t * (s.b.y - s.a.y)}) < -0.01)
          cover.uncovered_m += length / steps;
      }
    }
  }
  truth = UnionOfAreas(truth);
  cover.truth_m2 = Area(truth);
  cover.over_m2 = Area(Difference(obstacles, Offset(truth, options.clearance_m + options.tolerance_m, 4)));
  return cover;
}

// Side by side, so that timings have enough to do.
inline Scene Copies(const Scene& scene, int count, double step_m) {
  Scene out = scene;
  const int side = static_cast<int>(std::ceil(std::sqrt(count)));
  for (int k = 1; k < count; ++k) {
    const auto first_node = static_cast<int>(out.nodes.size());
    for (SceneNode node : scene.nodes) {
      if (node.parent >= 0) node.parent += first_node;
      node.name += "_" + std::to_string(k);
      node.world.m[3][0] += static_cast<float>(k % side * step_m);
      node.world.m[3][2] += static_cast<float>(k / side * step_m);
      out.nodes.push_back(node);
    }
  }
  return out;
}

}  // namespace flaneur::figures
