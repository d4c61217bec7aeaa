// The same bits from every compiler setting and on every machine: a scene of everything people do, against the hash it
// always gave. A change of how people walk changes the hash on purpose: then the new one, which the failing test
// prints, belongs here, if it is the same in a debug and a release build.
#include <gtest/gtest.h>

#include "runtime/crowd/crowd.h"
#include "runtime/crowd/fast_math.h"

namespace flaneur {
namespace {

constexpr float kStep_s = 1.0f / 30;
constexpr int kSteps = 300;
constexpr uint64_t kHash = 6054346952704133265ull;

// A square of 40 m that slopes gently to the north, with a pavement, a house, a wall with a doorway and trees.
Walkable Place() {
  Walkable w;
  GroundRaster ground{{-20, -20}, 0.5f, 80, 80, std::vector<float>(6400, 0), std::vector<uint8_t>(6400, 3)};
  for (size_t k = 0; k < 6400; ++k) {
    ground.height_m[k] = 0.02f * static_cast<float>(k / 80);
    if (k % 80 > 60) ground.kind[k] = 2;
  }
  w.ground = Share(std::move(ground));
  w.polygons.push_back({{{-8, -3}, {-3, -3}, {-3, 3}, {-8, 3}}, {}});
  w.polygons.push_back({{{5, -20}, {5.3f, -20}, {5.3f, -0.75f}, {5, -0.75f}}, {}});
  w.polygons.push_back({{{5, 0.75f}, {5.3f, 0.75f}, {5.3f, 20}, {5, 20}}, {}});
  w.circles.push_back({{0, 6}, 0.5f});
  w.circles.push_back({{11, -7}, 0.3f});
  BuildWalkable(0.3f, &w);
  return w;
}

// Walkers, pairs and people who stand, in view, at its edge and out of it.
Crowd People(const Walkable& w) {
  Crowd c;
  Random random{11};
  while (c.size() < 220) {
    Person p;
    p.position = {random.Uniform(-19, 19), random.Uniform(-19, 19)};
    if (!IsFree(w, p.position)) continue;
    p.preferred_mps = random.Uniform(1.0f, 1.6f);
    p.heading_rad = random.Uniform(-3, 3);
    if (c.size() % 9 != 0)
      p.field = FieldFor({p.position.x > 0 ? -17.0f : 17.0f, static_cast<float>(random.Below(5)) * 8 - 16}, &c);
    AddPerson(p, &c);
    c.view.back() = static_cast<ViewClass>(c.size() % 3);
    c.avoids_camera.back() = c.size() % 2 == 0 ? 1 : 0;
  }
  for (int k = 100; k < 140; k += 4) AddGroup({k, k + 1, k + 2}, &c);
  return c;
}

bool AlwaysFree(Vec2, float, const void*) { return false; }

uint64_t HashOfTheScene(bool keeps_scratch) {
  const Walkable w = Place();
  Crowd c = People(w);
  CrowdScratch scratch;
  for (int step = 0; step < kSteps; ++step) {
    if (!keeps_scratch) scratch = {};
    const Vec2 visitor{-12 + 0.03f * static_cast<float>(step), 8};
    StepCrowd(w, {{visitor, 0.6f, true, {0.9f, 0}}, {visitor, 3, false, {0.9f, 0}}}, kStep_s, &scratch, &c);
    if (!keeps_scratch) scratch = {};
    if (step % 10 == 0) SeparateBoundary(w, AlwaysFree, nullptr, &scratch, &c);
    if (step == 100) c.detour[5] = {0.3f, 1}, c.detour_s[5] = 2;
    if (step == 150) RemovePerson(101, &c), SetGoal(7, FieldFor({0, -15}, &c), &c);
  }
  return StateHash(c);
}

TEST(Crowd, GivesTheSameBitsInEveryBuild) {
  const uint64_t hash = HashOfTheScene(true);
  EXPECT_EQ(hash, kHash) << "now " << hash << "ull";
}

TEST(Crowd, KeepsNothingInItsScratchFromOnePassToTheNext) { EXPECT_EQ(HashOfTheScene(false), kHash); }

}  // namespace
}  // namespace flaneur
