// Keeping the number of high-resolution people down by moving people (paper, section 4.1), and beyond it.
#pragma once
#include <vector>

#include "runtime/control/foresight.h"
#include "runtime/control/level_control.h"

namespace flaneur {

// kPaper marks who avoids the camera and adds the camera obstacles: only low-resolution visible people nearer than
// r_unimportant avoid them, and only while the number of high ones is at its limit. kFull foresees instead, see
// foresight.h.
void InfluenceCrowd(const ViewCamera& camera, const ViewMotion& motion, const LevelState& levels,
                    const Walkable& walkable, const ControlSettings& settings, Crowd* crowd,
                    std::vector<MovingObstacle>* obstacles, ForesightState* foresight);

}  // namespace flaneur
