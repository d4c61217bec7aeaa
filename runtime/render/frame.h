// What one picture shows. Ground axes (x east, y north, z up), metres, radians.
#pragma once
#include <array>
#include <cstdint>
#include <iterator>
#include <string>
#include <vector>

#include "runtime/base/math.h"
#include "runtime/tour_data/level.h"
#include "runtime/tour_data/shadow_limits.h"

namespace flaneur {

// And behind these the avatar's others.
enum class ClipKind : uint8_t { kWalk, kIdle, kTalk };
inline constexpr int kUsualClips = 3;
inline ClipKind OtherClip(int which) { return static_cast<ClipKind>(kUsualClips + which); }
inline bool IsOtherClip(ClipKind clip) { return static_cast<int>(clip) >= kUsualClips; }

struct ClipMoment {
  ClipKind clip = ClipKind::kWalk;
  float phase = 0;  // of the clip, [0, 1)
};

// Somebody who changes from one level to another stands twice in a frame, once with each level, with shares of a dither
// pattern that complement each other: [0, t) and [t, 1). Who appears or vanishes has [0, t) alone.
struct DrawnPerson {
  int avatar = 0;
  Level level = MeshLevel(0);
  ClipMoment moment;
  ClipMoment other;  // mixed in by other_share, where a walk ends or begins; an impostor shows the greater share alone
  float other_share = 0;
  Vec3 position;          // of the feet
  float heading_rad = 0;  // where the person faces
  float share_from = 0, share_to = 1;
  Vec2 slope;        // of the ground there: its rise a metre to the east and to the north
  float lift_m = 0;  // of the feet above the ground
  bool casts_shadow = true;
  uint8_t props = 0;               // bit k: the k-th of the avatar's is drawn too,
  float props_share = 1;           // [0, props_share) of the pattern
  std::array<uint8_t, 3> tints{};  // by tint of the avatar: 0 its own colour, k the k-th of its others
  float size = 1;                  // of the avatar's, 0.9 to 1.1,
  float breadth = 1;               // and across, of what the size makes it: 0.9 to 1.1
};

// A soft spot that turns to the eye.
struct SmokePuff {
  Vec3 position;
  float radius_m = 1, density = 0.5f;  // density: how much its middle hides, 0 to 1
  float turn_rad = 0;
};

struct CaptionStyle {
  std::string language;        // such as "ar"
  float size = 1;              // of its letters; 1: a twentieth of the picture's height
  bool high_contrast = false;  // yellow on black that nothing shines through
  int side = 0;                // -1, 1: on the picture's left or right, and the rest stays free; 0: all along it
  friend bool operator==(const CaptionStyle&, const CaptionStyle&) = default;
};

struct FrameInput {
  Vec3 eye;
  float yaw_rad = 0, pitch_rad = 0, fov_rad = 1;  // horizontal
  Vec3 to_sun{0, 0, 1};                           // unit
  float exposure = 1;                             // of all that the light falls on
  std::vector<DrawnPerson> people;
  // Who is farther from the eye casts the shadow of a coarser figure, and who is beyond the reach none. In a picture of
  // a smaller scale coarser figures begin nearer.
  float fine_shadow_m = kFineShadow_m, shadow_reach_m = kShadowReach_m;
  float contact_shade = 0.3f;    // of the light, that feet and walls keep from the ground about them
  std::vector<SmokePuff> smoke;  // farthest first
  // How each of the pack's turning parts has turned from where it is modelled, radians about its axis; of those beyond
  // the last: not at all.
  std::vector<float> turns_rad;
  std::vector<Vec3> ground_mark;  // a strip of triangles over the ground; empty: none
  std::string caption;            // UTF-8, at the foot of the picture; empty: none
  float caption_share = 1;        // how much of it is seen, 0 to 1
  // Of the time in which it is read, how much has passed, 0 to 1: of one that is too long for the picture the part that
  // is due is shown. Below 0: that isn't known.
  float caption_passed = -1;
  CaptionStyle caption_style;
  // Of the picture's width and height, 0.1 to 1: all but the caption is drawn so coarsely, and enlarged. Below 1 people
  // are drawn by the coarser levels that serve at that size.
  float resolution_scale = 1;
  // Of people, 0.1 to 1: their meshes are those that serve in a picture of this share of its resolution, and their
  // shadows end at this share of their reach.
  float detail = 1;
  bool keeps_levels = false;  // draws people by their levels even so
};

// The parts of a picture in the order in which they are drawn.
enum class DrawPass : uint8_t { kCull, kPeopleShadow, kTownShadow, kMeshes, kTown, kImpostors, kLight, kSky, kFinish };
inline constexpr const char* kDrawPassNames[] = {"cull, sort, upload",
                                                 "shadows of people",
                                                 "shadows of the town",
                                                 "people's meshes",
                                                 "town",
                                                 "impostors",
                                                 "light",
                                                 "sky, mark",
                                                 "smoothing, enlarging, caption"};

struct FrameStatistics {
  int64_t town_triangles = 0,
          people_triangles = 0;  // drawn into the picture, both levels of who changes; not the shadows
  int64_t shadow_triangles = 0, people_shadow_triangles = 0;  // of all, and of people alone
  float resolution_scale = 1;                                 // the frame's
  int draw_calls = 0;                                         // of the whole picture, shadows included
  int people_drawn = 0, people_hidden = 0;                    // hidden: behind walls or above or below the view
  int people_not_loaded = 0;  // drawn by another level than the frame's, or not at all, because that is not loaded yet
  double people_ms = 0;       // of it, on the CPU: choosing who can be seen, poses, the upload
  // Until the picture is there; with RenderOptions::runs_ahead until its commands are handed over or, if that is
  // longer, what the graphics card took over the picture before.
  double draw_ms = 0;
  std::array<double, std::size(kDrawPassNames)>
      pass_ms{};  // by DrawPass: processor time of all threads, with RenderOptions::time_passes
};

}  // namespace flaneur
