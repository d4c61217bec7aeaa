#include "runtime/control/head_view.h"

namespace flaneur {
namespace {

constexpr float kWidest_rad = 170 * kPi / 180;

// Whether straight up or down lies within the eye's picture.
bool SeesVertical(const EyeFrustum& e) {
  for (const float vertical : {-1.0f, 1.0f}) {
    const float ahead = vertical * e.ahead.z;
    if (ahead <= 0) continue;
    const float right = vertical * e.right.z / ahead, up = vertical * e.up.z / ahead;
    if (right >= e.left_tangent && right <= e.right_tangent && up >= e.lower_tangent && up <= e.upper_tangent)
      return true;
  }
  return false;
}

float Wrapped(float angle_rad) { return std::remainder(angle_rad, 2 * kPi); }

}  // namespace

// What an eye sees is a cone of four edges. Where the vertical is not within it, its shadow on the ground is a wedge of
// less than half a turn, and the edges of that are edges of the cone.
HeadView ViewOfHead(Vec2 place, std::span<const EyeFrustum> eyes) {
  HeadView head;
  if (eyes.empty()) return head;
  const EyeFrustum& first = eyes.front();
  const Vec3 middle = first.ahead + first.right * ((first.left_tangent + first.right_tangent) / 2) +
                      first.up * ((first.lower_tangent + first.upper_tangent) / 2);
  const float middle_rad = std::atan2(middle.y, middle.x);
  float low_rad = 0, high_rad = 0;
  head.is_bounded = true;
  for (const EyeFrustum& e : eyes) {
    head.is_bounded = head.is_bounded && !SeesVertical(e);
    head.aside_m = std::max(head.aside_m, Length(Vec2{e.place.x, e.place.y} - place));
    for (const float x : {e.left_tangent, e.right_tangent}) {
      for (const float y : {e.lower_tangent, e.upper_tangent}) {
        const Vec3 edge = e.ahead + e.right * x + e.up * y;
        const float off_rad = Wrapped(std::atan2(edge.y, edge.x) - middle_rad);
        low_rad = std::min(low_rad, off_rad);
        high_rad = std::max(high_rad, off_rad);
      }
    }
  }
  head.fov_rad = high_rad - low_rad;
  head.yaw_rad = Wrapped(middle_rad + (low_rad + high_rad) / 2);
  head.is_bounded = head.is_bounded && head.fov_rad < kWidest_rad;
  return head;
}

ViewCamera Behind(const ViewCamera& camera, float aside_m) {
  ViewCamera behind = camera;
  const Vec2 axis{std::cos(camera.yaw_rad), std::sin(camera.yaw_rad)};
  behind.position = camera.position - axis * (aside_m / std::sin(camera.fov_rad / 2));
  return behind;
}

MotionLimits WithHead(MotionLimits limits) {
  limits.yaw_rate_radps = std::max(limits.yaw_rate_radps, kHeadTurn_radps);
  limits.camera_speed_mps += kHeadSpeed_mps;
  limits.reach_m += kHeadReach_m;
  limits.reach_grows_m = 0;  // the wedge holds all that an eye sees, however it is pitched
  return limits;
}

}  // namespace flaneur
