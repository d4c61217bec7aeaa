#include "runtime/control/props.h"

#include <algorithm>

#include "runtime/base/random.h"

namespace flaneur {
namespace {

enum Known : uint8_t { kNew, kBefore, kNow };

int TrianglesOf(const std::vector<PropCost>& props, uint8_t chosen) {
  int triangles = 0;
  for (size_t k = 0; k < props.size(); ++k) triangles += (chosen >> k & 1) != 0 ? props[k].triangles : 0;
  return triangles;
}

}  // namespace

uint8_t PropsOf(const std::vector<PropCost>& props, int id) {
  uint8_t chosen = 0;
  for (size_t k = 0; k < props.size(); ++k) {
    // One draw for each slot, which its props share out among them.
    Random random{static_cast<uint64_t>(id) * 64 + static_cast<uint64_t>(props[k].slot)};
    float drawn = random.Uniform();
    for (size_t other = 0; other < k; ++other) drawn -= props[other].slot == props[k].slot ? props[other].share : 0;
    if (drawn >= 0 && drawn < props[k].share) chosen = static_cast<uint8_t>(chosen | 1u << k);
  }
  return chosen;
}

void ChooseProps(int64_t room_triangles, int next_id, Props* state) {
  Props& p = *state;
  p.shown.resize(static_cast<size_t>(next_id), 0);
  p.known.resize(static_cast<size_t>(next_id), kNew);
  p.triangles = 0;
  std::sort(p.bearers.begin(), p.bearers.end(), [](const PropBearer& a, const PropBearer& b) {
    return a.distance_m != b.distance_m ? a.distance_m < b.distance_m : a.id < b.id;
  });
  for (const bool anew : {false, true}) {
    for (const PropBearer& bearer : p.bearers) {
      const auto id = static_cast<size_t>(bearer.id);
      if ((p.known[id] == kNew) != anew || p.known[id] == kNow) continue;
      if (anew) p.shown[id] = PropsOf(*bearer.props, bearer.id);
      const int triangles = TrianglesOf(*bearer.props, p.shown[id]);
      if (p.triangles + triangles > room_triangles) p.shown[id] = 0;
      else p.triangles += triangles;
      p.known[id] = kNow;
    }
  }
  for (int before : p.before) {
    const auto id = static_cast<size_t>(before);
    if (p.known[id] == kBefore) p.known[id] = kNew, p.shown[id] = 0;
  }
  p.before.clear();
  for (const PropBearer& bearer : p.bearers) {
    p.known[static_cast<size_t>(bearer.id)] = kBefore;
    p.before.push_back(bearer.id);
  }
}

}  // namespace flaneur
