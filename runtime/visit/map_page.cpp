#include "runtime/visit/map_page.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "runtime/base/array.h"
#include "runtime/visit/page_rows.h"
#include "runtime/visit/phrases.h"

namespace flaneur {
namespace {

constexpr float kEdge = 0.5f, kListWide = 14, kListShare = 0.46f;  // in letters; of the picture's width, at most
constexpr float kLeastListWide = 11.5f, kMostListShare = 0.62f;    // likewise, where letters are large
constexpr float kPortraitMap = 0.52f;                              // of the height
constexpr float kPin = 0.62f, kPinReach = 1.3f, kSelf = 0.7f;      // radius in letters; touched so far off
constexpr float kStreetLetter = 0.62f;                             // of a letter
constexpr float kMostMapLetter = 0.042f;                           // of the map's shorter side
constexpr size_t kMostHintLines = 2;                               // longer, it would leave the names no room
constexpr float kMostHint = 0.15f;  // of the list: else it takes the place of the first stop
constexpr float kMostTimes = 16, kLabelMargin_px = 3;
constexpr ImU32 kPinColor = IM_COL32(140, 36, 28, 255), kSelfColor = IM_COL32(24, 92, 168, 255);
constexpr ImU32 kWhite = IM_COL32(255, 255, 255, 255);
constexpr PageColor kInk{70, 52, 36, 255};
constexpr ImGuiWindowFlags kPlain =
    ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings;

struct Box {
  float left = 0, top = 0, right = 0, bottom = 0;
};
bool Overlap(const Box& a, const Box& b) {
  return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

// Where the map and the list are on the page.
struct Places {
  Box map, list;
};

Places PlacesFor(const PageLook& look, float width_px, float height_px) {
  const float edge = kEdge * look.letter_px;
  if (height_px > width_px) {
    const float split = kPortraitMap * height_px;
    return {{edge, edge, width_px - edge, split}, {edge, split + edge, width_px - edge, height_px - edge}};
  }
  const float most_px =
      std::max(kListShare * width_px, std::min(kLeastListWide * look.letter_px, kMostListShare * width_px));
  const float split = width_px - std::min(kListWide * look.letter_px, most_px);
  return {{edge, edge, split, height_px - edge}, {split + edge, edge, width_px - edge, height_px - edge}};
}

struct Drawing {
  const TourPack& pack;
  const Simulation& s;
  const PageLook& look;
  const MapView& view;
  ImVec2 corner;
  ImDrawList* list;
  TextLayer* text;
  std::vector<Box> taken;  // by pins and names

  ImVec2 On(Vec2 p) const {
    const Vec2 px = OnMap(view, p);
    return {corner.x + px.x, corner.y + px.y};
  }
  bool IsOnMap(ImVec2 p) const {
    return p.x >= corner.x && p.y >= corner.y && p.x < corner.x + static_cast<float>(view.width_px) &&
           p.y < corner.y + static_cast<float>(view.height_px);
  }
};

void ShowPins(const std::vector<MapStop>& stops, Drawing* d) {
  const float radius_px = kPin * d->look.letter_px;
  for (const MapStop& stop : stops) {
    const ImVec2 at = d->On(d->s.visitor.tour.stops[stop.stop].position_m);
    if (!d->IsOnMap(at)) continue;
    d->list->AddCircleFilled(at, radius_px * 1.15f, kWhite, 32);
    d->list->AddCircleFilled(at, radius_px, kPinColor, 32);
    TextLook number = TextOf(d->look);
    number.letter_px = radius_px * 1.3f;
    number.align = Align::kCenter;
    number.color = {255, 255, 255, 255};
    DrawText(std::to_string(stop.number), {at.x - radius_px, at.y - radius_px, 2 * radius_px, 2 * radius_px}, number,
             d->text);
    d->taken.push_back({at.x - radius_px, at.y - radius_px, at.x + radius_px, at.y + radius_px});
  }
}

// A place for a name, along which it is written from left to right.
struct NamePlace {
  Vec2 middle, along{1, 0};
};

// Along its longest straight parts, the middle of each first.
std::vector<NamePlace> PlacesForName(const Street& street) {
  std::vector<std::pair<float, size_t>> parts;
  for (size_t k = 0; k + 1 < street.points.size(); ++k)
    parts.emplace_back(-Length(street.points[k + 1] - street.points[k]), k);
  std::sort(parts.begin(), parts.end());
  std::vector<NamePlace> places;
  for (const auto& [minus_length_m, k] : parts) {
    const Vec2 from = street.points[k], way = street.points[k + 1] - from;
    if (minus_length_m >= 0) continue;
    for (const float share : {0.5f, 0.35f, 0.65f, 0.2f, 0.8f})
      places.push_back({from + way * share, way * ((way.x < 0 ? 1 : -1) / minus_length_m)});
  }
  return places;
}

bool ShowNameAt(const std::string& name, const NamePlace& place, const TextLook& words, const TextRoom& room,
                Drawing* d) {
  const ImVec2 at = d->On(place.middle);
  const Vec2 along = place.along;
  const float half_wide = std::abs(along.x) * room.width_px / 2 + std::abs(along.y) * room.height_px / 2;
  const float half_high = std::abs(along.y) * room.width_px / 2 + std::abs(along.x) * room.height_px / 2;
  const Box box{at.x - half_wide - kLabelMargin_px, at.y - half_high - kLabelMargin_px,
                at.x + half_wide + kLabelMargin_px, at.y + half_high + kLabelMargin_px};
  const bool free = std::none_of(d->taken.begin(), d->taken.end(), [&](const Box& b) { return Overlap(b, box); });
  if (!free || !d->IsOnMap({box.left, box.top}) || !d->IsOnMap({box.right, box.bottom})) return false;
  d->taken.push_back(box);
  const int first = d->list->VtxBuffer.Size;
  DrawText(name, {at.x - room.width_px / 2, at.y - room.height_px / 2, room.width_px + 1, room.height_px}, words,
           d->text);
  for (int k = first; k < d->list->VtxBuffer.Size; ++k) {  // turned along the street; y is down
    ImVec2* p = &d->list->VtxBuffer[k].pos;
    const float x = p->x - at.x, y = p->y - at.y;
    *p = {at.x + x * along.x + y * along.y, at.y - x * along.y + y * along.x};
  }
  return true;
}

void ShowStreetName(const Street& street, Drawing* d) {
  const std::string name = TextIn(street.names, d->look.language, d->pack.language);
  TextLook words = TextOf(d->look);
  words.letter_px *= kStreetLetter;
  words.color = kInk;
  words.most_lines = 1;
  const TextRoom room = RoomFor(name, 1e4f, words, d->text);
  for (const NamePlace& place : PlacesForName(street)) {
    if (ShowNameAt(name, place, words, room, d)) return;
  }
}

void ShowSelf(Drawing* d) {
  const ViewCamera& camera = d->s.visitor.camera.view;
  const ImVec2 at = d->On(camera.position);
  if (!d->IsOnMap(at)) return;
  const float size_px = kSelf * d->look.letter_px;
  const auto corner = [&](float turn_rad, float far) {
    const float angle = camera.yaw_rad + turn_rad;
    return ImVec2{at.x + std::cos(angle) * far * size_px, at.y - std::sin(angle) * far * size_px};
  };
  for (const bool outline : {true, false}) {
    const float far = outline ? 1.3f : 1;
    const ImU32 color = outline ? kWhite : kSelfColor;
    const ImVec2 tip = corner(0, far), notch = corner(kPi, 0.35f * far);
    d->list->AddTriangleFilled(tip, corner(2.5f, far), notch, color);
    d->list->AddTriangleFilled(tip, notch, corner(-2.5f, far), color);
  }
}

void ShowNorth(const Drawing& d) {
  const float letter_px = d.look.letter_px;
  const float x = d.corner.x + static_cast<float>(d.view.width_px) - 1.2f * letter_px,
              y = d.corner.y + 0.5f * letter_px;
  const ImU32 ink = IM_COL32(kInk[0], kInk[1], kInk[2], 255);
  d.list->AddTriangleFilled({x, y}, {x - 0.45f * letter_px, y + letter_px}, {x + 0.45f * letter_px, y + letter_px},
                            ink);
  TextLook north = TextOf(d.look);
  north.color = kInk;
  north.align = Align::kCenter;
  DrawText(Say(Phrase::kNorth, d.look.language), {x - letter_px, y + letter_px, 2 * letter_px, 1.3f * letter_px}, north,
           d.text);
}

void ShowHotspotDots(const Drawing& d) {
  for (const Hotspot& hotspot : d.pack.hotspots) {
    const ImVec2 at = d.On(hotspot.position_m);
    if (d.IsOnMap(at)) d.list->AddCircleFilled(at, 0.18f * d.look.letter_px, kPinColor, 16);
  }
}

// What was tapped: a stop whose pin is near, else the place.
MapChoice ChoiceAt(ImVec2 tapped, const std::vector<MapStop>& stops, const Drawing& d) {
  MapChoice choice;
  float least_px = kPinReach * d.look.letter_px;
  for (const MapStop& stop : stops) {
    const ImVec2 at = d.On(d.s.visitor.tour.stops[stop.stop].position_m);
    const float far_px = std::hypot(at.x - tapped.x, at.y - tapped.y);
    if (far_px < least_px) least_px = far_px, choice.stop = stop.stop;
  }
  if (!choice.stop) choice.place = FromMap(d.view, {tapped.x - d.corner.x, tapped.y - d.corner.y});
  return choice;
}

MapChoice ShowTheMap(const TourPack& pack, const Simulation& s, PageLook look, const Box& box, Overlay* overlay,
                     MapPage* page) {
  const float side_px = std::min(box.right - box.left, box.bottom - box.top);
  look.letter_px = std::min(look.letter_px, kMostMapLetter * side_px);
  const int width_px = static_cast<int>(box.right - box.left), height_px = static_cast<int>(box.bottom - box.top);
  if (page->whole.width_px != width_px || page->whole.height_px != height_px)
    page->whole = WholeTown(s.town.walkable, width_px, height_px);
  const MapView view = Enlarged(page->whole, page->times, s.visitor.camera.view.position);
  const bool same = page->picture != nullptr && view.width_px == page->drawn.width_px &&
                    view.height_px == page->drawn.height_px && view.px_per_m == page->drawn.px_per_m &&
                    Length(view.center_m - page->drawn.center_m) * view.px_per_m < 0.5f;
  if (!same) {
    overlay->RemovePicture(page->picture);
    page->picture = overlay->AddPicture(width_px, height_px, DrawTownMap(s.town.walkable, view));
    page->drawn = view;
  }
  ImGui::SetNextWindowPos({box.left, box.top});
  ImGui::SetNextWindowSize({box.right - box.left, box.bottom - box.top});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  ImGui::Begin(
      "map", nullptr,
      kPlain | ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoBringToFrontOnFocus);
  Drawing drawing{pack, s, look, page->drawn, ImGui::GetCursorScreenPos(), ImGui::GetWindowDrawList(), &overlay->text(),
                  {}};
  const ImVec2 high{drawing.corner.x + static_cast<float>(width_px), drawing.corner.y + static_cast<float>(height_px)};
  drawing.list->AddImageRounded(page->picture, drawing.corner, high, {0, 0}, {1, 1}, kWhite, 0.5f * look.letter_px);
  const std::vector<MapStop> stops = StopsOnMap(s.visitor.tour);
  ShowHotspotDots(drawing);
  ShowPins(stops, &drawing);
  const ImVec2 self = drawing.On(s.visitor.camera.view.position);
  const float self_px = kSelf * look.letter_px;
  drawing.taken.push_back({self.x - self_px, self.y - self_px, self.x + self_px, self.y + self_px});
  for (const Street& street : pack.streets) ShowStreetName(street, &drawing);
  ShowNorth(drawing);
  ShowSelf(&drawing);
  MapChoice choice;
  if (ImGui::InvisibleButton("###on the map", {static_cast<float>(width_px), static_cast<float>(height_px)}))
    choice = ChoiceAt(ImGui::GetIO().MousePos, stops, drawing);
  ImGui::End();
  ImGui::PopStyleVar();
  return choice;
}

std::string WhereOneIs(const TourPack& pack, const Simulation& s, const std::string& language) {
  const int street = StreetAt(pack.streets, s.visitor.camera.view.position);
  if (street < 0) return Say(Phrase::kYouAreHere, language);
  return Say(Phrase::kYouAreIn, language, {TextIn(At(pack.streets, street).names, language, pack.language)});
}

std::string TimesText(float times) {
  char text[16];
  std::snprintf(text, sizeof text, "%.0f×", static_cast<double>(times));
  return text;
}

void ShowListRows(const TourPack& pack, const Simulation& s, const PageLook& look, bool hints, PageRows* rows,
                  MapPage* page, MapChoice* choice) {
  rows->Words(WhereOneIs(pack, s, look.language));
  if (hints) rows->Words(Say(Phrase::kMapTap, look.language));
  for (const MapStop& stop : StopsOnMap(s.visitor.tour)) {
    const std::string name = std::to_string(stop.number) + "   " + NameOfStop(s.visitor.tour, stop.stop);
    if (rows->Button(name, "stop " + std::to_string(stop.stop))) choice->stop = stop.stop;
  }
  for (size_t k = 0; k < pack.streets.size(); ++k) {
    const std::string name = TextIn(pack.streets[k].names, look.language, pack.language);
    if (rows->Button(name, "street " + std::to_string(k))) choice->place = MiddleOf(pack.streets[k]);
  }
  const int steps = rows->Amount(Say(Phrase::kZoom, look.language), TimesText(page->times));
  page->times = std::clamp(steps > 0 ? page->times * 2 : steps < 0 ? page->times / 2 : page->times, 1.0f, kMostTimes);
}

MapChoice ShowList(const TourPack& pack, const Simulation& s, const PageLook& look, const Box& box, Menu* menu,
                   Overlay* overlay, MapPage* page) {
  MapChoice choice;
  const float letter_px = look.letter_px, inner_px = box.right - box.left - 1.6f * letter_px;
  PageRows rows(look, inner_px, &overlay->text());
  ImGui::SetNextWindowPos({box.left, box.top});
  ImGui::SetNextWindowSize({box.right - box.left, box.bottom - box.top});
  if (ImGui::Begin("map list", nullptr, kPlain)) {
    ShowKeyMark(&menu->mark);
    const std::string back = Say(Phrase::kBackToPages, look.language);
    const TextRoom hint = RoomFor(Say(Phrase::kMapTap, look.language), inner_px, TextOf(look), &overlay->text());
    const bool hints = hint.lines <= kMostHintLines && hint.height_px <= kMostHint * (box.bottom - box.top);
    ShowListRows(pack, s, look, hints, &rows, page, &choice);
    const float rest_px = box.bottom - box.top - 1.2f * letter_px - rows.ButtonHeight_px(back) - 0.6f * letter_px;
    if (!rows.Fit(rest_px, menu->first, Say(Phrase::kMore, look.language))) menu->first = 0;
    ShowListRows(pack, s, look, hints, &rows, page, &choice);
    rows.ShowMore();
    if (rows.more_pressed()) {
      menu->first = rows.end() < rows.count() ? rows.end() : 0;
      menu->mark.is_asked = menu->mark.by_keys;
    }
    if (rows.ButtonBelow(back, "back")) OpenPage(Page::kNone, menu);
  }
  ImGui::End();
  return choice;
}

}  // namespace

MapChoice ShowMapPage(const TourPack& pack, const Simulation& s, const PageLook& look, int width_px, int height_px,
                      Menu* menu, Overlay* overlay, MapPage* page) {
  if (menu->page != Page::kMap) return {};
  const ImVec2 picture{static_cast<float>(width_px), static_cast<float>(height_px)};
  const Places places = PlacesFor(look, picture.x, picture.y);
  const PageStyle style(look, menu->mark);
  ImGui::GetBackgroundDrawList()->AddRectFilled({0, 0}, picture, IM_COL32(0, 0, 0, 130));
  MapChoice choice = ShowTheMap(pack, s, look, places.map, overlay, page);
  const MapChoice listed = ShowList(pack, s, look, places.list, menu, overlay, page);
  if (listed.stop || listed.place) choice = listed;
  if (choice.stop || choice.place) OpenPage(Page::kNone, menu);
  return choice;
}

}  // namespace flaneur
