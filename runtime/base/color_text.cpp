#include "runtime/base/color_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace flaneur {

std::optional<Vec3> ColorFromText(std::string_view text) {
  if (text.size() != 7 || text[0] != '#') return std::nullopt;
  unsigned bits = 0;
  const auto [end, error] = std::from_chars(text.data() + 1, text.data() + text.size(), bits, 16);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  const auto channel = [&](unsigned shift) { return static_cast<float>((bits >> shift) & 255) / 255; };
  return Vec3{channel(16), channel(8), channel(0)};
}

std::string TextFromColor(Vec3 color) {
  const auto byte = [](float value) { return static_cast<int>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255)); };
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", byte(color.x) & 255, byte(color.y) & 255, byte(color.z) & 255);
  return text;
}

}  // namespace flaneur
