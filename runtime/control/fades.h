// Levels on their way out. Who changes their level is drawn with both for a moment, so that nobody pops: the budget is about both.
#pragma once
#include <cstdint>
#include <vector>

namespace flaneur {

inline constexpr float kFade_s = 0.3f;

struct Fades {
  struct Fade { int id = 0, triangles = 0; float left_s = 0; };
  std::vector<Fade> running;
  int64_t triangles = 0;         // of all of them
  std::vector<uint8_t> at_once;  // by id: whose change of this frame is not faded, for want of budget
};

// A step later: those that are over go, and where the budget has become smaller than what fades, all do.
void PassFades(float step_s, int64_t budget_triangles, int next_id, Fades* fades);

// What was drawn with `triangles` begins to fade out, if they fit into `room_triangles`; else it goes at once. Returns what it takes.
int64_t BeginFade(int id, int triangles, int64_t room_triangles, Fades* fades);

}  // namespace flaneur
