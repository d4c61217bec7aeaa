// A small picture of an impostor atlas for the report.
#pragma once
#include <cstdint>
#include <vector>

#include "pipeline/core/impostor.h"

namespace flaneur {

// PNG of the atlas's first frame from every second direction, as the camera goes round the person. Empty where the
// atlas cannot be decoded: a report without a picture is still a report.
std::vector<uint8_t> ImpostorThumbnail(const ImpostorAtlas& atlas);

// PNG of the person from both sides, grey, for each tint once: what it dyes is orange, the more the stronger. Empty as
// above.
std::vector<uint8_t> TintThumbnail(const ImpostorAtlas& atlas, const std::vector<Tint>& tints);

}  // namespace flaneur
