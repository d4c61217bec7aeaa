#include "runtime/visit/page_look.h"

#include <algorithm>

namespace flaneur {
namespace {

constexpr float kLettersHigh = 22, kLettersWide = 30;  // how many the picture has room for
constexpr float kLarge = 1.3f, kLargest = 1.65f;       // of a usual letter
constexpr float kLeastEye_m = 0.5f;                    // a child on the ground
constexpr float kOutline = 0.1f;                       // of a letter

float SizeOf(const PlayerSettings& settings) {
  return settings.text_size == "largest" ? kLargest : settings.text_size == "large" ? kLarge : 1;
}

}  // namespace

std::string PageLanguage(const Controls& c, const Simulation& s) {
  return c.settings.language.empty() ? s.visitor.tour.language : c.settings.language;
}

PageLook LookOf(const Controls& c, const Simulation& s, int width_px, int height_px) {
  PageLook look;
  look.language = PageLanguage(c, s);
  look.letter_px = SizeOf(c.settings) *
                   std::min(static_cast<float>(height_px) / kLettersHigh, static_cast<float>(width_px) / kLettersWide);
  if (!c.settings.high_contrast) return look;
  look.high_contrast = true;
  look.outline_px = std::max(2.0f, kOutline * look.letter_px);
  look.panel = look.button = {0, 0, 0, 255};
  look.text = look.outline = {255, 255, 255, 255};
  look.marked = look.pressed = {255, 238, 64, 255};
  look.marked_text = {0, 0, 0, 255};
  look.veil = {0, 0, 0, 170};
  return look;
}

TextLook TextOf(const PageLook& look) {
  TextLook text;
  text.letter_px = look.letter_px;
  text.language = look.language;
  text.color = look.text;
  return text;
}

float EyeHeight_m(const PlayerSettings& settings, float own_m) {
  return settings.eye_height_m > 0 ? std::max(kLeastEye_m, settings.eye_height_m) : own_m;
}

CaptionStyle CaptionStyleOf(const PlayerSettings& settings, const std::string& language) {
  return {language, SizeOf(settings), settings.high_contrast};
}

}  // namespace flaneur
