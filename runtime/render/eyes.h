// Both eyes of a headset: what is chosen for a picture is chosen once, for a frustum that holds theirs. No OpenGL.
#pragma once
#include <vector>

#include "runtime/render/projection.h"

namespace flaneur {

// What an eye is to see, and where in the headset's picture. glTF axes.
struct EyePicture {
  Mat4 view_projection;
  Vec3 eye;
  int left_px = 0, bottom_px = 0, width_px = 0, height_px = 0;
};

// From which place, and which way, both eyes' pictures are chosen for. glTF axes.
struct EyesTogether {
  Mat4 view_projection;
  Vec3 eye, ahead;
  float focal_px = 1;  // pixels that a metre takes at a distance of one, in the middle of an eye's picture
};

// At least one eye, each with the perspective of a camera.
EyesTogether Together(const std::vector<EyePicture>& eyes, float near_m, float far_m);

}  // namespace flaneur
