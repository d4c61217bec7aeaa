// The guided tour: which stop is next, the way there, and how long the visitor rests. Internal to runtime/walk.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/tour_data/tour_data.h"
#include "runtime/walk/route.h"

namespace flaneur {

struct VisitorInTown;

// A tour made shorter, as for a film.
struct TourCut {
  std::vector<float> stops;  // numbers from 1 of those to rest at; the tour ends at the last. Empty: all
  float most_rest_s = 0;     // at a stop; 0: as long as it takes
  float approach_m = 0;      // of the way to each, the rest is skipped; 0: all of it
};

// What is shown and said at a stop, in the visitor's language.
struct StopWords {
  std::string caption;
  int sound = -1;    // index into the tour's sounds; -1: none
  float rest_s = 0;  // how long one stays; 0: passes by
  float read_s = 0;  // in which the caption is read; longer than one stays where the tour's pauses are short
};

struct GuidedTour {
  std::vector<TourStop> stops;
  std::vector<StopWords> words;        // by stop
  std::vector<std::string> languages;  // that there are, the tour's own first
  std::string language;                // that words are in, as far as there are any
  TourCut cut;
  // The way to the next halt, which is a stop to rest at, or the last stop: indices of the stops on it, and a line over
  // the ground.
  std::vector<size_t> stage;
  size_t passed = 0;          // of the stage
  std::vector<float> stop_m;  // by stop of the stage: where it is on the route
  Route route;
  float visitor_m = 0;  // how far along the route the visitor is
  bool resting = false, paused = false, over = false;
  bool holds = false;   // nothing goes on: paused, or the visitor has left the halt
  bool begun = true;    // else it waits where it begins, for somebody to lead
  bool follows = true;  // the tour leads the visitor, who does not walk about freely
  float rested_s = 0;
  float reroute_s = 0;  // until a visitor who strayed is thought of again
  Corner corner;        // of the visitor's way back to the route
  int plans = 0;        // stages and routes so far
};

// What the visitor asks the tour for. Next and back end a pause; for who walks about on their own there is none.
struct TourWish {
  bool next = false, back = false, toggle_pause = false;
  std::optional<size_t> lead_to = std::nullopt;  // a stop, straight from where the visitor is; the tour goes on there
};

inline bool HasTour(const GuidedTour& tour) { return !tour.stops.empty() && !tour.over; }
// The stop where the visitor rests, or to which the present way leads.
inline size_t HaltOf(const GuidedTour& tour) { return tour.stage.empty() ? 0 : tour.stage.back(); }
// What visitors read: the title in this language, else in the pack's own, else its name.
std::string TitleOf(const TourData& tour, const std::string& language);
// What they read at the guided tour's end, likewise; empty where the tour says nothing.
std::string ThanksOf(const TourData& tour, const std::string& language);
// What a stop is called: its caption's first sentence. Empty where it has none.
std::string NameOfStop(const GuidedTour& tour, size_t stop);
// Who is farther from a halt does not hear what is said there, and has left it for now.
inline constexpr float kHears_m = 6;
// How long one rests there: as long as the tour says, else as it takes to read the caption; and until the sound is
// over.
inline float RestOf_s(const GuidedTour& tour, size_t stop) { return tour.words[stop].rest_s; }

// Where the visitor looks there: what there is to see at a halt, else the way on, or at the tour's end the way they
// came.
float LookAt_rad(const GuidedTour& tour, size_t stop);

// The tour's stops and languages. own_language: of the stops' `caption`.
void TakeStops(const std::vector<TourStop>& stops, const std::string& own_language, GuidedTour* tour);
// From now on, before the tour begins. Errors: numbers of stops that there are not, or at which nobody rests.
Error CutTour(const TourCut& cut, GuidedTour* tour);
// Words of a stop that has none in this language are in the tour's own.
void SetLanguage(const std::string& language, GuidedTour* tour);

// Stops that nobody can stand at move beside the wall they are in, those that cannot be reached from where most are,
// are left out; one warning for each of the two.
void PlaceStops(const VisitorInTown& v);
// The first stage, or the end of it where the tour is cut, from where the visitor stands.
void BeginTour(const VisitorInTown& v);

// The tour goes on to where the visitor is now.
void StepTour(const TourWish& wish, bool follows, const VisitorInTown& v);

// The visitor, and the guide with them, is at that stop from now on, and the tour goes on from there.
void JumpToStop(size_t stop, const VisitorInTown& v);

// The way to the next stop is barred: the tour passes it by.
void GiveUpStop(const VisitorInTown& v);

}  // namespace flaneur
