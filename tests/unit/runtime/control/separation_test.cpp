// Separation in the boundary (paper, section 4.3.1), as the player does it: at once, and never into view.
#include <gtest/gtest.h>

#include <cmath>

#include "runtime/control/view_volumes.h"

namespace flaneur {
namespace {

CrowdScratch scratch;
constexpr float kBack_m = 8;

// A square of 40 m with a house and a lamp post.
Walkable Square() {
  Walkable w;
  w.ground = Share({{-20, -20}, 0.5f, 80, 80, std::vector<float>(6400, 0), std::vector<uint8_t>(6400, 3)});
  w.polygons.push_back({{{-8, -3}, {-3, -3}, {-3, 3}, {-8, 3}}, {}});
  w.circles.push_back({{2, 6}, 0.5f});
  BuildWalkable(0.3f, &w);
  return w;
}

bool InView(Vec2 p, float reach_m, const void* volume) {
  const auto* camera = static_cast<const ViewCamera*>(volume);
  return Classify(p, reach_m, *camera, 0) != ViewClass::kOutside;
}

// Up to twelve people in a knot of half a metre, standing in each other.
void AddKnot(const Walkable& w, const ViewCamera& camera, Random* random, Crowd* crowd) {
  const Vec2 middle{random->Uniform(-18, 18), random->Uniform(-18, 18)};
  for (int k = 1 + random->Below(12); k > 0; --k) {
    Person p;
    p.radius_m = random->Uniform(0.2f, 0.3f);
    p.reach_m = 0.6f;
    p.position = middle + Vec2{random->Uniform(-0.5f, 0.5f), random->Uniform(-0.5f, 0.5f)};
    if (!IsFree(w, p.position)) continue;
    AddPerson(p, crowd);
    crowd->view.back() = Classify(p.position, crowd->reach_m.back(), camera, kBack_m);
  }
}

bool InTheWay(const Crowd& c, size_t i, size_t j) {
  return i != j && c.view[j] != ViewClass::kOutside &&
         Length(c.position[i] - c.position[j]) < c.radius_m[i] + c.radius_m[j] - 0.002f;
}

TEST(Separation, IsAtOnceAndNeverIntoViewNorIntoWalls) {
  const Walkable w = Square();
  Random random{17};
  int moved = 0;
  for (int round = 0; round < 300; ++round) {
    const ViewCamera camera{{random.Uniform(-10, 10), random.Uniform(-10, 10)}, random.Uniform(-kPi, kPi), 1.05f};
    Crowd crowd;
    for (int knot = 0; knot < 10; ++knot) AddKnot(w, camera, &random, &crowd);
    const Crowd before = crowd;
    SeparateBoundary(w, InView, &camera, &scratch, &crowd);
    for (size_t i = 0; i < crowd.size(); ++i) {
      const float way_m = Length(crowd.position[i] - before.position[i]);
      if (crowd.view[i] != ViewClass::kBoundary) {
        ASSERT_EQ(way_m, 0) << "only the boundary is separated";
        continue;
      }
      moved += way_m > 0 ? 1 : 0;
      ASSERT_FALSE(InView(crowd.position[i], crowd.reach_m[i], &camera));
      ASSERT_TRUE(IsFree(w, crowd.position[i]));
      for (size_t j = 0; j < crowd.size(); ++j) ASSERT_FALSE(InTheWay(crowd, i, j)) << "round " << round;
    }
  }
  EXPECT_GT(moved, 1000);
}

// Who is just out of view was drawn a moment ago: a leap from there could be told.
TEST(Separation, WhoWasVisibleAMomentAgoStaysAndOthersMakeRoom) {
  const Walkable w = Square();
  const ViewCamera camera{{0, -15}, kPi / 2, 1.05f};
  for (const size_t seen : {0, 1}) {
    Crowd crowd;
    for (int k = 0; k < 2; ++k) {
      Person p;
      p.position = {-6 + 0.2f * static_cast<float>(k), -8};
      p.radius_m = 0.25f;
      AddPerson(p, &crowd);
      crowd.view.back() = ViewClass::kBoundary;
    }
    crowd.was_visible[seen] = 1;
    const Crowd before = crowd;
    SeparateBoundary(w, InView, &camera, &scratch, &crowd);
    EXPECT_EQ(Length(crowd.position[seen] - before.position[seen]), 0);
    EXPECT_FALSE(InTheWay(crowd, 0, 1));
  }
}

}  // namespace
}  // namespace flaneur
