#include "pipeline/cli/thumbnail.h"

#include <algorithm>

#include "pipeline/impostor/atlas_image.h"
#include "pipeline/pictures/picture_files.h"
#include "runtime/base/array.h"
#include "runtime/pack/tint.h"

namespace flaneur {
namespace {

void CopyCell(const Pixels& from, const ImpostorCell& cell, int to_x, int to_y, Pixels* to) {
  for (int y = 0; y < cell.height; ++y) {
    for (int x = 0; x < cell.width; ++x) {
      const auto* in = &from.rgba[static_cast<size_t>((cell.y + y) * from.width + cell.x + x) * 4];
      auto* out = &to->rgba[static_cast<size_t>((to_y + y) * to->width + to_x + x) * 4];
      if (in[3] > 0) std::copy(in, in + 4, out);  // the gutters' fill stays out
    }
  }
}

constexpr Vec3 kDyed{1.0f, 0.45f, 0.0f};

// The whole atlas in grey, with what the t-th tint dyes in a colour that shows.
Pixels DyedBy(const Pixels& albedo, const std::optional<Pixels>& regions, const std::vector<Tint>& tints, size_t t) {
  Pixels out = albedo;
  for (size_t i = 0; i + 3 < out.rgba.size(); i += 4) {
    const auto channel = [&](size_t c) { return static_cast<float>(albedo.rgba[i + c]) / 255; };
    const Vec3 color{channel(0), channel(1), channel(2)};
    const float grey = 0.25f + 0.6f * Dot(color, {0.30f, 0.59f, 0.11f});
    const float region = regions ? static_cast<float>(regions->rgba[i + t]) / 255 : 1;
    const Vec3 shown =
        Vec3{grey, grey, grey} + (kDyed - Vec3{grey, grey, grey}) * (region * TintShare(tints[t], color));
    const float channels[] = {shown.x, shown.y, shown.z};
    for (size_t c = 0; c < 3; ++c) out.rgba[i + c] = static_cast<uint8_t>(std::clamp(channels[c], 0.0f, 1.0f) * 255);
  }
  return out;
}

}  // namespace

std::vector<uint8_t> TintThumbnail(const ImpostorAtlas& atlas, const std::vector<Tint>& tints) {
  const std::optional<Pixels> whole = Decoded(atlas.albedo.bytes);
  std::optional<Pixels> regions;
  if (atlas.tint_regions) regions = Decoded(atlas.tints.bytes);
  if (!whole || whole->width != atlas.width_px || whole->height != atlas.height_px) return {};
  if (regions && regions->rgba.size() != whole->rgba.size()) return {};
  const ImpostorCell& front = atlas.cells[CellIndex(atlas, 0, 0, 0)];
  const ImpostorCell& back = atlas.cells[CellIndex(atlas, 0, 0, atlas.directions / 2)];
  Pixels strip{Count(tints) * (front.width + back.width), std::max(front.height, back.height), {}};
  strip.rgba.resize(static_cast<size_t>(strip.width) * static_cast<size_t>(strip.height) * 4);
  int left = 0;
  for (size_t t = 0; t < tints.size(); ++t) {
    const Pixels dyed = DyedBy(*whole, regions, tints, t);
    for (const ImpostorCell* cell : {&front, &back}) {
      CopyCell(dyed, *cell, left, strip.height - cell->height, &strip);
      left += cell->width;
    }
  }
  Image png;
  if (EncodePng(strip, true, &png)) return {};
  return png.bytes;
}

std::vector<uint8_t> ImpostorThumbnail(const ImpostorAtlas& atlas) {
  const std::optional<Pixels> whole = Decoded(atlas.albedo.bytes);
  if (!whole || whole->width != atlas.width_px || whole->height != atlas.height_px) return {};
  const int step = atlas.directions > 8 ? 2 : 1;
  Pixels strip;
  for (int d = 0; d < atlas.directions; d += step) {
    const ImpostorCell& cell = atlas.cells[CellIndex(atlas, 0, 0, d)];
    strip.width += cell.width;
    strip.height = std::max(strip.height, cell.height);
  }
  strip.rgba.resize(static_cast<size_t>(strip.width) * static_cast<size_t>(strip.height) * 4);
  int left = 0;
  for (int d = 0; d < atlas.directions; d += step) {
    const ImpostorCell& cell = atlas.cells[CellIndex(atlas, 0, 0, d)];
    CopyCell(*whole, cell, left, strip.height - cell.height, &strip);
    left += cell.width;
  }
  Image png;
  if (EncodePng(strip, true, &png)) return {};
  return png.bytes;
}

}  // namespace flaneur
