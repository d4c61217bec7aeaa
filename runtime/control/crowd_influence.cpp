#include "runtime/control/crowd_influence.h"

#include <algorithm>
#include <cmath>

namespace flaneur {
namespace {

Vec2 Direction(float yaw_rad) { return {std::cos(yaw_rad), std::sin(yaw_rad)}; }

// Two overlapping circles over the visible high-resolution area, the second over the edge towards which the camera
// turns.
void AddCameraObstacles(const ViewCamera& camera, float yaw_rate_radps, const LevelState& levels,
                        const ControlSettings& s, Crowd* crowd, std::vector<MovingObstacle>* obstacles) {
  if (levels.high < levels.limit) return;
  const float r = s.r_high_m / 2;
  const float side = yaw_rate_radps >= 0 ? 1.0f : -1.0f;
  obstacles->push_back({camera.position + Direction(camera.yaw_rad) * r, r, false});
  obstacles->push_back({camera.position + Direction(camera.yaw_rad + side * camera.fov_rad / 2) * r, r, false});
  for (size_t i = 0; i < crowd->size(); ++i) {
    if (IsMesh(LevelInView(*crowd, levels, i))) continue;
    crowd->avoids_camera[i] =
        crowd->activity[i] != Activity::kWorking && Length(crowd->position[i] - camera.position) < s.r_unimportant_m;
  }
}

}  // namespace

void InfluenceCrowd(const ViewCamera& camera, const ViewMotion& motion, const LevelState& levels,
                    const Walkable& walkable, const ControlSettings& s, Crowd* crowd,
                    std::vector<MovingObstacle>* obstacles, ForesightState* foresight) {
  if (s.adaptation == Adaptation::kFull) {
    Foresee(camera, motion, walkable, s, levels.limit, crowd, foresight);
  } else if (s.adaptation == Adaptation::kPaper) {
    std::fill(crowd->avoids_camera.begin(), crowd->avoids_camera.end(), uint8_t{0});
    AddCameraObstacles(camera, motion.yaw_rate_radps, levels, s, crowd, obstacles);
  }
}

}  // namespace flaneur
