#include "pipeline/impostor/atlas_layers.h"

#include <algorithm>
#include <functional>
#include <string>

#include "pipeline/impostor/view_geometry.h"
#include "pipeline/pictures/picture_files.h"
#include "runtime/base/array.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;

// One sample in 4096 counts; what rounding leaves in Blender's sums does not.
constexpr float kMinCoverage = 1e-4f;
// How far coverage keeps from a half, for each halving: compression is off by more the smaller a person gets in a
// block.
constexpr float kClearOfHalf = 0.02f;

enum Layer {
  kRed,
  kGreen,
  kBlue,
  kNormalX,
  kNormalY,
  kNormalZ,
  kMotionX,
  kMotionY,
  kMotionZ,
  kBendX,
  kBendY,
  kBendZ,
  kDepth,
  kCoverage,
  kTint0,  // from here on only where tints are bound to materials
  kTint1,
  kTint2,
  kLayers
};
constexpr std::array<const char*, kLayers> kLayerNames = {
    "albedo.R", "albedo.G", "albedo.B", "normal.R", "normal.G",  "normal.B", "motion.R", "motion.G", "motion.B",
    "bend.R",   "bend.G",   "bend.B",   "depth.",   "coverage.", "tints.R",  "tints.G",  "tints.B"};
// Versions of Blender name the parts of a vector and of a single value differently.
constexpr std::array<const char*, kLayers> kOtherNames = {
    "albedo.X", "albedo.Y", "albedo.Z", "normal.X", "normal.Y", "normal.Z", "motion.X", "motion.Y", "motion.Z",
    "bend.X",   "bend.Y",   "bend.Z",   "depth",    "coverage", "tints.X",  "tints.Y",  "tints.Z"};

// Channel names are "ViewLayer.albedo.R".
int FindChannel(const std::vector<std::string>& names, const std::string& wanted) {
  for (size_t i = 0; i < names.size(); ++i) {
    const size_t at = names[i].find(wanted);
    if (at != std::string::npos && (at == 0 || names[i][at - 1] == '.')) return static_cast<int>(i);
  }
  return -1;
}

Error FindChannels(const fs::path& exr, const PictureShape& shape, std::array<int, kLayers>* channels) {
  for (size_t i = 0; i < kLayers; ++i) {
    int found = FindChannel(shape.channels, kLayerNames[i]);
    if (found < 0) found = FindChannel(shape.channels, kOtherNames[i]);
    if (found < 0 && i < kTint0) {
      return Fail(exr.string() + ": Blender wrote no layer '" + kLayerNames[i] + "'; use Blender 3.4 to 4.x");
    }
    (*channels)[i] = found;
  }
  return Ok();
}

// layers: the sums of one texel, premultiplied with the coverage.
AtlasTexel TexelOf(const std::array<float, kLayers>& layers) {
  AtlasTexel texel;
  if (layers[kCoverage] < kMinCoverage) return texel;
  const auto mean = [&](Layer layer) { return layers[layer] / layers[kCoverage]; };
  texel.coverage = std::min(1.0f, layers[kCoverage]);
  texel.albedo = {mean(kRed), mean(kGreen), mean(kBlue)};
  texel.normal = {mean(kNormalX), mean(kNormalY), mean(kNormalZ)};
  texel.depth_m = mean(kDepth);
  texel.motion_m = {mean(kMotionX), mean(kMotionY), mean(kMotionZ)};
  texel.bend_m = {mean(kBendX), mean(kBendY), mean(kBendZ)};
  texel.tints = {mean(kTint0), mean(kTint1), mean(kTint2)};
  return texel;
}

void AddWeighted(const AtlasTexel& from, float weight, AtlasTexel* sum) {
  for (size_t c = 0; c < 3; ++c) sum->albedo[c] += weight * from.albedo[c];
  sum->normal = sum->normal + from.normal * weight;
  sum->depth_m += weight * from.depth_m;
  sum->motion_m = sum->motion_m + from.motion_m * weight;
  sum->bend_m = sum->bend_m + from.bend_m * weight;
  for (size_t t = 0; t < 3; ++t) sum->tints[t] += weight * from.tints[t];
}

AtlasLevel Half(const AtlasLevel& from) {
  AtlasLevel to{std::max(1, from.width / 2), std::max(1, from.height / 2), {}};
  to.texels.resize(static_cast<size_t>(to.width) * static_cast<size_t>(to.height));
  for (int y = 0; y < to.height; ++y) {
    for (int x = 0; x < to.width; ++x) {
      AtlasTexel sum;
      for (int k = 0; k < 4; ++k) {
        const int u = std::min(2 * x + k % 2, from.width - 1), v = std::min(2 * y + k / 2, from.height - 1);
        const AtlasTexel& texel = At(from.texels, v * from.width + u);
        AddWeighted(texel, texel.coverage, &sum);
        sum.coverage += texel.coverage;
      }
      if (sum.coverage <= 0) continue;
      AtlasTexel& mean = At(to.texels, y * to.width + x);
      AddWeighted(sum, 1 / sum.coverage, &mean);
      mean.coverage = sum.coverage / 4;
    }
  }
  return to;
}

// Where coverage passes `threshold` it comes to pass a half, clear of it by at least so much.
float Stretched(float coverage, float threshold, float clear) {
  const float share = 0.5f - clear;
  return coverage < threshold ? share * coverage / threshold : 1 - share * (1 - coverage) / (1 - threshold);
}

// The coverage that so large a share of the texels reaches.
float ThresholdFor(const AtlasLevel& level, double share) {
  std::vector<float> coverages;
  for (const AtlasTexel& texel : level.texels) coverages.push_back(texel.coverage);
  const auto rank = static_cast<size_t>(share * static_cast<double>(coverages.size()) + 0.5);
  if (rank == 0 || rank >= coverages.size()) return 0.5f;
  std::nth_element(coverages.begin(), coverages.begin() + static_cast<std::ptrdiff_t>(rank - 1), coverages.end(),
                   std::greater<>());
  return std::clamp(coverages[rank - 1], 0.05f, 0.95f);
}

}  // namespace

Error ReadLayers(const fs::path& exr, int first_row, AtlasLevel* level) {
  std::array<int, kLayers> channels{};
  size_t stride = 0;
  const auto accept = [&](const PictureShape& shape) {
    if (shape.width != level->width || first_row + shape.height > level->height) {
      return Fail(exr.string() + ": Blender rendered " + std::to_string(shape.width) + " x " +
                  std::to_string(shape.height) + " pixels, not what it was asked for");
    }
    stride = shape.channels.size();
    return FindChannels(exr, shape, &channels);
  };
  return ReadPicture(exr, accept, [&](int row, std::span<const float> values) {
    AtlasTexel* texels = &At(level->texels, (first_row + row) * level->width);
    for (size_t i = 0; i < values.size() / stride; ++i) {
      std::array<float, kLayers> layers{};
      for (size_t c = 0; c < kLayers; ++c) {
        if (channels[c] >= 0) layers[c] = values[i * stride + static_cast<size_t>(channels[c])];
      }
      texels[i] = TexelOf(layers);
    }
  });
}

void TurnIntoCells(const ImpostorAtlas& atlas, AtlasLevel* level) {
  const size_t elevations = atlas.elevations_deg.size(), directions = static_cast<size_t>(atlas.directions);
  for (size_t i = 0; i < atlas.cells.size(); ++i) {
    const ImpostorCell& cell = atlas.cells[i];
    const ViewAxes axes =
        AxesOf(static_cast<int>(i % directions), atlas.directions, atlas.elevations_deg[i / directions % elevations]);
    const auto turned = [&](Vec3 v) { return Vec3{Dot(v, axes.right), Dot(v, axes.up), Dot(v, axes.near)}; };
    for (int y = cell.y; y < cell.y + cell.height; ++y) {
      for (int x = cell.x; x < cell.x + cell.width; ++x) {
        AtlasTexel& texel = At(level->texels, y * level->width + x);
        texel.normal = turned(texel.normal);
        texel.motion_m = turned(texel.motion_m);
        texel.bend_m = turned(texel.bend_m);
      }
    }
  }
}

std::vector<AtlasLevel> MakeLevels(AtlasLevel finest) {
  std::vector<AtlasLevel> levels;
  levels.push_back(std::move(finest));
  while (levels.back().width > 1 || levels.back().height > 1) levels.push_back(Half(levels.back()));
  return levels;
}

void FillGutters(std::vector<AtlasLevel>* levels) {
  for (size_t k = levels->size() - 1; k-- > 0;) {
    AtlasLevel& level = (*levels)[k];
    const AtlasLevel& coarser = (*levels)[k + 1];
    for (int y = 0; y < level.height; ++y) {
      for (int x = 0; x < level.width; ++x) {
        AtlasTexel& texel = At(level.texels, y * level.width + x);
        if (texel.coverage > 0) continue;
        const int u = std::min(x / 2, coarser.width - 1), v = std::min(y / 2, coarser.height - 1);
        texel = At(coarser.texels, v * coarser.width + u);
        texel.coverage = 0;
      }
    }
  }
}

void KeepCoverage(std::vector<AtlasLevel>* levels, int count) {
  const double share = CoveredShare(levels->front(), 0.5f);
  for (size_t k = 1; k < std::min(levels->size(), static_cast<size_t>(count)); ++k) {
    AtlasLevel& level = (*levels)[k];
    const float threshold = ThresholdFor(level, share);
    for (AtlasTexel& texel : level.texels)
      texel.coverage = Stretched(texel.coverage, threshold, kClearOfHalf * static_cast<float>(k));
  }
}

double CoveredShare(const AtlasLevel& level, float least) {
  const auto covered = [&](const AtlasTexel& texel) { return texel.coverage >= least; };
  return level.texels.empty() ? 0
                              : static_cast<double>(std::count_if(level.texels.begin(), level.texels.end(), covered)) /
                                    static_cast<double>(level.texels.size());
}

}  // namespace flaneur
