#include "runtime/control/foresight.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "runtime/base/random.h"
#include "runtime/crowd/fast_math.h"

namespace flaneur {
namespace {

using State = ForesightState;
using Forecast = State::Forecast;

constexpr int kPlanEvery_steps = 5;
constexpr float kMoment_s = 0.5f;                          // between the moments looked at
constexpr int kTurnMoments[State::kTurns] = {0, 2, 4};     // the first is now
constexpr float kReach_m = 8;                              // beyond r_high: who may be inside within the foresight
constexpr float kNearestRim = -0.1f, kFarthestRim = 0.3f;  // of r_high: how much farther out people keep
constexpr float kRim_m = 0.6f;                             // the forecast is that uncertain
constexpr float kReserve = 0.06f;                          // share of the limit kept free for surprises
constexpr float kTurnLasts_s = 1.0f;                       // a turn of the head dies away
constexpr float kWalksOn_m = 8;
constexpr float kWalksOn_s = 0.5f;                           // in the new direction after a turn
constexpr float kLeans_s = 2.0f;                             // a choice holds so long
constexpr float kBoldReserve = 0.2f, kBoldWalksOn_s = 2.6f;  // without discretion
constexpr float kStepsAside_s = 3;                           // people make room for the visitor so long before
constexpr float kRoom_m = 0.15f;
constexpr float kBlockingCounts = 5;  // moments that holding the visitor up is worth, without discretion
constexpr float kHold_s = 0.2f;       // what is asked is asked anew every step
constexpr float kAheadFree_s = 1.5f;  // and must be walkable so far
constexpr float kCostUnseen = 0.1f;   // moments in the way that one radian is worth
constexpr float kCostInView = 1.35f;
constexpr float kCostOfPace = 1.5f;   // of doubling the pace, in radians
constexpr float kTurnsInView = 0.5f;  // what the visitor may turn to matters that much to people in view
constexpr float kAny = 1e-4f;         // of times in the way; they cannot differ by less

// What is asked of people, and how soon they come to it. In view it is no more than people do on their own, unless
// detail matters more than discretion.
struct Freedom {
  float turn_rad, pace;  // at most; pace: slower or faster by this share
  float cost;            // moments in the way that one radian is worth
  float turn_radps, pace_ps;
};
constexpr Freedom kUnseen{1.5f, 0.5f, kCostUnseen, 3, 2};
constexpr Freedom kFar{1.0f, 0.15f, 0.7f, 0.8f, 0.3f};
constexpr Freedom kNear{0.5f, 0.12f, 0.9f, 0.5f, 0.15f};
constexpr Freedom kBold{1.1f, 0.2f, kCostInView, 90, 30};                          // without any discretion
constexpr float kTurns[] = {0, 0.25f, -0.25f, 0.5f, -0.5f, 0.75f, -0.75f, 1, -1};  // shares of the most
constexpr float kPaces[] = {0, -0.3f, 0.4f, -1, 1};

Vec2 Rotated(Vec2 v, float by_rad) {
  const Vec2 d = DirectionOf(by_rad);
  return {v.x * d.x - v.y * d.y, v.x * d.y + v.y * d.x};
}

float MomentTime_s(int moment) { return static_cast<float>(moment) * kMoment_s; }

void FollowCamera(const ViewCamera& camera, const ViewMotion& motion, float step_s, State* state) {
  Smooth(motion, step_s, &state->motion);
  state->speed_mps = Length(state->motion.velocity);
  state->sine = std::sin(camera.fov_rad / 2), state->cosine = std::cos(camera.fov_rad / 2);
  for (int m = 0; m < State::kMoments; ++m) {
    const float t = MomentTime_s(m);
    const Vec2 position = camera.position + state->motion.velocity * t;
    const Vec2 axis =
        DirectionOf(camera.yaw_rad + state->motion.yaw_rate_radps * kTurnLasts_s * (1 - std::exp(-t / kTurnLasts_s)));
    state->views[static_cast<size_t>(m)] = {position, axis};
  }
}

// Whether a forecast position is in view and within r_high at that moment.
bool InView(const State& state, int moment, float r_high_m, Vec2 p, float body_m) {
  const State::FutureView& m = state.views[static_cast<size_t>(moment)];
  const Vec2 off = p - m.position;
  const float reach_m = r_high_m + kRim_m;
  return Dot(off, off) < reach_m * reach_m &&
         Dot(off, m.axis) * state.sine + body_m + kRim_m >= std::abs(Cross(m.axis, off)) * state.cosine;
}

// Near enough to matter if the visitor turns that way, and perhaps walks on there.
bool InTurningReach(const State& state, float r_high_m, Vec2 off) {
  const float reach_m = r_high_m + std::min(state.walks_on_s * state.speed_mps, kWalksOn_m);
  return Dot(off, off) < reach_m * reach_m;
}

// Beyond it this person does not mind a full view. Were it the same for all, those who keep out would stand in a ring.
float OwnReach_m(const Crowd& c, size_t i, const ControlSettings& s) {
  const float farther = kNearestRim + (kFarthestRim - kNearestRim) * Random{static_cast<uint64_t>(c.id[i])}.Uniform();
  return s.r_high_m * (1 + s.discretion * farther);
}

Vec2 OwnWay(const Crowd& c, size_t i) {
  return c.activity[i] == Activity::kWalking && c.field[i] >= 0 ? c.way[i] * c.preferred_mps[i] : Vec2{};
}

Vec2 Desired(const Crowd& c, size_t i) { return c.detour_s[i] > 0 ? c.detour[i] : OwnWay(c, i); }

bool WouldBeInView(const Crowd& c, size_t i, Vec2 velocity, float r_high_m, int moment, const State& state) {
  return InView(state, moment, r_high_m, c.position[i] + velocity * MomentTime_s(moment), c.view_reach_m[i]);
}

// Where around the visitor the person would be, should the visitor turn; -1 out of reach.
int WouldBeInSector(const Crowd& c, size_t i, Vec2 velocity, float r_high_m, int turn, const State& state) {
  const int m = kTurnMoments[turn];
  const Vec2 off = c.position[i] + velocity * MomentTime_s(m) - state.views[static_cast<size_t>(m)].position;
  return InTurningReach(state, r_high_m, off) ? SectorOf(off) : -1;
}

// The first moment in which the person could be within r_high, both walking towards each other.
int SoonestMoment(const Crowd& c, size_t i, Vec2 velocity, float r_high_m, const State& state) {
  const float closing_mps = Length(velocity) + state.speed_mps + 1e-3f;
  const float soonest_s = (Length(c.position[i] - state.views[0].position) - r_high_m - 2 * kRim_m) / closing_mps;
  return std::clamp(static_cast<int>(soonest_s / kMoment_s), 0, State::kMoments);
}

Forecast Forecasted(const Crowd& c, size_t i, Vec2 velocity, float r_high_m, const State& state) {
  Forecast f;
  for (int m = SoonestMoment(c, i, velocity, r_high_m, state); m < State::kMoments; ++m) {
    if (WouldBeInView(c, i, velocity, r_high_m, m, state)) f.in_view |= 1u << m;
  }
  for (int k = 0; k < State::kTurns; ++k)
    f.sector[static_cast<size_t>(k)] = static_cast<int8_t>(WouldBeInSector(c, i, velocity, r_high_m, k, state));
  return f;
}

void Tally(const Forecast& f, int count, State* state) {
  for (int m = 0; m < State::kMoments; ++m) state->seen[static_cast<size_t>(m)] += f.in_view >> m & 1 ? count : 0;
  for (size_t k = 0; k < State::kTurns; ++k) {
    if (f.sector[k] >= 0) state->around[k][static_cast<size_t>(f.sector[k])] += count;
  }
}

// Finds where there would be too many.
void MeasureExcess(float fov_rad, int capacity, State* state) {
  state->overfull_moments = state->overfull_turns = 0;
  for (int m = 1; m < State::kMoments; ++m) {
    if (state->seen[static_cast<size_t>(m)] > capacity) state->overfull_moments |= 1u << m;
  }
  const int width = SectorsTouched(fov_rad);
  for (size_t k = 0; k < State::kTurns; ++k) {
    state->excess[k].fill(0);
    if (Fullest(state->around[k], width) <= capacity) continue;
    state->overfull_turns |= 1u << k;
    const Sectors<int> fullest = FullestOver(state->around[k], width);
    for (size_t j = 0; j < kSectors; ++j) state->excess[k][j] = std::max(0, fullest[j] - capacity);
  }
}

// Whether the visitor would have to stop for the person.
bool Blocks(const Crowd& c, size_t i, Vec2 velocity, float r_personal_m, const State& state) {
  const Vec2 apart = c.position[i] - state.views[0].position, closing = state.motion.velocity - velocity;
  const float speed2 = Dot(closing, closing), ahead = Dot(apart, closing);
  if (ahead <= 0 || ahead > kStepsAside_s * speed2) return false;
  const float reach_m = r_personal_m + c.radius_m[i] + kRoom_m;
  return Dot(apart, apart) * speed2 - ahead * ahead < reach_m * reach_m * speed2;
}

float BlockingCounts(const Crowd& c, size_t i, Vec2 velocity, const ControlSettings& s, const State& state) {
  if (s.discretion >= 1 || !Blocks(c, i, velocity, s.r_personal_m, state)) return 0;
  return kBlockingCounts * (1 - s.discretion);
}

// How much one person too many in this sector counts. Where every direction is full already, the fullest counts most.
float ExcessCounts(const Crowd& c, size_t i, size_t turn, int sector, const State& state) {
  const int excess = sector < 0 ? 0 : state.excess[turn][static_cast<size_t>(sector)];
  if (excess <= 0) return 0;
  const float share = c.view[i] == ViewClass::kVisible ? kTurnsInView : 1.0f;
  return share * (1 + static_cast<float>(excess) / static_cast<float>(state.high_limit));
}

// In how many instants the person would be one too many.
float TimesInTheWay(const Crowd& c, size_t i, Vec2 velocity, const Forecast& f, const ControlSettings& s,
                    const State& state) {
  float times = BlockingCounts(c, i, velocity, s, state);
  times += static_cast<float>(std::popcount(f.in_view & state.overfull_moments));
  for (size_t k = 0; k < State::kTurns; ++k) times += ExcessCounts(c, i, k, f.sector[k], state);
  return times;
}

// The same with another velocity, counted no further than `enough`. Where the person is now they are with any velocity.
float TimesInTheWay(const Crowd& c, size_t i, Vec2 velocity, const Forecast& f, const ControlSettings& s, float reach_m,
                    float enough, const State& state) {
  float times = BlockingCounts(c, i, velocity, s, state);
  for (uint32_t left = state.overfull_moments; left != 0 && times < enough; left &= left - 1) {
    if (WouldBeInView(c, i, velocity, reach_m, std::countr_zero(left), state)) ++times;
  }
  for (int k = 0; k < State::kTurns && times < enough; ++k) {
    if (!(state.overfull_turns >> k & 1)) continue;
    const int sector = k == 0 ? f.sector[0] : WouldBeInSector(c, i, velocity, reach_m, k, state);
    times += ExcessCounts(c, i, static_cast<size_t>(k), sector, state);
  }
  return times;
}

bool CanWalk(const Walkable& w, Vec2 from, Vec2 way) { return IsFree(w, from + way * 0.5f) && IsFree(w, from + way); }

Freedom Between(const Freedom& a, const Freedom& b, float share) {
  const auto mix = [share](float from, float to) { return from + (to - from) * share; };
  return {mix(a.turn_rad, b.turn_rad), mix(a.pace, b.pace), mix(a.cost, b.cost), mix(a.turn_radps, b.turn_radps),
          mix(a.pace_ps, b.pace_ps)};
}

Freedom FreedomOf(const Crowd& c, size_t i, const ControlSettings& s, const State& state) {
  if (c.view[i] != ViewClass::kVisible) return kUnseen;
  const Vec2 off = c.position[i] - state.views[0].position;
  return Between(kBold, Dot(off, off) > s.r_high_m * s.r_high_m ? kFar : kNear, s.discretion);
}

State::Memory& MemoryOf(const Crowd& c, size_t i, State* state) { return EntryOf(c.slot[i], c.id[i], &state->memory); }

Vec2 Leant(Vec2 own, const State::Lean& lean, float top_mps) {
  return ClampLength(Rotated(own, lean.turn_rad) * lean.pace, top_mps);
}

bool IsStraight(const State::Memory& m) { return m.now == State::Lean{} && m.wanted == State::Lean{}; }

void Consider(const Walkable& w, const ControlSettings& s, size_t i, Crowd* crowd, State* state) {
  Crowd& c = *crowd;
  State::Memory& m = MemoryOf(c, i, state);
  const Vec2 own = OwnWay(c, i);
  const float reach_m = OwnReach_m(c, i, s);
  const Forecast forecast = Forecasted(c, i, Desired(c, i), reach_m, *state);
  const float now = TimesInTheWay(c, i, Desired(c, i), forecast, s, *state);
  if (now == 0) {  // what goes well ends only when the own way is free again: nobody wavers
    if (!(m.wanted == State::Lean{}) && TimesInTheWay(c, i, own, forecast, s, reach_m, kAny, *state) > 0 &&
        CanWalk(w, c.position[i], Desired(c, i) * kAheadFree_s))
      m.left_s = kLeans_s;
    return;
  }
  if (own.x == 0 && own.y == 0) return;
  const Freedom freedom = FreedomOf(c, i, s, *state);
  State::Choice best{0, static_cast<int>(i), {}};
  for (const float faster : kPaces) {
    const float pace = 1 + faster * freedom.pace;
    const float change = kCostOfPace * std::abs(pace - m.wanted.pace);
    for (const float share : kTurns) {
      const float turn = share * freedom.turn_rad;
      const float at_best = now - freedom.cost * (std::abs(turn - m.wanted.turn_rad) + change);
      if (at_best <= best.gain) continue;
      const Vec2 velocity = Leant(own, {turn, pace}, c.top_mps[i]);
      const float gain =
          at_best - TimesInTheWay(c, i, velocity, forecast, s, reach_m, at_best - best.gain + kAny, *state);
      if (gain > best.gain && CanWalk(w, c.position[i], velocity * kAheadFree_s))
        best.gain = gain, best.lean = {turn, pace};
    }
  }
  if (best.gain > 0) state->choices.push_back(best);
}

void Choose(const ControlSettings& s, float fov_rad, int capacity, Crowd* c, State* state) {
  std::sort(state->choices.begin(), state->choices.end(), [&](const State::Choice& a, const State::Choice& b) {
    return a.gain != b.gain ? a.gain > b.gain
                            : c->id[static_cast<size_t>(a.person)] < c->id[static_cast<size_t>(b.person)];
  });
  for (const State::Choice& choice : state->choices) {
    const size_t i = static_cast<size_t>(choice.person);
    const Vec2 desired = Desired(*c, i);
    const Forecast minded = Forecasted(*c, i, desired, OwnReach_m(*c, i, s), *state);
    if (TimesInTheWay(*c, i, desired, minded, s, *state) == 0) continue;  // others have made room
    Tally(Forecasted(*c, i, desired, s.r_high_m, *state), -1, state);
    State::Memory& m = MemoryOf(*c, i, state);
    m.wanted = choice.lean;
    m.left_s = kLeans_s;
    c->detour[i] = Leant(OwnWay(*c, i), m.now, c->top_mps[i]);
    c->detour_s[i] = kHold_s;
    Tally(Forecasted(*c, i, Leant(OwnWay(*c, i), m.wanted, c->top_mps[i]), s.r_high_m, *state), 1, state);
    MeasureExcess(fov_rad, capacity, state);
  }
}

float Approached(float now, float wanted, float most) { return now + std::clamp(wanted - now, -most, most); }

// Everybody who leans comes a step nearer to what is wanted of them; who is on their own way again is let go.
void Lean(float step_s, const ControlSettings& s, Crowd* c, State* state) {
  for (size_t i = 0; i < c->size(); ++i) {
    if (c->detour_s[i] <= 0 || static_cast<size_t>(c->slot[i]) >= state->memory.size()) continue;
    State::Memory& m = state->memory[static_cast<size_t>(c->slot[i])];
    if (m.id != c->id[i] || IsStraight(m)) continue;
    if ((m.left_s -= step_s) <= 0) m.wanted = {};
    const Freedom freedom = FreedomOf(*c, i, s, *state);
    m.now.turn_rad = Approached(m.now.turn_rad, m.wanted.turn_rad, freedom.turn_radps * step_s);
    m.now.pace = Approached(m.now.pace, m.wanted.pace, freedom.pace_ps * step_s);
    const Vec2 own = OwnWay(*c, i);
    const bool over = IsStraight(m) || (own.x == 0 && own.y == 0);
    if (over) m.now = m.wanted = {};
    c->detour[i] = Leant(own, m.now, c->top_mps[i]);
    c->detour_s[i] = over ? 0 : kHold_s;
  }
}

}  // namespace

void Foresee(const ViewCamera& camera, const ViewMotion& motion, const Walkable& walkable, const ControlSettings& s,
             int high_limit, Crowd* c, State* state) {
  FollowCamera(camera, motion, Step_s(s), state);
  state->high_limit = high_limit;
  Lean(Step_s(s), s, c, state);
  if (state->step++ % kPlanEvery_steps != 0) return;
  const float reserve = kBoldReserve + (kReserve - kBoldReserve) * s.discretion;
  state->walks_on_s = kBoldWalksOn_s + (kWalksOn_s - kBoldWalksOn_s) * s.discretion;
  const int capacity = high_limit - static_cast<int>(std::lround(reserve * static_cast<float>(high_limit)));
  const float reach_m = s.r_high_m + kReach_m + state->speed_mps * MomentTime_s(State::kMoments - 1);
  state->near.clear();
  state->choices.clear();
  state->seen.fill(0);
  for (auto& around : state->around) around.fill(0);
  for (size_t i = 0; i < c->size(); ++i) {
    const Vec2 off = c->position[i] - camera.position;
    if (Dot(off, off) > reach_m * reach_m) continue;
    state->near.push_back(i);
    Tally(Forecasted(*c, i, Desired(*c, i), s.r_high_m, *state), 1, state);
  }
  MeasureExcess(camera.fov_rad, capacity, state);
  if (s.discretion >= 1 && state->overfull_moments == 0 && state->overfull_turns == 0) return;  // nobody is in the way
  for (const size_t i : state->near) {
    if (c->activity[i] != Activity::kWorking && MemoryOf(*c, i, state).left_s <= 0.5f * kLeans_s)
      Consider(walkable, s, i, c, state);
  }
  Choose(s, camera.fov_rad, capacity, c, state);
}

}  // namespace flaneur
