// Memory that is asked for before it is needed.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace flaneur {

// Brings what lies at p, which must be readable, into the processor's cache. WebAssembly knows no such request: there
// it is read.
inline void Fetch(const void* p) {
#ifdef __EMSCRIPTEN__
  static_cast<void>(*static_cast<const volatile uint8_t*>(p));
#else
  __builtin_prefetch(p);
#endif
}

// fetch(k) and visit(k) for each in order, some in a row by turns: what the next ones ask for comes side by side, also
// where a fetch is a read, while these are visited.
template <typename Fetches, typename Visits>
inline void FetchAndVisit(size_t first, size_t end, Fetches fetch, Visits visit) {
  constexpr size_t kInARow = 16;
  size_t fetched = first;
  for (size_t k = first; k < end;) {
    for (const size_t ahead = std::min(k + 2 * kInARow, end); fetched < ahead; ++fetched) fetch(fetched);
    for (const size_t last = std::min(k + kInARow, end); k < last; ++k) visit(k);
  }
}

}  // namespace flaneur
