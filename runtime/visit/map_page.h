// The visitor's map: streets and stops by name, where one is and looks, and the way there. Internal to runtime/visit;
// between an Overlay's Begin and Draw.
#pragma once
#include <optional>

#include "runtime/pack/tour_pack.h"
#include "runtime/render/overlay.h"
#include "runtime/visit/menu.h"
#include "runtime/visit/page_look.h"
#include "runtime/visit/town_map.h"

namespace flaneur {

struct MapPage {
  float times = 1;  // as large as the whole town
  MapView whole;    // all of the town, in the map's present size
  MapView drawn;    // what the picture shows
  OverlayPicture picture = nullptr;
};

// Where the visitor wants to be led.
struct MapChoice {
  std::optional<size_t> stop;  // of the tour
  std::optional<Vec2> place;
};

MapChoice ShowMapPage(const TourPack& pack, const Simulation& simulation, const PageLook& look, int width_px,
                      int height_px, Menu* menu, Overlay* overlay, MapPage* page);

}  // namespace flaneur
