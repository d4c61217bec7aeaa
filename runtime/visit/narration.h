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
  int sound = -1;
  float rested_s = 0;
};

// Once a picture. holds: everything stands still.
void Narrate(const GuidedTour& tour, bool holds, const std::vector<std::vector<uint8_t>>& sounds, Narration* last,
             SoundOutput* output);

}  // namespace flaneur
