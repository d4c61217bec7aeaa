// How much two pictures of one person differ.
#pragma once
#include <cstdint>
#include <vector>

namespace flaneur {

// A person before the sky: what the visitor sees, and the normals with coverage. Both have the same size.
struct Portrait {
  int size_px = 0;               // width and height
  std::vector<uint8_t> rgba;     // lit
  std::vector<uint8_t> normals;  // * 0.5 + 0.5, times coverage; alpha: coverage
};

struct Likeness {
  double delta_e = 0;        // CIE 1976 dE*ab: mean over the pixels that both cover by half
  double delta_e_whole = 0;  // over the pixels that `full` covers by half: where the other misses them, against the sky
  double overlap = 0;        // intersection over union of those pixels
  double normal_deg = 0;     // mean angle over the pixels that both cover by half
};

// Both portraits must show somebody and have the same size; otherwise overlap is 0 and nothing else is meaningful.
Likeness Compare(const Portrait& full, const Portrait& other);

// dE*ab of two sRGB colours under D65. From the CIE's definition of L*a*b*.
double DeltaE(const uint8_t* rgb_a, const uint8_t* rgb_b);

}  // namespace flaneur
