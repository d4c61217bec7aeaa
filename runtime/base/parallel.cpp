#include "runtime/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace flaneur {

void ParallelFor(size_t count, const std::function<void(size_t)>& work) {
  std::atomic<size_t> next{0};
  std::exception_ptr failure;
  size_t failed = count;
  std::mutex failure_mutex;
  const auto run = [&] {
    for (size_t i = next++; i < count; i = next++) {
      try {
        work(i);
      } catch (...) {
        const std::lock_guard lock(failure_mutex);
        if (i < failed) failure = std::current_exception(), failed = i;
        next = count;  // earlier ones have begun: the first failure of all is found
      }
    }
  };
  std::vector<std::thread> threads;
  const size_t cores = std::max<size_t>(1, std::thread::hardware_concurrency());
  for (size_t t = 1; t < std::min(cores, count); ++t) threads.emplace_back(run);
  run();
  for (std::thread& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace flaneur
