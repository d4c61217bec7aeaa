// Normals and colours as vertices hold them. Internal to runtime/render; no OpenGL.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "runtime/base/srgb.h"

namespace flaneur {

inline int8_t SignedByte(float v) { return static_cast<int8_t>(std::lround(std::clamp(v, -1.0f, 1.0f) * 127)); }
inline float FromSignedByte(int8_t b) { return static_cast<float>(b) / 127; }
inline uint8_t Byte(float v) { return static_cast<uint8_t>(std::clamp(v, 0.0f, 1.0f) * 255 + 0.5f); }

// Of a linear tint, as the display shows it. Pictures are multiplied by it before they are made linear: once a pixel
// instead of for every surface, and off by at most 3 of 255.
inline uint8_t SrgbByte(float linear) { return Byte(SrgbFromLinear(std::clamp(linear, 0.0f, 1.0f))); }

}  // namespace flaneur
