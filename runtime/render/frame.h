// What one picture shows, and what it cost. Ground axes (x east, y north, z up), metres, seconds, radians.
#pragma once
#include <cstdint>
#include <span>

#include "runtime/base/math.h"
#include "runtime/pack/tour_pack.h"

namespace flaneur {

inline constexpr int kDrawAsImpostor = -1;

enum class DrawnClip : uint8_t { kWalk, kIdle, kTalk };

struct DrawnPerson {
  int avatar = 0;                // index into TourPack::avatars
  int level = 0;                 // index into its levels, or kDrawAsImpostor
  DrawnClip clip = DrawnClip::kIdle;
  float phase = 0;               // of the clip, in [0, 1)
  Vec3 position_m;               // of the feet
  float heading_rad = 0;         // anticlockwise from +x
  float cover = 1;               // share of the pixels drawn, 0..1: below 1 while two levels cross-fade
  bool complement = false;       // the outgoing one of the two: draws the pixels that the other, with the same cover, leaves
  uint32_t seed = 0;             // slight variation of colour; the same for a person in every frame
};

struct FrameCamera {
  Vec3 position_m;               // of the eye
  float yaw_rad = 0, pitch_rad = 0;  // pitch above the horizon; never rolls
  float fov_rad = 1.0472f;       // horizontal
};

// Sun and sky, linear RGB; surfaces show albedo * (sun * cosine + sky).
struct FrameLight {
  Vec3 to_sun{0, 0, 1};          // unit
  Vec3 sun{3, 2.7f, 2.2f};
  Vec3 sky{0.55f, 0.68f, 0.95f}; // ambient light from above
  Vec3 ground{0.4f, 0.34f, 0.27f};  // and from below
  Vec3 zenith{0.2f, 0.38f, 0.75f}, horizon{0.85f, 0.82f, 0.75f};  // colours of the sky
};

struct FrameInput {
  FrameCamera camera;
  FrameLight light;
  float time_s = 0;              // moves clouds
  std::span<const DrawnPerson> people;
};

struct FrameStatistics {
  int64_t triangles_people = 0;  // as seen: impostors count two each, shadows none
  int64_t triangles_town = 0;    // after culling
  double draw_ms = 0;            // wall clock, until the picture is complete
};

// The sun starts where the settings say, in the afternoon, and circles clockwise (seen from above) through half a turn in
// day_length_s. It sinks towards the horizon and rises again but never sets, so that a tour can be long. The light's colours
// follow its elevation.
FrameLight LightAt(const LightSettings& settings, float time_s);

}  // namespace flaneur
