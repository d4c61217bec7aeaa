// Made-up situations like those of the recordings that pedestrian models are judged by (ETH's and UCY's pavements and
// campus): people come, cross the picture and go, alone and in company, each with a speed of their own. How they walk
// is measured as an annotator would see it, every 0.4 s and 2 cm off. Shared by tests and benchmarks.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "runtime/base/random.h"
#include "runtime/crowd/crowd.h"
#include "runtime/crowd/fast_math.h"

namespace flaneur {

inline constexpr float kPavementStep_s = 1.0f / 30, kSeenEvery_s = 0.4f, kSeenNoise_m = 0.02f;
inline constexpr int kStepsSeen = 12, kSeenSamples = 8;
inline constexpr float kSeenWalks_mps = 0.3f;

// What was measured of real people there: means over windows of 2.8 s.
struct RealWalk {
  float speed_deviation_mps, acceleration_mps2, turn_dps;
};

struct PavementPlan {
  std::string name;
  float length_m = 14, width_m = 10;  // of the picture; people cross it lengthways, or any way
  bool any_way = false;
  float speed_mps = 1.2f, speed_spread_mps = 0.2f;
  float come_ps = 0.5f, in_company = 0.4f;  // companies a second; share of them that are pairs
  int standing = 0;                         // companies who stand about
  float weight = 0;                         // share of the windows of all recordings
  RealWalk real{};
};

inline std::vector<PavementPlan> Pavements() {
  return {{"before a building", 15, 10, false, 1.51f, 0.25f, 0.4f, 0.3f, 0, 0.08f, {0.079f, 0.163f, 6.9f}},
          {"narrow pavement", 12, 5, false, 1.38f, 0.2f, 0.4f, 0.3f, 1, 0.10f, {0.067f, 0.122f, 7.6f}},
          {"shopping street", 15, 9, false, 1.14f, 0.2f, 0.3f, 0.5f, 0, 0.14f, {0.062f, 0.079f, 5.5f}},
          {"busier street", 15, 9, false, 1.18f, 0.2f, 0.4f, 0.5f, 1, 0.20f, {0.075f, 0.093f, 6.9f}},
          {"campus", 15, 14, true, 0.8f, 0.2f, 1.3f, 0.55f, 4, 0.48f, {0.128f, 0.240f, 13.3f}}};
}

struct Walked {  // of one person, as seen
  std::vector<Vec2> seen;
  int company = -1;
};

struct Pavement {
  PavementPlan plan;
  Walkable walkable;
  Crowd crowd;
  CrowdScratch scratch;
  Random random{1};
  std::vector<Walked> walked;  // by id
  float next_s = 0;
  int companies = 0;
};

inline Pavement MakePavement(const PavementPlan& plan, uint64_t seed) {
  Pavement p;
  p.plan = plan;
  p.random.state = seed * 977 + 5;
  constexpr float kRim_m = 4;
  const int columns = static_cast<int>(plan.length_m + 2 * kRim_m), rows = static_cast<int>(plan.width_m + 2 * kRim_m);
  const size_t all = static_cast<size_t>(columns) * static_cast<size_t>(rows);
  p.walkable.ground =
      Share({{-kRim_m, -kRim_m}, 1, columns, rows, std::vector<float>(all, 0), std::vector<uint8_t>(all, 3)});
  BuildWalkable(0.3f, &p.walkable, 0.25f);
  for (int k = 0; k < plan.standing; ++k) {
    const Vec2 middle{p.random.Uniform(3, plan.length_m - 3), p.random.Uniform(2, plan.width_m - 1.5f)};
    const int count = 2 + p.random.Below(2);
    for (int m = 0; m < count; ++m) {
      Person who;
      who.position = middle + DirectionOf(2 * kPi * static_cast<float>(m) / static_cast<float>(count)) * 0.5f;
      AddPerson(who, &p.crowd);
      p.crowd.view.back() = ViewClass::kVisible;
    }
  }
  p.walked.resize(p.crowd.size());
  return p;
}

inline float NormalOf(Random* random) {
  float sum = 0;
  for (int k = 0; k < 12; ++k) sum += random->Uniform();
  return sum - 6;
}

// On one of the sides of the picture, 0 to 3.
inline Vec2 OnSide(int side, Pavement* p) {
  const float x = p->random.Uniform(1, p->plan.length_m - 1), y = p->random.Uniform(0.8f, p->plan.width_m - 0.8f);
  if (side == 0) return {0, y};
  if (side == 1) return {p->plan.length_m, y};
  return side == 2 ? Vec2{x, 0} : Vec2{x, p->plan.width_m};
}

inline void Come(Pavement* p) {
  Crowd& c = p->crowd;
  const int sides = p->plan.any_way ? 4 : 2, from = p->random.Below(sides);
  int to = p->random.Below(sides);
  while (to == from) to = p->random.Below(sides);
  const Vec2 start = OnSide(from, p), goal = OnSide(to, p), ahead = Unit(goal - start), left{-ahead.y, ahead.x};
  const int count = p->random.Uniform() < p->plan.in_company ? 2 : 1;
  const float speed_mps = p->plan.speed_mps + p->plan.speed_spread_mps * NormalOf(&p->random);
  const int field = FieldFor(goal + ahead, &c);
  std::vector<int> members;
  for (int k = 0; k < count; ++k) {
    Person who;
    who.position = start + left * (0.75f * static_cast<float>(k));
    for (const Vec2 other : c.position) {
      if (Length(other - who.position) < 0.6f) return;
    }
    who.heading_rad = AngleOf(ahead);
    who.preferred_mps = std::clamp(speed_mps, 0.45f, 2.2f);
    who.field = field;
    members.push_back(static_cast<int>(c.size()));
    AddPerson(who, &c);
    c.velocity.back() = ahead * who.preferred_mps;
    c.view.back() = ViewClass::kVisible;
    p->walked.push_back({{}, count > 1 ? p->companies : -1});
  }
  if (count > 1) AddGroup(members, &c);
  ++p->companies;
}

inline void RunPavement(float for_s, Pavement* p) {
  Crowd& c = p->crowd;
  for (int step = 0; step < static_cast<int>(for_s / kPavementStep_s); ++step) {
    if ((p->next_s -= kPavementStep_s) <= 0) {
      Come(p);
      p->next_s = -std::log(1 - p->random.Uniform()) / p->plan.come_ps;
    }
    StepCrowd(p->walkable, {}, kPavementStep_s, &p->scratch, &c);
    for (size_t i = c.size(); i-- > 0;) {
      const Vec2 at = c.position[i];
      const bool in = at.x > -0.5f && at.y > -0.5f && at.x < p->plan.length_m + 0.5f && at.y < p->plan.width_m + 0.5f;
      if (c.field[i] >= 0 && !in) {
        RemovePerson(i, &c);
        continue;
      }
      // Everybody at the same moments, so that who walk together can be compared.
      std::vector<Vec2>& seen = p->walked[static_cast<size_t>(c.id[i])].seen;
      if (step % kStepsSeen == 0) {
        seen.push_back(at + Vec2{NormalOf(&p->random), NormalOf(&p->random)} * kSeenNoise_m);
      }
    }
  }
}

// As the data page says: smoothed by 1 2 1.
inline std::vector<Vec2> Smoothed(const std::vector<Vec2>& seen) {
  std::vector<Vec2> out;
  for (size_t k = 1; k + 1 < seen.size(); ++k) out.push_back((seen[k - 1] + seen[k] * 2 + seen[k + 1]) * 0.25f);
  return out;
}

struct WalkMeasures {
  double speed_mps = 0, speed_deviation_mps = 0, acceleration_mps2 = 0, turn_dps = 0;  // means over windows
  int windows = 0;
  std::vector<double> ahead_m, apart_m;          // of pairs
  std::array<double, 5> correlation{};           // of a person's pace, after 0.4, 0.8, 1.6, 3.2, 6.4 s
  std::array<double, 5> together{}, variance{};  // sums for it
};

inline void MeasureWindow(const std::vector<Vec2>& at, size_t first, WalkMeasures* m) {
  std::array<Vec2, kSeenSamples - 1> v;
  std::array<double, kSeenSamples - 1> speed;
  double mean = 0, square = 0, acceleration = 0, turn = 0;
  for (size_t k = 0; k < v.size(); ++k) {
    v[k] = (at[first + k + 1] - at[first + k]) * (1 / kSeenEvery_s);
    speed[k] = static_cast<double>(Length(v[k]));
    if (speed[k] < static_cast<double>(kSeenWalks_mps)) return;
    mean += speed[k], square += speed[k] * speed[k];
  }
  for (size_t k = 1; k < v.size(); ++k) {
    acceleration += std::abs(speed[k] - speed[k - 1]);
    turn += static_cast<double>(std::abs(WrapAngle(AngleOf(v[k]) - AngleOf(v[k - 1]))));
  }
  const double count = static_cast<double>(v.size()), changes = (count - 1) * static_cast<double>(kSeenEvery_s);
  mean /= count;
  m->speed_mps += mean;
  m->speed_deviation_mps += std::sqrt(std::max(0.0, square / count - mean * mean));
  m->acceleration_mps2 += acceleration / changes;
  m->turn_dps += turn / changes * 180 / static_cast<double>(kPi);
  ++m->windows;
}

inline void MeasurePace(const std::vector<Vec2>& at, WalkMeasures* m) {
  std::vector<double> speed;
  double mean = 0;
  for (size_t k = 0; k + 1 < at.size(); ++k) {
    speed.push_back(static_cast<double>(Length(at[k + 1] - at[k]) / kSeenEvery_s));
    mean += speed.back();
  }
  if (speed.size() < 8) return;
  mean /= static_cast<double>(speed.size());
  for (size_t lag = 0; lag < 5; ++lag) {
    const size_t apart = size_t{1} << lag;
    for (size_t k = 0; k + apart < speed.size(); ++k) {
      const double a = speed[k] - mean, b = speed[k + apart] - mean;
      m->together[lag] += a * b, m->variance[lag] += 0.5 * (a * a + b * b);
    }
  }
}

inline void MeasurePairs(const Pavement& p, WalkMeasures* m) {
  for (size_t a = 0; a + 1 < p.walked.size(); ++a) {
    if (p.walked[a].company < 0 || p.walked[a].company != p.walked[a + 1].company) continue;
    const std::vector<Vec2> first = Smoothed(p.walked[a].seen), second = Smoothed(p.walked[a + 1].seen);
    for (size_t k = 0; k + 1 < std::min(first.size(), second.size()); ++k) {
      const Vec2 way = first[k + 1] - first[k] + second[k + 1] - second[k], off = first[k] - second[k];
      if (Length(way) < 2 * kSeenWalks_mps * kSeenEvery_s) continue;
      m->ahead_m.push_back(static_cast<double>(std::abs(Dot(off, Unit(way)))));
      m->apart_m.push_back(static_cast<double>(Length(off)));
    }
  }
}

inline WalkMeasures MeasureWalks(const Pavement& p) {
  WalkMeasures m;
  for (const Walked& who : p.walked) {
    const std::vector<Vec2> at = Smoothed(who.seen);
    for (size_t first = 0; first + kSeenSamples <= at.size(); first += kSeenSamples) MeasureWindow(at, first, &m);
    if (!at.empty() && Length(at.back() - at.front()) > 4) MeasurePace(at, &m);
  }
  MeasurePairs(p, &m);
  const double share = 1.0 / std::max(1, m.windows);
  m.speed_mps *= share, m.speed_deviation_mps *= share, m.acceleration_mps2 *= share, m.turn_dps *= share;
  for (size_t k = 0; k < 5; ++k) m.correlation[k] = m.variance[k] > 0 ? m.together[k] / m.variance[k] : 0;
  return m;
}

inline double QuantileOf(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<size_t>(share * static_cast<double>(values.size() - 1))];
}

}  // namespace flaneur
