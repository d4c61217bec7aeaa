#include "pipeline/rig/steps.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/array.h"

namespace flaneur {
namespace {

constexpr float kLow = 0.045f;       // of the leg's length: how near the ground a standing foot is
constexpr float kOnGround = 0.024f;  // of the leg's length: how near the ground a sole is on it
constexpr float kLoose = 0.4f;       // of the walking speed: what a standing foot may seem to move
constexpr float kStill = 0.25f;      // leg lengths a second, the same on the spot
constexpr float kWalks = 0.12f;      // leg lengths a second: slower is no walk
constexpr float kClear = 0.045f;     // of the leg's length: how high a swinging foot is over the ground at least
constexpr float kGroundShare = 0.02f, kStandShare = 0.4f;  // of the keys may have a sole lower: ever; in a walk
constexpr float kDip = 0.02f;                              // of the leg's length: less is a foot that rolls
constexpr size_t kGapShare = 6;  // of a walk's keys, one of so many: for longer who stands on no foot flies
constexpr int kGap = 2;          // keys: shorter gaps and stands are noise

size_t LowestOf(const std::vector<Vec3>& points) {
  return static_cast<size_t>(std::min_element(points.begin(), points.end(), [](Vec3 a, Vec3 b) { return a.y < b.y; }) -
                             points.begin());
}

// Without the sixth that is least and the sixth that is most. The mean, and not the median, so that feet which slide in
// the source come as far in the copy.
float TrimmedMean(std::vector<float> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const size_t cut = values.size() / 6;
  float sum = 0;
  for (size_t i = cut; i < values.size() - cut; ++i) sum += values[i];
  return sum / static_cast<float>(values.size() - 2 * cut);
}

// Runs of `value` no longer than kGap become the other.
void Close(bool value, bool loops, std::vector<bool>* flags) {
  const size_t n = flags->size();
  const auto at = [&](size_t i) { return (*flags)[i % n]; };
  if (std::all_of(flags->begin(), flags->end(), [&](bool f) { return f == value; })) return;
  for (size_t start = 0; start < n; ++start) {
    if (at(start) != value || (start == 0 ? (loops && at(n - 1) == value) : at(start - 1) == value)) continue;
    size_t length = 0;
    while (length < n && (loops || start + length < n) && at(start + length) == value) ++length;
    const bool open_end = !loops && (start == 0 || start + length == n);
    if (length > static_cast<size_t>(kGap) || open_end) continue;
    for (size_t i = 0; i < length; ++i) (*flags)[(start + i) % n] = !value;
  }
}

struct Stand {
  size_t first = 0, length = 0;
};

std::vector<Stand> StandsOf(const std::vector<bool>& stands, bool loops) {
  const size_t n = stands.size();
  std::vector<Stand> found;
  if (std::all_of(stands.begin(), stands.end(), [](bool s) { return s; })) return {{0, n}};
  for (size_t k = 0; k < n; ++k) {
    const bool before = k > 0 ? stands[k - 1] : loops && stands[n - 1];
    if (!stands[k] || before) continue;
    size_t length = 0;
    while (length < n && (loops || k + length < n) && stands[(k + length) % n]) ++length;
    found.push_back({k, length});
  }
  return found;
}

// The way of a standing foot's ankle, from where it first stands.
std::vector<Vec3> RollStand(const FootTrack& track, const Stand& stand, float step_m) {
  const size_t n = track.sole.size();
  std::vector<Vec3> way;
  Vec3 ankle;
  for (size_t i = 0; i < stand.length; ++i) {
    const std::vector<Vec3>& sole = track.sole[(stand.first + i) % n];
    ankle.y = -sole[LowestOf(sole)].y;
    way.push_back(ankle);
    if (i + 1 == stand.length) break;
    const std::vector<Vec3>& next = track.sole[(stand.first + i + 1) % n];
    size_t pivot = 0;  // lowest over both keys
    for (size_t p = 1; p < sole.size(); ++p) {
      if (sole[p].y + next[p].y < sole[pivot].y + next[pivot].y) pivot = p;
    }
    const Vec3 turned = next[pivot] - sole[pivot];
    ankle = ankle + Vec3{-turned.x, 0, -turned.z - step_m};
  }
  return way;
}

// As near to where the source's is as can be.
void Place(const FootTrack& track, const Stand& stand, std::vector<Vec3>* way) {
  const size_t n = track.wanted.size();
  Vec3 off;
  for (size_t i = 0; i < stand.length; ++i) off = off + track.wanted[(stand.first + i) % n] - (*way)[i];
  off = off * (1 / static_cast<float>(stand.length));
  off.y = 0;
  for (Vec3& p : *way) p = p + off;
}

float Smooth(float t) { return t * t * (3 - 2 * t); }

// Above the ground, and in the middle of a swing clear of it: a foot that skims it seems to slide.
void KeepAbove(const FootTrack& track, const std::vector<float>& clear_m, std::vector<Vec3>* ankles) {
  for (size_t k = 0; k < ankles->size(); ++k) {
    const float low = (*ankles)[k].y + (clear_m[k] > 0 ? track.lowest[k] : track.sole[k][LowestOf(track.sole[k])].y);
    if (low < clear_m[k]) (*ankles)[k].y += clear_m[k] - low;
  }
}

// How the lowest point of both soles moves from each key to the next, where it is lower than `height`.
std::vector<Vec3> WaysOfLowest(const Soles& left, const Soles& right, float height) {
  std::vector<Vec3> ways;
  for (size_t k = 0; k + 1 < left.size(); ++k) {
    float lowest = 1e30f;
    Vec3 way;
    for (const Soles* soles : {&left, &right}) {
      const std::vector<Vec3>&now = (*soles)[k], &then = (*soles)[k + 1];
      for (size_t p = 0; p < now.size(); ++p) {
        const float high = std::max(now[p].y, then[p].y);
        if (high < lowest) lowest = high, way = then[p] - now[p];
      }
    }
    if (lowest < height) ways.push_back(way);
  }
  return ways;
}

}  // namespace

float GroundUnder(std::vector<float> lowest, float leg, bool walks) {
  if (lowest.empty()) return 0;
  std::sort(lowest.begin(), lowest.end());
  const auto at = [&](float share) { return lowest[static_cast<size_t>(share * static_cast<float>(lowest.size()))]; };
  const float ground = at(kGroundShare), stands = at(kStandShare);
  return walks && stands - ground > kDip * leg ? stands : ground;
}

float SpeedOfSoles(const Soles& left, const Soles& right, float step_s, float leg) {
  std::vector<float> speeds;
  for (const Vec3 way : WaysOfLowest(left, right, kLow * leg)) speeds.push_back(-way.z / step_s);
  const float speed = TrimmedMean(std::move(speeds));
  return std::abs(speed) > kWalks * leg ? speed : 0;
}

float SlideOfSoles(const Soles& left, const Soles& right, float step_s, float leg, float speed) {
  if (!(speed > 0)) return 0;
  float sum = 0, count = 0;
  for (const Vec3 way : WaysOfLowest(left, right, kOnGround * leg)) {
    sum += Length({way.x / step_s, 0, way.z / step_s + speed}) / speed, count += 1;
  }
  return count > 0 ? sum / count : 0;
}

std::vector<bool> FindStance(const Soles& sole, float speed, float step_s, float leg, bool loops) {
  const size_t n = sole.size();
  std::vector<bool> stands(n);
  const float loose = std::max(kLoose * std::abs(speed), kStill * leg);
  for (size_t k = 0; k < n && !sole[k].empty(); ++k) {  // a leg may have no foot
    const size_t low = LowestOf(sole[k]);
    const size_t before = k > 0 ? k - 1 : loops ? n - 1 : 0, after = k + 1 < n ? k + 1 : loops ? 0 : n - 1;
    const float keys = static_cast<float>(k > 0 || loops) + static_cast<float>(k + 1 < n || loops);
    Vec3 velocity = (sole[after][low] - sole[before][low]) * (1 / (std::max(keys, 1.0f) * step_s));
    velocity.z += speed;
    velocity.y = 0;
    stands[k] = sole[k][low].y < kLow * leg && Length(velocity) < loose;
  }
  Close(false, loops, &stands);
  Close(true, loops, &stands);
  return stands;
}

void StandSomewhere(const Soles& left, const Soles& right, float leg, bool walks, std::vector<bool>* left_stands,
                    std::vector<bool>* right_stands) {
  std::vector<bool>&l = *left_stands, &r = *right_stands;
  const size_t n = l.size();
  std::vector<bool> lost(n);  // neither foot stands
  for (size_t k = 0; k < n; ++k) lost[k] = !l[k] && !r[k];
  const auto is_short = [&](size_t k) {
    size_t length = 1;
    for (size_t i = 1; i < n && lost[(k + i) % n]; ++i) ++length;
    for (size_t i = 1; i < n && lost[(k + n - i) % n]; ++i) ++length;
    return length <= 1 + n / kGapShare;
  };
  for (size_t k = 0; k < n; ++k) {
    if (!lost[k]) continue;
    if (left[k].empty() || right[k].empty()) continue;
    const float a = left[k][LowestOf(left[k])].y, b = right[k][LowestOf(right[k])].y;
    if (!(walks && is_short(k)) && std::min(a, b) > kLow * leg) continue;
    (a < b ? l : r)[k] = true;
  }
  for (size_t k = 0; walks && k < n; ++k) {
    const size_t next = (k + 1) % n;
    if ((l[k] && l[next]) || (r[k] && r[next]) || (!l[k] && !r[k]) || (!l[next] && !r[next])) continue;
    (l[k] ? l : r)[next] = true;  // who stood until now stands until the other does
  }
}

std::vector<Vec3> RollFoot(const FootTrack& track, float step_m, float leg_m, bool loops) {
  const size_t n = track.wanted.size();
  std::vector<float> clear_m(n, 0.0f);
  std::vector<Vec3> ankles = track.wanted;
  const std::vector<Stand> stands = StandsOf(track.stands, loops);
  for (const Stand& stand : stands) {
    std::vector<Vec3> way = RollStand(track, stand, step_m);
    Place(track, stand, &way);
    for (size_t i = 0; i < stand.length; ++i) ankles[(stand.first + i) % n] = way[i];
  }
  const auto offset = [&](size_t k) { return ankles[k % n] - track.wanted[k % n]; };
  for (size_t s = 0; s < stands.size(); ++s) {
    if (stands[s].length >= n) break;
    const bool last = s + 1 == stands.size();
    if (last && !loops) {
      for (size_t k = stands[s].first + stands[s].length; k < n; ++k) {
        ankles[k] = track.wanted[k] + offset(stands[s].first + stands[s].length - 1);
      }
      break;
    }
    const size_t from = stands[s].first + stands[s].length - 1;
    const size_t to = (last ? stands[0].first + n : stands[s + 1].first);
    const Vec3 begin = offset(from), end = offset(to);
    for (size_t k = from + 1; k < to; ++k) {
      const float t = Smooth(static_cast<float>(k - from) / static_cast<float>(to - from));
      ankles[k % n] = track.wanted[k % n] + begin * (1 - t) + end * t;
      const float through = static_cast<float>(k - from) / static_cast<float>(to - from);
      clear_m[k % n] = kClear * leg_m * std::sqrt(std::sin(kPi * through));
    }
  }
  KeepAbove(track, clear_m, &ankles);
  return ankles;
}

}  // namespace flaneur
