#include "runtime/control/crowd_influence.h"

#include <algorithm>
#include <cmath>

namespace flaneur {
namespace {

constexpr float kForesight_s = 4;      // people change their way this long before they would come near
constexpr float kCameraAhead_s = 1.5f; // where the visitor will be is guessed this far
constexpr float kSlower = 0.8f;        // within the spread of natural walking speeds

Vec2 Direction(float yaw_rad) { return {std::cos(yaw_rad), std::sin(yaw_rad)}; }

// Smallest distance to the center during the next seconds at constant velocities.
float ClosestApproach(Vec2 apart, Vec2 relative_velocity, float seconds) {
  const float speed2 = Dot(relative_velocity, relative_velocity);
  const float t = speed2 > 1e-6f ? std::clamp(-Dot(apart, relative_velocity) / speed2, 0.0f, seconds) : 0.0f;
  return Length(apart + relative_velocity * t);
}

}  // namespace

void InfluenceCrowd(const ViewCamera& camera, Vec2 camera_velocity, float yaw_rate_radps, const LevelState& levels,
                    const InfluenceSettings& s, Crowd* crowd, std::vector<MovingObstacle>* obstacles) {
  std::fill(crowd->avoids_camera.begin(), crowd->avoids_camera.end(), uint8_t{0});
  std::fill(crowd->pace.begin(), crowd->pace.end(), 1.0f);
  if (s.adaptation == Adaptation::kOff || levels.high < s.high_limit) return;

  const float r = s.r_high_m / 2;
  const Vec2 lead = s.adaptation == Adaptation::kFull ? camera_velocity * kCameraAhead_s : Vec2{};
  const float side = yaw_rate_radps >= 0 ? 1.0f : -1.0f;
  const Vec2 first = camera.position + lead + Direction(camera.yaw_rad) * r;
  const Vec2 second = camera.position + lead + Direction(camera.yaw_rad + side * camera.fov_rad / 2) * r;
  obstacles->push_back({first, r, false});
  obstacles->push_back({second, r, false});

  for (size_t i = 0; i < crowd->size(); ++i) {
    if (crowd->view[i] != ViewClass::kVisible || levels.level[i] >= 0) continue;
    const Vec2 apart = crowd->position[i] - camera.position;
    if (Length(apart) > s.r_unimportant_m) continue;
    if (s.adaptation == Adaptation::kPaper) {
      crowd->avoids_camera[i] = 1;
      continue;
    }
    const float nearest_m = ClosestApproach(crowd->position[i] - first, crowd->velocity[i] - camera_velocity, kForesight_s);
    if (nearest_m > r + 1) continue;
    crowd->avoids_camera[i] = 1;
    crowd->pace[i] = kSlower;
  }
}

}  // namespace flaneur
