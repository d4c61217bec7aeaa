#include "runtime/visit/page_rows.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

namespace flaneur {
namespace {

// In letters.
constexpr float kRow = 1.55f, kPadding = 0.6f, kPaddingUp = 0.16f, kGap = 0.4f, kGapUp = 0.28f;
constexpr float kStepButton = 2, kValue = 6.2f;
constexpr float kBeside = 0.39f;  // of the page's width, for what the buttons beside it are for
constexpr size_t kMostLinesBeside = 2;
constexpr int kColors = 8, kVariables = 8;

ImU32 Packed(const PageColor& c) { return IM_COL32(c[0], c[1], c[2], c[3]); }

}  // namespace

bool TextButton(const std::string& text, const std::string& id, float width_px, float height_px, Align align,
                const PageLook& look, TextLayer* layer) {
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const bool pressed = ImGui::Button(("###" + id).c_str(), {width_px, height_px});
  TextLook letters = TextOf(look);
  letters.align = align;
  letters.color = ImGui::IsItemHovered() || ImGui::IsItemActive() ? look.marked_text : look.text;
  const float padding_px = (align == Align::kCenter ? kPaddingUp : kPadding) * look.letter_px;
  DrawText(text, {corner.x + padding_px, corner.y, width_px - 2 * padding_px, height_px}, letters, layer);
  return pressed;
}

void TextAt(const std::string& text, float width_px, Align align, const PageLook& look, TextLayer* layer) {
  TextLook letters = TextOf(look);
  letters.align = align;
  const float height_px = RoomFor(text, width_px, letters, layer).height_px;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::Dummy({width_px, height_px});
  DrawText(text, {corner.x, corner.y, width_px, height_px}, letters, layer);
}

void ShowKeyMark(KeyMark* mark, bool at_once) {
  if (ImGui::IsWindowAppearing()) {
    ImGui::SetWindowFocus();
    mark->is_shown = false;
    mark->is_asked = mark->by_keys && at_once;
  }
  if (!mark->is_asked) return;
  ImGui::SetKeyboardFocusHere();  // the next button
  mark->is_asked = false;
  mark->is_shown = true;
}

PageRows::PageRows(const PageLook& look, float width_px, TextLayer* text)
    : look_(look), width_px_(width_px), text_(text) {}

bool PageRows::IsShown(float height_px) {
  if (measures_) {
    heights_px_.push_back(height_px);
    return false;
  }
  const size_t row = next_++;
  return row >= first_ && row < end_;
}

float PageRows::ButtonHeight_px(const std::string& text, float width_px) const {
  const TextRoom room = RoomFor(text, width_px - 2 * kPadding * look_.letter_px, TextOf(look_), text_);
  return std::max(kRow * look_.letter_px, room.height_px + 2 * kPaddingUp * look_.letter_px);
}

void PageRows::WordsAt(const std::string& text, float width_px, float height_px) {
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::Dummy({width_px, height_px});
  DrawText(text, {corner.x, corner.y, width_px, height_px}, TextOf(look_), text_);
}

bool PageRows::FitsBeside(const std::string& text, float width_px) const {
  if (width_px <= 0) return false;
  const TextRoom room = RoomFor(text, width_px, TextOf(look_), text_);
  return !room.broken_words && room.lines <= kMostLinesBeside;
}

bool PageRows::Button(const std::string& text, const std::string& id) {
  const float height_px = ButtonHeight_px(text, width_px_);
  return IsShown(height_px) && ButtonAt(text, id, width_px_, height_px, Align::kStart);
}

void PageRows::Words(const std::string& text) {
  const float height_px = RoomFor(text, width_px_, TextOf(look_), text_).height_px;
  if (IsShown(height_px)) WordsAt(text, width_px_, height_px);
}

int PageRows::Amount(const std::string& text, const std::string& value) {
  const float letter_px = look_.letter_px, button_px = kStepButton * letter_px, gap_px = kGap * letter_px;
  const float value_px = std::min(kValue * letter_px, width_px_ - 2 * button_px - 2 * gap_px);
  const float beside_px = width_px_ - 2 * button_px - value_px - 3 * gap_px;
  const bool beside = FitsBeside(text, beside_px);
  const float words_px = beside ? beside_px : width_px_;
  const float text_px = RoomFor(text, words_px, TextOf(look_), text_).height_px;
  const float row_px = std::max(kRow * letter_px, beside ? text_px : 0);
  if (!IsShown(beside ? row_px : text_px + kGapUp * letter_px + row_px)) return 0;
  ImGui::PushID(text.c_str());
  WordsAt(text, words_px, beside ? row_px : text_px);
  if (beside) ImGui::SameLine(0, gap_px);
  ImGui::PushButtonRepeat(true);
  const bool less = ButtonAt("–", "less", button_px, row_px, Align::kCenter);
  ImGui::SameLine(0, gap_px);
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::Dummy({value_px, row_px});
  TextLook letters = TextOf(look_);
  letters.align = Align::kCenter;
  DrawText(value, {corner.x, corner.y, value_px, row_px}, letters, text_);
  ImGui::SameLine(0, gap_px);
  const bool more = ButtonAt("+", "more", button_px, row_px, Align::kCenter);
  ImGui::PopButtonRepeat();
  ImGui::PopID();
  return static_cast<int>(more) - static_cast<int>(less);
}

int PageRows::Choice(const std::string& text, const std::vector<std::string>& buttons, const std::string& id) {
  const float letter_px = look_.letter_px, gap_px = kGap * letter_px;
  const float count = static_cast<float>(buttons.size()), words_px = kBeside * width_px_;
  const float narrow_px = (width_px_ - words_px) / count - gap_px;
  const auto fits_narrow = [&](const std::string& b) { return FitsBeside(b, narrow_px - 2 * kPadding * letter_px); };
  const bool beside = FitsBeside(text, words_px) && std::all_of(buttons.begin(), buttons.end(), fits_narrow);
  const float button_px = beside ? narrow_px : (width_px_ - (count - 1) * gap_px) / count;
  float row_px = kRow * letter_px;
  for (const std::string& b : buttons) row_px = std::max(row_px, ButtonHeight_px(b, button_px));
  const float text_px = RoomFor(text, beside ? words_px : width_px_, TextOf(look_), text_).height_px;
  if (beside) row_px = std::max(row_px, text_px);
  if (!IsShown(beside ? row_px : text_px + kGapUp * letter_px + row_px)) return -1;
  WordsAt(text, beside ? words_px : width_px_, beside ? row_px : text_px);
  int pressed = -1;
  for (size_t k = 0; k < buttons.size(); ++k) {
    if (beside || k > 0) ImGui::SameLine(0, gap_px);
    if (ButtonAt(buttons[k], id + std::to_string(k), button_px, row_px, Align::kStart)) pressed = static_cast<int>(k);
  }
  return pressed;
}

bool PageRows::Fit(float height_px, size_t first, const std::string& more) {
  measures_ = false;
  more_ = more;
  const float gap_px = kGapUp * look_.letter_px;
  float all_px = 0;
  for (float h : heights_px_) all_px += h + gap_px;
  first_ = all_px <= height_px || first >= count() ? 0 : first;
  const float room_px = all_px <= height_px ? height_px : height_px - ButtonHeight_px(more, width_px_) - gap_px;
  float used_px = 0;
  for (end_ = first_; end_ < count(); ++end_) {
    used_px += heights_px_[end_] + gap_px;
    if (used_px > room_px && end_ > first_) break;
  }
  return first < count();
}

void PageRows::ShowMore() {
  if (first_ == 0 && end_ == count()) return;
  more_pressed_ = ButtonAt(more_, "more", width_px_, ButtonHeight_px(more_, width_px_), Align::kStart);
}

bool PageRows::ButtonBelow(const std::string& text, const std::string& id) {
  return ButtonAt(text, id, width_px_, ButtonHeight_px(text), Align::kStart);
}

PageStyle::PageStyle(const PageLook& look, const KeyMark& mark) {
  const auto color = [](ImGuiCol which, const PageColor& c) { ImGui::PushStyleColor(which, Packed(c)); };
  color(ImGuiCol_WindowBg, look.panel);
  color(ImGuiCol_Border, look.outline_px > 0 ? look.outline : PageColor{});
  color(ImGuiCol_Text, look.text);
  color(ImGuiCol_Button, look.button);
  color(ImGuiCol_ButtonHovered, look.marked);
  color(ImGuiCol_ButtonActive, look.pressed);
  color(ImGuiCol_NavHighlight, mark.is_shown ? look.outline : PageColor{});
  color(ImGuiCol_BorderShadow, {});
  const float letter_px = look.letter_px;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.8f * letter_px, 0.6f * letter_px});
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {kPadding * letter_px, 0.25f * letter_px});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {kGap * letter_px, kGapUp * letter_px});
  ImGui::PushStyleVar(ImGuiStyleVar_FrameRounding, 0.25f * letter_px);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.5f * letter_px);
  ImGui::PushStyleVar(ImGuiStyleVar_FrameBorderSize, look.outline_px);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, look.outline_px);
  ImGui::PushStyleVar(ImGuiStyleVar_ButtonTextAlign, {0, 0.5f});
}

PageStyle::~PageStyle() {
  ImGui::PopStyleVar(kVariables);
  ImGui::PopStyleColor(kColors);
}

}  // namespace flaneur
