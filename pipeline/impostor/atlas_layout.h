// Where each picture stands in the atlas. Internal to pipeline/impostor.
#pragma once
#include <vector>

#include "pipeline/core/impostor.h"
#include "pipeline/impostor/view_geometry.h"

namespace flaneur {

// Fills in the cells, cropped to their bounds and `border_px` more, and the atlas's size: of all widths the one that
// wastes least. Cells stand at multiples of 4, so that no block and no texel of the first two mip levels shows two of
// them. False where no atlas of 8192 px a side holds them.
bool LayOutCells(const std::vector<ViewBounds>& views, int border_px, ImpostorAtlas* atlas);

// All four KTX2 pictures together, in bytes on the graphics card.
size_t TextureMemory(const ImpostorAtlas& atlas);

// Their mip levels: as many as halve the atlas evenly, the motion's one less.
inline constexpr int kAtlasLevels = 6;

}  // namespace flaneur
