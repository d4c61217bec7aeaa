#include "runtime/web/page_visit.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "runtime/render/renderer.h"
#include "runtime/show/frame_from_simulation.h"
#include "runtime/show/guide_figure.h"
#include "runtime/visit/controls.h"
#include "runtime/visit/loading.h"
#include "runtime/visit/phrases.h"
#include "runtime/visit/resolution.h"
#include "runtime/walk/staging.h"

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
constexpr int kMaxStepsPerFrame = 4;                   // a machine that cannot keep up slows the town down

}  // namespace

struct PageVisit::Impl {
  std::vector<uint8_t> bytes;  // until the file is open
  ByteRanges there;
  TourPack pack;
  std::vector<LateFile> late;  // of the pack's
  Loader loader;
  Simulation s;
  Renderer renderer;
  Controls controls;
  PersonLooks looks;
  FrameInput frame;
  CameraInput wishes;
  FrameStatistics statistics;
  Resolution resolution;
  bool open = false;
  double owed_s = 0;
  int64_t pictures = 0;

  ResolutionSettings ResolutionWished() const {
    return ResolutionFor(controls.settings.frames_per_s, controls.settings.least_resolution_scale, s.control.settings);
  }
  void Step(float passed_s);
  void Draw(int width_px, int height_px);
};

PageVisit::PageVisit() : impl_(std::make_unique<Impl>()) {}
PageVisit::~PageVisit() = default;

void PageVisit::Expect(size_t bytes) { impl_->bytes.resize(bytes); }

Error PageVisit::Arrive(size_t offset, std::span<const uint8_t> bytes) {
  Impl& v = *impl_;
  if (v.open) {
    Fill(offset, bytes, &v.late);
    return v.loader.Arrive(offset, bytes);
  }
  if (offset > v.bytes.size() || bytes.size() > v.bytes.size() - offset)
    return Fail("a piece lies beyond the tour's end");
  std::copy(bytes.begin(), bytes.end(), v.bytes.begin() + static_cast<std::ptrdiff_t>(offset));
  v.there.Add({offset, bytes.size()});
  return Ok();
}

Error PageVisit::Open() {
  Impl& v = *impl_;
  PackFile file;
  if (Error e = file.Open(std::move(v.bytes), std::move(v.there), "the tour", &v.pack)) return e;
  AddGuideFigure(&v.pack);
  AddLate(v.pack.sound_ranges, &v.pack.sounds, &v.late);
  AddLate(v.pack.picture_ranges, &v.pack.pictures, &v.late);
  if (Error e = StartSimulation(&v.pack, ScenarioOf(v.pack), &v.s)) return e;
  v.loader.Start(std::move(file), v.pack);
  v.open = true;
  PlayerSettings settings;
  settings.pointer = "point";
  v.controls = MakeControls(settings, {}, v.s);
  return Ok();
}

Error PageVisit::Begin() {
  if (Error e = impl_->renderer.Begin(impl_->pack, {.onto_window = true, .runs_ahead = true})) return e;
  impl_->loader.PrepareFor(impl_->renderer);
  return Ok();
}

Error PageVisit::Load(bool* there) {
  Impl& v = *impl_;
  if (v.loader.TownIsThere()) v.loader.GoOn();
  *there = v.loader.LikenessesAreThere();
  return *there ? Ok() : v.loader.Upload(kLongUpload_ms, &v.renderer);
}

void PageVisit::Impl::Step(float passed_s) {
  const double step_s = static_cast<double>(Step_s(s));
  owed_s = std::min(owed_s + static_cast<double>(passed_s), step_s * kMaxStepsPerFrame);
  if (owed_s >= step_s) controls.turned_rad = 0;
  for (; owed_s >= step_s; owed_s -= step_s) {
    StepSimulation(NextStep(wishes, s, &controls), passed_s * 1000, &s);
    wishes.tour = {};
    wishes.walk_to.reset();
  }
}

void PageVisit::Impl::Draw(int width_px, int height_px) {
  const float share = static_cast<float>(owed_s) / Step_s(s);
  FrameFromSimulation(pack, s, &looks, &frame,
                      {share, TurnUntil(share, s, controls), controls.turned_rad, LookUntilNow(s, controls)});
  frame.resolution_scale = ScaleNow(ResolutionWished(), resolution);
  frame.detail = DetailNow(ResolutionWished(), resolution);
  renderer.Draw(frame, width_px, height_px, &statistics);
  renderer.Present();
  ++pictures;
}

Error PageVisit::Picture(const WindowInput& input, int width_px, int height_px, float passed_s) {
  Impl& v = *impl_;
  if (Error e = v.loader.Upload(kUpload_ms, &v.renderer)) return e;
  if (width_px <= 0 || height_px <= 0) return Ok();
  SetPictureSize(width_px, height_px, &v.s);
  TakeInput(input, passed_s, static_cast<float>(width_px) / static_cast<float>(height_px), false, v.s, &v.controls,
            &v.wishes);
  v.Step(passed_s);
  v.Draw(width_px, height_px);
  v.loader.GoOn();
  return Ok();
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
  flaneur::SetLanguage(language, &impl_->s.visitor.tour);
}

void PageVisit::GoToStop(size_t stop) {
  Impl& v = *impl_;
  if (stop >= v.s.visitor.tour.stops.size()) return;
  JumpToStop(stop, InTown(&v.s));
  v.controls.follows_tour = true;
  v.looks = {};
}

void PageVisit::TakeTour(bool follows) { impl_->controls.follows_tour = follows; }

void PageVisit::Pause(bool pauses) {
  if (impl_->s.visitor.tour.paused != pauses) impl_->wishes.tour.toggle_pause = true;
}

void PageVisit::WidenView(float factor) {
  constexpr float kLeast_rad = 30 * kPi / 180, kMost_rad = 110 * kPi / 180;
  Simulation& s = impl_->s;
  SetFieldOfView(std::clamp(s.visitor.camera.view.fov_rad * factor, kLeast_rad, kMost_rad), &s);
}

std::span<const uint8_t> PageVisit::Sound(size_t sound) const {
  const std::vector<std::vector<uint8_t>>& all = impl_->pack.sounds;
  return sound < all.size() ? std::span<const uint8_t>(all[sound]) : std::span<const uint8_t>();
}

std::string PageVisit::State() const {
  const Impl& v = *impl_;
  const GuidedTour& tour = v.s.visitor.tour;
  const CameraState& camera = v.s.visitor.camera;
  nlohmann::json state{{"caption", v.frame.caption},
                       {"language", tour.language},
                       {"stop", tour.stops.empty() ? -1 : static_cast<int>(HaltOf(tour))},
                       {"resting", tour.resting},
                       {"sound", tour.resting && !tour.stops.empty() ? tour.words[HaltOf(tour)].sound : -1},
                       {"over", tour.over},
                       {"paused", tour.paused},
                       {"follows_tour", v.controls.follows_tour},
                       {"pictures", v.pictures},
                       {"people_drawn", v.statistics.people_drawn},
                       {"resolution_scale", v.statistics.resolution_scale},
                       {"place_m", {camera.view.position.x, camera.view.position.y}},
                       {"yaw_rad", camera.view.yaw_rad},
                       {"pitch_rad", camera.pitch_rad},
                       {"fov_rad", camera.view.fov_rad},
                       {"complete", v.loader.Done()}};
  return state.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string PageVisit::Words(const std::string& language) const {
  nlohmann::json phrases, actions, languages = nlohmann::json::object();
  for (size_t k = 0; k < static_cast<size_t>(Phrase::kCount); ++k)
    phrases[kPhraseNames[k]] = Say(static_cast<Phrase>(k), language);
  for (size_t k = 0; k < kActions; ++k) actions[kActionNames[k]] = NameOf(static_cast<Action>(k), language);
  for (const std::string& each : impl_->s.visitor.tour.languages) languages[each] = LanguageName(each);
  const std::string thanks = ThanksOf(impl_->pack, language);
  const nlohmann::json words{{"phrases", phrases},
                             {"actions", actions},
                             {"languages", languages},
                             {"thanks", thanks.empty() ? Say(Phrase::kThanks, language) : thanks}};
  return words.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string PageVisit::Description() const {
  const Impl& v = *impl_;
  const GuidedTour& tour = v.s.visitor.tour;
  nlohmann::json stops = nlohmann::json::array();
  for (size_t k = 0; k < tour.stops.size(); ++k)
    stops.push_back({{"name", NameOfStop(tour, k)}, {"halt", RestOf_s(tour, k) > 0}});
  nlohmann::json described{{"title", TitleOf(v.pack, tour.language)}, {"languages", tour.languages}, {"stops", stops}};
  return described.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace flaneur
