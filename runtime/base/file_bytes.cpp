#include "runtime/base/file_bytes.h"

#include <sys/mman.h>

#include <cstdlib>
#include <new>

namespace flaneur {
namespace {

// Of large room: the system hands it out in fewer and larger pages, where it has them.
void AskForLargePages([[maybe_unused]] void* room, [[maybe_unused]] size_t count) {
#ifdef MADV_HUGEPAGE
  constexpr uintptr_t kPage_bytes = 4096;
  const auto first = (reinterpret_cast<uintptr_t>(room) + kPage_bytes - 1) / kPage_bytes * kPage_bytes;
  const uintptr_t end = (reinterpret_cast<uintptr_t>(room) + count) / kPage_bytes * kPage_bytes;
  if (first < end) ::madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
#endif
}

}  // namespace

FileBytes::FileBytes(std::vector<uint8_t> bytes) {
  const auto owner = std::make_shared<std::vector<uint8_t>>(std::move(bytes));
  bytes_ = *owner;
  owner_ = owner;
}

FileBytes FileBytes::Room(size_t count) {
  FileBytes room;
  if (count == 0) return room;
  void* memory = std::malloc(count);
  if (memory == nullptr) throw std::bad_alloc();
  room.owner_ = std::shared_ptr<void>(memory, std::free);
  room.bytes_ = {static_cast<uint8_t*>(memory), count};
  AskForLargePages(memory, count);
  return room;
}

}  // namespace flaneur
