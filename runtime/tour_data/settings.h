// The settings that travel from tour.toml through the pack to the player. Each is listed once, in VisitFields, with its
// range: what reads tour.toml, a scenario or a pack and what writes one all walk these lists, so that a name cannot
// differ between them.
#pragma once
#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <string>

#include "runtime/base/math.h"

namespace flaneur {

struct CrowdSettings {
  int people = 200;
  uint64_t seed = 1;
  float preferred_speed_mps = 1.3f, speed_spread_mps = 0.2f, top_speed_mps = 1.9f;
  float loiter_share = 0.15f;  // of the people, standing at loiter places at any time
  float group_share = 0.4f;    // of the people, who walk in groups of 2 to 4
  float work_share = 0.2f;     // of the people, at most, who are at places of work
};

// How the number of people in high resolution is limited: a fixed count, or what the frame time affords (paper,
// section 3.2).
enum class LimitMethod { kCount, kFrameTime };
inline constexpr std::initializer_list<const char*> kLimitMethodNames = {"count", "frame_time"};

// How people are kept out of the visitor's way (paper, section 4, and beyond it).
enum class Adaptation { kOff, kPaper, kFull };
inline constexpr std::initializer_list<const char*> kAdaptationNames = {"off", "paper", "full"};

struct ControlSettings {
  LimitMethod method = LimitMethod::kCount;
  Adaptation adaptation = Adaptation::kFull;
  // Who is in view is asked to change their way no more than people do on their own (1), or whatever the limit needs
  // (0). Where it cannot be kept unnoticed, fewer are in high resolution.
  float discretion = 1;
  int high_limit = 12;            // most people in high resolution, with LimitMethod::kCount
  float target_ms = 16.7f;        // of a frame, with LimitMethod::kFrameTime
  int budget_triangles = 200000;  // of all visible people together
  // Distances from the visitor (paper, section 3.2): nobody comes nearer than the first; nominally high resolution
  // within the second; paths are left alone beyond the third; nothing is drawn beyond the fourth.
  float r_personal_m = 0.6f, r_high_m = 10, r_unimportant_m = 40, r_far_m = 200;
  float fov_rad = kPi / 3;  // horizontal
  float step_hz = 30;       // steps of the simulation a second
  float max_yaw_rate_dps = 120, camera_speed_mps = 1.4f;
};

inline float Step_s(const ControlSettings& s) { return 1 / s.step_hz; }
inline float MaxYawRate_radps(const ControlSettings& s) { return s.max_yaw_rate_dps * kPi / 180; }

struct LightSettings {
  float sun_azimuth_rad = 0.75f * kPi, sun_elevation_rad = kPi / 4.5f;  // direction to the sun at the start
  float day_length_s = 600;  // time for the sun's way across the sky; 0: it stands still
  float exposure = 0;        // of the picture; 0: in tour.toml by how bright the town is, in a pack 1
};

struct WindSettings {
  float yaw_rad = kPi / 6;  // where it blows to, on the whole
  float speed_mps = 1;
};

// An enumeration as the text that stands in files; the names by value.
template <typename Enum>
const char* NameOf(Enum value, std::initializer_list<const char*> names) {
  return names.begin()[static_cast<size_t>(value)];
}
template <typename Enum>
void TakeNamed(const std::string& name, std::initializer_list<const char*> names, Enum* value) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) *value = static_cast<Enum>(found - names.begin());
}
template <typename Fields, typename Enum>
void VisitChoice(Fields&& fields, const char* key, std::initializer_list<const char*> names, Enum* value) {
  std::string name = NameOf(*value, names);
  fields.Choice(key, &name, names);
  TakeNamed(name, names, value);
}

// fields.Number(name, &value, least, most); fields.Angle(stem, &radians, least_deg, most_deg), which is STEM_deg in
// tour.toml and STEM_rad in the pack; fields.Choice(name, &text, {allowed, ...}).
template <typename Fields>
void VisitFields(Fields&& fields, CrowdSettings* s) {
  fields.Number("people", &s->people, 0, 200000);
  fields.Number("seed", &s->seed, 0, 4294967295.0);
  fields.Number("preferred_speed_mps", &s->preferred_speed_mps, 0.1, 5);
  fields.Number("speed_spread_mps", &s->speed_spread_mps, 0, 2);
  fields.Number("top_speed_mps", &s->top_speed_mps, 0.1, 10);
  fields.Number("loiter_share", &s->loiter_share, 0, 1);
  fields.Number("group_share", &s->group_share, 0, 1);
  fields.Number("work_share", &s->work_share, 0, 1);
}

template <typename Fields>
void VisitFields(Fields&& fields, ControlSettings* s) {
  VisitChoice(fields, "method", kLimitMethodNames, &s->method);
  VisitChoice(fields, "adaptation", kAdaptationNames, &s->adaptation);
  fields.Number("discretion", &s->discretion, 0, 1);
  fields.Number("high_limit", &s->high_limit, 0, 10000);
  fields.Number("target_ms", &s->target_ms, 1, 1000);
  fields.Number("budget_triangles", &s->budget_triangles, 1, 1e9);
  fields.Number("r_personal_m", &s->r_personal_m, 0, 10);
  fields.Number("r_high_m", &s->r_high_m, 0, 1000);
  fields.Number("r_unimportant_m", &s->r_unimportant_m, 0, 10000);
  fields.Number("r_far_m", &s->r_far_m, 1, 100000);
  fields.Angle("fov", &s->fov_rad, 10, 150);
  fields.Number("step_hz", &s->step_hz, 10, 240);
  fields.Number("max_yaw_rate_dps", &s->max_yaw_rate_dps, 1, 720);
  fields.Number("camera_speed_mps", &s->camera_speed_mps, 0, 20);
}

template <typename Fields>
void VisitFields(Fields&& fields, LightSettings* s) {
  fields.Angle("sun_azimuth", &s->sun_azimuth_rad, -360, 360);
  fields.Angle("sun_elevation", &s->sun_elevation_rad, 0, 90);
  fields.Number("day_length_s", &s->day_length_s, 0, 1e6);
  fields.Number("exposure", &s->exposure, 0, 4);
}

template <typename Fields>
void VisitFields(Fields&& fields, WindSettings* s) {
  fields.Angle("yaw", &s->yaw_rad, -360, 360);
  fields.Number("speed_mps", &s->speed_mps, 0, 10);
}

}  // namespace flaneur
