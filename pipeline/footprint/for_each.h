// Work on several threads.
#pragma once
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace flaneur {

// Calls work(0) to work(count - 1), several at a time; 0 threads: one a core. What one of them throws is thrown here,
// once all threads have ended; the rest may be left out then.
template <typename Work>
void ForEach(size_t count, int threads, const Work& work) {
  const size_t most = threads > 0 ? static_cast<size_t>(threads) : std::max(1u, std::thread::hardware_concurrency());
  std::atomic<size_t> next{0};
  std::atomic_flag failed;
  std::exception_ptr failure;
  const auto worker = [&] {
    try {
      for (size_t i = next++; i < count; i = next++) work(i);
    } catch (...) {
      if (!failed.test_and_set()) failure = std::current_exception();
      next = count;
    }
  };
  {
    std::vector<std::jthread> others;
    for (size_t t = 1; t < std::min(count, most); ++t) others.emplace_back(worker);
    worker();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace flaneur
