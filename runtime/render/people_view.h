// Draws people: skinned meshes near, impostors far. Internal to runtime/render.
#pragma once
#include <string>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/render/gl_objects.h"
#include "runtime/render/people_batches.h"
#include "runtime/render/textures.h"

namespace flaneur {

struct PersonRange { Surface surface; size_t first = 0; GLsizei count = 0; };  // of the level's indices
struct PersonLevel { GLuint vertex_array = 0; std::vector<PersonRange> ranges; int64_t triangles = 0; };

struct AvatarView {
  std::vector<PersonLevel> levels;
  GLuint albedo = 0, normals = 0, depth = 0, motion = 0;  // of the impostor
  Vec4 atlas;                      // texture coordinates a metre, size in texels
  Vec3 ranges;                     // of depth and of motion, in metres
};

struct PeopleView {
  GLuint programs[2][2] = {};      // [masked][fades]
  GLuint shadow_programs[2] = {};  // [masked]
  GLuint impostor_program = 0, impostor_shadow_program = 0;
  GLuint instances = 0, quad_array = 0, poses = 0;
  bool smooth_edges = false;       // of impostors, by the samples of a pixel
  size_t poses_held = 0;           // rows of the pose texture
  std::vector<AvatarView> avatars;
  std::vector<AvatarLayout> layouts;
  PeopleBatches batches;
};

// `defines`: of the lit programs. Errors: a shader that the driver refuses, more joints than a texture is wide.
Error CreatePeopleView(const TourPack& pack, const std::string& defines, const std::vector<Surface>& surfaces, PeopleView* people);

// Once a picture: instances and poses of people->batches, for both draws below.
void UploadPeople(PeopleView* people);
// Return the triangles drawn. The frame block must be bound.
int64_t DrawPeople(const PeopleView& people);
int64_t DrawPeopleShadow(const PeopleView& people);

}  // namespace flaneur
