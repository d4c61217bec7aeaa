#include "runtime/render/shadow_maps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace flaneur {
namespace {

constexpr int kTownMap_px = 2048;
constexpr float kMaxFarHalfWidth_m = 400;  // half the width that the coarse map of the town covers
constexpr float kLeastNear_m = 20;         // of the fine one
// A finer map ends where the next coarser one has texels of so much of the distance.
constexpr float kTexelAtEnd = 1.0f / 300;
constexpr float kShadowDepth_m = 140;
constexpr float kFinePeopleDepth_m = 60;  // the longest shadows that reach from people in the fine map
constexpr float kNearStep = 8.0f / 55;    // of half a map's width: when the eye has gone so far it is drawn anew
constexpr float kSunStep = 0.004f;  // or when the sun has turned by so much, in radians: hardly a texel on the ground
constexpr float kSunJump = 0.3f;    // so much of a turn is not waited for,
// nor so many steps of the eye: they leave some of the near map before it, but nothing of the middle one, which the
// coarse one stands in for.
constexpr float kFarthestSteps = 5, kFarthestMiddleSteps = 13;
constexpr float kTrianglesAPicture = 10000;  // the work is spread over many pictures, so that no frame stumbles

void SetUpMap() {
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
}

GLuint NewFramebuffer() {
  GLuint framebuffer = 0;
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  const GLenum none = GL_NONE;
  glDrawBuffers(1, &none);
  return framebuffer;
}

void BindMap(GLuint framebuffer, int size_px, const Mat4& matrix, Vec3 to_sun, GLuint block_buffer, bool clear) {
  FrameBlock block{};
  block.to_sun = {to_sun.x, to_sun.y, to_sun.z, 0};
  block.view_projection = matrix;
  BindFrameBlock(block_buffer, block);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, size_px, size_px);
  if (clear) glClear(GL_DEPTH_BUFFER_BIT);
}

DrawCost DrawSome(int64_t triangles, GLuint block_buffer, const TownView& town, ShadowMaps* maps, TownMap* map) {
  int& spare = map == &maps->near ? maps->near_spare : maps->spare;
  BindMap(maps->town_framebuffers[static_cast<size_t>(spare)], kTownMap_px, map->next_matrix, map->to_sun, block_buffer,
          map->next_step == 0);
  const DrawCost cost = DrawTownShadow(map->next_matrix, triangles, town, &map->next_step);
  if (map->next_step < ShadowSteps(town)) return cost;
  map->draws = false;
  std::swap(map->layer, spare);
  map->matrix = map->next_matrix;
  return cost;
}

// A matrix that takes every place out of the map.
Mat4 Nowhere() {
  Mat4 matrix;
  matrix.m[0] = matrix.m[1] = matrix.m[2] = {0, 0, 0, 0};
  matrix.m[3] = {9, 9, 9, 1};
  return matrix;
}

void LeaveOut(TownMap* map) {
  map->valid = map->draws = false;
  map->matrix = Nowhere();
}

// One picture draws parts of one map only. The near one, which the eye leaves soonest, and the others take turns, and
// of those, which share a spare layer, one waits for the other.
bool Waits(const TownMap& map, ShadowMaps* maps) {
  if (&map == &maps->near) return maps->near_rests;
  maps->others_wait |= maps->near_drew;
  return maps->near_drew || (&map == &maps->middle ? maps->far : maps->middle).draws;
}

DrawCost UpdateTownMap(Vec3 center, Vec3 to_sun, float share, GLuint block_buffer, const TownView& town,
                       ShadowMaps* maps, TownMap* map) {
  const float moved_m = Length(center - map->center), turned = Length(to_sun - map->to_sun);
  const float steps = map == &maps->middle ? kFarthestMiddleSteps : kFarthestSteps;
  const bool jumped = !map->valid || moved_m > steps * map->step_m || turned > kSunJump;
  const bool due = jumped || map->draws || moved_m > map->step_m || turned > kSunStep;
  if (!due || (Waits(*map, maps) && !jumped)) return {};
  if (map == &maps->near) maps->near_drew = true;
  else (map == &maps->middle ? maps->far : maps->middle).next_step = 0;  // where this one takes the layer away
  if (jumped || !map->draws) {
    map->center = center;
    map->to_sun = to_sun;
    map->next_matrix = ShadowMatrix(center, to_sun, map->half_width_m,
                                    std::max(kShadowDepth_m, map->half_width_m * 1.5f), kTownMap_px);
    map->draws = true;
    map->next_step = 0;
  }
  map->valid = true;
  return DrawSome(jumped ? std::numeric_limits<int64_t>::max() : static_cast<int64_t>(share * kTrianglesAPicture),
                  block_buffer, town, maps, map);
}

}  // namespace

void CreateShadowMaps(ShadowMaps* maps) {
  glGenTextures(1, &maps->town_texture);
  glBindTexture(GL_TEXTURE_2D_ARRAY, maps->town_texture);
  glTexStorage3D(GL_TEXTURE_2D_ARRAY, 1, GL_DEPTH_COMPONENT16, kTownMap_px, kTownMap_px,
                 static_cast<GLsizei>(maps->town_framebuffers.size()));
  SetUpMap();
  for (size_t k = 0; k < maps->town_framebuffers.size(); ++k) {
    maps->town_framebuffers[k] = NewFramebuffer();
    glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, maps->town_texture, 0, static_cast<GLint>(k));
  }
  maps->middle.layer = 1;
  maps->far.layer = 2;
  glGenTextures(1, &maps->people_texture);
  glBindTexture(GL_TEXTURE_2D_ARRAY, maps->people_texture);
  glTexStorage3D(GL_TEXTURE_2D_ARRAY, 1, GL_DEPTH_COMPONENT16, kPeopleMap_px, kPeopleMap_px,
                 static_cast<GLsizei>(maps->people_framebuffers.size()));
  SetUpMap();
  for (size_t k = 0; k < maps->people_framebuffers.size(); ++k) {
    maps->people_framebuffers[k] = NewFramebuffer();
    glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, maps->people_texture, 0, static_cast<GLint>(k));
  }
}

float Texel_m(const TownMap& map) { return 2 * map.half_width_m / static_cast<float>(kTownMap_px); }

void ForgetTownShadows(ShadowMaps* maps) {
  for (TownMap* map : {&maps->near, &maps->middle, &maps->far}) map->valid = false;
}

DrawCost UpdateTownShadows(Vec3 eye, Vec3 to_sun, float share, GLuint block_buffer, const TownView& town,
                           ShadowMaps* maps) {
  glEnable(GL_DEPTH_TEST);
  // The coarse map stands still over a town that it covers, and else follows the eye.
  const Vec3 middle = (town.box.low + town.box.high) * 0.5f;
  const float reach_m = town.geometry.blocks.empty() ? 1 : Length(town.box.high - middle);
  const bool covered = reach_m <= kMaxFarHalfWidth_m;
  maps->far.half_width_m = covered ? reach_m : kMaxFarHalfWidth_m;
  maps->middle.half_width_m = std::max(Texel_m(maps->far) / kTexelAtEnd, kLeastNear_m);
  maps->near.half_width_m = std::max(Texel_m(maps->middle) / kTexelAtEnd, kLeastNear_m);
  for (TownMap* map : {&maps->near, &maps->middle}) map->step_m = kNearStep * map->half_width_m;
  maps->far.step_m = kMaxFarHalfWidth_m / 8;
  maps->near_rests = std::exchange(maps->near_drew, false) && std::exchange(maps->others_wait, false);
  const bool needs_middle = maps->middle.half_width_m > maps->near.half_width_m;
  if (!needs_middle) LeaveOut(&maps->middle);
  DrawCost cost;
  for (TownMap* map : {&maps->near, &maps->middle, &maps->far}) {
    if (map == &maps->middle && !needs_middle) continue;
    cost += UpdateTownMap(map == &maps->far && covered ? middle : eye, to_sun, share, block_buffer, town, maps, map);
  }
  BindTextureArray(kTownShadowUnit, maps->town_texture);
  return cost;
}

std::array<Mat4, 2> PeopleShadowMatrices(Vec3 eye, Vec3 ahead, Vec3 to_sun) {
  const Vec3 level_ahead = Normalized(Vec3{ahead.x, 0, ahead.z});
  return {
      ShadowMatrix(eye + level_ahead * kFinePeopleAhead_m, to_sun, kFinePeople_m, kFinePeopleDepth_m, kPeopleMap_px),
      ShadowMatrix(eye + level_ahead * (kPeopleShadow_m - 4), to_sun, kPeopleShadow_m, kShadowDepth_m, kPeopleMap_px)};
}

DrawCost DrawPeopleShadows(Vec3 eye, Vec3 ahead, Vec3 to_sun, GLuint block_buffer, const PeopleView& people,
                           ShadowMaps* maps) {
  maps->people_matrices = PeopleShadowMatrices(eye, ahead, to_sun);
  glEnable(GL_DEPTH_TEST);
  DrawCost cost;
  for (size_t k = 0; k < maps->people_matrices.size(); ++k) {
    BindMap(maps->people_framebuffers[k], kPeopleMap_px, maps->people_matrices[k], to_sun, block_buffer, true);
    cost += DrawPeopleShadow(people, people.batches.shadows[k]);
  }
  BindTextureArray(kPeopleShadowUnit, maps->people_texture);
  return cost;
}

}  // namespace flaneur
