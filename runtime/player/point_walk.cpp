#include "runtime/player/point_walk.h"

#include <algorithm>
#include <cmath>

#include "runtime/player/simulation.h"

namespace flaneur {
namespace {

constexpr float kFarthest_m = 80;
constexpr float kMarch_m = 0.15f;

}  // namespace

std::optional<Vec2> GroundAt(const Simulation& s, Vec2 place, float aspect) {
  const CameraState& camera = s.camera;
  const float half = std::tan(camera.view.fov_rad / 2);
  const float right = (2 * place.x - 1) * half, up = (1 - 2 * place.y) * half / aspect;
  const float ahead = std::cos(camera.pitch_rad) - up * std::sin(camera.pitch_rad);
  const float rise = std::sin(camera.pitch_rad) + up * std::cos(camera.pitch_rad);
  const Vec2 front{std::cos(camera.view.yaw_rad), std::sin(camera.view.yaw_rad)};
  const Vec2 along = front * ahead + Vec2{front.y, -front.x} * right;
  const float along_m = Length(along);
  if (along_m < 1e-4f) return camera.view.position;  // straight down
  const Vec2 direction = along * (1 / along_m);
  const float slope = rise / along_m;
  const float eye_m = HeightAt(s.walkable, camera.view.position) + camera.eye_height_m;
  Vec2 last = camera.view.position;
  for (float far_m = 0; far_m < kFarthest_m; far_m += kMarch_m) {
    const Vec2 p = camera.view.position + direction * far_m;
    if (!IsFree(s.walkable, p) && InsideObstacle(s.walkable, p) && far_m > 0) return last;
    if (!OnGround(s.walkable, p)) continue;
    last = p;
    if (eye_m + slope * far_m <= HeightAt(s.walkable, p)) return p;
  }
  return std::nullopt;
}

void SetOut(Vec2 place, Simulation* s) {
  PointWalk& walk = s->point_walk;
  walk = {};
  const int cell = FreeCellFor(s->walkable, place);
  if (cell < 0) return;
  walk.route = {{s->camera.view.position}, {0}};
  s->stuck_s = 0;
  const Vec2 to = IsFree(s->walkable, place) ? place : CellCenter(s->walkable, cell);
  if (!ExtendRoute(s->walkable, to, &s->crowd.search, &walk.route)) walk = {};
}

}  // namespace flaneur
