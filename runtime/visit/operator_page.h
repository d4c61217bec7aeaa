// What a kiosk's operator sees: the keypad for their PIN, and behind it what they can do. By touch, mouse, keyboard and
// gamepad.
#pragma once
#include <string>

#include "runtime/visit/kiosk.h"
#include "runtime/visit/page_look.h"
#include "runtime/visit/page_rows.h"

namespace flaneur {

enum class OperatorChoice { kNone, kBack, kRestart, kEnd };

// Between an Overlay's Begin and Draw. state: a line of what the operator wants to know.
OperatorChoice ShowOperatorPage(const PageLook& look, const std::string& state, int width_px, int height_px,
                                Kiosk* kiosk, KeyMark* mark, TextLayer* text);

}  // namespace flaneur
