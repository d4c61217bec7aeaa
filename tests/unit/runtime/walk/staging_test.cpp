// How the guide is seen on random guided tours through random towns: clear of what the visitor looks at, whole, and not
// under the caption.
#include "runtime/walk/staging.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "runtime/crowd/fast_math.h"
#include "tests/unit/runtime/simulation/tour_town.h"

namespace flaneur {
namespace {

constexpr float kHalfWidth_m = 0.3f, kHeight_m = 1.75f;  // of the guide
constexpr float kCaption = 0.62f;                        // of the picture's width, from the edge away from the guide
constexpr int kTowns = 8, kSteps = 30 * 600;

// Blocks of houses between streets of 2.4 to 8 m; one or two blocks are squares.
struct RandomTown {
  explicit RandomTown(uint64_t seed) : random(seed) {
    pack = TourTown(40);
    pack.crowd.seed = seed;
    const std::vector<float> xs = Lines(), ys = Lines();
    const float width_m = xs.back() + 10, depth_m = ys.back() + 10;
    const int columns = static_cast<int>(width_m * 2), rows = static_cast<int>(depth_m * 2);
    const size_t cells = static_cast<size_t>(columns) * static_cast<size_t>(rows);
    pack.ground = Share({{0, 0}, 0.5f, columns, rows, std::vector<float>(cells, 0), std::vector<uint8_t>(cells, 3)});
    pack.obstacles.polygons.clear();
    const size_t square = 1 + Below(2);
    for (size_t i = 0; i + 1 < xs.size(); i += 2) {
      for (size_t j = 0; j + 1 < ys.size(); j += 2) {
        if (i == 2 * square && j == 2) continue;
        pack.obstacles.polygons.push_back(Box({xs[i], ys[j]}, {xs[i + 1], ys[j + 1]}));
      }
    }
    for (size_t i = 1; i + 1 < xs.size(); i += 2) streets_x.push_back((xs[i] + xs[i + 1]) / 2);
    for (size_t j = 1; j + 1 < ys.size(); j += 2) streets_y.push_back((ys[j] + ys[j + 1]) / 2);
    pack.places = {{"one", "exit", {streets_x.front(), 1}, 2}, {"other", "exit", {1, streets_y.back()}, 2}};
    pack.path.clear();
    Vec2 before{-100, -100};
    while (pack.path.size() < 8) {
      const Vec2 p = Below(2) ? Vec2{streets_x[Below(streets_x.size())], Between(ys.front(), ys.back())}
                              : Vec2{Between(xs.front(), xs.back()), streets_y[Below(streets_y.size())]};
      if (Length(p - before) < 12) continue;
      before = p;
      pack.path.push_back(pack.path.size() % 2 == 0 ? Waypoint(p) : Halt(p, OpenYaw(p), 5));
    }
  }
  // Borders of blocks: block, street, block, ...
  std::vector<float> Lines() {
    std::vector<float> lines{5};
    for (int k = 0; k < 4; ++k) {
      lines.push_back(lines.back() + Between(8, 14));
      lines.push_back(lines.back() + Between(2.4f, 8));
    }
    lines.push_back(lines.back() + Between(8, 14));
    return lines;
  }
  bool IsBuilt(Vec2 p) const {
    for (const PolygonObstacle& o : pack.obstacles.polygons) {
      if (p.x > o.outer[0].x && p.x < o.outer[2].x && p.y > o.outer[0].y && p.y < o.outer[2].y) return true;
    }
    return false;
  }
  // A direction in which there is something to see: not the next wall.
  float OpenYaw(Vec2 p) {
    for (int tries = 0;; ++tries) {
      const float yaw_rad = Between(-kPi, kPi);
      bool open = true;
      for (float far_m = 0; far_m < 9; far_m += 0.3f) open = open && !IsBuilt(p + DirectionOf(yaw_rad) * far_m);
      if (open || tries > 400) return yaw_rad;
    }
  }
  size_t Below(size_t end) { return random() % end; }
  float Between(float least, float most) { return std::uniform_real_distribution<float>(least, most)(random); }

  std::mt19937_64 random;
  TourPack pack;
  std::vector<float> streets_x, streets_y;
};

// Where the guide is in the picture; -1 to 1 from its left to its right and from its lower to its upper edge.
struct Seen {
  float left = 0, right = 0, feet = 0;
  bool ahead = false;

  bool InMiddleThird() const { return ahead && right > -1 / 3.0f && left < 1 / 3.0f; }
  bool Whole() const { return ahead && left > -1 && right < 1 && feet > -1; }
  bool UnderCaption(bool guide_is_left) const {
    const float edge = 2 * kCaption - 1;
    return ahead && (guide_is_left ? right > -edge : left < edge);
  }
};

Seen GuideSeen(const Simulation& s) {
  const CameraState& c = s.visitor.camera;
  const Vec2 off = s.town.crowd.position[s.visitor.guide.index] - c.view.position;
  const Vec2 look = DirectionOf(c.view.yaw_rad);
  const float depth_m = Dot(off, look), right_m = -Cross(look, off);
  Seen seen;
  if (depth_m < 0.3f) return seen;
  const float half_m = depth_m * std::tan(c.view.fov_rad / 2);
  seen.ahead = true;
  seen.left = (right_m - kHalfWidth_m) / half_m;
  seen.right = (right_m + kHalfWidth_m) / half_m;
  seen.feet = -c.eye_height_m * c.aspect / half_m;
  return seen;
}

struct Shares {
  int walking = 0, walking_in_middle = 0, walking_whole = 0;
  int resting = 0, resting_in_middle = 0, resting_whole = 0, under_caption = 0;
  int finished = 0;

  float Of(int part, int whole) const { return whole > 0 ? static_cast<float>(part) / static_cast<float>(whole) : 0; }
};

void Watch(const Simulation& s, Shares* shares) {
  const Seen seen = GuideSeen(s);
  const GuidedTour& t = s.visitor.tour;
  if (t.over) return;
  if (!t.resting) {
    if (s.visitor.camera.actual_mps < 0.3f) return;
    ++shares->walking;
    shares->walking_in_middle += seen.InMiddleThird();
    shares->walking_whole += seen.Whole();
  } else if (t.rested_s > 2) {
    ++shares->resting;
    shares->resting_in_middle += seen.InMiddleThird();
    shares->resting_whole += seen.Whole();
    shares->under_caption += seen.UnderCaption(s.visitor.guide.is_left);
  }
}

Shares WatchTowns(float fov_rad, float aspect) {
  Shares shares;
  for (uint64_t seed = 1; seed <= kTowns; ++seed) {
    const RandomTown town(seed);
    Scenario scenario = ScenarioOf(town.pack);
    scenario.control.fov_rad = fov_rad;
    scenario.screen_height_px = static_cast<int>(static_cast<float>(scenario.screen_width_px) / aspect);
    Simulation s;
    const Error e = StartSimulation(&town.pack, scenario, &s);
    EXPECT_FALSE(e) << e.message;
    Shares own;
    for (int step = 0; step < kSteps && !s.visitor.finished; ++step) {
      StepSimulation({}, 0, &s);
      Watch(s, &own);
    }
    std::printf("town %d: walking %.2f in the middle, %.2f whole; resting %.2f, %.2f, %.2f under the caption; %s\n",
                static_cast<int>(seed), own.Of(own.walking_in_middle, own.walking),
                own.Of(own.walking_whole, own.walking), own.Of(own.resting_in_middle, own.resting),
                own.Of(own.resting_whole, own.resting), own.Of(own.under_caption, own.resting),
                s.visitor.finished ? "to the end" : "not to the end");
    shares.walking += own.walking, shares.walking_in_middle += own.walking_in_middle;
    shares.walking_whole += own.walking_whole, shares.resting += own.resting;
    shares.resting_in_middle += own.resting_in_middle, shares.resting_whole += own.resting_whole;
    shares.under_caption += own.under_caption, shares.finished += s.visitor.finished;
  }
  return shares;
}

void ExpectWellStaged(const Shares& shares) {
  EXPECT_EQ(shares.finished, kTowns);
  EXPECT_LT(shares.Of(shares.walking_in_middle, shares.walking), 0.15f);
  EXPECT_GT(shares.Of(shares.walking_whole, shares.walking), 0.7f);
  EXPECT_LT(shares.Of(shares.resting_in_middle, shares.resting), 0.08f);
  EXPECT_GT(shares.Of(shares.resting_whole, shares.resting), 0.7f);
  EXPECT_LT(shares.Of(shares.under_caption, shares.resting), 0.15f);
}

TEST(Staging, ShowsTheGuideWholeAndClearOfWhatThereIsToSee) { ExpectWellStaged(WatchTowns(kPi / 3, 16.0f / 9)); }

TEST(Staging, HoldsForAWiderViewAndAnotherPicture) { ExpectWellStaged(WatchTowns(1.4f, 4.0f / 3)); }

}  // namespace
}  // namespace flaneur
