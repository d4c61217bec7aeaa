// What people carry or wear besides their level: geometry of its own, within the triangle budget.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "runtime/tour_data/avatar_data.h"

namespace flaneur {

inline constexpr float kPropReach_m = 35;  // beyond it props are not drawn,
inline constexpr float kPropFade_m = 7;    // and over so much before it they fade

// Somebody in view and within reach whose avatar has props. doing: what the props of that clip are for.
struct PropBearer {
  int slot = 0, id = 0;
  const std::vector<Prop>* props = nullptr;
  float distance_m = 0;
  const std::string* doing = nullptr;  // name of the clip; null: nothing
};

struct Props {
  int64_t triangles = 0;            // of all that are shown
  std::vector<PropBearer> bearers;  // of this step, to be set before ChooseProps

  struct Memory {
    int id = -1;
    uint8_t shown = 0;
    bool bore = false, served = false;
  };                           // bore: was among the bearers of the last step
  std::vector<Memory> memory;  // by slot
  std::vector<int> before;     // slots of the last step's bearers
};

// What a person has, by id and by what they do alone; bit k: the k-th.
uint8_t PropsOf(const std::vector<Prop>& props, int id, const std::string* doing = nullptr);

// Whose props are shown. They may take `room_triangles` together: who has shown them keeps them before others get any,
// the nearest first, and nothing appears on who is in view already.
void ChooseProps(int64_t room_triangles, Props* state);

// Those that are shown; bit k: the k-th.
inline uint8_t ShownProps(const Props& state, int slot, int id) {
  const auto at = static_cast<size_t>(slot);
  return at < state.memory.size() && state.memory[at].id == id ? state.memory[at].shown : uint8_t{0};
}

}  // namespace flaneur
