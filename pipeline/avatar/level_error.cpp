#include "pipeline/avatar/level_error.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "pipeline/avatar/poses.h"
#include "pipeline/avatar/surface_distance.h"
#include "pipeline/avatar/surface_places.h"
#include "pipeline/avatar/threads.h"

namespace flaneur {
namespace {

constexpr size_t kMostCorners = 6000;
constexpr float kSameSide = 0.3f;  // cosine between normals of places that belong together

// Points that move with a surface: evenly spread ones and corners, where distances are greatest.
std::vector<Place> PlacesOn(const std::vector<Mesh>& meshes, const Triangles& triangles,
                            int samples) {
  std::vector<Place> places = SpreadPlaces(triangles, samples), corners;
  uint32_t triangle = 0;
  for (const Mesh& mesh : meshes) {
    std::vector<bool> known(mesh.positions.size(), false);
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3, ++triangle) {
      for (size_t k = 0; k < 3; ++k) {
        if (known[mesh.indices[i + k]]) continue;
        known[mesh.indices[i + k]] = true;
        Place corner{triangle, {}};
        corner.shares[k] = 1;
        corners.push_back(corner);
      }
    }
  }
  const size_t step = 1 + corners.size() / kMostCorners;
  for (size_t i = 0; i < corners.size(); i += step) places.push_back(corners[i]);
  return places;
}

struct Surface {
  Surface(const std::vector<Mesh>& of, int samples)
      : meshes(Shapes(of)),
        bind(PosedTriangles(meshes, nullptr)),
        places(PlacesOn(meshes, bind, samples)),
        tree(bind) {}
  std::vector<Mesh> meshes;
  Triangles bind;
  std::vector<Place> places;
  SurfaceTree tree;  // the bind pose's
};

// Follows both surfaces from pose to pose: where a point was nearest it mostly still is.
class Follower {
 public:
  explicit Follower(const Surface& surface) : surface_(surface), tree_(surface.tree) {}

  void MoveTo(const std::vector<Mat4>* pose) {
    triangles_ = pose != nullptr ? PosedTriangles(surface_.meshes, pose) : surface_.bind;
    tree_.MoveTo(triangles_);
  }

  // The greatest distance of its points from the other surface, or `greatest` where that is more. `guesses`: one a point.
  float FarthestFrom(const Follower& other, float greatest, std::vector<uint32_t>* guesses) const {
    const bool first_time = guesses->empty();
    guesses->resize(surface_.places.size(), 0);
    for (size_t i = 0; i < guesses->size(); ++i) {
      if (first_time && i > 0) (*guesses)[i] = (*guesses)[i - 1];  // most lie beside the one before
      const Place& place = surface_.places[i];
      const Vec3 point = At(triangles_[place.triangle], place.shares);
      greatest = other.tree_.AtLeast(point, greatest, &(*guesses)[i]);
    }
    return greatest;
  }

 private:
  const Surface& surface_;
  SurfaceTree tree_;
  Triangles triangles_;
};

// Of each level in some of the poses, or what it was in one before; 0 is the bind pose, which stands for itself.
void MeasurePoses(const Surface& original, const std::vector<std::unique_ptr<Surface>>& levels,
                  const std::vector<std::vector<Mat4>>& poses, size_t first, size_t step,
                  std::vector<std::vector<float>>* errors) {
  if (first > poses.size()) return;
  struct Guesses {
    std::vector<uint32_t> on_level, on_original;
  };
  std::vector<Guesses> guesses(levels.size());
  std::vector<std::unique_ptr<Follower>> followers;
  for (const auto& level : levels) {
    followers.push_back(level ? std::make_unique<Follower>(*level) : nullptr);
  }
  Follower whole(original);
  for (size_t pose = first; pose <= poses.size(); pose += step) {
    const std::vector<Mat4>* matrices = pose > 0 ? &poses[pose - 1] : nullptr;
    whole.MoveTo(matrices);
    for (size_t k = 0; k < levels.size(); ++k) {
      if (!followers[k]) continue;
      followers[k]->MoveTo(matrices);
      float& greatest = (*errors)[pose][k];
      greatest = pose > step ? (*errors)[pose - step][k] : 0;
      greatest = whole.FarthestFrom(*followers[k], greatest, &guesses[k].on_level);
      greatest = followers[k]->FarthestFrom(whole, greatest, &guesses[k].on_original);
    }
  }
}

int CountTriangles(const Avatar& avatar) {
  int count = 0;
  for (const Mesh& mesh : avatar.meshes) count += TriangleCount(mesh);
  return count;
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

float MeanAngle_deg(const SurfaceTree& original, const Triangles& original_normals, const std::vector<Mesh>& meshes, int samples) {
  const Triangles triangles = PosedTriangles(meshes, nullptr), normals = CornerNormals(meshes);
  double sum = 0;
  int count = 0;
  uint32_t guess = 0;
  for (const Place& place : SpreadPlaces(triangles, samples)) {
    const auto found = original.Find(At(triangles[place.triangle], place.shares), guess);
    guess = found.triangle;
    const Vec3 a = Normalized(At(normals[place.triangle], place.shares)), b = Normalized(At(original_normals[found.triangle], found.shares));
    if (!(Dot(a, b) > kSameSide)) continue;
    sum += std::atan2(static_cast<double>(Length(Cross(a, b))), static_cast<double>(Dot(a, b)));
    ++count;
  }
  return count > 0 ? static_cast<float>(sum / count * 180 / static_cast<double>(kPi)) : 0;
}

}  // namespace

void MeasureNormals(const Avatar& original, int samples, std::vector<AvatarLevel>* levels) {
  const Triangles triangles = PosedTriangles(original.meshes, nullptr), normals = CornerNormals(original.meshes);
  if (triangles.empty() || samples <= 0) return;
  const SurfaceTree tree(triangles);
  RunOnThreads([&](size_t first, size_t step) {
    for (size_t k = first; k < levels->size(); k += step) {
      AvatarLevel& level = (*levels)[k];
      const bool whole = level.triangles == static_cast<int>(triangles.size());
      level.normal_deg = whole ? 0 : MeanAngle_deg(tree, normals, level.meshes, samples);
    }
  });
}

void MeasureLevels(const Avatar& original, int samples, int walk_poses,
                   std::vector<AvatarLevel>* levels) {
  const int triangles = CountTriangles(original);
  if (std::all_of(levels->begin(), levels->end(),
                  [&](const AvatarLevel& level) { return level.triangles == triangles; })) {
    return;
  }
  const Surface whole(original.meshes, samples);
  const std::vector<std::vector<Mat4>> poses = WalkPoses(original, walk_poses);
  std::vector<std::unique_ptr<Surface>> surfaces;  // none: it is the original
  for (const AvatarLevel& level : *levels) {
    surfaces.push_back(
        level.triangles == triangles ? nullptr : std::make_unique<Surface>(level.meshes, samples));
  }
  std::vector<std::vector<float>> errors(1 + poses.size(), std::vector<float>(levels->size()));
  RunOnThreads([&](size_t first, size_t step) {
    MeasurePoses(whole, surfaces, poses, first, step, &errors);
  });
  for (size_t k = 0; k < levels->size(); ++k) {
    AvatarLevel& level = (*levels)[k];
    level.error_mm = 1000 * errors[0][k];
    level.posed_error_mm = 0;
    for (size_t pose = 1; pose < errors.size(); ++pose) {
      level.posed_error_mm = std::max(level.posed_error_mm, 1000 * errors[pose][k]);
    }
  }
}

}  // namespace flaneur
