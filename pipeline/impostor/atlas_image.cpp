#include "pipeline/impostor/atlas_image.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "runtime/base/math.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;

// One sample in 4096 counts; what rounding leaves in Blender's sums does not.
constexpr float kLeastCoverage = 1e-4f;

// Enough for three mip levels; what lies further out only costs bytes, so that it gets one colour.
constexpr int kFillRings = 8;

enum Layer { kRed, kGreen, kBlue, kNormalX, kNormalY, kNormalZ, kDepth, kCoverage, kLayers };
constexpr std::array<const char*, kLayers> kLayerNames = {
    "albedo.R", "albedo.G", "albedo.B", "normal.R", "normal.G", "normal.B", "depth.", "coverage."};
// Versions of Blender name the parts of a vector and of a single value differently.
constexpr std::array<const char*, kLayers> kOtherNames = {
    "albedo.X", "albedo.Y", "albedo.Z", "normal.X", "normal.Y", "normal.Z", "depth", "coverage"};

uint8_t Quantized(float value) {
  return static_cast<uint8_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255));
}

// IEC 61966-2-1.
float SrgbFromLinear(float value) {
  return value <= 0.0031308f ? 12.92f * value : 1.055f * std::pow(value, 1 / 2.4f) - 0.055f;
}

// Channel names are "ViewLayer.albedo.R".
int FindChannel(const std::vector<std::string>& names, const std::string& wanted) {
  for (size_t i = 0; i < names.size(); ++i) {
    const size_t at = names[i].find(wanted);
    if (at != std::string::npos && (at == 0 || names[i][at - 1] == '.')) return static_cast<int>(i);
  }
  return -1;
}

Error FindChannels(const fs::path& exr, const OIIO::ImageSpec& spec,
                   std::array<int, kLayers>* channels) {
  for (size_t i = 0; i < kLayers; ++i) {
    int found = FindChannel(spec.channelnames, kLayerNames[i]);
    if (found < 0) found = FindChannel(spec.channelnames, kOtherNames[i]);
    if (found < 0) {
      return Fail(exr.string() + ": Blender wrote no layer '" + kLayerNames[i] +
                  "'; use Blender 3.4 to 4.x");
    }
    (*channels)[i] = found;
  }
  return Ok();
}

// layers: the sums of one texel, premultiplied with the coverage.
void PutTexel(const std::array<float, kLayers>& layers, float depth_range_m, uint8_t* albedo,
              uint8_t* normal) {
  const float coverage = layers[kCoverage];
  if (coverage < kLeastCoverage) return;
  for (int c = 0; c < 3; ++c) {
    albedo[c] = Quantized(SrgbFromLinear(layers[static_cast<size_t>(kRed + c)] / coverage));
  }
  albedo[3] = std::max<uint8_t>(1, Quantized(coverage));
  const Vec3 n = Normalized(Vec3{layers[kNormalX], layers[kNormalY], layers[kNormalZ]});
  normal[0] = Quantized(n.x * 0.5f + 0.5f);
  normal[1] = Quantized(n.y * 0.5f + 0.5f);
  normal[2] = Quantized(n.z * 0.5f + 0.5f);
  normal[3] = Quantized(layers[kDepth] / coverage / depth_range_m * 0.5f + 0.5f);
}

// The fill of one cell, from its upper left corner on.
class CellFill {
 public:
  CellFill(int left, int top, int width, int height, AtlasPixels* atlas)
      : left_(left),
        top_(top),
        width_(width),
        height_(height),
        atlas_(atlas),
        known_(static_cast<size_t>(width) * static_cast<size_t>(height), 0) {}

  void Run() {
    FindCovered();
    if (fresh_.empty()) return;
    const Sums whole = SumsOf(fresh_);
    for (int rings = 0; rings < kFillRings; ++rings) {
      const std::vector<int> ring = NextRing();
      for (int at : ring) PutMean(SumsOf(KnownNeighbours(at)), at);
      for (int at : ring) known_[static_cast<size_t>(at)] = 1;
    }
    for (int at = 0; at < width_ * height_; ++at) {
      if (!known_[static_cast<size_t>(at)]) PutMean(whole, at);
    }
  }

 private:
  struct Sums {
    std::array<int, 8> channels{};  // albedo's, then normal's
    int count = 0;
  };

  void FindCovered() {
    for (int at = 0; at < width_ * height_; ++at) {
      if (atlas_->albedo.rgba[Offset(at) + 3] == 0) continue;
      known_[static_cast<size_t>(at)] = 1;
      fresh_.push_back(at);
    }
  }

  size_t Offset(int at) const {
    const int x = left_ + at % width_, y = top_ + at / width_;
    return 4 * (static_cast<size_t>(y) * static_cast<size_t>(atlas_->albedo.width) +
                static_cast<size_t>(x));
  }

  template <typename Visit>
  void ForNeighbours(int at, Visit visit) const {
    const int x = at % width_, y = at / width_;
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height_ - 1); ++v) {
      for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width_ - 1); ++u) {
        visit(v * width_ + u);
      }
    }
  }

  // Unknown texels beside those that became known last.
  std::vector<int> NextRing() {
    std::vector<int> ring;
    for (int at : fresh_) {
      ForNeighbours(at, [&](int other) {
        if (!known_[static_cast<size_t>(other)]) ring.push_back(other);
      });
    }
    std::sort(ring.begin(), ring.end());
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    fresh_ = ring;
    return ring;
  }

  std::vector<int> KnownNeighbours(int at) const {
    std::vector<int> known;
    ForNeighbours(at, [&](int other) {
      if (known_[static_cast<size_t>(other)]) known.push_back(other);
    });
    return known;
  }

  Sums SumsOf(const std::vector<int>& texels) const {
    Sums sums;
    for (int at : texels) {
      for (size_t c = 0; c < 4; ++c) {
        sums.channels[c] += atlas_->albedo.rgba[Offset(at) + c];
        sums.channels[c + 4] += atlas_->normal.rgba[Offset(at) + c];
      }
    }
    sums.count = static_cast<int>(texels.size());
    return sums;
  }

  void PutMean(const Sums& sums, int at) {
    for (size_t c = 0; c < 4; ++c) {
      if (c < 3) atlas_->albedo.rgba[Offset(at) + c] = Mean(sums.channels[c], sums.count);
      atlas_->normal.rgba[Offset(at) + c] = Mean(sums.channels[c + 4], sums.count);
    }
  }

  static uint8_t Mean(int sum, int count) {
    return static_cast<uint8_t>((2 * sum + count) / (2 * count));
  }

  int left_, top_, width_, height_;
  AtlasPixels* atlas_;
  std::vector<uint8_t> known_;
  std::vector<int> fresh_;
};

}  // namespace

Error ReadLayers(const fs::path& exr, int first_row, float depth_range_m, AtlasPixels* atlas) {
  const auto input = OIIO::ImageInput::open(exr.string());
  if (!input) return Fail(exr.string() + ": " + OneLine(OIIO::geterror()));
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.width != atlas->albedo.width || first_row + spec.height > atlas->albedo.height) {
    return Fail(exr.string() + ": Blender rendered " + std::to_string(spec.width) + " x " +
                std::to_string(spec.height) + " pixels, not what it was asked for");
  }
  std::array<int, kLayers> channels{};
  if (Error error = FindChannels(exr, spec, &channels)) return error;
  const auto stride = static_cast<size_t>(spec.nchannels);
  std::vector<float> values(stride * static_cast<size_t>(spec.width) *
                            static_cast<size_t>(spec.height));
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, values.data())) {
    return Fail(exr.string() + ": " + OneLine(input->geterror()));
  }
  const size_t first = static_cast<size_t>(first_row) * static_cast<size_t>(spec.width);
  for (size_t i = 0; i < values.size() / stride; ++i) {
    std::array<float, kLayers> layers{};
    for (size_t c = 0; c < kLayers; ++c) {
      layers[c] = values[i * stride + static_cast<size_t>(channels[c])];
    }
    PutTexel(layers, depth_range_m, &atlas->albedo.rgba[4 * (first + i)],
             &atlas->normal.rgba[4 * (first + i)]);
  }
  return Ok();
}

void FillGutters(int cell_width, int cell_height, AtlasPixels* atlas) {
  for (int top = 0; top < atlas->albedo.height; top += cell_height) {
    for (int left = 0; left < atlas->albedo.width; left += cell_width) {
      CellFill(left, top, cell_width, cell_height, atlas).Run();
    }
  }
}

double FillRate(const Pixels& albedo) {
  size_t covered = 0;
  for (size_t i = 3; i < albedo.rgba.size(); i += 4) covered += albedo.rgba[i] > 0;
  return albedo.rgba.empty()
             ? 0
             : 4 * static_cast<double>(covered) / static_cast<double>(albedo.rgba.size());
}

Error EncodePng(const Pixels& pixels, bool srgb, Image* image) {
  OIIO::ImageSpec spec(pixels.width, pixels.height, 4, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:UnassociatedAlpha", 1);  // else the writer would divide by it
  if (srgb) spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("png:compressionLevel", 6);
  OIIO::Filesystem::IOVecOutput bytes;
  auto output = OIIO::ImageOutput::create("atlas.png", &bytes);
  if (!output) return Fail("OpenImageIO cannot write PNG: " + OneLine(OIIO::geterror()));
  if (!output->open("atlas.png", spec) ||
      !output->write_image(OIIO::TypeDesc::UINT8, pixels.rgba.data()) || !output->close()) {
    return Fail("OpenImageIO cannot write PNG: " + OneLine(output->geterror()));
  }
  image->mime_type = "image/png";
  image->bytes = bytes.buffer();
  return Ok();
}

}  // namespace flaneur
