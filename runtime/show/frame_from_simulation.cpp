#include "runtime/show/frame_from_simulation.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/crowd/fast_math.h"
#include "runtime/show/ground_mark.h"

namespace flaneur {
namespace {

constexpr float kStandsBelow_mps = 0.10f, kWalksAbove_mps = 0.18f;
constexpr float kLeaps_m = 2;    // whoever moves by more between two pictures was put there
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
  if (!s.visitor.tour.resting) return;
  const TourStop& stop = s.visitor.tour.stops[HaltOf(s.visitor.tour)];
  if (Length(stop.position_m - s.visitor.camera.view.position) > kReach_m) return;
  frame->caption = s.visitor.tour.words[HaltOf(s.visitor.tour)].caption;
  frame->caption_share = s.visitor.gentle ? 1 : std::clamp(std::min(s.visitor.tour.rested_s, RestOf_s(s.visitor.tour, HaltOf(s.visitor.tour)) - s.visitor.tour.rested_s) / kFadeCaption_s, 0.0f, 1.0f);
}

// The outer one with whoever reaches into the view.
ViewVolumes WithEdge(const ViewCamera& c) { return VolumesOf(c, kEdge_m / std::max(0.1f, std::sin(c.fov_rad / 2))); }

// What pictures until the next step can show: between the step before and the last one, and as the hand turns the view on.
using Views = std::array<ViewVolumes, 3>;

Views ViewsUntilNextStep(const Simulation& s, const PersonLooks& looks) {
  ViewCamera next = s.visitor.camera.view;
  next.yaw_rad = WrapAngle(next.yaw_rad + s.visitor.camera.yaw_rate_radps * Step_s(s));
  return {WithEdge(s.visitor.camera.view), WithEdge(looks.frame < 0 ? s.visitor.camera.view : looks.camera), WithEdge(next)};
}

// The level that the control has chosen. It leaves out who stands outside the view: whose middle is just beyond its edge keeps
// the level in which they left, or comes in as an impostor.
int LevelToShow(const Simulation& s, size_t i, const Views& views, const PersonLooks& looks) {
  const int chosen = s.control.levels.level[i];
  // Who is outside the outer view volume can't have been in view at the step before, nor be at the next.
  if (chosen != kNotDrawn || s.town.crowd.view[i] != ViewClass::kBoundary) return chosen;
  const auto hides = [&](const ViewVolumes& view) { return Classify(s.town.crowd.position[i], view) == ViewClass::kOutside; };
  if (std::all_of(views.begin(), views.end(), hides)) return kNotDrawn;
  const auto id = static_cast<size_t>(s.town.crowd.id[i]);
  return looks.is_shown[id] && looks.by_id[id].level != kNotDrawn ? looks.by_id[id].level : kImpostor;
}

ClipMoment MomentOf(const Simulation& s, size_t i, const PackAvatar& avatar, ClipKind last) {
  const float speed_mps = Length(s.town.crowd.velocity[i]);
  if (speed_mps > (last == ClipKind::kWalk ? kStandsBelow_mps : kWalksAbove_mps)) {
    // One clip's length of way for each turn of the walk, so that feet don't slide.
    const float cycle_m = avatar.walk_speed_mps * std::max(avatar.walk.duration_s, 0.1f);
    return {ClipKind::kWalk, Fraction(s.town.crowd.walked_m[i] / cycle_m)};
  }
  const bool talks = s.town.crowd.activity[i] == Activity::kTalking;
  const float own_time_s = static_cast<float>(s.town.step) * Step_s(s) + static_cast<float>(s.town.crowd.id[i] % 97) * 0.37f;
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

// The same person wears the same all day, and people who came one after the other, as those of a group, wear different colours.
std::array<uint8_t, 4> TintsOf(const PackAvatar& avatar, int id) {
  constexpr float kApart[] = {0.618034f, 0.754878f, 0.569840f};  // fractions whose multiples spread evenly (Roberts 2018)
  std::array<uint8_t, 4> tints{};
  for (size_t t = 0; t < std::min(avatar.tints.size(), kMaxTints); ++t) {
    const auto count = static_cast<float>(avatar.tints[t].colors.size() + 1);
    tints[t] = static_cast<uint8_t>(Fraction(static_cast<float>(id % 4096 + 1) * kApart[t]) * count);
  }
  return tints;
}

float Mix_rad(float a, float b, float share) { return WrapAngle(a + share * WrapAngle(b - a)); }

// The part of a person that is drawn with any level, and less of it the farther they are.
float PropsShare(const PersonLook& look, float done, float distance_m) {
  const float drawn = (look.level != kNotDrawn ? done : 0) + (look.last_level != kNotDrawn ? 1 - done : 0);
  return drawn * std::clamp((kPropReach_m - distance_m) / kPropFade_m, 0.0f, 1.0f);
}

void Show(const PersonLook& look, float share, FrameInput* frame) {
  DrawnPerson person;
  person.avatar = look.avatar;
  person.tints = look.tints;
  person.moment = {look.moment.clip, Fraction(look.moment.phase - (1 - share) * look.phase_step)};
  person.other = look.last_moment;
  person.other_share = std::max(0.0f, 1 - look.clip_s / kMix_s);
  person.position = look.before + (look.position - look.before) * share;
  person.heading_rad = Mix_rad(look.heading_before_rad, look.heading_rad, share);
  const float done = std::min(1.0f, look.level_s / kFade_s);
  person.casts_shadow = look.casts_shadow;
  person.props_share = PropsShare(look, done, Length(person.position - frame->eye));
  person.props = person.props_share > 0 ? look.props : 0;
  if (look.level != kNotDrawn && done > 0) {
    person.level = look.level;
    person.share_to = done;
    frame->people.push_back(person);
    person.props = 0;  // once is enough
  }
  if (look.last_level != kNotDrawn && done < 1) {
    person.level = look.last_level;
    person.share_from = done;
    person.share_to = 1;
    frame->people.push_back(person);
  }
}

void KeepIfShown(int id, PersonLooks* looks) {
  const PersonLook& look = looks->by_id[static_cast<size_t>(id)];
  const bool shown = look.level != kNotDrawn || (look.last_level != kNotDrawn && look.level_s < kFade_s);
  looks->is_shown[static_cast<size_t>(id)] = shown;
  if (shown) looks->shown.push_back(id);
}

// What is the same for everybody in one picture.
struct Moment {
  float passed_s = 0;               // since the last one
  Views views;
  ViewVolumes last_view;
};

void Move(Vec3 position, float heading_rad, bool leaps, PersonLook* look) {
  leaps = leaps || Length(position - look->position) > kLeaps_m;
  look->before = leaps ? position : look->position;
  look->heading_before_rad = leaps ? heading_rad : look->heading_rad;
  look->position = position;
  look->heading_rad = heading_rad;
}

// How far the same clip has gone on since.
float PhaseStep(const ClipMoment& before, const ClipMoment& now) {
  const float step = Fraction(now.phase - before.phase);
  return before.clip == now.clip && step < 0.5f ? step : 0;
}

void FollowPerson(const TourPack& pack, const Simulation& s, size_t i, const Moment& moment, PersonLooks* looks) {
  const auto id = static_cast<size_t>(s.town.crowd.id[i]);
  const Vec2 p = s.town.crowd.position[i];
  const int level = LevelToShow(s, i, moment.views, *looks);
  const bool was_shown = looks->is_shown[id];
  if (level == kNotDrawn && !was_shown) return;
  PersonLook& look = looks->by_id[id];
  look.here = true;
  look.casts_shadow = s.control.levels.casts_shadow[i] != 0;
  const bool first = looks->frame < 0, was_in_view = !first && Classify(p, moment.last_view) == ViewClass::kVisible;
  const bool anew = first || !was_shown;
  // Who comes into the picture with the view's edge, or leaves with it, needs no fading.
  const bool leaves_view = level == kNotDrawn && s.town.crowd.view[i] != ViewClass::kVisible;
  look.avatar = s.town.crowd.avatar[i];
  if (anew) look.tints = TintsOf(pack.avatars[static_cast<size_t>(look.avatar)], s.town.crowd.id[i]);
  Move({p.x, p.y, HeightAt(s.town.walkable, p)}, s.town.crowd.heading_rad[i], anew, &look);
  const ClipMoment before = look.moment;
  FollowClip(MomentOf(s, i, pack.avatars[static_cast<size_t>(look.avatar)], look.moment.clip), anew, moment.passed_s, &look);
  look.phase_step = anew ? 0 : PhaseStep(before, look.moment);
  look.props = id < s.control.levels.props.shown.size() ? s.control.levels.props.shown[id] : 0;
  const bool no_budget = id < s.control.levels.fades.at_once.size() && s.control.levels.fades.at_once[id] != 0;
  FollowLevel(level, leaves_view || no_budget || (anew && !was_in_view), moment.passed_s, &look);
  KeepIfShown(s.town.crowd.id[i], looks);
}

void FollowPeople(const TourPack& pack, const Simulation& s, PersonLooks* looks) {
  Moment moment;
  moment.passed_s = looks->frame < 0 ? 0 : static_cast<float>(s.town.step - looks->frame) * Step_s(s);
  moment.views = ViewsUntilNextStep(s, *looks);
  moment.last_view = VolumesOf(looks->camera, 0);
  looks->by_id.resize(std::max(looks->by_id.size(), static_cast<size_t>(s.town.crowd.next_id)));
  looks->is_shown.resize(looks->by_id.size());
  std::swap(looks->shown, looks->shown_before);
  looks->shown.clear();
  for (int id : looks->shown_before) looks->by_id[static_cast<size_t>(id)].here = false;
  for (size_t i = 0; i < s.town.crowd.size(); ++i) FollowPerson(pack, s, i, moment, looks);
  for (int id : looks->shown_before) {
    PersonLook& look = looks->by_id[static_cast<size_t>(id)];
    if (look.here) continue;
    look.casts_shadow = false;
    FollowLevel(kNotDrawn, false, moment.passed_s, &look);  // gone: fades where they were
    Move(look.position, look.heading_rad, true, &look);
    look.phase_step = 0;
    KeepIfShown(id, looks);
  }
}

// Everything on to the last step, from where the last picture before it stood.
void Follow(const TourPack& pack, const Simulation& s, PersonLooks* looks) {
  FollowPeople(pack, s, looks);
  const Vec2 c = s.visitor.camera.view.position;
  const EyeLook eye = {{c.x, c.y, HeightAt(s.town.walkable, c) + s.visitor.camera.eye_height_m}, s.visitor.camera.view.yaw_rad};
  const bool leaps = looks->frame < 0 || Length(eye.position - looks->eye.position) > kLeaps_m;
  looks->eye_before = leaps ? eye : looks->eye;
  looks->eye = eye;
  looks->steps = leaps ? 0 : s.town.step - looks->frame;
  looks->frame = s.town.step;
  looks->camera = s.visitor.camera.view;
}

}  // namespace

void FrameFromSimulation(const TourPack& pack, const Simulation& s, PersonLooks* looks, FrameInput* frame, const BetweenSteps& between) {
  if (s.town.step != looks->frame) Follow(pack, s, looks);
  const float share = looks->steps > 0 ? 1 - (1 - between.share) / static_cast<float>(looks->steps) : 1;
  frame->eye = looks->eye_before.position + (looks->eye.position - looks->eye_before.position) * share;
  // The way between the steps, but the hand's part of it at once.
  const float own_yaw_rad = WrapAngle(looks->eye.yaw_rad - between.turned_rad);
  frame->yaw_rad = WrapAngle(Mix_rad(looks->eye_before.yaw_rad, own_yaw_rad, share) + between.turned_rad + between.turn_rad);
  frame->pitch_rad = s.visitor.camera.pitch_rad + between.look_rad;
  frame->fov_rad = s.visitor.camera.view.fov_rad;
  const float time_s = static_cast<float>(s.town.step) * Step_s(s);
  frame->to_sun = s.hour ? SunAt(*s.hour + time_s / 3600) : ToSun(pack.light, time_s);
  frame->fine_shadow_m = s.control.levels.shadows.fine_m;
  frame->shadow_reach_m = s.control.levels.shadows.reach_m;
  AddCaption(s, frame);
  RingWherePointed(s, &frame->ground_mark);
  frame->people.clear();
  for (int id : looks->shown) Show(looks->by_id[static_cast<size_t>(id)], share, frame);
}

}  // namespace flaneur
