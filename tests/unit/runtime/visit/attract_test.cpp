// The tour shows itself, hour after hour, in towns with and without stops.
#include "runtime/visit/attract.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <vector>

#include "runtime/crowd/fast_math.h"
#include "runtime/simulation/scenario.h"
#include "tests/unit/runtime/simulation/tour_town.h"

namespace flaneur {
namespace {

constexpr float kFastest_mps = 1.5f, kFastestTurn_radps = 0.4f, kFastestRise_mps = 0.8f;
constexpr float kRoom_m = 0.35f;  // around the eye, more than to the near plane
constexpr float kFromPosts_m = 0.6f;
constexpr float kJerk_m = 0.01f;  // from one step to the next: it sets out and stops gently

struct Shown {
  std::set<size_t> stops;  // that were visited
  std::set<int> squares;   // of 8 m that were seen
  float longest_rest_s = 0, highest_m = 0;
};

Shown ShowFor(float seconds, TourPack pack) {
  Simulation s = Started(pack);
  s.visitor.gentle = true;
  Attract attract;
  BeginAttract(s, false, &attract);
  Shown shown;
  float rests_s = 0, yaw_rad = s.visitor.camera.view.yaw_rad, walked_m = 0;
  float eye_m = s.visitor.camera.eye_height_m;
  for (float t = 0; t < seconds; t += Step_s(s)) {
    const Vec2 before = s.visitor.camera.view.position;
    StepSimulation(NextOfAttract(s, &attract), 0, &s);
    const Vec2 at = s.visitor.camera.view.position;
    EXPECT_FALSE(InsideObstacle(s.town.walkable, at)) << "the camera is in a wall after " << t << " s";
    const float rises_mps = std::abs(s.visitor.camera.eye_height_m - eye_m) / Step_s(s);
    EXPECT_LT(rises_mps, kFastestRise_mps) << "after " << t << " s";
    eye_m = s.visitor.camera.eye_height_m;
    shown.highest_m = std::max(shown.highest_m, eye_m);
    EXPECT_LT(std::abs(Length(at - before) - walked_m), kJerk_m) << "after " << t << " s";
    walked_m = Length(at - before);
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

using Triangle = std::array<Vec3, 3>;

// What is drawn within so much of what is flown over.
std::vector<Triangle> TownTriangles(const PackFile& file, const TourPack& pack) {
  std::vector<Triangle> all;
  for (const TownInstance& instance : pack.town) {
    PackMesh mesh;
    EXPECT_EQ(file.ReadMesh(instance.mesh, &mesh).message, "");
    for (const PackPrimitive& part : mesh.primitives) {
      for (size_t k = 0; k + 2 < part.indices.size(); k += 3) {
        Triangle triangle;
        for (size_t c = 0; c < 3; ++c)
          triangle[c] = GroundFromGltf(TransformPoint(instance.world, part.positions[part.indices[k + c]]));
        all.push_back(triangle);
      }
    }
  }
  return all;
}

// Moeller and Trumbore 1997, of a line from a to b.
bool Crosses(const Triangle& t, Vec3 a, Vec3 b) {
  const Vec3 along = b - a, e1 = t[1] - t[0], e2 = t[2] - t[0], p = Cross(along, e2);
  const float det = Dot(e1, p);
  if (std::abs(det) < 1e-9f) return false;
  const Vec3 from = a - t[0], q = Cross(from, e1);
  const float u = Dot(from, p) / det, v = Dot(along, q) / det, at = Dot(e2, q) / det;
  return u >= 0 && v >= 0 && u + v <= 1 && at >= 0 && at <= 1;
}

// Whether anything is within so much of the eye, to the sides, above, below, or on its way from the place before.
bool Touches(const std::vector<Triangle>& triangles, Vec3 before, Vec3 eye, float room_m) {
  std::vector<Vec3> ends{before};
  for (int k = 0; k < 8; ++k) {
    const Vec2 d = DirectionOf(2 * kPi * static_cast<float>(k) / 8) * room_m;
    ends.push_back(eye + Vec3{d.x, d.y, 0});
  }
  ends.push_back(eye + Vec3{0, 0, room_m});
  ends.push_back(eye - Vec3{0, 0, room_m});
  for (const Triangle& t : triangles) {
    constexpr float kNear_m = 12;  // larger than any triangle that stands in the way
    if (std::abs(t[0].x - eye.x) > kNear_m || std::abs(t[0].y - eye.y) > kNear_m) continue;
    if (std::any_of(ends.begin(), ends.end(), [&](Vec3 end) { return Crosses(t, eye, end); })) return true;
  }
  return false;
}

TEST(Attract, LeadsAlongAllStopsAgainAndAgain) {
  for (const int people : {0, 60}) {
    const Shown shown = ShowFor(420, TourTown(people));
    EXPECT_EQ(shown.stops.size(), TourTown(0).path.size()) << people;
    EXPECT_LT(shown.longest_rest_s, 25) << people;
    EXPECT_GT(shown.highest_m, 3) << "above everybody's heads";
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

TEST(Attract, WithLessMotionStandsAndIsElsewhereAtOnce) {
  Simulation s = Started(TourTown(30));
  Attract attract;
  BeginAttract(s, true, &attract);
  std::set<size_t> stops;
  for (int k = 0; k < 100 * 30; ++k) {
    const CameraState before = s.visitor.camera;
    StepSimulation(NextOfAttract(s, &attract), 0, &s);
    const CameraState& now = s.visitor.camera;
    if (!attract.leapt) {
      EXPECT_LT(Length(now.view.position - before.view.position), 1e-6f);
      EXPECT_LT(std::abs(now.view.yaw_rad - before.view.yaw_rad), 1e-6f);
      continue;
    }
    for (size_t stop = 0; stop < s.visitor.tour.stops.size(); ++stop) {
      if (Length(s.visitor.tour.stops[stop].position_m - now.view.position) < 0.1f) stops.insert(stop);
    }
  }
  EXPECT_GT(stops.size(), 4u);
}

// What stands in the town, as it is drawn: no wall, roof, crown of a tree or vault is flown through.
TEST(AttractOfTheDemo, FliesThroughNothing) {
  const std::filesystem::path path =
      std::filesystem::path(FLANEUR_SOURCE_DIR) / "build_assets/wolfenbuettel/wolfenbuettel.glb";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path << ": bake the demo tour with ./demo";
  TourPack pack;
  PackFile file;
  ASSERT_EQ(file.Open(path, &pack).message, "");
  Scenario scenario = ScenarioOf(pack);
  scenario.crowd.people = 0;
  Simulation s;
  Jobs jobs(0);
  ASSERT_EQ(StartSimulation(&pack, scenario, &s, &jobs).message, "");
  const std::vector<Triangle> triangles = TownTriangles(file, pack);
  ASSERT_GT(triangles.size(), 1000u);
  Attract attract;
  BeginAttract(s, false, &attract);
  std::optional<Vec3> last;
  float highest_m = 0, way_m = 0, to_posts_m = 10;
  for (int k = 0; k < 500 * 30; ++k) {
    StepSimulation(NextOfAttract(s, &attract), 0, &s);
    const Vec2 p = s.visitor.camera.view.position;
    const Vec3 eye{p.x, p.y, HeightAt(s.town.walkable, p) + s.visitor.camera.eye_height_m};
    highest_m = std::max(highest_m, s.visitor.camera.eye_height_m);
    for (const CircleObstacle& post : s.town.walkable.circles)
      to_posts_m = std::min(to_posts_m, Length(p - post.center) - post.radius_m);
    if (last && Length(eye - *last) < 0.4f) continue;
    EXPECT_FALSE(Touches(triangles, last.value_or(eye), eye, kRoom_m)) << eye.x << " " << eye.y << " " << eye.z;
    way_m += last ? Length(eye - *last) : 0;
    last = eye;
  }
  EXPECT_GT(to_posts_m, kFromPosts_m) << "lamps and trees";
  EXPECT_GT(highest_m, 3.5f);
  EXPECT_GT(way_m, 200);
}

TEST(Attract, GoesOnFromWhereTheVisitorLeft) {
  Simulation s = Started(TourTown(0));
  s.visitor.camera.view.position = {52, 14};
  Attract attract;
  BeginAttract(s, false, &attract);
  EXPECT_EQ(attract.next, 5u) << "the nearest stop";
}

}  // namespace
}  // namespace flaneur
