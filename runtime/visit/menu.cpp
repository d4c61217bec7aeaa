#include "runtime/visit/menu.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "runtime/visit/phrases.h"

namespace flaneur {
namespace {

constexpr float kLettersHigh = 22, kLettersWide = 30;            // how many the picture has room for
constexpr float kRow = 1.55f, kPageWidth = 24, kKeysWidth = 28;  // in letters
constexpr float kKeyNames = 0.39f, kKeyButton = 0.295f;          // of that
constexpr const char* kCutShort = "…";
constexpr float kStickPushed = 0.5f;
constexpr float kRadians = kPi / 180;

struct PageView {
  const Simulation& s;
  Menu* menu;
  Controls* controls;
  std::string language;
  float letter_px, width_px;
  size_t rows;  // that fit on a page beside its head and foot
  MenuChoice choice;

  const char* Words(Phrase phrase) const { return Say(phrase, language); }
  float row_px() const { return kRow * letter_px; }
};

// As much of the text as has room.
std::string Fitted(const std::string& text, float most_px) {
  std::string fitted = text;
  for (size_t end = text.size(); end > 0 && ImGui::CalcTextSize(fitted.c_str()).x > most_px;
       fitted = text.substr(0, end) + kCutShort) {
    while (--end > 0 && (text[end] & 0xC0) == 0x80) {  // within a letter of several bytes
    }
  }
  return fitted;
}

std::vector<size_t> Halts(const GuidedTour& tour) {
  std::vector<size_t> halts;
  for (size_t k = 0; k < tour.stops.size(); ++k) {
    if (RestOf_s(tour, k) > 0) halts.push_back(k);
  }
  return halts;
}

// The tour's languages and the player's own, or those that a kiosk offers.
std::vector<std::string> Languages(const Controls& c, const Simulation& s) {
  if (!c.offered_languages.empty()) return c.offered_languages;
  std::vector<std::string> all;
  if (!s.visitor.tour.stops.empty()) all = s.visitor.tour.languages;
  for (const std::string& own : PhraseLanguages()) {
    if (std::find(all.begin(), all.end(), own) == all.end()) all.push_back(own);
  }
  return all;
}

// `###` keeps a button the same whatever is written on it.
bool Button(const PageView& v, const std::string& text, const std::string& id, float width_px) {
  const std::string fitted = Fitted(text, width_px - 2 * ImGui::GetStyle().FramePadding.x);
  return ImGui::Button((fitted + "###" + id).c_str(), {width_px, v.row_px()});
}

bool Row(const PageView& v, const std::string& text, const std::string& id) { return Button(v, text, id, v.width_px); }

void Changed(PageView* v) { v->controls->changed = v->controls->applies = true; }

// Less and more; by how many steps it shall change.
int Amount(const PageView& v, const char* text, const std::string& value) {
  const float button_px = 1.3f * v.row_px(), value_px = 6.2f * v.letter_px;
  ImGui::PushID(text);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(Fitted(text, v.width_px - 2 * button_px - value_px - 0.4f * v.letter_px).c_str());
  ImGui::SameLine(v.width_px - 2 * button_px - value_px);
  ImGui::PushButtonRepeat(true);
  ImGui::PushStyleVar(ImGuiStyleVar_ButtonTextAlign, {0.5f, 0.5f});
  const bool less = ImGui::Button("-", {button_px, v.row_px()});
  const float text_px = ImGui::CalcTextSize(value.c_str()).x;
  ImGui::SameLine(v.width_px - button_px - value_px / 2 - text_px / 2);
  ImGui::TextUnformatted(value.c_str());
  ImGui::SameLine(v.width_px - button_px);
  const bool more = ImGui::Button("+", {button_px, v.row_px()});
  ImGui::PopStyleVar();
  ImGui::PopButtonRepeat();
  ImGui::PopID();
  return static_cast<int>(more) - static_cast<int>(less);
}

std::string Number(const PageView& v, const char* format, float value) {
  char text[32];
  std::snprintf(text, sizeof text, format, static_cast<double>(value));
  std::string number = text;
  if (const size_t point = number.find('.'); point != std::string::npos)
    number.replace(point, 1, v.Words(Phrase::kDecimalPoint));
  return number;
}

void Step(int steps, float step, float least, float most, float* value, PageView* v) {
  if (steps == 0) return;
  *value = std::clamp((std::round(*value / step) + static_cast<float>(steps)) * step, least, most);
  Changed(v);
}

void Switch(const char* text, bool* value, PageView* v) {
  if (!Row(*v, std::string(text) + ": " + v->Words(*value ? Phrase::kYes : Phrase::kNo), text)) return;
  *value = !*value;
  Changed(v);
}

// The rows that fit, and a button for more where there are more.
template <typename ShowRow>
void PagedRows(size_t count, PageView* v, ShowRow show) {
  const bool all_fit = count <= v->rows;
  const size_t shown = all_fit ? count : v->rows - 1;
  if (v->menu->first >= count) v->menu->first = 0;
  for (size_t k = v->menu->first; k < std::min(count, v->menu->first + shown); ++k) show(k);
  if (!all_fit && Row(*v, v->Words(Phrase::kMore), "more")) v->menu->first += shown;
}

void FollowTour(PageView* v) {
  v->controls->follows_tour = true;
  OpenPage(Page::kNone, v->menu);
  if (v->s.visitor.finished) v->choice.stop = 0;
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
      else c->follows_tour = false, OpenPage(Page::kNone, v->menu);
    }
    if (!Halts(tour).empty() && Row(*v, v->Words(Phrase::kStops), "stops")) OpenPage(Page::kStops, v->menu);
  }
  const std::vector<std::string> languages = Languages(*c, v->s);
  if (languages.size() > 1 &&
      Row(*v, std::string(v->Words(Phrase::kLanguage)) + ": " + LanguageName(v->language), "language")) {
    const auto now = std::find(languages.begin(), languages.end(), v->language) - languages.begin();
    c->settings.language = languages[static_cast<size_t>(now + 1) % languages.size()];
    Changed(v);
  }
  if (Row(*v, v->Words(Phrase::kSettings), "settings")) OpenPage(Page::kSettings, v->menu);
  if (!c->settings.kiosk && Row(*v, v->Words(Phrase::kKeys), "keys")) OpenPage(Page::kKeys, v->menu);
  if (!c->settings.kiosk && Row(*v, v->Words(Phrase::kEnd), "end")) v->choice.ends = true;
}

void ShowStops(PageView* v) {
  const std::vector<size_t> halts = Halts(v->s.visitor.tour);
  const bool led = v->controls->follows_tour && !v->s.visitor.tour.over;
  PagedRows(halts.size(), v, [&](size_t k) {
    std::string text = std::to_string(k + 1) + "   " + NameOfStop(v->s.visitor.tour, halts[k]);
    if (led && halts[k] == HaltOf(v->s.visitor.tour))
      text += std::string("   (") + v->Words(v->s.visitor.tour.resting ? Phrase::kNow : Phrase::kNext) + ")";
    if (!Row(*v, text, std::to_string(k))) return;
    v->choice.stop = halts[k];
    v->controls->follows_tour = true;
    OpenPage(Page::kNone, v->menu);
  });
}

constexpr size_t kVolumeRow = 5, kSettingRows = 11;

// What visitors of a kiosk can change besides the language.
std::vector<size_t> SettingRows(bool kiosk) {
  if (kiosk) return {kVolumeRow};
  std::vector<size_t> all(kSettingRows);
  std::iota(all.begin(), all.end(), size_t{0});
  return all;
}

void ShowSetting(size_t row, PageView* v) {
  PlayerSettings& s = v->controls->settings;
  const float view_deg = v->s.visitor.camera.view.fov_rad / kRadians;
  switch (row) {
    case 0:
      return Step(Amount(*v, v->Words(Phrase::kWalkSpeed), Number(*v, "%.1f m/s", s.walk_speed_mps)), 0.1f, 0.3f, 3,
                  &s.walk_speed_mps, v);
    case 1:
      return Step(Amount(*v, v->Words(Phrase::kTurnSpeed), Number(*v, "%.0f°/s", s.turn_speed_dps)), 10, 10, 360,
                  &s.turn_speed_dps, v);
    case 2: {
      const std::string value =
          s.snap_turn_deg > 0 ? Number(*v, "%.0f°", s.snap_turn_deg) : v->Words(Phrase::kSmoothly);
      return Step(Amount(*v, v->Words(Phrase::kSnapTurn), value), 15, 0, 90, &s.snap_turn_deg, v);
    }
    case 3:
      return Step(Amount(*v, v->Words(Phrase::kMouseSpeed), Number(*v, "%.1f", s.mouse_speed)), 0.1f, 0.1f, 10,
                  &s.mouse_speed, v);
    case 4: {
      const int steps = Amount(*v, v->Words(Phrase::kFieldOfView), Number(*v, "%.0f°", view_deg));
      if (steps != 0) s.field_of_view_deg = view_deg;
      return Step(steps, 5, 30, 120, &s.field_of_view_deg, v);
    }
    case kVolumeRow:
      return Step(Amount(*v, v->Words(Phrase::kVolume), Number(*v, "%.0f %%", 100 * s.sound_volume)), 0.1f, 0, 1,
                  &s.sound_volume, v);
    case 6:
      return Switch(v->Words(Phrase::kReducedMotion), &s.reduced_motion, v);
    case 7:
      return Switch(v->Words(Phrase::kInvertLook), &s.invert_look, v);
    case 8:
      return Step(Amount(*v, v->Words(Phrase::kFramesPerSecond), Number(*v, "%.0f", s.frames_per_s)), 5, 5, 240,
                  &s.frames_per_s, v);
    case 9: {
      const std::string value = Number(*v, "%.0f %%", 100 * s.least_resolution_scale);
      return Step(Amount(*v, v->Words(Phrase::kLeastResolution), value), 0.05f, 0.25f, 1, &s.least_resolution_scale, v);
    }
    default:
      break;
  }
  const std::string how = v->Words(v->controls->points ? Phrase::kMousePoints : Phrase::kMouseLooks);
  if (!Row(*v, std::string(v->Words(Phrase::kMouse)) + ": " + how, "mouse")) return;
  v->controls->points = !v->controls->points;
  s.pointer = v->controls->points ? "point" : "look";
  Changed(v);
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

void KeyButton(Action action, bool pad, PageView* v) {
  Menu* menu = v->menu;
  const bool waits = menu->rebinds == action && menu->rebinds_pad == pad;
  const std::string text = waits ? v->Words(pad ? Phrase::kPressButton : Phrase::kPressKey) : KeysOf(*v, action, pad);
  const std::string id = std::string(kActionNames[static_cast<size_t>(action)]) + (pad ? "pad" : "key");
  if (!Button(*v, text, id, kKeyButton * v->width_px)) return;
  menu->rebinds = action;
  menu->rebinds_pad = pad;
}

void ShowKeys(PageView* v) {
  std::vector<Action> actions;
  for (size_t k = 0; k < kActions; ++k) {
    const auto action = static_cast<Action>(k);
    if (action != Action::kMenu) actions.push_back(action);
  }
  PagedRows(actions.size() + 1, v, [&](size_t k) {
    if (k == actions.size()) {
      if (Row(*v, v->Words(Phrase::kDefaults), "defaults")) ResetKeys(v->controls);
      return;
    }
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(Fitted(NameOf(actions[k], v->language), (kKeyNames - 0.01f) * v->width_px).c_str());
    for (const bool pad : {false, true}) {
      ImGui::SameLine(ImGui::GetStyle().WindowPadding.x + v->width_px * (pad ? 1 - kKeyButton : kKeyNames));
      KeyButton(actions[k], pad, v);
    }
  });
}

void ShowRows(PageView* v) {
  switch (v->menu->page) {
    case Page::kNone:
      return;
    case Page::kMain:
      return ShowMain(v);
    case Page::kStops:
      return ShowStops(v);
    case Page::kSettings: {
      const std::vector<size_t> rows = SettingRows(v->controls->settings.kiosk);
      return PagedRows(rows.size(), v, [&](size_t k) { ShowSetting(rows[k], v); });
    }
    case Page::kKeys:
      return ShowKeys(v);
  }
}

Phrase TitleOf(Page page) {
  return page == Page::kStops ? Phrase::kStops : page == Page::kSettings ? Phrase::kSettings : Phrase::kKeys;
}

// Dark, warm and large, with the button that is meant clearly brighter.
struct PageStyle {
  explicit PageStyle(float letter_px) {
    const auto color = [](ImGuiCol which, float r, float g, float b, float a) {
      ImGui::PushStyleColor(which, {r, g, b, a});
    };
    color(ImGuiCol_WindowBg, 0.07f, 0.06f, 0.05f, 0.86f);
    color(ImGuiCol_Border, 0, 0, 0, 0);
    color(ImGuiCol_Text, 0.97f, 0.95f, 0.90f, 1);
    color(ImGuiCol_Button, 0.24f, 0.20f, 0.16f, 0.9f);
    color(ImGuiCol_ButtonHovered, 0.66f, 0.42f, 0.14f, 1);
    color(ImGuiCol_ButtonActive, 0.80f, 0.54f, 0.20f, 1);
    color(ImGuiCol_NavHighlight, 0.98f, 0.80f, 0.42f, 1);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.8f * letter_px, 0.6f * letter_px});
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0.6f * letter_px, 0.25f * letter_px});
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0.4f * letter_px, 0.28f * letter_px});
    ImGui::PushStyleVar(ImGuiStyleVar_FrameRounding, 0.25f * letter_px);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.5f * letter_px);
    ImGui::PushStyleVar(ImGuiStyleVar_ButtonTextAlign, {0, 0.5f});
  }
  ~PageStyle() {
    ImGui::PopStyleVar(6);
    ImGui::PopStyleColor(7);
  }
  PageStyle(const PageStyle&) = delete;
  PageStyle& operator=(const PageStyle&) = delete;
};

constexpr ImGuiWindowFlags kPlain =
    ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings;

size_t RowsThatFit(int height_px, float letter_px) {
  const float row_px = (kRow + 0.28f) * letter_px, rest_px = static_cast<float>(height_px) - 6.5f * letter_px;
  return static_cast<size_t>(std::max(3.0f, std::floor(rest_px / row_px)));
}

}  // namespace

void OpenPage(Page page, Menu* menu) {
  menu->page = page;
  menu->begins = menu->begins && page != Page::kNone;
  menu->first = 0;
  menu->rebinds.reset();
}

void MeetSomebodyNew(Menu* menu) {
  OpenPage(Page::kMain, menu);
  menu->begins = true;
}

std::string PageLanguage(const Controls& c, const Simulation& s) {
  return c.settings.language.empty() ? s.visitor.tour.language : c.settings.language;
}

float PageLetter_px(int width_px, int height_px) {
  return std::min(static_cast<float>(height_px) / kLettersHigh, static_cast<float>(width_px) / kLettersWide);
}

std::string PageTexts(const Controls& c, const Simulation& s) {
  std::string all = std::string("–°←→↑↓") + kCutShort;
  for (const std::string& language : Languages(c, s)) all += LanguageName(language);
  for (size_t k = 0; k < s.visitor.tour.words.size(); ++k) all += NameOfStop(s.visitor.tour, k);
  for (const auto& codes : c.codes) {
    for (int code : codes) all += InputLabel(code, c.layout);
  }
  return all;
}

OverlayInput OverlayInputFrom(const WindowInput& input, const Menu& menu, int width_px, int height_px, float passed_s) {
  OverlayInput out;
  out.pointer_px = {input.pointer.x * static_cast<float>(width_px), input.pointer.y * static_cast<float>(height_px)};
  out.pressed = input.pressed;
  out.passed_s = passed_s;
  if (menu.page == Page::kNone || menu.lets_go) return out;
  const auto down = [&](std::initializer_list<const char*> names) {
    return std::any_of(names.begin(), names.end(),
                       [&](const char* name) { return input.down[static_cast<size_t>(InputCode(name))]; });
  };
  out.up = down({"up", "pad_up"}) || input.left_stick.y > kStickPushed;
  out.down = down({"down", "pad_down"}) || input.left_stick.y < -kStickPushed;
  out.left = down({"left", "pad_left"}) || input.left_stick.x < -kStickPushed;
  out.right = down({"right", "pad_right"}) || input.left_stick.x > kStickPushed;
  out.activate = down({"enter", "keypad_enter", "space", "pad_a"});
  return out;
}

void TakePageInput(const WindowInput& input, Menu* menu, Controls* c) {
  const std::bitset<kInputCodes> pressed = input.down & ~menu->was_down;
  menu->was_down = input.down;
  menu->lets_go = menu->rebinds || (menu->lets_go && input.down.any());
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
  if (back || pressed[static_cast<size_t>(InputCode("pad_b"))])
    OpenPage(menu->page == Page::kMain ? Page::kNone : Page::kMain, menu);
}

MenuChoice ShowMenu(const std::string& title, const Simulation& s, int width_px, int height_px, Menu* menu,
                    Controls* c) {
  if (menu->page == Page::kNone) return {};
  const Page page = menu->page;
  const ImVec2 picture{static_cast<float>(width_px), static_cast<float>(height_px)};
  const float letter_px = PageLetter_px(width_px, height_px);
  PageView view{s,
                menu,
                c,
                PageLanguage(*c, s),
                letter_px,
                std::min((page == Page::kKeys ? kKeysWidth : kPageWidth) * letter_px, picture.x - 2 * letter_px),
                RowsThatFit(height_px, letter_px),
                {}};
  const LargeText large;
  const PageStyle style(letter_px);
  ImGui::GetBackgroundDrawList()->AddRectFilled({0, 0}, picture, IM_COL32(0, 0, 0, 110));
  ImGui::SetNextWindowPos({picture.x / 2, picture.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
  const std::string name = "page " + std::to_string(static_cast<int>(page));
  if (ImGui::Begin(name.c_str(), nullptr, kPlain | ImGuiWindowFlags_AlwaysAutoResize)) {
    if (ImGui::IsWindowAppearing()) ImGui::SetWindowFocus();
    ImGui::TextUnformatted(Fitted(page == Page::kMain ? title : view.Words(TitleOf(page)), view.width_px).c_str());
    ImGui::PushTextWrapPos(0);
    ShowRows(&view);
    ImGui::PopTextWrapPos();
    if (page != Page::kMain && Row(view, view.Words(Phrase::kBackToPages), "back")) OpenPage(Page::kMain, menu);
  }
  ImGui::End();
  return view.choice;
}

bool ShowMenuButton(int width_px, int height_px) {
  const float letter_px = PageLetter_px(width_px, height_px), side_px = 2 * letter_px;
  const PageStyle style(letter_px);
  ImGui::SetNextWindowPos({static_cast<float>(width_px) - side_px - letter_px / 2, letter_px / 2});
  ImGui::SetNextWindowSize({side_px, side_px});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  ImGui::Begin("menu button", nullptr, kPlain | ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoNav);
  const ImVec2 low = ImGui::GetCursorScreenPos();
  const bool pressed = ImGui::Button("###menu", {side_px, side_px});
  for (int line = 0; line < 3; ++line) {
    const float y = low.y + side_px * (0.3f + 0.2f * static_cast<float>(line));
    ImGui::GetWindowDrawList()->AddLine({low.x + side_px * 0.25f, y}, {low.x + side_px * 0.75f, y},
                                        IM_COL32(247, 242, 230, 255), side_px / 14);
  }
  ImGui::End();
  ImGui::PopStyleVar();
  return pressed;
}

}  // namespace flaneur
