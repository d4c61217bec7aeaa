// Fonts by number: 0 is the one inside the program; others are looked for where it lacks a letter.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace flaneur {

struct FontFile {
  std::string name;  // for people, such as "Noto Sans CJK JP"
  std::vector<uint8_t> bytes;
  int face = 0;  // in a collection
};

// A font of this machine that has the letter, best in that language; none: nullopt.
using FindFont = std::function<std::optional<FontFile>(char32_t letter, const std::string& language)>;

// One glyph's coverage, 255 where it is full.
struct GlyphPicture {
  int left_px = 0, top_px = 0;  // of its upper left corner from the pen on the baseline, y down
  int width_px = 0, height_px = 0;
  std::vector<uint8_t> cover;
};

// Not for several threads at once.
class Fonts {
 public:
  explicit Fonts(FindFont find = {});
  ~Fonts();
  Fonts(const Fonts&) = delete;
  Fonts& operator=(const Fonts&) = delete;

  // That shows the letter; -1: none does, on this machine.
  int FontFor(char32_t letter, const std::string& language);
  bool Has(int font, char32_t letter) const;
  const std::string& NameOf(int font) const;
  // Above and below the baseline, as shares of the em.
  float Ascent_em(int font) const;
  float Descent_em(int font) const;
  GlyphPicture Draw(int font, uint32_t glyph, float em_px) const;

  // Letters that were asked for and that no font shows, each once; empties the list.
  std::u32string TakeMissing();

  struct Impl;
  Impl& impl() const { return *impl_; }  // internal to runtime/text

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace flaneur
