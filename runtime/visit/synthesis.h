// The player's own sounds, made by computing: nothing is recorded, and nobody else has rights in them.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "runtime/tour_data/visitor_data.h"

namespace flaneur {

inline constexpr int kSynthesisRate_hz = 24000;
inline constexpr int kVariants = 4;  // of steps and birds, so that none is heard twice in a row

// One channel. Murmur and water go round without a seam; steps, birds and bells end in silence. A loop has no sound of
// its own and is empty. The same call gives the same sound.
std::vector<int16_t> Synthesize(SoundKind kind, int variant = 0);

// The same a part at a time, some milliseconds each.
class Synthesis {
 public:
  explicit Synthesis(SoundKind kind, int variant = 0);
  Synthesis(Synthesis&&) noexcept;
  Synthesis& operator=(Synthesis&&) noexcept;
  ~Synthesis();
  bool GoOn(std::vector<int16_t>* sound);  // true: it is there

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

inline bool GoesRound(SoundKind kind) {
  return kind == SoundKind::kMurmur || kind == SoundKind::kWater || kind == SoundKind::kLoop;
}

}  // namespace flaneur
