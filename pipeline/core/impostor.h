// A baked impostor atlas: one orthographic picture of the person for each (frame, direction).
#pragma once
#include <string>
#include <vector>

#include "pipeline/core/mesh.h"

namespace flaneur {

// A run of atlas rows: the phases of one clip, evenly spaced over its duration.
struct ImpostorClip {
  std::string name;  // walk, idle, talk
  int first_frame = 0;
  int phases = 0;
};

// Cell (direction d, frame f) is at column d, row f * elevations + e, row 0 at the top of the image. Direction d is seen from
// azimuth 2*pi*d/directions about the person, anticlockwise from above, from where they face; each cell is
// window_width_m x window_height_m, centred on the vertical axis, its lower edge at bottom_m.
// Both images: linear filtering wanted, gutters filled, alpha straight (not premultiplied).
struct ImpostorAtlas {
  int directions = 16;
  std::vector<float> elevations_deg{0};  // camera above the horizon
  int frames = 0;
  int cell_width_px = 0, cell_height_px = 0;
  float window_width_m = 0, window_height_m = 0, bottom_m = 0;
  float depth_range_m = 0;  // normal image's alpha: 0..1 = -range..+range towards the camera from the axis
  std::vector<ImpostorClip> clips;
  Image albedo;  // sRGB albedo, alpha = coverage; PNG
  Image normal;  // linear, avatar-space normal * 0.5 + 0.5 (glTF axes), alpha = depth; PNG
};

}  // namespace flaneur
