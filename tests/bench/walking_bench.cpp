// Whether people walk like people: made-up situations like those that were recorded, measured as the recordings were,
// beside what was measured there. ETH and UCY recordings, 1,500 people, 5,845 windows of 2.8 s.
//
//     bench_walking [SEEDS]      # 4 of 300 s each; exit status 1: a mean is not within 0.8 to 1.25 of real people's
#include <cstdio>
#include <cstdlib>

#include "tests/unit/runtime/crowd/pavements.h"

namespace {

using namespace flaneur;

constexpr double kRealAhead_m = 0.21, kRealCorrelation[] = {0.82, 0.56, 0.30, -0.09, -0.36};
constexpr double kRealAheads_m[] = {0.02, 0.10, 0.21, 0.39, 0.85}, kRealAparts_m[] = {0.47, 0.61, 0.73, 0.89, 1.21};
constexpr double kShares[] = {0.05, 0.25, 0.5, 0.75, 0.95};

void Add(const WalkMeasures& m, WalkMeasures* all) {
  const double n = m.windows;
  all->speed_mps += n * m.speed_mps, all->speed_deviation_mps += n * m.speed_deviation_mps;
  all->acceleration_mps2 += n * m.acceleration_mps2, all->turn_dps += n * m.turn_dps, all->windows += m.windows;
  all->ahead_m.insert(all->ahead_m.end(), m.ahead_m.begin(), m.ahead_m.end());
  all->apart_m.insert(all->apart_m.end(), m.apart_m.begin(), m.apart_m.end());
  for (size_t k = 0; k < 5; ++k) all->together[k] += m.together[k], all->variance[k] += m.variance[k];
}

void PrintQuantiles(const char* what, const std::vector<double>& values, const double* real) {
  std::printf("%s, m:", what);
  for (size_t k = 0; k < 5; ++k) std::printf(" %.2f (%.2f)", QuantileOf(values, kShares[k]), real[k]);
  std::printf("\n");
}

bool Judge(const char* what, double ours, double real) {
  std::printf("%-38s %.3f, real %.3f: %.2f of it\n", what, ours, real, ours / real);
  return ours >= 0.8 * real && ours <= 1.25 * real;
}

}  // namespace

int main(int count, char** words) {
  const int seeds = count > 1 ? std::atoi(words[1]) : 4;
  double ours[3] = {}, real[3] = {};
  WalkMeasures pairs;
  std::array<double, 5> correlation{};
  std::printf("ours over real: speed deviation, acceleration, turning\n");
  const std::vector<PavementPlan> plans = Pavements();
  for (const PavementPlan& plan : plans) {
    WalkMeasures all;
    for (int seed = 1; seed <= seeds; ++seed) {
      Pavement p = MakePavement(plan, static_cast<uint64_t>(seed));
      RunPavement(300, &p);
      Add(MeasureWalks(p), &all);
    }
    const double n = all.windows, of[3] = {all.speed_deviation_mps / n, all.acceleration_mps2 / n, all.turn_dps / n};
    const double there[3] = {static_cast<double>(plan.real.speed_deviation_mps),
                             static_cast<double>(plan.real.acceleration_mps2), static_cast<double>(plan.real.turn_dps)};
    std::printf("  %-18s %.2f m/s, %5d windows: %.3f m/s (%.2f)  %.3f m/s2 (%.2f)  %.1f deg/s (%.2f)\n",
                plan.name.c_str(), all.speed_mps / n, all.windows, of[0], of[0] / there[0], of[1], of[1] / there[1],
                of[2], of[2] / there[2]);
    for (int k = 0; k < 3; ++k)
      ours[k] += static_cast<double>(plan.weight) * of[k], real[k] += static_cast<double>(plan.weight) * there[k];
    for (size_t k = 0; k < 5; ++k) correlation[k] += 0.2 * all.together[k] / all.variance[k];
    Add(all, &pairs);
  }
  bool like = Judge("speed deviation in 2.8 s, m/s", ours[0], real[0]);
  like &= Judge("mean absolute acceleration, m/s2", ours[1], real[1]);
  like &= Judge("mean absolute turn rate, deg/s", ours[2], real[2]);
  like &= Judge("one of a pair ahead, median, m", QuantileOf(pairs.ahead_m, 0.5), kRealAhead_m);
  PrintQuantiles("one of a pair ahead, 5 to 95 % (real)", pairs.ahead_m, kRealAheads_m);
  PrintQuantiles("a pair apart, 5 to 95 % (real)", pairs.apart_m, kRealAparts_m);
  std::printf("pace with itself after 0.4 to 6.4 s (real):");
  for (size_t k = 0; k < 5; ++k) std::printf(" %.2f (%.2f)", correlation[k], kRealCorrelation[k]);
  std::printf("\n");
  return like ? 0 : 1;
}
