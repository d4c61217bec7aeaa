// Work in equal strides on all cores.
#pragma once
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace flaneur {

// 0: one a core. Results must not depend on it: a test tries others.
inline std::atomic<unsigned> thread_count = 0;

// Calls `work(first, step)` once a thread: each takes first, first + step, first + 2 step, ...
template <typename Work>
void RunOnThreads(const Work& work) {
  const unsigned wanted = thread_count > 0 ? thread_count.load() : std::thread::hardware_concurrency();
  const size_t count = std::clamp(wanted, 1u, 16u);
  std::vector<std::thread> threads;
  for (size_t i = 1; i < count; ++i) threads.emplace_back(work, i, count);
  work(size_t{0}, count);
  for (std::thread& thread : threads) thread.join();
}

}  // namespace flaneur
