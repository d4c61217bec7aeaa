#include "runtime/visit/operator_page.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "runtime/render/overlay.h"
#include "runtime/visit/menu.h"
#include "runtime/visit/phrases.h"

namespace flaneur {
namespace {

constexpr float kKey = 2.4f, kGap = 0.3f;  // of the keypad, in letters
constexpr float kKeypadWide = 10;
constexpr float kRowHigh = 1.55f, kRowWide = 16;
constexpr const char* kDelete = "←";
constexpr const char* kDot = "•";
constexpr ImGuiWindowFlags kPlain = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize;

struct OperatorStyle {
  explicit OperatorStyle(float letter_px) {
    ImGui::PushStyleColor(ImGuiCol_WindowBg, {0.05f, 0.06f, 0.08f, 0.95f});
    ImGui::PushStyleColor(ImGuiCol_Border, {0, 0, 0, 0});
    ImGui::PushStyleColor(ImGuiCol_Text, {0.95f, 0.96f, 0.97f, 1});
    ImGui::PushStyleColor(ImGuiCol_Button, {0.18f, 0.22f, 0.28f, 1});
    ImGui::PushStyleColor(ImGuiCol_ButtonHovered, {0.24f, 0.32f, 0.44f, 1});
    ImGui::PushStyleColor(ImGuiCol_ButtonActive, {0.30f, 0.46f, 0.66f, 1});
    ImGui::PushStyleColor(ImGuiCol_NavHighlight, {0.60f, 0.80f, 1, 1});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {letter_px, 0.8f * letter_px});
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {kGap * letter_px, kGap * letter_px});
    ImGui::PushStyleVar(ImGuiStyleVar_FrameRounding, 0.25f * letter_px);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.5f * letter_px);
  }
  ~OperatorStyle() {
    ImGui::PopStyleVar(4);
    ImGui::PopStyleColor(7);
  }
  OperatorStyle(const OperatorStyle&) = delete;
  OperatorStyle& operator=(const OperatorStyle&) = delete;
};

bool Key(const std::string& text, float letter_px) {
  return ImGui::Button(text.c_str(), {kKey * letter_px, kKey * letter_px});
}

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

OperatorChoice ShowKeypad(const std::string& language, float letter_px, Kiosk* k) {
  const float wide_px = kKeypadWide * letter_px, left_px = (wide_px - (3 * kKey + 2 * kGap) * letter_px) / 2;
  const std::string state = StateOfEntry(language, k->pin);
  const float edge_px = ImGui::GetCursorPosX();
  ImGui::Dummy({wide_px, 0});
  ImGui::SetCursorPosX(edge_px + std::max(0.0f, (wide_px - ImGui::CalcTextSize(state.c_str()).x) / 2));
  ImGui::TextUnformatted(state.c_str());
  const char* const keys[] = {"1", "2", "3", "4", "5", "6", "7", "8", "9", kDelete, "0"};
  for (size_t key = 0; key < std::size(keys); ++key) {
    if (key % 3 != 0) ImGui::SameLine();
    else ImGui::SetCursorPosX(edge_px + left_px);
    if (!Key(keys[key], letter_px)) continue;
    if (keys[key] == kDelete) DeleteDigit(&k->pin);
    else if (k->page == OperatorPage::kKeypad) TypePin(*keys[key], k);
  }
  ImGui::SameLine();
  if (ImGui::Button("###leave", {kKey * letter_px, kKey * letter_px})) return OperatorChoice::kBack;
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  const float in_px = 0.36f * (high.x - low.x);
  ImDrawList* draw = ImGui::GetWindowDrawList();
  const ImU32 color = IM_COL32(242, 245, 248, 255);
  draw->AddLine({low.x + in_px, low.y + in_px}, {high.x - in_px, high.y - in_px}, color, letter_px / 8);
  draw->AddLine({low.x + in_px, high.y - in_px}, {high.x - in_px, low.y + in_px}, color, letter_px / 8);
  return OperatorChoice::kNone;
}

OperatorChoice ShowChoices(const std::string& language, const std::string& state, float letter_px) {
  ImGui::TextUnformatted(Say(Phrase::kOperator, language));
  if (!state.empty()) ImGui::TextUnformatted(state.c_str());
  const auto row = [&](Phrase phrase) {
    return ImGui::Button(Say(phrase, language), {kRowWide * letter_px, kRowHigh * letter_px});
  };
  OperatorChoice choice = OperatorChoice::kNone;
  if (row(Phrase::kBackToPages)) choice = OperatorChoice::kBack;
  if (row(Phrase::kRestart)) choice = OperatorChoice::kRestart;
  if (row(Phrase::kEnd)) choice = OperatorChoice::kEnd;
  return choice;
}

}  // namespace

OperatorChoice ShowOperatorPage(const std::string& language, const std::string& state, int width_px, int height_px,
                                Kiosk* k) {
  if (k->page == OperatorPage::kNone) return OperatorChoice::kNone;
  const ImVec2 picture{static_cast<float>(width_px), static_cast<float>(height_px)};
  const float letter_px = PageLetter_px(width_px, height_px);
  const LargeText large;
  const OperatorStyle style(letter_px);
  ImGui::GetBackgroundDrawList()->AddRectFilled({0, 0}, picture, IM_COL32(0, 0, 0, 140));
  ImGui::SetNextWindowPos({picture.x / 2, picture.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
  const bool keypad = k->page == OperatorPage::kKeypad;
  OperatorChoice choice = OperatorChoice::kNone;
  if (ImGui::Begin(keypad ? "keypad" : "operator", nullptr, kPlain)) {
    if (ImGui::IsWindowAppearing()) ImGui::SetWindowFocus();
    choice = keypad ? ShowKeypad(language, letter_px, k) : ShowChoices(language, state, letter_px);
  }
  ImGui::End();
  return choice;
}

std::string OperatorTexts(const std::string& language) {
  std::string all = std::string(kDelete) + kDot;
  for (Phrase phrase : {Phrase::kPinAsked, Phrase::kPinWrong, Phrase::kPinWait, Phrase::kOperator, Phrase::kRestart,
                        Phrase::kEnd, Phrase::kBackToPages})
    all += Say(phrase, language);
  return all;
}

}  // namespace flaneur
