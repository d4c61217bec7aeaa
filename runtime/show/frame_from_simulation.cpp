#include "runtime/show/frame_from_simulation.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/crowd/fast_math.h"
#include "runtime/show/birds.h"
#include "runtime/show/ground_mark.h"
#include "runtime/show/hour.h"
#include "runtime/show/looks.h"
#include "runtime/show/smoke.h"
#include "runtime/show/turning_parts.h"

namespace flaneur {
namespace {

constexpr float kStandsBelow_mps = 0.10f, kWalksAbove_mps = 0.18f;
constexpr float kRunsAbove = 0.65f, kRunsBand = 0.15f;  // of a clip's speed: slower people walk
constexpr float kLeaps_m = 2;                           // whoever moves by more between two pictures was put there

// The sun goes round by day_length_s a turn, and stays between its start height and a low evening.
Vec3 ToSun(const LightSettings& light, float time_s) {
  const float turn = light.day_length_s > 0 ? time_s / light.day_length_s : 0;
  const float azimuth = light.sun_azimuth_rad - 2 * kPi * turn;
  const float elevation = light.sun_elevation_rad * (0.75f + 0.25f * std::cos(2 * kPi * turn));
  return {std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation), std::sin(elevation)};
}

// Where the sun stands in early summer over the middle of Europe, by the hour of its own time: at 12 it is highest, in
// the south.
Vec3 SunAt(float hour) {
  constexpr float kLatitude_rad = 52 * kPi / 180, kDeclination_rad = 20 * kPi / 180;
  const float turned_rad = (hour - 12) * kPi / 12;
  const float sin_l = std::sin(kLatitude_rad), cos_l = std::cos(kLatitude_rad), sin_d = std::sin(kDeclination_rad),
              cos_d = std::cos(kDeclination_rad);
  return {-cos_d * std::sin(turned_rad), cos_l * sin_d - sin_l * cos_d * std::cos(turned_rad),
          sin_l * sin_d + cos_l * cos_d * std::cos(turned_rad)};
}

// A stop's caption shows while the tour rests there, and only to a visitor who has not walked off.
void AddCaption(const Simulation& s, FrameInput* frame) {
  constexpr float kFadeCaption_s = 0.4f, kReach_m = 2.5f;
  frame->caption.clear();
  frame->caption_passed = -1;
  if (!s.visitor.tour.resting) return;
  const TourStop& stop = s.visitor.tour.stops[HaltOf(s.visitor.tour)];
  const float reach_m = s.visitor.comfort.captions_stay ? kHears_m : kReach_m;
  if (Length(stop.position_m - s.visitor.camera.view.position) > reach_m) return;
  const GuidedTour& tour = s.visitor.tour;
  const StopWords& words = tour.words[HaltOf(tour)];
  frame->caption = words.caption;
  frame->caption_passed = words.read_s > 0 ? std::min(1.0f, tour.rested_s / words.read_s) : -1;
  const float faded = std::min(tour.rested_s, words.rest_s - tour.rested_s) / kFadeCaption_s;
  frame->caption_share = s.visitor.gentle ? 1 : std::clamp(faded, 0.0f, 1.0f);
}

// Away from a guide who leads the visitor.
int SideOfCaption(const Simulation& s) {
  if (s.visitor.guide.id < 0 || !s.visitor.tour.follows || s.visitor.tour.over) return 0;
  return s.visitor.guide.is_left ? 1 : -1;
}

// With whom they stand, or, where the place says so, as their work.
bool Talks(const Simulation& s, size_t i) {
  const Activity activity = s.town.crowd.activity[i];
  if (activity != Activity::kWorking) return activity == Activity::kTalking;
  const WorkSpot& spot = s.town.work_spots[static_cast<size_t>(PlanOf(i, s.town).work)];
  return s.town.places[static_cast<size_t>(spot.place)].clip == "talk";
}

// step: how long theirs are, of the avatar's.
ClipMoment MomentOf(const Simulation& s, size_t i, const PackAvatar& avatar, float step, ClipKind last) {
  const float speed_mps = Length(s.town.crowd.velocity[i]);
  const int doing = s.town.crowd.doing[i];
  const PackOtherClip* other = doing >= 0 ? &avatar.other_clips[static_cast<size_t>(doing)] : nullptr;
  if (other != nullptr && other->speed_mps > 0 &&
      speed_mps > other->speed_mps * (last == OtherClip(doing) ? kRunsAbove - kRunsBand : kRunsAbove)) {
    const float cycle_m = step * other->speed_mps * std::max(other->clip.duration_s, 0.1f);
    return {OtherClip(doing), Fraction(s.town.crowd.walked_m[i] / cycle_m)};
  }
  if (speed_mps > (last == ClipKind::kWalk ? kStandsBelow_mps : kWalksAbove_mps)) {
    // One clip's length of way for each turn of the walk, so that feet don't slide: longer legs take longer steps.
    const float cycle_m = step * avatar.walk_speed_mps * std::max(avatar.walk.duration_s, 0.1f);
    return {ClipKind::kWalk, Fraction(s.town.crowd.walked_m[i] / cycle_m)};
  }
  const float own_time_s =
      static_cast<float>(s.town.step) * Step_s(s) + static_cast<float>(s.town.crowd.id[i] % 97) * 0.37f;
  const auto moment = [&](ClipKind kind, const PackClip& clip) {
    return ClipMoment{kind, Fraction(own_time_s / std::max(clip.duration_s, 0.1f))};
  };
  if (other != nullptr && other->speed_mps <= 0) return moment(OtherClip(doing), other->clip);
  if (Talks(s, i)) return moment(ClipKind::kTalk, avatar.talk);
  return moment(ClipKind::kIdle, avatar.idle);
}

// How far over the ground their feet are, who sit higher than their clip does.
float Lift_m(const Simulation& s, size_t i, const PackAvatar& avatar) {
  const int doing = s.town.crowd.doing[i];
  if (doing < 0) return 0;
  const int work = PlanOf(i, s.town).work;
  if (work < 0) return 0;
  const float seat_m = avatar.other_clips[static_cast<size_t>(doing)].seat_m;
  const WorkSpot& spot = s.town.work_spots[static_cast<size_t>(work)];
  const float wanted_m = s.town.places[static_cast<size_t>(spot.place)].seat_m;
  return seat_m > 0 && wanted_m > 0 ? wanted_m - seat_m : 0;
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

float Mix_rad(float a, float b, float share) { return WrapAngle(a + share * WrapAngle(b - a)); }

// The part of a person that is drawn with any level, and less of it the farther they are.
float PropsShare(const PersonLevel& level, float done, float distance_m) {
  const float drawn = (IsDrawn(level.level) ? done : 0) + (IsDrawn(level.from) ? 1 - done : 0);
  return drawn * std::clamp((kPropReach_m - distance_m) / kPropFade_m, 0.0f, 1.0f);
}

Vec2 SlopeAt(const Walkable& ground, Vec2 p) {
  constexpr float kAside_m = 0.25f;
  const auto rise = [&](Vec2 aside) {
    return (HeightAt(ground, p + aside) - HeightAt(ground, p - aside)) / (2 * kAside_m);
  };
  return {rise({kAside_m, 0}), rise({0, kAside_m})};
}

// before_s: how long before the last step.
void Show(const PersonLook& look, float share, float before_s, FrameInput* frame) {
  DrawnPerson person;
  person.avatar = look.avatar;
  person.tints = look.tints;
  person.size = look.size;
  person.breadth = look.breadth;
  person.moment = {look.moment.clip, Fraction(look.moment.phase - (1 - share) * look.phase_step)};
  person.other = look.last_moment;
  person.other_share = std::max(0.0f, 1 - look.clip_s / kMix_s);
  person.position = look.before + (look.position - look.before) * share;
  person.heading_rad = Mix_rad(look.heading_before_rad, look.heading_rad, share);
  const float done = ShareOf(look.level, before_s);
  person.slope = look.slope;
  person.lift_m = look.lift_m;
  person.casts_shadow = look.casts_shadow;
  person.props_share = PropsShare(look.level, done, Length(person.position - frame->eye));
  person.props = person.props_share > 0 ? look.props : 0;
  if (IsDrawn(look.level.level) && done > 0) {
    person.level = look.level.level;
    person.share_to = done;
    frame->people.push_back(person);
    person.props = 0;  // once is enough
  }
  if (IsDrawn(look.level.from) && done < 1) {
    person.level = look.level.from;
    person.share_from = done;
    person.share_to = 1;
    frame->people.push_back(person);
  }
}

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

void FollowPerson(const TourPack& pack, const Simulation& s, size_t i, float passed_s, PersonLooks* looks) {
  const Crowd& crowd = s.town.crowd;
  const LevelState& levels = s.control.levels;
  if (!IsDrawn(levels.people[i])) return;
  PersonLook& look = EntryOf(crowd.slot[i], crowd.id[i], &looks->people);
  const bool anew = looks->frame < 0 || look.frame != looks->frame;
  look.frame = s.town.step;
  look.avatar = crowd.avatar[i];
  look.level = levels.people[i];
  // A first picture, as a still is one, shows nobody halfway.
  if (looks->frame < 0) look.level = {look.level.level, kNotDrawn, kLongAgo_s};
  look.casts_shadow = levels.casts_shadow[i] != 0;
  look.props = ShownProps(levels.props, crowd.slot[i], crowd.id[i]);
  const PackAvatar& avatar = pack.avatars[static_cast<size_t>(look.avatar)];
  if (anew) {
    look.tints = TintsOf(avatar, crowd.id[i]);
    look.size = SizeOf(avatar, crowd.id[i]);
    look.breadth = BreadthOf(avatar, crowd.id[i]);
  }
  const Vec2 p = crowd.position[i];
  look.slope = SlopeAt(s.town.walkable, p);
  look.lift_m = Lift_m(s, i, avatar);
  Move({p.x, p.y, HeightAt(s.town.walkable, p) + look.lift_m}, crowd.heading_rad[i], anew, &look);
  const ClipMoment before = look.moment;
  FollowClip(MomentOf(s, i, avatar, look.size * look.breadth, look.moment.clip), anew, passed_s, &look);
  look.phase_step = anew ? 0 : PhaseStep(before, look.moment);
  looks->shown.push_back(crowd.slot[i]);
}

// Who has left the town fades where they were.
void FollowGone(const LevelState::Gone& gone, int64_t step, PersonLooks* looks) {
  PersonLook& look = EntryOf(gone.slot, gone.id, &looks->people);
  if (look.frame != looks->frame || looks->frame < 0) return;
  look.frame = step;
  look.level = gone.level;
  look.casts_shadow = false;
  Move(look.position, look.heading_rad, true, &look);
  look.phase_step = 0;
  looks->shown.push_back(gone.slot);
}

void FollowPeople(const TourPack& pack, const Simulation& s, PersonLooks* looks) {
  const float passed_s = looks->frame < 0 ? 0 : static_cast<float>(s.town.step - looks->frame) * Step_s(s);
  looks->shown.clear();
  for (size_t i = 0; i < s.town.crowd.size(); ++i) FollowPerson(pack, s, i, passed_s, looks);
  for (const LevelState::Gone& gone : s.control.levels.gone) FollowGone(gone, s.town.step, looks);
}

// Everything on to the last step, from where the last picture before it stood.
void Follow(const TourPack& pack, const Simulation& s, PersonLooks* looks) {
  FollowPeople(pack, s, looks);
  const Vec2 c = s.visitor.camera.view.position;
  const EyeLook eye = {{c.x, c.y, HeightAt(s.town.walkable, c) + s.visitor.camera.eye_height_m},
                       s.visitor.camera.view.yaw_rad};
  const bool leaps = looks->frame < 0 || Length(eye.position - looks->eye.position) > kLeaps_m;
  looks->eye_before = leaps ? eye : looks->eye;
  looks->eye = eye;
  looks->steps = leaps ? 0 : s.town.step - looks->frame;
  looks->frame = s.town.step;
}

}  // namespace

void FrameFromSimulation(const TourPack& pack, const Simulation& s, PersonLooks* looks, FrameInput* frame,
                         const BetweenSteps& between) {
  if (s.town.step != looks->frame) Follow(pack, s, looks);
  const float share = looks->steps > 0 ? 1 - (1 - between.share) / static_cast<float>(looks->steps) : 1;
  frame->eye = looks->eye_before.position + (looks->eye.position - looks->eye_before.position) * share;
  // The way between the steps, but the hand's part of it at once.
  const float own_yaw_rad = WrapAngle(looks->eye.yaw_rad - between.turned_rad);
  frame->yaw_rad =
      WrapAngle(Mix_rad(looks->eye_before.yaw_rad, own_yaw_rad, share) + between.turned_rad + between.turn_rad);
  frame->pitch_rad = s.visitor.camera.pitch_rad + between.look_rad;
  frame->fov_rad = s.visitor.camera.view.fov_rad;
  const float time_s = static_cast<float>(s.town.step) * Step_s(s);
  frame->exposure = pack.light.exposure > 0 ? pack.light.exposure : 1;
  frame->to_sun = s.hour ? SunAt(*s.hour + time_s / 3600) : ToSun(pack.light, time_s);
  frame->fine_shadow_m = s.control.levels.shadows.fine_m;
  frame->shadow_reach_m = s.control.levels.shadows.reach_m;
  AddCaption(s, frame);
  frame->caption_style.side = SideOfCaption(s);
  RingWherePointed(s, &frame->ground_mark);
  frame->people.clear();
  const float before_s = std::max(0.0f, 1 - between.share) * Step_s(s);
  for (int slot : looks->shown) Show(looks->people[static_cast<size_t>(slot)], share, before_s, frame);
  AddBirds(pack, s, between.share, frame);
  AddSmoke(pack, time_s - before_s, frame);
  TurnParts(pack, time_s - before_s, HourNow(s, frame->to_sun), frame);
}

}  // namespace flaneur
