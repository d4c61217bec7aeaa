// Work on several threads.
#pragma once
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace flaneur {

// Calls work(0) to work(count - 1), several at a time; 0 threads: one a core.
template <typename Work>
void ForEach(size_t count, int threads, const Work& work) {
  const size_t most = threads > 0 ? static_cast<size_t>(threads) : std::max(1u, std::thread::hardware_concurrency());
  std::atomic<size_t> next{0};
  const auto worker = [&] {
    for (size_t i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::jthread> others;
  for (size_t t = 1; t < std::min(count, most); ++t) others.emplace_back(worker);
  worker();
}

}  // namespace flaneur
