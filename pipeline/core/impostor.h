// A baked impostor atlas: orthographic pictures of a person, from every direction, at every phase of every clip.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/core/mesh.h"
#include "runtime/tour_data/avatar_data.h"

namespace flaneur {

// Pictures: linear filtering wanted, gutters filled, alpha straight (not premultiplied).
struct ImpostorAtlas : ImpostorLayout {
  Image albedo;  // PNG: sRGB albedo, alpha = coverage
  Image normal;  // PNG: linear, avatar-space normal * 0.5 + 0.5 (glTF axes), alpha = depth
  // The same for graphics cards, KTX2 with mip levels: albedo as above (BC7); the normal in the cell's own axes (right,
  // up, towards the camera) on half an octahedron (BC5); depth (BC4); and, at half the size, how far the surface moves
  // to the right and up from half a phase before to half a phase after, and how far to the right and up that way's
  // middle lies (BC7).
  std::vector<uint8_t> albedo_ktx2, normal_ktx2, depth_ktx2, motion_ktx2;
  // Where tints are bound to materials: by channel how much of a texel the tint may dye. PNG, and BC7 at half the size.
  bool tint_regions = false;
  Image tints;
  std::vector<uint8_t> tints_ktx2;
};

inline size_t CellIndex(const ImpostorAtlas& atlas, int frame, size_t elevation, int direction) {
  return (static_cast<size_t>(frame) * atlas.elevations_deg.size() + elevation) *
             static_cast<size_t>(atlas.directions) +
         static_cast<size_t>(direction);
}

}  // namespace flaneur
