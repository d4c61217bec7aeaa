// KTX2 files: the Khronos container for block-compressed pictures. Only what a tour pack needs: one 2D picture with mip
// levels.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/pack/texture.h"

namespace flaneur {

// A complete file, without supercompression. `texture` must be whole: each level as long as LevelBytes says.
std::vector<uint8_t> WriteKtx2(const PackTexture& texture);

// The bytes are not trusted. Errors: not KTX2, truncated, another format, cube, array or volume, supercompressed.
Error ReadKtx2(std::span<const uint8_t> bytes, PackTexture* texture);

}  // namespace flaneur
