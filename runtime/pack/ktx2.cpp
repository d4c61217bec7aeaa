#include "runtime/pack/ktx2.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "runtime/pack/zstandard.h"

namespace flaneur {
namespace {

constexpr std::array<uint8_t, 12> kIdentifier{0xAB, 'K', 'T', 'X', ' ', '2', '0', 0xBB, '\r', '\n', 0x1A, '\n'};
constexpr size_t kHeaderBytes = 80, kLevelEntryBytes = 24, kMaxLevels = 16;
constexpr uint32_t kMaxSide_px = 16384;
enum : size_t {
  kFormat,
  kTypeSize,
  kWidth,
  kHeight,
  kDepth,
  kLayers,
  kFaces,
  kLevels,
  kScheme
};  // words of the header

class Bytes {
 public:
  template <typename Whole>
  void Put(Whole value) {
    for (size_t i = 0; i < sizeof value; ++i)
      data.push_back(static_cast<uint8_t>(static_cast<uint64_t>(value) >> (8 * i)));
  }
  void Text(std::string_view text) { data.insert(data.end(), text.begin(), text.end()); }
  void Align(size_t to) { data.resize((data.size() + to - 1) / to * to); }

  std::vector<uint8_t> data;
};

// The Khronos data format descriptor: one basic block. Numbers from the Khronos Data Format Specification 1.3.
std::vector<uint8_t> Descriptor(TextureFormat format) {
  constexpr uint8_t kBc4Model = 131, kBc5Model = 132, kBc7Model = 134, kBt709 = 1, kLinear = 1, kSrgb = 2;
  const size_t samples = format == TextureFormat::kBc5 ? 2 : 1;
  const size_t block_bytes = 24 + 16 * samples;
  Bytes out;
  out.Put(static_cast<uint32_t>(4 + block_bytes));
  out.Put(uint32_t{0});  // vendor Khronos, basic descriptor
  out.Put(uint16_t{2});
  out.Put(static_cast<uint16_t>(block_bytes));
  out.Put(format == TextureFormat::kBc4 ? kBc4Model : format == TextureFormat::kBc5 ? kBc5Model : kBc7Model);
  out.Put(kBt709);
  out.Put(format == TextureFormat::kBc7Srgb ? kSrgb : kLinear);
  out.Put(uint8_t{0});        // straight alpha
  out.Put(uint32_t{0x0303});  // blocks of 4 x 4
  out.Put(static_cast<uint64_t>(BlockBytes(format)));
  for (size_t s = 0; s < samples; ++s) {
    out.Put(static_cast<uint16_t>(64 * s));
    out.Put(static_cast<uint8_t>(BlockBytes(format) * 8 / samples - 1));
    out.Put(static_cast<uint8_t>(s));  // red, green; a BC7 block is one channel
    out.Put(uint32_t{0});
    out.Put(uint32_t{0});
    out.Put(uint32_t{0xFFFFFFFF});
  }
  return out.data;
}

std::vector<uint8_t> KeyValues() {
  using namespace std::string_view_literals;
  Bytes out;
  for (std::string_view pair : {"KTXorientation\0rd\0"sv, "KTXwriter\0flaneur\0"sv}) {
    out.Put(static_cast<uint32_t>(pair.size()));
    out.Text(pair);
    out.Align(4);
  }
  return out.data;
}

uint64_t Number(std::span<const uint8_t> bytes, size_t at, size_t size) {
  uint64_t value = 0;
  for (size_t i = 0; i < size; ++i) value |= uint64_t{bytes[at + i]} << (8 * i);
  return value;
}

uint32_t Word(std::span<const uint8_t> bytes, size_t index) {
  return static_cast<uint32_t>(Number(bytes, kIdentifier.size() + 4 * index, 4));
}

size_t BytesOfLevel(std::span<const uint8_t> bytes, TextureFormat format, size_t level) {
  const auto side_px = [&](uint32_t whole_px) { return std::max(1, static_cast<int>(whole_px >> level)); };
  return LevelBytes(format, side_px(Word(bytes, kWidth)), side_px(Word(bytes, kHeight)));
}

}  // namespace

std::vector<uint8_t> WriteKtx2(const PackTexture& texture, Supercompression packed) {
  std::vector<std::vector<uint8_t>> zipped;
  if (packed == Supercompression::kZstandard)
    for (const std::vector<uint8_t>& level : texture.levels) zipped.push_back(PackedByZstandard(level));
  const std::vector<std::vector<uint8_t>>& levels = zipped.empty() ? texture.levels : zipped;
  const std::vector<uint8_t> descriptor = Descriptor(texture.format), pairs = KeyValues();
  const size_t descriptor_at = kHeaderBytes + kLevelEntryBytes * texture.levels.size();
  Bytes out;
  out.data.assign(kIdentifier.begin(), kIdentifier.end());
  out.Put(static_cast<uint32_t>(texture.format));
  out.Put(uint32_t{1});  // of a type: bytes
  out.Put(static_cast<uint32_t>(texture.width_px));
  out.Put(static_cast<uint32_t>(texture.height_px));
  for (uint32_t depth_layers_faces : {0u, 0u, 1u}) out.Put(depth_layers_faces);
  out.Put(static_cast<uint32_t>(texture.levels.size()));
  out.Put(static_cast<uint32_t>(packed));
  out.Put(static_cast<uint32_t>(descriptor_at));
  out.Put(static_cast<uint32_t>(descriptor.size()));
  out.Put(static_cast<uint32_t>(descriptor_at + descriptor.size()));
  out.Put(static_cast<uint32_t>(pairs.size()));
  out.Put(uint64_t{0});
  out.Put(uint64_t{0});
  // The smallest level stands first in the file.
  const size_t alignment = packed == Supercompression::kNone ? 16 : 1;
  const auto aligned = [alignment](size_t at) { return (at + alignment - 1) / alignment * alignment; };
  std::vector<size_t> offsets(levels.size());
  size_t at = descriptor_at + descriptor.size() + pairs.size();
  for (size_t k = levels.size(); k-- > 0; at += levels[k].size()) offsets[k] = at = aligned(at);
  for (size_t k = 0; k < levels.size(); ++k) {
    out.Put(static_cast<uint64_t>(offsets[k]));
    out.Put(static_cast<uint64_t>(levels[k].size()));
    out.Put(static_cast<uint64_t>(texture.levels[k].size()));
  }
  out.data.insert(out.data.end(), descriptor.begin(), descriptor.end());
  out.data.insert(out.data.end(), pairs.begin(), pairs.end());
  for (size_t k = levels.size(); k-- > 0;) {
    out.data.resize(offsets[k]);
    out.data.insert(out.data.end(), levels[k].begin(), levels[k].end());
  }
  return out.data;
}

Error ReadKtx2(std::span<const uint8_t> bytes, PackTexture* texture) {
  return ReadKtx2Beginning(bytes, bytes.size(), texture);
}

uint64_t Ktx2BytesInMemory(std::span<const uint8_t> bytes) {
  if (bytes.size() < kHeaderBytes) return 0;
  const size_t levels = std::min<size_t>(Word(bytes, kLevels), kMaxLevels);
  uint64_t sum = 0;
  if (std::max(Word(bytes, kWidth), Word(bytes, kHeight)) > kMaxSide_px) return 0;  // refused when it is read
  for (size_t k = 0; k < levels; ++k) sum += BytesOfLevel(bytes, static_cast<TextureFormat>(Word(bytes, kFormat)), k);
  return sum;
}

size_t Ktx2BytesOfWidth(std::span<const uint8_t> bytes, size_t whole, int width_px) {
  if (bytes.size() < kHeaderBytes) return whole;
  const size_t levels = std::min<size_t>(Word(bytes, kLevels), kMaxLevels);
  for (size_t k = 0; k < levels && bytes.size() >= kHeaderBytes + kLevelEntryBytes * (k + 1); ++k) {
    if (static_cast<int>(Word(bytes, kWidth)) >> k > width_px) continue;
    const uint64_t offset = Number(bytes, kHeaderBytes + kLevelEntryBytes * k, 8);
    return static_cast<size_t>(
        std::min<uint64_t>(whole, offset + Number(bytes, kHeaderBytes + kLevelEntryBytes * k + 8, 8)));
  }
  return whole;
}

Error ReadKtx2Beginning(std::span<const uint8_t> bytes, size_t whole, PackTexture* texture) {
  if (bytes.size() < kHeaderBytes || !std::equal(kIdentifier.begin(), kIdentifier.end(), bytes.begin())) {
    return Fail("is no KTX2 picture");
  }
  const uint32_t format = Word(bytes, kFormat), width = Word(bytes, kWidth), height = Word(bytes, kHeight);
  if (format != static_cast<uint32_t>(TextureFormat::kBc4) && format != static_cast<uint32_t>(TextureFormat::kBc5) &&
      format != static_cast<uint32_t>(TextureFormat::kBc7) &&
      format != static_cast<uint32_t>(TextureFormat::kBc7Srgb)) {
    return Fail("is a KTX2 picture of format " + std::to_string(format) + ", not BC4, BC5 or BC7");
  }
  if (Word(bytes, kDepth) != 0 || Word(bytes, kLayers) != 0 || Word(bytes, kFaces) != 1) {
    return Fail("is a KTX2 picture that is no plain 2D picture");
  }
  const auto packed = static_cast<Supercompression>(Word(bytes, kScheme));
  if (packed != Supercompression::kNone && packed != Supercompression::kZstandard)
    return Fail("is a KTX2 picture that is packed otherwise than by Zstandard");
  const size_t levels = Word(bytes, kLevels);
  if (width < 1 || height < 1 || width > kMaxSide_px || height > kMaxSide_px || levels < 1 || levels > kMaxLevels) {
    return Fail("is a KTX2 picture of an impossible size");
  }
  if (bytes.size() < kHeaderBytes + kLevelEntryBytes * levels) return Fail("is a truncated KTX2 picture");
  PackTexture out{static_cast<TextureFormat>(format), static_cast<int>(width), static_cast<int>(height), {}};
  for (size_t k = 0; k < levels; ++k) {
    const uint64_t offset = Number(bytes, kHeaderBytes + kLevelEntryBytes * k, 8);
    const uint64_t length = Number(bytes, kHeaderBytes + kLevelEntryBytes * k + 8, 8);
    if (offset > whole || length > whole - offset) return Fail("is a truncated KTX2 picture");
    const uint64_t unpacked = Number(bytes, kHeaderBytes + kLevelEntryBytes * k + 16, 8);
    const bool is_packed = packed == Supercompression::kZstandard;
    if ((is_packed ? unpacked : length) != BytesOfLevel(bytes, out.format, k))
      return Fail("is a KTX2 picture with a level of the wrong length");
    if (offset + length > bytes.size()) continue;  // coarser ones stand before it
    if (out.levels.empty())
      out.width_px = std::max(1, out.width_px >> k), out.height_px = std::max(1, out.height_px >> k);
    const auto level = bytes.subspan(static_cast<size_t>(offset), static_cast<size_t>(length));
    if (!is_packed) {
      out.levels.emplace_back(level.begin(), level.end());
    } else if (!UnpackZstandard(level, out.levels.emplace_back(static_cast<size_t>(unpacked)))) {
      return Fail("is a KTX2 picture whose Zstandard data is damaged");
    }
  }
  if (out.levels.empty()) return Fail("is a KTX2 picture of which nothing has arrived");
  *texture = std::move(out);
  return Ok();
}

}  // namespace flaneur
