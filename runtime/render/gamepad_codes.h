// Where a gamepad's buttons stand among the input codes: behind all keys. Internal to runtime/render.
#pragma once

namespace flaneur {

inline constexpr int kFirstPadCode = 400;
constexpr int PadCode(int button) { return kFirstPadCode + button; }

}  // namespace flaneur
