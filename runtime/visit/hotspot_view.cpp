#include "runtime/visit/hotspot_view.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "runtime/base/array.h"
#include "runtime/base/pixels.h"
#include "runtime/visit/page_rows.h"

namespace flaneur {
namespace {

constexpr float kMark = 0.32f, kMarkGrows = 0.32f;     // radius in letters: unnoticed, and what interest adds
constexpr float kMarkLifts = 0.75f;                    // of its opacity, where it is near the edge of its reach
constexpr float kPanelWide = 17, kPanelShare = 0.44f;  // in letters; of the picture's width, at most
constexpr float kLeastPanelWide = 12, kMostPanelShare = 0.62f;  // likewise, where letters are large
constexpr float kShrinks = 0.92f, kLeastShrunk = 0.6f;          // of letters, where words would not fit
constexpr float kLeastPicture = 3;                              // in letters; lower, it is left out
constexpr float kPanelHigh = 0.86f, kPortraitHigh = 0.5f;       // of the picture's height, at most
constexpr float kPictureHigh = 0.3f;                            // the same of its picture
constexpr float kEdge = 0.6f, kGap = 0.4f, kClose = 1.5f;       // in letters
constexpr float kTitle = 1.1f;                                  // of a letter

ImU32 Packed(const PageColor& c, float share = 1) {
  return IM_COL32(c[0], c[1], c[2], static_cast<int>(static_cast<float>(c[3]) * share));
}

void ShowMark(const SeenHotspot& seen, bool open, const PageLook& look, float width_px, float height_px) {
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  const ImVec2 at{seen.place.x * width_px, seen.place.y * height_px};
  const float grown = open ? 1 : seen.interest, radius_px = look.letter_px * (kMark + kMarkGrows * grown);
  const float share = look.high_contrast ? 1 : kMarkLifts + (1 - kMarkLifts) * grown;
  list->AddCircleFilled(at, radius_px * 1.25f, IM_COL32(0, 0, 0, static_cast<int>(90 * share)), 32);
  list->AddCircleFilled(at, radius_px, Packed(look.marked, share), 32);
  list->AddCircle(at, radius_px, Packed(look.outline, share), 32, std::max(1.5f, radius_px * 0.14f));
  list->AddCircleFilled(at, radius_px * 0.28f, Packed(look.outline, share), 16);
  if (open || seen.interest <= 0) return;
  list->PathArcTo(at, radius_px * 1.4f, -kPi / 2, -kPi / 2 + 2 * kPi * seen.interest, 32);
  list->PathStroke(Packed(look.outline), 0, std::max(2.0f, radius_px * 0.18f));
}

void TakePicture(const TourPack& pack, int wanted, Overlay* overlay, HotspotPicture* p) {
  if (wanted == p->picture) return;
  overlay->RemovePicture(p->shown);
  *p = {wanted, nullptr, 0, 0};
  if (wanted < 0 || wanted >= Count(pack.pictures)) return;
  constexpr int kMostSide_px = 4096;  // the bytes are not trusted
  const std::vector<uint8_t>& bytes = At(pack.pictures, wanted);
  const auto size = DecodedSize(bytes);
  if (!size || size->width > kMostSide_px || size->height > kMostSide_px) return;
  const auto pixels = Decoded(bytes);
  if (!pixels) return;
  p->width_px = pixels->width;
  p->height_px = pixels->height;
  p->shown = overlay->AddPicture(pixels->width, pixels->height, pixels->rgba);
}

struct Panel {
  float left_px = 0, top_px = 0, width_px = 0, most_px = 0;  // most: of its height
};

// Beside what it tells of; in a high picture above its caption.
Panel PlaceOfPanel(const SeenHotspot* seen, const PageLook& look, float width_px, float height_px) {
  const float edge_px = kEdge * look.letter_px;
  if (height_px > width_px) {
    const bool below = seen == nullptr || seen->place.y < 0.45f;
    const float high_px = kPortraitHigh * height_px;
    return {edge_px, below ? height_px * 0.45f : edge_px + kClose * 2 * look.letter_px, width_px - 2 * edge_px,
            std::min(high_px, height_px * 0.4f)};
  }
  const float most_px =
      std::max(kPanelShare * width_px, std::min(kLeastPanelWide * look.letter_px, kMostPanelShare * width_px));
  const float wide_px = std::min(kPanelWide * look.letter_px, most_px);
  const bool right = seen == nullptr || seen->place.x < 0.5f;
  const float top_px = right ? edge_px + kClose * 2 * look.letter_px : edge_px;  // the pages' button is in that corner
  return {right ? width_px - wide_px - edge_px : edge_px, top_px, wide_px, kPanelHigh * height_px - top_px};
}

// Of a panel's title and text, with what is around them.
float NeededHeight_px(const std::string& title, const std::string& text, float inner_px, const TextLook& words,
                      TextLayer* layer) {
  const float letter_px = words.letter_px, gap_px = kGap * letter_px;
  TextLook head = words;
  head.letter_px *= kTitle;
  const float head_px = RoomFor(title, inner_px - kClose * letter_px - gap_px, head, layer).height_px;
  const float text_px = text.empty() ? 0 : RoomFor(text, inner_px, words, layer).height_px;
  return std::ceil(1.2f * letter_px + std::max(kClose * letter_px + gap_px, head_px + kGap * head.letter_px) + text_px);
}

float Write(const std::string& text, float top_px, const TextBox& within, TextLook look, TextLayer* layer) {
  if (text.empty()) return 0;
  look.upright = Upright::kTop;
  const float room_px = within.top_px + within.height_px - top_px;
  const float high_px = std::min(room_px, RoomFor(text, within.width_px, look, layer).height_px);
  if (high_px > look.letter_px / 2) DrawText(text, {within.left_px, top_px, within.width_px, high_px}, look, layer);
  return high_px + kGap * look.letter_px;
}

}  // namespace

void ShowHotspotMarks(const Hotspots& h, const PageLook& look, int width_px, int height_px) {
  for (const SeenHotspot& seen : h.seen)
    ShowMark(seen, seen.hotspot == h.open, look, static_cast<float>(width_px), static_cast<float>(height_px));
}

bool ShowHotspotPanel(const TourPack& pack, const Hotspots& h, PageLook look, int width_px, int height_px,
                      Overlay* overlay, HotspotPicture* picture) {
  const Hotspot* hotspot = h.open < 0 ? nullptr : &At(pack.hotspots, h.open);
  TakePicture(pack, hotspot == nullptr ? -1 : hotspot->picture, overlay, picture);
  if (hotspot == nullptr) return false;
  const auto seen = std::find_if(h.seen.begin(), h.seen.end(), [&](const auto& s) { return s.hotspot == h.open; });
  const float high_px = static_cast<float>(height_px);
  const Panel panel =
      PlaceOfPanel(seen == h.seen.end() ? nullptr : &*seen, look, static_cast<float>(width_px), high_px);
  const std::string title = TextIn(hotspot->titles, look.language, pack.language);
  const std::string text = TextIn(hotspot->texts, look.language, pack.language);
  TextLayer* layer = &overlay->text();
  const float most_letter_px = look.letter_px;
  const auto inner = [&] { return panel.width_px - 1.6f * look.letter_px; };
  while (look.letter_px > kLeastShrunk * most_letter_px &&
         NeededHeight_px(title, text, inner(), TextOf(look), layer) > panel.most_px)
    look.letter_px *= kShrinks;
  const float letter_px = look.letter_px, inner_px = inner();
  TextLook words = TextOf(look), head = words;
  head.letter_px *= kTitle;
  ImVec2 shown_px{0, 0};
  if (picture->shown != nullptr) {
    const float scale = std::min(inner_px / static_cast<float>(picture->width_px),
                                 kPictureHigh * high_px / static_cast<float>(picture->height_px));
    shown_px = {scale * static_cast<float>(picture->width_px), scale * static_cast<float>(picture->height_px)};
  }
  const float gap_px = kGap * letter_px, head_px = inner_px - kClose * letter_px - gap_px;
  float needed_px = NeededHeight_px(title, text, inner_px, words, layer);
  // Words before pictures: it is as large as they leave it room.
  const float room_px = std::floor(panel.most_px - needed_px - gap_px) - 1;  // windows have whole pixels
  if (shown_px.y > 0 && room_px < shown_px.y) {
    const float share = room_px < kLeastPicture * letter_px ? 0 : room_px / shown_px.y;
    shown_px = {shown_px.x * share, shown_px.y * share};
  }
  if (shown_px.y > 0) needed_px += std::ceil(shown_px.y + gap_px);
  const PageStyle style(look);
  ImGui::SetNextWindowPos({panel.left_px, panel.top_px});
  ImGui::SetNextWindowSize({panel.width_px, std::min(needed_px, panel.most_px)});
  ImGui::Begin("hotspot", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoFocusOnAppearing);
  const ImVec2 corner = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
  float top_px = corner.y;
  top_px +=
      std::max(kClose * letter_px + gap_px, Write(title, top_px, {corner.x, corner.y, head_px, room.y}, head, layer));
  if (shown_px.y > 0) {
    const ImVec2 low{corner.x + (inner_px - shown_px.x) / 2, top_px};
    ImGui::GetWindowDrawList()->AddImage(picture->shown, low, {low.x + shown_px.x, low.y + shown_px.y});
    top_px += shown_px.y + gap_px;
  }
  Write(text, top_px, {corner.x, corner.y, inner_px, room.y}, words, layer);
  const float side_px = kClose * letter_px;
  const ImVec2 cross{corner.x + inner_px - side_px, corner.y};
  ImGui::SetCursorScreenPos(cross);
  const bool closed = ImGui::Button("###close hotspot", {side_px, side_px});
  for (float turn : {1.0f, -1.0f}) {
    const float arm_px = 0.25f * side_px, x = cross.x + side_px / 2, y = cross.y + side_px / 2;
    ImGui::GetWindowDrawList()->AddLine({x - arm_px, y - turn * arm_px}, {x + arm_px, y + turn * arm_px},
                                        Packed(look.text), std::max(1.5f, side_px / 14));
  }
  ImGui::End();
  return closed;
}

}  // namespace flaneur
