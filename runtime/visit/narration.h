// What the guided tour says, to where sound goes.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "runtime/visit/shell.h"
#include "runtime/walk/guided_tour.h"

namespace flaneur {

// What the tour says where it rests now.
struct Narration {
  size_t stop = 0;
  int sound = -1, hotspot = -1;  // hotspot: whose sound it is; -1: the stop's
  float rested_s = 0;
};

// What somebody hears who looks at a hotspot; sound -1: nothing.
struct Aside {
  int hotspot = -1, sound = -1;
};

// Once a picture. holds: everything stands still. The aside is heard where the tour says nothing.
void Narrate(const GuidedTour& tour, const Aside& aside, bool holds, const std::vector<std::vector<uint8_t>>& sounds,
             Narration* last, SoundOutput* output);

}  // namespace flaneur
