// Birds that peck about a place and fly up before whoever comes near.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "runtime/show/frame_from_simulation.h"
#include "tests/unit/runtime/simulation/box_obstacle.h"

namespace flaneur {
namespace {

constexpr int kBirdAvatar = 1, kBirds = 16;

// A square of 60 m without anybody but the birds, and a box beside their place.
TourPack Square() {
  TourPack pack;
  pack.ground = Share({{-30, -30}, 0.5f, 120, 120, std::vector<float>(14400, 0), std::vector<uint8_t>(14400, 3)});
  pack.obstacles.polygons = {Box({3, -3}, {6, 3})};
  pack.avatars.resize(2);
  pack.avatars[0].name = "person";
  pack.avatars[0].levels = {{0, 8000, 0, 0, 200}, {0, 1000, 0, 0, 0}};
  PackAvatar& bird = pack.avatars[kBirdAvatar];
  bird.name = "bird";
  bird.share = 0;
  bird.height_m = 0.26f;
  bird.walk_speed_mps = 0.3f;
  bird.other_clips.push_back({"fly", {0.25f, 1, {Mat4{}}}});
  bird.levels = {{0, 600, 0, 0, 60}, {0, 100, 0, 0, 0}};
  pack.crowd.people = 0;
  pack.flocks = {{"bird", {0, 0}, 5, kBirds, 3, "fly"}};
  return pack;
}

Scenario SeenFrom(const TourPack& pack, Vec2 p, std::vector<CameraLeg> legs = {}) {
  Scenario scenario = ScenarioOf(pack);
  scenario.has_camera = true;
  scenario.camera_position_m = p;
  scenario.legs = std::move(legs);
  return scenario;
}

Simulation Started(const TourPack& pack, const Scenario& scenario) {
  Simulation s;
  const Error e = StartSimulation(&pack, scenario, &s);
  EXPECT_FALSE(e) << e.message;
  return s;
}

const std::vector<Bird>& BirdsOf(const Simulation& s) { return s.town.flocks.front().birds; }

int Flying(const Simulation& s) {
  return static_cast<int>(
      std::count_if(BirdsOf(s).begin(), BirdsOf(s).end(), [](const Bird& bird) { return InTheAir(bird.state); }));
}

CameraLeg WalkTo(Vec2 p) {
  CameraLeg leg;
  leg.kind = CameraLeg::Kind::kWalk;
  leg.to_m = p;
  leg.speed_mps = 1.4f;
  return leg;
}

TEST(Flock, PecksWhereNobodyComes) {
  const TourPack pack = Square();
  Simulation s = Started(pack, SeenFrom(pack, {-20, 0}));
  ASSERT_EQ(BirdsOf(s).size(), static_cast<size_t>(kBirds));
  float walked_m = 0;
  for (int step = 0; step < 900; ++step) {
    StepSimulation({}, 0, &s);
    ASSERT_EQ(Flying(s), 0);
    for (const Bird& bird : BirdsOf(s)) {
      const Vec2 p{bird.position.x, bird.position.y};
      EXPECT_LE(Length(p), 5.01f);
      EXPECT_FALSE(InsideObstacle(s.town.walkable, p));
      EXPECT_EQ(bird.position.z, 0);
      EXPECT_LT(Length(bird.position - bird.before), 0.02f);
    }
  }
  for (const Bird& bird : BirdsOf(s)) walked_m += bird.walked_m;
  EXPECT_GT(walked_m, 1.0f * kBirds);
}

// Who walks into them has none before their feet, sees them all in the air, and who then leaves sees them settle.
TEST(Flock, FliesUpBeforeAVisitorCirclesAndSettlesAgain) {
  const TourPack pack = Square();
  Simulation s = Started(pack, SeenFrom(pack, {-12, 0}, {WalkTo({-1, 0}), WalkTo({-25, 0})}));
  int most = 0;
  float highest_m = 0;
  for (int step = 0; step < 30 * 60; ++step) {
    StepSimulation({}, 0, &s);
    most = std::max(most, Flying(s));
    for (const Bird& bird : BirdsOf(s)) {
      const Vec2 p{bird.position.x, bird.position.y};
      highest_m = std::max(highest_m, bird.position.z);
      EXPECT_GE(bird.position.z, 0);
      EXPECT_LT(Length(bird.position - bird.before), 0.3f) << "nothing moves at once";
      EXPECT_FALSE(bird.position.z < 2 && InsideObstacle(s.town.walkable, p));
      EXPECT_FALSE(!InTheAir(bird.state) && Length(p - s.visitor.camera.view.position) < 2.9f);
    }
  }
  EXPECT_GE(most, kBirds - 3);
  EXPECT_GT(highest_m, 4);
  EXPECT_LT(highest_m, 9);
  EXPECT_EQ(Flying(s), 0);
}

TEST(Flock, FliesUpBeforePeopleTooAndTheyAreNotHeldUp) {
  TourPack pack = Square();
  Scenario scenario = SeenFrom(pack, {-25, -20});
  ScenarioPerson person;
  person.position_m = {-10, 0.5f};
  person.goals_m = {{2, 0.5f}};
  person.stay = true;
  scenario.persons = {person};
  Simulation with = Started(pack, scenario);
  pack.flocks.clear();
  Simulation without = Started(pack, scenario);
  int most = 0;
  for (int step = 0; step < 300; ++step) {
    StepSimulation({}, 0, &with);
    StepSimulation({}, 0, &without);
    most = std::max(most, Flying(with));
    ASSERT_EQ(with.town.crowd.position[0].x, without.town.crowd.position[0].x);
  }
  EXPECT_GE(most, 1);
}

TEST(Flock, IsTheSameInEveryRun) {
  const TourPack pack = Square();
  const Scenario scenario = SeenFrom(pack, {-8, 0}, {WalkTo({0, 0})});
  Simulation a = Started(pack, scenario), b = Started(pack, scenario);
  for (int step = 0; step < 600; ++step) {
    StepSimulation({}, 0, &a);
    StepSimulation({}, 0, &b);
  }
  for (size_t k = 0; k < BirdsOf(a).size(); ++k) {
    EXPECT_EQ(BirdsOf(a)[k].position.x, BirdsOf(b)[k].position.x);
    EXPECT_EQ(BirdsOf(a)[k].position.z, BirdsOf(b)[k].position.z);
  }
}

// What a picture shows of a bird changes by degrees, and whatever it takes is out of people's budget.
TEST(Flock, ComesIntoThePictureAndIntoItsMeshesByDegreesWithinTheBudget) {
  const TourPack pack = Square();
  Simulation s = Started(pack, SeenFrom(pack, {-28, 0}, {WalkTo({-5, 0})}));
  PersonLooks looks;
  FrameInput frame;
  std::vector<std::array<float, 2>> before(kBirds);  // how much is seen of either mesh
  for (int step = 0; step < 500; ++step) {
    StepSimulation({}, 0, &s);
    FrameFromSimulation(pack, s, &looks, &frame);
    std::vector<std::array<float, 2>> now(kBirds);
    int64_t triangles = 0;
    for (const ShownBird& shown : s.birds.shown) {
      auto& meshes = now[static_cast<size_t>(shown.bird)];
      meshes[static_cast<size_t>(shown.mesh)] = shown.share * shown.finer;
      if (shown.finer < 1) meshes[static_cast<size_t>(shown.mesh) + 1] = shown.share * (1 - shown.finer);
    }
    for (const DrawnPerson& drawn : frame.people) {
      ASSERT_EQ(drawn.avatar, kBirdAvatar);
      triangles += pack.avatars[kBirdAvatar].levels[static_cast<size_t>(drawn.level.mesh)].triangles;
    }
    EXPECT_LE(triangles, s.birds.triangles);
    EXPECT_LE(s.birds.triangles, 20000);
    for (size_t k = 0; step > 0 && k < now.size(); ++k) {
      EXPECT_NEAR(now[k][0], before[k][0], 0.34f);
      EXPECT_NEAR(now[k][0] + now[k][1], before[k][0] + before[k][1], 0.34f);
    }
    before = now;
  }
}

TEST(Flock, TakesNoMoreOfAShortBudgetThanItsShareTheNearestFirst) {
  TourPack pack = Square();
  pack.control.budget_triangles = 30000;
  Simulation s = Started(pack, SeenFrom(pack, {-4, 0}));
  for (int step = 0; step < 60; ++step) {
    StepSimulation({}, 0, &s);
    EXPECT_LE(s.birds.triangles, 3000);
    EXPECT_GT(s.birds.shown.size(), 2u);
    EXPECT_LT(s.birds.shown.size(), static_cast<size_t>(kBirds));
  }
}

TEST(Flock, IsLeftOutWithAWordWhereItCannotBe) {
  TourPack pack = Square();
  pack.flocks = {{"person", {0, 0}, 5, 3, 3, "fly"}, {"bird", {4.5f, 0}, 0.5f, 3, 3, "fly"}};
  const Simulation s = Started(pack, SeenFrom(pack, {-20, 0}));
  EXPECT_TRUE(s.town.flocks.empty());
  ASSERT_EQ(s.town.warnings.size(), 2u);
  EXPECT_NE(s.town.warnings[0].find("'person'"), std::string::npos);
  EXPECT_NE(s.town.warnings[1].find("no free ground"), std::string::npos);
}

}  // namespace
}  // namespace flaneur
