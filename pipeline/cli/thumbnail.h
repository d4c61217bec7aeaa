// A small picture of an impostor atlas for the report.
#pragma once
#include <cstdint>
#include <vector>

#include "pipeline/core/impostor.h"

namespace flaneur {

// PNG of the atlas's first frame from every second direction, as the camera goes round the person. Empty where the
// atlas cannot be decoded: a report without a picture is still a report.
std::vector<uint8_t> ImpostorThumbnail(const ImpostorAtlas& atlas);

}  // namespace flaneur
