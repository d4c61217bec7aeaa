#include "runtime/web/page_visit.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "runtime/render/renderer.h"
#include "runtime/show/frame_from_simulation.h"
#include "runtime/show/guide_figure.h"
#include "runtime/visit/controls.h"
#include "runtime/visit/home.h"
#include "runtime/visit/hotspots.h"
#include "runtime/visit/leading.h"
#include "runtime/visit/loading.h"
#include "runtime/visit/menu.h"
#include "runtime/visit/menu_rows.h"
#include "runtime/visit/narration.h"
#include "runtime/visit/notices.h"
#include "runtime/visit/page_look.h"
#include "runtime/visit/phrases.h"
#include "runtime/visit/resolution.h"
#include "runtime/visit/settings_in_force.h"
#include "runtime/visit/settings_text.h"
#include "runtime/visit/soundscape.h"
#include "runtime/visit/tour_end.h"
#include "runtime/walk/staging.h"
#include "runtime/web/headset.h"
#include "runtime/web/page_sound.h"
#include "runtime/web/told_map.h"
#include "runtime/web/told_rows.h"

namespace flaneur {
namespace {

// A file of the pack that arrives after it was opened.
struct LateFile {
  std::vector<uint8_t>* file = nullptr;
  ByteRange range;
  std::vector<uint8_t> bytes;
  ByteRanges there;
};

void AddLate(const std::vector<ByteRange>& ranges, std::vector<std::vector<uint8_t>>* files,
             std::vector<LateFile>* late) {
  for (size_t k = 0; k < ranges.size(); ++k) {
    if ((*files)[k].empty()) late->push_back({&(*files)[k], ranges[k], std::vector<uint8_t>(ranges[k].bytes), {}});
  }
}

// What of the bytes is theirs; who is whole stands in the pack.
void Fill(size_t offset, std::span<const uint8_t> bytes, std::vector<LateFile>* late) {
  for (LateFile& l : *late) {
    const size_t begin = std::max(offset, l.range.offset),
                 end = std::min(offset + bytes.size(), l.range.offset + l.range.bytes);
    if (begin >= end) continue;
    const auto part = bytes.subspan(begin - offset, end - begin);
    std::copy(part.begin(), part.end(), l.bytes.begin() + static_cast<std::ptrdiff_t>(begin - l.range.offset));
    l.there.Add({begin - l.range.offset, end - begin});
    if (l.there.Holds({0, l.bytes.size()})) *l.file = std::move(l.bytes);
  }
  std::erase_if(*late, [](const LateFile& l) { return !l.file->empty(); });
}

constexpr double kLongUpload_ms = 30, kUpload_ms = 3;  // before the first picture, and in each later one
constexpr int kWaitsForRoom = 8;  // pictures at most, each of which is still being drawn when there is time to upload
const RenderOptions kDrawing{.onto_window = true, .runs_ahead = true};
constexpr int kStepsBefore = 2;  // the first picture: in them everybody finds a way, which takes tenths of a second
constexpr int kMaxStepsPerFrame = 4;  // a machine that cannot keep up slows the town down
constexpr float kTapReach = 0.045f;   // of the picture's height, around a hotspot

std::string Text(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

RoomEye EyeFrom(const float* at) {
  RoomEye eye;
  for (size_t k = 0; k < 16; ++k) {
    eye.projection.m[k / 4][k % 4] = at[k];
    eye.eye_from_room.m[k / 4][k % 4] = at[16 + k];
  }
  eye.place = {at[32], at[33], at[34]};
  eye.left_px = static_cast<int>(at[35]);
  eye.bottom_px = static_cast<int>(at[36]);
  eye.width_px = static_cast<int>(at[37]);
  eye.height_px = static_cast<int>(at[38]);
  return eye;
}

constexpr const char* kPageNames[] = {"", "main", "stops", "languages", "settings", "keys", "map", "photo", "end"};

}  // namespace

struct PageVisit::Impl {
  FileBytes bytes;  // until the file is open
  ByteRanges there;
  TourPack pack;
  PackFile pack_file;          // between its opening and the loader's start
  std::vector<LateFile> late;  // of the pack's
  Loader loader;
  Simulation s;
  Renderer renderer;
  PlayerSettings settings;  // as the visit begins
  OwnView own;
  Controls controls;
  Menu menu;
  Notices notices;
  TourEnd end;
  Leading leading;
  Hotspots hotspots;
  Soundscape soundscape;
  Narration narration;
  PageSound sound;
  ToldMap map;
  Headset headset;
  PersonLooks looks;
  FrameInput frame;
  CameraInput wishes;
  FrameStatistics statistics;
  Resolution resolution;
  bool open = false, loads = false, has_kept = false;  // has_kept: settings that are to be kept
  bool photo_asked = false, photo_taken = false;
  float aspect = 1;
  double owed_s = 0;
  float picture_s = 0;                     // the last one took
  float ahead_s = 0;                       // of the next one's time, what hands and steps have been through already
  bool stepped = false;                    // since then
  int64_t pictures = 0, uploaded_at = -1;  // uploaded_at: so many pictures

  bool pages() const { return menu.page != Page::kNone; }
  std::string Language() const { return PageLanguage(controls, s); }
  LeadingIn Lead() { return {s, controls, notices, wishes, leading}; }
  ResolutionSettings ResolutionWished() const {
    return ResolutionFor(controls.settings.frames_per_s, controls.settings.least_resolution_scale, s.control.settings);
  }
  void ApplySettings();
  void Jump(size_t stop);
  void Do(const MenuChoice& choice);
  void TakeHands(const WindowInput& input, float passed_s);
  void TakeWishes();
  void Step(float passed_s, int most_steps);
  void StepsOfPicture(float passed_s);
  void StepInRoom(CameraInput input, float picture_ms);
  void DrawInRoom(unsigned framebuffer);
  void Draw(int width_px, int height_px, float passed_s);
  void TakePhoto(int width_px, int height_px);
  void Sound(float passed_s);
  nlohmann::json Page();
  nlohmann::json ToldHotspots() const;
};

PageVisit::PageVisit() : impl_(std::make_unique<Impl>()) {}
PageVisit::~PageVisit() = default;

void PageVisit::Expect(size_t bytes) { impl_->bytes = FileBytes::Room(bytes); }

Error PageVisit::Arrive(size_t offset, std::span<const uint8_t> bytes) {
  Impl& v = *impl_;
  if (v.open) {
    Fill(offset, bytes, &v.late);
    return v.loads ? v.loader.Arrive(offset, bytes) : v.pack_file.Arrive(offset, bytes);
  }
  if (offset > v.bytes.size() || bytes.size() > v.bytes.size() - offset)
    return Fail("a piece lies beyond the tour's end");
  std::copy(bytes.begin(), bytes.end(), v.bytes.data() + offset);
  v.there.Add({offset, bytes.size()});
  return Ok();
}

Error PageVisit::Open(const std::string& settings) {
  Impl& v = *impl_;
  if (Error e = v.pack_file.Open(std::move(v.bytes), std::move(v.there), "the tour", &v.pack)) return e;
  AddGuideFigure(&v.pack);
  AddLate(v.pack.sound_ranges, &v.pack.sounds, &v.late);
  AddLate(v.pack.picture_ranges, &v.pack.pictures, &v.late);
  if (Error e = v.renderer.Begin(v.pack, kDrawing)) return e;  // the driver works on while the town is prepared
  if (Error e = StartSimulation(&v.pack, ScenarioOf(v.pack), &v.s)) return e;
  v.open = true;
  v.own = {v.s.visitor.camera.view.fov_rad, v.s.visitor.camera.eye_height_m};
  v.settings.pointer = "point";
  std::vector<std::string> warnings;  // of what another version of the page kept: defaults serve
  if (TakePlayerSettings(settings, "settings", &v.settings, &warnings)) v.settings = {};
  v.controls = MakeControls(v.settings, {}, v.s);
  v.menu.can_quit = false;
  v.controls.has_photos = true;
  v.ApplySettings();
  v.resolution = FirstResolution(v.ResolutionWished(), v.renderer.software());
  BeginHint(v.controls, v.s, &v.notices);
  PrepareHotspots(v.pack.hotspots, v.s.town.walkable, &v.hotspots);
  PrepareSoundscape(v.pack, v.s.town.walkable, &v.soundscape);
  v.sound.Prepare(v.soundscape.recordings);
  return Ok();
}

void PageVisit::Prepare() { impl_->renderer.Expect(kDrawing); }

Error PageVisit::Begin() {
  Impl& v = *impl_;
  v.loader.Start(std::move(v.pack_file), v.pack);
  v.loads = true;
  v.loader.PrepareFor(v.renderer);
  return Ok();
}

Error PageVisit::Load(bool* there) {
  Impl& v = *impl_;
  if (v.loader.TownIsThere()) v.loader.GoOn();
  if (!v.loader.LikenessesAreThere()) {
    *there = false;
    return v.loader.Upload(kLongUpload_ms, &v.renderer);
  }
  *there = v.s.town.step >= kStepsBefore;
  if (!*there) StepSimulation({}, 0, &v.s);
  return Ok();
}

void PageVisit::Impl::ApplySettings() {
  HeedSettings(controls.settings, own, &s);
  sound.SetVolume(controls.settings.sound_volume);
  controls.applies = false;
  if (!notices.is_hint) return;
  const float left_s = notices.left_s;
  BeginHint(controls, s, &notices);  // in the language that is chosen now
  notices.left_s = left_s;
}

void PageVisit::Impl::Jump(size_t stop) {
  JumpToStop(stop, InTown(&s));
  looks = {};
}

void PageVisit::Impl::Do(const MenuChoice& choice) {
  if (choice.stop) Jump(*choice.stop);
  wishes.tour.toggle_pause = wishes.tour.toggle_pause || choice.toggles_pause;
  if (!choice.home) return;
  GoHome(controls.settings, {s, controls, wishes, notices});
  controls.has_photos = true;
  CloseHotspot(&hotspots);
  leading = {};
  looks = {};
  OpenPage(Page::kNone, &menu);
  BeginVisit({s, controls, wishes, notices});
}

void PageVisit::Impl::TakeHands(const WindowInput& input, float passed_s) {
  TakePageInput(input, &menu, &controls);
  WindowInput walking = input;
  const bool for_pages = pages();
  if (for_pages) {
    walking = {};
    walking.down = input.down;
    leading.was_down = input.down;
  } else {
    std::erase_if(walking.clicks,
                  [&](const Vec2& click) { return flaneur::TapHotspot(click, aspect, kTapReach, &hotspots); });
    StopWhereAsked(walking, Lead());
  }
  TakeInput(walking, passed_s, aspect, for_pages, s, &controls, &wishes);
  TakeWishes();
}

// What keys and the page's buttons asked for.
void PageVisit::Impl::TakeWishes() {
  if (controls.opens_pages) OpenPage(Page::kMain, &menu);
  if (controls.opens_map) OpenPage(Page::kMap, &menu);
  if (controls.asks) AskHotspot(&hotspots);
  photo_asked = photo_asked || controls.takes_photo;
  controls.opens_pages = controls.opens_map = controls.asks = controls.takes_photo = false;
  controls.quits = controls.toggles_views = controls.switches_adaptation = false;
  if (controls.applies) ApplySettings();
  has_kept = has_kept || controls.changed;
  controls.changed = false;
}

// The head turns the view. Where hands do not walk, the body goes where the head has gone in its room.
void PageVisit::Impl::StepInRoom(CameraInput input, float picture_ms) {
  constexpr float kMost_mps = 2;
  LookWithHead(headset, &s, &input);
  const auto off = WalkUnderHead(headset);
  const bool follows_head = off && input.active && input.speed_mps <= 0 && !input.walk_to;
  if (follows_head) {
    input.direction = *off * (1 / Length(*off));
    input.speed_mps = std::min(kMost_mps, Length(*off) / Step_s(s));
  }
  const Vec2 before = s.visitor.camera.view.position;
  StepSimulation(input, picture_ms, &s);
  if (follows_head) Followed(s.visitor.camera.view.position - before, &headset);
}

void PageVisit::Impl::Step(float passed_s, int most_steps) {
  const float picture_ms = picture_s * 1000;
  const double step_s = static_cast<double>(Step_s(s));
  if (!HoldsTown(menu)) owed_s = std::min(owed_s + static_cast<double>(passed_s), step_s * kMaxStepsPerFrame);
  if (owed_s >= step_s && !std::exchange(stepped, true)) controls.turned_rad = 0;
  for (int k = 0; k < most_steps && owed_s >= step_s; ++k, owed_s -= step_s) {
    const CameraInput input = NextStep(wishes, s, &controls);
    if (headset.worn) StepInRoom(input, picture_ms);
    else StepSimulation(input, picture_ms, &s);
    wishes.tour = {};
    wishes.walk_to.reset();
  }
}

void PageVisit::Impl::StepsOfPicture(float passed_s) {
  picture_s = passed_s;
  Step(std::max(0.0f, passed_s - ahead_s), kMaxStepsPerFrame);
  ahead_s = 0;
  stepped = false;
  if (!pages()) FollowNotices(controls, s, passed_s, &notices);
}

// The whole of it as fine as the window; the page takes it from its canvas.
void PageVisit::Impl::TakePhoto(int width_px, int height_px) {
  photo_asked = false;
  FrameInput whole = frame;
  whole.caption.clear();
  whole.ground_mark.clear();
  whole.resolution_scale = 1;
  renderer.Draw(whole, width_px, height_px, &statistics);
  renderer.Present();
  photo_taken = true;
  OpenPage(Page::kPhoto, &menu);
}

void PageVisit::Impl::Draw(int width_px, int height_px, float passed_s) {
  const float share = static_cast<float>(owed_s) / Step_s(s);
  FrameFromSimulation(pack, s, &looks, &frame,
                      {share, TurnUntil(share, s, controls), controls.turned_rad, LookUntilNow(s, controls)});
  if (pages()) frame.caption.clear();
  else ShowNotice(notices, !controls.settings.reduced_motion, controls.settings.captions_always, &frame);
  frame.resolution_scale = ScaleNow(ResolutionWished(), resolution);
  frame.detail = DetailNow(ResolutionWished(), resolution);
  ++pictures;
  if (photo_asked) return TakePhoto(width_px, height_px);
  renderer.Draw(frame, width_px, height_px, &statistics);
  renderer.Present();
  const GuidedTour& tour = s.visitor.tour;
  const bool is_led = controls.follows_tour && HasTour(tour) && !tour.paused;
  if (pages()) return;
  LookForHotspots(
      pack.hotspots, frame, aspect, !is_led && !leading.led, passed_s,
      [&](Vec3 point) { return renderer.Hides(point); }, &hotspots);
}

void PageVisit::Impl::DrawInRoom(unsigned framebuffer) {
  const float share = static_cast<float>(owed_s) / Step_s(s);
  FrameFromSimulation(pack, s, &looks, &frame, {share, 0, 0, 0});
  ShowNotice(notices, false, controls.settings.captions_always, &frame);
  const Vec3 body{frame.eye.x, frame.eye.y, frame.eye.z - s.visitor.camera.eye_height_m};
  frame.resolution_scale = frame.detail = 1;
  ++pictures;
  renderer.DrawEyes(frame, PicturesOf(headset, body), framebuffer, &statistics);
}

// What is said waits until its file has arrived.
void PageVisit::Impl::Sound(float passed_s) {
  const GuidedTour& tour = s.visitor.tour;
  Aside aside;
  if (hotspots.open >= 0) {
    const auto& sounds = pack.hotspots[static_cast<size_t>(hotspots.open)].sounds;
    auto said = sounds.find(Language());
    if (said == sounds.end()) said = sounds.find(pack.language);
    aside = {hotspots.open, said == sounds.end() ? -1 : said->second.sound};
  }
  const auto is_there = [&](int file) { return file < 0 || !pack.sounds[static_cast<size_t>(file)].empty(); };
  const int of_stop = tour.resting && !tour.stops.empty() ? tour.words[HaltOf(tour)].sound : -1;
  if (is_there(of_stop) && is_there(aside.sound)) Narrate(tour, aside, pages(), pack.sounds, &narration, &sound);
  FollowSoundscape(pack, s, frame, passed_s, narration.sound >= 0, pages(), &soundscape);
  sound.Hear(soundscape.heard);
}

Error PageVisit::LoadMore(bool* all) {
  Impl& v = *impl_;
  const bool waits = !v.renderer.software() && v.renderer.IsDrawing() && v.pictures < v.uploaded_at + kWaitsForRoom;
  const bool uploads = !waits && std::exchange(v.uploaded_at, v.pictures) != v.pictures;
  // Between a headset's pictures browsers find time for few tasks.
  const double most_ms = v.headset.worn ? std::clamp(100.0 * v.picture_s, kUpload_ms, 4 * kUpload_ms) : kUpload_ms;
  const Error e = uploads ? v.loader.Upload(most_ms, &v.renderer) : v.loader.ReadOn(most_ms);
  *all = v.loader.Done();
  return e;
}

void PageVisit::Meanwhile(const WindowInput& input, float passed_s) {
  Impl& v = *impl_;
  v.ahead_s += passed_s;
  v.TakeHands(input, passed_s);
  v.Step(passed_s, 1);
}

Error PageVisit::Picture(const WindowInput& input, int width_px, int height_px, float passed_s) {
  Impl& v = *impl_;
  v.photo_taken = false;
  if (width_px <= 0 || height_px <= 0) return Ok();
  v.aspect = static_cast<float>(width_px) / static_cast<float>(height_px);
  SetPictureSize(width_px, height_px, &v.s);
  v.TakeHands(input, std::max(0.0f, passed_s - v.ahead_s));
  FollowTourEnd(v.pack, v.s, v.pages(), passed_s, &v.end, &v.controls, &v.wishes, &v.menu);
  v.StepsOfPicture(passed_s);
  v.Draw(width_px, height_px, passed_s);
  v.Sound(passed_s);
  v.loader.GoOn();
  return Ok();
}

bool PageVisit::IsBusy() const { return impl_->renderer.software() && impl_->renderer.IsDrawing(); }

void PageVisit::PutOnHeadset(Vec3 head, float pictures_per_s) {
  Impl& v = *impl_;
  PutOn(head, pictures_per_s, &v.s, &v.headset);
  v.owed_s = 0;
}

void PageVisit::TakeOffHeadset() {
  Impl& v = *impl_;
  if (!v.headset.worn) return;
  TakeOff(v.headset, &v.s);
  v.headset = {};
  v.looks = {};
}

Error PageVisit::PictureInRoom(const WindowInput& input, Vec3 head, std::span<const float> eyes, unsigned framebuffer,
                               float passed_s) {
  Impl& v = *impl_;
  v.headset.head = head;
  v.headset.eyes.clear();
  for (size_t k = 0; k + kFloatsOfEye <= eyes.size(); k += kFloatsOfEye) v.headset.eyes.push_back(EyeFrom(&eyes[k]));
  if (v.headset.eyes.empty()) return Ok();
  v.TakeHands(input, passed_s);
  FollowTourEnd(v.pack, v.s, v.pages(), passed_s, &v.end, &v.controls, &v.wishes, &v.menu);
  v.StepsOfPicture(passed_s);
  v.DrawInRoom(framebuffer);
  v.Sound(passed_s);
  v.loader.GoOn();
  return Ok();
}

void PageVisit::TurnInRoom(float angle_rad) { TurnRoom(angle_rad, &impl_->headset); }

bool PageVisit::Land(Vec3 from, Vec3 along, bool goes, Vec3* there) {
  Impl& v = *impl_;
  const auto place = LandingPlace(from, along, v.headset, v.s);
  if (!place) return false;
  *there = InRoom(*place, v.headset, v.s);
  if (!goes) return true;
  Teleport(*place, &v.s, &v.headset);
  v.controls.follows_tour = false;
  v.looks = {};
  return true;
}

void PageVisit::TellTime(float took_ms) {
  Impl& v = *impl_;
  constexpr float kMoves_mps = 0.3f, kTurns_radps = 0.2f;
  const CameraState& camera = v.s.visitor.camera;
  const bool moves = camera.actual_mps > kMoves_mps || std::abs(camera.yaw_rate_radps) > kTurns_radps;
  FollowPictureTime(took_ms, moves, v.ResolutionWished(), &v.resolution);
}

void PageVisit::SetLanguage(const std::string& language) {
  const std::vector<std::string>& known = impl_->s.visitor.tour.languages;
  if (std::find(known.begin(), known.end(), language) == known.end()) return;
  impl_->controls.settings.language = language;
  impl_->ApplySettings();
}

void PageVisit::GoToStop(size_t stop) {
  Impl& v = *impl_;
  if (stop >= v.s.visitor.tour.stops.size()) return;
  v.Jump(stop);
  v.controls.follows_tour = true;
  OpenPage(Page::kNone, &v.menu);
}

void PageVisit::TakeTour(bool follows) { impl_->controls.follows_tour = follows; }

void PageVisit::Pause(bool pauses) {
  if (impl_->s.visitor.tour.paused != pauses) impl_->wishes.tour.toggle_pause = true;
}

void PageVisit::Ask(const std::string& action) {
  Impl& v = *impl_;
  Controls& c = v.controls;
  TourWish& tour = v.wishes.tour;
  if (action == "menu") c.opens_pages = true;
  if (action == "map") c.opens_map = true;
  if (action == "photo") c.takes_photo = true;
  if (action == "ask") c.asks = true;
  if (action == "tour") c.follows_tour = !c.follows_tour;
  if (action == "next" || action == "back" || action == "pause") {
    const bool was_led = c.follows_tour;
    c.follows_tour = true;
    tour.next = tour.next || action == "next";
    tour.back = tour.back || action == "back";
    if (action == "pause" && was_led) tour.toggle_pause = !tour.toggle_pause;
  }
}

void PageVisit::Press(const std::string& page, int row, int which) {
  Impl& v = *impl_;
  if (page != kPageNames[static_cast<size_t>(v.menu.page)]) return;  // it has closed meanwhile
  ToldRows rows(row, which);
  v.Do(FillRows(v.s, &v.menu, &v.controls, &rows));
  v.TakeWishes();
}

void PageVisit::GoBack() { flaneur::GoBack(&impl_->menu, &impl_->controls); }

void PageVisit::TapHotspot(int hotspot) {
  Impl& v = *impl_;
  for (const SeenHotspot& seen : v.hotspots.seen) {
    if (seen.hotspot == hotspot && hotspot != v.hotspots.open) {
      flaneur::TapHotspot(seen.place, v.aspect, kTapReach, &v.hotspots);
      return;
    }
  }
  CloseHotspot(&v.hotspots);
}

const std::vector<uint8_t>& PageVisit::Map(int width_px, int height_px, float times) {
  DrawMap(impl_->s, width_px, height_px, times, &impl_->map);
  return impl_->map.rgba;
}

std::string PageVisit::MapMarks() const { return Text(MarksOf(impl_->map, impl_->pack, impl_->s, impl_->Language())); }

void PageVisit::LeadTo(float x_px, float y_px) {
  Impl& v = *impl_;
  OpenPage(Page::kNone, &v.menu);
  LeadToPlace(FromMap(v.map.view, {x_px, y_px}), v.Lead());
}

void PageVisit::LeadTo(size_t stop) {
  Impl& v = *impl_;
  if (stop >= v.s.visitor.tour.stops.size()) return;
  OpenPage(Page::kNone, &v.menu);
  LeadToStop(stop, v.Lead());
}

void PageVisit::WidenView(float factor) {
  constexpr float kLeast_rad = 30 * kPi / 180, kMost_rad = 110 * kPi / 180;
  Simulation& s = impl_->s;
  SetFieldOfView(std::clamp(s.visitor.camera.view.fov_rad * factor, kLeast_rad, kMost_rad), &s);
}

bool PageVisit::photo_taken() const { return impl_->photo_taken; }
std::string PageVisit::Sounds() { return Text(impl_->sound.Take()); }
std::span<const uint8_t> PageVisit::Spoken() const { return impl_->sound.Spoken(); }
std::span<const uint8_t> PageVisit::RecordingOf(int recording) {
  return impl_->sound.BytesOf(static_cast<size_t>(recording));
}
bool PageVisit::IsComputed(int recording) const { return impl_->sound.IsComputed(static_cast<size_t>(recording)); }

std::span<const uint8_t> PageVisit::PackPicture(int picture) const {
  const std::vector<std::vector<uint8_t>>& all = impl_->pack.pictures;
  const auto k = static_cast<size_t>(picture);
  return k < all.size() ? std::span<const uint8_t>(all[k]) : std::span<const uint8_t>();
}

std::string PageVisit::TakeSettings() {
  if (!impl_->has_kept) return "";
  impl_->has_kept = false;
  return PlayerSettingsText(impl_->controls.settings);
}

// The page that is open.
nlohmann::json PageVisit::Impl::Page() {
  if (!pages()) return nullptr;
  const std::string language = Language();
  nlohmann::json page{{"name", kPageNames[static_cast<size_t>(menu.page)]},
                      {"waits_for_key", menu.rebinds.has_value()}};
  if (IsOfTown(menu.page)) {
    page["head"] = Say(menu.page == Page::kMap ? Phrase::kMap : Phrase::kPhoto, language);
    page["back"] = Say(Phrase::kContinue, language);
    page["line"] = TextIn(pack.photo.lines, language, pack.language);
    return page;
  }
  ToldRows rows;
  FillRows(s, &menu, &controls, &rows);
  page["head"] = HeadOf(menu, TitleOf(pack, language), language);
  page["back"] = BackOf(menu, language);
  page["rows"] = rows.Take();
  return page;
}

// Marks on what is seen, and what the one tells that does.
nlohmann::json PageVisit::Impl::ToldHotspots() const {
  nlohmann::json marks = nlohmann::json::array(), told;
  const std::string language = Language();
  for (const SeenHotspot& seen : hotspots.seen) {
    const Hotspot& hotspot = pack.hotspots[static_cast<size_t>(seen.hotspot)];
    marks.push_back({{"hotspot", seen.hotspot},
                     {"place", {seen.place.x, seen.place.y}},
                     {"interest", seen.interest},
                     {"title", TextIn(hotspot.titles, language, pack.language)}});
  }
  if (hotspots.open >= 0) {
    const Hotspot& hotspot = pack.hotspots[static_cast<size_t>(hotspots.open)];
    told = {{"hotspot", hotspots.open},
            {"title", TextIn(hotspot.titles, language, pack.language)},
            {"text", TextIn(hotspot.texts, language, pack.language)},
            {"picture", hotspot.picture}};
  }
  return {{"marks", marks}, {"told", told}};
}

std::string PageVisit::HotspotsNow() const { return Text(impl_->ToldHotspots()); }

std::string PageVisit::State() {
  Impl& v = *impl_;
  const GuidedTour& tour = v.s.visitor.tour;
  const CameraState& camera = v.s.visitor.camera;
  const PlayerSettings& settings = v.controls.settings;
  return Text({{"caption", v.frame.caption},
               {"caption_passed", v.frame.caption_passed},
               {"language", v.Language()},
               {"stop", tour.stops.empty() ? -1 : static_cast<int>(HaltOf(tour))},
               {"resting", tour.resting},
               {"over", tour.over},
               {"paused", tour.paused},
               {"follows_tour", v.controls.follows_tour},
               {"page", v.Page()},
               {"points", v.controls.points},
               {"fullscreen", settings.fullscreen},
               {"text_size", settings.text_size},
               {"high_contrast", settings.high_contrast},
               {"reduced_motion", settings.reduced_motion},
               {"hotspots", v.hotspots.seen.size()},
               {"told", v.hotspots.open},
               {"pictures", v.pictures},
               {"people_drawn", v.statistics.people_drawn},
               {"resolution_scale", v.statistics.resolution_scale},
               {"place_m", {camera.view.position.x, camera.view.position.y}},
               {"yaw_rad", camera.view.yaw_rad},
               {"pitch_rad", camera.pitch_rad},
               {"fov_rad", camera.view.fov_rad},
               {"eye_height_m", camera.eye_height_m},
               {"complete", v.loader.Done()}});
}

std::string PageVisit::Words(const std::string& language) const {
  nlohmann::json phrases, actions;
  for (size_t k = 0; k < static_cast<size_t>(Phrase::kCount); ++k)
    phrases[kPhraseNames[k]] = Say(static_cast<Phrase>(k), language);
  for (size_t k = 0; k < kActions; ++k) actions[kActionNames[k]] = NameOf(static_cast<Action>(k), language);
  return Text({{"phrases", phrases}, {"actions", actions}});
}

std::string PageVisit::Description() const {
  const Impl& v = *impl_;
  const GuidedTour& tour = v.s.visitor.tour;
  nlohmann::json stops = nlohmann::json::array();
  for (size_t k = 0; k < tour.stops.size(); ++k)
    stops.push_back({{"name", NameOfStop(tour, k)}, {"halt", RestOf_s(tour, k) > 0}});
  return Text({{"title", TitleOf(v.pack, tour.language)}, {"languages", tour.languages}, {"stops", stops}});
}

}  // namespace flaneur
