#include "runtime/walk/guide.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "runtime/crowd/fast_math.h"
#include "runtime/walk/staging.h"
#include "tests/unit/runtime/simulation/tour_town.h"

namespace flaneur {
namespace {

constexpr int kMaxSteps = 30 * 300;
constexpr float kFarthest_m = 10.2f;  // the lead, 4 m for a visitor who is held up, and what stopping takes

Vec2 GuideOf(const Simulation& s) { return s.town.crowd.position[s.visitor.guide.index]; }
float Apart_m(const Simulation& s) { return Length(GuideOf(s) - s.visitor.camera.view.position); }

float OffVisitor_rad(const Simulation& s) {
  const Vec2 way = s.visitor.camera.view.position - GuideOf(s);
  return std::abs(WrapAngle(s.town.crowd.heading_rad[s.visitor.guide.index] - std::atan2(way.y, way.x)));
}

void Step(Simulation* s, int steps, const CameraInput& input = {}) {
  for (int k = 0; k < steps; ++k) StepSimulation(input, 0, s);
}

CameraInput Walking(Vec2 direction) {
  CameraInput input;
  input.active = true;
  input.direction = direction;
  input.speed_mps = Length(direction) > 0 ? 1.5f : 0;
  return input;
}

TEST(Guide, WalksAheadWithinAFewMetresUntilTheEnd) {
  for (const int people : {1, 60, 250}) {
    Simulation s = Started(TourTown(people));
    ASSERT_GE(s.visitor.guide.id, 0);
    int plans = 0, turned_at = 0;
    for (int step = 0; step < kMaxSteps && !s.visitor.finished; ++step) {
      Step(&s, 1);
      ASSERT_LT(Apart_m(s), kFarthest_m) << people << " people, step " << step;
      if (s.visitor.tour.plans != plans) plans = s.visitor.tour.plans, turned_at = step;
      const bool turning = step - turned_at < 10 * 30;  // from a halt the way may lead back past the visitor
      const bool arrives =
          LengthOf_m(s.visitor.tour.route) - s.visitor.tour.visitor_m < 9;  // the guide stands beside the view already
      if (s.visitor.tour.resting || s.visitor.tour.over || turning || arrives) continue;
      ASSERT_GT(s.visitor.guide.way_m - s.visitor.tour.visitor_m, 0.5f) << people << " people, step " << step;
    }
    EXPECT_TRUE(s.visitor.finished);
    EXPECT_LT(Length(s.visitor.camera.view.position - Vec2{54, 12}), 1);
  }
}

TEST(Guide, StandsStillAndLooksAtAVisitorWhoStops) {
  Simulation s = Started(TourTown(40));
  Step(&s, 150);
  Step(&s, 120, Walking({}));
  const Vec2 before = GuideOf(s);
  Step(&s, 60, Walking({}));
  EXPECT_LT(Length(GuideOf(s) - before), 0.3f);
  EXPECT_LT(Apart_m(s), 8);
  EXPECT_LT(OffVisitor_rad(s), 0.3f);
}

TEST(Guide, WaitsForAVisitorWhoStrays) {
  Simulation s = Started(TourTown(40));
  Step(&s, 150);
  Step(&s, 600, Walking({-0.6f, 0.8f}));
  ASSERT_GT(Apart_m(s), 8);
  const Vec2 before = GuideOf(s);
  Step(&s, 150, Walking({}));
  EXPECT_LT(Length(GuideOf(s) - before), 0.5f);
  EXPECT_LT(OffVisitor_rad(s), 0.3f);
  bool led = false;
  for (int step = 0; step < kMaxSteps && !s.visitor.finished; ++step) {
    Step(&s, 1);
    led = led || (!s.visitor.tour.resting && Apart_m(s) < 8 && s.visitor.guide.way_m > s.visitor.tour.visitor_m + 1);
  }
  EXPECT_TRUE(led);
  EXPECT_TRUE(s.visitor.finished);
}

TEST(Guide, FacesTheVisitorAtEveryHaltAndIsSeen) {
  Simulation s = Started(TourTown(80));
  int halts = 0, steps = 0, turned_away = 0;
  for (int step = 0; step < kMaxSteps && !s.visitor.finished; ++step) {
    Step(&s, 1);
    if (!s.visitor.tour.resting || s.visitor.tour.rested_s < 2.5f) continue;
    if (s.visitor.tour.rested_s < 2.55f) ++halts;
    ++steps;
    if (OffVisitor_rad(s) > 0.4f) ++turned_away;  // whoever is jostled takes a step or two back
    EXPECT_LT(OffVisitor_rad(s), kPi / 2);
    EXPECT_GT(Apart_m(s), 1);
    EXPECT_LT(Apart_m(s), 8);
    EXPECT_EQ(s.town.crowd.view[s.visitor.guide.index], ViewClass::kVisible);
    EXPECT_EQ(s.town.crowd.activity[s.visitor.guide.index], Activity::kTalking);
  }
  EXPECT_GE(halts, 3);
  EXPECT_LT(turned_away, steps / 4);
}

// Beside which the guide goes to stand while the visitor still walks up to it.
TEST(Guide, IsSeenOnTheWayToAHaltThatLooksAside) {
  for (const float aside_deg : {-70, -50, -30, 0, 30, 50, 70}) {
    TourPack pack = TourTown(1);
    pack.path = {Waypoint({3, 30}), Halt({19, 30}, aside_deg * kPi / 180, 3)};
    Simulation s = Started(pack);
    int steps = 0, unseen = 0;
    float turned_rad = 0;
    for (; steps < kMaxSteps && !s.visitor.tour.resting; ++steps) {
      Step(&s, 1);
      const Vec2 way = GuideOf(s) - s.visitor.camera.view.position;
      unseen += std::abs(WrapAngle(AngleOf(way) - s.visitor.camera.view.yaw_rad)) > s.visitor.camera.view.fov_rad / 2;
      turned_rad = std::max(turned_rad, std::abs(s.visitor.camera.view.yaw_rad));
    }
    EXPECT_LT(unseen, steps / 20) << aside_deg << " degrees, of " << steps;
    EXPECT_LT(turned_rad, 1.3f) << "who walks looks where they go besides";
  }
}

// Where a passer-by was walked round, the way's last step may lead anywhere: the view turned with it, off the guide.
// The guide's place lies beside the way that both have come.
TEST(Guide, GoesStraightToWhereToStandAtAHaltThatLooksBack) {
  for (const float aside_deg : {90, 105, 120, 135, 150, 165, 180, -105, -120, -135, -150, -165}) {
    TourPack pack = TourTown(1);
    pack.path = {Waypoint({3, 30}), Halt({19, 30}, aside_deg * kPi / 180, 3)};
    Simulation s = Started(pack);
    float walked_m = 0, turned_rad = 0, nearest_m = 99, yaw_rad = s.visitor.camera.view.yaw_rad;
    Vec2 place = GuideOf(s);
    int steps = 0;
    for (; steps < kMaxSteps && (!s.visitor.tour.resting || s.visitor.tour.rested_s < 2.9f); ++steps) {
      Step(&s, 1);
      walked_m += Length(GuideOf(s) - place);
      turned_rad += std::abs(WrapAngle(s.visitor.camera.view.yaw_rad - yaw_rad));
      nearest_m = std::min(nearest_m, Apart_m(s));
      place = GuideOf(s), yaw_rad = s.visitor.camera.view.yaw_rad;
    }
    ASSERT_TRUE(s.visitor.tour.resting) << aside_deg;
    EXPECT_LT(walked_m, 14) << aside_deg << " degrees: 10 m, and none of it round the visitor";
    EXPECT_LT(turned_rad, 1.6f * kPi) << aside_deg;
    EXPECT_GT(nearest_m, 1.5f) << aside_deg;
  }
}

TEST(Guide, IsLookedPastToTheSightFromTheLastStepsOfAnyWay) {
  TourPack pack = TourTown(1);
  pack.path = {Waypoint({3, 30}), Halt({19, 30}, -kPi / 2, 3)};
  Simulation s = Started(pack);
  for (int step = 0; step < kMaxSteps && Length(s.visitor.camera.view.position - Vec2{19, 30}) > 0.6f; ++step)
    Step(&s, 1);
  for (int way_deg = -180; way_deg < 180; way_deg += 20) {
    const float way_rad = static_cast<float>(way_deg) * kPi / 180;
    EXPECT_NEAR(WrapAngle(way_rad + LookOffWay_rad(way_rad, InTown(&s)) + kPi / 2), 0, 0.01f) << way_deg;
  }
}

// From a halt that looks so to one that lies and looks so, 8 m away.
Simulation JustLeftAHalt(float look_rad, float next_rad) {
  constexpr Vec2 kHalt{20, 29};
  TourPack pack = TourTown(1);
  pack.path = {Waypoint({4, 29}), Halt(kHalt, look_rad, 3), Halt(kHalt + DirectionOf(next_rad) * 8, next_rad, 3)};
  Simulation s = Started(pack);
  while (!s.visitor.tour.resting) Step(&s, 1);
  while (s.visitor.tour.resting) Step(&s, 1);
  return s;
}

// However the next stop lies.
TEST(Guide, IsNotTurnedAwayFromWhereATourLeavesAHalt) {
  for (int look_deg = -180; look_deg < 180; look_deg += 30) {
    for (int next_deg = -180; next_deg < 180; next_deg += 30) {
      const float look_rad = static_cast<float>(look_deg) * kPi / 180,
                  next_rad = static_cast<float>(next_deg) * kPi / 180;
      Simulation s = JustLeftAHalt(look_rad, next_rad);
      float away_rad = 0;
      for (int step = 0; step < 30 * 4; ++step) {
        const float before_rad = s.visitor.camera.view.yaw_rad;
        const Vec2 guide = GuideOf(s) - s.visitor.camera.view.position;
        const float guide_rad = WrapAngle(AngleOf(guide) - before_rad);
        Step(&s, 1);
        const float turn_rad = WrapAngle(s.visitor.camera.view.yaw_rad - before_rad);
        if (turn_rad * guide_rad < 0 && std::abs(guide_rad) > 0.6f) away_rad += std::abs(turn_rad);
      }
      EXPECT_LT(away_rad, 0.3f) << look_deg << ", " << next_deg << " degrees";
    }
  }
}

// Who waits for the guide to get ahead does not stare where nobody is any more.
TEST(Guide, IsLookedAfterByAVisitorWhoStillStands) {
  for (int next_deg = -180; next_deg < 180; next_deg += 30) {
    Simulation s = JustLeftAHalt(0, static_cast<float>(next_deg) * kPi / 180);
    int staring = 0;
    for (int step = 0; step < 30 * 6; ++step) {
      const float before_rad = s.visitor.camera.view.yaw_rad;
      Step(&s, 1);
      const float guide_rad = WrapAngle(AngleOf(GuideOf(s) - s.visitor.camera.view.position) - before_rad);
      const bool stares = std::abs(WrapAngle(s.visitor.camera.view.yaw_rad - before_rad)) < 1e-4f;
      staring += stares && std::abs(guide_rad) > s.visitor.camera.view.fov_rad / 2;
    }
    EXPECT_LT(staring, 10) << next_deg << " degrees";
  }
}

// Which is a place that nobody rests at: what a visitor looks at there is the way they came along.
TEST(Guide, IsSeenAtTheToursEndAndFacesTheVisitor) {
  TourPack pack = TourTown(60);
  pack.path.push_back(Waypoint({38, 10}));
  Simulation s = Started(pack);
  for (int step = 0; step < kMaxSteps && !s.visitor.finished; ++step) Step(&s, 1);
  ASSERT_TRUE(s.visitor.tour.over);
  Step(&s, 60, Walking({}));
  EXPECT_EQ(s.town.crowd.view[s.visitor.guide.index], ViewClass::kVisible);
  EXPECT_LT(Apart_m(s), 8);
  EXPECT_LT(OffVisitor_rad(s), 0.4f);
}

// By every person but those out of sight, who meet nobody.
TEST(Guide, TouchesNobodyAndNothing) {
  for (const int people : {120, 300}) {
    Simulation s = Started(TourTown(people));
    float overlap_m = 0;
    for (int step = 0; step < kMaxSteps && !s.visitor.finished; ++step) {
      Step(&s, 1);
      const size_t g = s.visitor.guide.index;
      ASSERT_FALSE(InsideObstacle(s.town.walkable, GuideOf(s))) << step;
      ASSERT_GT(Apart_m(s), s.control.settings.r_personal_m + s.town.crowd.radius_m[g] - 0.05f) << step;
      for (size_t i = 0; i < s.town.crowd.size(); ++i) {
        if (i == g || s.town.crowd.view[g] == ViewClass::kOutside || s.town.crowd.view[i] == ViewClass::kOutside)
          continue;
        overlap_m = std::max(overlap_m, s.town.crowd.radius_m[i] + s.town.crowd.radius_m[g] -
                                            Length(s.town.crowd.position[i] - GuideOf(s)));
      }
    }
    EXPECT_TRUE(s.visitor.finished) << people;
    EXPECT_LT(overlap_m, 0.05f) << people;
  }
}

// People who stand packed across the square, with nowhere to go.
// On which side of the line from the visitor to the guide everybody is who stands beside it, by id.
std::map<int, bool> SidesOfTalk(const Simulation& s) {
  const Crowd& c = s.town.crowd;
  const Vec2 visitor = s.visitor.camera.view.position, line = GuideOf(s) - visitor;
  std::map<int, bool> sides;
  for (size_t i = 0; i < c.size(); ++i) {
    const Vec2 off = c.position[i] - visitor;
    const float along = Dot(off, line);
    if (i != s.visitor.guide.index && along > 0 && along < Dot(line, line)) sides[c.id[i]] = Cross(line, off) > 0;
  }
  return sides;
}

TEST(Guide, IsNotWalkedInFrontOfWhileTalkingWhereThereIsRoomToGoRound) {
  TourPack pack = TourTown(140);
  pack.obstacles.polygons.clear();
  for (TourStop& stop : pack.path) stop.pause_s *= 5;
  int crossed = 0, beside = 0;
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    pack.crowd.seed = seed;
    Simulation s = Started(pack);
    std::map<int, bool> before;
    for (int step = 0; step < kMaxSteps && !s.visitor.finished; ++step) {
      Step(&s, 1);
      const bool talks = s.visitor.tour.resting && !s.visitor.guide.walks;
      const std::map<int, bool> now = talks ? SidesOfTalk(s) : std::map<int, bool>{};
      beside += static_cast<int>(now.size());
      for (const auto& [id, side] : now) crossed += before.contains(id) && before[id] != side;
      before = now;
    }
  }
  EXPECT_GT(beside, 5000) << "steps of people beside the two";
  EXPECT_LE(crossed, 20);
}

TEST(Guide, IsLetThroughARow) {
  const TourPack pack = TourTown(1);
  Scenario scenario = ScenarioOf(pack);
  for (int k = 0; k < 36; ++k) {
    ScenarioPerson p;
    p.position_m = {10 + 0.55f * static_cast<float>(k % 2), 1.0f + 0.3f * static_cast<float>(k)};
    p.goals_m = {{3, 20}};
    scenario.persons.push_back(p);
  }
  Simulation s;
  ASSERT_EQ(StartSimulation(&pack, scenario, &s).message, "");
  for (int step = 0; step < 30 * 60 && !s.visitor.tour.resting; ++step) Step(&s, 1);
  EXPECT_TRUE(s.visitor.tour.resting);
  EXPECT_LT(Apart_m(s), 8);
}

TEST(Guide, IsAMeshWheneverSeenAndWithinTheBudget) {
  TourPack pack = TourTown(250);
  pack.control.high_limit = 3;
  pack.control.budget_triangles = 12000;
  Simulation s = Started(pack);
  for (int step = 0; step < kMaxSteps && !s.visitor.finished; ++step) {
    Step(&s, 1);
    ASSERT_LE(s.control.levels.triangles, 12000);
    if (s.town.crowd.view[s.visitor.guide.index] == ViewClass::kVisible) {
      ASSERT_TRUE(IsMesh(s.control.levels.people[s.visitor.guide.index].level)) << step;
    }
  }
}

TEST(Guide, IsOneOfThePeopleAskedFor) {
  EXPECT_EQ(Started(TourTown(50)).town.crowd.size(), 50u);
  const Simulation empty = Started(TourTown(0));
  EXPECT_EQ(empty.town.crowd.size(), 0u);
  EXPECT_LT(empty.visitor.guide.id, 0);
}

TEST(Guide, IsTheSameInEveryRun) {
  Simulation a = Started(TourTown(150)), b = Started(TourTown(150));
  for (int step = 0; step < 1500; ++step) {
    Step(&a, 1);
    Step(&b, 1);
  }
  EXPECT_EQ(StateHash(a.town.crowd), StateHash(b.town.crowd));
}

TEST(Guide, StaysAwayFromScenariosWithAWayOfTheirOwn) {
  const TourPack pack = TourTown(20);
  Scenario scenario = ScenarioOf(pack);
  scenario.has_camera = true;
  scenario.camera_position_m = {5, 5};
  scenario.legs.resize(1);
  Simulation s;
  ASSERT_EQ(StartSimulation(&pack, scenario, &s).message, "");
  EXPECT_LT(s.visitor.guide.id, 0);
  EXPECT_EQ(s.town.crowd.size(), 20u);
}

// Two squares and a lane between them that is too narrow for two to pass: 12 to 48 m.
TourPack LaneTown(float width_m, int people) {
  TourPack pack = TourTown(people);
  const float south = 20 - width_m / 2, north = 20 + width_m / 2;
  pack.obstacles.polygons = {Box({12, 0}, {48, south}), Box({12, north}, {48, 40})};
  pack.places = {{"west", "exit", {1, 20}, 2}, {"east", "exit", {59, 20}, 2}};
  return pack;
}

struct Followed {
  float before_eyes_s = 0, held_up_s = 0, guide_in_view = 0, nearest_m = 1e9f;
};

// Somebody within 1.3 m in the middle of the view; a visitor who does not get on.
Followed FollowTour(Simulation* s) {
  Followed f;
  int steps = 0;
  for (; steps < kMaxSteps && !s->visitor.tour.over; ++steps) {
    Step(s, 1);
    const CameraState& camera = s->visitor.camera;
    const auto off_rad = [&](Vec2 off) { return std::abs(WrapAngle(AngleOf(off) - camera.view.yaw_rad)); };
    bool near = false;
    for (size_t i = 0; i < s->town.crowd.size(); ++i) {
      const Vec2 off = s->town.crowd.position[i] - camera.view.position;
      near = near || (Length(off) < 1.3f && off_rad(off) < 0.5f);
      f.nearest_m = std::min(f.nearest_m, Length(off) - s->town.crowd.radius_m[i]);
    }
    f.before_eyes_s += near ? 1 / 30.0f : 0;
    f.held_up_s += camera.asked_mps > 0.3f && camera.actual_mps < 0.2f * camera.asked_mps ? 1 / 30.0f : 0;
    f.guide_in_view += off_rad(GuideOf(*s) - camera.view.position) < 0.5f;
  }
  f.guide_in_view /= static_cast<float>(steps);
  EXPECT_TRUE(s->visitor.tour.over);
  return f;
}

TEST(Guide, IsNoFaceBeforeTheEyesInALaneTooNarrowToPass) {
  for (const float width_m : {1.2f, 1.5f, 1.8f}) {
    for (const float look_rad : {0.0f, kPi, kPi / 2}) {
      TourPack pack = LaneTown(width_m, 1);
      pack.path = {Halt({5, 20}, 0, 2), Halt({30, 20}, look_rad, 3), Halt({5, 25}, kPi, 3), Halt({55, 20}, 0, 3)};
      Simulation s = Started(pack);
      const Followed f = FollowTour(&s);
      EXPECT_LT(f.before_eyes_s, 1) << width_m << ' ' << look_rad;
      EXPECT_LT(f.held_up_s, 1) << width_m << ' ' << look_rad;
      EXPECT_GT(f.guide_in_view, 0.6f) << width_m << ' ' << look_rad;
      EXPECT_GT(f.nearest_m, s.control.settings.r_personal_m - 0.005f);
    }
  }
}

TEST(Guide, LeadsThroughANarrowLaneWithoutPeopleWhoDanceBeforeTheVisitor) {
  Followed all;
  for (const uint64_t seed : {1u, 2u, 3u, 4u}) {
    TourPack pack = LaneTown(1.8f, 10);
    pack.crowd.seed = seed;
    pack.path = {Halt({5, 20}, 0, 2), Halt({55, 20}, 0, 3), Halt({5, 25}, kPi, 3)};
    Simulation s = Started(pack);
    const Followed f = FollowTour(&s);
    all.before_eyes_s += f.before_eyes_s, all.held_up_s += f.held_up_s;
    EXPECT_GT(f.nearest_m, s.control.settings.r_personal_m - 0.005f) << seed;
  }
  EXPECT_LT(all.before_eyes_s, 15);
  EXPECT_LT(all.held_up_s, 8);
}

}  // namespace
}  // namespace flaneur
