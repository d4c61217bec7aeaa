#include "runtime/player/frame_from_simulation.h"

#include <cmath>

namespace flaneur {
namespace {

constexpr float kStandsBelow_mps = 0.12f;

// The sun goes round by day_length_s a turn, and stays between its start height and a low evening.
Vec3 ToSun(const LightSettings& light, float time_s) {
  const float turn = light.day_length_s > 0 ? time_s / light.day_length_s : 0;
  const float azimuth = light.sun_azimuth_rad - 2 * kPi * turn;
  const float elevation = light.sun_elevation_rad * (0.75f + 0.25f * std::cos(2 * kPi * turn));
  return {std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation), std::sin(elevation)};
}

float Fraction(float x) { return x - std::floor(x); }

}  // namespace

void FrameFromSimulation(const TourPack& pack, const Simulation& s, FrameInput* frame) {
  const float time_s = static_cast<float>(s.frame) * s.step_s;
  const Vec2 c = s.camera.view.position;
  frame->eye = {c.x, c.y, HeightAt(s.walkable, c) + s.camera.eye_height_m};
  frame->yaw_rad = s.camera.view.yaw_rad;
  frame->pitch_rad = s.camera.pitch_rad;
  frame->fov_rad = s.camera.view.fov_rad;
  frame->to_sun = ToSun(pack.light, time_s);
  frame->people.clear();
  for (size_t i = 0; i < s.crowd.size(); ++i) {
    if (s.levels.level[i] == kNotDrawn) continue;
    const PackAvatar& avatar = pack.avatars[static_cast<size_t>(s.crowd.avatar[i])];
    const Vec2 p = s.crowd.position[i];
    DrawnPerson person;
    person.avatar = s.crowd.avatar[i];
    person.level = s.levels.level[i];
    person.position = {p.x, p.y, HeightAt(s.walkable, p)};
    person.heading_rad = s.crowd.heading_rad[i];
    const float own_time_s = time_s + static_cast<float>(s.crowd.id[i] % 97) * 0.37f;
    if (Length(s.crowd.velocity[i]) > kStandsBelow_mps) {
      // One clip's length of way for each turn of the walk, so that feet don't slide.
      const float cycle_m = avatar.walk_speed_mps * std::max(avatar.walk.duration_s, 0.1f);
      person.moment.clip = ClipKind::kWalk;
      person.moment.phase = Fraction(s.crowd.walked_m[i] / cycle_m);
    } else {
      const bool talks = s.crowd.activity[i] == Activity::kTalking;
      person.moment.clip = talks ? ClipKind::kTalk : ClipKind::kIdle;
      person.moment.phase = Fraction(own_time_s / std::max(talks ? avatar.talk.duration_s : avatar.idle.duration_s, 0.1f));
    }
    frame->people.push_back(person);
  }
}

}  // namespace flaneur
