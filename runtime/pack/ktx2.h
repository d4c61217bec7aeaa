// KTX2 files: the Khronos container for block-compressed pictures. Only what a tour pack needs: one 2D picture with mip
// levels.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/pack/texture.h"

namespace flaneur {

// How a file's levels are packed, by KTX2's numbers.
enum class Supercompression : uint32_t { kNone = 0, kZstandard = 2 };

// A complete file. `texture` must be whole: each level as long as LevelBytes says.
std::vector<uint8_t> WriteKtx2(const PackTexture& texture, Supercompression packed);

// The bytes are not trusted. Errors: not KTX2, truncated, another format, cube, array or volume, packed otherwise or
// damaged. Pages read no packed ones.
Error ReadKtx2(std::span<const uint8_t> bytes, PackTexture* texture);
// The same of a file of `whole` bytes whose beginning is there: its finest levels are left out as far as they are not,
// and the texture is as large as the first that is. Errors: none is there.
Error ReadKtx2Beginning(std::span<const uint8_t> bytes, size_t whole, PackTexture* texture);
// What the levels take in memory that the beginning of a file speaks of; 0 where too little is there to tell.
uint64_t Ktx2BytesInMemory(std::span<const uint8_t> bytes);
// How many bytes from its beginning hold the first level that is no wider than `width_px`, and all coarser ones; all of
// them where no level is so narrow or too little is there to tell.
size_t Ktx2BytesOfWidth(std::span<const uint8_t> bytes, size_t whole, int width_px);

}  // namespace flaneur
