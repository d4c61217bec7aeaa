// Keeping the number of high-resolution people down by moving people (paper, section 4.1), and beyond it.
#pragma once
#include <vector>

#include "runtime/control/foresight.h"
#include "runtime/control/level_control.h"

namespace flaneur {

enum class Adaptation { kOff, kPaper, kFull };

struct InfluenceSettings {
  Adaptation adaptation = Adaptation::kFull;
  int high_limit = 12;
  float r_high_m = 10, r_unimportant_m = 40;
  float r_personal_m = 0.6f;
  float step_s = 1.0f / 30;
};

// kPaper marks who avoids the camera and adds the camera obstacles: only low-resolution visible people nearer than r_unimportant
// avoid them, and only while the number of high ones is at its limit. kFull foresees instead, see foresight.h.
void InfluenceCrowd(const ViewCamera& camera, const ViewMotion& motion, const LevelState& levels,
                    const Walkable& walkable, const InfluenceSettings& settings, Crowd* crowd,
                    std::vector<MovingObstacle>* obstacles, ForesightState* foresight);

}  // namespace flaneur
