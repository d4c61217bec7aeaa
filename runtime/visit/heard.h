// What is heard besides words, for whoever lets it sound.
#pragma once
#include <cstdint>
#include <vector>

#include "runtime/base/math.h"
#include "runtime/tour_data/visitor_data.h"

namespace flaneur {

// A sound to be made ready: the player's own, or a file's bytes.
struct Recording {
  SoundKind kind = SoundKind::kLoop;
  int variant = 0;
  const std::vector<uint8_t>* file = nullptr;  // null: Synthesize makes it
};

// In the ground's axes.
struct HeardSound {
  int source = 0;  // of what goes round: the same from picture to picture
  int recording = 0;
  Vec3 place;
  float gain = 0, pitch = 1;
};

struct Heard {
  Vec3 ear;
  float yaw_rad = 0;              // where the listener looks
  std::vector<HeardSound> round;  // sounds on and on
  std::vector<HeardSound> once;   // begins now
};

}  // namespace flaneur
