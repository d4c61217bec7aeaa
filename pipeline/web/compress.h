// Files as a server sends them. Internal to pipeline/web.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/base/error.h"

namespace flaneur {

using Bytes = std::vector<uint8_t>;

// The same bytes give the same result. Errors: not enough memory.
Error Gzip(std::span<const uint8_t> bytes, Bytes* packed);
Error Brotli(std::span<const uint8_t> bytes, Bytes* packed);

}  // namespace flaneur
