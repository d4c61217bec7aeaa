// Work in equal strides on all threads.
#pragma once
#include <cstddef>

#include "runtime/base/jobs.h"

namespace flaneur {

// Calls work(first, step) once a thread: each takes first, first + step, first + 2 step, ... What comes out must not
// depend on how many there are.
template <typename Work>
void InStrides(Jobs* jobs, const Work& work) {
  const size_t step = 1 + (jobs != nullptr ? jobs->threads() : 0);
  ParallelFor(jobs, step, [&](size_t first) { work(first, step); });
}

}  // namespace flaneur
