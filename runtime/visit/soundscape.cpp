#include "runtime/visit/soundscape.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/base/array.h"
#include "runtime/show/hour.h"

namespace flaneur {
namespace {

constexpr float kNear_m = 2;          // as loud as it gets
constexpr float kBehindWalls = 0.4f;  // of the loudness
constexpr float kFollows_s = 0.6f;    // loudness follows that slowly
constexpr float kWhileSpoken = 0.35f, kWhileHeld = 0.25f;
constexpr float kStepsNear_m = 9, kStep_m = 0.7f;  // heard so far; the visitor's
constexpr size_t kMostWalkers = 6;
constexpr float kStepGain = 0.5f, kOwnStepGain = 0.3f, kGrassGain = 0.45f;
constexpr float kMurmurNear_m = 16, kMurmurGain = 0.3f, kMurmurPeople = 12;  // so many talking beside one: full
constexpr float kWalkerTalks = 0.3f;  // of what somebody who stands and talks adds
constexpr float kMostBirds = 6, kBirdsApart_m = 22, kBirdsHeard_m = 45, kBirdsUp_m = 6, kBirdGain = 0.5f;
constexpr float kDaylight = 0.08f;  // sine of the sun's elevation above which birds sing
constexpr float kStroke_s = 1.6f, kMostJump_h = 0.2f;
constexpr float kShortHour_s = 240;  // hours that pass faster are struck once, and not all of them

float Chance(Soundscape* s, float low, float high) {
  s->chance = s->chance * 6364136223846793005ull + 1442695040888963407ull;
  return low + (high - low) * static_cast<float>(s->chance >> 40) / 16777216.0f;
}

float Falloff(float far_m, float radius_m) {
  if (far_m >= radius_m) return 0;
  const float share = far_m / radius_m;
  return std::min(1.0f, kNear_m / std::max(far_m, 0.1f)) * (1 - share * share);
}

// What the tour says of steps or murmur, which have no place; null: nothing.
const SoundPlace* SayingOf(const Soundscape& s, SoundKind kind) {
  const auto found = std::find_if(s.places.begin(), s.places.end(), [&](const auto& p) { return p.kind == kind; });
  return found == s.places.end() ? nullptr : &*found;
}

int RecordingOf(const Soundscape& s, SoundKind kind, int variant) {
  for (size_t k = 0; k < s.places.size(); ++k) {
    if (s.places[k].kind != kind) continue;
    return s.places[k].sound >= 0 ? s.first_of[k] : s.first_of[k] + variant;
  }
  return -1;
}

bool HasOwn(const std::vector<SoundPlace>& places, SoundKind kind) {
  return std::any_of(places.begin(), places.end(), [&](const auto& p) { return p.kind == kind; });
}

// Over grass, well apart.
void AddBirds(const Walkable& w, std::vector<SoundPlace>* places) {
  const GroundRaster& g = *w.ground;
  const int stride = std::max(1, static_cast<int>(kBirdsApart_m / 4 / g.cell_m));
  std::vector<Vec2> found;
  for (int row = 0; row < g.rows; row += stride) {
    for (int column = 0; column < g.columns; column += stride) {
      const size_t cell = static_cast<size_t>(row) * static_cast<size_t>(g.columns) + static_cast<size_t>(column);
      if (g.kind[cell] != 4) continue;
      const Vec2 p = g.min_m + Vec2{static_cast<float>(column) + 0.5f, static_cast<float>(row) + 0.5f} * g.cell_m;
      const bool apart =
          std::none_of(found.begin(), found.end(), [&](Vec2 o) { return Length(o - p) < kBirdsApart_m; });
      if (apart && static_cast<float>(found.size()) < kMostBirds) found.push_back(p);
    }
  }
  for (const Vec2& p : found) places->push_back({SoundKind::kBirds, p, kBirdsUp_m, kBirdsHeard_m, kBirdGain, -1});
}

Vec3 PlaceOf(const SoundPlace& place, const Walkable& w) {
  const float ground_m = OnGround(w, place.position_m) ? HeightAt(w, place.position_m) : 0;
  return {place.position_m.x, place.position_m.y, ground_m + place.height_m};
}

Vec2 Flat(Vec3 p) { return {p.x, p.y}; }

float GroundGain(const Walkable& w, Vec2 p) {
  const GroundRaster& g = *w.ground;
  const int column = static_cast<int>(std::floor((p.x - g.min_m.x) / g.cell_m));
  const int row = static_cast<int>(std::floor((p.y - g.min_m.y) / g.cell_m));
  if (column < 0 || row < 0 || column >= g.columns || row >= g.rows) return 1;
  return g.kind[static_cast<size_t>(row) * static_cast<size_t>(g.columns) + static_cast<size_t>(column)] == 4
             ? kGrassGain
             : 1;
}

void Step(Vec2 at, float height_m, float gain, const Walkable& w, Soundscape* s) {
  const SoundPlace* saying = SayingOf(*s, SoundKind::kSteps);
  gain *= GroundGain(w, at) * (saying == nullptr ? 1 : saying->volume);
  const int variant = static_cast<int>(Chance(s, 0, kVariants - 0.01f));
  if (gain > 0.005f)
    s->heard.once.push_back({0,
                             RecordingOf(*s, SoundKind::kSteps, variant),
                             {at.x, at.y, height_m},
                             gain * s->loud,
                             Chance(s, 0.9f, 1.1f)});
}

// A foot comes down twice in a walk cycle, whose way the clip knows.
void HearWalkers(const TourPack& pack, const Simulation& sim, Soundscape* s) {
  const Crowd& crowd = sim.town.crowd;
  const Vec2 ear = Flat(s->heard.ear);
  std::vector<std::pair<float, size_t>> near;
  for (size_t i = 0; i < crowd.size(); ++i) {
    const float far_m = Length(crowd.position[i] - ear);
    if (far_m < kStepsNear_m) near.emplace_back(far_m, i);
  }
  std::sort(near.begin(), near.end());
  if (near.size() > kMostWalkers) near.resize(kMostWalkers);
  std::vector<Soundscape::Walker> walkers;
  for (const auto& [far_m, i] : near) {
    const auto avatar = static_cast<size_t>(crowd.avatar[i]);
    const bool known = avatar < pack.avatars.size();
    const float cycle_m = known ? pack.avatars[avatar].walk.duration_s * pack.avatars[avatar].walk_speed_mps : 0;
    const int steps = static_cast<int>(crowd.walked_m[i] / (cycle_m > 0.2f ? cycle_m / 2 : kStep_m));
    const auto before = std::find_if(s->walkers.begin(), s->walkers.end(),
                                     [&, id = crowd.id[i]](const auto& walker) { return walker.id == id; });
    if (before != s->walkers.end() && steps > before->steps)
      Step(crowd.position[i], HeightAt(sim.town.walkable, crowd.position[i]), kStepGain * Falloff(far_m, kStepsNear_m),
           sim.town.walkable, s);
    walkers.push_back({crowd.id[i], steps});
  }
  s->walkers = std::move(walkers);
}

void HearOwnSteps(const Simulation& sim, float passed_s, Soundscape* s) {
  if (!sim.visitor.camera.flies) s->walked_m += sim.visitor.camera.actual_mps * passed_s;
  const int steps = static_cast<int>(s->walked_m / kStep_m);
  if (steps == s->own_steps) return;
  s->own_steps = steps;
  const Vec2 at = sim.visitor.camera.view.position;
  Step(at, s->heard.ear.z - 1.6f, kOwnStepGain, sim.town.walkable, s);
}

// From three sides, each as loud as there are people near and inclined to talk.
void HearMurmur(const Simulation& sim, float follows, Soundscape* s) {
  const Crowd& crowd = sim.town.crowd;
  const Vec2 ear = Flat(s->heard.ear);
  std::array<float, 3> people{};
  std::array<Vec2, 3> middle{};
  for (size_t i = 0; i < crowd.size(); ++i) {
    const Vec2 off = crowd.position[i] - ear;
    const float far_m = Length(off);
    if (far_m > kMurmurNear_m) continue;
    const float talks = crowd.activity[i] == Activity::kTalking ? 1 : kWalkerTalks;
    const float weight = talks * (1 - far_m / kMurmurNear_m);
    const float turn = (std::atan2(off.y, off.x) + kPi) / (2 * kPi) * 3;
    const size_t side = std::min<size_t>(2, static_cast<size_t>(turn));
    people[side] += weight;
    middle[side] = middle[side] + off * weight;
  }
  const SoundPlace* saying = SayingOf(*s, SoundKind::kMurmur);
  const float volume = kMurmurGain * (saying == nullptr ? 1 : saying->volume);
  for (size_t side = 0; side < 3; ++side) {
    const float wanted = volume * std::min(1.0f, std::sqrt(people[side] / kMurmurPeople));
    s->murmur_gain[side] += (wanted - s->murmur_gain[side]) * follows;
    if (people[side] > 0) {
      const Vec2 at = ear + middle[side] * (1 / people[side]);
      s->murmur_place[side] = {at.x, at.y, s->heard.ear.z};
    }
    if (s->murmur_gain[side] < 0.003f) continue;
    constexpr float kPitch[] = {1, 0.94f, 1.05f};  // no side says the same
    s->heard.round.push_back({static_cast<int>(side), RecordingOf(*s, SoundKind::kMurmur, 0), s->murmur_place[side],
                              s->murmur_gain[side] * s->loud, kPitch[side]});
  }
}

void CountStrokes(float hour, float passed_s, bool has_bell, Soundscape* s) {
  const float before = s->hour;
  s->silent_s += passed_s;
  s->hour = hour;
  s->stroke_s -= passed_s;
  if (!has_bell || before < 0 || hour < before || hour - before > kMostJump_h) return;
  if (std::floor(hour) == std::floor(before)) return;
  const float hour_lasts_s = passed_s / std::max(hour - before, 1e-9f);
  const int by_clock = (static_cast<int>(std::floor(hour)) + 11) % 12 + 1;
  const bool flies = hour_lasts_s < kShortHour_s;
  if (flies && s->silent_s < kShortHour_s / 2) return;
  s->strokes = flies ? 1 : by_clock;
  s->stroke_s = s->silent_s = 0;
}

void HearPlaces(const Simulation& sim, const FrameInput& frame, float passed_s, float follows, Soundscape* s) {
  const Vec3 ear = s->heard.ear;
  const bool strikes = s->strokes > 0 && s->stroke_s <= 0;
  for (size_t k = 0; k < s->places.size(); ++k) {
    const SoundPlace& place = s->places[k];
    if (place.kind == SoundKind::kSteps || place.kind == SoundKind::kMurmur) continue;
    const Vec3 at = PlaceOf(place, sim.town.walkable);
    const float fall = Falloff(Length(at - ear), place.radius_m);
    const bool free = place.kind == SoundKind::kBell || place.kind == SoundKind::kBirds ||
                      !IsBehindWalls(s->walls[k], Flat(ear), place.position_m);  // those are over the roofs
    s->openness[k] += ((free ? 1 : kBehindWalls) - s->openness[k]) * follows;
    const float gain = place.volume * fall * s->openness[k] * s->loud;
    if (place.kind == SoundKind::kBell) {
      if (strikes && gain > 0) s->heard.once.push_back({0, s->first_of[k], at, gain, 1});
    } else if (place.kind == SoundKind::kBirds) {
      s->next_s[k] -= passed_s;
      if (s->next_s[k] > 0) continue;
      s->next_s[k] = Chance(s, 3, 10);
      const int variant = place.sound >= 0 ? 0 : static_cast<int>(Chance(s, 0, kVariants - 0.01f));
      if (frame.to_sun.z > kDaylight && gain > 0.005f)
        s->heard.once.push_back({0, s->first_of[k] + variant, at, gain, Chance(s, 0.92f, 1.1f)});
    } else if (gain > 0.003f) {
      s->heard.round.push_back({3 + static_cast<int>(k), s->first_of[k], at, gain, 1});
    }
  }
  if (!strikes) return;
  --s->strokes;
  s->stroke_s = kStroke_s;
}

}  // namespace

void PrepareSoundscape(const TourPack& pack, const Walkable& w, Soundscape* s) {
  *s = {};
  s->places = pack.sound_places;
  if (!HasOwn(s->places, SoundKind::kBirds)) AddBirds(w, &s->places);
  for (SoundKind kind : {SoundKind::kSteps, SoundKind::kMurmur}) {
    if (!HasOwn(s->places, kind)) s->places.push_back({kind, {}, 0, 25, 1, -1});
  }
  for (const SoundPlace& place : s->places) {
    s->first_of.push_back(Count(s->recordings));
    if (place.sound >= 0) {
      s->recordings.push_back({place.kind, 0, &At(pack.sounds, place.sound)});
      continue;
    }
    const bool varies = place.kind == SoundKind::kSteps || place.kind == SoundKind::kBirds;
    const auto same = [&](const SoundPlace& other) { return other.kind == place.kind && other.sound < 0; };
    const size_t first =
        static_cast<size_t>(std::find_if(s->places.begin(), s->places.end(), same) - s->places.begin());
    if (first + 1 < s->first_of.size()) {
      s->first_of.back() = s->first_of[first];
      continue;
    }
    for (int variant = 0; variant < (varies ? kVariants : 1); ++variant)
      s->recordings.push_back({place.kind, variant, nullptr});
  }
  for (const SoundPlace& place : s->places) s->walls.push_back(LargeWallsAround(w, place.position_m, place.radius_m));
  s->openness.assign(s->places.size(), 1);
  s->next_s.assign(s->places.size(), 0);
  for (float& next_s : s->next_s) next_s = Chance(s, 0.5f, 8);
}

void FollowSoundscape(const TourPack& pack, const Simulation& sim, const FrameInput& frame, float passed_s, bool speaks,
                      bool holds, Soundscape* s) {
  s->heard.round.clear();
  s->heard.once.clear();
  s->heard.ear = frame.eye;
  s->heard.yaw_rad = frame.yaw_rad;
  const float follows = std::min(1.0f, passed_s / kFollows_s);
  s->loud += ((holds ? kWhileHeld : speaks ? kWhileSpoken : 1) - s->loud) * follows;
  const bool has_bell = HasOwn(s->places, SoundKind::kBell);
  CountStrokes(HourNow(sim, frame.to_sun), passed_s, has_bell, s);
  HearMurmur(sim, follows, s);
  HearPlaces(sim, frame, holds ? 0 : passed_s, follows, s);
  if (holds) return;
  HearOwnSteps(sim, passed_s, s);
  HearWalkers(pack, sim, s);
}

}  // namespace flaneur
