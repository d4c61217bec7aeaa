// Hotspots over the picture: a discreet mark on each that is seen, and a panel beside the one that tells. Internal to
// runtime/visit; between an Overlay's Begin and Draw.
#pragma once
#include <string>

#include "runtime/pack/tour_pack.h"
#include "runtime/render/overlay.h"
#include "runtime/visit/hotspots.h"
#include "runtime/visit/page_look.h"

namespace flaneur {

// The picture of the hotspot that tells.
struct HotspotPicture {
  int picture = -1;  // of the pack
  OverlayPicture shown = nullptr;
  int width_px = 0, height_px = 0;
};

void ShowHotspotMarks(const Hotspots& hotspots, const PageLook& look, int width_px, int height_px);

// True where it was closed by its button.
bool ShowHotspotPanel(const TourPack& pack, const Hotspots& hotspots, PageLook look, int width_px, int height_px,
                      Overlay* overlay, HotspotPicture* picture);

}  // namespace flaneur
