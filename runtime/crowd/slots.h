// Places in arrays that other rooms keep about people. People come and go all day, and their ids are never used again;
// a slot is, once its person has gone. The id tells whose a slot is, as the generation of a handle does: an entry with
// another id is somebody else's.
#pragma once
#include <cstddef>
#include <deque>
#include <vector>

namespace flaneur {

// A slot rests until so many others have been given back after it, so that what fades where somebody went is over by
// then.
inline constexpr size_t kRestingSlots = 64;

struct Slots {
  std::vector<int> owner;   // by slot: the id of who has it; -1: nobody
  std::deque<int> resting;  // given back, the longest first
};

inline int TakeSlot(int id, Slots* slots) {
  if (slots->resting.size() <= kRestingSlots) {
    slots->owner.push_back(id);
    return static_cast<int>(slots->owner.size()) - 1;
  }
  const int slot = slots->resting.front();
  slots->resting.pop_front();
  slots->owner[static_cast<size_t>(slot)] = id;
  return slot;
}

inline void GiveBackSlot(int slot, Slots* slots) {
  slots->owner[static_cast<size_t>(slot)] = -1;
  slots->resting.push_back(slot);
}

// What is kept about whoever has the slot now, begun anew where it was somebody else's. Entry: has a member `id`.
template <typename Entry>
Entry& EntryOf(int slot, int id, std::vector<Entry>* entries) {
  const auto at = static_cast<size_t>(slot);
  if (entries->size() <= at) entries->resize(at + 1);
  Entry& entry = (*entries)[at];
  if (entry.id != id) entry = Entry{}, entry.id = id;
  return entry;
}

}  // namespace flaneur
