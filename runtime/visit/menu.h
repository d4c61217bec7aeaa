// The visitor's pages: go on, tour or free walk, the tour's stops, language, settings, keys. By mouse, touch, keyboard
// and gamepad. Which one is open; menu_rows.h says what stands there, menu_view.h draws it.
#pragma once
#include <bitset>
#include <optional>
#include <string>

#include "runtime/render/overlay.h"
#include "runtime/simulation/simulation.h"
#include "runtime/visit/controls.h"
#include "runtime/visit/page_look.h"
#include "runtime/visit/page_rows.h"

namespace flaneur {

// Map and photo are pages of their own, which FillRows leaves alone.
enum class Page { kNone, kMain, kStops, kLanguages, kSettings, kKeys, kMap, kPhoto, kEnd };

struct Menu {
  Page page = Page::kNone;
  std::string thanks;             // said on the page at the tour's end
  bool can_quit = true;           // there is a program to end, not a web page to leave
  bool begins = false;            // somebody new meets the pages before the town
  size_t first = 0;               // of the rows, where not all fit
  std::optional<Action> rebinds;  // whose new key is waited for
  bool rebinds_pad = false;       // a button, not a key
  bool lets_go = false;           // whatever is held now was meant for that
  std::bitset<kInputCodes> was_down;
  KeyMark mark;
};

struct MenuChoice {
  bool ends = false;
  bool home = false;           // back to the beginning
  std::optional<size_t> stop;  // of the tour, to go to now
  bool toggles_pause = false;  // of the tour
};

// The tour's languages and the player's own, or those that a kiosk offers.
std::vector<std::string> OfferedLanguages(const Controls& controls, const Simulation& simulation);

bool IsOfTown(Page page);  // map and photo
void OpenPage(Page page, Menu* menu);
// Thanks at the tour's end; again, on one's own, or home. Whatever is held just then was not meant for it.
void OpenEndOfTour(const std::string& thanks, Menu* menu);
// The town stands still behind the page; not while nobody is led.
bool HoldsTown(const Menu& menu);
// The first page, as whoever comes to an exhibition meets it.
void MeetSomebodyNew(Menu* menu);

// The hands, for Overlay::Begin.
OverlayInput OverlayInputFrom(const WindowInput& input, const Menu& menu, const Controls& controls, int width_px,
                              int height_px, float passed_s);

// Whether they use keys or a pointer; what was pressed just now. Once a picture, by TakePageInput unless that is left
// out.
std::bitset<kInputCodes> FollowHands(const WindowInput& input, const Controls& controls, Menu* menu);

// To the page before, or out of the pages; from a key that is waited for to none.
void GoBack(Menu* menu, Controls* controls);
// Back to the page before, and the key that is waited for. Once a picture.
void TakePageInput(const WindowInput& input, Menu* menu, Controls* controls);

// The page closes, and the visitor goes where they like.
void WalkOnOwn(Menu* menu, Controls* controls);

}  // namespace flaneur
