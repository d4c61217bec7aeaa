// Who works: a keeper behind a stall, somebody who sits, sweeps or draws water.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "runtime/simulation/simulation.h"
#include "tests/unit/runtime/simulation/box_obstacle.h"

namespace flaneur {
namespace {

constexpr int kStallSpot = 0;

PackAvatar Figure(const char* name, float share, std::vector<std::string> clips) {
  PackAvatar avatar;
  avatar.name = name;
  avatar.share = share;
  avatar.levels = {{0, 8000, 0, 0, 200}, {0, 1000, 0, 0, 0}};
  for (const std::string& clip : clips) avatar.other_clips.push_back({clip, {}, clip == "sit" ? 0.45f : 0});
  return avatar;
}

Place Work(const char* name, Vec2 p, float yaw_rad, const char* clip, std::vector<std::string> avatars, float stay_s) {
  Place place{name, "work", p};
  place.yaw_rad = yaw_rad;
  place.clip = clip;
  place.avatars = std::move(avatars);
  place.stay_s = stay_s;
  return place;
}

// A square of 60 m with a stall that is open to the back, and less room in it than people walk in.
TourPack Square(int people) {
  TourPack pack;
  pack.ground = Share({{-30, -30}, 0.5f, 120, 120, std::vector<float>(14400, 0), std::vector<uint8_t>(14400, 3)});
  pack.places = {{"west", "exit", {-29, 0}, 3}, {"east", "exit", {29, 0}, 3}};
  pack.obstacles.polygons = {Box({-1.5f, -1}, {1.5f, 0}), Box({-1.5f, 0}, {-0.4f, 1}), Box({0.4f, 0}, {1.5f, 1})};
  pack.avatars = {Figure("maid", 3, {"sweep", "keep"}), Figure("farmer", 3, {"sit"}), Figure("horse", 0, {})};
  pack.crowd.people = people;
  pack.crowd.work_share = 0.5f;
  pack.places.push_back(Work("stall", {0, 0.4f}, -kPi / 2, "keep", {}, 0));
  pack.places.push_back(Work("yard", {8, 8}, 0, "sweep", {}, 0));
  pack.places.push_back(Work("bench", {-8, 8}, kPi, "sit", {}, 0));
  pack.places.push_back(Work("cart", {-8, -12}, 0, "", {"horse"}, 0));
  return pack;
}

Simulation Started(const TourPack& pack, const Scenario& scenario) {
  Simulation s;
  const Error e = StartSimulation(&pack, scenario, &s);
  EXPECT_FALSE(e) << e.message;
  return s;
}

Simulation Started(const TourPack& pack) { return Started(pack, ScenarioOf(pack)); }

// Index of whoever has the spot, -1: nobody.
int WorkerOf(const Simulation& s, int spot) {
  for (size_t i = 0; i < s.town.crowd.size(); ++i) {
    if (PlanOf(i, s.town).work == spot) return static_cast<int>(i);
  }
  return -1;
}

TEST(Work, WhoWorksSomewhereStaysThereAllDayAndDoesWhatIsDoneThere) {
  TourPack pack = Square(60);
  Scenario scenario = ScenarioOf(pack);
  scenario.has_camera = true;
  scenario.camera_position_m = {0, -12};
  scenario.camera_yaw_deg = 90;
  scenario.control.high_limit = 2;  // others are asked to make room all the time
  Simulation s = Started(pack, scenario);
  ASSERT_EQ(s.town.work_spots.size(), 4u);
  std::vector<int> ids;
  for (int k = 0; k < 4; ++k) {
    const int i = WorkerOf(s, k);
    ASSERT_GE(i, 0) << s.town.places[static_cast<size_t>(s.town.work_spots[static_cast<size_t>(k)].place)].name;
    ids.push_back(s.town.crowd.id[static_cast<size_t>(i)]);
  }
  int away = 0, idle = 0;
  for (int step = 0; step < 3000; ++step) {
    StepSimulation({}, 0, &s);
    ASSERT_LE(s.control.levels.high, 2);
    if (step % 30 != 0) continue;
    for (int k = 0; k < 4; ++k) {
      const WorkSpot& spot = s.town.work_spots[static_cast<size_t>(k)];
      const auto i = static_cast<size_t>(WorkerOf(s, k));
      ASSERT_LT(i, s.town.crowd.size());
      ASSERT_EQ(s.town.crowd.id[i], ids[static_cast<size_t>(k)]);
      away += Length(s.town.crowd.position[i] - spot.position_m) > 0.6f ? 1 : 0;
      const PackAvatar& avatar = pack.avatars[static_cast<size_t>(s.town.crowd.avatar[i])];
      const std::string& clip = s.town.places[static_cast<size_t>(spot.place)].clip;
      const int doing = s.town.crowd.doing[i];
      idle += clip != (doing >= 0 ? avatar.other_clips[static_cast<size_t>(doing)].name : "") ? 1 : 0;
    }
  }
  EXPECT_LT(away, 8) << "of 400 looks";
  EXPECT_LT(idle, 16);
  const auto keeper = static_cast<size_t>(WorkerOf(s, kStallSpot));
  EXPECT_NEAR(s.town.crowd.position[keeper].x, 0, 0.02f);
  EXPECT_NEAR(s.town.crowd.position[keeper].y, 0.4f, 0.02f) << "not moved to where people walk";
  EXPECT_NEAR(s.town.crowd.heading_rad[keeper], -kPi / 2, 1e-3f);
}

// Everybody else walks through the lane, which the seat makes narrower.
TEST(Work, NobodyIsPushedOffTheirSeat) {
  TourPack pack = Square(150);
  pack.places = {
      {"west", "exit", {-29, 0}, 3}, {"east", "exit", {29, 0}, 3}, Work("bench", {0, 0.7f}, -kPi / 2, "sit", {}, 0)};
  pack.obstacles.polygons = {Box({-8, -8}, {8, -1}), Box({-8, 1}, {8, 8})};
  Scenario scenario = ScenarioOf(pack);
  scenario.has_camera = true;
  scenario.camera_position_m = {-5, -0.3f};
  Simulation s = Started(pack, scenario);
  int near = 0;
  float away_m = 0;
  for (int step = 0; step < 4000; ++step) {
    StepSimulation({}, 0, &s);
    const int i = WorkerOf(s, 0);
    ASSERT_GE(i, 0);
    const Crowd& c = s.town.crowd;
    ASSERT_GE(c.doing[static_cast<size_t>(i)], 0);
    away_m = std::max(away_m, Length(c.position[static_cast<size_t>(i)] - s.town.work_spots[0].position_m));
    near += std::count_if(c.position.begin(), c.position.end(), [](Vec2 p) {
              return Length(p - Vec2{0, 0.7f}) < 0.9f;
            }) > 1;
  }
  EXPECT_GT(near, 500) << "hardly anybody came by";
  EXPECT_LT(away_m, 0.1f);
}

TEST(Work, WhoSitsStaysSeatedWhenTheVisitorWalksUpToThem) {
  TourPack pack = Square(0);
  pack.places = {Work("bench", {0, 10}, -kPi / 2, "sit", {}, 0)};
  pack.crowd.people = 1;
  pack.crowd.work_share = 1;
  Scenario scenario = ScenarioOf(pack);
  scenario.has_camera = true;
  scenario.camera_position_m = {0, 4};
  Simulation s = Started(pack, scenario);
  ASSERT_EQ(WorkerOf(s, 0), 0);
  CameraInput up_to_them;
  up_to_them.active = true;
  up_to_them.direction = {0, 1};
  up_to_them.speed_mps = 1.4f;
  for (int step = 0; step < 300; ++step) {
    StepSimulation(up_to_them, 0, &s);
    ASSERT_LT(Length(s.town.crowd.position[0] - Vec2{0, 10}), 0.02f) << step;
  }
  EXPECT_LT(Length(s.visitor.camera.view.position - Vec2{0, 10}), 1.6f) << "the visitor did not come near";
}

// As grids of the ground leave it where obstacles are near.
TEST(Work, WhoFindsNoWayToTheSpotItselfStepsThere) {
  const TourPack pack = Square(60);
  Scenario scenario = ScenarioOf(pack);
  scenario.has_camera = true;
  scenario.camera_position_m = {0, -12};
  Simulation s = Started(pack, scenario);
  const int stall = WorkerOf(s, kStallSpot);
  ASSERT_GE(stall, 0);
  s.town.crowd.position[static_cast<size_t>(stall)] = {0, 1.4f};
  for (int step = 0; step < 600; ++step) StepSimulation({}, 0, &s);
  const auto keeper = static_cast<size_t>(WorkerOf(s, kStallSpot));
  EXPECT_LT(Length(s.town.crowd.position[keeper] - Vec2{0, 0.4f}), 0.05f);
  EXPECT_GE(s.town.crowd.doing[keeper], 0);
}

TEST(Work, OneWithoutAShareIsAtTheirPlaceAndNowhereElse) {
  const Simulation s = Started(Square(80));
  EXPECT_EQ(std::count(s.town.crowd.avatar.begin(), s.town.crowd.avatar.end(), 2), 1);
  const int horse = WorkerOf(s, 3);
  ASSERT_GE(horse, 0);
  EXPECT_EQ(s.town.crowd.avatar[static_cast<size_t>(horse)], 2);
}

TEST(Work, NoMoreWorkThanTheShareAndAllArePartOfTheCrowd) {
  TourPack pack = Square(40);
  for (int k = 0; k < 20; ++k)
    pack.places.push_back(Work("more", {-20 + 2.0f * static_cast<float>(k), 18}, 0, "sweep", {}, 0));
  pack.crowd.work_share = 0.25f;
  Simulation s = Started(pack);
  EXPECT_EQ(s.town.crowd.size(), 40u);
  EXPECT_EQ(s.town.workers, 10);
  for (int step = 0; step < 1200; ++step) StepSimulation({}, 0, &s);
  EXPECT_LE(s.town.workers, 10);
  pack.crowd.work_share = 0;
  EXPECT_EQ(Started(pack).town.workers, 0);
}

TEST(Work, WhoseTimeIsOverLeavesAndSomebodyElseComes) {
  TourPack pack = Square(60);
  pack.crowd.group_share = 0;
  pack.places = {{"west", "exit", {-29, 0}, 3}, {"east", "exit", {29, 0}, 3}, Work("yard", {8, 8}, 0, "sweep", {}, 20)};
  Simulation s = Started(pack);
  int at_work = 0, first = -1, changes = 0;
  for (int step = 0; step < 6000; ++step) {
    StepSimulation({}, 0, &s);
    const int i = WorkerOf(s, 0);
    if (i < 0 || !s.town.work_spots[0].there) continue;
    ++at_work;
    const int id = s.town.crowd.id[static_cast<size_t>(i)];
    changes += id != first ? 1 : 0;
    first = id;
  }
  EXPECT_GE(changes, 2);
  EXPECT_GT(at_work, 1000);
  EXPECT_LT(at_work, 5500);
}

TEST(Work, EqualRunsAreEqual) {
  const TourPack pack = Square(60);
  Simulation a = Started(pack), b = Started(pack);
  for (int step = 0; step < 600; ++step) StepSimulation({}, 0, &a), StepSimulation({}, 0, &b);
  EXPECT_EQ(StateHash(a.town.crowd), StateHash(b.town.crowd));
}

TEST(Work, APlaceThatNobodyCanFillSaysSo) {
  TourPack pack = Square(20);
  pack.places.push_back(Work("forge", {12, -12}, 0, "hammer", {}, 0));
  const Simulation s = Started(pack);
  ASSERT_EQ(s.town.warnings.size(), 1u);
  EXPECT_EQ(s.town.warnings[0], "place 'forge': nobody can work there; no avatar has the clip 'hammer' and the room");
}

TEST(Work, AToolIsInTheHandsOfWhoUsesItAlone) {
  const std::vector<Prop> props{
      {"broom", 1, "load", 60, "sweep"}, {"basket", 1, "load", 80, ""}, {"hat", 1, "", 20, ""}};
  const std::string sweep = "sweep", sit = "sit";
  EXPECT_EQ(PropsOf(props, 7), 0b110);
  EXPECT_EQ(PropsOf(props, 7, &sit), 0b110);
  EXPECT_EQ(PropsOf(props, 7, &sweep), 0b101) << "and the basket is laid down";
}

}  // namespace
}  // namespace flaneur
