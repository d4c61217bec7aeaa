// Work on all cores.
#pragma once
#include <cstddef>
#include <functional>

namespace flaneur {

// Calls work(0) ... work(count - 1), each once, on as many threads as there are cores, in any order; returns when all are done.
// Of exceptions that calls throw, the one of the least index is thrown here again; calls that had not begun by then are left out.
void ParallelFor(size_t count, const std::function<void(size_t)>& work);

}  // namespace flaneur
