#include "runtime/simulation/birds.h"

#include <algorithm>
#include <cmath>

namespace flaneur {
namespace {

constexpr float kBand = 0.2f;     // of the distance up to which a mesh serves, over which the next one comes in
constexpr float kFadeOut = 0.2f;  // of the reach, over which birds vanish
constexpr float kRise_mps = 4;    // of the reach, where there is room again

// Up to where a mesh is fine enough.
float ServesUntil_m(const AvatarCosts& avatar, size_t mesh, const LevelQuery& query) {
  const float focal_px = static_cast<float>(query.screen_width_px) / (2 * std::tan(query.camera.fov_rad / 2));
  return avatar.height_m * focal_px / std::max(avatar.levels[mesh].switch_px, 1e-3f);
}

void ChooseMesh(const AvatarCosts& avatar, float away_m, const LevelQuery& query, ShownBird* bird) {
  size_t mesh = 0;
  while (mesh + 1 < avatar.levels.size() && away_m > ServesUntil_m(avatar, mesh, query)) ++mesh;
  bird->mesh = static_cast<int>(mesh);
  if (mesh + 1 == avatar.levels.size()) return;
  const float until_m = ServesUntil_m(avatar, mesh, query);
  bird->finer = std::clamp((until_m - away_m) / (kBand * until_m), 0.0f, 1.0f);
}

int TrianglesOf(const ShownBird& bird, const AvatarCosts& avatar) {
  const auto mesh = static_cast<size_t>(bird.mesh);
  int triangles = avatar.levels[mesh].triangles;
  if (bird.finer < 1) triangles += avatar.levels[mesh + 1].triangles;
  if (bird.casts_shadow) triangles += std::max(avatar.shadow.fine_triangles, 2 * avatar.shadow.coarse_triangles);
  return triangles;
}

// As far as all of them together fit.
float FittingReach_m(int64_t room, BirdLevels* birds) {
  std::sort(birds->nearest.begin(), birds->nearest.end());
  for (const auto& [away_m, triangles] : birds->nearest) {
    room -= triangles;
    if (room < 0) return away_m;
  }
  return kBirdReach_m;
}

}  // namespace

void ChooseBirds(const Town& town, const std::vector<AvatarCosts>& avatars, const LevelQuery& query, float eye_height_m,
                 float budget_triangles, float step_s, BirdLevels* birds) {
  birds->shown.clear();
  birds->nearest.clear();
  birds->triangles = 0;
  const Vec2 c = query.camera.position;
  const Vec3 eye{c.x, c.y, HeightAt(town.walkable, c) + eye_height_m};
  std::vector<float> away_m;
  for (size_t f = 0; f < town.flocks.size(); ++f) {
    const FlockState& flock = town.flocks[f];
    const AvatarCosts& avatar = avatars[static_cast<size_t>(flock.avatar)];
    for (size_t k = 0; k < flock.birds.size(); ++k) {
      const float away = Length(flock.birds[k].position - eye);
      if (away >= kBirdReach_m) continue;
      ShownBird bird{static_cast<int>(f), static_cast<int>(k)};
      bird.casts_shadow = away < kBirdShadow_m;
      ChooseMesh(avatar, away, query, &bird);
      birds->nearest.emplace_back(away, TrianglesOf(bird, avatar));
      birds->shown.push_back(bird);
      away_m.push_back(away);
    }
  }
  const auto room = static_cast<int64_t>(kBirdBudgetShare * budget_triangles);
  birds->reach_m = std::min(birds->reach_m + kRise_mps * step_s, FittingReach_m(room, birds));
  size_t kept = 0;
  for (size_t k = 0; k < birds->shown.size(); ++k) {
    if (away_m[k] >= birds->reach_m) continue;
    ShownBird bird = birds->shown[k];
    bird.share = std::min(1.0f, (birds->reach_m - away_m[k]) / (kFadeOut * birds->reach_m));
    birds->triangles +=
        TrianglesOf(bird, avatars[static_cast<size_t>(town.flocks[static_cast<size_t>(bird.flock)].avatar)]);
    birds->shown[kept++] = bird;
  }
  birds->shown.resize(kept);
}

}  // namespace flaneur
