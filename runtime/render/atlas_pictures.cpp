#include "runtime/render/atlas_pictures.h"

#include <algorithm>

#include "runtime/render/etc2_blocks.h"

namespace flaneur {
namespace {

constexpr int kStrip_texels = 1 << 15;  // made ready at a time: a few milliseconds

StoredAs StoredHow(const PackTexture& from, const AtlasFormats& formats) {
  const TextureFormat format = from.format;
  const bool rgtc = format == TextureFormat::kBc4 || format == TextureFormat::kBc5;
  const bool fits = !formats.whole_blocks || (from.width_px % 4 == 0 && from.height_px % 4 == 0);
  if (fits && (rgtc ? formats.rgtc_blocks : formats.bc7_blocks)) return StoredAs::kOwnBlocks;
  // ETC2's colours differ in brightness alone: what is no colour would lose what its channels say.
  return formats.etc2_blocks && format != TextureFormat::kBc7 ? StoredAs::kEtc2Blocks : StoredAs::kTexels;
}

int Side_px(int whole_px, size_t level) { return std::max(1, whole_px >> level); }

// Decoded depth in red, motion in green and blue; its bend is left out.
AtlasPicture Packed(const AtlasPicture& depth, const AtlasPicture& motion) {
  AtlasPicture out{TextureFormat::kBc7Srgb, depth.width_px, depth.height_px, StoredAs::kTexels, {}};
  const auto side = [](int px, size_t level) { return static_cast<size_t>(std::max(1, px >> level)); };
  for (size_t level = 0; level < std::min(depth.levels.size(), motion.levels.size()); ++level) {
    const size_t width = side(out.width_px, level), height = side(out.height_px, level);
    const size_t motion_width = side(motion.width_px, level), motion_height = side(motion.height_px, level);
    std::vector<uint8_t>& texels = out.levels.emplace_back(width * height * 4);
    for (size_t y = 0; y < height; ++y) {
      for (size_t x = 0; x < width; ++x) {
        const uint8_t* moved =
            &motion.levels[level][4 * (y * motion_height / height * motion_width + x * motion_width / width)];
        uint8_t* to = &texels[4 * (y * width + x)];
        to[0] = depth.levels[level][y * width + x], to[1] = moved[0], to[2] = moved[1];
      }
    }
  }
  return out;
}

// Rows of blocks from that texel row on, a strip of them; returns the row behind it.
int AddStrip(const PackTexture& from, size_t level, int row_px, StoredAs stored_as, std::vector<uint8_t>* to) {
  const std::vector<uint8_t>& blocks = from.levels[level];
  const int width_px = Side_px(from.width_px, level), height_px = Side_px(from.height_px, level);
  if (stored_as == StoredAs::kOwnBlocks) {
    *to = blocks;
    return height_px;
  }
  const int end_px = std::min(height_px, row_px + std::max(4, kStrip_texels / width_px / 4 * 4));
  const auto at = [&](int row) {
    return blocks.begin() + static_cast<std::ptrdiff_t>(LevelBytes(from.format, width_px, row));
  };
  const std::vector<uint8_t> texels =
      DecodeLevel(from.format, width_px, end_px - row_px, std::vector<uint8_t>(at(row_px), at(end_px)));
  const std::vector<uint8_t> more =
      stored_as == StoredAs::kTexels ? texels : Etc2Blocks(Channels(from.format), width_px, end_px - row_px, texels);
  to->insert(to->end(), more.begin(), more.end());
  return end_px;
}

}  // namespace

AtlasBuilder::AtlasBuilder(const PackImpostor& impostor, const AtlasFormats& formats)
    : from_{&impostor.albedo, &impostor.normal, &impostor.depth, &impostor.motion, &impostor.tints},
      pack_details_(formats.pack_details) {
  for (size_t k = 0; k < from_.size(); ++k) {
    const PackTexture& from = *from_[k];
    if (from.levels.empty()) continue;
    const StoredAs stored_as = StoredHow(from, formats);
    const bool details = k == 1 || k == 2;
    const bool coarser = formats.pack_details ? details : formats.fewer_texels && stored_as == StoredAs::kTexels;
    first_[k] = std::min<size_t>(coarser ? 1 : 0, from.levels.size() - 1);
    pictures_[k] = {from.format, Side_px(from.width_px, first_[k]), Side_px(from.height_px, first_[k]), stored_as, {}};
  }
}

bool AtlasBuilder::Advance() {
  const auto done = [&](size_t k) {
    const size_t wanted = std::min<size_t>(from_[k]->levels.size() - first_[k], kCoarsestAtlasLevel + 1);
    return from_[k]->levels.empty() || (pictures_[k].levels.size() == wanted && next_row_px_ == 0);
  };
  while (picture_ < kAtlasPictures && done(picture_)) ++picture_;
  if (picture_ == kAtlasPictures) {
    if (pack_details_) {
      pictures_[2] = Packed(pictures_[2], pictures_[3]);
      pictures_[3] = {};
    }
    return true;
  }
  AtlasPicture& picture = pictures_[picture_];
  if (next_row_px_ == 0) picture.levels.emplace_back();
  const size_t level = picture.levels.size() - 1;
  const int behind_px =
      AddStrip(*from_[picture_], first_[picture_] + level, next_row_px_, picture.stored_as, &picture.levels.back());
  next_row_px_ = behind_px == Side_px(picture.height_px, level) ? 0 : behind_px;
  return false;
}

std::array<AtlasPicture, kAtlasPictures> BuildAtlas(const PackImpostor& impostor, const AtlasFormats& formats) {
  AtlasBuilder builder(impostor, formats);
  while (!builder.Advance()) {}
  return builder.Take();
}

}  // namespace flaneur
