// Work on so many threads as an option says.
#pragma once
#include <cstddef>

#include "runtime/base/jobs.h"

namespace flaneur {

// Calls work(0) to work(count - 1), several at a time. What one of them throws is thrown here, once all threads have
// ended; the rest may be left out then.
template <typename Work>
void ForEach(size_t count, int threads, const Work& work) {
  Jobs jobs(count > 1 ? OtherThreads(threads) : 0);
  ParallelFor(&jobs, count, work);
}

}  // namespace flaneur
