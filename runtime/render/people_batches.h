// Sorts the people of a picture into instanced draws and mixes their poses. Internal to runtime/render; no OpenGL.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/pack/tour_pack.h"
#include "runtime/render/frame.h"
#include "runtime/render/occlusion.h"

namespace flaneur {

// A clip's skinning matrices as the upper three rows, joint by joint and frame by frame, in 16 bits: turns and scalings
// times AvatarLayout::turn_step, shifts times shift_step_m.
using PoseRow = std::array<int16_t, 4>;
struct ClipRows {
  int frames = 1;
  std::vector<PoseRow> rows;
};

struct AvatarLayout {
  int joints = 0, levels = 0, props = 0;
  float turn_step = 0, shift_step_m = 0;
  std::vector<ClipRows> clips;                     // by ClipKind,
  std::vector<int> impostor_clips;                 // and of the impostor's; -1: it has no pictures of that
  std::vector<int> first_shadow_row, shadow_rows;  // in the texture of poses for coarse shadows
  float height_m = 0, radius_m = 0;
  std::vector<float> switch_px;  // by level, PackLevel's
  PackImpostor impostor;         // without its pictures
  int first_cell = 0;            // of its cells in the texture of all cells
};

// Of the impostor's clips, by ClipKind; -1 without pictures of it. Without pictures of what else they do people stand.
std::vector<int> ImpostorClipsOf(const PackAvatar& avatar);

// Sets all but first_shadow_row and first_cell.
AvatarLayout LayoutOf(const PackAvatar& avatar);
size_t ClipBytes(const AvatarLayout& layout);  // what animating it takes

// Frames of a clip that coarse shadows know.
inline constexpr int kMaxShadowFrames = 24;
int ShadowFrame(const ClipRows& clip, int shadow_row, int shadow_rows);

// What can be drawn of an avatar: pictures and meshes may still be on their way.
struct AvatarReady {
  std::vector<bool> levels;  // behind them the props
  bool impostor = false, shadow = false;
};

// Of one person.
struct PersonInstance {
  Vec4 place;  // position in glTF axes, turn about the vertical
  Vec4 look;   // mesh: row of the poses; impostor: first cell of its picture; shadow: row of the poses, or of those for
              // coarse shadows; then share of the pattern from, to; and, impostor: phases since its picture, prop: 1 on
              // an impostor
  std::array<uint8_t, 4> tints{};  // DrawnPerson's, its breadth and size, as tint_choice.glsl reads them
};

// One draw: instances first ... first + count - 1 of one avatar at one level (-1: impostor; behind the last one: a
// prop).
struct PeopleBatch {
  int avatar = 0, level = 0;
  bool fades = false;
  size_t first = 0, count = 0;
};

struct PeopleBatches {
  std::vector<PersonInstance> instances;
  std::vector<PeopleBatch> seen;  // from the eye
  // From the sun, into people's fine map and into the coarse one; level: of the ShadowLevels.
  std::array<std::vector<PeopleBatch>, 2> shadows;
  PeopleBatch contacts;     // the shade about the feet of those near the eye
  std::vector<Vec4> poses;  // pose_width texels a row
  size_t pose_width = 0, pose_rows = 0;
  int hidden = 0;      // left out because the picture cannot show them
  int not_loaded = 0;  // drawn by another level than asked for, or not at all, because that is not loaded yet

  struct Entry {
    uint32_t person = 0;
    int key = 0, step = 0;
    bool on_impostor = false;
  };                           // of a prop
  std::vector<Entry> entries;  // scratch
  std::array<std::vector<Entry>, 2> shadow_entries;
  std::vector<PersonInstance> contact_instances;
  std::vector<size_t> counts;
  std::vector<int> pose_rows_of;  // by person: their row of the poses; -1: none yet
};

// From where people are seen, and what hides them. Without a map nothing does.
struct PeopleSight {
  Vec3 eye, to_sun;  // glTF axes; to_sun: unit
  Frustum frustum{};
  const OcclusionMap* walls = nullptr;
  float shadow_reach_m = 0;  // who is farther from the eye casts no shadow
  float focal_px = 0;  // of a coarse picture: pixels that a metre takes at a distance of one; 0: levels as they are
  float fine_shadow_m = 0;  // who is farther casts the shadow of a coarser figure, as does who is
  Frustum fine_map{};       // not wholly in this map; all zero: everybody is
  float contact_shade = 0;  // FrameInput's
};

// pose_width of `out` must be set: three times the most joints.
void SortPeople(const std::vector<DrawnPerson>& people, const std::vector<AvatarLayout>& avatars,
                const std::vector<AvatarReady>& ready, const PeopleSight& sight, PeopleBatches* out);

}  // namespace flaneur
