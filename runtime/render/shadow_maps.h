// The sun's shadows: of the town a fine map around the eye and a coarse one of all of it, renewed bit by bit as eye and
// sun move, and a fine map of the people ahead, drawn in every picture. Internal to runtime/render.
#pragma once
#include <array>

#include "runtime/render/people_view.h"
#include "runtime/render/town_view.h"

namespace flaneur {

inline constexpr float kPeopleShadow_m = 36;  // half the width that the map of people covers; it begins at the eye

// One map of the town: a layer that is shown; the next one is drawn into the layer that is spare.
struct TownMap {
  float half_width_m = 0, step_m = 0;  // step_m: drawn anew when the eye has gone so far
  int layer = 0;
  Mat4 matrix, next_matrix;
  bool draws = false;    // the next one
  size_t next_step = 0;  // of ShadowSteps: what is to be drawn still
  Vec3 center, to_sun;   // of the newest
  bool valid = false;
};

struct ShadowMaps {
  GLuint town_texture = 0, people_texture = 0, people_framebuffer = 0;
  std::array<GLuint, 3> town_framebuffers{};  // by layer
  TownMap near, far;
  int spare_layer = 2;
  Mat4 people_matrix;
};

void CreateShadowMaps(ShadowMaps* maps);
// After another town has come: all of it is drawn anew.
void ForgetTownShadows(ShadowMaps* maps);
// eye, ahead, to_sun: glTF axes. share: of the work that a picture usually does, for one that has less time. Both leave
// their map bound to its unit; `block_buffer` is overwritten.
DrawCost UpdateTownShadows(Vec3 eye, Vec3 to_sun, float share, GLuint block_buffer, const TownView& town,
                           ShadowMaps* maps);
DrawCost DrawPeopleShadows(Vec3 eye, Vec3 ahead, Vec3 to_sun, GLuint block_buffer, const PeopleView& people,
                           ShadowMaps* maps);

}  // namespace flaneur
