#include "pipeline/avatar/decimate.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "pipeline/avatar/fit_surface.h"
#include "pipeline/avatar/quadric_decimater.h"
#include "pipeline/avatar/surface_distance.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

constexpr int kQuadricPoses = 4;  // of the walk, that levels are made for; besides the bind pose
constexpr float kTargetTolerance = 0.02f;
constexpr float kEndless_px = 100000;  // switch height where the next level is exact

Error CheckMeshes(const Avatar& avatar) {
  int triangles = 0;
  for (const Mesh& mesh : avatar.meshes) {
    const std::string name = std::string("avatar '").append(OneLine(avatar.name)) + "', mesh '" +
                             OneLine(mesh.name) + "'";
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
      const Vec3 p = mesh.positions[v];
      if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) continue;
      return Fail(name + ": the position of vertex " + std::to_string(v) + " is not finite");
    }
    for (const uint32_t i : mesh.indices) {
      if (i >= mesh.positions.size()) return Fail(name + ": an index is out of range");
    }
    triangles += TriangleCount(mesh);
  }
  return triangles > 0 ? Ok() : Fail("avatar '" + OneLine(avatar.name) + "' has no triangles");
}

Error CheckOptions(const LevelsOptions& options) {
  if (options.ratios.empty()) return Fail("levels: at least one ratio is needed");
  float previous = 1.00001f;
  for (const float ratio : options.ratios) {
    if (!(ratio > 0) || !(ratio < previous)) {
      return Fail("levels: ratios must fall and lie in (0, 1]");
    }
    previous = ratio;
  }
  if (options.error_samples < 0 || options.walk_poses < 0 || options.max_triangles < 0 ||
      options.min_triangles < 0) {
    return Fail("levels: counts must not be negative");
  }
  return Ok();
}

int CountTriangles(const std::vector<Mesh>& meshes) {
  int count = 0;
  for (const Mesh& mesh : meshes) count += TriangleCount(mesh);
  return count;
}

std::vector<Mesh> Posed(const std::vector<Mesh>& meshes, const std::vector<Mat4>& matrices) {
  std::vector<Mesh> posed;
  for (const Mesh& mesh : meshes) posed.push_back(Skinned(mesh, matrices));
  return posed;
}

// Skinning matrices of `count` moments of the walk, evenly spread.
std::vector<std::vector<Mat4>> WalkPoses(const Avatar& avatar, int count) {
  std::vector<std::vector<Mat4>> poses;
  const Clip* walk = FindClip(avatar, "walk");
  for (int i = 0; walk != nullptr && i < count; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(count);
    poses.push_back(SkinningMatrices(avatar, *walk, share * walk->duration_s));
  }
  return poses;
}

// A point of a surface that moves with it.
struct Sample {
  size_t mesh = 0, triangle = 0;
  float u = 0, v = 0;  // of the second and third corner
};

// Random by area, the same every time.
std::vector<Sample> SampleSurface(const std::vector<Mesh>& meshes, int count) {
  std::vector<float> sums;
  std::vector<Sample> triangles, samples;
  float total = 0;
  for (size_t m = 0; m < meshes.size(); ++m) {
    const Mesh& mesh = meshes[m];
    for (size_t t = 0; t < mesh.indices.size() / 3; ++t) {
      const auto corner = [&](size_t k) { return mesh.positions[mesh.indices[3 * t + k]]; };
      total += Length(Cross(corner(1) - corner(0), corner(2) - corner(0)));
      sums.push_back(total);
      triangles.push_back({m, t, 0, 0});
    }
  }
  std::mt19937 random(1);
  const auto unit = [&random] { return static_cast<float>(random()) / 4294967296.0f; };
  for (int i = 0; i < count; ++i) {
    const auto at = std::upper_bound(sums.begin(), sums.end(), unit() * total);
    const size_t t = std::min(static_cast<size_t>(at - sums.begin()), sums.size() - 1);
    Sample sample = triangles[t];
    const float root = std::sqrt(unit());
    sample.v = root * unit();
    sample.u = root - sample.v;
    samples.push_back(sample);
  }
  return samples;
}

std::vector<Vec3> Points(const std::vector<Mesh>& meshes, const std::vector<Sample>& samples) {
  std::vector<Vec3> points;
  for (const Sample& s : samples) {
    const Mesh& mesh = meshes[s.mesh];
    const auto corner = [&](size_t k) { return mesh.positions[mesh.indices[3 * s.triangle + k]]; };
    points.push_back(corner(0) * (1 - s.u - s.v) + corner(1) * s.u + corner(2) * s.v);
  }
  for (const Mesh& mesh : meshes) {
    std::vector<bool> used(mesh.positions.size(), false);
    for (const uint32_t i : mesh.indices) used[i] = true;
    for (size_t v = 0; v < used.size(); ++v) {
      if (used[v]) points.push_back(mesh.positions[v]);
    }
  }
  return points;
}

SurfaceTree Tree(const std::vector<Mesh>& meshes) {
  std::vector<std::array<Vec3, 3>> triangles;
  for (const Mesh& mesh : meshes) {
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      triangles.push_back({mesh.positions[mesh.indices[i]], mesh.positions[mesh.indices[i + 1]],
                           mesh.positions[mesh.indices[i + 2]]});
    }
  }
  return SurfaceTree(std::move(triangles));
}

// Measures levels against the original: both surfaces sampled, the greater of the two distances.
class Comparison {
 public:
  Comparison(const Avatar& avatar, const LevelsOptions& options)
      : options_(options), poses_(WalkPoses(avatar, options.walk_poses)) {
    const std::vector<Sample> samples = SampleSurface(avatar.meshes, options.error_samples);
    Add(avatar.meshes, samples);
    for (const auto& matrices : poses_) Add(Posed(avatar.meshes, matrices), samples);
  }

  void Measure(AvatarLevel* level) const {
    const std::vector<Sample> samples = SampleSurface(level->meshes, options_.error_samples);
    level->error_mm = 1000 * Deviation(0, level->meshes, samples);
    for (size_t pose = 0; pose < poses_.size(); ++pose) {
      const std::vector<Mesh> posed = Posed(level->meshes, poses_[pose]);
      level->posed_error_mm =
          std::max(level->posed_error_mm, 1000 * Deviation(pose + 1, posed, samples));
    }
  }

 private:
  void Add(const std::vector<Mesh>& meshes, const std::vector<Sample>& samples) {
    trees_.push_back(Tree(meshes));
    points_.push_back(Points(meshes, samples));
  }

  float Deviation(size_t pose, const std::vector<Mesh>& meshes,
                  const std::vector<Sample>& samples) const {
    return std::max(GreatestDistance(Tree(meshes), points_[pose]),
                    GreatestDistance(trees_[pose], Points(meshes, samples)));
  }

  LevelsOptions options_;
  std::vector<std::vector<Mat4>> poses_;
  std::vector<SurfaceTree> trees_;  // the original's, bind pose first
  std::vector<std::vector<Vec3>> points_;
};

std::vector<int> Targets(const LevelsOptions& options, int triangles) {
  const int limit =
      options.max_triangles > 0 ? std::min(options.max_triangles, triangles) : triangles;
  std::vector<int> targets;
  for (const float ratio : options.ratios) {
    const int wanted = static_cast<int>(std::lround(ratio * static_cast<float>(limit)));
    const int target = std::max(wanted, std::min(options.min_triangles, limit));
    // A level that hardly differs from the one before helps nobody.
    if (targets.empty() || static_cast<float>(target) <
                               (1 - 2 * kTargetTolerance) * static_cast<float>(targets.back())) {
      targets.push_back(std::max(target, 1));
    }
  }
  return targets;
}

// A level is needed where the next coarser one's error would show: span at least a pixel of the
// screen.
void SetSwitchHeights(float height_m, std::vector<AvatarLevel>* levels) {
  float error_mm = 0;
  for (size_t k = 1; k < levels->size(); ++k) {
    const AvatarLevel& coarser = (*levels)[k];
    error_mm = std::max({error_mm, coarser.error_mm, coarser.posed_error_mm});
    const float height_mm = 1000 * height_m;
    (*levels)[k - 1].switch_px =
        error_mm * kEndless_px > height_mm ? height_mm / error_mm : kEndless_px;
  }
  levels->back().switch_px = 0;
}

}  // namespace

Error BuildLevels(const Avatar& avatar, const LevelsOptions& options, AvatarLevels* levels,
                  std::vector<std::string>* warnings) {
  if (Error e = CheckOptions(options)) return e;
  if (Error e = CheckMeshes(avatar)) return e;
  levels->avatar = avatar;
  levels->levels.clear();
  const int original = CountTriangles(avatar.meshes);
  const Comparison comparison(avatar, options);
  const std::vector<std::vector<Mat4>> poses = WalkPoses(avatar, kQuadricPoses);
  std::unique_ptr<QuadricDecimater> decimater;
  for (const int target : Targets(options, original)) {
    AvatarLevel level;
    level.meshes = avatar.meshes;
    if (target < original) {
      if (!decimater) decimater = std::make_unique<QuadricDecimater>(avatar.meshes, poses);
      const int most = static_cast<int>((1 + kTargetTolerance) * static_cast<float>(target));
      decimater->DecimateTo(target);
      if (decimater->Triangles() > most) {
        warnings->push_back("avatar '" + OneLine(avatar.name) + "': a level has " +
                            std::to_string(decimater->Triangles()) + " triangles instead of " +
                            std::to_string(target) + ", as its parts cannot be simplified further");
      }
      WedgeSurface surface = decimater->Surface();
      FitSurface(avatar.meshes, poses, {}, &surface);
      level.meshes = SplitWedges(surface, avatar.meshes);
      comparison.Measure(&level);
    }
    level.triangles = CountTriangles(level.meshes);
    levels->levels.push_back(std::move(level));
  }
  levels->avatar.meshes = levels->levels[0].meshes;
  SetSwitchHeights(avatar.height_m, &levels->levels);
  return Ok();
}

}  // namespace flaneur
