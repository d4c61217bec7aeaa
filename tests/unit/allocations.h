// Counts what operator new gives out in the program that includes this; for one source file of a program.
#pragma once
#include <atomic>
#include <cstdlib>
#include <new>

inline std::atomic<long> allocations = 0;  // in whatever thread

// Not inlined: where only one of a pair is, GCC 12 takes them for a mismatch.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
// The standard library's sorts ask for their scratch so.
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size > 0 ? size : 1);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
