// Where feet are set in a retargeted clip: rolling while they stand, swinging as the source's in between.
#pragma once
#include <array>
#include <vector>

#include "pipeline/rig/rig.h"

namespace flaneur {

// The points of one foot's sole, a list a key.
using Soles = std::vector<std::vector<Vec3>>;

// One foot's cycle, one entry a key of a clip.
struct FootTrack {
  std::vector<bool> stands;
  std::vector<Vec3> wanted;  // where the ankle would be as the source's is
  // Of the sole's points against the ankle, with the foot turned as it will be.
  std::vector<std::vector<Vec3>> sole;
  std::vector<float> lowest;  // of the whole foot against the ankle, likewise
};

// How high the ground is under one whose lowest points these are, one a key. Of who `walks`, so that a foot is always
// on it, it is what soles stand on in most keys: stylized walks dip heels and toes into it.
float GroundUnder(std::vector<float> lowest, float leg, bool walks);

// Velocity over the ground, units a second along +Z, of a walk on the spot, by its lowest points; 0: it does not walk.
float SpeedOfSoles(const Soles& left, const Soles& right, float step_s, float leg);

// What the lower sole moves over that ground while it is on it, as a share of `speed`, in the mean.
float SlideOfSoles(const Soles& left, const Soles& right, float step_s, float leg, float speed);

// Keys at which a foot stands: low, and not moving over ground that goes back at `speed`.
std::vector<bool> FindStance(const Soles& sole, float speed, float step_s, float leg, bool loops);

// Lets the lower foot stand where neither does and one is low; of who `walks`, however low it is, unless for so long
// that it is a flight, and each until the other does.
void StandSomewhere(const Soles& left, const Soles& right, float leg, bool walks, std::vector<bool>* left_stands,
                    std::vector<bool>* right_stands);

// Where the ankle goes: while the foot stands, its lowest point stays on ground that moves backwards by `step_m` a key;
// in between the source's way, led over to both ends. Never below the ground, and
// clear of it in the middle of a swing.
std::vector<Vec3> RollFoot(const FootTrack& track, float step_m, float leg_m, bool loops);

}  // namespace flaneur
