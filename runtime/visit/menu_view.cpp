#include "runtime/visit/menu_view.h"

#include <imgui.h>

#include <algorithm>

#include "runtime/visit/menu_rows.h"
#include "runtime/visit/page_rows.h"
#include "runtime/visit/phrases.h"

namespace flaneur {
namespace {

constexpr float kPageWidth = 24, kKeysWidth = 28;  // in letters
constexpr float kMargin = 0.5f, kPadding = 0.6f, kGap = 0.28f, kSides = 0.8f;

float HeadHeight_px(const std::string& head, float width_px, const PageLook& look, TextLayer* text) {
  return RoomFor(head, width_px, TextOf(look), text).height_px + kGap * look.letter_px;
}

void ShowHead(const std::string& head, float width_px, const PageLook& look, TextLayer* text) {
  const float height_px = RoomFor(head, width_px, TextOf(look), text).height_px;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::Dummy({width_px, height_px});
  DrawText(head, {corner.x, corner.y, width_px, height_px}, TextOf(look), text);
}

constexpr ImGuiWindowFlags kPlain =
    ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings;

}  // namespace

MenuChoice ShowMenu(const std::string& title, const Simulation& s, int width_px, int height_px, Menu* menu, Controls* c,
                    TextLayer* text) {
  if (menu->page == Page::kNone || IsOfTown(menu->page)) return {};
  const Page page = menu->page;
  const PageLook look = LookOf(*c, s, width_px, height_px);
  const ImVec2 picture{static_cast<float>(width_px), static_cast<float>(height_px)};
  const float letter_px = look.letter_px, most_px = picture.x - 2 * (kMargin + kSides) * letter_px;
  const float page_px = std::min((page == Page::kKeys ? kKeysWidth : kPageWidth) * letter_px, most_px);
  PageRows rows(look, page_px, text);
  MenuChoice choice;
  const PageStyle style(look, menu->mark);
  ImGui::GetBackgroundDrawList()->AddRectFilled({0, 0}, picture,
                                                IM_COL32(look.veil[0], look.veil[1], look.veil[2], look.veil[3]));
  ImGui::SetNextWindowPos({picture.x / 2, picture.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
  const std::string name = "page " + std::to_string(static_cast<int>(page));
  if (ImGui::Begin(name.c_str(), nullptr, kPlain | ImGuiWindowFlags_AlwaysAutoResize)) {
    ShowKeyMark(&menu->mark);
    const std::string head = HeadOf(*menu, title, look.language), back = BackOf(*menu, look.language);
    ShowHead(head, page_px, look, text);
    FillRows(s, menu, c, &rows);  // only tells how high they are
    const float rest_px = picture.y - 2 * (kMargin + kPadding) * letter_px - HeadHeight_px(head, page_px, look, text) -
                          (back.empty() ? 0 : rows.ButtonHeight_px(back) + kGap * letter_px);
    if (!rows.Fit(rest_px, menu->first, Say(Phrase::kMore, look.language))) menu->first = 0;
    choice = FillRows(s, menu, c, &rows);
    rows.ShowMore();
    if (rows.more_pressed()) {
      menu->first = rows.end() < rows.count() ? rows.end() : 0;
      menu->mark.is_asked = menu->mark.by_keys;
    }
    if (!back.empty() && rows.ButtonBelow(back, "back")) OpenPage(Page::kMain, menu);
  }
  ImGui::End();
  return choice;
}

bool ShowMenuButton(const PageLook& look, int width_px) {
  const float letter_px = look.letter_px, side_px = 2 * letter_px;
  const PageStyle style(look);
  ImGui::SetNextWindowPos({static_cast<float>(width_px) - side_px - letter_px / 2, letter_px / 2});
  ImGui::SetNextWindowSize({side_px, side_px});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  ImGui::Begin("menu button", nullptr, kPlain | ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoNav);
  const ImVec2 low = ImGui::GetCursorScreenPos();
  const bool pressed = ImGui::Button("###menu", {side_px, side_px});
  const PageColor& color = ImGui::IsItemHovered() ? look.marked_text : look.text;
  for (int line = 0; line < 3; ++line) {
    const float y = low.y + side_px * (0.3f + 0.2f * static_cast<float>(line));
    ImGui::GetWindowDrawList()->AddLine({low.x + side_px * 0.25f, y}, {low.x + side_px * 0.75f, y},
                                        IM_COL32(color[0], color[1], color[2], color[3]),
                                        side_px / (look.high_contrast ? 9 : 14));
  }
  ImGui::End();
  ImGui::PopStyleVar();
  return pressed;
}

}  // namespace flaneur
