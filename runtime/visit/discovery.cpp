#include "runtime/visit/discovery.h"

#include <imgui.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "runtime/base/array.h"
#include "runtime/visit/page_rows.h"
#include "runtime/visit/phrases.h"

namespace flaneur {
namespace {

constexpr float kTapReach = 0.045f;              // of the picture's height, around a hotspot
constexpr float kButton = 2, kButtonGap = 0.4f;  // in letters

float Aspect(int width_px, int height_px) {
  return static_cast<float>(std::max(1, width_px)) / static_cast<float>(std::max(1, height_px));
}

void Tell(const std::string& text, const DiscoveryIn& in) { TellNotice(text, in.controls, in.s, &in.notices); }

LeadingIn LeadingOf(const DiscoveryIn& in) { return {in.s, in.controls, in.notices, in.wishes, in.d.leading}; }

// A button of the corner's, with a picture that needs no word. which: 0 map, 1 photo.
bool CornerButton(int which, int place, const PageLook& look, int width_px) {
  const float side_px = kButton * look.letter_px, gap_px = kButtonGap * look.letter_px;
  const PageStyle style(look);
  ImGui::SetNextWindowPos({static_cast<float>(width_px) - side_px - look.letter_px / 2,
                           look.letter_px / 2 + (side_px + gap_px) * static_cast<float>(place)});
  ImGui::SetNextWindowSize({side_px, side_px});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  ImGui::Begin(which == 0 ? "map button" : "photo button", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoNav);
  const ImVec2 low = ImGui::GetCursorScreenPos();
  const bool pressed = ImGui::Button("###corner", {side_px, side_px});
  const PageColor& c = ImGui::IsItemHovered() ? look.marked_text : look.text;
  const ImU32 color = IM_COL32(c[0], c[1], c[2], c[3]);
  const float line_px = side_px / (look.high_contrast ? 9 : 14);
  const auto at = [&](float x, float y) { return ImVec2{low.x + x * side_px, low.y + y * side_px}; };
  ImDrawList* list = ImGui::GetWindowDrawList();
  if (which == 0) {  // a folded sheet
    for (float x : {0.22f, 0.41f, 0.6f}) {
      const float lower = x == 0.41f ? 0.06f : 0, upper = 0.06f - lower;
      list->AddQuad(at(x, 0.27f + lower), at(x + 0.19f, 0.27f + upper), at(x + 0.19f, 0.7f + upper),
                    at(x, 0.7f + lower), color, line_px * 0.8f);
    }
  } else {  // a camera
    list->AddRect(at(0.2f, 0.34f), at(0.8f, 0.74f), color, side_px * 0.06f, 0, line_px);
    list->AddRectFilled(at(0.38f, 0.26f), at(0.62f, 0.36f), color);
    list->AddCircle(at(0.5f, 0.54f), side_px * 0.12f, color, 24, line_px);
  }
  ImGui::End();
  ImGui::PopStyleVar();
  return pressed;
}

std::string LinkPattern(const DiscoveryIn& in) {
  return in.settings.photo_link.empty() ? in.pack.photo.link : in.settings.photo_link;
}

void ShowCode(TakenPhoto* t, Overlay* overlay) {
  overlay->RemovePicture(t->code);
  t->code = nullptr;
  if (t->link.empty()) return;
  const auto code = QrOf(t->link);
  if (!code) return;
  t->code_px = code->side_px;
  t->code = overlay->AddPicture(code->side_px, code->side_px, code->rgba);
}

void FollowKeeping(const DiscoveryIn& in) {
  TakenPhoto& t = in.d.photo;
  if (t.told) return;
  t.keeping.Advance();
  if (!t.keeping.Done()) return;
  t.told = true;
  if (t.error) in.shell.warnings.Warn(t.error.message);
}

}  // namespace

std::string PhotoFolder(const PlayerSettings& settings) {
  if (!settings.photos.empty()) return settings.photos;
  const char* home = std::getenv("HOME");
  if (settings.kiosk || home == nullptr || home[0] != '/') return "";
  return (std::filesystem::path(home) / "Pictures" / "Flaneur").string();
}

void PrepareDiscovery(const DiscoveryIn& in) {
  PrepareHotspots(in.pack.hotspots, in.s.town.walkable, &in.d.hotspots);
  PrepareSoundscape(in.pack, in.s.town.walkable, &in.d.soundscape);
  in.shell.sound.Prepare(in.d.soundscape.recordings);
}

void TakeDiscoveryInput(bool pages, int width_px, int height_px, const DiscoveryIn& in, WindowInput* input) {
  if (pages) {
    in.d.leading.was_down = input->down;
    return;
  }
  std::erase_if(input->clicks, [&](const Vec2& click) {
    return TapHotspot(click, Aspect(width_px, height_px), kTapReach, &in.d.hotspots);
  });
  StopWhereAsked(*input, LeadingOf(in));
}

void TakeDiscoveryWishes(const DiscoveryIn& in) {
  Controls& c = in.controls;
  c.has_photos = !PhotoFolder(in.settings).empty();
  if (c.opens_map) OpenPage(Page::kMap, &in.menu);
  if (c.asks) AskHotspot(&in.d.hotspots);
  if (c.takes_photo && !c.has_photos) Tell(Say(Phrase::kPhotoNone, PageLanguage(c, in.s)), in);
  in.d.photo_asked = in.d.photo_asked || (c.takes_photo && c.has_photos);
  c.opens_map = c.asks = c.takes_photo = false;
}

void ShowDiscoveryPages(const PageLook& look, int width_px, int height_px, const DiscoveryIn& in, Overlay* overlay) {
  FollowKeeping(in);
  const bool pages = in.menu.page != Page::kNone;
  const MapChoice choice = ShowMapPage(in.pack, in.s, look, width_px, height_px, &in.menu, overlay, &in.d.map);
  if (choice.stop) LeadToStop(*choice.stop, LeadingOf(in));
  if (choice.place) LeadToPlace(*choice.place, LeadingOf(in));
  ShowPhotoPage(in.d.photo, PhotoFolder(in.settings), !in.settings.kiosk, look, width_px, height_px, &in.menu, overlay);
  if (!in.controls.points || pages) return;
  if (CornerButton(0, 1, look, width_px)) OpenPage(Page::kMap, &in.menu);
  if (in.controls.has_photos && CornerButton(1, 2, look, width_px)) in.d.photo_asked = true;
}

void TakePhoto(const FrameInput& frame, int width_px, int height_px, const std::string& language, const DiscoveryIn& in,
               Renderer* renderer, Overlay* overlay) {
  if (!in.d.photo_asked) return;
  in.d.photo_asked = false;
  FrameInput whole = frame;
  whole.caption.clear();
  whole.ground_mark.clear();
  whole.resolution_scale = 1;
  FrameStatistics statistics;
  renderer->Draw(whole, width_px, height_px, &statistics);
  Photo photo{width_px, height_px, {}};
  renderer->Read(&photo.rgb);
  TakenPhoto& t = in.d.photo;
  t.keeping = Job();
  t.photo = WithLine(std::move(photo), TextIn(in.pack.photo.lines, language, in.pack.language), language,
                     &overlay->text().fonts());
  t.id = NewPhotoId();
  t.error = Ok();
  t.told = false;
  const std::string pattern = LinkPattern(in);
  t.link = pattern.empty() ? "" : PhotoLink(pattern, t.id);
  overlay->RemovePicture(t.shown);
  std::vector<uint8_t> rgba;
  for (size_t k = 0; k + 2 < t.photo.rgb.size(); k += 3)
    rgba.insert(rgba.end(), {t.photo.rgb[k], t.photo.rgb[k + 1], t.photo.rgb[k + 2], 255});
  t.shown = overlay->AddPicture(t.photo.width_px, t.photo.height_px, rgba);
  ShowCode(&t, overlay);
  const std::filesystem::path folder = PhotoFolder(in.settings);
  const auto most = static_cast<size_t>(in.settings.photos_most);
  t.keeping = StartJob(in.shell.jobs, [&t, folder, most] {
    t.error = KeepPhoto(t.photo, folder, t.id, most);
    return true;
  });
  OpenPage(Page::kPhoto, &in.menu);
}

void ShowDiscovery(const FrameInput& frame, const Renderer& renderer, float passed_s, bool pages, const PageLook& look,
                   int width_px, int height_px, const DiscoveryIn& in, Overlay* overlay) {
  if (pages) return;
  const GuidedTour& tour = in.s.visitor.tour;
  const bool is_led = in.controls.follows_tour && HasTour(tour) && !tour.paused;
  LookForHotspots(
      in.pack.hotspots, frame, Aspect(width_px, height_px), !is_led && !in.d.leading.led, passed_s,
      [&](Vec3 point) { return renderer.Hides(point); }, &in.d.hotspots);
  ShowHotspotMarks(in.d.hotspots, look, width_px, height_px);
  if (ShowHotspotPanel(in.pack, in.d.hotspots, look, width_px, height_px, overlay, &in.d.hotspot_picture))
    CloseHotspot(&in.d.hotspots);
}

Aside AsideOf(const DiscoveryIn& in) {
  const int open = in.d.hotspots.open;
  if (open < 0) return {};
  const auto& sounds = At(in.pack.hotspots, open).sounds;
  auto sound = sounds.find(PageLanguage(in.controls, in.s));
  if (sound == sounds.end()) sound = sounds.find(in.pack.language);
  return {open, sound == sounds.end() ? -1 : sound->second.sound};
}

void HearTown(const FrameInput& frame, float passed_s, bool speaks, bool holds, const DiscoveryIn& in) {
  FollowSoundscape(in.pack, in.s, frame, passed_s, speaks, holds, &in.d.soundscape);
  in.shell.sound.Hear(in.d.soundscape.heard);
}

void ForgetDiscovery(const DiscoveryIn& in) {
  CloseHotspot(&in.d.hotspots);
  in.d.hotspots.closed = -1;
  in.d.photo_asked = in.d.leading.led = false;
  in.d.map.times = 1;
}

}  // namespace flaneur
