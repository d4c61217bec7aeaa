#include "runtime/text/font.h"

#include <stb/stb_image.h>

// The font file as gzip leaves it, built into the program.
__asm__(
    ".section .rodata\n"
    ".balign 16\n"
    ".global flaneur_font\n"
    "flaneur_font:\n"
    ".incbin \"" FLANEUR_FONT
    "\"\n"
    "flaneur_font_end:\n"
    ".global flaneur_font_end\n"
    ".byte 0\n"
    ".previous\n");
extern "C" const char flaneur_font[], flaneur_font_end[];

namespace flaneur {
namespace {

constexpr int kGzipHead_bytes = 10, kGzipTail_bytes = 8;  // around the deflated data (RFC 1952, no name given)

}  // namespace

std::span<const unsigned char> BuiltInFont() {
  static const std::span<const unsigned char> file = [] {
    const int packed_bytes = static_cast<int>(flaneur_font_end - flaneur_font) - kGzipHead_bytes - kGzipTail_bytes;
    int bytes = 0;
    const char* unpacked = stbi_zlib_decode_noheader_malloc(flaneur_font + kGzipHead_bytes, packed_bytes, &bytes);
    return std::span(reinterpret_cast<const unsigned char*>(unpacked), static_cast<size_t>(bytes));
  }();
  return file;
}

}  // namespace flaneur
