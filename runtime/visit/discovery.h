// What visitors find by themselves: things that tell something, the map, photos, and what the town sounds like.
// Internal to runtime/visit.
#pragma once
#include <string>
#include <vector>

#include "runtime/render/renderer.h"
#include "runtime/visit/hotspot_view.h"
#include "runtime/visit/leading.h"
#include "runtime/visit/map_page.h"
#include "runtime/visit/narration.h"
#include "runtime/visit/notices.h"
#include "runtime/visit/photo_page.h"
#include "runtime/visit/shell.h"
#include "runtime/visit/soundscape.h"

namespace flaneur {

struct Discovery {
  Hotspots hotspots;
  HotspotPicture hotspot_picture;
  MapPage map;
  Soundscape soundscape;
  TakenPhoto photo;
  bool photo_asked = false;  // with the next picture
  Leading leading;           // by the map
};

// What a visit's parts of it work on.
struct DiscoveryIn {
  const TourPack& pack;
  const PlayerSettings& settings;
  Simulation& s;
  Controls& controls;
  Menu& menu;
  Notices& notices;
  CameraInput& wishes;
  const Shell& shell;
  Discovery& d;
};

void PrepareDiscovery(const DiscoveryIn& in);

// Before the hands' wishes for the walk: taps on hotspots are taken out of them. pages: a page is open.
void TakeDiscoveryInput(bool pages, int width_px, int height_px, const DiscoveryIn& in, WindowInput* input);
// After the hands' wishes: map, photo and questions that keys or gamepad asked for.
void TakeDiscoveryWishes(const DiscoveryIn& in);
// Map and photo, and for who has no keys their buttons; between an Overlay's Begin and Draw.
void ShowDiscoveryPages(const PageLook& look, int width_px, int height_px, const DiscoveryIn& in, Overlay* overlay);

// With the picture's frame, before and after it is drawn: the photo that was asked for; hotspots over it.
void TakePhoto(const FrameInput& frame, int width_px, int height_px, const std::string& language, const DiscoveryIn& in,
               Renderer* renderer, Overlay* overlay);
void ShowDiscovery(const FrameInput& frame, const Renderer& renderer, float passed_s, bool pages, const PageLook& look,
                   int width_px, int height_px, const DiscoveryIn& in, Overlay* overlay);

// What somebody hears who looks at a hotspot.
Aside AsideOf(const DiscoveryIn& in);
void HearTown(const FrameInput& frame, float passed_s, bool speaks, bool holds, const DiscoveryIn& in);

// For the next visitor of an exhibition.
void ForgetDiscovery(const DiscoveryIn& in);

// Where photos are kept; empty: nowhere.
std::string PhotoFolder(const PlayerSettings& settings);

}  // namespace flaneur
