// What is drawn into, and the finished picture. Internal to runtime/render.
#pragma once
#include "runtime/base/error.h"
#include "runtime/render/gl_objects.h"

namespace flaneur {

// With several samples a pixel edges are smoothed by resolving them; with one, by a pass over the picture.
struct Picture {
  int samples = 1, width_px = 0, height_px = 0;
  GLuint color = 0, depth = 0, framebuffer = 0;      // drawn into; color is a texture where samples is 1
  GLuint finished_color = 0, finished = 0;           // framebuffer of the finished picture
  GLuint smooth_program = 0, empty_array = 0;
};

// samples: wished for; the driver may have fewer. Errors: a shader that the driver refuses.
Error CreatePicture(int samples, Picture* picture);
void ResizePicture(int width_px, int height_px, Picture* picture);
// Leaves the finished picture bound for drawing.
void FinishPicture(const Picture& picture);

}  // namespace flaneur
