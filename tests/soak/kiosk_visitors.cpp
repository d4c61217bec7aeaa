#include "tests/soak/kiosk_visitors.h"

namespace flaneur {
namespace {

constexpr float kTap_s = 0.15f, kAfterTap_s = 0.35f, kSign_s = 3.5f;

}  // namespace

void KioskVisitors::Hold(std::initializer_list<const char*> keys, float seconds) {
  Moment moment{{}, seconds};
  for (const char* key : keys) moment.hands.down.set(static_cast<size_t>(InputCode(key)));
  plan_.push_back(moment);
}

void KioskVisitors::Rest(float seconds) { plan_.push_back({{}, seconds}); }

void KioskVisitors::Tap(const char* key) {
  Hold({key}, kTap_s);
  Rest(kAfterTap_s);
}

void KioskVisitors::Touch(Vec2 at) {
  Moment finger{{}, kTap_s};
  finger.hands.pointer = at;
  plan_.push_back(finger);
  finger.hands.pressed = true;
  plan_.push_back(finger);
  finger.hands.pressed = false;
  finger.hands.clicks = {at};
  finger.seconds = 0;
  plan_.push_back(finger);
  Rest(kAfterTap_s);
}

void KioskVisitors::Drag() {
  Moment finger{{}, Between(0.3, 2)};
  finger.hands.pointer = {Between(0.2, 0.8), Between(0.2, 0.8)};
  finger.hands.pressed = true;
  finger.hands.turned_px = {Between(-30, 30), Between(-6, 6)};
  plan_.push_back(finger);
  Rest(kAfterTap_s);
}

void KioskVisitors::UsePages() {
  if (Below(2) == 0) Tap("escape");
  else Touch({0.97f, 0.04f});  // the pages' button
  for (int k = 2 + Below(8); k > 0; --k) {
    const char* const keys[] = {"down", "down", "up", "right", "left", "enter", "enter", "pad_down", "pad_a"};
    if (Below(3) > 0) Tap(keys[Below(9)]);
    else Touch({Between(0.25, 0.75), Between(0.1, 0.95)});
  }
  Tap("escape");
}

void KioskVisitors::GuessPin() {
  if (Below(2) == 0) {
    Hold({"f10"}, kSign_s);
  } else {
    Moment corner{{}, kSign_s};
    corner.hands.pointer = {0.04f, 0.04f};
    corner.hands.pressed = true;
    plan_.push_back(corner);
  }
  const char* const digits[] = {"0", "1", "2", "3", "keypad_5", "backspace"};
  for (int k = 3 + Below(8); k > 0; --k) Tap(digits[Below(6)]);
  Tap("escape");
}

// What somebody does next.
void KioskVisitors::Plan() {
  switch (Below(16)) {
    case 0:
    case 1:
      return Hold({"w"}, Between(1, 8));
    case 2:
      return Hold({"up", "left"}, Between(0.5, 3));
    case 3:
      return Hold({"s", "d"}, Between(0.5, 3));
    case 4:
    case 5:
      return Drag();
    case 6:
    case 7:
      return Touch({Between(0, 1), Between(0.4, 1)});  // to walk there, or a thing that tells something
    case 8:
      return UsePages();
    case 9:  // the map, by key or finger, and somewhere on it
      if (Below(2) == 0) Tap("t");
      else Touch({0.97f, 0.15f});
      if (Below(3) == 0) Tap("enter");
      else Touch({Between(0, 1), Between(0, 1)});
      return Rest(Between(0.5, 6));
    case 10:
      if (Below(2) == 0) Tap("p");
      else Touch({0.97f, 0.26f});
      Rest(Between(0.5, 3));
      return Tap(Below(2) == 0 ? "enter" : "escape");
    case 11:
      Tap("e");
      return Rest(Between(1, 5));
    case 12: {
      const char* const keys[] = {"tab", "space", "n", "b", "l", "m", "f1", "f2", "f11"};
      return Tap(keys[Below(9)]);
    }
    case 13:
      return Below(4) == 0 ? GuessPin() : Rest(1);
    case 14:
      return Tap(InputNames()[static_cast<size_t>(Below(static_cast<int>(InputNames().size())))].c_str());
    default:
      return Rest(Between(1, 12));
  }
}

WindowInput KioskVisitors::Next(bool waits, float passed_s) {
  stays_s_ -= passed_s;
  if (plan_.empty() && stays_s_ > 0) Plan();
  if (plan_.empty() && waits) {  // somebody comes, later
    Rest(Between(1, 40));
    if (Below(4) == 0) Tap("enter");
    else Touch({Between(0, 1), Between(0, 1)});
    if (Below(3) > 0) Tap("enter");  // begins
    stays_s_ = Between(5, 150);
    ++visitors_;
  }
  busy_ = !plan_.empty();
  if (!busy_) return {};  // they have gone
  Moment& now = plan_.front();
  const WindowInput hands = now.hands;
  now.hands.clicks.clear();
  now.seconds -= passed_s;
  if (now.seconds <= 0) plan_.pop_front();
  return hands;
}

}  // namespace flaneur
