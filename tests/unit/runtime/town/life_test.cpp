// The townspeople's life: who walks together, who comes and goes and where.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "runtime/simulation/simulation.h"

namespace flaneur {
namespace {

// A square of 60 m with an exit on each side.
TourPack Square(int people) {
  TourPack pack;
  pack.ground = Share({{-30, -30}, 0.5f, 120, 120, std::vector<float>(14400, 0), std::vector<uint8_t>(14400, 3)});
  pack.places = {{"west", "exit", {-29, 0}, 3},
                 {"east", "exit", {29, 0}, 3},
                 {"north", "exit", {0, 29}, 3},
                 {"south", "exit", {0, -29}, 3}};
  pack.avatars.emplace_back();
  pack.avatars.back().levels.push_back({0, 1000, 0, 0, 0});
  pack.crowd.people = people;
  pack.crowd.loiter_share = 0;
  return pack;
}

Simulation Started(const TourPack& pack, const Scenario& scenario) {
  Simulation s;
  const Error e = StartSimulation(&pack, scenario, &s);
  EXPECT_FALSE(e) << e.message;
  return s;
}

Simulation Started(const TourPack& pack) { return Started(pack, ScenarioOf(pack)); }

int InGroups(const Crowd& c) {
  return static_cast<int>(std::count_if(c.group.begin(), c.group.end(), [](int g) { return g >= 0; }));
}

TEST(Life, AsManyWalkInGroupsAsAskedForAndStartTogether) {
  for (const float share : {0.0f, 0.4f, 1.0f}) {
    TourPack pack = Square(1200);
    pack.crowd.group_share = share;
    const Simulation s = Started(pack);
    ASSERT_EQ(s.town.crowd.size(), 1200u);
    EXPECT_NEAR(static_cast<float>(InGroups(s.town.crowd)) / 1200, share, 0.06f);
    for (const Group& g : s.town.crowd.groups) {
      const size_t first = static_cast<size_t>(g.member[0]);
      for (int k = 1; k < g.size; ++k) {
        const size_t i = static_cast<size_t>(g.member[k]);
        EXPECT_LT(Length(s.town.crowd.position[i] - s.town.crowd.position[first]), 3);
        EXPECT_EQ(s.town.crowd.field[i], s.town.crowd.field[first]);
        EXPECT_EQ(s.town.crowd.preferred_mps[i], s.town.crowd.preferred_mps[first]);
      }
    }
  }
}

TEST(Life, WhoWalksTogetherComesAndLeavesTogether) {
  TourPack pack = Square(60);
  pack.crowd.group_share = 1;
  Scenario scenario = ScenarioOf(pack);
  scenario.has_camera = true;
  scenario.camera_position_m = {20, 20};
  scenario.camera_yaw_deg = 45;
  Simulation s = Started(pack, scenario);
  std::map<int, std::vector<int>> company;  // ids, by the id of the first
  std::map<int, int64_t> left;              // frame, by id
  std::vector<int> before;
  int later = 0;
  for (int step = 0; step < 5400; ++step) {
    StepSimulation({}, 0, &s);
    for (const Group& g : s.town.crowd.groups) {
      std::vector<int> ids;
      for (int k = 0; k < g.size; ++k) ids.push_back(s.town.crowd.id[static_cast<size_t>(g.member[k])]);
      const int first = *std::min_element(ids.begin(), ids.end());
      if (company.count(first) == 0 && left.count(first) == 0) {
        company[first] = ids;
        later += step > 0 ? 1 : 0;
      }
    }
    for (int id : before) {
      if (std::find(s.town.crowd.id.begin(), s.town.crowd.id.end(), id) == s.town.crowd.id.end())
        left[id] = s.town.step;
    }
    before = s.town.crowd.id;
  }
  EXPECT_GT(later, 20) << "groups come too";
  int seen = 0, late = 0;
  for (const auto& [first, ids] : company) {
    int64_t earliest = s.town.step, latest = 0;
    bool all = true;
    for (int id : ids) {
      all = all && left.count(id) == 1;
      if (left.count(id) == 1) earliest = std::min(earliest, left[id]), latest = std::max(latest, left[id]);
    }
    if (!all) continue;
    ++seen;
    late += latest - earliest > 8 * 30 ? 1 : 0;
    EXPECT_LT(latest - earliest, 15 * 30) << "of " << ids.size();
  }
  EXPECT_GT(seen, 20);
  EXPECT_LT(20 * late, seen) << "hardly anybody is held up";
}

float ToNearestGate_m(const Simulation& s, Vec2 p) {
  float nearest_m = 1e9f;
  for (int gate : s.town.place_lists.gates)
    nearest_m = std::min(nearest_m, Length(s.town.places[static_cast<size_t>(gate)].position_m - p));
  return nearest_m;
}

struct Sighting {
  Vec2 position;
  ViewClass view = ViewClass::kOutside;
};

std::map<int, Sighting> Seen(const Simulation& s) {
  std::map<int, Sighting> seen;
  for (size_t i = 0; i < s.town.crowd.size(); ++i)
    seen[s.town.crowd.id[i]] = {s.town.crowd.position[i], s.town.crowd.view[i]};
  return seen;
}

// One step, in which people only come and go at gates, and come out of sight.
void StepWatched(const CameraInput& input, Simulation* s, int* came, int* went) {
  const std::map<int, Sighting> before = Seen(*s);
  StepSimulation(input, 0, s);
  const std::map<int, Sighting> after = Seen(*s);
  for (const auto& [id, person] : after) {
    if (before.count(id)) continue;
    ++*came;
    EXPECT_LT(ToNearestGate_m(*s, person.position), 1.2f);
    EXPECT_EQ(person.view, ViewClass::kOutside) << "came in view";
  }
  for (const auto& [id, person] : before) {
    if (after.count(id)) continue;
    ++*went;
    EXPECT_LT(ToNearestGate_m(*s, person.position), 0.6f);
  }
}

TEST(Life, PeopleComeAndGoOnlyThroughGatesAndComeOutOfSight) {
  const TourPack pack = Square(120);
  Scenario scenario = ScenarioOf(pack);
  scenario.has_camera = true;
  scenario.camera_position_m = {0, 10};
  Simulation s = Started(pack, scenario);
  CameraInput input;
  input.active = true;
  int came = 0, went = 0;
  for (int step = 0; step < 3600; ++step) {
    input.yaw_rate_radps = step % 300 < 100 ? 1.0f : 0.0f;
    StepWatched(input, &s, &came, &went);
    EXPECT_LE(s.town.crowd.size(), 120u);
    EXPECT_GE(s.town.crowd.size(), 100u);
  }
  EXPECT_GT(came, 30);
  EXPECT_GT(went, 30);
}

// A blind alley, 4 m wide and 22 m long, north of the square; two doors at its end.
TEST(Life, WhoIsEnclosedInADeadEndAndTooManyGoesIndoors) {
  TourPack pack = Square(10);
  for (const float x : {-30.0f, 2.0f}) {
    PolygonObstacle block;
    block.outer = {{x, 5}, {x + 28, 5}, {x + 28, 30}, {x, 30}};
    pack.obstacles.polygons.push_back(block);
  }
  pack.places = {{"door_1", "door", {-1.5f, 24}, 1}, {"door_2", "door", {1.5f, 20}, 1}, {"south", "exit", {0, -29}, 3}};
  pack.control.high_limit = 4;
  pack.crowd.group_share = 0.4f;
  Scenario scenario = ScenarioOf(pack);
  scenario.crowd_area = Area{{-2, 6}, {2, 28}};
  scenario.has_camera = true;
  scenario.camera_position_m = {0, 2};
  scenario.camera_yaw_deg = 90;
  CameraLeg walk, wait;
  walk.kind = CameraLeg::Kind::kWalk;
  walk.to_m = {0, 14};
  walk.speed_mps = 0.8f;
  wait.wait_s = 60;
  scenario.legs = {walk, wait};
  int exceeded = 0, came = 0, went = 0;
  Simulation s = Started(pack, scenario);
  ASSERT_EQ(s.town.crowd.size(), 10u);
  for (int step = 0; step < 1500; ++step) {
    StepWatched({}, &s, &came, &went);
    exceeded += step > 600 && s.control.levels.exceeded ? 1 : 0;
  }
  EXPECT_GE(went, 4) << "through the doors";
  EXPECT_LT(exceeded, 18) << "frames of 900";
}

// The square with a stall, a well and a corner to talk at.
TourPack Market(int people) {
  TourPack pack = Square(people);
  pack.crowd.loiter_share = 0.25f;
  PolygonObstacle stall;
  stall.outer = {{-12, 6}, {-8, 6}, {-8, 7}, {-12, 7}};
  pack.obstacles.polygons.push_back(stall);
  pack.obstacles.circles.push_back({{8, 8}, 1.2f});
  pack.places.push_back({"stall", "loiter", {-10, 5}, 1, kPi / 2});
  pack.places.push_back({"well_west", "loiter", {6, 8}, 1, 0.0f});
  pack.places.push_back({"well_south", "loiter", {8, 6}, 1, kPi / 2});
  pack.places.push_back({"corner", "loiter", {0, -10}, 1});
  return pack;
}

// Somebody they stand with, or something to see, lies where they look.
bool LooksAtSomething(const Simulation& s, size_t i) {
  const Crowd& c = s.town.crowd;
  const Vec2 ahead{std::cos(c.heading_rad[i]), std::sin(c.heading_rad[i])};
  const LoiterSpot& spot = s.town.loiter_spots[static_cast<size_t>(PlanOf(i, s.town).spot)];
  if (Dot(ahead, spot.look) > 0.8f) return true;
  for (size_t j = 0; j < c.size(); ++j) {
    const Vec2 way = c.position[j] - c.position[i];
    if (j != i && Length(way) < 2 && Dot(way, ahead) > 0.8f * Length(way)) return true;
  }
  return false;
}

TEST(Life, PeopleStandAboutEachAtAnotherSpotAndLookAtThingsOrEachOther) {
  const TourPack pack = Market(40);
  Scenario scenario = ScenarioOf(pack);
  scenario.has_camera = true;
  scenario.camera_position_m = {0, -29};
  scenario.camera_yaw_deg = 90;
  scenario.control.high_limit = 1000;
  Simulation s = Started(pack, scenario);
  EXPECT_GE(std::count(s.town.crowd.activity.begin(), s.town.crowd.activity.end(), Activity::kStanding), 8)
      << "at once";
  int standing = 0, talking = 0, looking = 0, wrong = 0;
  for (int step = 0; step < 3600; ++step) {
    StepSimulation({}, 0, &s);
    if (step < 300 || step % 30 != 0) continue;
    for (size_t i = 0; i < s.town.crowd.size(); ++i) {
      const int spot = PlanOf(i, s.town).spot;
      if (spot < 0 || s.town.crowd.field[i] >= 0 || Length(s.town.crowd.velocity[i]) > 0.05f) continue;
      ++standing;
      talking += s.town.crowd.activity[i] == Activity::kTalking ? 1 : 0;
      looking += LooksAtSomething(s, i) ? 1 : 0;
      for (size_t j = 0; j < i; ++j) wrong += PlanOf(j, s.town).spot == spot ? 1 : 0;
    }
  }
  EXPECT_EQ(wrong, 0) << "two at one spot";
  const float share = static_cast<float>(standing) / (110 * 40);
  EXPECT_GT(share, 0.15f);
  EXPECT_LT(share, 0.32f);
  EXPECT_GT(talking, standing / 5);
  EXPECT_LT(talking, standing * 9 / 10);
  EXPECT_GT(looking, standing * 9 / 10);
}

TEST(Life, WhoStandsSetsOutWhenADetourIsAsked) {
  Simulation s = Started(Market(40));
  size_t who = 0;
  while (s.town.crowd.field[who] >= 0) ++who;
  const int id = s.town.crowd.id[who];
  s.town.crowd.detour[who] = {0, -1};
  s.town.crowd.detour_s[who] = 1;
  for (int step = 0; step < 45; ++step) StepSimulation({}, 0, &s);
  const auto now = std::find(s.town.crowd.id.begin(), s.town.crowd.id.end(), id) - s.town.crowd.id.begin();
  EXPECT_GE(s.town.crowd.field[static_cast<size_t>(now)], 0);
  EXPECT_EQ(PlanOf(static_cast<size_t>(now), s.town).spot, -1);
}

// The north-west quarter painted in full, the south-east one by half; people stand about in a strip in the south-west.
TourPack Painted(int people) {
  TourPack pack = Square(people);
  pack.crowd.group_share = 0.3f;
  Painting& p = pack.painting;
  p.min_m = {-30, -30};
  p.cell_m = 1;
  p.columns = p.rows = 60;
  for (int row = 0; row < 60; ++row) {
    for (int column = 0; column < 60; ++column) {
      p.people.push_back(column < 30 && row >= 30 ? 200 : column >= 30 && row < 30 ? 100 : 0);
      p.loiter.push_back(column < 20 && row >= 5 && row < 10 ? 255 : 0);
    }
  }
  return pack;
}

TEST(Life, PeopleStartWhereTheyArePainted) {
  const TourPack pack = Painted(300);
  const Simulation s = Started(pack);
  EXPECT_TRUE(s.town.warnings.empty());
  int north_west = 0, south_east = 0;
  for (const Vec2 p : s.town.crowd.position) {
    north_west += p.x < 0.5f && p.y > -0.5f ? 1 : 0;
    south_east += p.x > -0.5f && p.y < 0.5f ? 1 : 0;
  }
  EXPECT_GE(north_west + south_east, 295) << "who follows somebody may start beside the paint";
  EXPECT_NEAR(static_cast<float>(north_west) / 300, 2.0f / 3, 0.08f);
  EXPECT_EQ(s.town.place_lists.goals.size(), 24u);
  for (int goal : s.town.place_lists.goals) {
    const int cell = PaintingCell(pack.painting, s.town.places[static_cast<size_t>(goal)].position_m);
    ASSERT_GE(cell, 0);
    EXPECT_GT(pack.painting.people[static_cast<size_t>(cell)], 0);
  }
}

TEST(Life, PeopleStandAboutWhereThatIsPainted) {
  TourPack pack = Painted(100);
  pack.crowd.loiter_share = 0.3f;
  pack.places.push_back({"tagged", "loiter", {20, 20}, 1});
  Simulation s = Started(pack);
  int standing = 0, off_paint = 0;
  for (int step = 0; step < 1800; ++step) {
    StepSimulation({}, 0, &s);
    if (step % 60 != 0) continue;
    for (size_t i = 0; i < s.town.crowd.size(); ++i) {
      if (PlanOf(i, s.town).spot < 0 || s.town.crowd.field[i] >= 0) continue;
      const Vec2 p = s.town.crowd.position[i];
      ++standing;
      off_paint += p.x > -8 || p.y < -27 || p.y > -18 ? 1 : 0;
    }
  }
  EXPECT_GT(standing, 30 * 15);
  EXPECT_EQ(off_paint, 0);
}

TEST(Life, APaintingBesideAllGroundSaysSo) {
  TourPack pack = Painted(20);
  pack.painting.min_m = {100, 100};
  const Simulation s = Started(pack);
  ASSERT_EQ(s.town.warnings.size(), 2u);
  EXPECT_EQ(s.town.warnings[0], "the painting has no place of kind goal where people can walk; it is not used");
  EXPECT_EQ(s.town.crowd.size(), 20u);
}

TEST(Life, PeopleStartAtSpawnsWhereThereAreAny) {
  TourPack pack = Square(30);
  pack.places.push_back({"camp", "spawn", {18, 18}, 1});
  const Simulation s = Started(pack);
  for (const Vec2 p : s.town.crowd.position) EXPECT_LT(Length(p - Vec2{18, 18}), 8 + 2.5f);
}

float MeanSpeed_mps(int steps, Simulation* s) {
  double sum_mps = 0;
  for (int step = 0; step < steps; ++step) {
    StepSimulation({}, 0, s);
    for (const Vec2 v : s->town.crowd.velocity) sum_mps += static_cast<double>(Length(v));
  }
  return static_cast<float>(sum_mps / (static_cast<double>(steps) * static_cast<double>(s->town.crowd.size())));
}

// Two people on three square metres, who share 24 goals: those who came and those who wanted to leave stood before each
// other for good.
TEST(Life, ADenseCrowdKeepsMovingRoundTheGoalsItShares) {
  Scenario scenario;
  scenario.has_ground = true;
  scenario.ground_min_m = {-15, -15};
  scenario.ground_max_m = {15, 15};
  scenario.crowd.people = 600;
  Simulation s;
  const Error e = StartSimulation(nullptr, scenario, &s);
  ASSERT_FALSE(e) << e.message;
  ASSERT_GT(s.town.crowd.size(), 590u);
  MeanSpeed_mps(900, &s);
  EXPECT_GT(MeanSpeed_mps(300, &s), 0.85f);
}

// Two loiter places, one of them right before the eyes of a visitor who stands on the square, the other behind the
// back.
Simulation WithVisitorBeforeAPlace() {
  TourPack pack = Square(80);
  pack.crowd.loiter_share = 0.3f;
  pack.places.push_back({"before", "loiter", {2, 0}, 1});
  pack.places.push_back({"behind", "loiter", {-9, 0}, 1});
  Scenario scenario = ScenarioOf(pack);
  scenario.has_camera = true;
  scenario.camera_position_m = {0, 0};
  scenario.camera_yaw_deg = 0;
  scenario.control.adaptation = Adaptation::kOff;
  return Started(pack, scenario);
}

TEST(Life, NobodyPicksAPlaceToStandThatFillsTheVisitorsView) {
  Simulation s = WithVisitorBeforeAPlace();
  int before = 0, behind = 0;
  for (int step = 0; step < 5400; ++step) {
    StepSimulation({}, 0, &s);
    for (const LoiterSpot& spot : s.town.loiter_spots) {
      before += spot.there && spot.position_m.x > 0 && Length(spot.position_m) < 2.8f;
      behind += spot.there && spot.position_m.x < 0;
    }
  }
  EXPECT_EQ(before, 0);
  EXPECT_GT(behind, 1000) << "they stand elsewhere";
}

// In a lane that the visitor bars, nobody waits before them for the way to come free.
TEST(Life, WhoCannotPassTheVisitorGoesElsewhere) {
  TourPack pack = Square(120);
  for (const float y : {1.0f, -9.0f}) {
    pack.obstacles.polygons.push_back({{{-8, y}, {8, y}, {8, y + 8}, {-8, y + 8}}, {}});
  }
  Scenario scenario = ScenarioOf(pack);
  scenario.has_camera = true;
  scenario.camera_position_m = {0, 0};
  scenario.control.adaptation = Adaptation::kOff;
  Simulation s = Started(pack, scenario);
  std::map<int, int> waits;  // steps in a row, by id
  int longest = 0, came = 0;
  for (int step = 0; step < 3600; ++step) {
    StepSimulation({}, 0, &s);
    const Crowd& c = s.town.crowd;
    for (size_t i = 0; i < c.size(); ++i) {
      const bool near = Length(c.position[i]) < 2.5f && std::abs(c.position[i].y) < 1;
      came += near;
      int& steps = waits[c.id[i]];
      steps = near ? steps + 1 : 0;
      longest = std::max(longest, steps);
    }
  }
  EXPECT_GT(came, 100) << "people try the lane";
  EXPECT_LT(longest, 30 * 12);
}

}  // namespace
}  // namespace flaneur
