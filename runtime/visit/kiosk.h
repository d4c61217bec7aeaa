// The kiosk from visitor to visitor: it shows itself until somebody comes, and again once nobody is there any more; the
// operator has a page of their own. A rule about hands and time alone: it draws nothing.
#pragma once
#include "runtime/visit/kiosk_settings.h"
#include "runtime/visit/pin.h"
#include "runtime/visit/player_settings.h"
#include "runtime/visit/window_input.h"

namespace flaneur {

enum class KioskState { kAttract, kVisit };
enum class OperatorPage { kNone, kKeypad, kChoices };

struct Kiosk {
  KioskSettings settings;
  KioskState state = KioskState::kAttract;
  OperatorPage page = OperatorPage::kNone;
  PinEntry pin{};
  float unused_s = 0;          // since the hands did anything
  float held_s = 0;            // that the operator's sign has been given
  WindowInput hands_before{};  // of the last picture
};

enum class KioskEvent { kNothing, kVisitBegins, kVisitEnds };

// Once a picture, passed_s after the one before. is_led: the tour shows somebody round, who need not touch anything.
KioskEvent FollowKiosk(const WindowInput& hands, float passed_s, bool is_led, const PlayerSettings& settings,
                       Kiosk* kiosk);

// The visitor says that they are done.
KioskEvent EndVisit(Kiosk* kiosk);

// The keypad's digit, by finger or key. The right PIN opens the operator's page.
void TypePin(char digit, Kiosk* kiosk);
void ClosePage(Kiosk* kiosk);

// What visitors of a kiosk cannot do: developer views, leaving full screen, ending the program.
bool IsLocked(Action action);

// The operator's sign, held so long: the key for ending (F10), both Back and Start of a gamepad, or a finger in the
// picture's upper left corner. Closing the window asks for the PIN at once.
inline constexpr float kSign_s = 3, kCorner = 0.1f;  // kCorner: of the picture's width and height
inline constexpr float kPageCloses_s = 20;           // untouched

}  // namespace flaneur
