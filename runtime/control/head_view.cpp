#include "runtime/control/head_view.h"

namespace flaneur {
namespace {

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
// less than half a turn, and the edges of that are edges of the cone. An eye beside the place sees along them what,
// from the place, lies beyond them by the angle under which the way to the eye is seen from there.
HeadView ViewOfHead(Vec2 place, std::span<const EyeFrustum> eyes) {
  HeadView head;
  if (eyes.empty()) return head;
  const EyeFrustum& first = eyes.front();
  const Vec3 middle = first.ahead + first.right * ((first.left_tangent + first.right_tangent) / 2) +
                      first.up * ((first.lower_tangent + first.upper_tangent) / 2);
  const float middle_rad = std::atan2(middle.y, middle.x);
  float low_rad = 0, high_rad = 0, aside_m = 0;
  head.is_bounded = true;
  for (const EyeFrustum& e : eyes) {
    head.is_bounded = head.is_bounded && !SeesVertical(e);
    aside_m = std::max(aside_m, Length(Vec2{e.place.x, e.place.y} - place));
    for (const float x : {e.left_tangent, e.right_tangent}) {
      for (const float y : {e.lower_tangent, e.upper_tangent}) {
        const Vec3 edge = e.ahead + e.right * x + e.up * y;
        const float off_rad = Wrapped(std::atan2(edge.y, edge.x) - middle_rad);
        low_rad = std::min(low_rad, off_rad);
        high_rad = std::max(high_rad, off_rad);
      }
    }
  }
  const float aside_rad = std::asin(std::min(1.0f, aside_m / kNearestToHead_m));
  head.fov_rad = high_rad - low_rad + 2 * aside_rad;
  head.yaw_rad = Wrapped(middle_rad + (low_rad + high_rad) / 2);
  head.pitch_rad = std::asin(std::clamp(first.ahead.z, -1.0f, 1.0f));
  head.is_bounded = head.is_bounded && head.fov_rad < kWidestHead_rad;
  if (head.is_bounded) return head;
  head.fov_rad = kWidestHead_rad;
  head.yaw_rad = std::atan2(first.ahead.y, first.ahead.x);
  return head;
}

}  // namespace flaneur
