#include "runtime/visit/menu_rows.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "runtime/visit/page_look.h"
#include "runtime/visit/phrases.h"

namespace flaneur {
namespace {

constexpr float kRadians = kPi / 180;

struct PageView {
  const Simulation& s;
  Menu* menu;
  Controls* controls;
  const std::string language;
  Rows* rows;
  MenuChoice choice;

  const char* Words(Phrase phrase) const { return Say(phrase, language); }
  std::string Pair(const std::string& what, const std::string& value) const {
    return Say(Phrase::kPair, language, {what, value});
  }
};

std::vector<size_t> Halts(const GuidedTour& tour) {
  std::vector<size_t> halts;
  for (size_t k = 0; k < tour.stops.size(); ++k) {
    if (RestOf_s(tour, k) > 0) halts.push_back(k);
  }
  return halts;
}

bool Row(const PageView& v, const std::string& text, const std::string& id) { return v.rows->Button(text, id); }

void Changed(PageView* v) { v->controls->changed = v->controls->applies = true; }

int Amount(const PageView& v, Phrase phrase, const std::string& value) {
  return v.rows->Amount(v.Words(phrase), value);
}

std::string Number(const PageView& v, const char* format, float value) {
  char text[32];
  std::snprintf(text, sizeof text, format, static_cast<double>(value));
  std::string number = text;
  if (const size_t point = number.find('.'); point != std::string::npos)
    number.replace(point, 1, v.Words(Phrase::kDecimalPoint));
  return number;
}

std::string Percent(const PageView& v, float share) {
  return Say(Phrase::kPercent, v.language, {Number(v, "%.0f", 100 * share)});
}

void Step(int steps, float step, float least, float most, float* value, PageView* v) {
  if (steps == 0) return;
  *value = std::clamp((std::round(*value / step) + static_cast<float>(steps)) * step, least, most);
  Changed(v);
}

void Switch(Phrase phrase, const char* id, bool* value, PageView* v) {
  if (!Row(*v, v->Pair(v->Words(phrase), v->Words(*value ? Phrase::kYes : Phrase::kNo)), id)) return;
  *value = !*value;
  Changed(v);
}

struct NamedChoice {
  const char* value;
  Phrase phrase;
};

// On to the next one.
void Cycle(Phrase phrase, const char* id, std::initializer_list<NamedChoice> choices, std::string* value, PageView* v) {
  const auto* now =
      std::find_if(choices.begin(), choices.end(), [&](const NamedChoice& c) { return *value == c.value; });
  if (now == choices.end()) now = choices.begin();
  if (!Row(*v, v->Pair(v->Words(phrase), v->Words(now->phrase)), id)) return;
  *value = now + 1 == choices.end() ? choices.begin()->value : (now + 1)->value;
  Changed(v);
}

void FollowTour(PageView* v) {
  v->controls->follows_tour = true;
  OpenPage(Page::kNone, v->menu);
  if (v->s.visitor.finished) v->choice.stop = 0;
}

// Who reads another language than the one that is on finds the word for it even so.
std::string LanguageRow(const PageView& v) {
  std::string word = v.Words(Phrase::kLanguage);
  const std::string english = Say(Phrase::kLanguage, "en");
  if (word != english) word += " / " + english;
  return v.Pair(word, LanguageName(v.language));
}

void ShowMain(PageView* v) {
  const GuidedTour& tour = v->s.visitor.tour;
  Controls* c = v->controls;
  if (Row(*v, v->Words(v->menu->begins ? Phrase::kBegin : Phrase::kContinue), "continue"))
    OpenPage(Page::kNone, v->menu);
  if (!tour.stops.empty()) {
    const bool led = c->follows_tour && !v->s.visitor.finished;
    if (Row(*v, v->Words(led ? Phrase::kFreeWalk : Phrase::kTour), "tour")) {
      if (!led) FollowTour(v);
      else WalkOnOwn(v->menu, c);
    }
    if (led && !v->menu->begins && Row(*v, v->Words(tour.paused ? Phrase::kLetTourGoOn : Phrase::kHoldTour), "hold")) {
      v->choice.toggles_pause = true;
      OpenPage(Page::kNone, v->menu);
    }
    if (!Halts(tour).empty() && Row(*v, v->Words(Phrase::kStops), "stops")) OpenPage(Page::kStops, v->menu);
  }
  if (Row(*v, v->Words(Phrase::kMap), "map")) OpenPage(Page::kMap, v->menu);
  if (c->has_photos && !v->menu->begins && Row(*v, v->Words(Phrase::kPhoto), "photo")) {
    c->takes_photo = true;
    OpenPage(Page::kNone, v->menu);
  }
  if (OfferedLanguages(*c, v->s).size() > 1 && Row(*v, LanguageRow(*v), "language"))
    OpenPage(Page::kLanguages, v->menu);
  if (Row(*v, v->Words(Phrase::kSettings), "settings")) OpenPage(Page::kSettings, v->menu);
  if (!c->settings.kiosk && Row(*v, v->Words(Phrase::kKeys), "keys")) OpenPage(Page::kKeys, v->menu);
  if (v->menu->can_quit && !c->settings.kiosk && Row(*v, v->Words(Phrase::kEnd), "end")) v->choice.ends = true;
}

void ShowEndOfTour(PageView* v) {
  if (Row(*v, v->Words(Phrase::kAgain), "again")) FollowTour(v);
  if (Row(*v, v->Words(Phrase::kFreeWalk), "explore")) WalkOnOwn(v->menu, v->controls);
  if (Row(*v, v->Words(Phrase::kHome), "home")) v->choice.home = true;
}

void ShowStops(PageView* v) {
  const std::vector<size_t> halts = Halts(v->s.visitor.tour);
  const bool led = v->controls->follows_tour && !v->s.visitor.tour.over;
  for (size_t k = 0; k < halts.size(); ++k) {
    std::string text = std::to_string(k + 1) + "   " + NameOfStop(v->s.visitor.tour, halts[k]);
    if (led && halts[k] == HaltOf(v->s.visitor.tour))
      text += std::string("   (") + v->Words(v->s.visitor.tour.resting ? Phrase::kNow : Phrase::kNext) + ")";
    if (!Row(*v, text, std::to_string(k))) continue;
    v->choice.stop = halts[k];
    v->controls->follows_tour = true;
    OpenPage(Page::kNone, v->menu);
  }
}

void ShowLanguages(PageView* v) {
  for (const std::string& language : OfferedLanguages(*v->controls, v->s)) {
    if (!Row(*v, LanguageName(language), language)) continue;
    v->controls->settings.language = language;
    Changed(v);
    OpenPage(Page::kMain, v->menu);
  }
}

void ShowEyeHeight(PageView* v) {
  constexpr float kSeated_m = 1.2f, kStep_m = 0.05f, kLeast_m = 0.5f, kMost_m = 2.2f;
  float* eye_m = &v->controls->settings.eye_height_m;
  const int steps =
      Amount(*v, Phrase::kEyeHeight, *eye_m > 0 ? Number(*v, "%.2f m", *eye_m) : v->Words(Phrase::kAsTheTour));
  if (steps == 0) return;
  if (*eye_m <= 0) *eye_m = kSeated_m;  // most who ask for it sit
  else if (std::lround(*eye_m / kStep_m) + steps > std::lround(kMost_m / kStep_m)) *eye_m = 0;
  else return Step(steps, kStep_m, kLeast_m, kMost_m, eye_m, v);
  Changed(v);
}

// For everybody; an exhibition's visitors have no others.
void ShowReading(PageView* v) {
  PlayerSettings& s = v->controls->settings;
  Cycle(Phrase::kTextSize, "text size",
        {{"normal", Phrase::kTextNormal}, {"large", Phrase::kTextLarge}, {"largest", Phrase::kTextLargest}},
        &s.text_size, v);
  Switch(Phrase::kHighContrast, "contrast", &s.high_contrast, v);
  Step(Amount(*v, Phrase::kVolume, Percent(*v, s.sound_volume)), 0.1f, 0, 1, &s.sound_volume, v);
}

void ShowComfort(PageView* v) {
  PlayerSettings& s = v->controls->settings;
  Switch(Phrase::kCaptionsAlways, "captions", &s.captions_always, v);
  Step(Amount(*v, Phrase::kPace, Percent(*v, s.pace)), 0.1f, 0.3f, 1.5f, &s.pace, v);
  Switch(Phrase::kReducedMotion, "motion", &s.reduced_motion, v);
  ShowEyeHeight(v);
  const std::string before = s.one_handed;
  Cycle(Phrase::kOneHand, "one hand",
        {{"off", Phrase::kBothHands},
         {"left_keys", Phrase::kLeftKeys},
         {"right_keys", Phrase::kRightKeys},
         {"left_pad", Phrase::kLeftPad},
         {"right_pad", Phrase::kRightPad}},
        &s.one_handed, v);
  if (s.one_handed != before) TakeKeys(v->controls);
  const Phrase how = v->controls->points ? Phrase::kMousePoints : Phrase::kMouseLooks;
  if (!Row(*v, v->Pair(v->Words(Phrase::kMouse), v->Words(how)), "mouse")) return;
  v->controls->points = !v->controls->points;
  s.pointer = v->controls->points ? "point" : "look";
  Changed(v);
}

void ShowHandling(PageView* v) {
  PlayerSettings& s = v->controls->settings;
  Step(Amount(*v, Phrase::kWalkSpeed, Number(*v, "%.1f m/s", s.walk_speed_mps)), 0.1f, 0.3f, 3, &s.walk_speed_mps, v);
  Step(Amount(*v, Phrase::kTurnSpeed, Number(*v, "%.0f°/s", s.turn_speed_dps)), 10, 10, 360, &s.turn_speed_dps, v);
  const std::string snap = s.snap_turn_deg > 0 ? Number(*v, "%.0f°", s.snap_turn_deg) : v->Words(Phrase::kSmoothly);
  Step(Amount(*v, Phrase::kSnapTurn, snap), 15, 0, 90, &s.snap_turn_deg, v);
  Step(Amount(*v, Phrase::kMouseSpeed, Number(*v, "%.1f", s.mouse_speed)), 0.1f, 0.1f, 10, &s.mouse_speed, v);
  Switch(Phrase::kInvertLook, "invert", &s.invert_look, v);
  const float view_deg = v->s.visitor.camera.view.fov_rad / kRadians;
  const int steps = Amount(*v, Phrase::kFieldOfView, Number(*v, "%.0f°", view_deg));
  if (steps != 0) s.field_of_view_deg = view_deg;
  Step(steps, 5, 30, 120, &s.field_of_view_deg, v);
  Step(Amount(*v, Phrase::kFramesPerSecond, Number(*v, "%.0f", s.frames_per_s)), 5, 5, 240, &s.frames_per_s, v);
  Step(Amount(*v, Phrase::kLeastResolution, Percent(*v, s.least_resolution_scale)), 0.05f, 0.25f, 1,
       &s.least_resolution_scale, v);
}

void ShowSettings(PageView* v) {
  ShowReading(v);
  if (v->controls->settings.kiosk) return;
  ShowComfort(v);
  ShowHandling(v);
}

std::string KeysOf(const PageView& v, Action action, bool pad) {
  std::string list;
  for (int code : v.controls->codes[static_cast<size_t>(action)]) {
    if (IsGamepadCode(code) == pad)
      list += (list.empty() ? "" : ", ") + KeyName(InputLabel(code, v.controls->layout), v.language);
  }
  if (!list.empty()) return list;
  return v.Words(pad && action <= Action::kLookDown ? Phrase::kStick : Phrase::kNothing);
}

std::string KeyButton(Action action, bool pad, const PageView& v) {
  const bool waits = v.menu->rebinds == action && v.menu->rebinds_pad == pad;
  return waits ? v.Words(pad ? Phrase::kPressButton : Phrase::kPressKey) : KeysOf(v, action, pad);
}

void ShowKeys(PageView* v) {
  for (size_t k = 0; k < kActions; ++k) {
    const auto action = static_cast<Action>(k);
    if (action == Action::kMenu) continue;
    const int pressed = v->rows->Choice(NameOf(action, v->language),
                                        {KeyButton(action, false, *v), KeyButton(action, true, *v)}, kActionNames[k]);
    if (pressed < 0) continue;
    v->menu->rebinds = action;
    v->menu->rebinds_pad = pressed == 1;
  }
  if (Row(*v, v->Words(Phrase::kDefaults), "defaults")) ResetKeys(v->controls);
}

void ShowRows(PageView* v) {
  switch (v->menu->page) {
    case Page::kNone:
      return;
    case Page::kMain:
      return ShowMain(v);
    case Page::kStops:
      return ShowStops(v);
    case Page::kLanguages:
      return ShowLanguages(v);
    case Page::kSettings:
      return ShowSettings(v);
    case Page::kKeys:
      return ShowKeys(v);
    case Page::kMap:
    case Page::kPhoto:
      return;
    case Page::kEnd:
      return ShowEndOfTour(v);
  }
}

Phrase TitleOf(Page page) {
  return page == Page::kStops       ? Phrase::kStops
         : page == Page::kLanguages ? Phrase::kLanguage
         : page == Page::kSettings  ? Phrase::kSettings
                                    : Phrase::kKeys;
}

}  // namespace

MenuChoice FillRows(const Simulation& s, Menu* menu, Controls* c, Rows* rows) {
  PageView view{s, menu, c, PageLanguage(*c, s), rows, {}};
  ShowRows(&view);
  return view.choice;
}

std::string HeadOf(const Menu& menu, const std::string& title, const std::string& language) {
  if (menu.page == Page::kMain) return title;
  return menu.page == Page::kEnd ? menu.thanks : Say(TitleOf(menu.page), language);
}

std::string BackOf(const Menu& menu, const std::string& language) {
  return menu.page == Page::kMain || menu.page == Page::kEnd ? "" : Say(Phrase::kBackToPages, language);
}

}  // namespace flaneur
