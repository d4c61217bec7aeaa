#include "runtime/visit/attract_page.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "runtime/visit/phrases.h"

namespace flaneur {
namespace {

constexpr float kTile = 1.9f, kTileWide = 6.5f, kGap = 0.4f;  // in letters
constexpr float kEachLanguage_s = 3.5f, kPulse_s = 3.5f;
constexpr float kEdge = 0.9f;  // between the last row of tiles and the picture's foot, in letters

ImU32 ColorOf(const PageColor& c) { return IM_COL32(c[0], c[1], c[2], c[3]); }

size_t Columns(size_t count, const PageLook& look, int width_px) {
  const float room = (static_cast<float>(width_px) / look.letter_px - kGap) / (kTileWide + kGap);
  return std::clamp(static_cast<size_t>(std::max(1.0f, room)), size_t{1}, std::max<size_t>(1, count));
}

// In the middle of the picture's foot, row by row.
TextBox TileOf(size_t k, size_t count, const PageLook& look, int width_px, int height_px) {
  const size_t columns = Columns(count, look, width_px), rows = (count + columns - 1) / columns;
  const size_t row = k / columns, in_row = row + 1 < rows ? columns : count - row * columns;
  const float letter_px = look.letter_px, wide_px = std::min(kTileWide * letter_px, static_cast<float>(width_px));
  const float row_px = static_cast<float>(in_row) * (wide_px + kGap * letter_px) - kGap * letter_px;
  const float left_px = (static_cast<float>(width_px) - row_px) / 2 +
                        static_cast<float>(k - row * columns) * (wide_px + kGap * letter_px);
  const float from_foot_px = (kEdge + static_cast<float>(rows - row) * (kTile + kGap)) * letter_px;
  return {left_px, static_cast<float>(height_px) - from_foot_px, wide_px, kTile * letter_px};
}

// One line of it, as large as the look asks for or as the picture is wide.
void DrawLine(const std::string& line, const TextBox& box, TextLook words, TextLayer* text) {
  constexpr float kSmaller = 0.93f, kLeast = 0.3f;
  const float least_px = kLeast * words.letter_px;
  const float width_px = box.width_px - words.letter_px;
  while (words.letter_px > least_px && RoomFor(line, width_px, words, text).lines > 1) words.letter_px *= kSmaller;
  DrawText(line, box, words, text);
}

}  // namespace

std::optional<size_t> LanguageAt(Vec2 place, size_t languages, const PageLook& look, int width_px, int height_px) {
  if (place.x < 0 || languages < 2) return std::nullopt;
  const float x = place.x * static_cast<float>(width_px), y = place.y * static_cast<float>(height_px);
  for (size_t k = 0; k < languages; ++k) {
    const TextBox tile = TileOf(k, languages, look, width_px, height_px);
    if (x >= tile.left_px && x < tile.left_px + tile.width_px && y >= tile.top_px && y < tile.top_px + tile.height_px)
      return k;
  }
  return std::nullopt;
}

void ShowAttractPage(const std::string& title, const std::vector<std::string>& languages, float time_s, bool moves,
                     const PageLook& look, int width_px, int height_px, TextLayer* text) {
  const auto width = static_cast<float>(width_px), height = static_cast<float>(height_px);
  const size_t tiles = languages.size() < 2 ? 0 : languages.size();
  const float top_px = tiles > 0 ? TileOf(0, tiles, look, width_px, height_px).top_px : height - kEdge * look.letter_px;
  const float call_px = 3.2f * look.letter_px;
  ImDrawList* draw = ImGui::GetBackgroundDrawList();
  const ImU32 dark = look.high_contrast ? IM_COL32(0, 0, 0, 255) : IM_COL32(10, 8, 6, 215),
              clear = IM_COL32(10, 8, 6, 0);
  const float fade_px = top_px - 2 * call_px;
  draw->AddRectFilledMultiColor({0, fade_px}, {width, top_px - call_px}, clear, clear, dark, dark);
  draw->AddRectFilled({0, top_px - call_px}, {width, height}, dark);
  TextLook words = TextOf(look);
  words.plane = TextPlane::kBehind;
  words.align = Align::kCenter;
  const size_t now = languages.empty() ? 0 : static_cast<size_t>(time_s / kEachLanguage_s) % languages.size();
  words.language = languages.empty() ? look.language : languages[now];
  words.letter_px = 1.7f * look.letter_px;
  if (moves) words.color[3] = static_cast<uint8_t>(185 + 70 * std::cos(2 * kPi * time_s / kPulse_s));
  DrawLine(Say(Phrase::kTouchToBegin, words.language), {0, top_px - call_px, width, call_px * 0.9f}, words, text);
  words.color[3] = 255;
  words.language = look.language;
  words.letter_px = 1.3f * look.letter_px;
  DrawLine(title, {0, top_px - 2 * call_px + 0.6f * look.letter_px, width, call_px}, words, text);
  words.letter_px = look.letter_px;
  for (size_t k = 0; k < tiles; ++k) {
    const TextBox tile = TileOf(k, tiles, look, width_px, height_px);
    const ImVec2 low{tile.left_px, tile.top_px}, high{tile.left_px + tile.width_px, tile.top_px + tile.height_px};
    draw->AddRectFilled(low, high, ColorOf(look.button), 0.25f * look.letter_px);
    if (look.outline_px > 0)
      draw->AddRect(low, high, ColorOf(look.outline), 0.25f * look.letter_px, 0, look.outline_px);
    words.language = languages[k];
    DrawLine(LanguageName(languages[k]), tile, words, text);
  }
}

}  // namespace flaneur
