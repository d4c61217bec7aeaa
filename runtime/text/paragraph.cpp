#include "runtime/text/paragraph.h"

#include <fribidi.h>
#include <hb.h>
#include <linebreak.h>

#include <algorithm>
#include <memory>

#include "runtime/text/font_faces.h"
#include "runtime/text/unicode.h"

namespace flaneur {
namespace {

constexpr char32_t kSoftHyphen = 0xAD;
constexpr char32_t kHyphen = U'-';

using HbBuffer = std::unique_ptr<hb_buffer_t, decltype(&hb_buffer_destroy)>;

// The language's own direction where anything of the text runs that way; else the text's first letter decides.
bool RunsRightToLeft(const std::vector<FriBidiCharType>& types, const std::string& language) {
  const auto is_right = [](FriBidiCharType t) { return FRIBIDI_IS_STRONG(t) && FRIBIDI_IS_RTL(t); };
  const auto is_left = [](FriBidiCharType t) { return FRIBIDI_IS_STRONG(t) && !FRIBIDI_IS_RTL(t); };
  const bool any_right = std::any_of(types.begin(), types.end(), is_right);
  const bool any_left = std::any_of(types.begin(), types.end(), is_left);
  if (!any_right) return !any_left && IsRightToLeft(language);
  if (!any_left || language.empty())
    return FRIBIDI_IS_RTL(fribidi_get_par_direction(types.data(), static_cast<FriBidiStrIndex>(types.size())));
  return IsRightToLeft(language);
}

std::vector<FriBidiLevel> LevelsOf(Paragraph* p) {
  const auto size = static_cast<FriBidiStrIndex>(p->text.size());
  const std::vector<FriBidiChar> letters(p->text.begin(), p->text.end());
  std::vector<FriBidiCharType> types(p->text.size());
  std::vector<FriBidiBracketType> brackets(p->text.size());
  std::vector<FriBidiLevel> levels(p->text.size());
  fribidi_get_bidi_types(letters.data(), size, types.data());
  fribidi_get_bracket_types(letters.data(), size, types.data(), brackets.data());
  p->right_to_left = RunsRightToLeft(types, p->language);
  FriBidiParType direction = p->right_to_left ? FRIBIDI_PAR_RTL : FRIBIDI_PAR_LTR;
  if (fribidi_get_par_embedding_levels_ex(types.data(), brackets.data(), size, &direction, levels.data()) == 0)
    std::fill(levels.begin(), levels.end(), static_cast<FriBidiLevel>(p->right_to_left ? 1 : 0));
  return levels;
}

// Signs that many scripts share take that of the letters before them, or at the beginning of those after.
std::vector<hb_script_t> ScriptsOf(const std::u32string& text) {
  std::vector<hb_script_t> scripts;
  hb_script_t last = HB_SCRIPT_COMMON;
  for (const char32_t c : text) {
    const hb_script_t own = hb_unicode_script(hb_unicode_funcs_get_default(), c);
    if (own != HB_SCRIPT_COMMON && own != HB_SCRIPT_INHERITED) {
      if (last == HB_SCRIPT_COMMON) std::fill(scripts.begin(), scripts.end(), own);
      last = own;
    }
    scripts.push_back(last);
  }
  return scripts;
}

bool IsMark(char32_t c) {
  const auto category = hb_unicode_general_category(hb_unicode_funcs_get_default(), c);
  return category == HB_UNICODE_GENERAL_CATEGORY_NON_SPACING_MARK ||
         category == HB_UNICODE_GENERAL_CATEGORY_SPACING_MARK || category == HB_UNICODE_GENERAL_CATEGORY_ENCLOSING_MARK;
}

bool IsShared(char32_t c) {
  const hb_script_t script = hb_unicode_script(hb_unicode_funcs_get_default(), c);
  return script == HB_SCRIPT_COMMON || script == HB_SCRIPT_INHERITED;
}

// Marks, and signs that scripts share, stay in the font of what stands before them where that has them.
std::vector<int> FontsOf(const Paragraph& p) {
  std::vector<int> fonts;
  int last = -1;
  for (const char32_t c : p.text) {
    const bool stays =
        last >= 0 && (IsInvisible(c) || ((IsMark(c) || (last != 0 && IsShared(c))) && p.fonts->Has(last, c)));
    if (!stays) last = IsInvisible(c) ? 0 : std::max(0, p.fonts->FontFor(c, p.language));
    fonts.push_back(last);
  }
  return fonts;
}

void MakeRuns(Paragraph* p) {
  const std::vector<FriBidiLevel> levels = LevelsOf(p);
  const std::vector<hb_script_t> scripts = ScriptsOf(p->text);
  const std::vector<int> fonts = FontsOf(*p);
  for (size_t k = 0; k < p->text.size(); ++k) {
    const TextRun now{k, k + 1, static_cast<uint8_t>(levels[k]), static_cast<uint32_t>(scripts[k]), fonts[k]};
    TextRun* last = p->runs.empty() ? nullptr : &p->runs.back();
    const bool goes_on =
        last != nullptr && last->level == now.level && last->script == now.script && last->font == now.font;
    if (goes_on) last->end = k + 1;
    else p->runs.push_back(now);
  }
}

HbBuffer Shape(const Paragraph& p, const TextRun& run) {
  HbBuffer buffer(hb_buffer_create(), hb_buffer_destroy);
  hb_buffer_add_utf32(buffer.get(), reinterpret_cast<const uint32_t*>(p.text.data()), static_cast<int>(p.text.size()),
                      static_cast<unsigned>(run.first), static_cast<int>(run.end - run.first));
  hb_buffer_set_direction(buffer.get(), run.level % 2 == 1 ? HB_DIRECTION_RTL : HB_DIRECTION_LTR);
  hb_buffer_set_script(buffer.get(), static_cast<hb_script_t>(run.script));
  if (!p.language.empty()) hb_buffer_set_language(buffer.get(), hb_language_from_string(p.language.c_str(), -1));
  hb_shape(p.fonts->impl().faces[static_cast<size_t>(run.font)].shaped, buffer.get(), nullptr, 0);
  return buffer;
}

void Measure(Paragraph* p) {
  p->width_em.assign(p->text.size(), 0);
  p->begins.assign(p->text.size(), 0);
  for (const TextRun& run : p->runs) {
    const float em = p->fonts->impl().faces[static_cast<size_t>(run.font)].units_per_em;
    const HbBuffer buffer = Shape(*p, run);
    unsigned count = 0;
    const hb_glyph_info_t* infos = hb_buffer_get_glyph_infos(buffer.get(), &count);
    const hb_glyph_position_t* places = hb_buffer_get_glyph_positions(buffer.get(), &count);
    for (unsigned k = 0; k < count; ++k) {
      p->begins[infos[k].cluster] = 1;
      p->width_em[infos[k].cluster] += static_cast<float>(places[k].x_advance) / em;
    }
  }
}

void FindBreaks(Paragraph* p) {
  static const bool ready = (init_linebreak(), true);
  static_cast<void>(ready);
  p->break_after.assign(p->text.size(), LINEBREAK_NOBREAK);
  const std::vector<utf32_t> letters(p->text.begin(), p->text.end());
  set_linebreaks_utf32(letters.data(), letters.size(), p->language.c_str(), p->break_after.data());
  for (char& b : p->break_after) b = b == LINEBREAK_ALLOWBREAK || b == LINEBREAK_MUSTBREAK;
}

bool IsSpace(char32_t c) { return c == U' ' || c == 0x3000 || (c >= 0x2000 && c <= 0x200B && c != 0x2007); }

// In scripts that write without spaces any cluster may end a line where nothing better is known.
bool WritesWithoutSpaces(uint32_t script) {
  return script == HB_SCRIPT_THAI || script == HB_SCRIPT_LAO || script == HB_SCRIPT_KHMER ||
         script == HB_SCRIPT_MYANMAR || script == HB_SCRIPT_HAN;
}

const TextRun& RunAt(const Paragraph& p, size_t letter) {
  return *std::find_if(p.runs.begin(), p.runs.end(), [&](const TextRun& r) { return letter < r.end; });
}

LineRange Trimmed(const Paragraph& p, LineRange range) {
  while (range.end > range.first && IsSpace(p.text[range.end - 1])) --range.end;
  return range;
}

// From left to right (rule L2).
void Reorder(std::vector<TextRun>* runs) {
  int highest = 0;
  for (const TextRun& run : *runs) highest = std::max<int>(highest, run.level);
  for (int level = highest; level > 0; --level) {
    for (auto first = runs->begin(); first != runs->end();) {
      const auto end = std::find_if(first, runs->end(), [&](const TextRun& r) { return r.level < level; });
      std::reverse(first, end);
      first = end == runs->end() ? end : end + 1;
    }
  }
}

}  // namespace

Paragraph MakeParagraph(const std::u32string& text, const std::string& language, Fonts* fonts) {
  Paragraph p;
  p.text = text;
  p.language = language;
  p.fonts = fonts;
  p.right_to_left = IsRightToLeft(language);
  if (text.empty()) return p;
  MakeRuns(&p);
  Measure(&p);
  FindBreaks(&p);
  return p;
}

std::vector<LineRange> BreakLines(const Paragraph& p, float width_em) {
  std::vector<LineRange> lines;
  size_t first = 0, best = 0;
  float used_em = 0;
  for (size_t k = 0; k < p.text.size(); ++k) {
    const bool overflows = !IsSpace(p.text[k]) && used_em + p.width_em[k] > width_em;
    if (overflows && k > first) {
      size_t end = best;
      const bool breaks = best <= first;
      if (breaks)
        for (end = k; end > first + 1 && !p.begins[end]; --end) {}
      lines.push_back(Trimmed(p, {first, end, breaks && !WritesWithoutSpaces(RunAt(p, end).script)}));
      first = best = end;
      used_em = 0;
      for (size_t j = first; j < k; ++j) used_em += p.width_em[j];
    }
    used_em += p.width_em[k];
    if (p.break_after[k]) best = k + 1;
  }
  lines.push_back(Trimmed(p, {first, p.text.size(), used_em > width_em && p.text.size() == first + 1}));
  return lines;
}

ShapedLine ShapeLine(const Paragraph& p, const LineRange& range) {
  std::vector<TextRun> runs;
  for (TextRun run : p.runs) {
    run.first = std::max(run.first, range.first);
    run.end = std::min(run.end, range.end);
    if (run.first < run.end) runs.push_back(run);
  }
  Reorder(&runs);
  // A soft hyphen shows at a line's end alone.
  const bool hyphen = range.end > range.first && p.text[range.end - 1] == kSoftHyphen && range.end < p.text.size();
  Paragraph hyphenated;
  if (hyphen) {
    hyphenated = p;
    hyphenated.text[range.end - 1] = kHyphen;
  }
  ShapedLine line;
  for (const TextRun& run : runs) {
    const float em = p.fonts->impl().faces[static_cast<size_t>(run.font)].units_per_em;
    const HbBuffer buffer = Shape(hyphen ? hyphenated : p, run);
    unsigned count = 0;
    const hb_glyph_info_t* infos = hb_buffer_get_glyph_infos(buffer.get(), &count);
    const hb_glyph_position_t* places = hb_buffer_get_glyph_positions(buffer.get(), &count);
    for (unsigned k = 0; k < count; ++k) {
      const Vec2 pen{line.width_em + static_cast<float>(places[k].x_offset) / em,
                     static_cast<float>(places[k].y_offset) / em};
      line.glyphs.push_back({run.font, infos[k].codepoint, pen, infos[k].cluster});
      line.width_em += static_cast<float>(places[k].x_advance) / em;
    }
  }
  return line;
}

}  // namespace flaneur
