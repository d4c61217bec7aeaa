#include "runtime/pack/meshopt_view.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/pack/gltf_file.h"

namespace flaneur {
namespace {

constexpr uint8_t kHeader = 0xa0;
constexpr size_t kGroup = 16, kMaxStride = 256, kMinTail = 32;
constexpr size_t kMaxBytesAByte = 64;  // a group of 16 bytes takes two bits at least
constexpr char kBroken[] = "has a broken compressed animation";

// Reads forwards, never beyond the end.
struct Reader {
  std::span<const uint8_t> rest;
  std::span<const uint8_t> Take(size_t count) {
    if (count > rest.size()) throw PackRefused(kBroken);
    const auto taken = rest.first(count);
    rest = rest.subspan(count);
    return taken;
  }
};

uint8_t FromZigzag(uint8_t v) { return static_cast<uint8_t>((v & 1) != 0 ? ~(v >> 1) : v >> 1); }

// 16 differences of `bits` each, from the uppermost down; all bits set stand for a whole byte that follows.
void ReadGroup(int bits, Reader* reader, uint8_t* differences) {
  if (bits == 8) {
    std::copy_n(reader->Take(kGroup).begin(), kGroup, differences);
    return;
  }
  const auto per_byte = static_cast<size_t>(8 / bits);
  const int escape = (1 << bits) - 1;
  const auto packed = reader->Take(kGroup / per_byte);
  for (size_t i = 0; i < kGroup; ++i) {
    const int shift = 8 - bits * static_cast<int>(i % per_byte + 1);
    const int value = packed[i / per_byte] >> shift & escape;
    differences[i] = value == escape ? reader->Take(1)[0] : static_cast<uint8_t>(value);
  }
}

// One byte of each of `count` elements, which lie `stride` apart; `last` is the element's before and becomes the last
// one's.
void ReadBytes(size_t count, size_t stride, Reader* reader, uint8_t* last, uint8_t* out) {
  const size_t groups = (count + kGroup - 1) / kGroup;
  const auto headers = reader->Take((groups + 3) / 4);
  for (size_t g = 0; g < groups; ++g) {
    uint8_t differences[kGroup] = {};
    const int mode = headers[g / 4] >> g % 4 * 2 & 3;
    if (mode > 0) ReadGroup(1 << mode, reader, differences);
    for (size_t i = g * kGroup; i < std::min(count, (g + 1) * kGroup); ++i) {
      *last = static_cast<uint8_t>(*last + FromZigzag(differences[i % kGroup]));
      out[i * stride] = *last;
    }
  }
}

void UnfilterRotation(uint8_t* element) {
  int16_t in[4], out[4];
  std::memcpy(in, element, sizeof in);
  const auto one = static_cast<float>(in[3] | 3);
  float rest = 1;
  for (size_t i = 0; i < 3; ++i) {
    const float x = static_cast<float>(in[i]) / one * std::sqrt(0.5f);
    rest -= x * x;
    out[(static_cast<size_t>(in[3] & 3) + 1 + i) % 4] =
        static_cast<int16_t>(std::lround(std::clamp(x, -1.0f, 1.0f) * 32767));
  }
  out[in[3] & 3] = static_cast<int16_t>(std::lround(std::sqrt(std::max(rest, 0.0f)) * 32767));
  std::memcpy(element, out, sizeof out);
}

void UnfilterNumber(uint8_t* element) {
  uint32_t in = 0;
  std::memcpy(&in, element, sizeof in);
  const float whole = static_cast<float>(static_cast<int32_t>(in << 8) >> 8);
  const float number = std::ldexp(whole, static_cast<int8_t>(in >> 24));
  std::memcpy(element, &number, sizeof number);
}

void Unfilter(const std::string& filter, size_t stride, std::vector<uint8_t>* elements) {
  if (filter == "NONE") return;
  const bool rotations = filter == "QUATERNION";
  if (rotations ? stride != 8 : filter != "EXPONENTIAL")
    throw PackRefused("has an animation compressed in an unknown way");
  const size_t step = rotations ? 8 : 4;
  for (size_t at = 0; at < elements->size(); at += step) {
    rotations ? UnfilterRotation(elements->data() + at) : UnfilterNumber(elements->data() + at);
  }
}

}  // namespace

std::vector<uint8_t> DecodeMeshoptView(std::span<const uint8_t> bytes, size_t count, size_t stride,
                                       const std::string& filter) {
  const size_t tail = std::max(stride, kMinTail);
  if (stride == 0 || stride > kMaxStride || stride % 4 != 0 || bytes.size() < 1 + tail || bytes[0] != kHeader ||
      count > kMaxBytesAByte * bytes.size() / stride) {
    throw PackRefused(kBroken);
  }
  std::vector<uint8_t> last(bytes.end() - static_cast<std::ptrdiff_t>(stride), bytes.end());
  std::vector<uint8_t> out(count * stride);
  Reader reader{bytes.subspan(1, bytes.size() - 1 - tail)};
  const size_t block = std::min<size_t>((8192 / stride) & ~(kGroup - 1), 256);
  for (size_t first = 0; first < count; first += block) {
    for (size_t b = 0; b < stride; ++b) {
      ReadBytes(std::min(block, count - first), stride, &reader, &last[b], out.data() + first * stride + b);
    }
  }
  if (!reader.rest.empty()) throw PackRefused(kBroken);
  Unfilter(filter, stride, &out);
  return out;
}

}  // namespace flaneur
