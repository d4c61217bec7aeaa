// Beyond the paper's camera obstacles: people see early where the visitor will look and choose another way, so that the
// number of high-resolution people stays at its limit without anybody being pushed (paper, section 7).
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "runtime/control/sectors.h"
#include "runtime/control/view_volumes.h"
#include "runtime/crowd/crowd.h"
#include "runtime/tour_data/settings.h"

namespace flaneur {

// Scratch, kept so that a steady step allocates nothing, and what is remembered of the camera.
struct ForesightState {
  static constexpr int kMoments = 11;  // looked at ahead, half a second apart
  static constexpr int kTurns = 3;     // of the moments, in which the visitor may look anywhere

  int64_t step = 0;
  int high_limit = 0;    // in force
  ViewMotion motion;     // of the camera, settled
  float speed_mps = 0;   // likewise
  float walks_on_s = 0;  // in a new direction, as far as it counts
  struct FutureView {
    Vec2 position, axis;
  };  // of the camera
  std::array<FutureView, kMoments> views{};
  float sine = 0, cosine = 1;                         // of half the field of view
  std::array<int, kMoments> seen{};                   // people within the view and r_high then
  std::array<Sectors<int>, kTurns> around{};          // people within r_high
  std::array<Sectors<int>, kTurns> excess{};          // people too many in the fullest view over the sector
  uint32_t overfull_moments = 0, overfull_turns = 0;  // a bit for each with too many people in some view
  struct Forecast {                                   // of one person
    uint32_t in_view = 0;                             // a bit for every moment
    std::array<int8_t, kTurns> sector{-1, -1, -1};    // none where they are out of reach then
  };
  std::vector<size_t> near;  // people who may come within r_high
  struct Lean {              // how somebody walks, relative to their own way
    float turn_rad = 0, pace = 1;

    bool operator==(const Lean&) const = default;
  };
  struct Choice {
    float gain = 0;
    int person = 0;
    Lean lean;
  };
  std::vector<Choice> choices;
  // What is remembered of somebody from step to step.
  struct Memory {
    int id = -1;
    Lean now, wanted;  // now comes nearer to wanted from step to step
    float left_s = 0;  // that it is wanted
  };
  std::vector<Memory> memory;  // by slot
};

// Every few steps: forecasts, with everybody going on as they do, how many people will be within r_high in view, and,
// for those out of view, how many there would be wherever the visitor turned. Where that comes near the limit, those
// who can keep out of it with the least change of speed and direction do so for a second: Crowd::detour. People in view
// change theirs little, people out of view as much as walking allows. high_limit: in force.
void Foresee(const ViewCamera& camera, const ViewMotion& motion, const Walkable& walkable,
             const ControlSettings& settings, int high_limit, Crowd* crowd, ForesightState* state);

}  // namespace flaneur
