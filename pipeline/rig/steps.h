// Where feet are set in a retargeted clip: rolling while they stand, swinging as the source's in between.
#pragma once
#include <array>
#include <vector>

#include "pipeline/rig/rig.h"

namespace flaneur {

// One foot's cycle, one entry a key of a clip.
struct FootTrack {
  std::vector<bool> stands;
  std::vector<Vec3> wanted;  // where the ankle would be as the source's is
  // Of the sole's points against the ankle, with the foot turned as it will be.
  std::vector<std::vector<Vec3>> sole;
};

// Velocity over the ground, units a second along +Z, of a walk on the spot, by its lowest points; 0: it does not walk.
float SpeedOfSoles(const std::vector<std::vector<Vec3>>& left, const std::vector<std::vector<Vec3>>& right,
                   float step_s, float leg);

// Keys at which a foot stands: low, and not moving over ground that goes back at `speed`.
std::vector<bool> FindStance(const std::vector<std::vector<Vec3>>& sole, float speed, float step_s, float leg,
                             bool loops);

// Lets the lower foot stand where neither does and one is low.
void StandSomewhere(const std::vector<std::vector<Vec3>>& left, const std::vector<std::vector<Vec3>>& right, float leg,
                    std::vector<bool>* left_stands, std::vector<bool>* right_stands);

// Where the ankle goes: while the foot stands, its lowest point stays on ground that moves backwards by `step_m` a key;
// in between the source's way, led over to both ends. Never below the ground, and
// clear of it in the middle of a swing.
std::vector<Vec3> RollFoot(const FootTrack& track, float step_m, float leg_m, bool loops);

}  // namespace flaneur
