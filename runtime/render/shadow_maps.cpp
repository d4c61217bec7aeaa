#include "runtime/render/shadow_maps.h"

#include <cmath>

namespace flaneur {
namespace {

constexpr int kTownMap_px = 2048, kPeopleMap_px = 1024;
constexpr float kTownShadow_m = 60;      // half the width that the map of the town covers
constexpr float kShadowDepth_m = 140;
constexpr float kEyeStep_m = 8;          // the town's map is drawn anew when the eye has gone so far
constexpr float kJump_m = 25;            // farther than anybody walks meanwhile: draw it at once
constexpr float kSunStep = 0.004f;       // or when the sun has turned by so much, in radians: hardly a texel on the ground
constexpr size_t kSlices = 16;           // pictures over which that work is spread, so that no frame stumbles

DepthMap CreateDepthMap(int size_px) {
  DepthMap map;
  map.size_px = size_px;
  glGenTextures(1, &map.texture);
  glBindTexture(GL_TEXTURE_2D, map.texture);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, size_px, size_px, 0, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  glGenFramebuffers(1, &map.framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, map.framebuffer);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, map.texture, 0);
  const GLenum none = GL_NONE;
  glDrawBuffers(1, &none);
  return map;
}

void BindMap(const DepthMap& map, const Mat4& matrix, Vec3 to_sun, GLuint block_buffer, bool clear) {
  FrameBlock block{};
  block.to_sun = {to_sun.x, to_sun.y, to_sun.z, 0};
  block.view_projection = matrix;
  BindFrameBlock(block_buffer, block);
  glBindFramebuffer(GL_FRAMEBUFFER, map.framebuffer);
  glViewport(0, 0, map.size_px, map.size_px);
  if (clear) glClear(GL_DEPTH_BUFFER_BIT);
}

void DrawTownSlices(size_t count, GLuint block_buffer, const TownView& town, ShadowMaps* maps) {
  BindMap(maps->town[1 - maps->shown], maps->next_town_matrix, maps->to_sun, block_buffer, maps->slices_done == 0);
  for (; count > 0 && maps->slices_done < kSlices; --count, ++maps->slices_done) {
    DrawTownShadow(maps->next_town_matrix, maps->slices_done, kSlices, town);
  }
  if (maps->slices_done < kSlices) return;
  maps->shown = 1 - maps->shown;
  maps->town_matrix = maps->next_town_matrix;
}

void UpdateTownMap(Vec3 eye, Vec3 to_sun, GLuint block_buffer, const TownView& town, ShadowMaps* maps) {
  const bool jumped = !maps->valid || Length(eye - maps->center) > kJump_m || Length(to_sun - maps->to_sun) > 0.1f;
  const bool moved = Length(eye - maps->center) > kEyeStep_m || Length(to_sun - maps->to_sun) > kSunStep;
  if (jumped || (moved && maps->slices_done >= kSlices)) {
    maps->center = eye;
    maps->to_sun = to_sun;
    maps->next_town_matrix = ShadowMatrix(eye, to_sun, kTownShadow_m, kShadowDepth_m, kTownMap_px);
    maps->slices_done = 0;
  }
  if (maps->slices_done < kSlices) DrawTownSlices(jumped ? kSlices : 1, block_buffer, town, maps);
  maps->valid = true;
}

}  // namespace

void CreateShadowMaps(ShadowMaps* maps) {
  for (DepthMap& map : maps->town) map = CreateDepthMap(kTownMap_px);
  maps->people = CreateDepthMap(kPeopleMap_px);
  maps->slices_done = kSlices;
}

void UpdateShadowMaps(Vec3 eye, Vec3 to_sun, GLuint block_buffer, const TownView& town, const PeopleView& people, ShadowMaps* maps) {
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(2, 4);
  UpdateTownMap(eye, to_sun, block_buffer, town, maps);
  maps->people_matrix = ShadowMatrix(eye, to_sun, kPeopleShadow_m, kShadowDepth_m, kPeopleMap_px);
  BindMap(maps->people, maps->people_matrix, to_sun, block_buffer, true);
  DrawPeopleShadow(people);
  glDisable(GL_POLYGON_OFFSET_FILL);
  BindTexture(kTownShadowUnit, maps->town[maps->shown].texture);
  BindTexture(kPeopleShadowUnit, maps->people.texture);
}

}  // namespace flaneur
