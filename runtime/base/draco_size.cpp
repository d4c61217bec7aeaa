#include "runtime/base/draco_size.h"

#include <algorithm>
#include <string_view>

namespace flaneur {
namespace {

constexpr size_t kHeader_bytes = 11;
constexpr std::string_view kMagic = "DRACO";

struct Reader {
  std::span<const uint8_t> rest;
  bool good = true;

  uint8_t Byte() {
    if (rest.empty()) return good = false, uint8_t{0};
    const uint8_t byte = rest.front();
    rest = rest.subspan(1);
    return byte;
  }
  uint64_t Word() {
    uint64_t word = 0;
    for (unsigned shift = 0; shift < 32; shift += 8) word |= uint64_t{Byte()} << shift;
    return word;
  }
  // Seven bits a byte, the lowest first, the eighth set in all but the last.
  uint64_t Varint() {
    uint64_t value = 0;
    for (unsigned shift = 0; shift < 35; shift += 7) {
      const uint8_t byte = Byte();
      value |= uint64_t{byte & 0x7Fu} << shift;
      if ((byte & 0x80) == 0) return value;
    }
    good = false;
    return value;
  }
};

}  // namespace

// Bitstream specification 2.2, sections 4.1, 6.1 and 7.1; before 2.0 counts were whole words, before 2.2 the edge
// breaker told the number of its new vertices first.
std::optional<DracoSize> DracoSizeOf(std::span<const uint8_t> bytes) {
  if (bytes.size() < kHeader_bytes || !std::equal(kMagic.begin(), kMagic.end(), bytes.begin())) return {};
  const int version = 10 * bytes[5] + bytes[6], type = bytes[7], method = bytes[8];
  const bool has_metadata = (bytes[10] & 0x80) != 0;
  if (bytes[5] > 2 || bytes[6] > 9 || version > 22 || type != 1 || method > 1 || has_metadata) return {};
  Reader reader{bytes.subspan(kHeader_bytes)};
  const auto count = [&](int first_with_varint) {
    return version < first_with_varint ? reader.Word() : reader.Varint();
  };
  DracoSize size;
  if (method == 0) {
    size.faces = count(22);
    size.vertices = count(22);
  } else {
    reader.Byte();  // how it is traversed
    if (version < 22) count(20);
    size.vertices = count(20);
    size.faces = count(20);
  }
  if (!reader.good) return {};
  return size;
}

}  // namespace flaneur
