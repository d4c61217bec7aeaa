// What people carry or wear besides their level: geometry of its own, within the triangle budget.
#pragma once
#include <cstdint>
#include <vector>

namespace flaneur {

inline constexpr float kPropReach_m = 35;  // beyond it props are not drawn,
inline constexpr float kPropFade_m = 7;    // and over so much before it they fade

struct PropCost {
  int triangles = 0;
  float share = 0;  // of the people
  int slot = 0;     // nobody has two of one slot
};

// Somebody in view and within reach whose avatar has props.
struct PropBearer { int id = 0; const std::vector<PropCost>* props = nullptr; float distance_m = 0; };

struct Props {
  std::vector<uint8_t> shown;       // by id; bit k: the k-th prop of their avatar
  int64_t triangles = 0;            // of all that are shown
  std::vector<PropBearer> bearers;  // of this step, to be set before ChooseProps

  std::vector<uint8_t> known;       // by id; scratch: whether they were among the bearers of the last step
  std::vector<int> before;          // scratch: ids of those
};

// What a person has, by id alone; bit k: the k-th.
uint8_t PropsOf(const std::vector<PropCost>& props, int id);

// Whose props are shown. They may take `room_triangles` together: who has shown them keeps them before others get any, the nearest
// first, and nothing appears on who is in view already. `next_id`: above all ids.
void ChooseProps(int64_t room_triangles, int next_id, Props* state);

}  // namespace flaneur
