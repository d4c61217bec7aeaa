// The guided tour under hands that press its keys in any order: wherever they leave it, going on goes on, the next stop
// is reached, and the foot of the picture says nothing that is not so.
#include <gtest/gtest.h>

#include <random>

#include "runtime/visit/controls.h"
#include "runtime/visit/notices.h"
#include "runtime/visit/phrases.h"
#include "tests/unit/runtime/simulation/tour_town.h"

namespace flaneur {
namespace {

constexpr float kAspect = 16.0f / 9;
constexpr float kGoesOnWithin_s = 8;  // the guide may have to come first
constexpr float kReachedWithin_s = 120;
constexpr int kVisits = 60, kMostActs = 14;

// Each stop with a name of its own.
TourPack NamedStops(int people, const char* guide) {
  TourPack pack = TourTown(people);
  pack.guide = guide;
  for (size_t k = 0; k < pack.path.size(); ++k) {
    if (!pack.path[k].caption.empty()) pack.path[k].caption = "Stop " + std::to_string(k) + ". Something to see.";
  }
  return pack;
}

class TourHands {
 public:
  TourHands(uint64_t seed, const char* guide) : random_(seed), s_(Started(NamedStops(25, guide))) {
    controls_ = MakeControls({}, {}, s_);
    BeginHint(controls_, s_, &notices_);
  }

  void Picture(const WindowInput& input) {
    TakeInput(input, Step_s(s_), kAspect, false, s_, &controls_, &wishes_);
    StepSimulation(NextStep(wishes_, s_, &controls_), 0, &s_);
    wishes_.tour = {};
    wishes_.walk_to.reset();
    FollowNotices(controls_, s_, Step_s(s_), &notices_);
    ExpectTruth();
  }
  void Hold(const char* key, float seconds) {
    WindowInput input;
    if (key != nullptr) input.down.set(static_cast<size_t>(InputCode(key)));
    for (float left_s = seconds; left_s > 0; left_s -= Step_s(s_)) Picture(input);
  }
  void Tap(const char* key) {
    Hold(key, Step_s(s_));
    Hold(nullptr, Step_s(s_));
  }
  void Act() {
    static constexpr const char* kKeys[] = {"space", "tab", "n", "b"};
    const int act = Below(10);
    if (act < 6) Tap(kKeys[Below(4)]);
    else if (act == 6) Hold(Below(2) ? "w" : "s", Between(0.1f, 6));
    else if (act == 7) Hold("left", Between(0.1f, 2));
    else if (act == 8) Click();
    Hold(nullptr, Below(3) ? Between(0, 1) : Between(0, 12));
  }
  void Click() {
    WindowInput input;
    input.clicks = {{Between(0, 1), Between(0.4f, 1)}};
    Picture(input);
  }

  // What the foot of the picture says can be relied on.
  void ExpectTruth() const {
    FrameInput frame;
    ShowNotice(notices_, false, false, &frame);
    const std::string& said = frame.caption;
    const GuidedTour& t = s_.visitor.tour;
    const bool led = controls_.follows_tour;
    const auto says = [&](Phrase phrase) {
      const std::string words = Say(phrase, "en");
      return !said.empty() && said.rfind(words.substr(0, words.find('%')), 0) == 0;
    };
    const bool goes = led && !t.paused && !t.over;
    const bool is_so = says(Phrase::kTourPaused)   ? t.paused && led
                       : says(Phrase::kTourLeft)   ? !led
                       : says(Phrase::kNextStop)   ? goes && said.ends_with(NameOfStop(t, HaltOf(t)))
                       : says(Phrase::kTourGoesOn) ? goes
                                                   : true;
    EXPECT_TRUE(is_so) << said;
  }

  // As the foot of the picture, or the pages, say that it is done.
  void GoOn() {
    if (!controls_.follows_tour) Tap("tab");
    if (s_.visitor.tour.paused) Tap("space");
  }
  bool GetsOnWithin(float seconds) {
    const Vec2 from = s_.visitor.camera.view.position;
    const int plans = s_.visitor.tour.plans;
    const float rested_s = s_.visitor.tour.rested_s;
    for (float left_s = seconds; left_s > 0; left_s -= Step_s(s_)) {
      Picture({});
      const GuidedTour& t = s_.visitor.tour;
      if (t.over || t.plans != plans || Length(s_.visitor.camera.view.position - from) > 0.3f) return true;
      if (t.resting && t.rested_s > rested_s + 0.3f) return true;
    }
    return false;
  }
  // The stop that pressing next is for: past the one that the visitor is at or on the way to, if there is one.
  size_t NextOne() const {
    static constexpr size_t kHalts[] = {1, 3, 5};
    const GuidedTour& t = s_.visitor.tour;
    for (const size_t halt : kHalts) {
      if (halt > HaltOf(t)) return halt;
    }
    return t.resting ? t.stops.size() : HaltOf(t);
  }
  // The number of stops: the tour's end.
  bool Reaches(size_t stop) {
    for (float left_s = kReachedWithin_s; left_s > 0; left_s -= Step_s(s_)) {
      const GuidedTour& t = s_.visitor.tour;
      if (t.over ? stop == t.stops.size() : t.resting && HaltOf(t) == stop) return true;
      Picture({});
    }
    return false;
  }

  int Below(int end) { return static_cast<int>(random_() % static_cast<uint64_t>(end)); }
  float Between(float least, float most) { return std::uniform_real_distribution<float>(least, most)(random_); }
  bool over() const { return s_.visitor.tour.over; }

 private:
  std::mt19937_64 random_;
  Simulation s_;
  Controls controls_;
  CameraInput wishes_;
  Notices notices_;
};

class TourStates : public ::testing::TestWithParam<const char*> {};

TEST_P(TourStates, GoingOnGoesOnWhereverItWasLeft) {
  for (uint64_t seed = 1; seed <= kVisits; ++seed) {
    TourHands hands(seed, GetParam());
    for (int acts = 1 + hands.Below(kMostActs); acts > 0 && !hands.over(); --acts) hands.Act();
    if (hands.over()) continue;
    hands.GoOn();
    EXPECT_TRUE(hands.GetsOnWithin(kGoesOnWithin_s)) << "seed " << seed;
    if (HasFailure()) return;
  }
}

TEST_P(TourStates, NextReachesTheNextStopWhereverItIsPressed) {
  for (uint64_t seed = 1; seed <= kVisits; ++seed) {
    TourHands hands(seed + 1000, GetParam());
    for (int acts = 1 + hands.Below(kMostActs); acts > 0 && !hands.over(); --acts) hands.Act();
    if (hands.over()) continue;
    const size_t next = hands.NextOne();
    hands.Tap("n");
    EXPECT_TRUE(hands.Reaches(next)) << "stop " << next << ", seed " << seed;
    if (HasFailure()) return;
  }
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutGuide, TourStates, ::testing::Values("monk", ""),
                         [](const auto& which) { return std::string(which.param).empty() ? "alone" : "guided"; });

}  // namespace
}  // namespace flaneur
