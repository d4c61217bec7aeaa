#include "runtime/crowd/go_round.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace flaneur {
namespace {

constexpr float kSeen_m = 9;         // so far away people begin to bend their way
constexpr float kForeseen_s = 6;     // a disc that moves is foreseen so long
constexpr float kLooks_m = 3;        // so far a way must be free of walls
constexpr float kLook_m = 0.35f;     // from point to point of it
constexpr float kTouching_m = 0.1f;  // of those who have no choice, beyond touching
constexpr float kTolerance_m = 0.02f;
constexpr float kPast_m = 0.5f;
constexpr size_t kMostDiscs = 8;
constexpr float kOutwards = 0.15f;      // who is within a disc's room walks out of it at this slope at least
constexpr float kFarthestTurn = -0.6f;  // cosine of it
constexpr float kKeepsSide = 0.4f;      // cost of going round on the other side, where a turn by a costs 1 - cos a

// What people give up in turn where there is no such way.
enum class Manners : uint8_t { kAll, kRoom, kNone };

struct Disc {
  Vec2 off;  // from the person to its middle
  Vec2 velocity;
  float reach_m = 0;
  Vec2 talker, listener{};  // as `off`; the same: nobody talks
};

Disc DiscOf(const MovingObstacle& m, const Walking& me, Manners manners) {
  const Vec2 off = m.center - me.position;
  const Vec2 listener = manners == Manners::kAll ? off + m.talks_with : off;
  if (manners == Manners::kNone) return {off, m.velocity, m.radius_m + me.radius_m + kTouching_m, off, listener};
  return {off + m.before, m.velocity, m.radius_m + m.room_m + me.radius_m, off, listener};
}

// The goal is reached before, or lies within: no way there keeps the disc's room.
bool IsBeyondGoal(const Disc& d, const Walking& me) {
  const Vec2 left = d.off - me.way * me.goal_m;
  return Length(d.off) - d.reach_m > me.goal_m || Dot(left, left) < d.reach_m * d.reach_m;
}

bool Meets(const Disc& d, Vec2 way, const Walking& me) {
  const Vec2 closing = way * me.speed_mps - d.velocity;
  const float along = Dot(d.off, closing), closing2 = Dot(closing, closing), off2 = Dot(d.off, d.off);
  const float reach_m = d.reach_m - kTolerance_m;
  if (off2 < reach_m * reach_m) return along > -0.5f * kOutwards * std::sqrt(off2 * closing2);
  if (along <= 0 || along > kForeseen_s * closing2) return false;
  return off2 * closing2 - along * along < reach_m * reach_m * closing2;
}

// Who stands between them already goes on.
bool PassesBetween(const Disc& d, Vec2 way, const Walking& me) {
  const Vec2 line = d.listener - d.talker;
  const float across = Cross(way, line), far_m = std::min(me.goal_m, kForeseen_s * me.speed_mps);
  if (across == 0) return false;
  const float after_m = Cross(d.talker, line) / across, on = Cross(d.talker, way) / across;
  return after_m > 0 && after_m < far_m && on > 0 && on < 1;
}

bool IsFreeWay(const Walkable& w, const Walking& me, Vec2 way, float far_m) {
  for (float m = kLook_m; m <= far_m; m += kLook_m) {
    if (!IsFree(w, me.position + way * m)) return false;
  }
  return true;
}

// Past the disc where it will be then; out of it for who is inside.
Vec2 Tangent(const Disc& d, const Walking& me, float side) {
  const float soon_s = std::min(Length(d.off) / std::max(me.speed_mps, 0.1f), 0.5f * kForeseen_s);
  const Vec2 off = d.off + d.velocity * soon_s;
  const float off_m = std::max(Length(off), 1e-3f), sine = d.reach_m / off_m;
  const Vec2 ahead = off * (1 / off_m), left = Vec2{-ahead.y, ahead.x} * side;
  if (sine >= 1) return (left - ahead * kOutwards) * (1 / std::sqrt(1 + kOutwards * kOutwards));
  return ahead * std::sqrt(1 - sine * sine) + left * sine;
}

// Who goes that way is past the disc after so far.
float PastAfter_m(const Disc& d) {
  return std::sqrt(std::max(0.0f, Dot(d.off, d.off) - d.reach_m * d.reach_m)) + kPast_m;
}

struct Choice {
  Vec2 way;
  float cost = 1e9f;
  int8_t side = 0;
};

void Consider(const Walkable& w, std::span<const Disc> discs, const Disc& passed, float side, const Walking& me,
              int8_t last_side, Choice* best) {
  const Vec2 way = Tangent(passed, me, side);
  const float cosine = Dot(way, me.way);
  const bool turns = last_side != 0 && static_cast<float>(last_side) != side;
  const float cost = 1 - cosine + (turns ? kKeepsSide : 0);
  if (cosine < kFarthestTurn || cost >= best->cost) return;
  const auto hinders = [&](const Disc& d) { return (&d != &passed && Meets(d, way, me)) || PassesBetween(d, way, me); };
  if (std::any_of(discs.begin(), discs.end(), hinders)) return;
  if (!IsFreeWay(w, me, way, std::min(kLooks_m, PastAfter_m(passed)))) return;
  *best = {way, cost, static_cast<int8_t>(side)};
}

}  // namespace

Vec2 WayRound(const Walkable& w, const std::vector<MovingObstacle>& moving, const Walking& me, int8_t* side) {
  const auto counts = [&](const MovingObstacle& m) {
    return m.everyone && m.room_m > 0 && Length(m.center - me.position) <= kSeen_m;
  };
  if (std::none_of(moving.begin(), moving.end(), counts)) {
    *side = 0;
    return me.way;
  }
  for (const Manners manners : {Manners::kAll, Manners::kRoom, Manners::kNone}) {
    std::array<Disc, kMostDiscs> near;
    size_t count = 0;
    for (const MovingObstacle& m : moving) {
      if (!counts(m)) continue;
      const Disc disc = DiscOf(m, me, manners);
      if (count < kMostDiscs && !IsBeyondGoal(disc, me)) near[count++] = disc;
    }
    const std::span<const Disc> discs{near.data(), count};
    const auto meets = [&](const Disc& d) { return Meets(d, me.way, me) || PassesBetween(d, me.way, me); };
    if (std::none_of(discs.begin(), discs.end(), meets)) {
      if (manners != Manners::kNone) *side = 0;
      return me.way;
    }
    Choice best;
    for (const Disc& disc : discs) {
      for (const float to : {-1.0f, 1.0f}) Consider(w, discs, disc, to, me, *side, &best);  // the right first
    }
    if (best.side == 0) continue;
    *side = best.side;
    return best.way;
  }
  return me.way;
}

}  // namespace flaneur
