// The townspeople's life: who walks together, who comes and goes and where.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "runtime/player/simulation.h"

namespace flaneur {
namespace {

// A square of 60 m with an exit on each side.
TourPack Square(int people) {
  TourPack pack;
  pack.ground = {{-30, -30}, 0.5f, 120, 120, std::vector<float>(14400, 0), std::vector<uint8_t>(14400, 3)};
  pack.places = {{"west", "exit", {-29, 0}, 3}, {"east", "exit", {29, 0}, 3}, {"north", "exit", {0, 29}, 3}, {"south", "exit", {0, -29}, 3}};
  pack.avatars.emplace_back();
  pack.avatars.back().levels.push_back({0, 1000, 0, 0, 0});
  pack.crowd.people = people;
  pack.crowd.loiter_share = 0;
  return pack;
}

Simulation Started(const TourPack& pack, const Scenario& scenario = {}) {
  Simulation s;
  const Error e = StartSimulation(&pack, scenario, &s);
  EXPECT_FALSE(e) << e.message;
  return s;
}

int InGroups(const Crowd& c) {
  return static_cast<int>(std::count_if(c.group.begin(), c.group.end(), [](int g) { return g >= 0; }));
}

TEST(Life, AsManyWalkInGroupsAsAskedForAndStartTogether) {
  for (const float share : {0.0f, 0.4f, 1.0f}) {
    TourPack pack = Square(1200);
    pack.crowd.group_share = share;
    const Simulation s = Started(pack);
    ASSERT_EQ(s.crowd.size(), 1200u);
    EXPECT_NEAR(static_cast<float>(InGroups(s.crowd)) / 1200, share, 0.06f);
    for (const Group& g : s.crowd.groups) {
      const size_t first = static_cast<size_t>(g.member[0]);
      for (int k = 1; k < g.size; ++k) {
        const size_t i = static_cast<size_t>(g.member[k]);
        EXPECT_LT(Length(s.crowd.position[i] - s.crowd.position[first]), 3);
        EXPECT_EQ(s.crowd.field[i], s.crowd.field[first]);
        EXPECT_EQ(s.crowd.preferred_mps[i], s.crowd.preferred_mps[first]);
      }
    }
  }
}

TEST(Life, WhoWalksTogetherComesAndLeavesTogether) {
  TourPack pack = Square(60);
  pack.crowd.group_share = 1;
  Scenario scenario;
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
    for (const Group& g : s.crowd.groups) {
      std::vector<int> ids;
      for (int k = 0; k < g.size; ++k) ids.push_back(s.crowd.id[static_cast<size_t>(g.member[k])]);
      const int first = *std::min_element(ids.begin(), ids.end());
      if (company.count(first) == 0 && left.count(first) == 0) {
        company[first] = ids;
        later += step > 0 ? 1 : 0;
      }
    }
    for (int id : before) {
      if (std::find(s.crowd.id.begin(), s.crowd.id.end(), id) == s.crowd.id.end()) left[id] = s.frame;
    }
    before = s.crowd.id;
  }
  EXPECT_GT(later, 20) << "groups come too";
  int seen = 0;
  for (const auto& [first, ids] : company) {
    int64_t earliest = s.frame, latest = 0;
    bool all = true;
    for (int id : ids) {
      all = all && left.count(id) == 1;
      if (left.count(id) == 1) earliest = std::min(earliest, left[id]), latest = std::max(latest, left[id]);
    }
    if (!all) continue;
    ++seen;
    EXPECT_LT(latest - earliest, 8 * 30) << "of " << ids.size();
  }
  EXPECT_GT(seen, 20);
}

}  // namespace
}  // namespace flaneur
