#include "runtime/walk/point_walk.h"

#include <algorithm>
#include <cmath>

#include "runtime/walk/visitor.h"

namespace flaneur {
namespace {

constexpr float kFarthest_m = 80;
constexpr float kMarch_m = 0.15f;

}  // namespace

std::optional<Vec2> GroundAt(const Walkable& w, const CameraState& camera, Vec2 place, float aspect) {
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
  const float eye_m = HeightAt(w, camera.view.position) + camera.eye_height_m;
  Vec2 last = camera.view.position;
  for (float far_m = 0; far_m < kFarthest_m; far_m += kMarch_m) {
    const Vec2 p = camera.view.position + direction * far_m;
    if (!IsFree(w, p) && InsideObstacle(w, p) && far_m > 0) return last;
    if (!OnGround(w, p)) continue;
    last = p;
    if (eye_m + slope * far_m <= HeightAt(w, p)) return p;
  }
  return std::nullopt;
}

void SetOut(Vec2 place, const VisitorInTown& v) {
  PointWalk& walk = v.visitor.point_walk;
  walk = {};
  const int cell = FreeCellFor(v.town.walkable, place);
  if (cell < 0) return;
  walk.route = {{v.visitor.camera.view.position}, {0}};
  v.visitor.stuck_s = 0;
  const Vec2 to = IsFree(v.town.walkable, place) ? place : CellCenter(v.town.walkable, cell);
  if (!ExtendRoute(v.town.walkable, to, &v.town.crowd.search, &walk.route)) walk = {};
}

}  // namespace flaneur
