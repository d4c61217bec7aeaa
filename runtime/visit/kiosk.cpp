#include "runtime/visit/kiosk.h"

#include <algorithm>

namespace flaneur {
namespace {

constexpr float kStickMoved = 0.15f;  // sticks at rest tremble, and may rest anywhere

bool IsDown(const char* name, const WindowInput& hands) { return hands.down[static_cast<size_t>(InputCode(name))]; }

// A change of what is held: what has been laid on the keyboard is nobody.
bool IsUsed(const WindowInput& now, const WindowInput& before) {
  return now.down != before.down || now.pressed != before.pressed || !now.clicks.empty() || Length(now.turned_px) > 0 ||
         Length(now.left_stick - before.left_stick) > kStickMoved ||
         Length(now.right_stick - before.right_stick) > kStickMoved;
}

bool IsPressed(const WindowInput& now, const WindowInput& before) {
  return (now.down & ~before.down).any() || (now.pressed && !before.pressed) || !now.clicks.empty();
}

bool IsSign(const WindowInput& hands, const PlayerSettings& settings) {
  const auto& quit = settings.keys[static_cast<size_t>(Action::kQuit)];
  const bool key = std::any_of(quit.begin(), quit.end(), [&](const std::string& name) {
    const int code = InputCode(name);
    return code >= 0 && hands.down[static_cast<size_t>(code)];
  });
  const bool corner = hands.pressed && hands.pointer.x >= 0 && hands.pointer.x < kCorner && hands.pointer.y >= 0 &&
                      hands.pointer.y < kCorner;
  return key || corner || (IsDown("pad_back", hands) && IsDown("pad_start", hands));
}

void AskForPin(Kiosk* k) {
  if (k->settings.pin.empty() || k->page != OperatorPage::kNone) return;
  k->page = OperatorPage::kKeypad;
  k->unused_s = 0;
}

void TakeKeypadKeys(const WindowInput& hands, Kiosk* k) {
  const auto is_new = [&](const std::string& name) {
    return IsDown(name.c_str(), hands) && !IsDown(name.c_str(), k->hands_before);
  };
  for (char digit = '0'; digit <= '9' && k->page == OperatorPage::kKeypad; ++digit) {
    if (is_new(std::string(1, digit)) || is_new(std::string("keypad_") + digit)) TypePin(digit, k);
  }
  if (is_new("backspace")) DeleteDigit(&k->pin);
  if (is_new("escape") || is_new("pad_b")) ClosePage(k);
}

KioskEvent FollowState(bool pressed, bool is_led, Kiosk* k) {
  if (k->state == KioskState::kAttract) {
    if (!pressed) return KioskEvent::kNothing;
    k->state = KioskState::kVisit;
    k->unused_s = 0;
    return KioskEvent::kVisitBegins;
  }
  if (is_led) k->unused_s = 0;
  return k->unused_s > k->settings.idle_s ? EndVisit(k) : KioskEvent::kNothing;
}

}  // namespace

KioskEvent FollowKiosk(const WindowInput& hands, float passed_s, bool is_led, const PlayerSettings& settings,
                       Kiosk* k) {
  WaitForPin(passed_s, &k->pin);
  const bool pressed = IsPressed(hands, k->hands_before);
  k->unused_s = IsUsed(hands, k->hands_before) ? 0 : k->unused_s + passed_s;
  k->held_s = IsSign(hands, settings) ? k->held_s + passed_s : 0;
  KioskEvent event = KioskEvent::kNothing;
  if (k->page == OperatorPage::kNone) event = FollowState(pressed, is_led, k);
  else if (k->page == OperatorPage::kKeypad) TakeKeypadKeys(hands, k);
  if (k->page != OperatorPage::kNone && k->unused_s > kPageCloses_s) ClosePage(k);
  if (hands.close || k->held_s > kSign_s) AskForPin(k);
  k->hands_before = hands;
  return event;
}

KioskEvent EndVisit(Kiosk* k) {
  if (k->state == KioskState::kAttract) return KioskEvent::kNothing;
  k->state = KioskState::kAttract;
  return KioskEvent::kVisitEnds;
}

void TypePin(char digit, Kiosk* k) {
  if (TypeDigit(digit, k->settings.pin, &k->pin)) k->page = OperatorPage::kChoices;
}

void ClosePage(Kiosk* k) {
  k->page = OperatorPage::kNone;
  k->pin.typed.clear();
  k->unused_s = k->held_s = 0;
}

bool IsLocked(Action action) {
  switch (action) {
    case Action::kViews:
    case Action::kAdaptation:
    case Action::kFullscreen:
    case Action::kPointer:
    case Action::kWider:
    case Action::kNarrower:
    case Action::kQuit:
      return true;
    default:
      return false;
  }
}

}  // namespace flaneur
