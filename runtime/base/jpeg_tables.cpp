#include "runtime/base/jpeg_tables.h"

#include <cstddef>
#include <numeric>

namespace flaneur {
namespace {

// ITU-T T.81, table B.1.
constexpr uint8_t kMarker = 0xFF, kStuffed = 0x00, kTem = 0x01, kTables = 0xC4, kRestart = 0xD0, kStart = 0xD8,
                  kEnd = 0xD9;

// Of a segment of tables (T.81, B.2.4.2): a byte, how many codes there are of each of 16 lengths, their values.
bool AreSound(std::span<const uint8_t> tables) {
  while (!tables.empty()) {
    if (tables.size() < 17) return false;
    const auto lengths = tables.subspan(1, 16);
    const size_t values = std::accumulate(lengths.begin(), lengths.end(), size_t{0});
    if (values > 256 || tables.size() < 17 + values) return false;
    tables = tables.subspan(17 + values);
  }
  return true;
}

bool StandsAlone(uint8_t marker) {
  return marker == kStuffed || marker == kTem || (marker >= kRestart && marker <= kStart);
}

}  // namespace

bool HasSoundHuffmanTables(std::span<const uint8_t> bytes) {
  if (bytes.empty() || bytes[0] != kMarker) return true;
  size_t at = 0;
  while (true) {
    while (at < bytes.size() && bytes[at] != kMarker) ++at;  // padding, or a scan's data
    while (at < bytes.size() && bytes[at] == kMarker) ++at;
    if (at >= bytes.size()) return true;
    const uint8_t marker = bytes[at++];
    if (marker == kEnd) return true;
    if (StandsAlone(marker)) continue;
    if (at + 2 > bytes.size()) return true;
    const size_t length = static_cast<size_t>(bytes[at] << 8 | bytes[at + 1]);
    if (marker == kTables && (length < 2 || at + length > bytes.size() || !AreSound(bytes.subspan(at + 2, length - 2))))
      return false;
    at += length;
  }
}

}  // namespace flaneur
