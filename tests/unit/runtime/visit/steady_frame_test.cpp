// A steady frame allocates nothing of ours, and takes few draw calls however many people it shows: operator new is
// counted in this program.
#include <gtest/gtest.h>

#include <filesystem>

#include "runtime/desktop/context.h"
#include "runtime/render/renderer.h"
#include "runtime/show/frame_from_simulation.h"
#include "runtime/simulation/scenario.h"
#include "tests/soak/drivers_stay_loaded.h"
#include "tests/unit/allocations.h"

namespace flaneur {
namespace {

constexpr int kMaxDrawCalls = 84;

class SteadyFrameOfTheDemo : public testing::Test {
 protected:
  void SetUp() override {
    const std::filesystem::path path = source / "build_assets/wolfenbuettel/wolfenbuettel.glb";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path << ": bake the demo tour with ./demo";
    ASSERT_EQ(LoadTourPack(path, {}, &pack).message, "");
  }
  void Start(const char* scenario_file) {
    Scenario scenario = ScenarioOf(pack);
    ASSERT_EQ(ReadScenario(source / scenario_file, &scenario).message, "");
    ASSERT_EQ(StartSimulation(&pack, scenario, &simulation).message, "");
  }

  const std::filesystem::path source = FLANEUR_SOURCE_DIR;
  TourPack pack;
  Simulation simulation;
};

TEST_F(SteadyFrameOfTheDemo, AllocatesNothingAndTakesFewDrawCallsForTenThousandPeople) {
  HeadlessContext context;
  if (const Error error = context.Create()) GTEST_SKIP() << error.message;
  Renderer renderer;
  ASSERT_EQ(renderer.Create(pack).message, "");
  FrameInput frame;
  frame.eye = {-34, -5, 1.65f};
  frame.yaw_rad = 0.17f;
  frame.to_sun = Normalized(Vec3{-0.5f, 0.4f, 0.6f});
  const int avatars = static_cast<int>(pack.avatars.size());
  for (int i = 0; i < 10000; ++i) {  // a field of them before the eye, near ones as meshes and some of them fading
    DrawnPerson person;
    person.avatar = i % avatars;
    person.level = i < 24
                       ? MeshLevel(i % static_cast<int>(pack.avatars[static_cast<size_t>(person.avatar)].levels.size()))
                       : kImpostor;
    person.position = {-31 + 0.6f * static_cast<float>(i / 100), -35 + 0.6f * static_cast<float>(i % 100), 0};
    if (i % 8 == 3) person.share_to = 0.6f;
    person.moment.phase = static_cast<float>(i % 31) / 31;
    frame.people.push_back(person);
  }
  FrameStatistics statistics;
  const auto draw = [&](int first, int last, int most_calls = kMaxDrawCalls) {
    for (int k = first; k < last; ++k) {
      frame.yaw_rad = 0.17f + 0.01f * static_cast<float>(k);
      frame.resolution_scale =
          k % 4 == 3 ? 1.0f : 0.5f + 0.1f * static_cast<float>(k % 4);  // it may change at any time
      renderer.Draw(frame, 160, 90, &statistics);
      EXPECT_LE(statistics.draw_calls, most_calls) << k;
      EXPECT_GT(statistics.people_drawn, 1000);
    }
  };
  draw(0, 1, kMaxDrawCalls + 12);  // all of the town's shadows at once
  draw(1, 24);  // until all shadows have been drawn, and Mesa's compiler, which is C++ too, has seen everything
  const long before = allocations;
  draw(0, 4);
  EXPECT_EQ(allocations - before, 0);
  std::printf("allocations in 4 steady pictures: %ld; draw calls: %d\n", allocations - before, statistics.draw_calls);
}

TEST_F(SteadyFrameOfTheDemo, OfTheSimulationIsPutTogetherWithoutAllocating) {
  ASSERT_NO_FATAL_FAILURE(Start("assets_src/wolfenbuettel/film.toml"));
  PersonLooks looks;
  FrameInput frame;
  long allocated = 0;
  for (int k = 0; k < 300; ++k) {
    StepSimulation({}, 0, &simulation);
    const long before = allocations;
    FrameFromSimulation(pack, simulation, &looks, &frame);
    if (k >= 220) allocated += allocations - before;  // once the first caption has come
  }
  EXPECT_GT(frame.people.size(), 10u);
  EXPECT_EQ(allocated, 0);
}

TEST_F(SteadyFrameOfTheDemo, PeopleCastNoMoreShadowThanTheBudgetCounts) {
  ASSERT_NO_FATAL_FAILURE(Start("tests/scenario/turn-dense.toml"));
  HeadlessContext context;
  if (const Error error = context.Create()) GTEST_SKIP() << error.message;
  Renderer renderer;
  ASSERT_EQ(renderer.Create(pack).message, "");
  PersonLooks looks;
  FrameInput frame;
  FrameStatistics statistics;
  for (int k = 0; k < 60; ++k) {
    StepSimulation({}, 0, &simulation);
    FrameFromSimulation(pack, simulation, &looks, &frame);
    renderer.Draw(frame, 160, 90, &statistics);
    EXPECT_LE(statistics.people_shadow_triangles, simulation.control.levels.shadows.triangles) << k;
    EXPECT_LE(simulation.control.levels.triangles + simulation.control.levels.shadows.triangles,
              simulation.control.settings.budget_triangles)
        << k;
  }
  EXPECT_GT(statistics.people_shadow_triangles, 1000);
}

}  // namespace
}  // namespace flaneur
