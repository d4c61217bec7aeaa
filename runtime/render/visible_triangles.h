// Which triangles of the town a picture needs, where a look at one is cheaper than drawing it: in software. Internal to
// runtime/render; no OpenGL.
#pragma once
#include <array>

#include "runtime/render/occlusion.h"

namespace flaneur {

// The eye is clearly behind the triangle: what is looked at from its edge is left to OpenGL.
bool TurnsItsBack(const std::array<Vec3, 3>& corners, Vec3 eye);

// Of a picture with one sample a pixel, in whose middle.
struct TriangleSight {
  int width_px = 0, height_px = 0;
  const OcclusionMap* walls = nullptr;
};

// False only for triangles that reach the middle of no pixel or that walls hide, judged as in MayBeSeen. walls:
// finished.
bool MayBeSeen(const std::array<Vec3, 3>& corners, const TriangleSight& sight);

}  // namespace flaneur
