#include "runtime/visit/operator_page.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "runtime/visit/page_rows.h"
#include "runtime/visit/phrases.h"

namespace flaneur {
namespace {

constexpr float kKey = 2.4f, kGap = 0.3f;  // of the keypad, in letters
constexpr float kKeypadWide = 10;
constexpr float kRowHigh = 1.55f, kRowWide = 16;
constexpr float kLettersHigh = 15;  // that the keypad takes
constexpr const char* kDelete = "←";
constexpr const char* kLeave = "×";
constexpr const char* kDot = "•";
constexpr ImGuiWindowFlags kPlain = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize;

std::string StateOfEntry(const std::string& language, const PinEntry& pin) {
  if (pin.wait_s > 0) {
    const auto seconds = static_cast<int>(std::ceil(pin.wait_s));
    return std::string(Say(Phrase::kPinWait, language)) + " " + std::to_string(seconds / 60) + ":" +
           (seconds % 60 < 10 ? "0" : "") + std::to_string(seconds % 60);
  }
  if (pin.typed.empty()) return Say(pin.wrong > 0 ? Phrase::kPinWrong : Phrase::kPinAsked, language);
  std::string dots;
  for (size_t k = 0; k < pin.typed.size(); ++k) dots += kDot;
  return dots;
}

OperatorChoice ShowKeypad(const PageLook& look, TextLayer* text, Kiosk* k) {
  const float key_px = kKey * look.letter_px, wide_px = kKeypadWide * look.letter_px;
  const float left_px = (wide_px - (3 * kKey + 2 * kGap) * look.letter_px) / 2;
  const float edge_px = ImGui::GetCursorPosX();
  TextAt(StateOfEntry(look.language, k->pin), wide_px, Align::kCenter, look, text);
  const char* const keys[] = {"1", "2", "3", "4", "5", "6", "7", "8", "9", kDelete, "0"};
  for (size_t key = 0; key < std::size(keys); ++key) {
    if (key % 3 != 0) ImGui::SameLine();
    else ImGui::SetCursorPosX(edge_px + left_px);
    if (!TextButton(keys[key], keys[key], key_px, key_px, Align::kCenter, look, text)) continue;
    if (keys[key] == kDelete) DeleteDigit(&k->pin);
    else if (k->page == OperatorPage::kKeypad) TypePin(*keys[key], k);
  }
  ImGui::SameLine();
  return TextButton(kLeave, "leave", key_px, key_px, Align::kCenter, look, text) ? OperatorChoice::kBack
                                                                                 : OperatorChoice::kNone;
}

OperatorChoice ShowChoices(const PageLook& look, const std::string& state, float most_px, TextLayer* text) {
  const float wide_px = std::min(kRowWide * look.letter_px, most_px);
  TextAt(Say(Phrase::kOperator, look.language), wide_px, Align::kStart, look, text);
  if (!state.empty()) TextAt(state, wide_px, Align::kStart, look, text);
  const auto row = [&](Phrase phrase, const char* id) {
    return TextButton(Say(phrase, look.language), id, wide_px, kRowHigh * look.letter_px, Align::kStart, look, text);
  };
  OperatorChoice choice = OperatorChoice::kNone;
  if (row(Phrase::kBackToPages, "back")) choice = OperatorChoice::kBack;
  if (row(Phrase::kRestart, "restart")) choice = OperatorChoice::kRestart;
  if (row(Phrase::kEnd, "end")) choice = OperatorChoice::kEnd;
  return choice;
}

// Bluer than what visitors see, unless the contrast is high, and no larger than fits.
PageLook OperatorLook(PageLook look, int height_px) {
  look.letter_px = std::min(look.letter_px, static_cast<float>(height_px) / kLettersHigh);
  if (look.high_contrast) return look;
  look.panel = {13, 15, 20, 242};
  look.text = look.marked_text = {242, 245, 247, 255};
  look.button = {46, 56, 71, 255};
  look.marked = {61, 82, 112, 255};
  look.pressed = {77, 117, 168, 255};
  look.outline = {153, 204, 255, 255};
  return look;
}

}  // namespace

OperatorChoice ShowOperatorPage(const PageLook& pages, const std::string& state, int width_px, int height_px, Kiosk* k,
                                KeyMark* mark, TextLayer* text) {
  if (k->page == OperatorPage::kNone) return OperatorChoice::kNone;
  const ImVec2 picture{static_cast<float>(width_px), static_cast<float>(height_px)};
  const PageLook look = OperatorLook(pages, height_px);
  const PageStyle style(look, *mark);
  ImGui::GetBackgroundDrawList()->AddRectFilled({0, 0}, picture, IM_COL32(0, 0, 0, 140));
  ImGui::SetNextWindowPos({picture.x / 2, picture.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
  const bool keypad = k->page == OperatorPage::kKeypad;
  OperatorChoice choice = OperatorChoice::kNone;
  if (ImGui::Begin(keypad ? "keypad" : "operator", nullptr, kPlain)) {
    ShowKeyMark(mark, !keypad);  // whose keys are typed
    choice = keypad ? ShowKeypad(look, text, k) : ShowChoices(look, state, picture.x - 2 * look.letter_px, text);
  }
  ImGui::End();
  return choice;
}

}  // namespace flaneur
