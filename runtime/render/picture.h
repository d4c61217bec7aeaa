// What is drawn into, and the finished picture. Internal to runtime/render.
#pragma once

#include "runtime/base/error.h"
#include "runtime/render/gl_objects.h"

namespace flaneur {

// With several samples a pixel edges are smoothed by resolving them; with one, by a pass over the picture. What is
// drawn more coarsely than the finished picture is smoothed as it is, then enlarged. A change of size or scale makes
// the targets anew.
struct Picture {
  int samples = 1, width_px = 0, height_px = 0;  // of the finished picture
  int averages = 1;                              // pictures that the finished one is the mean of, instead of smoothing
  int drawn_width_px = 0, drawn_height_px = 0;
  bool deferred = false;                         // light comes after the surfaces, in a pass over the picture
  GLuint color = 0, depth = 0, framebuffer = 0;  // drawn into; color is a texture where samples is 1
  GLuint normals = 0;                            // where deferred, and depth is a texture then
  GLuint lit_color = 0, lit = 0;                 // where deferred
  GLuint depth_copy = 0, depth_copy_target = 0;  // likewise, where depth cannot be looked up while it is drawn into
  GLuint coarse_color = 0, coarse = 0;           // smooth but not yet enlarged
  GLuint finished_color = 0, finished = 0;       // framebuffer of the finished picture; 0: the window's own
  bool finishes_beside = false;                  // finished is there for a headset alone
  GLuint window = 0;                             // the window's own, or a headset's,
  int left_px = 0, bottom_px = 0;                // and where in it the finished picture is
  Program light_program, smooth_program, sharpen_program, enlarge_program;
  GLuint empty_array = 0;
};

struct PictureOptions {
  int samples = 1;           // wished for; the driver may have fewer
  int averages = 1;          // more need one sample
  bool deferred = false;     // where the mode is; needs one sample
  bool onto_window = false;  // with one sample and without averages the picture is finished there
};
// Errors: a shader that the driver refuses.
Error CreatePicture(const PictureOptions& options, ShaderMode mode, Picture* picture);
// scale: FrameInput::resolution_scale.
void ResizePicture(int width_px, int height_px, float scale, Picture* picture);
// Whether the picture is finished beside the window's surface, as a part of a headset's has to be: shaders go by where
// in their picture a pixel is. Before ResizePicture.
void FinishBeside(bool beside, Picture* picture);
// Empties what is drawn into, and leaves it bound.
void BeginPicture(const Picture& picture);
// Lights the surfaces where that has been deferred, and leaves bound what the sky is drawn into. The frame block must
// be bound.
void LightPicture(const Picture& picture);
// Leaves the finished picture bound for drawing, all of it. average: which of the pictures this was, from 0.
void FinishPicture(int average, const Picture& picture);
// Onto the window's surface, where it is not finished there.
void PresentPicture(const Picture& picture);

}  // namespace flaneur
