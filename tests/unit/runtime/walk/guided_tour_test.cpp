#include "runtime/walk/guided_tour.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "runtime/crowd/fast_math.h"
#include "tests/unit/runtime/simulation/box_obstacle.h"
#include "tests/unit/runtime/simulation/tour_town.h"

namespace flaneur {
namespace {

void Step(Simulation* s, int steps) {
  for (int k = 0; k < steps; ++k) StepSimulation({}, 0, s);
}

void Ask(const TourWish& wish, Simulation* s) {
  CameraInput input;
  input.tour = wish;
  StepSimulation(input, 0, s);
}

// The stop that the visitor comes to next; the number of stops where none.
size_t NextRest(Simulation* s) {
  for (int step = 0; step < 30 * 120 && !s->visitor.finished; ++step) {
    StepSimulation({}, 0, s);
    if (s->visitor.tour.resting) return HaltOf(s->visitor.tour);
  }
  return s->visitor.tour.stops.size();
}

class Tours : public ::testing::TestWithParam<const char*> {
 protected:
  TourPack Town() const {
    TourPack pack = TourTown(30);
    pack.guide = GetParam();
    return pack;
  }
};

TEST_P(Tours, RestAtEveryHaltForItsTime) {
  Simulation s = Started(Town());
  std::vector<size_t> halts;
  int resting = 0;
  for (int step = 0; step < 30 * 300 && !s.visitor.finished; ++step) {
    StepSimulation({}, 0, &s);
    if (!s.visitor.tour.resting) continue;
    ++resting;
    EXPECT_LT(Length(s.visitor.camera.view.position - s.visitor.tour.stops[HaltOf(s.visitor.tour)].position_m), 0.5f);
    if (halts.empty() || halts.back() != HaltOf(s.visitor.tour)) halts.push_back(HaltOf(s.visitor.tour));
  }
  EXPECT_EQ(halts, (std::vector<size_t>{1, 3, 5}));
  EXPECT_NEAR(static_cast<float>(resting) / 30, 9, 0.3f);
}

TEST_P(Tours, APauseHoldsEverythingUntilItEnds) {
  Simulation s = Started(Town());
  ASSERT_EQ(NextRest(&s), 1u);
  Ask({false, false, true}, &s);
  Step(&s, 300);
  EXPECT_TRUE(s.visitor.tour.resting);
  EXPECT_LT(s.visitor.tour.rested_s, 1);
  Ask({false, false, true}, &s);
  Step(&s, 150);
  EXPECT_FALSE(s.visitor.tour.resting);
  Ask({false, false, true}, &s);
  Step(&s, 60);
  const Vec2 here = s.visitor.camera.view.position;
  Step(&s, 60);
  EXPECT_LT(Length(s.visitor.camera.view.position - here), 0.05f) << "walks on though paused";
}

TEST_P(Tours, NextLeavesAHaltAndPassesOneBy) {
  Simulation s = Started(Town());
  ASSERT_EQ(NextRest(&s), 1u);
  Ask({true, false, false}, &s);
  EXPECT_FALSE(s.visitor.tour.resting);
  EXPECT_EQ(HaltOf(s.visitor.tour), 3u);
  Ask({true, false, false}, &s);
  EXPECT_EQ(NextRest(&s), 5u);
  Ask({true, false, false}, &s);
  EXPECT_TRUE(s.visitor.finished);
  Ask({true, false, false}, &s);
  EXPECT_TRUE(s.visitor.finished);
}

TEST_P(Tours, BackLeadsToTheHaltBeforeOrToThisOnesBeginning) {
  Simulation s = Started(Town());
  ASSERT_EQ(NextRest(&s), 1u);
  ASSERT_FALSE(s.visitor.finished);
  Step(&s, 95);
  ASSERT_EQ(NextRest(&s), 3u);
  Ask({false, true, false}, &s);
  EXPECT_EQ(HaltOf(s.visitor.tour), 1u);
  EXPECT_EQ(NextRest(&s), 1u);
  EXPECT_EQ(NextRest(&s), 1u);
  for (int step = 0; step < 30 * 60 && !(s.visitor.tour.resting && HaltOf(s.visitor.tour) == 3); ++step) Step(&s, 1);
  EXPECT_EQ(HaltOf(s.visitor.tour), 3u) << "goes on afterwards";
}

TEST_P(Tours, BackAfterTheEndReturnsToTheLastHalt) {
  Simulation s = Started(Town());
  for (int step = 0; step < 30 * 300 && !s.visitor.finished; ++step) Step(&s, 1);
  ASSERT_TRUE(s.visitor.finished);
  Ask({false, true, false}, &s);
  EXPECT_FALSE(s.visitor.finished);
  EXPECT_EQ(NextRest(&s), 5u);
}

TEST_P(Tours, AVisitorWhoLeftAndComesBackIsLedOn) {
  TourPack pack = Town();
  pack.path[1].pause_s = 8;
  Simulation s = Started(pack);
  ASSERT_EQ(NextRest(&s), 1u);
  CameraInput away;
  away.active = true;
  away.direction = {-0.8f, -0.6f};
  away.speed_mps = 1.5f;
  for (int step = 0; step < 240; ++step) StepSimulation(away, 0, &s);
  EXPECT_TRUE(s.visitor.tour.resting);
  EXPECT_LT(s.visitor.tour.rested_s, 6) << "the halt does not run out while the visitor is away";
  for (int step = 0; step < 30 * 200 && !s.visitor.finished; ++step) Step(&s, 1);
  EXPECT_TRUE(s.visitor.finished);
}

// The times at which the visitor rests at each stop, and the whole tour's.
struct Rests {
  std::vector<std::pair<size_t, float>> of_stop_s;
  float whole_s = 0, way_m = 0;
  bool captions = true;
};

Rests WatchRests(Simulation* s) {
  Rests rests;
  Vec2 before = s->visitor.camera.view.position;
  for (int step = 0; step < 30 * 400 && !s->visitor.finished; ++step) {
    StepSimulation({}, 0, s);
    rests.way_m += s->visitor.camera.actual_mps / 30;
    before = s->visitor.camera.view.position;
    EXPECT_FALSE(InsideObstacle(s->town.walkable, before)) << step;
    const GuidedTour& t = s->visitor.tour;
    if (!t.resting) continue;
    if (rests.of_stop_s.empty() || rests.of_stop_s.back().first != HaltOf(t)) rests.of_stop_s.push_back({HaltOf(t), 0});
    rests.of_stop_s.back().second += 1.0f / 30;
    rests.captions = rests.captions && !t.words[HaltOf(t)].caption.empty();
  }
  EXPECT_TRUE(s->visitor.finished);
  rests.whole_s = Time_s(*s);
  return rests;
}

TEST_P(Tours, CutShortRestAtTheStopsThatWereAskedForAlone) {
  const TourPack pack = Town();
  Scenario scenario = ScenarioOf(pack);
  Simulation whole, cut;
  ASSERT_EQ(StartSimulation(&pack, scenario, &whole).message, "");
  scenario.tour = {{2, 6}, 1.5f, 8};
  ASSERT_EQ(StartSimulation(&pack, scenario, &cut).message, "");
  const Rests all = WatchRests(&whole), some = WatchRests(&cut);
  EXPECT_EQ(all.of_stop_s.size(), 3u);
  ASSERT_EQ(some.of_stop_s.size(), 2u);
  EXPECT_EQ(some.of_stop_s[0].first, 1u);
  EXPECT_EQ(some.of_stop_s[1].first, 5u);
  for (const auto& [stop, rest_s] : some.of_stop_s) EXPECT_NEAR(rest_s, 1.5f, 0.1f);
  EXPECT_TRUE(some.captions);
  EXPECT_LT(some.way_m, 20);
  EXPECT_GT(some.way_m, 12) << "something is walked to each";
  EXPECT_LT(some.whole_s, all.whole_s / 2);
}

TEST(Tour, CannotBeCutToStopsWhereNobodyRests) {
  const TourPack pack = TourTown(5);
  Scenario scenario = ScenarioOf(pack);
  Simulation s;
  for (const float stop : {1.0f, 3.0f, 7.0f}) {
    scenario.tour.stops = {stop};
    EXPECT_NE(StartSimulation(&pack, scenario, &s).message.find("nobody rests at stop"), std::string::npos) << stop;
  }
}

TEST(Tour, TurnsToWhereItGoesBeforeItWalks) {
  TourPack pack = TourTown(0);
  pack.guide.clear();
  Simulation s = Started(pack);
  ASSERT_EQ(NextRest(&s), 1u);
  Ask({true, false, false}, &s);
  ASSERT_EQ(NextRest(&s), 3u);
  Ask({false, true, false}, &s);  // back, from where the way on is looked along
  float aside_m = 0;
  for (int step = 0; step < 150; ++step) {
    StepSimulation({}, 0, &s);
    const CameraState& c = s.visitor.camera;
    if (Dot(c.velocity, DirectionOf(c.view.yaw_rad)) < 0.5f * Length(c.velocity))
      aside_m += Length(c.velocity) * Step_s(s);
  }
  EXPECT_LT(aside_m, 1.3f);
}

// A house stands between the stops, and a passage of 1.6 m leads to the last.
TEST(Tour, KeepsOffWallsWhereThereIsRoom) {
  TourPack pack = TourTown(0);
  pack.guide.clear();
  pack.obstacles.polygons = {Box({24, 10}, {36, 22}), Box({0, 30}, {29.2f, 33}), Box({30.8f, 30}, {60, 33})};
  const auto stop = [](Vec2 at, float pause_s) {
    TourStop made;
    made.position_m = at, made.pause_s = pause_s;
    return made;
  };
  pack.path = {stop({20, 6}, 1), stop({40, 26}, 1), stop({20, 26}, 1), stop({30, 37}, 1)};
  Simulation s = Started(pack);
  const auto to_house_m = [](Vec2 p) {
    return Length(Vec2{std::max(std::abs(p.x - 30) - 6, 0.0f), std::max(std::abs(p.y - 16) - 6, 0.0f)});
  };
  float nearest_m = 100;
  for (int step = 0; step < 30 * 200 && !s.visitor.finished; ++step) {
    StepSimulation({}, 0, &s);
    nearest_m = std::min(nearest_m, to_house_m(s.visitor.camera.view.position));
  }
  EXPECT_TRUE(s.visitor.finished) << "the passage is not walked through";
  EXPECT_GT(nearest_m, 1.0f) << "0.4 m by the shortest way";
}

TEST(Tour, NobodyGoesOnStandingBeforeWhatIsShown) {
  TourPack pack = TourTown(30);
  Simulation s = Started(pack);
  ASSERT_EQ(NextRest(&s), 1u);
  const TourStop& stop = s.visitor.tour.stops[1];
  Crowd& c = s.town.crowd;
  const size_t somebody = s.visitor.guide.index == 0 ? 1 : 0;
  c.position[somebody] = stop.position_m + DirectionOf(*stop.yaw_rad) * 2.0f;
  c.wait_s[somebody] = 40;
  Step(&s, 2);
  EXPECT_LT(c.wait_s[somebody], 1);
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutGuide, Tours, ::testing::Values("monk", ""),
                         [](const auto& which) { return std::string(which.param).empty() ? "alone" : "guided"; });

// Who wrote the tour said only where to stop: nobody is left before a wall.
TEST(Tour, AStopThatSaysNoDirectionLooksOverOpenGroundToTheTown) {
  for (const Vec2 at : {Vec2{28, 10}, Vec2{28, 32}, Vec2{11, 15}, Vec2{41, 20}, Vec2{58, 38}, Vec2{30, 19.5f}}) {
    TourPack pack = TourTown(0);
    pack.guide.clear();
    pack.path = {Halt(at, 0, 3), Halt({20, 6}, 0, 3)};
    pack.path[0].yaw_rad.reset();
    const Simulation s = Started(pack);
    const Vec2 ahead = DirectionOf(s.visitor.camera.view.yaw_rad);
    for (float far_m = 0; far_m < 10; far_m += 0.5f)
      EXPECT_TRUE(IsFree(s.town.walkable, s.visitor.tour.stops[0].position_m + ahead * far_m))
          << at.x << ' ' << at.y << ": " << far_m;
    EXPECT_GT(Dot(ahead, Vec2{30, 20} - at), -5) << at.x << ' ' << at.y << ": away from the town";
  }
  EXPECT_FLOAT_EQ(*Started(TourTown(0)).visitor.tour.stops[1].yaw_rad, kPi / 2) << "who says one has it";
}

// A plain with all of the town's mass far in the south, and one row of houses in sight in the north.
TEST(Tour, AStopThatSaysNoDirectionLooksToWhatIsToBeSeenNotOverAnEmptyPlain) {
  TourPack pack = TourTown(0);
  pack.guide.clear();
  pack.ground = Share({{0, 0}, 1, 400, 400, std::vector<float>(160000, 0), std::vector<uint8_t>(160000, 3)});
  pack.places.clear();
  pack.obstacles.polygons = {Box({100, 5}, {300, 40}), Box({170, 352}, {230, 360})};
  for (const float near_m : {7.0f, 2.5f}) {  // a wall in the west
    pack.obstacles.polygons.resize(2);
    pack.obstacles.polygons.push_back(Box({180 - near_m, 290}, {179 - near_m, 325}));
    pack.path = {Halt({180, 310}, 0, 3), Halt({200, 300}, 0, 3)};
    pack.path[0].yaw_rad.reset();
    const Simulation s = Started(pack);
    EXPECT_GT(DirectionOf(s.visitor.camera.view.yaw_rad).y, 0.7f) << near_m;
  }
}

TourStop Spoken() {
  TourStop stop;
  stop.caption = "The well has never run dry.";
  stop.captions = {{"de", "Der Brunnen ist nie versiegt."}, {"fr", "Le puits."}};
  stop.sounds = {{"en", {0, 9}}, {"de", {1, 12}}};
  return stop;
}

TEST(Tour, IsCalledByItsTitleInTheVisitorsLanguageOrElseItsOwn) {
  TourPack pack;
  pack.name = "markt", pack.language = "de";
  EXPECT_EQ(TitleOf(pack, "en"), "markt");
  pack.titles = {{"de", "Der Markt"}, {"en", "The Market"}};
  EXPECT_EQ(TitleOf(pack, "en"), "The Market");
  EXPECT_EQ(TitleOf(pack, "fr"), "Der Markt");
}

TEST(Tour, SpeaksTheVisitorsLanguageOrElseItsOwn) {
  GuidedTour tour;
  TakeStops({Spoken()}, "en", &tour);
  EXPECT_EQ(tour.languages, (std::vector<std::string>{"en", "de", "fr"}));
  EXPECT_EQ(tour.words[0].caption, "The well has never run dry.");
  EXPECT_EQ(tour.words[0].sound, 0);
  SetLanguage("de", &tour);
  EXPECT_EQ(tour.words[0].caption, "Der Brunnen ist nie versiegt.");
  EXPECT_EQ(tour.words[0].sound, 1);
  SetLanguage("fr", &tour);
  EXPECT_EQ(tour.words[0].caption, "Le puits.");
  EXPECT_EQ(tour.words[0].sound, -1) << "not two languages at once";
  SetLanguage("it", &tour);
  EXPECT_EQ(tour.words[0].caption, "The well has never run dry.");
  EXPECT_EQ(tour.words[0].sound, 0);
}

TEST(Tour, RestsUntilEverythingIsReadAndHeard) {
  GuidedTour tour;
  TourStop waypoint, read = Spoken(), paused = Spoken();
  read.sounds.clear();
  paused.pause_s = 20;
  TakeStops({waypoint, read, Spoken(), paused}, "en", &tour);
  EXPECT_EQ(RestOf_s(tour, 0), 0);
  EXPECT_GT(RestOf_s(tour, 1), 3);
  EXPECT_LT(RestOf_s(tour, 1), 6);
  EXPECT_GT(RestOf_s(tour, 2), 9);
  EXPECT_EQ(RestOf_s(tour, 3), 20);
}

TEST(GuidedTour, CaptionsAreReadInAsMuchTimeInEveryScript) {
  GuidedTour tour;
  std::vector<TourStop> stops(4);
  stops[0].caption = "The well has never run dry.";
  stops[1].caption = "यह कुआँ कभी नहीं सूखा है।";
  stops[2].caption = "Το πηγάδι δεν στέρεψε ποτέ.";
  stops[3].caption = "这口井从未干涸过。";
  TakeStops(stops, "en", &tour);
  for (size_t k = 1; k < stops.size(); ++k) EXPECT_NEAR(RestOf_s(tour, k), RestOf_s(tour, 0), 0.4f) << k;
}

TEST(Tour, AnUnknownLanguageIsNamedWithTheKnownOnes) {
  TourPack pack = TourTown(5);
  pack.path[1].captions["de"] = "Etwas.";
  Scenario scenario = ScenarioOf(pack);
  scenario.language = "nl";
  Simulation s;
  ASSERT_EQ(StartSimulation(&pack, scenario, &s).message, "");
  ASSERT_EQ(s.town.warnings.size(), 1u);
  EXPECT_NE(s.town.warnings[0].find("'nl'; there is: en, de"), std::string::npos) << s.town.warnings[0];
  scenario.language = "de";
  ASSERT_EQ(StartSimulation(&pack, scenario, &s).message, "");
  EXPECT_TRUE(s.town.warnings.empty());
  EXPECT_EQ(s.visitor.tour.words[1].caption, "Etwas.");
}

}  // namespace
}  // namespace flaneur
