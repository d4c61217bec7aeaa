// The classic cases of crowds, tests/scenario/classic: each file there is played as it stands, and judged by what
// everybody would see. Who is named in a file arrives before its `seconds` are over.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "runtime/simulation/scenario.h"
#include "runtime/simulation/simulation.h"

namespace flaneur {
namespace {

constexpr float kDeepestTouch_m = 0.02f, kIntoWall_m = 0.001f;
constexpr float kStandstill_m = 0.3f, kLongestStandstill_s = 8, kMinPace = 0.5f, kSweptAlong_m = 1;

std::vector<std::filesystem::path> ScenarioFiles() {
  const std::filesystem::path folder = std::filesystem::path(FLANEUR_SOURCE_DIR) / "tests/scenario/classic";
  std::set<std::filesystem::path> sorted;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".toml") sorted.insert(entry.path());
  }
  return {sorted.begin(), sorted.end()};
}

std::string NameOf(const testing::TestParamInfo<std::filesystem::path>& info) {
  std::string name = info.param.stem().string();
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

class ClassicScenario : public testing::TestWithParam<std::filesystem::path> {
 protected:
  void SetUp() override {
    ASSERT_EQ(ReadScenario(GetParam(), &scenario).message, "");
    ASSERT_TRUE(scenario.seconds) << "says until when everybody has to have arrived";
    ASSERT_EQ(StartSimulation(nullptr, scenario, &simulation).message, "");
    ASSERT_GT(simulation.town.crowd.size(), 0u);
  }

  // look() sees every step, after it.
  template <typename Look>
  void Play(Look look) {
    while (Time_s(simulation) < *scenario.seconds && !HasFatalFailure()) {
      StepSimulation({}, 0, &simulation);
      look();
    }
  }

  const Crowd& crowd() const { return simulation.town.crowd; }
  const Walkable& walkable() const { return simulation.town.walkable; }
  std::string When(size_t i) const {
    return "person " + std::to_string(crowd().id[i]) + " at " + std::to_string(Time_s(simulation)) + " s";
  }

  Scenario scenario;
  Simulation simulation;
};

struct Seen {
  Vec2 position;
  float at_s = 0;
};  // by id; since when they have not left this place

float ToSegment_m(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 along = b - a;
  return Length(p - a - along * std::clamp(Dot(p - a, along) / Dot(along, along), 0.0f, 1.0f));
}

bool Crosses(Vec2 p, Vec2 q, Vec2 a, Vec2 b) {
  const auto side = [](Vec2 from, Vec2 to, Vec2 point) { return Cross(to - from, point - from) > 0; };
  return side(p, q, a) != side(p, q, b) && side(a, b, p) != side(a, b, q);
}

TEST_P(ClassicScenario, EverybodyArrivesInTime) {
  std::set<int> expected;  // the others have gone after their last goal
  for (size_t k = 0; k < scenario.persons.size(); ++k) {
    if (scenario.persons[k].stay) expected.insert(crowd().id[k]);
  }
  std::set<int> left;
  const int named = static_cast<int>(scenario.persons.size());
  Play([] {});
  for (int id : crowd().id) {
    if (id < named) left.insert(id);
  }
  EXPECT_EQ(left, expected) << "after " << *scenario.seconds << " s";
}

TEST_P(ClassicScenario, WhoIsStillOnTheWayHasKeptWalking) {
  Play([] {});
  for (size_t i = 0; i < crowd().size(); ++i) {
    if (crowd().field[i] < 0) continue;
    EXPECT_GE(crowd().walked_m[i], kMinPace * crowd().preferred_mps[i] * *scenario.seconds) << When(i);
  }
}

TEST_P(ClassicScenario, NobodyIsStuck) {
  std::vector<Seen> seen(crowd().size());
  for (size_t i = 0; i < crowd().size(); ++i) seen[static_cast<size_t>(crowd().id[i])].position = crowd().position[i];
  Play([&] {
    for (size_t i = 0; i < crowd().size(); ++i) {
      Seen& last = seen[static_cast<size_t>(crowd().id[i])];
      const bool stands = crowd().field[i] >= 0 && Length(crowd().position[i] - last.position) < kStandstill_m;
      if (!stands) last = {crowd().position[i], Time_s(simulation)};
      ASSERT_LT(Time_s(simulation) - last.at_s, kLongestStandstill_s) << When(i);
    }
  });
}

TEST_P(ClassicScenario, NobodyOverlaps) {
  Play([&] {
    for (size_t i = 0; i < crowd().size(); ++i) {
      for (size_t j = 0; j < i; ++j) {
        const float apart_m = Length(crowd().position[i] - crowd().position[j]);
        const float touching_m = crowd().radius_m[i] + crowd().radius_m[j];
        ASSERT_GE(apart_m, touching_m - kDeepestTouch_m) << When(i) << " and person " << crowd().id[j];
      }
    }
  });
}

TEST_P(ClassicScenario, NobodyWalksIntoAWallOrThroughOne) {
  std::vector<Vec2> before(crowd().size());
  for (size_t i = 0; i < crowd().size(); ++i) before[static_cast<size_t>(crowd().id[i])] = crowd().position[i];
  Play([&] {
    for (size_t i = 0; i < crowd().size(); ++i) {
      const Vec2 p = crowd().position[i];
      Vec2& last = before[static_cast<size_t>(crowd().id[i])];
      ASSERT_TRUE(OnGround(walkable(), p)) << When(i);
      for (const Walkable::Edge& edge : walkable().edges) {
        ASSERT_FALSE(Crosses(last, p, edge.a, edge.b)) << When(i);
        ASSERT_GE(ToSegment_m(p, edge.a, edge.b), crowd().radius_m[i] - kIntoWall_m) << When(i);
      }
      for (const CircleObstacle& circle : walkable().circles) {
        ASSERT_GE(Length(p - circle.center), circle.radius_m + crowd().radius_m[i] - kIntoWall_m) << When(i);
      }
      last = p;
    }
  });
}

TEST_P(ClassicScenario, WhoStaysIsWalkedRoundAndNotSweptAlong) {
  Play([&] {
    for (size_t i = 0; i < crowd().size(); ++i) {
      const auto id = static_cast<size_t>(crowd().id[i]);
      if (id >= scenario.persons.size() || !scenario.persons[id].goals_m.empty()) continue;
      ASSERT_LE(Length(crowd().position[i] - scenario.persons[id].position_m), kSweptAlong_m) << When(i);
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Files, ClassicScenario, testing::ValuesIn(ScenarioFiles()), NameOf);

}  // namespace
}  // namespace flaneur
