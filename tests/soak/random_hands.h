// Hands that do anything whatever, the same for the same seed.
#pragma once
#include <random>
#include <string>

#include "runtime/visit/player_settings.h"
#include "runtime/visit/window_input.h"

namespace flaneur {

class RandomHands {
 public:
  explicit RandomHands(uint64_t seed) : random_(seed) {}

  // Keys and buttons held for a while or tapped, the mouse moved or thrown about, clicks inside and outside the
  // picture, sticks pushed.
  WindowInput Next();
  // Of the window; often as before, rarely 0 (hidden) or tiny.
  void NextSize(int* width_px, int* height_px);
  // Since the picture before: mostly a thirtieth of a second, sometimes nothing, rarely many seconds.
  float NextPause_s();
  // Some settings changed to what is in their range, as SETTING=VALUE.
  PlayerSettings NextSettings();

  double Share() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  int Below(int end) { return static_cast<int>(random_() % static_cast<uint64_t>(end)); }

 private:
  float Between(double least, double most) { return static_cast<float>(least + (most - least) * Share()); }

  std::mt19937_64 random_;
  WindowInput held_;
};

}  // namespace flaneur
