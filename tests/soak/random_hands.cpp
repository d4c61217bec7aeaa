#include "tests/soak/random_hands.h"

namespace flaneur {

WindowInput RandomHands::Next() {
  static const std::vector<std::string> names = InputNames();
  held_.clicks.clear();
  held_.turned_px = {};
  if (Share() < 0.25)
    held_.down.flip(static_cast<size_t>(InputCode(names[static_cast<size_t>(Below(static_cast<int>(names.size())))])));
  if (Share() < 0.10) held_.down.flip(static_cast<size_t>(Below(kInputCodes)));  // of no name too
  if (Share() < 0.04) held_.down.reset();
  // What leads through the pages is tapped more often than chance would.
  for (const char* name : {"down", "enter", "pad_a", "escape"})
    held_.down.set(static_cast<size_t>(InputCode(name)), Share() < 0.12);
  if (Share() < 0.3) held_.turned_px = {Between(-40, 40), Between(-40, 40)};
  if (Share() < 0.01) held_.turned_px = {Between(-1e5, 1e5), Between(-1e5, 1e5)};
  if (Share() < 0.1) held_.left_stick = {Between(-1, 1), Between(-1, 1)};
  if (Share() < 0.1) held_.right_stick = {Between(-1, 1), Between(-1, 1)};
  if (Share() < 0.1) held_.left_stick = held_.right_stick = {};
  if (Share() < 0.3) held_.pointer = {Between(-0.1, 1.1), Between(-0.1, 1.1)};
  if (Share() < 0.05) held_.pointer = {-1, -1};
  if (Share() < 0.3) held_.pressed = !held_.pressed;
  if (Share() < 0.1) held_.clicks.push_back({Between(-0.1, 1.1), Between(-0.1, 1.1)});
  return held_;
}

void RandomHands::NextSize(int* width_px, int* height_px) {
  if (Share() > 0.03) return;
  *width_px = 16 + Below(480);
  *height_px = 16 + Below(300);
  if (Share() < 0.15) *width_px = 1 + Below(20);
  if (Share() < 0.15) *height_px = 1 + Below(20);
  if (Share() < 0.1) *width_px = *height_px = 0;
}

float RandomHands::NextPause_s() {
  const double kind = Share();
  return kind < 0.05 ? 0 : kind < 0.06 ? Between(0, 200) : Between(0.005, 0.1);
}

PlayerSettings RandomHands::NextSettings() {
  PlayerSettings s;
  const char* const languages[] = {"", "de", "en", "xx", "Ελληνικά"};
  s.language = languages[Below(5)];
  s.pointer = Share() < 0.5 ? "look" : "point";
  s.walk_speed_mps = Between(0.3, 3);
  s.turn_speed_dps = Between(10, 360);
  s.mouse_speed = Between(0.1, 10);
  s.field_of_view_deg = Share() < 0.5 ? 0 : Between(30, 120);
  s.snap_turn_deg = Share() < 0.5 ? 0 : Between(1, 90);
  s.invert_look = Share() < 0.5;
  s.reduced_motion = Share() < 0.5;
  s.sound_volume = Between(0, 1);
  s.kiosk = Share() < 0.4;
  const std::vector<std::string> names = InputNames();
  for (auto& keys : s.keys) {
    if (Share() < 0.1) keys = {names[static_cast<size_t>(Below(static_cast<int>(names.size())))]};
    if (Share() < 0.05) keys.clear();
  }
  return s;
}

}  // namespace flaneur
