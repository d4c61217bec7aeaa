#include "runtime/desktop/icon.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace flaneur {
namespace {

// Shapes in a square of side 1, y down: the signed distance to their edge, negative inside.
float Disc(float x, float y, float middle_x, float middle_y, float radius) {
  return std::hypot(x - middle_x, y - middle_y) - radius;
}

float RoundedBox(float x, float y, float half, float corner) {
  const float dx = std::abs(x - 0.5f) - half + corner, dy = std::abs(y - 0.5f) - half + corner;
  return std::hypot(std::max(dx, 0.0f), std::max(dy, 0.0f)) + std::min(std::max(dx, dy), 0.0f) - corner;
}

// From one point to the other, so thick.
float Stroke(float x, float y, std::array<float, 4> line, float radius) {
  const float wide = line[2] - line[0], high = line[3] - line[1];
  const float along =
      std::clamp(((x - line[0]) * wide + (y - line[1]) * high) / (wide * wide + high * high), 0.0f, 1.0f);
  return std::hypot(x - line[0] - along * wide, y - line[1] - along * high) - radius;
}

float Gate(float x, float y) {
  constexpr float kFoot = 0.86f, kSpring = 0.48f, kHalf = 0.3f;
  return y < kSpring ? Disc(x, y, 0.5f, kSpring, kHalf) : std::max(std::abs(x - 0.5f) - kHalf, y - kFoot);
}

float Walker(float x, float y) {
  const float body = Stroke(x, y, {0.5f, 0.45f, 0.5f, 0.6f}, 0.075f);
  const float legs =
      std::min(Stroke(x, y, {0.5f, 0.62f, 0.42f, 0.82f}, 0.035f), Stroke(x, y, {0.5f, 0.62f, 0.6f, 0.81f}, 0.035f));
  return std::min({Disc(x, y, 0.5f, 0.315f, 0.07f), body, legs});
}

struct Layer {
  float (*shape)(float x, float y);
  std::array<float, 3> rgb;
};

constexpr Layer kLayers[] = {{[](float x, float y) { return RoundedBox(x, y, 0.5f, 0.16f); }, {36, 28, 21}},
                             {Gate, {226, 164, 74}},
                             {Walker, {36, 28, 21}}};

}  // namespace

std::vector<uint8_t> IconPicture(int side_px) {
  const auto side = static_cast<size_t>(side_px);
  std::vector<uint8_t> rgba(4 * side * side);
  for (size_t k = 0; k < side * side; ++k) {
    const float x = (static_cast<float>(k % side) + 0.5f) / static_cast<float>(side_px);
    const float y = (static_cast<float>(k / side) + 0.5f) / static_cast<float>(side_px);
    std::array<float, 3> rgb = kLayers[0].rgb;
    for (const Layer& layer : kLayers) {
      const float share = std::clamp(0.5f - layer.shape(x, y) * static_cast<float>(side_px), 0.0f, 1.0f);
      for (size_t c = 0; c < 3; ++c) rgb[c] += share * (layer.rgb[c] - rgb[c]);
      if (&layer == kLayers) rgba[4 * k + 3] = static_cast<uint8_t>(255 * share);
    }
    for (size_t c = 0; c < 3; ++c) rgba[4 * k + c] = static_cast<uint8_t>(rgb[c]);
  }
  return rgba;
}

}  // namespace flaneur
