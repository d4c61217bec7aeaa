#include "runtime/control/fades.h"

#include <algorithm>

namespace flaneur {

void PassFades(float step_s, int64_t budget_triangles, int next_id, Fades* f) {
  f->at_once.assign(static_cast<size_t>(next_id), 0);
  for (Fades::Fade& fade : f->running) fade.left_s -= step_s;
  std::erase_if(f->running, [](const Fades::Fade& fade) { return fade.left_s <= 0; });
  f->triangles = 0;
  for (const Fades::Fade& fade : f->running) f->triangles += fade.triangles;
  if (f->triangles <= budget_triangles) return;
  for (const Fades::Fade& fade : f->running) f->at_once[static_cast<size_t>(fade.id)] = 1;
  f->running.clear();
  f->triangles = 0;
}

int64_t BeginFade(int id, int triangles, int64_t room_triangles, Fades* f) {
  if (triangles > room_triangles) {
    f->at_once[static_cast<size_t>(id)] = 1;
    return 0;
  }
  f->running.push_back({id, triangles, kFade_s});
  f->triangles += triangles;
  return triangles;
}

}  // namespace flaneur
