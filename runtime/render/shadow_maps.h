// The sun's shadows around the eye: a wide map of the town, renewed bit by bit as eye and sun move, and a fine map of people,
// drawn in every picture. Internal to runtime/render.
#pragma once
#include "runtime/render/people_view.h"
#include "runtime/render/town_view.h"

namespace flaneur {

inline constexpr float kPeopleShadow_m = 28;  // half the width that the map of people covers

struct DepthMap { GLuint texture = 0, framebuffer = 0; int size_px = 0; };

struct ShadowMaps {
  DepthMap town[2], people;
  Mat4 town_matrix, next_town_matrix, people_matrix;
  int shown = 0;               // of town; the other one is being drawn
  size_t slices_done = 0;      // of the one being drawn
  Vec3 center, to_sun;         // of the newest map of the town
  bool valid = false;
};

void CreateShadowMaps(ShadowMaps* maps);
// eye, to_sun: glTF axes. Leaves the maps bound to their units; `block_buffer` is overwritten.
void UpdateShadowMaps(Vec3 eye, Vec3 to_sun, GLuint block_buffer, const TownView& town, const PeopleView& people, ShadowMaps* maps);

}  // namespace flaneur
