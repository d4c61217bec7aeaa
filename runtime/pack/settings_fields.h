// The settings that travel from tour.toml through the pack to the player, listed once, with their ranges. Reader, writer and
// tour.toml's parser all walk these lists, so a name can't differ between them.
#pragma once
#include "runtime/pack/tour_pack.h"

namespace flaneur {

// fields.Number(name, &value, least, most); fields.Angle(stem, &radians, least_deg, most_deg), which is STEM_deg in tour.toml
// and STEM_rad in the pack; fields.Choice(name, &text, {allowed, ...}).
template <typename Fields>
void VisitFields(Fields&& fields, CrowdSettings* s) {
  fields.Number("people", &s->people, 0, 200000);
  fields.Number("seed", &s->seed, 0, 4294967295.0);
  fields.Number("preferred_speed_mps", &s->preferred_speed_mps, 0.1, 5);
  fields.Number("speed_spread_mps", &s->speed_spread_mps, 0, 2);
  fields.Number("top_speed_mps", &s->top_speed_mps, 0.1, 10);
  fields.Number("loiter_share", &s->loiter_share, 0, 1);
  fields.Number("group_share", &s->group_share, 0, 1);
}

template <typename Fields>
void VisitFields(Fields&& fields, ControlSettings* s) {
  fields.Choice("method", &s->method, {"count", "frame_time"});
  fields.Choice("adaptation", &s->adaptation, {"off", "paper", "full"});
  fields.Number("high_limit", &s->high_limit, 0, 10000);
  fields.Number("target_ms", &s->target_ms, 1, 1000);
  fields.Number("budget_triangles", &s->budget_triangles, 0, 1e9);
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
}

}  // namespace flaneur
