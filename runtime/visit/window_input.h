// What a visitor's hands do, as a window sees it. Keys and gamepad buttons have names, for settings that people write.
#pragma once
#include <bitset>
#include <functional>
#include <string>
#include <vector>

#include "runtime/base/math.h"

namespace flaneur {

inline constexpr int kInputCodes = 512;  // of keys and gamepad buttons
inline constexpr int kFirstMouseCode =
    390;                                   // of the mouse's buttons, the left one first, which has a meaning of its own
inline constexpr int kFirstPadCode = 400;  // of the gamepad buttons, behind all keys

struct WindowInput {
  std::bitset<kInputCodes> down;  // or pressed since the last call, however shortly
  Vec2 turned_px;  // by the mouse: x to the right, y down; where the pointer is free, while its left button is held
  Vec2 left_stick, right_stick;  // of the first gamepad: x to the right, y up, each -1 to 1
  std::vector<Vec2> clicks;      // 0 to 1 from the picture's upper left corner; its middle where the pointer is caught
  Vec2 pointer{-1, -1};          // likewise; negative where it is caught
  bool pressed = false;          // its left button
  bool close = false;
};

// Such as "w", "left_shift", "page_up" or "pad_a"; -1 for others.
int InputCode(const std::string& name);
std::string InputName(int code);  // empty where there is none
std::vector<std::string> InputNames();
// What stands on a key of the visitor's own keyboard; empty where that is not known.
using KeyLayout = std::function<std::string(int code)>;
// What stands on the key or button, for people to read: "W", "Page Up"; letters by the keyboard's layout.
std::string InputLabel(int code, const KeyLayout& layout);
bool IsGamepadCode(int code);

}  // namespace flaneur
