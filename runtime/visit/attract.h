// The tour shows itself while nobody is there: a slow flight above people's heads from one of its stops to the next,
// and a look at what there is to see at each; where it has none, along the streets. For who likes less motion it goes
// from stop to stop at once, and looks straight there.
#pragma once
#include <optional>
#include <vector>

#include "runtime/base/random.h"
#include "runtime/simulation/simulation.h"
#include "runtime/walk/flight.h"

namespace flaneur {

struct Attract {
  std::vector<Vec2> stops;       // to go to one after the other; empty: anywhere
  std::vector<float> looks_rad;  // what there is to see at each
  size_t next = 0;
  Flight flight;      // no points: it rests
  float rests_s = 0;  // left, where it is
  float turn = 1;     // while it rests where there is nothing to look at: to the left, or -1 to the right
  float turns_radps = 0, rises_mps = 0;
  std::optional<float> look_rad;
  bool still = false;  // less motion
  bool leapt = false;  // in the last step
  Random random{1};
  WaySearch search;
};

// From where the camera is, to the nearest stop first. still: with less motion.
void BeginAttract(const Simulation& simulation, bool still, Attract* attract);

// What the camera does in the simulation's next step.
CameraInput NextOfAttract(const Simulation& simulation, Attract* attract);

}  // namespace flaneur
