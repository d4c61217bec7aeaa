// Both eyes of a headset: what is chosen for a picture is chosen once, for a frustum that holds theirs. Internal to
// runtime/render; no OpenGL.
#pragma once
#include "runtime/render/frame.h"
#include "runtime/render/projection.h"

namespace flaneur {

// From which place, and which way, both eyes' pictures are chosen for. glTF axes.
struct EyesTogether {
  Mat4 view_projection;
  Vec3 eye, ahead;
  float focal_px = 1;  // pixels that a metre takes at a distance of one, in the middle of an eye's picture
};

// At least one eye, each with the perspective of a camera.
EyesTogether Together(const std::vector<EyePicture>& eyes, float near_m, float far_m);

}  // namespace flaneur
