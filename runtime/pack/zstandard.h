// Zstandard (RFC 8878), as KTX2's levels may be packed with. A page has none: its files are compressed as they are
// sent.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace flaneur {

std::vector<uint8_t> PackedByZstandard(std::span<const uint8_t> bytes);
// Fills `to` to its end. The bytes are not trusted. False: damaged, of another size, or a page.
bool UnpackZstandard(std::span<const uint8_t> packed, std::span<uint8_t> to);

}  // namespace flaneur
