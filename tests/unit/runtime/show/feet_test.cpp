// Do feet stand still on the ground while their owner walks? On the baked demo tour's own people.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "runtime/show/frame_from_simulation.h"
#include "tests/unit/runtime/show/posed_person.h"

namespace flaneur {
namespace {

constexpr float kSole_m =
    0.015f;  // what is no higher than this above a person's lowest point in both pictures is standing
constexpr float kMaxLift_m = 0.05f;  // of the lowest point above the ground
constexpr float kMaxSlide = 0.10f;   // of the walking speed

// Everybody of the pack side by side, each on the way straight to the east.
Scenario Parade(const TourPack& pack) {
  Scenario scenario = ScenarioOf(pack);
  scenario.has_ground = true;
  scenario.ground_min_m = {-5, -5};
  scenario.ground_max_m = {45, 3.0f * static_cast<float>(pack.avatars.size()) + 5};
  scenario.crowd.people = 0;
  for (size_t a = 0; a < pack.avatars.size(); ++a) {
    ScenarioPerson person;
    person.position_m = {0, 3.0f * static_cast<float>(a)};
    person.goals_m = {{40, person.position_m.y}};
    person.avatar = pack.avatars[a].name;
    person.stay = true;
    scenario.persons.push_back(person);
  }
  return scenario;
}

float Median(std::vector<float> v) {
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

float Lowest(const std::vector<Vec3>& points) {
  return std::min_element(points.begin(), points.end(), [](Vec3 a, Vec3 b) { return a.z < b.z; })->z;
}

// Speed over the ground of what stands on it.
float SlideSpeed(const std::vector<Vec3>& before, const std::vector<Vec3>& now, float step_s) {
  const float sole_before = Lowest(before) + kSole_m, sole_now = Lowest(now) + kSole_m;
  std::vector<float> speeds;
  for (size_t i = 0; i < now.size(); ++i) {
    if (before[i].z > sole_before || now[i].z > sole_now) continue;
    speeds.push_back(Length(Vec2{now[i].x - before[i].x, now[i].y - before[i].y}) / step_s);
  }
  return speeds.empty() ? -1 : Median(speeds);
}

TEST(FeetOfTheDemo, StandStillWhileTheirOwnerWalks) {
  const std::filesystem::path path =
      std::filesystem::path(FLANEUR_SOURCE_DIR) / "build_assets/wolfenbuettel/wolfenbuettel.glb";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "the demo tour is not baked";
  TourPack pack;
  ASSERT_EQ(LoadTourPack(path, {}, &pack).message, "");
  Simulation s;
  ASSERT_EQ(StartSimulation(&pack, Parade(pack), &s).message, "");
  PersonLooks looks;
  FrameInput frame;
  const int first = 60, frames = 60;  // once everybody is on the way
  std::vector<std::vector<Vec3>> last(pack.avatars.size());
  std::vector<std::vector<float>> slides(pack.avatars.size());
  for (int f = 0; f < first + frames; ++f) {
    StepSimulation({}, 0, &s);
    FrameFromSimulation(pack, s, &looks, &frame);
    if (f < first) continue;
    for (const DrawnPerson& person : frame.people) {
      const auto who = static_cast<size_t>(person.avatar);
      if (person.share_from > 0) continue;  // the level that fades out
      ASSERT_EQ(person.moment.clip, ClipKind::kWalk) << pack.avatars[who].name;
      std::vector<Vec3> now = PosedPerson(pack, person);
      EXPECT_LT(std::abs(Lowest(now) - person.position.z), kMaxLift_m) << pack.avatars[who].name;
      if (!last[who].empty()) slides[who].push_back(SlideSpeed(last[who], now, Step_s(s)));
      last[who] = std::move(now);
    }
  }
  for (size_t who = 0; who < pack.avatars.size(); ++who) {
    SCOPED_TRACE(pack.avatars[who].name);
    if (IsBird(pack, pack.avatars[who].name)) continue;  // would have to run here as people walk
    std::vector<float> standing;
    std::copy_if(slides[who].begin(), slides[who].end(), std::back_inserter(standing), [](float v) { return v >= 0; });
    ASSERT_GT(standing.size(), slides[who].size() / 2) << "no foot is on the ground most of the time";
    const float speed_mps = Length(s.town.crowd.velocity[who]);
    const bool on_four = pack.avatars[who].name.ends_with("dog") ||
                         pack.avatars[who].name == "horse";  // of whose paws two or three stand at a time
    EXPECT_LT(Median(standing), (on_four ? 2 : 1) * kMaxSlide * speed_mps);
  }
}

}  // namespace
}  // namespace flaneur
