#include "runtime/control/props.h"

#include <algorithm>

#include "runtime/base/random.h"
#include "runtime/crowd/slots.h"

namespace flaneur {
namespace {

int TrianglesOf(const std::vector<Prop>& props, uint8_t chosen) {
  int triangles = 0;
  for (size_t k = 0; k < props.size(); ++k) triangles += (chosen >> k & 1) != 0 ? props[k].triangles : 0;
  return triangles;
}

bool ShareASlot(const Prop& a, const Prop& b) {
  return &a == &b || (!a.slot.empty() && a.slot == b.slot && a.clip == b.clip);
}

// The props of one clip, or, `clip` empty, those that need none.
uint8_t PropsFor(const std::vector<Prop>& props, int id, const std::string& clip) {
  uint8_t chosen = 0;
  for (size_t k = 0; k < props.size(); ++k) {
    if (props[k].clip != clip) continue;
    size_t first = 0;
    while (!ShareASlot(props[first], props[k])) ++first;
    // One draw for each slot, which its props share out among them.
    Random random{static_cast<uint64_t>(id) * 64 + static_cast<uint64_t>(first)};
    float drawn = random.Uniform();
    for (size_t other = first; other < k; ++other) drawn -= ShareASlot(props[other], props[k]) ? props[other].share : 0;
    if (drawn >= 0 && drawn < props[k].share) chosen = static_cast<uint8_t>(chosen | 1u << k);
  }
  return chosen;
}

}  // namespace

uint8_t PropsOf(const std::vector<Prop>& props, int id, const std::string* doing) {
  const uint8_t usual = PropsFor(props, id, "");
  if (doing == nullptr || doing->empty()) return usual;
  uint8_t chosen = PropsFor(props, id, *doing);
  for (size_t k = 0; k < props.size(); ++k) {
    const bool laid_down = std::any_of(props.begin(), props.end(), [&](const Prop& tool) {
      return tool.clip == *doing && !tool.slot.empty() && tool.slot == props[k].slot;
    });
    if ((usual >> k & 1) != 0 && !laid_down) chosen = static_cast<uint8_t>(chosen | 1u << k);
  }
  return chosen;
}

void ChooseProps(int64_t room_triangles, Props* state) {
  Props& p = *state;
  p.triangles = 0;
  std::sort(p.bearers.begin(), p.bearers.end(), [](const PropBearer& a, const PropBearer& b) {
    return a.distance_m != b.distance_m ? a.distance_m < b.distance_m : a.id < b.id;
  });
  for (const bool anew : {false, true}) {
    for (const PropBearer& bearer : p.bearers) {
      Props::Memory& memory = EntryOf(bearer.slot, bearer.id, &p.memory);
      if (memory.served || memory.bore == anew) continue;
      if (anew) memory.shown = PropsOf(*bearer.props, bearer.id, bearer.doing);
      const int triangles = TrianglesOf(*bearer.props, memory.shown);
      if (p.triangles + triangles > room_triangles) memory.shown = 0;
      else p.triangles += triangles;
      memory.served = true;
    }
  }
  for (int slot : p.before) {
    Props::Memory& memory = p.memory[static_cast<size_t>(slot)];
    if (!memory.served) memory.bore = false, memory.shown = 0;
  }
  p.before.clear();
  for (const PropBearer& bearer : p.bearers) {
    Props::Memory& memory = p.memory[static_cast<size_t>(bearer.slot)];
    memory.bore = true;
    memory.served = false;
    p.before.push_back(bearer.slot);
  }
}

}  // namespace flaneur
