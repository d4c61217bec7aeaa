#include "runtime/render/window_input.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <iterator>

#include "runtime/render/gamepad_codes.h"

namespace flaneur {
namespace {

struct Named { const char* name; int code; };

constexpr Named kNamed[] = {
    {"space", GLFW_KEY_SPACE}, {"apostrophe", GLFW_KEY_APOSTROPHE}, {"comma", GLFW_KEY_COMMA}, {"minus", GLFW_KEY_MINUS},
    {"period", GLFW_KEY_PERIOD}, {"slash", GLFW_KEY_SLASH}, {"semicolon", GLFW_KEY_SEMICOLON}, {"equal", GLFW_KEY_EQUAL},
    {"left_bracket", GLFW_KEY_LEFT_BRACKET}, {"backslash", GLFW_KEY_BACKSLASH}, {"right_bracket", GLFW_KEY_RIGHT_BRACKET},
    {"grave", GLFW_KEY_GRAVE_ACCENT}, {"escape", GLFW_KEY_ESCAPE}, {"enter", GLFW_KEY_ENTER}, {"tab", GLFW_KEY_TAB},
    {"backspace", GLFW_KEY_BACKSPACE}, {"insert", GLFW_KEY_INSERT}, {"delete", GLFW_KEY_DELETE}, {"right", GLFW_KEY_RIGHT},
    {"left", GLFW_KEY_LEFT}, {"down", GLFW_KEY_DOWN}, {"up", GLFW_KEY_UP}, {"page_up", GLFW_KEY_PAGE_UP},
    {"page_down", GLFW_KEY_PAGE_DOWN}, {"home", GLFW_KEY_HOME}, {"end", GLFW_KEY_END}, {"left_shift", GLFW_KEY_LEFT_SHIFT},
    {"left_control", GLFW_KEY_LEFT_CONTROL}, {"left_alt", GLFW_KEY_LEFT_ALT}, {"right_shift", GLFW_KEY_RIGHT_SHIFT},
    {"right_control", GLFW_KEY_RIGHT_CONTROL}, {"right_alt", GLFW_KEY_RIGHT_ALT}, {"menu", GLFW_KEY_MENU},
    {"keypad_add", GLFW_KEY_KP_ADD}, {"keypad_subtract", GLFW_KEY_KP_SUBTRACT}, {"keypad_enter", GLFW_KEY_KP_ENTER},
    {"pad_a", PadCode(GLFW_GAMEPAD_BUTTON_A)}, {"pad_b", PadCode(GLFW_GAMEPAD_BUTTON_B)},
    {"pad_x", PadCode(GLFW_GAMEPAD_BUTTON_X)}, {"pad_y", PadCode(GLFW_GAMEPAD_BUTTON_Y)},
    {"pad_left_bumper", PadCode(GLFW_GAMEPAD_BUTTON_LEFT_BUMPER)}, {"pad_right_bumper", PadCode(GLFW_GAMEPAD_BUTTON_RIGHT_BUMPER)},
    {"pad_back", PadCode(GLFW_GAMEPAD_BUTTON_BACK)}, {"pad_start", PadCode(GLFW_GAMEPAD_BUTTON_START)},
    {"pad_left_stick", PadCode(GLFW_GAMEPAD_BUTTON_LEFT_THUMB)}, {"pad_right_stick", PadCode(GLFW_GAMEPAD_BUTTON_RIGHT_THUMB)},
    {"pad_up", PadCode(GLFW_GAMEPAD_BUTTON_DPAD_UP)}, {"pad_right", PadCode(GLFW_GAMEPAD_BUTTON_DPAD_RIGHT)},
    {"pad_down", PadCode(GLFW_GAMEPAD_BUTTON_DPAD_DOWN)}, {"pad_left", PadCode(GLFW_GAMEPAD_BUTTON_DPAD_LEFT)},
};

constexpr Named kLabels[] = {{"←", GLFW_KEY_LEFT}, {"→", GLFW_KEY_RIGHT}, {"↑", GLFW_KEY_UP}, {"↓", GLFW_KEY_DOWN}, {"Esc", GLFW_KEY_ESCAPE}};

template <typename Range>
const char* Find(const Range& range, int code) {
  const auto* const found = std::find_if(std::begin(range), std::end(range), [&](const Named& n) { return n.code == code; });
  return found != std::end(range) ? found->name : nullptr;
}

// "page_up" to "Page Up".
std::string Capitalized(std::string name) {
  bool begins = true;
  for (char& c : name) {
    if (c == '_') c = ' ';
    if (begins && c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    begins = c == ' ';
  }
  return name;
}

}  // namespace

int InputCode(const std::string& name) {
  for (int code = 0; code < kInputCodes; ++code) {
    if (!name.empty() && InputName(code) == name) return code;
  }
  return -1;
}

std::string InputName(int code) {
  if ((code >= GLFW_KEY_0 && code <= GLFW_KEY_9)) return std::string(1, static_cast<char>(code));
  if (code >= GLFW_KEY_A && code <= GLFW_KEY_Z) return std::string(1, static_cast<char>(code - 'A' + 'a'));
  if (code >= GLFW_KEY_F1 && code <= GLFW_KEY_F25) return "f" + std::to_string(code - GLFW_KEY_F1 + 1);
  if (code >= GLFW_KEY_KP_0 && code <= GLFW_KEY_KP_9) return "keypad_" + std::to_string(code - GLFW_KEY_KP_0);
  const char* name = Find(kNamed, code);
  return name != nullptr ? name : "";
}

bool IsGamepadCode(int code) { return code >= kFirstPadCode; }

std::string InputLabel(int code) {
  if (const char* label = Find(kLabels, code)) return label;
  const std::string name = InputName(code);
  if (IsGamepadCode(code)) return Capitalized(name.substr(std::string("pad_").size()));
  const char* printed = name.rfind("keypad", 0) == 0 ? nullptr : glfwGetKeyName(code, 0);
  return Capitalized(printed != nullptr ? printed : name);
}

std::vector<std::string> InputNames() {
  std::vector<std::string> names;
  for (int code = 0; code < kInputCodes; ++code) {
    if (const std::string name = InputName(code); !name.empty()) names.push_back(name);
  }
  return names;
}

}  // namespace flaneur
