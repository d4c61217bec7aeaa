#include "pipeline/impostor/compress_atlas.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "pipeline/impostor/atlas_image.h"
#include "pipeline/impostor/atlas_layout.h"
#include "pipeline/impostor/block_compression.h"
#include "pipeline/impostor/view_geometry.h"
#include "pipeline/pictures/picture_files.h"
#include "runtime/base/array.h"
#include "runtime/base/jobs.h"
#include "runtime/pack/ktx2.h"

namespace flaneur {
namespace {

constexpr float kUnseenWeight = 0.06f;  // of what fills a gutter

uint8_t Quantized(float value) { return static_cast<uint8_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255)); }

std::array<uint8_t, 4> AlbedoBytes(const AtlasTexel& texel) {
  const uint8_t coverage = texel.coverage > 0 ? std::max<uint8_t>(1, Quantized(texel.coverage)) : uint8_t{0};
  return {Quantized(texel.albedo[0]), Quantized(texel.albedo[1]), Quantized(texel.albedo[2]), coverage};
}

std::array<uint8_t, 4> TintBytes(const AtlasTexel& texel) {
  return {Quantized(texel.tints[0]), Quantized(texel.tints[1]), Quantized(texel.tints[2]), 255};
}

using Block = std::array<const AtlasTexel*, 16>;

// A level, block by block; at its edge the last texels are repeated.
std::vector<uint8_t> CompressLevel(const AtlasLevel& level, TextureFormat format, Jobs* jobs,
                                   const std::function<void(const Block&, uint8_t*)>& compress) {
  std::vector<uint8_t> out(LevelBytes(format, level.width, level.height));
  const size_t across = static_cast<size_t>(level.width + 3) / 4, down = static_cast<size_t>(level.height + 3) / 4;
  ParallelFor(jobs, down, [&](size_t row) {
    const int top = static_cast<int>(4 * row);
    uint8_t* at = out.data() + row * across * BlockBytes(format);
    for (int left = 0; left < level.width; left += 4, at += BlockBytes(format)) {
      Block block{};
      for (int i = 0; i < 16; ++i) {
        const int x = std::min(left + i % 4, level.width - 1), y = std::min(top + i / 4, level.height - 1);
        At(block, i) = &At(level.texels, y * level.width + x);
      }
      compress(block, at);
    }
  });
  return out;
}

template <typename Color>
void CompressColors(const Block& block, Color color, uint8_t* out) {
  BlockTexels texels{};
  std::array<float, 16> weights{};
  for (size_t i = 0; i < 16; ++i) {
    texels[i] = color(*block[i]);
    weights[i] = kUnseenWeight + (1 - kUnseenWeight) * std::min(1.0f, 2 * block[i]->coverage);
  }
  CompressBc7(texels, weights, std::span<uint8_t, 16>(out, 16));
}

// value: of a texel, 0 to 1.
template <typename Value>
void CompressChannel(const Block& block, Value value, uint8_t* out) {
  std::array<uint8_t, 16> values{};
  for (size_t i = 0; i < 16; ++i) values[i] = Quantized(value(*block[i]));
  CompressBc4(values, std::span<uint8_t, 8>(out, 8));
}

void CompressNormal(const Block& block, uint8_t* out) {
  CompressChannel(
      block, [](const AtlasTexel& t) { return SquareFromNormal(t.normal).x; }, out);
  CompressChannel(
      block, [](const AtlasTexel& t) { return SquareFromNormal(t.normal).y; }, out + 8);
}

std::vector<uint8_t> Ktx2(const std::vector<AtlasLevel>& levels, size_t first, TextureFormat format, Jobs* jobs,
                          const std::function<void(const Block&, uint8_t*)>& compress) {
  PackTexture texture{format, levels[first].width, levels[first].height, {}};
  for (size_t k = first; k < std::min(levels.size(), size_t{kAtlasLevels}); ++k) {
    texture.levels.push_back(CompressLevel(levels[k], format, jobs, compress));
  }
  return WriteKtx2(texture, Supercompression::kZstandard);
}

template <typename Bytes>
Pixels PixelsOf(const AtlasLevel& level, Bytes of) {
  Pixels pixels{level.width, level.height, {}};
  pixels.rgba.reserve(4 * level.texels.size());
  for (const AtlasTexel& texel : level.texels) {
    const auto bytes = of(texel);
    pixels.rgba.insert(pixels.rgba.end(), bytes.begin(), bytes.end());
  }
  return pixels;
}

// In the avatar's axes, with the depth as alpha.
Pixels NormalsOf(const AtlasLevel& finest, const ImpostorAtlas& atlas) {
  Pixels normal{finest.width, finest.height, {}};
  normal.rgba.assign(4 * finest.texels.size(), 128);
  const size_t directions = static_cast<size_t>(atlas.directions);
  for (size_t i = 0; i < atlas.cells.size(); ++i) {
    const ImpostorCell& cell = atlas.cells[i];
    const ViewAxes axes = AxesOf(static_cast<int>(i % directions), atlas.directions,
                                 atlas.elevations_deg[i / directions % atlas.elevations_deg.size()]);
    for (int y = cell.y; y < cell.y + cell.height; ++y) {
      for (int x = cell.x; x < cell.x + cell.width; ++x) {
        const size_t at = RowMajor(y, finest.width, x);
        const AtlasTexel& texel = finest.texels[at];
        const Vec3 n = Normalized(axes.right * texel.normal.x + axes.up * texel.normal.y + axes.near * texel.normal.z);
        const float channels[] = {n.x, n.y, n.z, texel.depth_m / atlas.depth_range_m};
        for (size_t c = 0; c < 4; ++c) normal.rgba[4 * at + c] = Quantized(0.5f + 0.5f * channels[c]);
      }
    }
  }
  return normal;
}

}  // namespace

Vec2 SquareFromNormal(Vec3 n) {
  n.z = std::max(n.z, 0.0f);
  const float sum = std::abs(n.x) + std::abs(n.y) + n.z;
  if (!(sum > 0)) return {0.5f, 0.5f};
  return {0.5f + 0.5f * (n.x + n.y) / sum, 0.5f + 0.5f * (n.x - n.y) / sum};
}

void CompressAtlas(const std::vector<AtlasLevel>& levels, Jobs* jobs, ImpostorAtlas* atlas) {
  const auto share = [](float value, float range) { return 0.5f + 0.5f * value / range; };
  const auto compress_albedo = [](const Block& block, uint8_t* out) { CompressColors(block, AlbedoBytes, out); };
  atlas->albedo_ktx2 = Ktx2(levels, 0, TextureFormat::kBc7Srgb, jobs, compress_albedo);
  atlas->normal_ktx2 = Ktx2(levels, 0, TextureFormat::kBc5, jobs, CompressNormal);
  atlas->depth_ktx2 = Ktx2(levels, 0, TextureFormat::kBc4, jobs, [&](const Block& block, uint8_t* out) {
    CompressChannel(
        block, [&](const AtlasTexel& t) { return share(t.depth_m, atlas->depth_range_m); }, out);
  });
  atlas->motion_ktx2 = Ktx2(levels, 1, TextureFormat::kBc7, jobs, [&](const Block& block, uint8_t* out) {
    const float motion_m = atlas->motion_range_m, bend_m = atlas->bend_range_m;
    CompressColors(
        block,
        [&](const AtlasTexel& t) {
          return BlockTexels::value_type{Quantized(share(t.motion_m.x, motion_m)),
                                         Quantized(share(t.motion_m.y, motion_m)), Quantized(share(t.bend_m.x, bend_m)),
                                         Quantized(share(t.bend_m.y, bend_m))};
        },
        out);
  });
  if (!atlas->tint_regions) return;
  atlas->tints_ktx2 = Ktx2(levels, 1, TextureFormat::kBc7, jobs,
                           [](const Block& block, uint8_t* out) { CompressColors(block, TintBytes, out); });
}

Error EncodeAtlas(const AtlasLevel& finest, Jobs* jobs, ImpostorAtlas* atlas) {
  const std::array<std::function<Error()>, 3> pictures{
      [&] { return EncodePng(PixelsOf(finest, AlbedoBytes), true, &atlas->albedo); },
      [&] { return EncodePng(NormalsOf(finest, *atlas), false, &atlas->normal); },
      [&] { return atlas->tint_regions ? EncodePng(PixelsOf(finest, TintBytes), false, &atlas->tints) : Ok(); }};
  std::array<Error, 3> errors;
  ParallelFor(jobs, pictures.size(), [&](size_t i) { errors[i] = pictures[i](); });
  for (Error& error : errors) {
    if (error) return std::move(error);
  }
  return Ok();
}

}  // namespace flaneur
