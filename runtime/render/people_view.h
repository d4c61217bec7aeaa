// Draws people: skinned meshes near, impostors far. Internal to runtime/render.
#pragma once
#include <vector>

#include "runtime/base/error.h"
#include "runtime/render/asset_content.h"
#include "runtime/render/gl_objects.h"
#include "runtime/render/people_batches.h"

namespace flaneur {

struct PersonMesh {
  GLuint vertex_array = 0;
  std::vector<PersonRange> ranges;
  int64_t triangles = 0;
};

struct AvatarView {
  std::vector<PersonMesh> levels;                         // behind them the props
  std::array<PersonMesh, 2> shadows;                      // as in ShadowLevels
  GLuint albedo = 0, normals = 0, depth = 0, motion = 0;  // of the impostor
  GLuint tint_regions = 0;                                // 0: its colours alone say what is dyed
  Vec4 atlas;                                             // texture coordinates a metre, size in texels
  Vec3 ranges;                                            // of depth, motion and its bend, in metres
  float directions = 1;
  std::array<Vec4, kMaxTints> tints{};                         // WithHalfLightness, 1 / reach squared; 0: none
  std::array<Vec4, kMaxTints * kMaxTintColors> tint_shifts{};  // from it to each of the others
  int impostor_of = -1;                                        // the avatar whose pictures these are; -1: its own
};

struct PeopleView {
  Program programs[2][2];  // [masked][fades]
  Program impostor_program, shadow_program;
  GLuint instances = 0, quad_array = 0, poses = 0, shadow_poses = 0, cells = 0;
  bool smooth_edges = false;  // of impostors, by the samples of a pixel
  size_t poses_held = 0;      // rows of the pose texture
  std::vector<AvatarView> avatars;
  std::vector<AvatarLayout> layouts;
  std::vector<AvatarReady> ready;
  std::vector<SurfaceGroup> groups;
  std::vector<GLuint> arrays;
  PeopleBatches batches;
  AtlasUpload upload;  // of the atlas that comes next
};

// Of the pack without its bulk. Errors: a shader that the driver refuses, more joints than a texture is wide.
Error CreatePeopleView(const TourPack& pack, ShaderMode mode, const SurfacePlan& plan,
                       const std::vector<GLuint>& arrays, PeopleView* people);
void AddLevel(int avatar, int level, const PersonGeometry& person, const ShadowLevels& shadows, PeopleView* people);
void ShowLevels(PeopleView* people);            // all that have been added, from now on
void AddAtlas(int avatar, PeopleView* people);  // the one that was uploaded

// What the people of a picture are drawn with, their shadows too, whether it is there or not.
std::vector<AssetId> AssetsFor(const std::vector<DrawnPerson>& drawn, const PeopleSight& sight,
                               const PeopleView& people);

// Attributes of the bound vertex array, from this batch's first instance on.
void BindInstances(GLuint buffer, const PeopleBatch& batch);
// Once a picture: instances and poses of people->batches, for both draws below.
void UploadPeople(PeopleView* people);
// The frame block must be bound.
DrawCost DrawPeople(const PeopleView& people, bool impostors);  // else the meshes
DrawCost DrawPeopleShadow(const PeopleView& people, const std::vector<PeopleBatch>& shadows);

}  // namespace flaneur
