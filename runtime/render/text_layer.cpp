#include "runtime/render/text_layer.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "runtime/render/glyph_atlas.h"
#include "runtime/render/overlay_textures.h"

namespace flaneur {
namespace {

using LayoutKey = std::tuple<std::string, std::string, float, float, float, int, Align>;

LayoutKey KeyOf(const std::string& text, float width_px, const TextStyle& s) {
  return {text, s.language, width_px, s.letter_px, s.line_gap, s.most_lines, s.align};
}

struct KeptLayout {
  TextLayout layout;
  bool used = true;  // since the last picture
};

}  // namespace

struct TextLayer::Impl {
  std::unique_ptr<Fonts> own_fonts;
  Fonts* fonts = nullptr;
  GlyphAtlas atlas;
  std::map<LayoutKey, KeptLayout> layouts;
  std::vector<DrawnText> drawn;

  const TextLayout& LayOut(const std::string& text, float width_px, const TextStyle& style) {
    const auto [kept, is_new] = layouts.try_emplace(KeyOf(text, width_px, style));
    if (is_new) kept->second.layout = LayOutText(text, width_px, style, fonts);
    kept->second.used = true;
    return kept->second.layout;
  }
};

TextLayer::TextLayer(Fonts* fonts) : impl_(std::make_unique<Impl>()) {
  if (fonts == nullptr) impl_->own_fonts = std::make_unique<Fonts>();
  impl_->fonts = fonts == nullptr ? impl_->own_fonts.get() : fonts;
}
TextLayer::~TextLayer() = default;

void TextLayer::BeginPicture() {
  impl_->drawn.clear();
  MakeRoom(&impl_->atlas);
  std::erase_if(impl_->layouts, [](const auto& kept) { return !kept.second.used; });
  for (auto& [key, kept] : impl_->layouts) kept.used = false;
}

const std::vector<DrawnText>& TextLayer::drawn() const { return impl_->drawn; }
Fonts& TextLayer::fonts() { return *impl_->fonts; }
GlyphAtlas& TextLayer::atlas() { return impl_->atlas; }

namespace {

ImDrawList* ListOf(TextPlane plane) {
  return plane == TextPlane::kWindow   ? ImGui::GetWindowDrawList()
         : plane == TextPlane::kBehind ? ImGui::GetBackgroundDrawList()
                                       : ImGui::GetForegroundDrawList();
}

void AddGlyphs(const TextLayout& layout, Vec2 corner, const TextLook& look, TextLayer* layer) {
  ImDrawList* list = ListOf(look.plane);
  const ImU32 color = IM_COL32(look.color[0], look.color[1], look.color[2], look.color[3]);
  constexpr float kPart = 1.0f / kGlyphAtlas_px;
  list->PushTextureID(kGlyphTexture);
  for (const PlacedGlyph& g : layout.glyphs) {
    const auto placed = PlaceGlyph(layer->fonts(), g.font, g.glyph, layout.em_px, &layer->atlas());
    if (!placed || placed->width_px == 0) continue;
    const float left = std::round(corner.x + g.pen_px.x) + static_cast<float>(placed->left_px);
    const float top = std::round(corner.y + g.pen_px.y) + static_cast<float>(placed->top_px);
    const auto width = static_cast<float>(placed->width_px), height = static_cast<float>(placed->height_px);
    const float u = static_cast<float>(placed->x_px) * kPart, v = static_cast<float>(placed->y_px) * kPart;
    list->PrimReserve(6, 4);
    list->PrimRectUV({left, top}, {left + width, top + height}, {u, v}, {u + width * kPart, v + height * kPart}, color);
  }
  list->PopTextureID();
}

}  // namespace

TextRoom RoomFor(const std::string& text, float width_px, const TextStyle& style, TextLayer* layer) {
  const TextLayout& layout = layer->impl().LayOut(text, width_px, style);
  return {layout.width_px, layout.height_px, layout.lines.size(), layout.broken_words};
}

bool DrawText(const std::string& text, const TextBox& box, const TextLook& look, TextLayer* layer) {
  TextStyle style = look;
  const TextLayout* layout = &layer->impl().LayOut(text, box.width_px, style);
  constexpr float kRounding_px = 0.5f;
  if (layout->height_px > box.height_px + kRounding_px && layout->lines.size() > 1) {
    const float line_px = layout->height_px / static_cast<float>(layout->lines.size());
    style.most_lines = std::max(1, static_cast<int>((box.height_px + kRounding_px) / line_px));
    layout = &layer->impl().LayOut(text, box.width_px, style);
  }
  const float free_px = look.upright == Upright::kMiddle ? (box.height_px - layout->height_px) / 2 : 0;
  const Vec2 corner{box.left_px, box.top_px + free_px};
  AddGlyphs(*layout, corner, look, layer);
  const TextBox covers{corner.x + layout->left_px, corner.y, layout->width_px, layout->height_px};
  layer->impl().drawn.push_back({text, box, covers, layout->cut, layout->broken_words});
  return !layout->cut;
}

}  // namespace flaneur
