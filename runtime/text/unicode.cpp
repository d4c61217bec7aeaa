#include "runtime/text/unicode.h"

#include <hb.h>

#include <algorithm>
#include <cstdint>
#include <iterator>

namespace flaneur {
namespace {

constexpr char32_t kBroken = 0xFFFD;

// Takes the bytes that go on a letter; false where they do not.
bool TakeMore(std::string_view text, int more, size_t* at, char32_t* letter) {
  for (int k = 0; k < more; ++k) {
    if (*at >= text.size() || (static_cast<uint8_t>(text[*at]) & 0xC0) != 0x80) return false;
    *letter = *letter << 6 | (static_cast<uint8_t>(text[(*at)++]) & 0x3F);
  }
  constexpr char32_t kLeast[] = {0, 0x80, 0x800, 0x10000};
  return *letter >= kLeast[more] && *letter < 0x110000 && (*letter < 0xD800 || *letter > 0xDFFF);
}

}  // namespace

std::u32string CodePoints(std::string_view text) {
  std::u32string out;
  for (size_t at = 0; at < text.size();) {
    const auto lead = static_cast<uint8_t>(text[at++]);
    const int more = lead >= 0xF0 ? 3 : lead >= 0xE0 ? 2 : lead >= 0xC0 ? 1 : 0;
    char32_t letter = more == 0 ? lead : lead & (0x3FU >> more);
    const bool leads = lead < 0x80 || (lead >= 0xC0 && lead < 0xF8);
    out.push_back(leads && TakeMore(text, more, &at, &letter) ? letter : kBroken);
  }
  return out;
}

std::string Utf8(std::u32string_view text) {
  std::string out;
  for (const char32_t c : text) {
    const int more = c >= 0x10000 ? 3 : c >= 0x800 ? 2 : c >= 0x80 ? 1 : 0;
    constexpr uint32_t kLead[] = {0, 0xC0, 0xE0, 0xF0};
    out.push_back(static_cast<char>(kLead[more] | c >> (6 * more)));
    for (int k = more - 1; k >= 0; --k) out.push_back(static_cast<char>(0x80 | (c >> (6 * k) & 0x3F)));
  }
  return out;
}

bool IsInvisible(char32_t letter) {
  if ((letter >= 0xFE00 && letter <= 0xFE0F) || (letter >= 0xE0100 && letter <= 0xE01EF)) return true;
  switch (hb_unicode_general_category(hb_unicode_funcs_get_default(), letter)) {
    case HB_UNICODE_GENERAL_CATEGORY_CONTROL:
    case HB_UNICODE_GENERAL_CATEGORY_FORMAT:
    case HB_UNICODE_GENERAL_CATEGORY_SPACE_SEPARATOR:
    case HB_UNICODE_GENERAL_CATEGORY_LINE_SEPARATOR:
    case HB_UNICODE_GENERAL_CATEGORY_PARAGRAPH_SEPARATOR:
      return true;
    default:
      return false;
  }
}

bool IsRightToLeft(std::string_view language) {
  constexpr std::string_view kThese[] = {"ar", "arc", "ckb", "dv", "fa", "he", "iw",
                                         "ps", "sd",  "syr", "ug", "ur", "yi"};
  const std::string_view main = language.substr(0, language.find_first_of("-_"));
  return std::find(std::begin(kThese), std::end(kThese), main) != std::end(kThese);
}

}  // namespace flaneur
