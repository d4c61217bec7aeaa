#include "pipeline/avatar/decimate.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "pipeline/avatar/fit_look.h"
#include "pipeline/avatar/fit_surface.h"
#include "pipeline/avatar/level_error.h"
#include "pipeline/avatar/limit_joints.h"
#include "pipeline/avatar/material_atlas.h"
#include "pipeline/avatar/merge_joints.h"
#include "pipeline/avatar/poses.h"
#include "pipeline/avatar/quadric_decimater.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

constexpr int kQuadricPoses = 4;  // of the walk, that levels are made for; besides the bind pose
constexpr float kTargetTolerance = 0.02f;
constexpr float kSameJoint_m = 1e-4f;     // a joint that moves nothing farther from its parent is none
constexpr float kJointShare = 0.1f;       // of a level's error, that merged joints may add
constexpr float kMinJointGain_m = 2e-4f;  // below it hardly any joint could merge
constexpr float kEndless_px = 100000;     // switch height where the next level is exact
// Of a chain that makes itself, heights of the person on screen:
constexpr float kFinest_px = 2000;   // larger than anybody is ever seen
constexpr float kImpostor_px = 128;  // below it most people are impostors
constexpr float kCoarsest_px = 64;   // half of it: below it nobody is a mesh
constexpr float kTurned_deg = 2.5f;  // of normals: a level that is further off is none for people higher than impostors
constexpr float kSimilarReachShare = 0.85f;    // of the height on screen up to which a finer level serves,
constexpr float kSimilarTriangleShare = 0.7f;  // which has so many triangles
constexpr size_t kMinLevels = 3;               // where triangles allow: for tight budgets
constexpr int kMaxPropTriangles = 300;
constexpr float kMinUsefulTriangles = 250;  // triangles: fewer save nothing beside the rest of a frame

Error CheckMeshes(const Avatar& avatar) {
  int triangles = 0;
  for (const Mesh& mesh : avatar.meshes) {
    const std::string name =
        std::string("avatar '").append(OneLine(avatar.name)) + "', mesh '" + OneLine(mesh.name) + "'";
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
  float previous = 1.00001f;
  for (const float ratio : options.ratios) {
    if (!(ratio > 0) || !(ratio < previous)) {
      return Fail("levels: ratios must fall and lie in (0, 1]");
    }
    previous = ratio;
  }
  if (options.error_samples < 0 || options.walk_poses < 0 || options.max_triangles < 0 || options.min_triangles < 0) {
    return Fail("levels: counts must not be negative");
  }
  if (!(options.error_px > 0)) return Fail("levels: error_px must be greater than 0");
  return Ok();
}

// 1, 0.5, 0.4, 0.2, 0.1, 0.05, ... as long as so few triangles save anything.
std::vector<float> Ladder(int triangles) {
  std::vector<float> ratios{1};
  for (float decade = 1;; decade /= 10) {
    for (const float step : {0.5f, 0.4f, 0.2f, 0.1f}) {
      if (step * decade * static_cast<float>(triangles) < kMinUsefulTriangles) return ratios;
      ratios.push_back(step * decade);
    }
  }
}

std::vector<int> Targets(const LevelsOptions& options, int triangles) {
  const int limit = options.max_triangles > 0 ? std::min(options.max_triangles, triangles) : triangles;
  std::vector<int> targets;
  for (const float ratio : options.ratios.empty() ? Ladder(limit) : options.ratios) {
    const int wanted = static_cast<int>(std::lround(ratio * static_cast<float>(limit)));
    const int target = std::max(wanted, std::min(options.min_triangles, limit));
    // A level that hardly differs from the one before helps nobody.
    if (targets.empty() ||
        static_cast<float>(target) < (1 - 2 * kTargetTolerance) * static_cast<float>(targets.back())) {
      targets.push_back(std::max(target, 1));
    }
  }
  return targets;
}

float Error_mm(const AvatarLevel& level) { return std::max(level.error_mm, level.posed_error_mm); }

// The person's height on screen from which on a level's error spans error_px, or its light would look unlike the
// original's.
float Limit_px(const AvatarLevel& level, const Avatar& avatar, float error_px) {
  const float height_mm = 1000 * avatar.height_m;
  const float limit_px =
      Error_mm(level) * kEndless_px > error_px * height_mm ? error_px * height_mm / Error_mm(level) : kEndless_px;
  return level.normal_deg > kTurned_deg ? std::min(limit_px, error_px * kImpostor_px) : limit_px;
}

// Of candidates from fine to coarse those that some size on screen needs.
void KeepNeeded(const Avatar& avatar, float error_px, std::vector<AvatarLevel>* levels) {
  std::vector<AvatarLevel> chosen;
  for (AvatarLevel& level : *levels) {
    const float limit_px = Limit_px(level, avatar, error_px);
    const auto hardly_fewer = [&](const AvatarLevel& finer) {
      return static_cast<float>(level.triangles) > kSimilarTriangleShare * static_cast<float>(finer.triangles);
    };
    // Finer ones go where this one serves everybody, or no worse, or, where impostors serve as well, hardly worse.
    const auto spares = [&](const AvatarLevel& finer) {
      const bool alike = limit_px < kImpostor_px && hardly_fewer(finer);
      return limit_px > kFinest_px || limit_px >= (alike ? kSimilarReachShare : 1) * Limit_px(finer, avatar, error_px);
    };
    while (chosen.size() > 1 && spares(chosen.back())) chosen.pop_back();
    if (chosen.size() >= kMinLevels && limit_px <= kCoarsest_px) break;
    if (chosen.size() > 1 && limit_px <= kCoarsest_px && hardly_fewer(chosen.back())) continue;
    chosen.push_back(std::move(level));
  }
  *levels = std::move(chosen);
}

// A level is needed where the next coarser one's error would show.
void SetSwitchHeights(const Avatar& avatar, float error_px, std::vector<AvatarLevel>* levels) {
  float limit_px = kEndless_px;
  for (size_t k = 1; k < levels->size(); ++k) {
    limit_px = std::min(limit_px, Limit_px((*levels)[k], avatar, error_px));
    (*levels)[k - 1].switch_px = limit_px;
  }
  levels->back().switch_px = 0;
}

// Each level in the number of joints that its error hides.
void SpareJoints(const Avatar& avatar, std::vector<AvatarLevel>* levels) {
  for (AvatarLevel& level : *levels) {
    const float bound_m = kJointShare * Error_mm(level) / 1000;
    if (bound_m > kMinJointGain_m) {
      level.posed_error_mm += 1000 * MergeJoints(avatar, bound_m, &level.meshes);
    }
    level.joints = CountJoints(level.meshes);
  }
}

// The avatar without joints that never move otherwise than their parents.
Avatar WithoutIdleJoints(Avatar avatar) {
  MergeJoints(avatar, kSameJoint_m, &avatar.meshes);
  DropIdleJoints(&avatar);
  return avatar;
}

std::string Missed(const Avatar& avatar, int triangles, int target) {
  return "avatar '" + OneLine(avatar.name) + "': a level has " + std::to_string(triangles) + " triangles instead of " +
         std::to_string(target) + ", as its parts cannot be simplified further";
}

// What all levels of one original are fitted to and measured against.
struct Reference {
  Reference(const Avatar& avatar, const std::vector<std::vector<Mat4>>& poses, const LevelsOptions& options)
      : surface(avatar.meshes, poses, options.jobs),
        look(avatar.meshes, {.jobs = options.jobs}),
        meter(avatar, options.error_samples, options.walk_poses, options.jobs) {}
  SurfaceFitter surface;
  LookFitter look;
  LevelMeter meter;
};

AvatarLevel FinishedLevel(const Avatar& avatar, const LevelsOptions& options, const Reference& reference,
                          WedgeSurface surface) {
  reference.surface.Fit(&surface);
  reference.look.Fit(&surface);
  AvatarLevel level;
  level.meshes = SplitWedges(surface, avatar.meshes);
  level.triangles = TriangleCount(level.meshes);
  reference.meter.MeasureDistance(&level);
  if (options.ratios.empty()) reference.meter.MeasureNormals(&level);
  return level;
}

// Levels of so many triangles.
std::vector<AvatarLevel> DecimatedLevels(const Avatar& avatar, const LevelsOptions& options,
                                         std::vector<std::string>* warnings) {
  const int original = TriangleCount(avatar.meshes);
  const std::vector<int> targets = Targets(options, original);
  std::vector<AvatarLevel> levels(targets.size());
  size_t first = 0;  // that is decimated
  for (; first < targets.size() && targets[first] >= original; ++first) {
    levels[first].meshes = avatar.meshes;
    levels[first].triangles = original;
  }
  if (first == targets.size()) return levels;
  const std::vector<std::vector<Mat4>> poses = WalkPoses(avatar, kQuadricPoses);
  // What levels are fitted to is prepared beside the decimation of the first.
  std::optional<Reference> reference;
  Job preparing = StartJob(options.jobs, [&] {
    reference.emplace(avatar, poses, options);
    return true;
  });
  QuadricDecimater decimater(avatar.meshes, poses, options.jobs);
  std::vector<WedgeSurface> surfaces;
  for (size_t k = first; k < targets.size(); ++k) {
    decimater.DecimateTo(targets[k]);
    const float most = (1 + kTargetTolerance) * static_cast<float>(targets[k]);
    if (static_cast<float>(decimater.Triangles()) > most)
      warnings->push_back(Missed(avatar, decimater.Triangles(), targets[k]));
    surfaces.push_back(decimater.Surface());
  }
  preparing.Wait();
  ParallelFor(options.jobs, surfaces.size(), [&](size_t k) {
    levels[first + k] = FinishedLevel(avatar, options, *reference, std::move(surfaces[k]));
  });
  return levels;
}

// To few enough triangles that it may be drawn beside an impostor.
void ReduceProp(const Avatar& avatar, Jobs* jobs, std::vector<std::string>* warnings, AvatarProp* prop) {
  const int triangles = TriangleCount(prop->meshes);
  if (triangles <= kMaxPropTriangles) return;
  Avatar alone = avatar;
  alone.name = avatar.name + "', prop '" + prop->name;
  alone.meshes = prop->meshes;
  LevelsOptions options;
  options.jobs = jobs;
  options.ratios = {static_cast<float>(kMaxPropTriangles) / static_cast<float>(triangles)};
  prop->meshes = DecimatedLevels(alone, options, warnings)[0].meshes;
}

}  // namespace

Error BuildLevels(const Avatar& source, const LevelsOptions& options, AvatarLevels* levels,
                  std::vector<std::string>* warnings) {
  if (Error e = CheckOptions(options)) return e;
  if (Error e = CheckMeshes(source)) return e;
  Avatar limited = source;
  if (!LimitJoints(options.max_joints, &limited, warnings)) {
    return Fail("it uses " + std::to_string(source.joints.size()) + " joints, at most " +
                std::to_string(options.max_joints) +
                " are possible, and too many of them move by themselves; simplify the skeleton");
  }
  const Avatar avatar = WithoutIdleJoints(limited);
  levels->avatar = avatar;
  levels->levels = DecimatedLevels(avatar, options, warnings);
  if (options.ratios.empty()) KeepNeeded(avatar, options.error_px, &levels->levels);
  SpareJoints(avatar, &levels->levels);
  levels->avatar.meshes = levels->levels[0].meshes;
  for (AvatarProp& prop : levels->avatar.props) ReduceProp(avatar, options.jobs, warnings, &prop);
  SetSwitchHeights(avatar, options.error_px, &levels->levels);
  MergeMaterials(levels, warnings);
  return Ok();
}

}  // namespace flaneur
