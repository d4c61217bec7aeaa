#include "runtime/pack/zstandard.h"

#ifndef __EMSCRIPTEN__
#include <zstd.h>
#endif

namespace flaneur {

#ifdef __EMSCRIPTEN__
std::vector<uint8_t> PackedByZstandard(std::span<const uint8_t>) { return {}; }
bool UnpackZstandard(std::span<const uint8_t>, std::span<uint8_t>) { return false; }
#else
namespace {
constexpr int kEffort = 6;  // of 22
}  // namespace

std::vector<uint8_t> PackedByZstandard(std::span<const uint8_t> bytes) {
  std::vector<uint8_t> packed(ZSTD_compressBound(bytes.size()));
  const size_t size = ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), kEffort);
  if (ZSTD_isError(size) != 0) return {};
  packed.resize(size);
  return packed;
}

bool UnpackZstandard(std::span<const uint8_t> packed, std::span<uint8_t> to) {
  const size_t got = ZSTD_decompress(to.data(), to.size(), packed.data(), packed.size());
  return ZSTD_isError(got) == 0 && got == to.size();
}
#endif

}  // namespace flaneur
