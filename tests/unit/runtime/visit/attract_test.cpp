// The tour shows itself, hour after hour, in towns with and without stops.
#include "runtime/visit/attract.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/unit/runtime/simulation/tour_town.h"

namespace flaneur {
namespace {

constexpr float kFastest_mps = 1.5f, kFastestTurn_radps = 1;

struct Shown {
  std::set<size_t> stops;  // that were visited
  std::set<int> squares;   // of 8 m that were seen
  float longest_rest_s = 0;
};

Shown ShowFor(float seconds, TourPack pack) {
  Simulation s = Started(pack);
  s.visitor.gentle = true;
  Attract attract;
  BeginAttract(s, &attract);
  Shown shown;
  float rests_s = 0, yaw_rad = s.visitor.camera.view.yaw_rad;
  for (float t = 0; t < seconds; t += Step_s(s)) {
    const Vec2 before = s.visitor.camera.view.position;
    StepSimulation(NextOfAttract(s, &attract), 0, &s);
    const Vec2 at = s.visitor.camera.view.position;
    EXPECT_FALSE(InsideObstacle(s.town.walkable, at)) << "the camera is in a wall after " << t << " s";
    EXPECT_LE(Length(at - before), kFastest_mps * Step_s(s));
    EXPECT_LE(std::abs(std::remainder(s.visitor.camera.view.yaw_rad - yaw_rad, 2 * kPi)),
              kFastestTurn_radps * Step_s(s));
    yaw_rad = s.visitor.camera.view.yaw_rad;
    rests_s = Length(at - before) > 0 ? 0 : rests_s + Step_s(s);
    shown.longest_rest_s = std::max(shown.longest_rest_s, rests_s);
    shown.squares.insert(static_cast<int>(at.x / 8) * 100 + static_cast<int>(at.y / 8));
    for (size_t k = 0; k < pack.path.size(); ++k) {
      if (Length(pack.path[k].position_m - at) < 1.5f) shown.stops.insert(k);
    }
    if (::testing::Test::HasFailure()) break;
  }
  return shown;
}

TEST(Attract, LeadsAlongAllStopsAgainAndAgain) {
  for (const int people : {0, 60}) {
    const Shown shown = ShowFor(420, TourTown(people));
    EXPECT_EQ(shown.stops.size(), TourTown(0).path.size()) << people;
    EXPECT_LT(shown.longest_rest_s, 25) << people;
  }
}

TEST(Attract, WalksAboutInTownsWithoutStops) {
  TourPack pack = TourTown(60);
  pack.path.clear();
  pack.guide.clear();
  const Shown shown = ShowFor(420, pack);
  EXPECT_GT(shown.squares.size(), 8u);
  EXPECT_LT(shown.longest_rest_s, 25);
}

TEST(Attract, GoesOnFromWhereTheVisitorLeft) {
  Simulation s = Started(TourTown(0));
  s.visitor.camera.view.position = {52, 14};
  Attract attract;
  BeginAttract(s, &attract);
  EXPECT_EQ(attract.next, 5u) << "the nearest stop";
}

}  // namespace
}  // namespace flaneur
