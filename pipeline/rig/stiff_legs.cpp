#include "pipeline/rig/stiff_legs.h"

#include <algorithm>
#include <cmath>

#include "pipeline/rig/rig.h"

namespace flaneur {
namespace {

constexpr float kSlowest = 0.15f;  // legs a second: who is slower does not walk
constexpr float kClear = 0.05f;    // of the leg's length: how high a foot swings at least in the middle of its way

float MeanZ(const std::vector<Vec3>& points) {
  float sum = 0;
  for (const Vec3 p : points) sum += p.z;
  return sum / static_cast<float>(std::max<size_t>(points.size(), 1));
}

float LowestOf(const std::vector<Vec3>& points) {
  float low = 1e30f;
  for (const Vec3 p : points) low = std::min(low, p.y);
  return low;
}

// From key to key the leg stands that goes back faster. A single key between two of the other's is the other's too.
std::vector<size_t> Standing(const std::array<Soles, 2>& soles, size_t steps) {
  std::vector<size_t> standing(steps);
  const auto back = [&](size_t side, size_t k) { return MeanZ(soles[side][k]) - MeanZ(soles[side][k + 1]); };
  for (size_t k = 0; k < steps; ++k) standing[k] = back(kLeft, k) >= back(kRight, k) ? kLeft : kRight;
  for (size_t k = 0; k < steps; ++k) {
    const size_t before = standing[(k + steps - 1) % steps], after = standing[(k + 1) % steps];
    if (before == after) standing[k] = before;
  }
  return standing;
}

// What the sole's lowest point moves against the hips.
Vec3 WayOfLowest(const std::vector<Vec3>& now, const std::vector<Vec3>& next) {
  size_t lowest = 0;
  for (size_t i = 1; i < now.size(); ++i) {
    if (now[i].y + next[i].y < now[lowest].y + next[lowest].y) lowest = i;
  }
  return next[lowest] - now[lowest];
}

// In a ring, over a twelfth of it to either side: steps from heel to toe come to hips as slowly as knees would let
// them.
std::vector<float> Eased(const std::vector<float>& ring) {
  const size_t steps = ring.size(), reach = std::max<size_t>(1, steps / 12);
  std::vector<float> eased(steps);
  for (size_t k = 0; k < steps; ++k) {
    float sum = 0, weights = 0;
    for (size_t i = 0; i <= 2 * reach; ++i) {
      const float weight = static_cast<float>(reach + 1 - (i < reach ? reach - i : i - reach));
      sum += weight * ring[(k + i + steps - reach) % steps], weights += weight;
    }
    eased[k] = sum / weights;
  }
  return eased;
}

// 0 at both ends of a swing, 1 in most of it.
float MiddleOfSwing(float done) { return std::min(1.0f, 16 * done * (1 - done)); }

}  // namespace

StiffWalk WalkOnStiffLegs(const std::array<Soles, 2>& soles, float step_s, float leg_m) {
  StiffWalk walk;
  if (soles[kLeft].size() < 4 || soles[kLeft][0].empty() || soles[kRight][0].empty()) return walk;
  const size_t steps = soles[kLeft].size() - 1;
  const std::vector<size_t> standing = Standing(soles, steps);
  std::vector<Vec3> ways;
  Vec3 mean;
  for (size_t k = 0; k < steps; ++k) {
    ways.push_back(WayOfLowest(soles[standing[k]][k], soles[standing[k]][k + 1]));
    mean = mean + ways[k] * (1 / static_cast<float>(steps));
  }
  const bool both = std::count(standing.begin(), standing.end(), kLeft) % static_cast<std::ptrdiff_t>(steps) != 0;
  if (!both || -mean.z < kSlowest * leg_m * step_s) return walk;
  walk.speed = -mean.z / step_s;
  walk.aside_rad = std::atan2(-mean.x, -mean.z);

  Vec3 at, middle;
  std::vector<float> high;
  for (size_t k = 0; k < steps; ++k) {
    high.push_back(-LowestOf(soles[standing[k]][k]));
    walk.middle.push_back({at.x, 0, at.z});
    middle = middle + at * (1 / static_cast<float>(steps));
    at = at + mean - ways[k];
  }
  high = Eased(high);
  for (size_t k = 0; k < steps; ++k) walk.middle[k] = walk.middle[k] + Vec3{-middle.x, high[k], -middle.z};

  for (const size_t side : {kLeft, kRight}) {
    walk.lift[side].assign(steps, 0);
    for (size_t k = 0; k < steps; ++k) {
      size_t before = 0, after = 0;  // keys since it stood, and until it does
      while (before < steps && standing[(k + 2 * steps - 1 - before) % steps] != side) ++before;
      while (after < steps && standing[(k + after) % steps] != side) ++after;
      const float done = static_cast<float>(before) / static_cast<float>(std::max<size_t>(before + after, 1));
      const float low = LowestOf(soles[side][k]) + walk.middle[k].y;
      const bool stands = before == 0 || after == 0;
      walk.lift[side][k] = stands ? -low : std::max(0.0f, kClear * leg_m * MiddleOfSwing(done) - low);
    }
    walk.lift[side].push_back(walk.lift[side].front());
  }
  walk.middle.push_back(walk.middle.front());
  return walk;
}

}  // namespace flaneur
