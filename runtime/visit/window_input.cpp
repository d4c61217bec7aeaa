#include "runtime/visit/window_input.h"

#include <algorithm>
#include <iterator>

namespace flaneur {
namespace {

struct Named {
  const char* name;
  int code;
};

// Keys are numbered as GLFW numbers them; runtime/desktop holds both to the same.
constexpr Named kNamed[] = {
    {"space", 32},
    {"apostrophe", 39},
    {"comma", 44},
    {"minus", 45},
    {"period", 46},
    {"slash", 47},
    {"semicolon", 59},
    {"equal", 61},
    {"left_bracket", 91},
    {"backslash", 92},
    {"right_bracket", 93},
    {"grave", 96},
    {"escape", 256},
    {"enter", 257},
    {"tab", 258},
    {"backspace", 259},
    {"insert", 260},
    {"delete", 261},
    {"right", 262},
    {"left", 263},
    {"down", 264},
    {"up", 265},
    {"page_up", 266},
    {"page_down", 267},
    {"home", 268},
    {"end", 269},
    {"left_shift", 340},
    {"left_control", 341},
    {"left_alt", 342},
    {"right_shift", 344},
    {"right_control", 345},
    {"right_alt", 346},
    {"menu", 348},
    {"keypad_add", 334},
    {"keypad_subtract", 333},
    {"keypad_enter", 335},
    {"mouse_right", kFirstMouseCode + 1},
    {"mouse_middle", kFirstMouseCode + 2},
    {"pad_a", kFirstPadCode + 0},
    {"pad_b", kFirstPadCode + 1},
    {"pad_x", kFirstPadCode + 2},
    {"pad_y", kFirstPadCode + 3},
    {"pad_left_bumper", kFirstPadCode + 4},
    {"pad_right_bumper", kFirstPadCode + 5},
    {"pad_back", kFirstPadCode + 6},
    {"pad_start", kFirstPadCode + 7},
    {"pad_left_stick", kFirstPadCode + 9},
    {"pad_right_stick", kFirstPadCode + 10},
    {"pad_up", kFirstPadCode + 11},
    {"pad_right", kFirstPadCode + 12},
    {"pad_down", kFirstPadCode + 13},
    {"pad_left", kFirstPadCode + 14},
};

constexpr Named kLabels[] = {{"←", 263}, {"→", 262}, {"↑", 265}, {"↓", 264}, {"Esc", 256}};

template <typename Range>
const char* Find(const Range& range, int code) {
  const auto* const found =
      std::find_if(std::begin(range), std::end(range), [&](const Named& n) { return n.code == code; });
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
  if ((code >= '0' && code <= '9')) return std::string(1, static_cast<char>(code));
  if (code >= 'A' && code <= 'Z') return std::string(1, static_cast<char>(code - 'A' + 'a'));
  if (code >= 290 && code <= 314) return "f" + std::to_string(code - 290 + 1);
  if (code >= 320 && code <= 329) return "keypad_" + std::to_string(code - 320);
  const char* name = Find(kNamed, code);
  return name != nullptr ? name : "";
}

bool IsGamepadCode(int code) { return code >= kFirstPadCode; }

std::string InputLabel(int code, const KeyLayout& layout) {
  if (const char* label = Find(kLabels, code)) return label;
  const std::string name = InputName(code);
  if (IsGamepadCode(code)) return Capitalized(name.substr(std::string("pad_").size()));
  const std::string printed = layout && name.rfind("keypad", 0) != 0 ? layout(code) : "";
  return Capitalized(printed.empty() ? name : printed);
}

std::vector<std::string> InputNames() {
  std::vector<std::string> names;
  for (int code = 0; code < kInputCodes; ++code) {
    if (const std::string name = InputName(code); !name.empty()) names.push_back(name);
  }
  return names;
}

}  // namespace flaneur
