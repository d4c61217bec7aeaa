#include "runtime/visit/visit.h"

#include <algorithm>
#include <set>

#include "runtime/base/text.h"
#include "runtime/render/overlay.h"
#include "runtime/render/renderer.h"
#include "runtime/show/frame_from_simulation.h"
#include "runtime/text/unicode.h"
#include "runtime/visit/attract.h"
#include "runtime/visit/attract_page.h"
#include "runtime/visit/controls.h"
#include "runtime/visit/developer_views.h"
#include "runtime/visit/discovery.h"
#include "runtime/visit/fade.h"
#include "runtime/visit/home.h"
#include "runtime/visit/kiosk.h"
#include "runtime/visit/menu.h"
#include "runtime/visit/menu_view.h"
#include "runtime/visit/narration.h"
#include "runtime/visit/notices.h"
#include "runtime/visit/operator_page.h"
#include "runtime/visit/phrases.h"
#include "runtime/visit/resolution.h"
#include "runtime/visit/settings_in_force.h"
#include "runtime/visit/tour_end.h"

namespace flaneur {
namespace {

constexpr double kLongUpload_ms = 50,
                 kUpload_ms = 3;      // of what has been loaded: before the first picture, and in each later one
constexpr int kMaxStepsPerFrame = 4;  // a machine that can't keep up slows the town down rather than freeze

bool IsUsed(const WindowInput& input) {
  constexpr float kMoved = 0.3f;
  return input.down.any() || input.pressed || Length(input.turned_px) > 0 || Length(input.left_stick) > kMoved ||
         Length(input.right_stick) > kMoved;
}

}  // namespace

struct Visit::Impl {
  const TourPack& pack;
  Loader* loader;
  PlayerSettings settings;  // as the visit begins
  Shell shell;
  Simulation* s;
  Kiosk kiosk;
  Attract attract{};
  float shows_itself_s = 0;    // the tour, by now
  VisitRecord record{};        // of the visit that is
  std::set<size_t> reached{};  // halts, in it
  Renderer renderer{};
  Overlay overlay{shell.fonts};
  Controls controls{};
  DeveloperViews views{};
  Menu menu{};
  Notices notices{};
  Fade fade{};
  PersonLooks looks{};
  FrameInput frame{};
  CameraInput wishes{};
  FrameStatistics statistics{};
  Narration narration{};
  Discovery discovery{};
  Resolution resolution{};
  OwnView own{};
  double owed_s = 0;  // of simulated time
  TourEnd end{};
  float says_nothing_s = 0;  // since they were asked what next
  int width_px = 0, height_px = 0;
  bool for_pages = false;  // what the hands do in this picture, even where that closes them
  bool starts_anew = false;

  bool pages() const { return menu.page != Page::kNone || operator_page(); }
  bool attracts() const { return settings.kiosk && kiosk.state == KioskState::kAttract; }
  bool operator_page() const { return kiosk.page != OperatorPage::kNone; }
  bool hidden() const { return width_px <= 0 || height_px <= 0; }
  DiscoveryIn find() { return {pack, settings, *s, controls, menu, notices, wishes, shell, discovery}; }
  void ApplySettings();
  void Save();
  void Jump(size_t stop);
  VisitSoFar SoFar() { return {*s, controls, wishes, notices}; }
  void BeginAnew();
  void EndVisitor();
  void NoteVisit();
  void MeetVisitor(const WindowInput& input);
  void MakeControlsAnew();
  bool IsLed() const;
  void FollowVisitors(const WindowInput& input, float passed_s);
  void ShowOperator(const PageLook& look);
  void EndTour(const WindowInput& input, float passed_s);
  void EndVisitNow();
  void TakeHands(const WindowInput& input, float passed_s);
  void ShowPages(const WindowInput& input, float passed_s);
  void StepTown(float passed_s, Records* records);
  BetweenSteps Between() const;
  ResolutionSettings ResolutionWished() const;
  void Draw(float passed_s);
};

// What the settings ask for, now and whenever they change.
void Visit::Impl::ApplySettings() {
  const PlayerSettings& chosen = controls.settings;
  HeedSettings(chosen, own, s);
  shell.sound.SetVolume(chosen.sound_volume);
  if (!notices.is_hint) return;
  const float left_s = notices.left_s;
  BeginHint(controls, *s, &notices);  // in the language that is chosen now
  notices.left_s = left_s;
}

void Visit::Impl::Save() {
  if (!controls.changed) return;
  controls.changed = false;
  if (settings.kiosk) return;  // the next visitor finds everything as it was
  if (Error e = shell.settings.Save(controls.settings)) shell.warnings.Warn(e.message);
}

void Visit::Impl::Jump(size_t stop) {
  JumpToStop(stop, InTown(s));
  if (controls.settings.reduced_motion) BeginFade(&fade);
  looks = {};
}

void Visit::Impl::MakeControlsAnew() {
  controls = MakeControls(settings, shell.layout, *s);
  if (settings.kiosk) controls.offered_languages = kiosk.settings.languages;
}

// All is as at the beginning.
void Visit::Impl::BeginAnew() {
  GoHome(settings, SoFar());
  if (settings.kiosk) controls.offered_languages = kiosk.settings.languages;
  ForgetDiscovery(find());
  looks = {};
}

void Visit::Impl::NoteVisit() {
  if (shell.visits == nullptr || record.began == 0) return;
  const GuidedTour& tour = s->visitor.tour;
  record.length_s = std::max(0.0f, record.length_s - kiosk.unused_s);
  record.language = PageLanguage(controls, *s);
  record.stops_reached = reached.size();
  for (size_t k = 0; k < tour.stops.size(); ++k) record.stops += RestOf_s(tour, k) > 0;
  if (Error e = shell.visits->Note(record)) shell.warnings.Warn(e.message);
  record = {};
}

// Nobody is there any more: the tour shows itself.
void Visit::Impl::EndVisitor() {
  NoteVisit();
  BeginAnew();
  ApplySettings();
  OpenPage(Page::kNone, &menu);
  s->visitor.gentle = true;
  shows_itself_s = 0;
  BeginAttract(*s, controls.settings.reduced_motion, &attract);
}

// Somebody is there, who may have touched a language.
void Visit::Impl::MeetVisitor(const WindowInput& input) {
  const std::vector<std::string> languages = OfferedLanguages(controls, *s);
  const PageLook look = LookOf(controls, *s, width_px, height_px);
  const auto language =
      hidden() ? std::nullopt : LanguageAt(input.pointer, languages.size(), look, width_px, height_px);
  BeginAnew();
  if (language) controls.settings.language = languages[*language];
  record = {};
  record.began = std::time(nullptr);
  reached.clear();
  ApplySettings();
  MeetSomebodyNew(&menu);
  menu.lets_go = true;
  menu.was_down = input.down;
  menu.mark.by_keys = input.down.any();
}

void Visit::Impl::EndVisitNow() {
  if (settings.kiosk) {
    EndVisit(&kiosk);
    return EndVisitor();
  }
  BeginAnew();
  MeetSomebodyNew(&menu);
  menu.lets_go = true;
}

// Thanks, and what next; who does not say it any more has left.
void Visit::Impl::EndTour(const WindowInput& input, float passed_s) {
  if (!attracts()) FollowTourEnd(pack, *s, pages(), passed_s, &end, &controls, &wishes, &menu);
  else end = {};
  says_nothing_s = menu.page == Page::kEnd && !IsUsed(input) ? says_nothing_s + passed_s : 0;
  if (pack.home_after_s > 0 && says_nothing_s > pack.home_after_s) EndVisitNow();
}

// Who is shown round need not touch anything.
bool Visit::Impl::IsLed() const {
  const GuidedTour& tour = s->visitor.tour;
  return controls.follows_tour && HasTour(tour) && !tour.paused && !pages();
}

void Visit::Impl::FollowVisitors(const WindowInput& input, float passed_s) {
  if (!settings.kiosk) return;
  switch (FollowKiosk(input, passed_s, IsLed(), settings, &kiosk)) {
    case KioskEvent::kVisitBegins:
      return MeetVisitor(input);
    case KioskEvent::kVisitEnds:
      return EndVisitor();
    case KioskEvent::kNothing:
      shows_itself_s += passed_s;
      record.length_s += passed_s;
      if (s->visitor.tour.resting && !attracts()) reached.insert(HaltOf(s->visitor.tour));
  }
}

void Visit::Impl::ShowOperator(const PageLook& look) {
  switch (ShowOperatorPage(look, "", width_px, height_px, &kiosk, &menu.mark, &overlay.text())) {
    case OperatorChoice::kNone:
      return;
    case OperatorChoice::kRestart:
      starts_anew = true;
      [[fallthrough]];
    case OperatorChoice::kEnd:
      controls.quits = true;
      [[fallthrough]];
    case OperatorChoice::kBack:
      ClosePage(&kiosk);
  }
}

void Visit::Impl::TakeHands(const WindowInput& input, float passed_s) {
  WindowInput walking = input;
  if (for_pages) walking = {input.down, {}, {}, {}, {}, {-1, -1}, false, input.close};
  if (!hidden() && overlay.HasPointer()) walking.clicks.clear();
  const float aspect = static_cast<float>(std::max(1, width_px)) / static_cast<float>(std::max(1, height_px));
  TakeDiscoveryInput(for_pages, width_px, height_px, find(), &walking);
  TakeInput(walking, passed_s, aspect, for_pages, *s, &controls, &wishes);
  if (controls.toggles_views) views.shown = !views.shown;
  if (controls.switches_adaptation) SwitchAdaptation(s);
  if (controls.opens_pages) OpenPage(Page::kMain, &menu);
  TakeDiscoveryWishes(find());
  controls.toggles_views = controls.switches_adaptation = controls.opens_pages = false;
  if (controls.applies) ApplySettings();
  controls.applies = false;
}

// Before the hands' wishes for the walk: what is pressed here is not meant for the town.
void Visit::Impl::ShowPages(const WindowInput& input, float passed_s) {
  for_pages = pages() || attracts();
  Menu navigated = menu;  // by keys
  if (operator_page()) {
    FollowHands(input, controls, &menu);
    navigated = menu;
    navigated.page = Page::kMain;
  } else {
    TakePageInput(input, &menu, &controls);
    navigated = menu;
  }
  if (hidden()) return;
  const std::string title = TitleOf(pack, PageLanguage(controls, *s));
  const PageLook look = LookOf(controls, *s, width_px, height_px);
  overlay.Begin(width_px, height_px, OverlayInputFrom(input, navigated, controls, width_px, height_px, passed_s));
  ShowOperator(look);
  const MenuChoice choice =
      operator_page() ? MenuChoice{} : ShowMenu(title, *s, width_px, height_px, &menu, &controls, &overlay.text());
  if (views.shown && !pages()) ShowViews(statistics, width_px, height_px, &views, s);
  if (attracts()) {
    if (operator_page()) return;
    ShowAttractPage(title, OfferedLanguages(controls, *s), shows_itself_s, !controls.settings.reduced_motion, look,
                    width_px, height_px, &overlay.text());
    ShowFade(width_px, height_px, passed_s, &fade);
    return;
  }
  if (controls.points && !pages() && ShowMenuButton(look, width_px)) OpenPage(Page::kMain, &menu);
  if (!operator_page()) ShowDiscoveryPages(look, width_px, height_px, find(), &overlay);
  controls.quits = controls.quits || choice.ends;
  if (choice.stop) Jump(*choice.stop);
  wishes.tour.toggle_pause = wishes.tour.toggle_pause || choice.toggles_pause;
  if (choice.home) EndVisitNow();
  if (for_pages && !pages()) Save();
  ShowFade(width_px, height_px, passed_s, &fade);
}

void Visit::Impl::StepTown(float passed_s, Records* records) {
  const double step_s = static_cast<double>(Step_s(*s));
  if (!pages() && !attracts()) BeginVisit(SoFar());
  if (!HoldsTown(menu) && !operator_page())
    owed_s = std::min(owed_s + static_cast<double>(passed_s), step_s * kMaxStepsPerFrame);
  if (owed_s >= step_s) controls.turned_rad = 0;
  while (owed_s >= step_s) {
    const CameraInput next = attracts() ? NextOfAttract(*s, &attract) : NextStep(wishes, *s, &controls);
    StepSimulation(next, passed_s * 1000, s);
    if (attracts() && attract.leapt) BeginFade(&fade);
    Record(*s, {statistics.town_triangles, statistics.shadow_triangles, statistics.draw_ms}, records);
    wishes.tour = {};
    wishes.walk_to.reset();
    owed_s -= step_s;
  }
  Narrate(s->visitor.tour, AsideOf(find()), pages() || attracts(), pack.sounds, &narration, &shell.sound);
  if (!pages() && !attracts()) FollowNotices(controls, *s, passed_s, &notices);
}

BetweenSteps Visit::Impl::Between() const {
  const float share = static_cast<float>(owed_s) / Step_s(*s);
  return {share, TurnUntil(share, *s, controls), controls.turned_rad, LookUntilNow(*s, controls)};
}

ResolutionSettings Visit::Impl::ResolutionWished() const {
  const PlayerSettings& chosen = controls.settings;
  return ResolutionFor(chosen.frames_per_s, chosen.least_resolution_scale, s->control.settings);
}

void Visit::Impl::Draw(float passed_s) {
  if (hidden()) return;
  FrameFromSimulation(pack, *s, &looks, &frame, Between());
  if (pages() || attracts()) frame.caption.clear();
  else ShowNotice(notices, !controls.settings.reduced_motion, controls.settings.captions_always, &frame);
  const int side = frame.caption_style.side;
  frame.caption_style = CaptionStyleOf(controls.settings, PageLanguage(controls, *s));
  frame.caption_style.side = side;
  const ResolutionSettings wished = ResolutionWished();
  frame.resolution_scale = ScaleNow(wished, resolution);
  frame.detail = DetailNow(wished, resolution);
  TakePhoto(frame, width_px, height_px, PageLanguage(controls, *s), find(), &renderer, &overlay);
  renderer.Draw(frame, width_px, height_px, &statistics);
  ShowDiscovery(frame, renderer, passed_s, pages(), LookOf(controls, *s, width_px, height_px), width_px, height_px,
                find(), &overlay);
  HearTown(frame, passed_s, narration.sound >= 0, pages(), find());
  overlay.Draw();
  if (const std::u32string missing = overlay.text().fonts().TakeMissing(); !missing.empty())
    shell.warnings.Warn("no font of this machine shows " + OneLine(Utf8(missing)) + "; visitors see boxes");
  RememberFrame(*s, statistics, passed_s * 1000, &views.history);
}

Visit::Visit(const TourPack& pack, Loader* loader, const PlayerSettings& settings, const Shell& shell,
             Simulation* simulation, const KioskSettings& kiosk)
    : impl_(new Impl{pack, loader, settings, shell, simulation, {kiosk}}) {}
Visit::~Visit() = default;

Error Visit::Begin(bool onto_window) {
  if (Error e = impl_->renderer.Begin(impl_->pack,
                                      {.onto_window = onto_window, .runs_ahead = true, .fonts = impl_->shell.fonts}))
    return e;
  impl_->loader->PrepareFor(impl_->renderer);
  return Ok();
}

Error Visit::Load(bool* there) {
  if (impl_->loader->TownIsThere()) impl_->loader->GoOn();
  *there = impl_->loader->LikenessesAreThere();
  return *there ? Ok() : impl_->loader->Upload(kLongUpload_ms, &impl_->renderer);
}

Error Visit::Enter(bool views) {
  Impl& v = *impl_;
  if (Error e = v.overlay.Create()) return e;
  v.views.shown = views && !v.settings.kiosk;
  v.own = {v.s->visitor.camera.view.fov_rad, v.s->visitor.camera.eye_height_m};
  v.MakeControlsAnew();
  v.ApplySettings();
  v.resolution = FirstResolution(v.ResolutionWished(), v.renderer.software());
  BeginHint(v.controls, *v.s, &v.notices);
  PrepareDiscovery(v.find());
  if (v.settings.kiosk) v.EndVisitor();
  return Ok();
}

Error Visit::Picture(const WindowInput& input, int width_px, int height_px, float passed_s, Records* records) {
  Impl& v = *impl_;
  if (Error e = v.loader->Upload(kUpload_ms, &v.renderer)) return e;
  v.width_px = width_px;
  v.height_px = height_px;
  if (!v.hidden()) SetPictureSize(width_px, height_px, v.s);
  v.FollowVisitors(input, passed_s);
  v.ShowPages(input, passed_s);
  v.TakeHands(input, passed_s);
  v.EndTour(input, passed_s);
  v.StepTown(passed_s, records);
  v.Draw(passed_s);
  v.loader->GoOn();
  return Ok();
}

void Visit::TellTime(float took_ms) {
  Impl& v = *impl_;
  took_ms = std::max(took_ms, static_cast<float>(v.statistics.draw_ms));
  constexpr float kMoves_mps = 0.3f, kTurns_radps = 0.2f;
  const CameraState& camera = v.s->visitor.camera;
  const bool moves = camera.actual_mps > kMoves_mps || std::abs(camera.yaw_rate_radps) > kTurns_radps;
  if (!v.hidden()) FollowPictureTime(took_ms, moves, v.ResolutionWished(), &v.resolution);
}

void Visit::Present() {
  if (!impl_->hidden()) impl_->renderer.Present();
}

void Visit::Read(std::vector<uint8_t>* rgb) { impl_->renderer.Read(rgb); }
void Visit::Leave() {
  impl_->Save();
  impl_->NoteVisit();
}
bool Visit::ends() const { return impl_->controls.quits; }
bool Visit::waits_for_visitors() const { return impl_->attracts() && !impl_->operator_page(); }
bool Visit::starts_anew() const { return impl_->starts_anew; }
bool Visit::frees_pointer() const { return impl_->controls.points || impl_->pages() || impl_->attracts(); }
bool Visit::fullscreen() const { return impl_->controls.settings.fullscreen; }
bool Visit::shows_pages() const { return impl_->pages(); }
const FrameStatistics& Visit::statistics() const { return impl_->statistics; }

}  // namespace flaneur
