// What is known of an object while obstacles are extracted.
#pragma once
#include <vector>

#include "pipeline/footprint/polygon_sets.h"

namespace flaneur {

// An object's part in the band.
struct Shape {
  int lines = 0;
  int lost_triangles = 0;  // surely missing from faces of its shell
  Rings solid;
  std::vector<Segment> loose;  // walls without area
  double open_m = 0;           // length of walls beside nothing solid
  double ground_z_m = 0;       // in the middle
  bool guessed = false;        // a gap wider than those of an untidy model had to be closed
  bool open_shell = false;     // a building whose walls do not close, or had to be closed
};

}  // namespace flaneur
