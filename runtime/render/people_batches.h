// Sorts the people of a picture into instanced draws and mixes their poses. Internal to runtime/render; no OpenGL.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "runtime/pack/tour_pack.h"
#include "runtime/render/frame.h"

namespace flaneur {

// A clip's skinning matrices as the upper three rows, joint by joint and frame by frame.
struct ClipRows { int frames = 1; std::vector<Vec4> rows; };

struct AvatarLayout {
  int joints = 0, levels = 0;
  std::array<ClipRows, 3> clips;  // by ClipKind
  PackImpostor impostor;
};

AvatarLayout LayoutOf(const PackAvatar& avatar);

// Of one person, as a mesh or as an impostor.
struct PersonInstance {
  Vec4 place;              // position in glTF axes, turn about the vertical
  Vec4 look;               // mesh: row of the poses; impostor: phases since its picture; share of the pattern from, to; and,
                           // impostor: how far between its two views
  // Of an impostor alone.
  Vec4 views;              // azimuths of its two views, sine and cosine of their elevation
  std::array<Vec4, 2> cells;  // their cells: left, top, right, bottom, in texels
  Vec4 origins;            // where in them the point between the feet is: x, y, x, y, in texels
  Vec4 window;             // what the two show together about that point: left, bottom, right, top, in metres
  Vec2 right;              // to the right on the ground, glTF's x and z
};

// One draw: instances first ... first + count - 1 of one avatar at one level (-1: impostor).
struct PeopleBatch { int avatar = 0, level = 0; bool fades = false; size_t first = 0, count = 0; };

struct PeopleBatches {
  std::vector<PersonInstance> instances;
  std::vector<PeopleBatch> seen;     // from the eye
  std::vector<PeopleBatch> shadows;  // from the sun, around the eye
  std::vector<Vec4> poses;           // pose_width texels a row
  size_t pose_width = 0, pose_rows = 0;

  struct Entry { PeopleBatch batch; PersonInstance instance; };
  std::vector<Entry> entries;        // scratch
  std::vector<PersonInstance> mesh_instances;
};

// eye, to_sun in glTF axes; shadow_reach_m: who is farther from the eye casts no shadow. pose_width of `out` must be set: three
// times the most joints.
void SortPeople(const std::vector<DrawnPerson>& people, const std::vector<AvatarLayout>& avatars, Vec3 eye, Vec3 to_sun,
                float shadow_reach_m, PeopleBatches* out);

}  // namespace flaneur
