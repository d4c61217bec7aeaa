#include "runtime/walk/guided_tour.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "runtime/crowd/fast_math.h"
#include "runtime/walk/start.h"
#include "runtime/walk/visitor.h"

namespace flaneur {
namespace {

constexpr float kPassed_m = 0.5f;  // before a stop that is only on the way
constexpr float kThere_m = 0.35f,
                kThereFreely_m = 1.8f;  // from a halt: for a visitor whom the tour leads, and who walks freely
constexpr float kStrays_m = 3;          // from the route
constexpr float kReroute_s = 1;
constexpr float kBackwards_m = 2,
                kForwards_m = 4;  // along the route: the visitor is looked for so near where they were
constexpr float kAgain_s = 3;     // back within this goes to the halt before, later to this one's beginning
constexpr float kAfterSound_s = 0.7f;
constexpr float kLooksAfterCut_m = 2.5f;                          // along the way
constexpr float kMinReading_s = 2, kReading_sPerLetter = 0.065f;  // about 15 letters a second, an unhurried reader
constexpr int kLettersOfSign = 3;                                 // a sign of China, Japan or Korea says as much

bool IsHalt(const GuidedTour& t, size_t stop) { return RestOf_s(t, stop) > 0; }

// The halt after `stop`, else the last stop.
size_t HaltFrom(const GuidedTour& t, size_t stop) {
  while (stop + 1 < t.stops.size() && !IsHalt(t, stop)) ++stop;
  return stop;
}

// The halt before `stop`, else the first stop.
size_t HaltBefore(const GuidedTour& t, size_t stop) {
  while (stop > 0 && !IsHalt(t, --stop)) {}
  return stop;
}

// Both ends count; the second may be the lower.
std::vector<size_t> StopsBetween(size_t first, size_t last) {
  std::vector<size_t> stops;
  for (size_t k = first;; k += first <= last ? 1 : size_t(-1)) {
    stops.push_back(k);
    if (k == last) return stops;
  }
}

void Plan(const std::vector<size_t>& stops, const VisitorInTown& v) {
  GuidedTour& t = v.visitor.tour;
  t.stage.clear();
  t.stop_m.clear();
  t.route = {{v.visitor.camera.view.position}, {0}};
  for (size_t k : stops) {
    const size_t from = t.route.points.size() - 1;
    if (!ExtendRoute(v.town.walkable, t.stops[k].position_m, &v.town.crowd.search, &t.route) && k != stops.back())
      continue;
    MakeRoomOnRoute(v.town.walkable, from, &t.route);
    t.stage.push_back(k);
    t.stop_m.push_back(LengthOf_m(t.route));
  }
  t.passed = 0;
  t.visitor_m = t.rested_s = 0;
  t.resting = t.over = false;
  t.corner = {};
  t.reroute_s = kReroute_s;
  ++t.plans;
}

// A cut: the visitor is near the halt at once, and looks along the way there. False where it is not far.
bool SkipWay(const VisitorInTown& v) {
  GuidedTour& t = v.visitor.tour;
  const float skipped_m = LengthOf_m(t.route) - t.cut.approach_m;
  if (t.cut.approach_m <= 0 || skipped_m <= 0) return false;
  ViewCamera& view = v.visitor.camera.view;
  view.position = v.visitor.stuck_at = PointAt(t.route, skipped_m);
  view.yaw_rad = AngleOf(PointAt(t.route, skipped_m + kLooksAfterCut_m) - view.position);
  v.visitor.stuck_s = v.visitor.looks_aside_rad = 0;
  size_t first = 0;
  while (first + 1 < t.stage.size() && t.stop_m[first] < skipped_m) ++first;
  Plan({t.stage.begin() + static_cast<std::ptrdiff_t>(first), t.stage.end()}, v);
  return true;
}

void LeaveHalt(const VisitorInTown& v) {
  GuidedTour& t = v.visitor.tour;
  const size_t next = HaltOf(t) + 1;
  if (next < t.stops.size()) {
    Plan(StopsBetween(next, HaltFrom(t, next)), v);
    if (SkipWay(v)) BringGuide(v);
    return;
  }
  t.resting = false;
  t.over = v.visitor.finished = true;
}

void GoToNext(const VisitorInTown& v) {
  GuidedTour& t = v.visitor.tour;
  if (t.over) return;
  if (t.resting) return LeaveHalt(v);
  const size_t halt = HaltOf(t), here = t.stage[std::min(t.passed, t.stage.size() - 1)];
  if (halt + 1 < t.stops.size()) Plan(StopsBetween(std::min(here, halt), HaltFrom(t, halt + 1)), v);
}

void GoBack(const VisitorInTown& v) {
  GuidedTour& t = v.visitor.tour;
  if (t.resting && t.rested_s > kAgain_s) {
    t.rested_s = 0;
    return;
  }
  v.visitor.finished = false;
  if (t.over) {
    const size_t last = t.stops.size() - 1, halt = IsHalt(t, last) ? last : HaltBefore(t, last);
    return Plan(StopsBetween(last, halt), v);
  }
  const size_t halt = HaltOf(t), here = t.stage[std::min(t.passed, t.stage.size() - 1)];
  const size_t before = HaltBefore(t, halt);
  Plan(StopsBetween(before < here ? here - 1 : here, before), v);
}

float FromVisitor_m(const VisitorInTown& v, Vec2 p) { return Length(p - v.visitor.camera.view.position); }

// The tour does not end while the visitor walks about on their own.
bool MayLeave(const GuidedTour& t) { return t.follows || HaltOf(t) + 1 < t.stops.size(); }

void LeadTo(size_t stop, const VisitorInTown& v) {
  v.visitor.finished = false;
  v.visitor.stuck_s = 0;
  Plan({stop}, v);
}

void Rest(const VisitorInTown& v) {
  GuidedTour& t = v.visitor.tour;
  const TourStop& stop = t.stops[HaltOf(t)];
  t.holds = t.paused || FromVisitor_m(v, stop.position_m) > kHears_m;
  if (!t.holds) t.rested_s += Step_s(v.settings) * std::min(1.0f, v.visitor.comfort.pace);
  if (t.rested_s >= RestOf_s(t, HaltOf(t)) && MayLeave(t)) LeaveHalt(v);
}

// A visitor who comes back to the tour from elsewhere is led on from there.
void Reroute(const VisitorInTown& v) {
  GuidedTour& t = v.visitor.tour;
  t.reroute_s -= Step_s(v.settings);
  if (t.reroute_s > 0) return;
  const std::vector<size_t> left(t.stage.begin() + static_cast<std::ptrdiff_t>(std::min(t.passed, t.stage.size() - 1)),
                                 t.stage.end());
  Plan(left, v);
}

void WalkOn(const VisitorInTown& v) {
  GuidedTour& t = v.visitor.tour;
  const Vec2 p = v.visitor.camera.view.position;
  t.visitor_m = WayTo(t.route, p, t.visitor_m - kBackwards_m, t.visitor_m + kForwards_m);
  while (t.passed + 1 < t.stage.size() && t.visitor_m > t.stop_m[t.passed] - kPassed_m) ++t.passed;
  if (FromVisitor_m(v, t.stops[HaltOf(t)].position_m) < (t.follows ? kThere_m : kThereFreely_m)) {
    t.resting = true;
    if (RestOf_s(t, HaltOf(t)) <= 0 && MayLeave(t)) LeaveHalt(v);
    return;
  }
  const bool strays = Length(PointAt(t.route, t.visitor_m) - p) > kStrays_m;
  const bool is_back =
      t.follows || v.visitor.guide.id < 0 || FromVisitor_m(v, v.town.crowd.position[v.visitor.guide.index]) < kHears_m;
  if (strays && is_back) Reroute(v);
}

// In this language, else in the tour's own; empty in neither.
std::string WordsIn(const std::map<std::string, std::string>& words, const std::string& language,
                    const std::string& own) {
  for (const std::string& wished : {language, own}) {
    const auto found = words.find(wished);
    if (found != words.end() && !found->second.empty()) return found->second;
  }
  return "";
}

// In letters of an alphabet. In UTF-8 those signs, from U+3000 on, begin with 0xe3 or more; what continues a letter
// with 0x80 to 0xbf.
int LengthOf(const std::string& text) {
  int letters = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80 || byte > 0xbf) letters += byte >= 0xe3 ? kLettersOfSign : 1;
  }
  return letters;
}

StopWords WordsOf(const TourStop& stop, const std::string& language, const std::string& own) {
  StopWords words;
  const auto caption = stop.captions.find(language);
  const bool translated = caption != stop.captions.end();
  words.caption = translated ? caption->second : stop.caption;
  auto sound = stop.sounds.find(language);
  if (sound == stop.sounds.end() && !translated) sound = stop.sounds.find(own);  // one language at a time
  if (!words.caption.empty())
    words.read_s = kMinReading_s + kReading_sPerLetter * static_cast<float>(LengthOf(words.caption));
  words.rest_s = stop.pause_s > 0 ? stop.pause_s : words.read_s;
  words.read_s = std::max(words.read_s, words.rest_s);
  if (sound == stop.sounds.end()) return words;
  words.sound = sound->second.sound;
  words.rest_s = std::max(words.rest_s, sound->second.duration_s + kAfterSound_s);
  words.read_s = std::max(words.read_s, sound->second.duration_s);
  return words;
}

}  // namespace

std::string TitleOf(const TourData& tour, const std::string& language) {
  const std::string title = WordsIn(tour.titles, language, tour.language);
  return title.empty() ? tour.name : title;
}

std::string ThanksOf(const TourData& tour, const std::string& language) {
  return WordsIn(tour.thanks, language, tour.language);
}

std::string NameOfStop(const GuidedTour& tour, size_t stop) {
  const std::string& caption = tour.words[stop].caption;
  const size_t end = caption.find_first_of(".!?:\n");
  return end == std::string::npos || end < 3 ? caption : caption.substr(0, end);
}

float LookAt_rad(const GuidedTour& t, size_t stop) {
  const float there_rad = t.stops[stop].yaw_rad.value_or(0);
  if (IsHalt(t, stop) || t.stops.size() < 2) return there_rad;
  const size_t from = std::min(stop, t.stops.size() - 2);
  const Vec2 way = t.stops[from + 1].position_m - t.stops[from].position_m;
  return Length(way) > 0 ? std::atan2(way.y, way.x) : there_rad;
}

void TakeStops(const std::vector<TourStop>& stops, const std::string& own_language, GuidedTour* t) {
  t->stops = stops;
  t->languages = {own_language};
  const auto add = [&](const std::string& language) {
    if (std::find(t->languages.begin(), t->languages.end(), language) == t->languages.end())
      t->languages.push_back(language);
  };
  for (const TourStop& stop : stops) {
    for (const auto& [language, caption] : stop.captions) add(language);
    for (const auto& [language, sound] : stop.sounds) add(language);
  }
  SetLanguage(own_language, t);
}

void SetLanguage(const std::string& language, GuidedTour* t) {
  t->language = language;
  t->words.clear();
  for (const TourStop& stop : t->stops) {
    t->words.push_back(WordsOf(stop, language, t->languages.front()));
    if (t->cut.most_rest_s > 0) t->words.back().rest_s = std::min(t->words.back().rest_s, t->cut.most_rest_s);
  }
}

Error CutTour(const TourCut& cut, GuidedTour* t) {
  size_t last = 0;
  for (const float number : cut.stops) {
    const auto k = static_cast<size_t>(number) - 1;
    if (k >= t->stops.size() || !IsHalt(*t, k))
      return Fail("tour.stops: nobody rests at stop " + std::to_string(k + 1) + " of this tour");
    last = std::max(last, k);
  }
  if (!cut.stops.empty()) t->stops.resize(last + 1);
  for (size_t k = 0; k < t->stops.size() && !cut.stops.empty(); ++k) {
    if (std::find(cut.stops.begin(), cut.stops.end(), static_cast<float>(k + 1)) == cut.stops.end())
      t->stops[k] = {t->stops[k].position_m, t->stops[k].yaw_rad};
  }
  t->cut = cut;
  SetLanguage(t->language, t);
  return Ok();
}

namespace {

int StretchOf(const Walkable& w, int cell) { return cell < 0 ? -1 : w.component[static_cast<size_t>(cell)]; }

// The stretch of ground that most of the cells are on; of equals the one that comes first; -1: none is on any.
int StretchOfMost(const Walkable& w, const std::vector<int>& cells) {
  std::map<int, int> count;
  for (const int cell : cells) ++count[StretchOf(w, cell)];
  int best = -1;
  for (const int cell : cells) {
    const int stretch = StretchOf(w, cell);
    if (stretch >= 0 && (best < 0 || count[stretch] > count[best])) best = stretch;
  }
  return best;
}

// "2", "2 and 3", "2, 3 and 5".
std::string Listed(const std::vector<size_t>& numbers) {
  std::string list;
  for (size_t i = 0; i < numbers.size(); ++i)
    list += (i == 0 ? "" : i + 1 < numbers.size() ? ", " : " and ") + std::to_string(numbers[i]);
  return list;
}

}  // namespace

void PlaceStops(const VisitorInTown& v) {
  const Walkable& w = v.town.walkable;
  const std::vector<TourStop>& stops = v.visitor.tour.stops;
  if (stops.empty()) return;
  std::vector<int> cells;
  for (const TourStop& stop : stops) cells.push_back(FreeCellFor(w, stop.position_m));
  const int stretch = StretchOfMost(w, cells);
  std::vector<TourStop> kept;
  std::vector<size_t> left_out, moved;
  for (size_t k = 0; k < stops.size(); ++k) {
    TourStop stop = stops[k];
    if (stretch < 0 || StretchOf(w, cells[k]) != stretch) {
      left_out.push_back(k + 1);
      continue;
    }
    if (!IsFree(w, stop.position_m)) {
      moved.push_back(k + 1);
      stop.position_m = CellCenter(w, cells[k]);
    }
    if (!stop.yaw_rad) stop.yaw_rad = BestView_rad(w, stop.position_m);
    kept.push_back(std::move(stop));
  }
  if (moved.size() == 1)
    v.town.warnings.push_back("stop " + Listed(moved) + " is not on free ground; the tour passes near it");
  if (moved.size() > 1)
    v.town.warnings.push_back("stops " + Listed(moved) + " are not on free ground; the tour passes near them");
  if (left_out.size() == 1)
    v.town.warnings.push_back("stop " + Listed(left_out) + " cannot be reached; the tour passes it by");
  if (left_out.size() > 1)
    v.town.warnings.push_back("stops " + Listed(left_out) + " cannot be reached; the tour passes them by");
  TakeStops(kept, std::string(v.visitor.tour.languages.front()), &v.visitor.tour);
}

void BeginTour(const VisitorInTown& v) {
  if (v.visitor.tour.stops.empty()) return;
  Plan(StopsBetween(0, HaltFrom(v.visitor.tour, 0)), v);
  SkipWay(v);
}

void StepTour(const TourWish& wish, bool follows, const VisitorInTown& v) {
  GuidedTour& t = v.visitor.tour;
  if (t.stops.empty() || !t.begun) return;
  if (t.follows != follows) v.visitor.stuck_s = 0;  // what held them up is of the walk before
  t.follows = follows;
  if (wish.toggle_pause) t.paused = !t.paused;
  if (!follows || t.over || wish.next || wish.back || wish.lead_to) t.paused = false;
  if (wish.next) GoToNext(v);
  if (wish.back) GoBack(v);
  if (wish.lead_to && *wish.lead_to < t.stops.size()) LeadTo(*wish.lead_to, v);
  if (t.over) return;
  if (t.resting) Rest(v);
  else WalkOn(v);
}

void JumpToStop(size_t stop, const VisitorInTown& v) {
  GuidedTour& t = v.visitor.tour;
  if (stop >= t.stops.size()) return;
  v.visitor.camera.view.position = v.visitor.stuck_at = t.stops[stop].position_m;
  v.visitor.camera.view.yaw_rad = LookAt_rad(t, stop);
  v.visitor.camera.pitch_rad = v.visitor.looks_about_s = v.visitor.stuck_s = 0;
  v.visitor.point_walk = {};
  v.visitor.finished = t.paused = t.holds = false;
  t.begun = true;
  Plan(StopsBetween(stop, HaltFrom(t, stop)), v);
  BringGuide(v);
}

void GiveUpStop(const VisitorInTown& v) {
  GuidedTour& t = v.visitor.tour;
  if (t.passed + 1 >= t.stage.size()) return LeaveHalt(v);
  Plan({t.stage.begin() + static_cast<std::ptrdiff_t>(t.passed) + 1, t.stage.end()}, v);
}

}  // namespace flaneur
