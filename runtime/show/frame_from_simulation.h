// What the simulation looks like now.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "runtime/control/level_control.h"
#include "runtime/pack/tour_pack.h"
#include "runtime/render/frame.h"
#include "runtime/simulation/simulation.h"

namespace flaneur {

// How a person was shown, so that nothing about them changes at once.
struct PersonLook {
  int id = -1;
  int64_t frame = -1;  // of the last picture that showed them
  int avatar = 0;
  PersonLevel level;
  bool casts_shadow = false;
  ClipMoment moment, last_moment;  // last_moment: where the clip before stopped
  float clip_s = 0;                // since the clip changed
  Vec3 position, before;           // before: where the picture stood before the last step
  Vec2 slope;                      // DrawnPerson's
  float lift_m = 0;                // likewise
  float heading_rad = 0, heading_before_rad = 0;
  float phase_step = 0;            // of the clip, since before
  std::array<uint8_t, 3> tints{};  // DrawnPerson's,
  float size = 1, breadth = 1;
  uint8_t props = 0;  // and these
};

struct EyeLook {
  Vec3 position;
  float yaw_rad = 0;
};

struct PersonLooks {
  std::vector<PersonLook> people;  // by Crowd::slot
  std::vector<int> shown;          // slots of whom the last picture shows
  int64_t frame = -1;              // of the last picture; -1: none yet
  EyeLook eye, eye_before;         // as people's positions
  int64_t steps = 0;               // between the two; 0: there is nothing before
};

// A moment between the last step and the one before it, so that pictures which come more often than steps, or out of
// time with them, move evenly.
struct BetweenSteps {
  float share = 1;       // of a step's time that has passed since the last one; 1: everything as it is after that step
  float turn_rad = 0;    // that the visitor's hand turned the view by and the simulation has still to do: shown at once
  float turned_rad = 0;  // the same that it has done since the picture before the last step
  float look_rad = 0;    // up, still to do
};

// Everybody is drawn by the control's LevelState::people and ::gone. A change of clip is mixed over kMix_s. The same
// moment seen twice gives the same picture.
inline constexpr float kMix_s = 0.2f;
void FrameFromSimulation(const TourPack& pack, const Simulation& simulation, PersonLooks* looks, FrameInput* frame,
                         const BetweenSteps& between = {});

}  // namespace flaneur
