#include "runtime/town/flock.h"

#include <algorithm>
#include <cmath>

#include "runtime/crowd/fast_math.h"
#include "runtime/town/town.h"

namespace flaneur {
namespace {

constexpr float kAwake_m = 110;             // flocks farther from the visitor rest
constexpr float kOfTownspeople = 0.4f;      // of shy_m: birds of a town know them,
constexpr float kWalks_mps = 0.4f;          // and who is slower frightens nobody
constexpr float kContagion_m = 2.5f;        // whose neighbours fly up before a visitor goes with them,
constexpr float kLittleContagion_m = 0.5f;  // or before somebody else,
constexpr float kMaxStart_s = 0.5f;         // so much later at most
constexpr float kFlies_mps = 6, kTurns_mps2 = 14;
constexpr float kMinRounds_s = 3, kMaxRounds_s = 7;  // in the air before they look for a place
constexpr float kMinHigh_m = 4.5f, kMaxHigh_m = 7;
constexpr float kMinRound_m = 2.5f, kRoundBeyond_m = 2;  // of the rounds; beyond the place's radius
constexpr float kBrakes_m = 5;                           // before they touch down
constexpr float kTouches_m = 0.12f;
constexpr float kStrolls_mps = 0.22f, kMinStroll_m = 0.2f, kMaxStroll_m = 1.0f;
constexpr float kMinPeck_s = 1.5f, kMaxPeck_s = 5;
constexpr float kGap_m = 0.25f;  // between birds on the ground
constexpr float kTurns_radps = 5;
constexpr int kTries = 16;
constexpr float kLook_m = 0.4f;  // between the points of a way that are looked at

Vec2 Flat(Vec3 v) { return {v.x, v.y}; }

Vec2 SomewhereIn(const Flock& place, Random* random) {
  const float angle = random->Uniform(-kPi, kPi);
  return place.position_m + DirectionOf(angle) * (place.radius_m * std::sqrt(random->Uniform()));
}

bool FreeWay(const Walkable& w, Vec2 from, Vec2 to) {
  const int steps = std::max(1, static_cast<int>(Length(to - from) / kLook_m));
  for (int k = 1; k <= steps; ++k) {
    if (!IsFree(w, from + (to - from) * (static_cast<float>(k) / static_cast<float>(steps)))) return false;
  }
  return true;
}

// The widest that keeps clear of walls, whatever the place.
float RoundFor_m(const Walkable& w, const Flock& place) {
  constexpr int kDirections = 24;
  float round_m = kMinRound_m;
  for (float wider_m = round_m; wider_m <= place.radius_m + kRoundBeyond_m; wider_m += 0.5f) {
    for (int k = 0; k < kDirections; ++k) {
      const float angle = 2 * kPi * static_cast<float>(k) / kDirections;
      if (!IsFree(w, place.position_m + DirectionOf(angle) * wider_m)) return round_m;
    }
    round_m = wider_m;
  }
  return round_m;
}

void Enter(BirdState state, float left_s, Bird* bird) {
  bird->last = bird->state;
  bird->state = state;
  bird->since_s = 0;
  bird->left_s = left_s;
}

void TakeOff(FlockState* flock, Bird* bird) {
  const Vec2 off = Flat(bird->position) - flock->place.position_m;
  bird->round_rad = Length(off) > 0.1f ? AngleOf(off) : flock->random.Uniform(-kPi, kPi);
  bird->high_m = flock->random.Uniform(kMinHigh_m, kMaxHigh_m);
  bird->velocity = {0, 0, 2};
  Enter(BirdState::kFlies, flock->random.Uniform(kMinRounds_s, kMaxRounds_s), bird);
}

struct Danger {
  Vec2 position;
  float fears_m = 0, contagion_m = 0;
};

// What is feared at p, within so many times its distance; null: nothing.
const Danger* FearedAt(Vec2 p, const std::vector<Danger>& dangers, float times) {
  const auto found = std::find_if(dangers.begin(), dangers.end(),
                                  [&](const Danger& d) { return Length(p - d.position) < times * d.fears_m; });
  return found != dangers.end() ? &*found : nullptr;
}

// Who frightens the flock's birds now.
std::vector<Danger> Dangers(Vec2 visitor, bool present, const FlockState& flock, const Town& town) {
  std::vector<Danger> dangers;
  const Flock& place = flock.place;
  if (present) dangers.push_back({visitor, place.shy_m, kContagion_m});
  const Crowd& c = town.crowd;
  const float fears_m = kOfTownspeople * place.shy_m;
  for (size_t i = 0; i < c.size(); ++i) {
    if (Length(c.position[i] - place.position_m) > place.radius_m + 2 * fears_m) continue;
    if (Length(c.velocity[i]) > kWalks_mps) dangers.push_back({c.position[i], fears_m, kLittleContagion_m});
  }
  return dangers;
}

bool IsTaken(Vec2 p, const FlockState& flock, const Bird* own) {
  return std::any_of(flock.birds.begin(), flock.birds.end(), [&](const Bird& other) {
    if (&other == own || other.state == BirdState::kFlies) return false;
    return Length(p - (other.state == BirdState::kPecks ? Flat(other.position) : other.to)) < kGap_m;
  });
}

// Where nobody is. False: not now.
bool FindLanding(const Walkable& w, const std::vector<Danger>& dangers, FlockState* flock, Bird* bird) {
  for (int attempt = 0; attempt < kTries; ++attempt) {
    const Vec2 to = SomewhereIn(flock->place, &flock->random);
    if (!IsFree(w, to) || FearedAt(to, dangers, 2) != nullptr || IsTaken(to, *flock, bird)) continue;
    bird->to = to;
    return true;
  }
  return false;
}

// Towards `aim` as birds fly: no faster than they can, and never at once.
void Fly(Vec3 aim, float mps, float step_s, Bird* bird) {
  const Vec3 way = aim - bird->position;
  const float away_m = Length(way);
  const Vec3 wanted = away_m > 1e-4f ? way * (mps / away_m) : Vec3{};
  const Vec3 change = wanted - bird->velocity;
  const float most = kTurns_mps2 * step_s, much = Length(change);
  bird->velocity = bird->velocity + (much > most ? change * (most / much) : change);
  bird->position = bird->position + bird->velocity * step_s;
}

void Turn(Vec2 way, float step_s, Bird* bird) {
  if (Length(way) < 0.05f) return;
  const float most = kTurns_radps * step_s;
  bird->heading_rad =
      WrapAngle(bird->heading_rad + std::clamp(WrapAngle(AngleOf(way) - bird->heading_rad), -most, most));
}

void Circle(const Walkable& w, const std::vector<Danger>& dangers, float step_s, FlockState* flock, Bird* bird) {
  bird->round_rad += kFlies_mps / flock->round_m * step_s;
  const Vec2 at = flock->place.position_m + DirectionOf(bird->round_rad) * flock->round_m;
  Fly({at.x, at.y, flock->ground_m + bird->high_m}, kFlies_mps, step_s, bird);
  Turn(Flat(bird->velocity), step_s, bird);
  bird->left_s -= step_s;
  if (bird->left_s <= 0 && FindLanding(w, dangers, flock, bird)) Enter(BirdState::kLands, 0, bird);
}

void Land(const Walkable& w, const std::vector<Danger>& dangers, float step_s, FlockState* flock, Bird* bird) {
  if (FearedAt(bird->to, dangers, 1) != nullptr) {  // somebody walks there now
    Enter(BirdState::kFlies, flock->random.Uniform(kMinRounds_s, kMaxRounds_s) / 2, bird);
    return;
  }
  const float ground_m = HeightAt(w, bird->to);
  const Vec2 off = bird->to - Flat(bird->position);
  const float away_m = Length(off), above_m = bird->position.z - ground_m;
  // Down on a slant, and from right above in the end: never through what stands around.
  const Vec3 aim{bird->to.x, bird->to.y, ground_m + std::max(0.0f, 0.5f * (away_m - 0.5f))};
  const float brakes = std::clamp((away_m + above_m) / kBrakes_m, 0.12f, 1.0f);
  Fly(aim, kFlies_mps * brakes, step_s, bird);
  bird->position.z = std::max(bird->position.z, HeightAt(w, Flat(bird->position)));
  Turn(Flat(bird->velocity), step_s, bird);
  if (Length(Vec3{off.x, off.y, above_m}) > kTouches_m) return;
  bird->position = {bird->to.x, bird->to.y, ground_m};
  bird->velocity = {};
  Enter(BirdState::kPecks, flock->random.Uniform(kMinPeck_s, kMaxPeck_s), bird);
}

void Stroll(const Walkable& w, FlockState* flock, Bird* bird) {
  const Vec2 p = Flat(bird->position);
  const Vec2 to = p + DirectionOf(bird->heading_rad + flock->random.Uniform(-1.5f, 1.5f)) *
                          flock->random.Uniform(kMinStroll_m, kMaxStroll_m);
  if (!FreeWay(w, p, to) || Length(to - flock->place.position_m) > flock->place.radius_m || IsTaken(to, *flock, bird)) {
    bird->left_s = flock->random.Uniform(0.2f, kMinPeck_s);  // and then another way
    bird->heading_rad = WrapAngle(bird->heading_rad + flock->random.Uniform(-0.2f, 0.2f));
    return;
  }
  bird->to = to;
  Enter(BirdState::kWalks, 0, bird);
}

void Walk(const Walkable& w, float step_s, FlockState* flock, Bird* bird) {
  const Vec2 off = bird->to - Flat(bird->position);
  const float step_m = std::min(kStrolls_mps * step_s, Length(off));
  Turn(off, step_s, bird);
  if (step_m > 1e-5f) {
    const Vec2 p = Flat(bird->position) + off * (step_m / Length(off));
    bird->position = {p.x, p.y, HeightAt(w, p)};
    bird->walked_m += step_m;
  } else {
    Enter(BirdState::kPecks, flock->random.Uniform(kMinPeck_s, kMaxPeck_s), bird);
  }
}

// Who is frightened tells those around.
void Startle(Vec2 at, float contagion_m, FlockState* flock) {
  for (Bird& other : flock->birds) {
    if (InTheAir(other.state) || other.left_s < 0 || Length(Flat(other.position) - at) > contagion_m) continue;
    other.left_s = -flock->random.Uniform(0.05f, kMaxStart_s);
  }
}

void StepOnGround(const Walkable& w, const std::vector<Danger>& dangers, float step_s, FlockState* flock, Bird* bird) {
  const bool startled = bird->left_s < 0;
  if (startled) bird->left_s = std::min(0.0f, bird->left_s + step_s);
  const Danger* feared = FearedAt(Flat(bird->position), dangers, 1);
  if (feared != nullptr || (startled && bird->left_s >= 0)) {
    if (feared != nullptr) Startle(Flat(bird->position), feared->contagion_m, flock);
    TakeOff(flock, bird);
    return;
  }
  if (bird->state == BirdState::kWalks) return Walk(w, step_s, flock, bird);
  if (startled) return;
  bird->left_s = std::max(0.0f, bird->left_s - step_s);
  if (bird->left_s <= 0) Stroll(w, flock, bird);
}

void StepBird(const Walkable& w, const std::vector<Danger>& dangers, float step_s, FlockState* flock, Bird* bird) {
  bird->before = bird->position;
  bird->heading_before_rad = bird->heading_rad;
  bird->since_s += step_s;
  if (bird->state == BirdState::kFlies) return Circle(w, dangers, step_s, flock, bird);
  if (bird->state == BirdState::kLands) return Land(w, dangers, step_s, flock, bird);
  StepOnGround(w, dangers, step_s, flock, bird);
}

void PlaceBirds(const Walkable& w, FlockState* flock) {
  const Flock& place = flock->place;
  for (int tries = 0; static_cast<int>(flock->birds.size()) < place.birds && tries < kTries * place.birds; ++tries) {
    const Vec2 p = SomewhereIn(place, &flock->random);
    if (!IsFree(w, p) || IsTaken(p, *flock, nullptr)) continue;
    Bird bird;
    bird.position = bird.before = {p.x, p.y, HeightAt(w, p)};
    bird.heading_rad = bird.heading_before_rad = flock->random.Uniform(-kPi, kPi);
    bird.left_s = flock->random.Uniform(0, kMaxPeck_s);
    bird.since_s = kMaxPeck_s;
    flock->birds.push_back(bird);
  }
}

// -1: there is none who can.
int BirdAvatar(const Flock& flock, const Town& town) {
  for (size_t k = 0; k < town.residents.size(); ++k) {
    const std::vector<std::string>& clips = town.residents[k].other_clips;
    if (town.residents[k].avatar == flock.avatar && std::find(clips.begin(), clips.end(), flock.clip) != clips.end())
      return static_cast<int>(k);
  }
  return -1;
}

}  // namespace

void PlaceFlocks(const std::vector<Flock>& flocks, Town* town) {
  town->flocks.clear();
  for (const Flock& place : flocks) {
    FlockState flock;
    flock.place = place;
    flock.avatar = BirdAvatar(place, *town);
    flock.random.state = town->settings.seed * 1000003 + town->flocks.size() + 1;
    if (flock.avatar < 0) {
      town->warnings.push_back("a flock is left out: no avatar '" + place.avatar + "' has the clip '" + place.clip +
                               "'");
      continue;
    }
    PlaceBirds(town->walkable, &flock);
    if (flock.birds.empty()) {
      town->warnings.push_back("a flock of '" + place.avatar + "' is left out: there is no free ground for it");
      continue;
    }
    flock.ground_m = HeightAt(town->walkable, place.position_m);
    flock.round_m = RoundFor_m(town->walkable, place);
    town->flocks.push_back(std::move(flock));
  }
}

void StepFlocks(Vec2 visitor, bool present, float step_s, Town* town) {
  for (FlockState& flock : town->flocks) {
    if (present && Length(visitor - flock.place.position_m) > flock.place.radius_m + kAwake_m) continue;
    const std::vector<Danger> dangers = Dangers(visitor, present, flock, *town);
    for (Bird& bird : flock.birds) StepBird(town->walkable, dangers, step_s, &flock, &bird);
  }
}

}  // namespace flaneur
