// What one picture shows. Ground axes (x east, y north, z up), metres, radians.
#pragma once
#include <cstdint>
#include <vector>

#include "runtime/base/math.h"

namespace flaneur {

enum class ClipKind : uint8_t { kWalk, kIdle, kTalk };

struct DrawnPerson {
  int avatar = 0;
  int level = 0;           // of the mesh; -1: impostor
  ClipKind clip = ClipKind::kWalk;
  float phase = 0;         // of the clip, [0, 1)
  Vec3 position;           // of the feet
  float heading_rad = 0;   // where the person faces
};

struct FrameInput {
  Vec3 eye;
  float yaw_rad = 0, pitch_rad = 0, fov_rad = 1;  // horizontal
  Vec3 to_sun{0, 0, 1};    // unit
  std::vector<DrawnPerson> people;
};

struct FrameStatistics {
  int64_t town_triangles = 0, people_triangles = 0;
  double draw_ms = 0;
};

}  // namespace flaneur
