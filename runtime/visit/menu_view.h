// The visitor's pages over the picture. Between an Overlay's Begin and Draw.
#pragma once
#include <string>

#include "runtime/render/text_layer.h"
#include "runtime/simulation/simulation.h"
#include "runtime/visit/controls.h"
#include "runtime/visit/menu.h"
#include "runtime/visit/page_look.h"

namespace flaneur {

// The page that is open, or nothing.
MenuChoice ShowMenu(const std::string& title, const Simulation& simulation, int width_px, int height_px, Menu* menu,
                    Controls* controls, TextLayer* text);
// In the picture's corner, for who has no keys. True when it is pressed.
bool ShowMenuButton(const PageLook& look, int width_px);

}  // namespace flaneur
