#include "pipeline/avatar/decimate.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "pipeline/avatar/fit_surface.h"
#include "pipeline/avatar/poses.h"
#include "pipeline/avatar/quadric_decimater.h"
#include "pipeline/avatar/surface_distance.h"
#include "pipeline/avatar/threads.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

constexpr int kQuadricPoses = 4;  // of the walk, that levels are made for; besides the bind pose
constexpr size_t kMostVertices = 3000;  // that the deviation is measured at
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

// Points that move with the surface: evenly spread ones and vertices, where distances are greatest.
class Points {
 public:
  Points(const std::vector<Mesh>& meshes, int samples) : samples_(SampleSurface(meshes, samples)) {
    std::vector<std::pair<size_t, size_t>> all;
    for (size_t m = 0; m < meshes.size(); ++m) {
      std::vector<bool> used(meshes[m].positions.size(), false);
      for (const uint32_t i : meshes[m].indices) used[i] = true;
      for (size_t v = 0; v < used.size(); ++v) {
        if (used[v]) all.push_back({m, v});
      }
    }
    const size_t step = 1 + all.size() / kMostVertices;
    for (size_t i = 0; i < all.size(); i += step) vertices_.push_back(all[i]);
  }

  std::vector<Vec3> On(const std::vector<Mesh>& meshes) const {
    std::vector<Vec3> points;
    for (const Sample& s : samples_) {
      const Mesh& mesh = meshes[s.mesh];
      const auto corner = [&](size_t k) {
        return mesh.positions[mesh.indices[3 * s.triangle + k]];
      };
      points.push_back(corner(0) * (1 - s.u - s.v) + corner(1) * s.u + corner(2) * s.v);
    }
    for (const auto& [mesh, vertex] : vertices_) points.push_back(meshes[mesh].positions[vertex]);
    return points;
  }

 private:
  std::vector<Sample> samples_;
  std::vector<std::pair<size_t, size_t>> vertices_;  // mesh and vertex
};

std::vector<std::array<Vec3, 3>> Triangles(const std::vector<Mesh>& meshes) {
  std::vector<std::array<Vec3, 3>> triangles;
  for (const Mesh& mesh : meshes) {
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      triangles.push_back({mesh.positions[mesh.indices[i]], mesh.positions[mesh.indices[i + 1]],
                           mesh.positions[mesh.indices[i + 2]]});
    }
  }
  return triangles;
}

// Measures levels against the original: both surfaces sampled, the greater of the two distances.
class Comparison {
 public:
  Comparison(const Avatar& avatar, const LevelsOptions& options)
      : meshes_(Shapes(avatar.meshes)),
        samples_(options.error_samples),
        poses_(WalkPoses(avatar, options.walk_poses)),
        points_(avatar.meshes, options.error_samples),
        tree_(Triangles(avatar.meshes)) {}

  // Of every pose, one after the other, so that each one's trees live shortly.
  void Measure(std::vector<AvatarLevel>* levels) const {
    std::vector<Shape> shapes;
    for (const AvatarLevel& level : *levels) {
      const bool original = level.triangles == CountTriangles(meshes_);
      shapes.push_back({original, Shapes(level.meshes), Points(level.meshes, samples_),
                        SurfaceTree(Triangles(level.meshes))});
    }
    std::vector<std::vector<float>> errors(1 + poses_.size());
    const auto measure = [&](size_t first, size_t step) {
      for (size_t pose = first; pose < errors.size(); pose += step) {
        errors[pose] = Deviations(pose, shapes);
      }
    };
    RunOnThreads(measure);
    for (size_t k = 0; k < levels->size(); ++k) {
      AvatarLevel& level = (*levels)[k];
      level.error_mm = 1000 * errors[0][k];
      level.posed_error_mm = 0;
      for (size_t pose = 1; pose < errors.size(); ++pose) {
        level.posed_error_mm = std::max(level.posed_error_mm, 1000 * errors[pose][k]);
      }
    }
  }

 private:
  struct Shape {
    bool original;
    std::vector<Mesh> meshes;
    Points points;
    SurfaceTree tree;
  };

  std::vector<Mesh> InPose(const std::vector<Mesh>& meshes, size_t pose) const {
    return pose == 0 ? meshes : Posed(meshes, poses_[pose - 1]);
  }

  // Of each level in one pose.
  std::vector<float> Deviations(size_t pose, const std::vector<Shape>& levels) const {
    const std::vector<Mesh> original = InPose(meshes_, pose);
    const std::vector<Vec3> on_original = points_.On(original);
    SurfaceTree original_tree = tree_;
    original_tree.MoveTo(Triangles(original));
    std::vector<float> out;
    for (const Shape& level : levels) {
      if (level.original) {
        out.push_back(0);
        continue;
      }
      const std::vector<Mesh> posed = InPose(level.meshes, pose);
      SurfaceTree level_tree = level.tree;
      level_tree.MoveTo(Triangles(posed));
      out.push_back(std::max(GreatestDistance(level_tree, on_original),
                             GreatestDistance(original_tree, level.points.On(posed))));
    }
    return out;
  }

  std::vector<Mesh> meshes_;
  int samples_;
  std::vector<std::vector<Mat4>> poses_;
  Points points_;
  SurfaceTree tree_;  // the bind pose's
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
    }
    level.triangles = CountTriangles(level.meshes);
    levels->levels.push_back(std::move(level));
  }
  if (decimater) Comparison(avatar, options).Measure(&levels->levels);
  levels->avatar.meshes = levels->levels[0].meshes;
  SetSwitchHeights(avatar.height_m, &levels->levels);
  return Ok();
}

}  // namespace flaneur
