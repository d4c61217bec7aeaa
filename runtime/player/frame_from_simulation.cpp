#include "runtime/player/frame_from_simulation.h"

#include <algorithm>
#include <cmath>

#include "runtime/player/ground_mark.h"

namespace flaneur {
namespace {

constexpr float kStandsBelow_mps = 0.10f, kWalksAbove_mps = 0.18f;
constexpr float kEdge_m = 0.8f;  // a body, skirts and shadow reach so far beyond its middle into the view

// The sun goes round by day_length_s a turn, and stays between its start height and a low evening.
Vec3 ToSun(const LightSettings& light, float time_s) {
  const float turn = light.day_length_s > 0 ? time_s / light.day_length_s : 0;
  const float azimuth = light.sun_azimuth_rad - 2 * kPi * turn;
  const float elevation = light.sun_elevation_rad * (0.75f + 0.25f * std::cos(2 * kPi * turn));
  return {std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation), std::sin(elevation)};
}

// Where the sun stands in early summer over the middle of Europe, by the hour of its own time: at 12 it is highest, in the south.
Vec3 SunAt(float hour) {
  constexpr float kLatitude_rad = 52 * kPi / 180, kDeclination_rad = 20 * kPi / 180;
  const float turned_rad = (hour - 12) * kPi / 12;
  const float sin_l = std::sin(kLatitude_rad), cos_l = std::cos(kLatitude_rad), sin_d = std::sin(kDeclination_rad), cos_d = std::cos(kDeclination_rad);
  return {-cos_d * std::sin(turned_rad), cos_l * sin_d - sin_l * cos_d * std::cos(turned_rad), sin_l * sin_d + cos_l * cos_d * std::cos(turned_rad)};
}

float Fraction(float x) { return x - std::floor(x); }

// A stop's caption shows while the tour rests there, and only to a visitor who has not walked off.
void AddCaption(const Simulation& s, FrameInput* frame) {
  constexpr float kFadeCaption_s = 0.4f, kReach_m = 2.5f;
  frame->caption.clear();
  if (!s.tour.resting) return;
  const TourStop& stop = s.tour.stops[HaltOf(s.tour)];
  if (Length(stop.position_m - s.camera.view.position) > kReach_m) return;
  frame->caption = s.tour.words[HaltOf(s.tour)].caption;
  frame->caption_share = s.gentle ? 1 : std::clamp(std::min(s.tour.rested_s, RestOf_s(s.tour, HaltOf(s.tour)) - s.tour.rested_s) / kFadeCaption_s, 0.0f, 1.0f);
}

// The outer one with whoever reaches into the view.
ViewVolumes WithEdge(const ViewCamera& c) { return VolumesOf(c, kEdge_m / std::max(0.1f, std::sin(c.fov_rad / 2))); }

// The level that the control has chosen. It leaves out who stands outside the view: whose middle is just beyond its edge keeps
// the level in which they left, or comes in as an impostor.
int LevelToShow(const Simulation& s, size_t i, const ViewVolumes& view, const PersonLook& look) {
  const int chosen = s.levels.level[i];
  if (chosen != kNotDrawn || s.crowd.view[i] == ViewClass::kVisible) return chosen;
  if (Classify(s.crowd.position[i], view) == ViewClass::kOutside) return kNotDrawn;
  return look.shown && look.level != kNotDrawn ? look.level : kImpostor;
}

ClipMoment MomentOf(const Simulation& s, size_t i, const PackAvatar& avatar, ClipKind last) {
  const float speed_mps = Length(s.crowd.velocity[i]);
  if (speed_mps > (last == ClipKind::kWalk ? kStandsBelow_mps : kWalksAbove_mps)) {
    // One clip's length of way for each turn of the walk, so that feet don't slide.
    const float cycle_m = avatar.walk_speed_mps * std::max(avatar.walk.duration_s, 0.1f);
    return {ClipKind::kWalk, Fraction(s.crowd.walked_m[i] / cycle_m)};
  }
  const bool talks = s.crowd.activity[i] == Activity::kTalking;
  const float own_time_s = static_cast<float>(s.frame) * s.step_s + static_cast<float>(s.crowd.id[i] % 97) * 0.37f;
  return {talks ? ClipKind::kTalk : ClipKind::kIdle,
          Fraction(own_time_s / std::max(talks ? avatar.talk.duration_s : avatar.idle.duration_s, 0.1f))};
}

// One change at a time: who changes again before the last is over has to wait for it.
void FollowClip(const ClipMoment& now, bool anew, float passed_s, PersonLook* look) {
  look->clip_s = anew ? kMix_s : look->clip_s + passed_s;
  if (anew || now.clip == look->moment.clip) {
    look->moment = now;
  } else if (look->clip_s >= kMix_s) {
    look->last_moment = look->moment;
    look->moment = now;
    look->clip_s = 0;
  }
}

void FollowLevel(int level, bool at_once, float passed_s, PersonLook* look) {
  look->level_s = at_once ? kFade_s : look->level_s + passed_s;
  if (at_once) {
    look->level = look->last_level = level;
  } else if (level != look->level && look->level_s >= kFade_s) {
    look->last_level = look->level;
    look->level = level;
    look->level_s = 0;
  }
}

void Show(const PersonLook& look, FrameInput* frame) {
  DrawnPerson person;
  person.avatar = look.avatar;
  person.moment = look.moment;
  person.other = look.last_moment;
  person.other_share = std::max(0.0f, 1 - look.clip_s / kMix_s);
  person.position = look.position;
  person.heading_rad = look.heading_rad;
  const float done = std::min(1.0f, look.level_s / kFade_s);
  if (look.level != kNotDrawn && done > 0) {
    person.level = look.level;
    person.share_to = done;
    frame->people.push_back(person);
  }
  if (look.last_level != kNotDrawn && done < 1) {
    person.level = look.last_level;
    person.share_from = done;
    person.share_to = 1;
    frame->people.push_back(person);
  }
}

bool IsShown(const PersonLook& look) {
  return look.level != kNotDrawn || (look.last_level != kNotDrawn && look.level_s < kFade_s);
}

// What is the same for everybody in one picture.
struct Moment {
  float passed_s = 0;               // since the last one
  ViewVolumes view, last_view;
};

void FollowPerson(const TourPack& pack, const Simulation& s, size_t i, const Moment& moment, PersonLooks* looks) {
  PersonLook& look = looks->by_id[static_cast<size_t>(s.crowd.id[i])];
  look.here = true;
  const Vec2 p = s.crowd.position[i];
  const int level = LevelToShow(s, i, moment.view, look);
  if (level == kNotDrawn && !look.shown) return;
  const bool first = looks->frame < 0, was_in_view = !first && Classify(p, moment.last_view) == ViewClass::kVisible;
  const bool anew = first || !look.shown;
  // Who comes into the picture with the view's edge, or leaves with it, needs no fading.
  const bool leaves_view = level == kNotDrawn && s.crowd.view[i] != ViewClass::kVisible;
  look.avatar = s.crowd.avatar[i];
  look.position = {p.x, p.y, HeightAt(s.walkable, p)};
  look.heading_rad = s.crowd.heading_rad[i];
  FollowClip(MomentOf(s, i, pack.avatars[static_cast<size_t>(look.avatar)], look.moment.clip), anew, moment.passed_s, &look);
  const auto id = static_cast<size_t>(s.crowd.id[i]);
  const bool no_budget = id < s.levels.fades.at_once.size() && s.levels.fades.at_once[id] != 0;
  FollowLevel(level, leaves_view || no_budget || (anew && !was_in_view), moment.passed_s, &look);
  look.shown = IsShown(look);
  if (look.shown) looks->shown.push_back(s.crowd.id[i]);
}

void FollowPeople(const TourPack& pack, const Simulation& s, PersonLooks* looks) {
  Moment moment;
  moment.passed_s = looks->frame < 0 ? 0 : static_cast<float>(s.frame - looks->frame) * s.step_s;
  moment.view = WithEdge(s.camera.view);
  moment.last_view = VolumesOf(looks->camera, 0);
  looks->by_id.resize(std::max(looks->by_id.size(), static_cast<size_t>(s.crowd.next_id)));
  std::swap(looks->shown, looks->shown_before);
  looks->shown.clear();
  for (int id : looks->shown_before) looks->by_id[static_cast<size_t>(id)].here = false;
  for (size_t i = 0; i < s.crowd.size(); ++i) FollowPerson(pack, s, i, moment, looks);
  for (int id : looks->shown_before) {
    PersonLook& look = looks->by_id[static_cast<size_t>(id)];
    if (look.here) continue;
    FollowLevel(kNotDrawn, false, moment.passed_s, &look);  // gone: fades where they were
    look.shown = IsShown(look);
    if (look.shown) looks->shown.push_back(id);
  }
  looks->frame = s.frame;
  looks->camera = s.camera.view;
}

}  // namespace

void FrameFromSimulation(const TourPack& pack, const Simulation& s, PersonLooks* looks, FrameInput* frame) {
  const Vec2 c = s.camera.view.position;
  frame->eye = {c.x, c.y, HeightAt(s.walkable, c) + s.camera.eye_height_m};
  frame->yaw_rad = s.camera.view.yaw_rad;
  frame->pitch_rad = s.camera.pitch_rad;
  frame->fov_rad = s.camera.view.fov_rad;
  const float time_s = static_cast<float>(s.frame) * s.step_s;
  frame->to_sun = s.hour ? SunAt(*s.hour + time_s / 3600) : ToSun(pack.light, time_s);
  AddCaption(s, frame);
  RingWherePointed(s, &frame->ground_mark);
  if (s.frame != looks->frame) FollowPeople(pack, s, looks);
  frame->people.clear();
  for (int id : looks->shown) Show(looks->by_id[static_cast<size_t>(id)], frame);
}

}  // namespace flaneur
