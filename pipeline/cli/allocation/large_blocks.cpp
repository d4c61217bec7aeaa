// new and delete of a program that moves packs of 100 MB about: large blocks lie in the system's large pages, where it
// has them. Fresh memory costs by the page, often more than what is done with it. Sanitizers have their own.
#include <cstdint>
#include <cstdlib>
#include <new>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define FLANEUR_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define FLANEUR_SANITIZED
#endif
#endif

#if defined(__linux__) && !defined(FLANEUR_SANITIZED)
#include <sys/mman.h>

namespace {

constexpr size_t kPage_bytes = size_t{2} << 20, kLarge_bytes = 2 * kPage_bytes;

void* Large(size_t bytes) {
  if (bytes > SIZE_MAX - kPage_bytes) return nullptr;
  void* block = std::aligned_alloc(kPage_bytes, (bytes + kPage_bytes - 1) / kPage_bytes * kPage_bytes);
  if (block != nullptr) ::madvise(block, bytes / kPage_bytes * kPage_bytes, MADV_HUGEPAGE);
  return block;
}

}  // namespace

void* operator new(size_t bytes) {
  while (true) {
    if (void* block = bytes < kLarge_bytes ? std::malloc(bytes > 0 ? bytes : 1) : Large(bytes)) return block;
    const std::new_handler handler = std::get_new_handler();
    if (handler == nullptr) throw std::bad_alloc();
    handler();
  }
}
void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, size_t) noexcept { std::free(block); }
#endif
