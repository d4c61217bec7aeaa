// Pseudo-random numbers that are the same on every machine.
#pragma once
#include <cstdint>

namespace flaneur {

// SplitMix64 (Steele, Lea and Flood 2014).
struct Random {
  uint64_t state = 0;

  uint64_t Next() {
    uint64_t z = (state += 0x9E3779B97F4A7C15ull);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
  }
  // In [0, 1).
  float Uniform() { return static_cast<float>(Next() >> 40) * 0x1p-24f; }
  float Uniform(float low, float high) { return low + (high - low) * Uniform(); }
  // In [0, count), count > 0.
  int Below(int count) { return static_cast<int>(Next() % static_cast<uint64_t>(count)); }
};

}  // namespace flaneur
