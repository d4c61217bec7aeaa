#include "pipeline/web/compress.h"

#include <brotli/encode.h>
#include <zlib.h>

namespace flaneur {

Error Gzip(std::span<const uint8_t> bytes, Bytes* packed) {
  constexpr int kGzipWindow = 15 + 16, kMostMemory = 9;
  z_stream stream{};
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, kGzipWindow, kMostMemory, Z_DEFAULT_STRATEGY) != Z_OK)
    return Fail("there is not enough memory to compress the tour");
  packed->resize(deflateBound(&stream, bytes.size()));
  stream.next_in = const_cast<uint8_t*>(bytes.data());
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = packed->data();
  stream.avail_out = static_cast<uInt>(packed->size());
  const int status = deflate(&stream, Z_FINISH);
  packed->resize(stream.total_out);
  deflateEnd(&stream);
  return status == Z_STREAM_END ? Ok() : Fail("the tour cannot be compressed");
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
