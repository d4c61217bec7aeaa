// A step shared by several threads: the same bits as by one.
#include <gtest/gtest.h>

#include "runtime/base/jobs.h"
#include "runtime/crowd/constants.h"
#include "runtime/crowd/crowd.h"
#include "runtime/crowd/field_builder.h"
#include "tests/unit/runtime/crowd/open_field.h"

namespace flaneur {
namespace {

constexpr int kSteps = 90;
constexpr int kPeople = 6000;

// People of every kind of view, in groups and alone, on detours, with goals that many share and that nobody else has.
struct Scene {
  OpenField field = MakeOpenField(kPeople, 6, 5, 0.6f);

  Scene() {
    Crowd& c = field.crowd;
    Random random{3};
    for (size_t i = 0; i < c.size(); ++i) {
      c.view[i] = static_cast<ViewClass>(random.Below(3));
      c.avoids_camera[i] = i % 2 == 0 ? 1 : 0;
      if (i % 11 == 0) SendAside(i, &random);
      if (i % 13 == 0) c.detour[i] = {0.5f, 0.8f}, c.detour_s[i] = random.Uniform(0, 3);
    }
    for (int k = 0; k + 3 < kPeople; k += 4) {
      SetGoal(static_cast<size_t>(k + 1), c.field[static_cast<size_t>(k)], &c);
      AddGroup({k, k + 1}, &c);
    }
    c.viewer = {0.5f * field.side_m, 0.5f * field.side_m};
    c.r_unimportant_m = 0.2f * field.side_m;
    c.r_far_m = 0.45f * field.side_m;
  }
  void SendAside(size_t i, Random* random) {
    const Vec2 somewhere{random->Uniform(1, field.side_m - 1), random->Uniform(1, field.side_m - 1)};
    const int cell = NearestFreeCell(field.walkable, somewhere, 3);
    if (cell >= 0) SetGoal(i, FieldFor(CellCenter(field.walkable, cell), &field.crowd), &field.crowd);
  }
};

uint64_t HashAfter(size_t threads, bool fields_come_later) {
  Scene scene;
  OpenField& f = scene.field;
  Crowd& c = f.crowd;
  c.fields_come_later = fields_come_later;
  Jobs jobs(threads);
  FieldBuilder builder;
  Random random{9};
  for (int step = 0; step < kSteps; ++step) {
    if (c.step % kSortEvery_steps == 0) SortBySpace(&f.scratch, &c);
    if (fields_come_later) builder.Step(f.walkable, &jobs, &c);
    const Vec2 visitor{0.5f * f.side_m + 0.04f * static_cast<float>(step), 0.5f * f.side_m};
    StepCrowd(f.walkable, {{visitor, 0.6f, true, {1.2f, 0}}, {visitor, 3, false, {1.2f, 0}}}, kOpenFieldStep_s,
              &f.scratch, &c, &jobs);
    for (int k = 0; k < 20; ++k) scene.SendAside(static_cast<size_t>(random.Below(kPeople)), &random);
  }
  return StateHash(c);
}

TEST(Threads, TakeStepsInTheSameBits) {
  static_assert(kPeople > static_cast<int>(kFewPeople));
  for (bool later : {false, true}) {
    const uint64_t alone = HashAfter(0, later);
    for (size_t threads : {1u, 2u, 7u}) EXPECT_EQ(HashAfter(threads, later), alone) << threads;
  }
}

}  // namespace
}  // namespace flaneur
