// What a tour says of its avatars, whatever their meshes and pictures are made of. Structs alone.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "runtime/base/math.h"

namespace flaneur {

inline constexpr size_t kMaxTints = 3;       // of an avatar
inline constexpr size_t kMaxTintColors = 8;  // of a tint, besides its own
inline constexpr float kMinTintReach = 0.01f;
inline constexpr float kMaxHeightSpread = 0.1f, kMaxBreadthSpread = 0.1f;

// People of one model wear their cloth in several colours, sRGB, 0 to 1 (runtime/pack/tint.h says how a cloth is
// known).
struct Tint {
  Vec3 color;                       // of the cloth in the avatar's own pictures
  float reach = 0.2f;               // kMinTintReach to 1: colours farther off than this are not dyed
  std::vector<Vec3> colors;         // in which others wear it; at least one
  std::vector<int> materials = {};  // of the pack, that alone it dyes; empty: all
  bool by_material = false;         // it is bound to some: what is dark there is its cloth in shadow
};

inline constexpr size_t kMaxProps = 7;  // of an avatar

// What some people of an avatar have: a mesh on the avatar's joints, drawn beside any of its levels and its impostor.
struct Prop {
  std::string name;    // of the node that shows it
  float share = 0.5f;  // of the people
  std::string slot;    // of those with the same one a person has one at most; empty: its own
  int triangles = 0;
  std::string clip = {};  // not empty: those alone have it who do this, and nothing else of the slot while they do
};

inline constexpr size_t kMaxOtherClips = 8;  // of an avatar, besides walk, idle and talk

// A run of frames of an impostor atlas: the phases of one clip, evenly spaced over its duration.
struct ImpostorClip {
  std::string name;  // walk, idle, talk, or one of the avatar's others
  int first_frame = 0, phases = 0;
};

// One picture in the atlas, cropped to the silhouette: a rectangle of texels from the upper left corner, and the texel
// corner at which the point between the feet is seen (it may lie outside). The rectangle's sides are multiples of 4.
struct ImpostorCell {
  int x = 0, y = 0, width = 0, height = 0, origin_x = 0, origin_y = 0;
};

// How an atlas is laid out. cells: frame by frame, elevation by elevation, direction by direction. Direction d is seen
// from azimuth 2 * pi * d / directions about the person, anticlockwise from above, from where they face. A texel is
// texel_m wide and high.
struct ImpostorLayout {
  int directions = 16;
  std::vector<float> elevations_deg{0};  // camera above the horizon
  int frames = 0;
  int width_px = 0, height_px = 0;  // multiples of 32
  float texel_m = 0;
  float depth_range_m = 0;   // depth 0..1 = -range..+range towards the camera from the axis
  float motion_range_m = 0;  // motion 0..1 = -range..+range
  float bend_range_m = 0;    // bend 0..1 = -range..+range
  std::vector<ImpostorClip> clips;
  std::vector<ImpostorCell> cells;
};

}  // namespace flaneur
