// Keys and buttons for people who play with one hand: all that visitors do lies on one half of a keyboard or gamepad.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "runtime/visit/player_settings.h"
#include "runtime/visit/window_input.h"

namespace flaneur {

// Of each action: the settings' own, less first keys that the settings give to another action, and on the keyboard or
// gamepad that is played with one hand those of its half.
std::array<std::vector<std::string>, kActions> KeysInForce(const PlayerSettings& settings);

// What the sticks ask for: x to the right, y ahead or up.
struct StickWishes {
  Vec2 walk, look;
};
// With both hands one stick walks and the other looks. With one hand its stick walks ahead and turns, and steps aside
// and looks up and down while the shoulder button above it is held.
StickWishes WishesOfSticks(const WindowInput& input, const PlayerSettings& settings);

}  // namespace flaneur
