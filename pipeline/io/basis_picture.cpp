#include "pipeline/io/basis_picture.h"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "pipeline/io/etc1s.h"
#include "pipeline/io/uastc.h"
#include "runtime/base/limits.h"

namespace flaneur {
namespace {

using Bytes = std::span<const uint8_t>;

constexpr std::array<uint8_t, 12> kIdentifier{0xAB, 'K', 'T', 'X', ' ', '2', '0', 0xBB, '\r', '\n', 0x1A, '\n'};
constexpr size_t kHeader_bytes = 80, kLevelEntry_bytes = 24;
constexpr uint8_t kEtc1sModel = 163, kUastcModel = 166, kAlphaChannel = 15;
enum Scheme : uint32_t { kPlain = 0, kBasisLz = 1, kZstandard = 2 };

// What the container says of the one picture.
struct Container {
  int width_px = 0, height_px = 0;
  uint32_t scheme = kPlain, levels = 1;
  uint8_t color_model = 0;
  bool has_alpha_slice = false;
  Bytes level, shared;  // the finest level, and what all levels share
};

Error CutShort() { return Fail("is a KTX2 picture that is cut short"); }

uint64_t Number(Bytes bytes, size_t at, size_t size) {
  uint64_t value = 0;
  for (size_t i = size; i-- > 0;) value = value << 8 | bytes[at + i];
  return value;
}

uint32_t Word(Bytes bytes, size_t at) { return static_cast<uint32_t>(Number(bytes, at, 4)); }

bool Part(Bytes bytes, uint64_t offset, uint64_t length, Bytes* part) {
  if (offset > bytes.size() || length > bytes.size() - offset) return false;
  *part = bytes.subspan(static_cast<size_t>(offset), static_cast<size_t>(length));
  return true;
}

Error ReadDescriptor(Bytes bytes, Container* out) {
  constexpr size_t kModelAt = 12, kSamplesAt = 28, kSample_bytes = 16;
  Bytes descriptor;
  if (!Part(bytes, Word(bytes, 48), Word(bytes, 52), &descriptor) || descriptor.size() < kSamplesAt + kSample_bytes)
    return CutShort();
  out->color_model = descriptor[kModelAt];
  out->has_alpha_slice = out->color_model == kEtc1sModel && descriptor.size() >= kSamplesAt + 2 * kSample_bytes &&
                         (descriptor[kSamplesAt + kSample_bytes + 3] & 15) == kAlphaChannel;
  return Ok();
}

Error ReadContainer(Bytes bytes, uint64_t most_pixels, Container* out) {
  if (!IsKtx2(bytes) || bytes.size() < kHeader_bytes + kLevelEntry_bytes) return CutShort();
  const uint64_t width = Word(bytes, 20), height = Word(bytes, 24);
  const uint32_t depth = Word(bytes, 28), layers = Word(bytes, 32), faces = Word(bytes, 36);
  if (depth != 0 || layers > 1 || faces != 1) return Fail("is a KTX2 picture, but no flat one");
  if (width < 1 || height < 1 || width > kMostPictureSide_px || height > kMostPictureSide_px)
    return Fail("is a KTX2 picture of " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
  if (width * height > most_pixels)
    return Fail("asks for " + std::to_string(width * height) + " pixels, far more than its size is worth");
  out->width_px = static_cast<int>(width), out->height_px = static_cast<int>(height);
  out->levels = std::max(1u, Word(bytes, 40));
  out->scheme = Word(bytes, 44);
  if (Error e = ReadDescriptor(bytes, out)) return e;
  const bool all_there =
      Part(bytes, Number(bytes, kHeader_bytes, 8), Number(bytes, kHeader_bytes + 8, 8), &out->level) &&
      Part(bytes, Number(bytes, 64, 8), Number(bytes, 72, 8), &out->shared);
  return all_there ? Ok() : CutShort();
}

int Blocks(int side_px) { return (side_px + 3) / 4; }

Pixels Blank(const Container& in) {
  return {in.width_px, in.height_px,
          std::vector<uint8_t>(4 * static_cast<size_t>(in.width_px) * static_cast<size_t>(in.height_px), 255)};
}

// Each block's texels that lie within the picture.
void Paste(const std::array<uint8_t, 64>& block, int block_x, int block_y, Pixels* pixels) {
  const int columns = std::min(4, pixels->width - 4 * block_x), rows = std::min(4, pixels->height - 4 * block_y);
  for (int row = 0; row < rows; ++row) {
    const auto to = static_cast<std::ptrdiff_t>(4) * ((4 * block_y + row) * pixels->width + 4 * block_x);
    std::copy_n(block.begin() + 16 * row, 4 * columns, pixels->rgba.begin() + to);
  }
}

Error DecodeUastc(const Container& in, Pixels* pixels) {
  const size_t blocks_x = static_cast<size_t>(Blocks(in.width_px)),
               blocks_y = static_cast<size_t>(Blocks(in.height_px));
  const size_t whole = blocks_x * blocks_y * kUastcBlock_bytes;
  std::vector<uint8_t> unpacked;
  Bytes level = in.level;
  if (in.scheme == kZstandard) {
    unpacked.resize(whole);
    const size_t got = ZSTD_decompress(unpacked.data(), whole, in.level.data(), in.level.size());
    if (ZSTD_isError(got) != 0) return Fail("is a KTX2 picture whose Zstandard data is damaged or of another size");
    level = Bytes(unpacked).first(got);
  } else if (in.scheme != kPlain) {
    return Fail("is a KTX2 picture packed by scheme " + std::to_string(in.scheme) + ", which is not read");
  }
  if (level.size() != whole)
    return Fail("is a KTX2 picture of " + std::to_string(level.size()) + " bytes where its size asks for " +
                std::to_string(whole));
  *pixels = Blank(in);
  std::array<uint8_t, 64> texels{};
  for (size_t i = 0; i < blocks_x * blocks_y; ++i) {
    const Bytes block = level.subspan(i * kUastcBlock_bytes, kUastcBlock_bytes);
    if (!DecodeUastcBlock(block.first<kUastcBlock_bytes>(), &texels))
      return Fail("is a KTX2 picture with a block of no known mode");
    Paste(texels, static_cast<int>(i % blocks_x), static_cast<int>(i / blocks_x), pixels);
  }
  return Ok();
}

// Books, tables and where the slices lie, as BasisLZ's global data has them.
struct SharedData {
  Etc1sBooks books;
  Bytes color_slice, alpha_slice;
};

Error ReadShared(const Container& in, SharedData* out) {
  constexpr size_t kCounts_bytes = 20, kImage_bytes = 20;
  const uint64_t images = kImage_bytes * uint64_t{in.levels};
  if (in.shared.size() < kCounts_bytes + images) return CutShort();
  uint64_t at = kCounts_bytes + images;
  std::array<Bytes, 3> books;
  for (size_t i = 0; i < books.size(); ++i) {
    const uint32_t length = Word(in.shared, 4 + 4 * i);
    if (!Part(in.shared, at, length, &books[i])) return CutShort();
    at += length;
  }
  const auto word = [&](size_t i) { return Word(in.shared, kCounts_bytes + 4 * i); };  // of the finest level's image
  if (!Part(in.level, word(1), word(2), &out->color_slice)) return CutShort();
  if (in.has_alpha_slice && !Part(in.level, word(3), word(4), &out->alpha_slice)) return CutShort();
  return ReadEtc1sBooks(static_cast<size_t>(Number(in.shared, 0, 2)), books[0],
                        static_cast<size_t>(Number(in.shared, 2, 2)), books[1], books[2], &out->books);
}

// `rgb` is of whole blocks; alpha is a picture of its own, of which one channel counts.
void CopyChannels(const std::vector<uint8_t>& rgb, bool alpha, Pixels* pixels) {
  const size_t row_bytes = 12 * static_cast<size_t>(Blocks(pixels->width)), width = static_cast<size_t>(pixels->width);
  for (size_t i = 0; i < pixels->rgba.size() / 4; ++i) {
    const uint8_t* from = rgb.data() + i / width * row_bytes + 3 * (i % width);
    if (alpha) pixels->rgba[4 * i + 3] = from[1];
    else std::copy_n(from, 3, &pixels->rgba[4 * i]);
  }
}

Error DecodeEtc1s(const Container& in, Pixels* pixels) {
  SharedData shared;
  Error e = in.scheme == kBasisLz ? ReadShared(in, &shared) : Fail("its ETC1S is not packed by BasisLZ");
  if (e) return Fail("is a KTX2 picture that is damaged: " + e.message);
  *pixels = Blank(in);
  for (const bool alpha : {false, true}) {
    if (alpha && !in.has_alpha_slice) break;
    std::vector<uint8_t> rgb;
    e = DecodeEtc1sSlice(shared.books, alpha ? shared.alpha_slice : shared.color_slice, Blocks(in.width_px),
                         Blocks(in.height_px), &rgb);
    if (e) return Fail("is a KTX2 picture that is damaged: " + e.message);
    CopyChannels(rgb, alpha, pixels);
  }
  return Ok();
}

}  // namespace

bool IsKtx2(Bytes bytes) {
  return bytes.size() >= kIdentifier.size() && std::equal(kIdentifier.begin(), kIdentifier.end(), bytes.begin());
}

Error DecodeBasisPicture(Bytes bytes, uint64_t most_pixels, Pixels* pixels) {
  Container container;
  if (Error e = ReadContainer(bytes, most_pixels, &container)) return e;
  if (container.color_model == kEtc1sModel) return DecodeEtc1s(container, pixels);
  if (container.color_model == kUastcModel) return DecodeUastc(container, pixels);
  return Fail("is a KTX2 picture in another code than ETC1S or UASTC; export it as Basis Universal, PNG or JPEG");
}

}  // namespace flaneur
