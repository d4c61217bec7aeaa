// Things behind ids. Whoever has found one keeps it alive, whatever happens to its id meanwhile.
#pragma once
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace flaneur {

// Id: a struct of `index1` (0: none) and `generation`.
template <typename Id, typename Thing>
class IdPool {
 public:
  Id Add(std::shared_ptr<Thing> thing) {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) {
      free_.reserve(slots_.size() + 1);  // so that Remove needs no memory
      slots_.emplace_back();
      free_.push_back(static_cast<uint32_t>(slots_.size() - 1));
    }
    const uint32_t index = free_.back();
    free_.pop_back();
    slots_[index].thing = std::move(thing);
    return {index + 1, slots_[index].generation};
  }

  // Null where there is none.
  std::shared_ptr<Thing> Find(Id id) const {
    const std::lock_guard lock(mutex_);
    return IsThere(id) ? slots_[id.index1 - 1].thing : nullptr;
  }

  // What was there, so that it ends outside of the lock.
  std::shared_ptr<Thing> Remove(Id id) {
    const std::lock_guard lock(mutex_);
    if (!IsThere(id)) return nullptr;
    Slot& slot = slots_[id.index1 - 1];
    ++slot.generation;
    if (slot.generation != 0) free_.push_back(id.index1 - 1);  // else it has had all its ids
    return std::exchange(slot.thing, nullptr);
  }

 private:
  struct Slot {
    std::shared_ptr<Thing> thing;
    uint32_t generation = 1;
  };

  bool IsThere(Id id) const {
    return id.index1 > 0 && id.index1 <= slots_.size() && slots_[id.index1 - 1].generation == id.generation &&
           slots_[id.index1 - 1].thing;
  }

  mutable std::mutex mutex_;
  std::vector<Slot> slots_;
  std::vector<uint32_t> free_;
};

}  // namespace flaneur
