// Times of single steps, by the thread's own clock: other work on the machine disturbs it least.
#pragma once
#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <vector>

namespace flaneur {

inline double ThreadTime_ms() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

// Runs `step` for every iteration; the median and the least of what the iterations took become counters.
template <typename Step>
void TimeSteps(benchmark::State& state, Step step, double (*clock_ms)() = ThreadTime_ms) {
  std::vector<double> took_ms;
  for (auto _ : state) {
    const double before_ms = clock_ms();
    step();
    took_ms.push_back(clock_ms() - before_ms);
  }
  std::sort(took_ms.begin(), took_ms.end());
  state.counters["median_ms"] = took_ms[took_ms.size() / 2];
  state.counters["least_ms"] = took_ms.front();
}

}  // namespace flaneur
