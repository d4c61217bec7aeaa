#include "pipeline/avatar/level_error.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "pipeline/avatar/in_strides.h"
#include "pipeline/avatar/poses.h"
#include "pipeline/avatar/surface_distance.h"
#include "pipeline/avatar/surface_places.h"

namespace flaneur {
namespace {

constexpr size_t kMaxCorners = 6000;
constexpr float kSameSide = 0.3f;  // cosine between normals of places that belong together

// Points that move with a surface: evenly spread ones and corners, where distances are greatest.
std::vector<SurfacePlace> PlacesOn(const std::vector<Mesh>& meshes, const Triangles& triangles, int samples) {
  std::vector<SurfacePlace> places = SpreadPlaces(triangles, samples), corners;
  uint32_t triangle = 0;
  for (const Mesh& mesh : meshes) {
    std::vector<bool> known(mesh.positions.size(), false);
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3, ++triangle) {
      for (size_t k = 0; k < 3; ++k) {
        if (known[mesh.indices[i + k]]) continue;
        known[mesh.indices[i + k]] = true;
        SurfacePlace corner{triangle, {}};
        corner.shares[k] = 1;
        corners.push_back(corner);
      }
    }
  }
  const size_t step = 1 + corners.size() / kMaxCorners;
  for (size_t i = 0; i < corners.size(); i += step) places.push_back(corners[i]);
  return places;
}

// Points of a surface and the surface itself, in one pose.
struct PosedSurface {
  std::vector<Vec3> points;
  SurfaceTree tree;
};

// A surface in all poses, the bind pose first.
std::vector<PosedSurface> InAllPoses(Jobs* jobs, const std::vector<Mesh>& of,
                                     const std::vector<std::vector<Mat4>>& poses, int samples) {
  const std::vector<Mesh> meshes = Shapes(of);
  const Triangles bind = PosedTriangles(meshes, nullptr);
  const std::vector<SurfacePlace> places = PlacesOn(meshes, bind, samples);
  std::vector<PosedSurface> all(1 + poses.size(), PosedSurface{{}, SurfaceTree(bind)});
  InStrides(jobs, [&](size_t first, size_t step) {
    for (size_t pose = first; pose < all.size(); pose += step) {
      const Triangles posed = pose > 0 ? PosedTriangles(meshes, &poses[pose - 1]) : bind;
      if (pose > 0) all[pose].tree.MoveTo(posed);
      for (const SurfacePlace& place : places) all[pose].points.push_back(At(posed[place.triangle], place.shares));
    }
  });
  return all;
}

// The greatest distance of the points from the surface, or `greatest` where that is more. `guesses`, one a point, of
// where each is nearest: mostly where it was in another pose.
float Farthest(const std::vector<Vec3>& points, const SurfaceTree& surface, float greatest,
               std::vector<uint32_t>* guesses) {
  const bool first_time = guesses->empty();
  guesses->resize(points.size(), 0);
  for (size_t i = 0; i < points.size(); ++i) {
    if (first_time && i > 0) (*guesses)[i] = (*guesses)[i - 1];  // most lie beside the one before
    greatest = surface.AtLeast(points[i], greatest, &(*guesses)[i]);
  }
  return greatest;
}

// The normals of each triangle's corners, zero where the mesh has none.
Triangles CornerNormals(const std::vector<Mesh>& meshes) {
  Triangles normals;
  for (const Mesh& mesh : meshes) {
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      auto& corners = normals.emplace_back();
      for (size_t k = 0; k < 3 && !mesh.normals.empty(); ++k) corners[k] = mesh.normals[mesh.indices[i + k]];
    }
  }
  return normals;
}

float MeanAngle_deg(const SurfaceTree& original, const Triangles& original_normals, const std::vector<Mesh>& meshes,
                    int samples) {
  const Triangles triangles = PosedTriangles(meshes, nullptr), normals = CornerNormals(meshes);
  double sum = 0;
  int count = 0;
  uint32_t guess = 0;
  for (const SurfacePlace& place : SpreadPlaces(triangles, samples)) {
    const auto found = original.Find(At(triangles[place.triangle], place.shares), guess);
    guess = found.triangle;
    const Vec3 a = Normalized(At(normals[place.triangle], place.shares)),
               b = Normalized(At(original_normals[found.triangle], found.shares));
    if (!(Dot(a, b) > kSameSide)) continue;
    sum += std::atan2(static_cast<double>(Length(Cross(a, b))), static_cast<double>(Dot(a, b)));
    ++count;
  }
  return count > 0 ? static_cast<float>(sum / count * 180 / static_cast<double>(kPi)) : 0;
}

}  // namespace

struct MeasuredOriginal {
  const Avatar& avatar;
  int samples;
  Jobs* jobs;
  std::vector<std::vector<Mat4>> walk;
  std::vector<PosedSurface> poses;
  Triangles normals;  // of corners
};

LevelMeter::LevelMeter(const Avatar& original, int samples, int walk_poses, Jobs* jobs)
    : original_(new MeasuredOriginal{original, samples, jobs, WalkPoses(original, walk_poses), {}, {}}) {
  original_->poses = InAllPoses(jobs, original.meshes, original_->walk, samples);
  original_->normals = CornerNormals(original.meshes);
}

LevelMeter::~LevelMeter() = default;

void LevelMeter::MeasureDistance(AvatarLevel* level) const {
  const std::vector<PosedSurface> poses =
      InAllPoses(original_->jobs, level->meshes, original_->walk, original_->samples);
  std::vector<float> errors_m(poses.size());
  InStrides(original_->jobs, [&](size_t first, size_t step) {
    std::vector<uint32_t> on_level, on_original;
    for (size_t pose = first; pose < poses.size(); pose += step) {
      // The walk's poses go on from the greatest so far; the bind pose stands for itself.
      float greatest = pose > step ? errors_m[pose - step] : 0;
      greatest = Farthest(original_->poses[pose].points, poses[pose].tree, greatest, &on_level);
      errors_m[pose] = Farthest(poses[pose].points, original_->poses[pose].tree, greatest, &on_original);
    }
  });
  level->error_mm = 1000 * errors_m[0];
  level->posed_error_mm = 0;
  for (size_t pose = 1; pose < errors_m.size(); ++pose)
    level->posed_error_mm = std::max(level->posed_error_mm, 1000 * errors_m[pose]);
}

void LevelMeter::MeasureNormals(AvatarLevel* level) const {
  if (original_->samples <= 0) return;
  level->normal_deg = MeanAngle_deg(original_->poses[0].tree, original_->normals, level->meshes, original_->samples);
}

}  // namespace flaneur
