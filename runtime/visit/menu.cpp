#include "runtime/visit/menu.h"

#include <algorithm>

#include "runtime/visit/phrases.h"

namespace flaneur {
namespace {

constexpr float kStickPushed = 0.5f;

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

void GoBack(Menu* menu, Controls* c) {
  if (menu->rebinds) menu->rebinds.reset();
  else if (menu->page == Page::kEnd) WalkOnOwn(menu, c);
  else OpenPage(menu->page == Page::kMain || IsOfTown(menu->page) ? Page::kNone : Page::kMain, menu);
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
    if (back) GoBack(menu, c);
    for (int code = 0; code < kInputCodes && menu->rebinds; ++code) {
      const bool fits = pressed[static_cast<size_t>(code)] && IsGamepadCode(code) == menu->rebinds_pad;
      if (fits && Rebind(*menu->rebinds, code, c)) menu->rebinds.reset();
    }
    return;
  }
  c->quits = c->quits || is_pressed(Action::kQuit);
  if (back || pressed[static_cast<size_t>(InputCode("pad_b"))]) {
    GoBack(menu, c);
  } else if (menu->page == Page::kMap && is_pressed(Action::kMap)) {
    OpenPage(Page::kNone, menu);
  }
}

void WalkOnOwn(Menu* menu, Controls* c) {
  c->follows_tour = false;
  OpenPage(Page::kNone, menu);
}

}  // namespace flaneur
