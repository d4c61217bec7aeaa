#include "pipeline/web/compress.h"

#include <brotli/encode.h>
#include <libdeflate.h>

#include <memory>

namespace flaneur {

Error Gzip(std::span<const uint8_t> bytes, Bytes* packed) {
  constexpr int kSmallest = 12;
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(kSmallest), libdeflate_free_compressor);
  if (!compressor) return Fail("there is not enough memory to compress the tour");
  packed->resize(libdeflate_gzip_compress_bound(compressor.get(), bytes.size()));
  const size_t size =
      libdeflate_gzip_compress(compressor.get(), bytes.data(), bytes.size(), packed->data(), packed->size());
  packed->resize(size);
  return size > 0 ? Ok() : Fail("the tour cannot be compressed");
}

Error Brotli(std::span<const uint8_t> bytes, Bytes* packed) {
  size_t size = BrotliEncoderMaxCompressedSize(bytes.size());
  packed->resize(size);
  if (!BrotliEncoderCompress(BROTLI_MAX_QUALITY, BROTLI_DEFAULT_WINDOW, BROTLI_MODE_TEXT, bytes.size(), bytes.data(),
                             &size, packed->data()))
    return Fail("there is not enough memory to compress the page");
  packed->resize(size);
  return Ok();
}

}  // namespace flaneur
