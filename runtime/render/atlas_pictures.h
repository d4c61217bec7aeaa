// An impostor's pictures as they are uploaded. Internal to runtime/render; no OpenGL.
#pragma once
#include <array>
#include <vector>

#include "runtime/pack/tour_pack.h"

namespace flaneur {

// The pack's own blocks where OpenGL reads them, else ETC2 of what has a channel of its own or is a colour; else
// texels, as in software, which decodes a block for every look-up.
enum class StoredAs { kTexels, kOwnBlocks, kEtc2Blocks };

struct AtlasFormats {
  bool bc7_blocks = false, rgtc_blocks = false;  // that OpenGL reads
  bool etc2_blocks = false;                      // likewise
  bool whole_blocks = false;  // and of a picture whose sides are no multiples of four it reads no blocks: WebGL
  bool fewer_texels = false;  // where there are no blocks: half as large, for they take four times the memory
  // Normals half as large, depth and motion together in one picture half as large: they look the same, take less memory
  // and are looked up faster.
  bool pack_details = false;
};

inline constexpr size_t kAtlasPictures = 5;

struct AtlasPicture {
  TextureFormat format = TextureFormat::kBc7Srgb;
  int width_px = 0, height_px = 0;
  StoredAs stored_as = StoredAs::kTexels;
  std::vector<std::vector<uint8_t>> levels;
};

// Albedo, normals, depth, motion, where tints may dye (empty: everywhere). Where details are packed motion is with the
// depth, as colour, and its own picture is empty. In many short steps, for who has no thread for it; the impostor
// outlives it.
class AtlasBuilder {
 public:
  AtlasBuilder(const PackImpostor& impostor, const AtlasFormats& formats);
  bool Advance();  // true: this was the last step
  std::array<AtlasPicture, kAtlasPictures> Take() { return std::move(pictures_); }

 private:
  std::array<const PackTexture*, kAtlasPictures> from_;
  std::array<size_t, kAtlasPictures> first_{};  // mip level of each that is uploaded
  bool pack_details_;
  std::array<AtlasPicture, kAtlasPictures> pictures_;
  size_t picture_ = 0;
  int next_row_px_ = 0;  // of its last level so far
};

std::array<AtlasPicture, kAtlasPictures> BuildAtlas(const PackImpostor& impostor, const AtlasFormats& formats);

}  // namespace flaneur
