#include "runtime/visit/photo_page.h"

#include <imgui.h>

#include <algorithm>
#include <filesystem>

#include "runtime/visit/page_rows.h"
#include "runtime/visit/phrases.h"

namespace flaneur {
namespace {

constexpr float kShare = 0.9f, kCodeShare = 0.36f;  // of the picture; of its shorter side, the code

std::string WhatBecame(const TakenPhoto& t, const std::string& folder, bool names_file, const std::string& language) {
  if (!t.keeping.Done()) return Say(Phrase::kPhotoKeeps, language);
  if (t.error) return Say(Phrase::kPhotoFailed, language);
  if (t.code != nullptr) return Say(Phrase::kPhotoScan, language);
  const std::filesystem::path file = PhotoFileName(t.id);
  return Say(Phrase::kPhotoKept, language, {(names_file ? std::filesystem::path(folder) / file : file).string()});
}

}  // namespace

void ShowPhotoPage(const TakenPhoto& t, const std::string& folder, bool names_file, const PageLook& look, int width_px,
                   int height_px, Menu* menu, Overlay* overlay) {
  if (menu->page != Page::kPhoto) return;
  const float wide_px = static_cast<float>(width_px), high_px = static_cast<float>(height_px),
              letter_px = look.letter_px;
  const bool codes = t.code != nullptr && t.keeping.Done() && !t.error, portrait = high_px > wide_px;
  const float code_px = codes ? kCodeShare * std::min(wide_px, high_px) : 0, gap_px = 0.6f * letter_px;
  const std::string words = WhatBecame(t, folder, names_file, look.language);
  const float inner_px = kShare * wide_px - 1.6f * letter_px;
  TextLayer* text = &overlay->text();
  PageRows rows(look, inner_px, text);
  const std::string on = Say(Phrase::kContinue, look.language);
  const float words_px = RoomFor(words, inner_px, TextOf(look), text).height_px;
  const float rest_px = kShare * high_px - words_px - rows.ButtonHeight_px(on) - 3 * gap_px - 1.2f * letter_px;
  const float most_wide_px = portrait ? inner_px : inner_px - code_px - (codes ? gap_px : 0);
  const float most_high_px = portrait ? rest_px - code_px - (codes ? gap_px : 0) : rest_px;
  const float scale = std::min(most_wide_px / static_cast<float>(std::max(1, t.photo.width_px)),
                               most_high_px / static_cast<float>(std::max(1, t.photo.height_px)));
  const ImVec2 shown_px{scale * static_cast<float>(t.photo.width_px), scale * static_cast<float>(t.photo.height_px)};
  const PageStyle style(look, menu->mark);
  ImGui::GetBackgroundDrawList()->AddRectFilled({0, 0}, {wide_px, high_px}, IM_COL32(0, 0, 0, 130));
  ImGui::SetNextWindowPos({wide_px / 2, high_px / 2}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::Begin("photo", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_AlwaysAutoResize);
  ShowKeyMark(&menu->mark);
  ImGui::Image(t.shown, shown_px);
  if (codes) {
    if (!portrait) ImGui::SameLine(0, gap_px);
    ImGui::Image(t.code, {code_px, code_px});
  }
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::Dummy({inner_px, words_px});
  DrawText(words, {corner.x, corner.y, inner_px, words_px}, TextOf(look), text);
  // The only button is meant even where nobody has moved to it yet.
  const bool accepted = ImGui::GetIO().NavInputsDownDuration[ImGuiNavInput_Activate] == 0;
  if (rows.ButtonBelow(on, "on") || accepted) OpenPage(Page::kNone, menu);
  ImGui::End();
}

}  // namespace flaneur
