// Keeping the number of high-resolution people down by moving people (paper, section 4.1), and beyond it.
#pragma once
#include <vector>

#include "runtime/control/level_control.h"

namespace flaneur {

enum class Adaptation { kOff, kPaper, kFull };

struct InfluenceSettings {
  Adaptation adaptation = Adaptation::kFull;
  int high_limit = 12;
  float r_high_m = 10, r_unimportant_m = 40;
};

// Marks who avoids the camera and how fast they walk, and adds the camera obstacles: two overlapping circles over the visible
// high-resolution area, the second over the edge towards which the camera turns. Only low-resolution visible people nearer than
// r_unimportant are affected, and only while the number of high ones is at its limit.
// kFull foresees instead: whoever would walk into the high-resolution area within the next seconds slows a little and turns
// aside early.
void InfluenceCrowd(const ViewCamera& camera, Vec2 camera_velocity, float yaw_rate_radps, const LevelState& levels,
                    const InfluenceSettings& settings, Crowd* crowd, std::vector<MovingObstacle>* obstacles);

}  // namespace flaneur
