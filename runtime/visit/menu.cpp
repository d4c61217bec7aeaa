#include "runtime/visit/menu.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "runtime/visit/page_rows.h"
#include "runtime/visit/phrases.h"

namespace flaneur {
namespace {

constexpr float kPageWidth = 24, kKeysWidth = 28;  // in letters
constexpr float kMargin = 0.5f, kPadding = 0.6f, kGap = 0.28f, kSides = 0.8f;
constexpr float kStickPushed = 0.5f;
constexpr float kRadians = kPi / 180;

struct PageView {
  const Simulation& s;
  Menu* menu;
  Controls* controls;
  const std::string language;
  PageRows* rows;
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

void WalkOnOwn(Menu* menu, Controls* c) {
  c->follows_tour = false;
  OpenPage(Page::kNone, menu);
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
  if (!c->settings.kiosk && Row(*v, v->Words(Phrase::kEnd), "end")) v->choice.ends = true;
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

float HeadHeight_px(const std::string& head, float width_px, const PageLook& look, TextLayer* text) {
  return RoomFor(head, width_px, TextOf(look), text).height_px + kGap * look.letter_px;
}

void ShowHead(const std::string& head, float width_px, const PageLook& look, TextLayer* text) {
  const float height_px = RoomFor(head, width_px, TextOf(look), text).height_px;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::Dummy({width_px, height_px});
  DrawText(head, {corner.x, corner.y, width_px, height_px}, TextOf(look), text);
}

constexpr ImGuiWindowFlags kPlain =
    ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings;

// What goes from row to row and chooses one.
OverlayInput HeldIn(const WindowInput& input, const Controls& c) {
  OverlayInput out;
  const auto down = [&](std::initializer_list<const char*> names) {
    return std::any_of(names.begin(), names.end(),
                       [&](const char* name) { return input.down[static_cast<size_t>(InputCode(name))]; });
  };
  // Whoever walks by them, with one hand or two, finds them here too.
  const auto does = [&](Action action) {
    const auto& codes = c.codes[static_cast<size_t>(action)];
    return std::any_of(codes.begin(), codes.end(), [&](int code) { return input.down[static_cast<size_t>(code)]; });
  };
  const Vec2 stick = Length(input.left_stick) > Length(input.right_stick) ? input.left_stick : input.right_stick;
  out.up = down({"up", "pad_up"}) || does(Action::kWalkAhead) || stick.y > kStickPushed;
  out.down = down({"down", "pad_down"}) || does(Action::kWalkBack) || stick.y < -kStickPushed;
  out.left = down({"left", "pad_left"}) || does(Action::kTurnLeft) || stick.x < -kStickPushed;
  out.right = down({"right", "pad_right"}) || does(Action::kTurnRight) || stick.x > kStickPushed;
  out.activate = down({"enter", "keypad_enter", "space", "pad_a"}) || does(Action::kPause);
  return out;
}

}  // namespace

std::vector<std::string> OfferedLanguages(const Controls& c, const Simulation& s) {
  if (!c.offered_languages.empty()) return c.offered_languages;
  std::vector<std::string> all;
  if (!s.visitor.tour.stops.empty()) all = s.visitor.tour.languages;
  for (const std::string& own : PhraseLanguages()) {
    if (std::find(all.begin(), all.end(), own) == all.end()) all.push_back(own);
  }
  return all;
}

bool IsOfTown(Page page) { return page == Page::kMap || page == Page::kPhoto; }

void OpenPage(Page page, Menu* menu) {
  menu->page = page;
  menu->begins = menu->begins && page != Page::kNone;
  menu->first = 0;
  menu->rebinds.reset();
}

void OpenEndOfTour(const std::string& thanks, Menu* menu) {
  OpenPage(Page::kEnd, menu);
  menu->thanks = thanks;
  menu->lets_go = true;
}

bool HoldsTown(const Menu& menu) { return menu.page != Page::kNone && menu.page != Page::kEnd && !menu.begins; }

void MeetSomebodyNew(Menu* menu) {
  OpenPage(Page::kMain, menu);
  menu->begins = true;
}

OverlayInput OverlayInputFrom(const WindowInput& input, const Menu& menu, const Controls& c, int width_px,
                              int height_px, float passed_s) {
  OverlayInput out;
  if (menu.page != Page::kNone && !menu.lets_go) out = HeldIn(input, c);
  out.pointer_px = {input.pointer.x * static_cast<float>(width_px), input.pointer.y * static_cast<float>(height_px)};
  out.pressed = input.pressed;
  out.passed_s = passed_s;
  return out;
}

std::bitset<kInputCodes> FollowHands(const WindowInput& input, const Controls& c, Menu* menu) {
  const std::bitset<kInputCodes> pressed = input.down & ~menu->was_down;
  menu->was_down = input.down;
  const OverlayInput held = HeldIn(input, c);
  const bool moves = held.up || held.down || held.left || held.right || held.activate;
  menu->lets_go = menu->rebinds || (menu->lets_go && (input.down.any() || moves));
  if (pressed.any() || moves) menu->mark.by_keys = true;
  if (input.pressed) menu->mark.by_keys = menu->mark.is_shown = false;
  if (!moves || menu->mark.is_shown || menu->lets_go) return pressed;
  menu->mark.is_asked = menu->lets_go = true;
  return pressed;
}

void TakePageInput(const WindowInput& input, Menu* menu, Controls* c) {
  const std::bitset<kInputCodes> pressed = FollowHands(input, *c, menu);
  if (menu->page == Page::kNone) return;
  const auto is_pressed = [&](Action action) {
    const auto& codes = c->codes[static_cast<size_t>(action)];
    return std::any_of(codes.begin(), codes.end(), [&](int code) { return pressed[static_cast<size_t>(code)]; });
  };
  const bool back = is_pressed(Action::kMenu);
  if (menu->rebinds) {
    if (back) menu->rebinds.reset();
    for (int code = 0; code < kInputCodes && menu->rebinds; ++code) {
      const bool fits = pressed[static_cast<size_t>(code)] && IsGamepadCode(code) == menu->rebinds_pad;
      if (fits && Rebind(*menu->rebinds, code, c)) menu->rebinds.reset();
    }
    return;
  }
  c->quits = c->quits || is_pressed(Action::kQuit);
  if (back || pressed[static_cast<size_t>(InputCode("pad_b"))]) {
    if (menu->page == Page::kEnd) WalkOnOwn(menu, c);
    else OpenPage(menu->page == Page::kMain || IsOfTown(menu->page) ? Page::kNone : Page::kMain, menu);
  } else if (menu->page == Page::kMap && is_pressed(Action::kMap)) {
    OpenPage(Page::kNone, menu);
  }
}

MenuChoice ShowMenu(const std::string& title, const Simulation& s, int width_px, int height_px, Menu* menu, Controls* c,
                    TextLayer* text) {
  if (menu->page == Page::kNone || IsOfTown(menu->page)) return {};
  const Page page = menu->page;
  const PageLook look = LookOf(*c, s, width_px, height_px);
  const ImVec2 picture{static_cast<float>(width_px), static_cast<float>(height_px)};
  const float letter_px = look.letter_px, most_px = picture.x - 2 * (kMargin + kSides) * letter_px;
  const float page_px = std::min((page == Page::kKeys ? kKeysWidth : kPageWidth) * letter_px, most_px);
  PageRows rows(look, page_px, text);
  PageView view{s, menu, c, look.language, &rows, {}};
  const PageStyle style(look, menu->mark);
  ImGui::GetBackgroundDrawList()->AddRectFilled({0, 0}, picture,
                                                IM_COL32(look.veil[0], look.veil[1], look.veil[2], look.veil[3]));
  ImGui::SetNextWindowPos({picture.x / 2, picture.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
  const std::string name = "page " + std::to_string(static_cast<int>(page));
  if (ImGui::Begin(name.c_str(), nullptr, kPlain | ImGuiWindowFlags_AlwaysAutoResize)) {
    ShowKeyMark(&menu->mark);
    const std::string head = page == Page::kMain  ? title
                             : page == Page::kEnd ? menu->thanks
                                                  : std::string(view.Words(TitleOf(page)));
    const std::string back = page == Page::kMain || page == Page::kEnd ? "" : view.Words(Phrase::kBackToPages);
    ShowHead(head, page_px, look, text);
    ShowRows(&view);
    const float rest_px = picture.y - 2 * (kMargin + kPadding) * letter_px - HeadHeight_px(head, page_px, look, text) -
                          (back.empty() ? 0 : rows.ButtonHeight_px(back) + kGap * letter_px);
    if (!rows.Fit(rest_px, menu->first, view.Words(Phrase::kMore))) menu->first = 0;
    ShowRows(&view);
    rows.ShowMore();
    if (rows.more_pressed()) {
      menu->first = rows.end() < rows.count() ? rows.end() : 0;
      menu->mark.is_asked = menu->mark.by_keys;
    }
    if (!back.empty() && rows.ButtonBelow(back, "back")) OpenPage(Page::kMain, menu);
  }
  ImGui::End();
  return view.choice;
}

bool ShowMenuButton(const PageLook& look, int width_px) {
  const float letter_px = look.letter_px, side_px = 2 * letter_px;
  const PageStyle style(look);
  ImGui::SetNextWindowPos({static_cast<float>(width_px) - side_px - letter_px / 2, letter_px / 2});
  ImGui::SetNextWindowSize({side_px, side_px});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  ImGui::Begin("menu button", nullptr, kPlain | ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoNav);
  const ImVec2 low = ImGui::GetCursorScreenPos();
  const bool pressed = ImGui::Button("###menu", {side_px, side_px});
  const PageColor& color = ImGui::IsItemHovered() ? look.marked_text : look.text;
  for (int line = 0; line < 3; ++line) {
    const float y = low.y + side_px * (0.3f + 0.2f * static_cast<float>(line));
    ImGui::GetWindowDrawList()->AddLine({low.x + side_px * 0.25f, y}, {low.x + side_px * 0.75f, y},
                                        IM_COL32(color[0], color[1], color[2], color[3]),
                                        side_px / (look.high_contrast ? 9 : 14));
  }
  ImGui::End();
  ImGui::PopStyleVar();
  return pressed;
}

}  // namespace flaneur
