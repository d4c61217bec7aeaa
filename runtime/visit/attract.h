// The tour shows itself while nobody is there: a slow way from one of its stops to the next, and a look round at each;
// where it has none, along the streets. The camera keeps to where visitors can walk.
#pragma once
#include <optional>
#include <vector>

#include "runtime/base/random.h"
#include "runtime/simulation/simulation.h"

namespace flaneur {

struct Attract {
  std::vector<Vec2> stops;       // to go to one after the other; empty: anywhere
  std::vector<float> looks_rad;  // what there is to see at each
  size_t next = 0;
  bool on_the_way = false;
  float rests_s = 0;  // left, where it is
  float turn = 1;     // while it rests where there is nothing to look at: to the left, or -1 to the right
  std::optional<float> look_rad;
  Random random{1};
};

// From where the camera is, to the nearest stop first.
void BeginAttract(const Simulation& simulation, Attract* attract);

// What the camera does in the simulation's next step.
CameraInput NextOfAttract(const Simulation& simulation, Attract* attract);

}  // namespace flaneur
