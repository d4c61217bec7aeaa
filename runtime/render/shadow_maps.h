// The sun's shadows: of the town a fine map around the eye, a coarse one of all of it and, where that is too coarse to
// follow the fine one, one between, renewed bit by bit as eye and sun move, and of the people a fine map around the eye
// and a coarse one of those ahead, drawn in every picture. Internal to runtime/render.
#pragma once
#include <array>

#include "runtime/render/people_view.h"
#include "runtime/render/town_view.h"

namespace flaneur {

inline constexpr float kPeopleShadow_m =
    36;  // half the width that the coarse map of people covers; it begins at the eye
// Half the width of the fine one, and how far ahead of the eye its middle lies. A texel is 2 cm, since a foot is 10 cm
// wide.
inline constexpr float kFinePeople_m = 10, kFinePeopleAhead_m = 4;
inline constexpr int kPeopleMap_px = 1024;
inline constexpr float kPeopleTexels_m[] = {2 * kFinePeople_m / kPeopleMap_px, 2 * kPeopleShadow_m / kPeopleMap_px};

// One map of the town: a layer that is shown; the next one is drawn into a layer that is spare.
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
  GLuint town_texture = 0, people_texture = 0;
  std::array<GLuint, 5> town_framebuffers{};    // by layer
  TownMap near, middle, far;                    // no place lies in a middle one that is not needed
  int near_spare = 3, spare = 4;                // layers; the middle and the far map share one
  bool near_drew = false;                       // some of its next one, in the newest picture,
  bool others_wait = false;                     // for which another one waits:
  bool near_rests = false;                      // then it does so in the next
  std::array<GLuint, 2> people_framebuffers{};  // by layer: the fine and the coarse map
  std::array<Mat4, 2> people_matrices;
};

void CreateShadowMaps(ShadowMaps* maps);
// After another town has come: all of it is drawn anew.
void ForgetTownShadows(ShadowMaps* maps);
float Texel_m(const TownMap& map);
// eye, ahead, to_sun: glTF axes. Of people's fine and coarse map.
std::array<Mat4, 2> PeopleShadowMatrices(Vec3 eye, Vec3 ahead, Vec3 to_sun);
// share: of the work that a picture usually does, for one that has less time. Both leave
// their map bound to its unit; `block_buffer` is overwritten.
DrawCost UpdateTownShadows(Vec3 eye, Vec3 to_sun, float share, GLuint block_buffer, const TownView& town,
                           ShadowMaps* maps);
DrawCost DrawPeopleShadows(Vec3 eye, Vec3 ahead, Vec3 to_sun, GLuint block_buffer, const PeopleView& people,
                           ShadowMaps* maps);

}  // namespace flaneur
