// A baked impostor atlas: orthographic pictures of a person, from every direction, at every phase of every clip.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/core/mesh.h"

namespace flaneur {

// A run of frames: the phases of one clip, evenly spaced over its duration.
struct ImpostorClip {
  std::string name;  // walk, idle, talk
  int first_frame = 0;
  int phases = 0;
};

// One picture in the atlas, cropped to the silhouette: a rectangle of texels from the upper left corner, and the texel corner at
// which the point between the feet is seen (it may lie outside). The rectangle's sides are multiples of 4.
struct ImpostorCell { int x = 0, y = 0, width = 0, height = 0, origin_x = 0, origin_y = 0; };

// cells: direction by direction, elevation by elevation, frame by frame. Direction d is seen from azimuth 2*pi*d/directions about
// the person, anticlockwise from above, from where they face. A texel is texel_m wide and high.
// Pictures: linear filtering wanted, gutters filled, alpha straight (not premultiplied).
struct ImpostorAtlas {
  int directions = 16;
  std::vector<float> elevations_deg{0};  // camera above the horizon
  int frames = 0;
  int width_px = 0, height_px = 0;       // multiples of 32
  float texel_m = 0;
  float depth_range_m = 0;   // depth 0..1 = -range..+range towards the camera from the axis
  float motion_range_m = 0;  // motion 0..1 = -range..+range
  float bend_range_m = 0;    // bend 0..1 = -range..+range
  std::vector<ImpostorClip> clips;
  std::vector<ImpostorCell> cells;
  Image albedo;  // PNG: sRGB albedo, alpha = coverage
  Image normal;  // PNG: linear, avatar-space normal * 0.5 + 0.5 (glTF axes), alpha = depth
  // The same for graphics cards, KTX2 with mip levels: albedo as above (BC7); the normal in the cell's own axes (right, up,
  // towards the camera) on half an octahedron (BC5); depth (BC4); and, at half the size, how far the surface moves to the right
  // and up from half a phase before to half a phase after, and how far to the right and up that way's middle lies (BC7).
  std::vector<uint8_t> albedo_ktx2, normal_ktx2, depth_ktx2, motion_ktx2;
};

inline size_t CellIndex(const ImpostorAtlas& atlas, int frame, size_t elevation, int direction) {
  return (static_cast<size_t>(frame) * atlas.elevations_deg.size() + elevation) * static_cast<size_t>(atlas.directions) +
         static_cast<size_t>(direction);
}

}  // namespace flaneur
