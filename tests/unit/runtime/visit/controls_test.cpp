#include "runtime/visit/controls.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "runtime/crowd/fast_math.h"
#include "runtime/walk/point_walk.h"
#include "tests/unit/runtime/simulation/tour_town.h"

namespace flaneur {
namespace {

constexpr float kAspect = 16.0f / 9;

WindowInput Holding(std::initializer_list<const char*> names) {
  WindowInput input;
  for (const char* name : names) input.down.set(static_cast<size_t>(InputCode(name)));
  return input;
}

// A visitor with hands, in a town without people.
struct Visitor {
  explicit Visitor(const PlayerSettings& settings = {}, bool tour = false, int people = 0) {
    TourPack pack = TourTown(people);
    if (!tour) pack.path.clear();
    s = Started(pack);
    controls = MakeControls(settings, {}, s);
  }
  void Do(const WindowInput& input, int steps = 1) {
    for (int k = 0; k < steps; ++k) {
      TakeInput(input, Step_s(s), kAspect, false, s, &controls, &wishes);
      StepSimulation(NextStep(wishes, s, &controls), 0, &s);
      wishes.tour = {};
      wishes.walk_to.reset();
    }
  }
  void Tap(const char* name) {
    Do(Holding({name}));
    Do({});
  }
  void Stand(Vec2 p, float yaw_rad) {
    s.visitor.camera.view.position = p;
    s.visitor.camera.view.yaw_rad = yaw_rad;
  }
  std::optional<Vec2> Ground(Vec2 place) const { return GroundAt(s.town.walkable, s.visitor.camera, place, kAspect); }
  Vec2 At() const { return s.visitor.camera.view.position; }

  Simulation s;
  Controls controls;
  CameraInput wishes;
};

TEST(Controls, KeysWalkInTheDirectionsOfTheView) {
  const struct {
    const char* key;
    Vec2 way;
  } cases[] = {{"w", {0, 1}}, {"down", {0, -1}}, {"a", {-1, 0}}, {"d", {1, 0}}};
  for (const auto& c : cases) {
    Visitor v;
    v.Stand({22, 20}, kPi / 2);
    v.Do(Holding({c.key}), 30);
    const Vec2 walked = v.At() - Vec2{22, 20};
    EXPECT_NEAR(Length(walked), 1.5f, 0.1f) << c.key;
    EXPECT_GT(Dot(walked, c.way), 0.99f * Length(walked)) << c.key;
  }
  Visitor v;
  v.Stand({22, 20}, 0);
  v.Do(Holding({"w", "d"}), 30);
  EXPECT_NEAR(Length(v.At() - Vec2{22, 20}), 1.5f, 0.1f) << "not faster at an angle";
}

TEST(Controls, SticksWalkAndTurnAndHaveADeadMiddle) {
  Visitor v;
  v.Stand({22, 20}, 0);
  WindowInput idle;
  idle.left_stick = {0.1f, -0.1f};
  idle.right_stick = {0.12f, 0.05f};
  v.Do(idle, 60);
  EXPECT_LT(Length(v.At() - Vec2{22, 20}), 0.01f);
  EXPECT_LT(std::abs(v.s.visitor.camera.view.yaw_rad), 0.001f);
  WindowInput half;
  half.left_stick = {0, 0.6f};
  v.Do(half, 30);
  EXPECT_GT(v.At().x, 22.4f);
  EXPECT_LT(v.At().x, 23.2f) << "slower than with a full push";
  WindowInput turn;
  turn.right_stick = {-1, 0};
  v.Do(turn, 30);
  EXPECT_NEAR(v.s.visitor.camera.view.yaw_rad, kPi / 2, 0.06f) << "90 degrees a second, to the left";
}

TEST(Controls, TheMouseTurnsAsFarAsItMovesHoweverFastItDoes) {
  Visitor v;
  v.Stand({22, 20}, 0);
  WindowInput flick;
  flick.turned_px = {-400, 0};
  v.Do(flick);
  v.Do({}, 30);
  EXPECT_NEAR(v.s.visitor.camera.view.yaw_rad, 1.0f, 0.01f);
}

TEST(Controls, ASnapTurnGoesOnceAndExactly) {
  PlayerSettings settings;
  settings.snap_turn_deg = 30;
  Visitor v(settings);
  v.Stand({22, 20}, 0);
  v.Do(Holding({"left"}), 40);
  EXPECT_NEAR(v.s.visitor.camera.view.yaw_rad, kPi / 6, 0.01f);
  v.Do({}, 2);
  v.Do(Holding({"right"}), 2);
  v.Do({}, 20);
  EXPECT_NEAR(v.s.visitor.camera.view.yaw_rad, 0, 0.01f);
}

// Else people come into view whom nobody has kept apart.
TEST(Controls, NothingTurnsFasterThanTheCrowdAllows) {
  PlayerSettings fast;
  fast.turn_speed_dps = 360;
  for (PlayerSettings settings : {fast, PlayerSettings{}}) {
    Visitor v(settings);
    WindowInput input = Holding({"left"});
    input.turned_px = {-300, 0};
    float last = v.s.visitor.camera.view.yaw_rad;
    for (int k = 0; k < 60; ++k) {
      v.Do(input);
      EXPECT_LE(std::abs(WrapAngle(v.s.visitor.camera.view.yaw_rad - last)),
                MaxYawRate_radps(v.s.control.settings) * Step_s(v.s) * 1.001f);
      last = v.s.visitor.camera.view.yaw_rad;
    }
  }
}

TEST(Controls, LookingUpAndDownEndsBeforeTheNeck) {
  Visitor v;
  WindowInput up;
  up.turned_px = {0, -300};
  v.Do(up, 40);
  EXPECT_LT(v.s.visitor.camera.pitch_rad, 1.3f);
  EXPECT_GT(v.s.visitor.camera.pitch_rad, 1);
  PlayerSettings inverted;
  inverted.invert_look = true;
  Visitor w(inverted);
  w.Do(up, 1);
  EXPECT_LT(w.s.visitor.camera.pitch_rad, 0);
}

TEST(Controls, RemappedKeysActAndTheOldOnesDont) {
  PlayerSettings settings;
  ASSERT_FALSE(SetPlayerSetting("keys.walk_ahead=i,pad_up", &settings));
  Visitor v(settings);
  v.Stand({22, 20}, 0);
  v.Do(Holding({"w"}), 30);
  EXPECT_LT(Length(v.At() - Vec2{22, 20}), 0.01f);
  v.Do(Holding({"pad_up"}), 30);
  EXPECT_GT(v.At().x, 23);
}

TEST(Controls, NoKeyOfAKioskEndsItOrShowsViewsOrChangesWhatIsTheOperators) {
  PlayerSettings settings;
  settings.kiosk = true;
  settings.pointer = "point";
  Visitor v(settings, true);
  v.controls.offered_languages = {"de", "fr"};
  const float fov_rad = v.s.visitor.camera.view.fov_rad;
  for (const std::string& name : InputNames()) {
    v.Tap(name.c_str());
    EXPECT_FALSE(v.controls.quits || v.controls.toggles_views || v.controls.switches_adaptation) << name;
    EXPECT_TRUE(v.controls.points) << name;
    EXPECT_FALSE(v.controls.settings.fullscreen) << name;
  }
  WindowInput closing;
  closing.close = true;
  v.Do(closing);
  EXPECT_FALSE(v.controls.quits);
  EXPECT_EQ(v.s.visitor.camera.view.fov_rad, fov_rad);
  EXPECT_TRUE(v.controls.settings.language == "de" || v.controls.settings.language == "fr");
}

TEST(Controls, TheTourIsLeftByWalkingAndFoundAgainByItsKey) {
  Visitor v({}, true, 20);
  v.Do({}, 60);
  ASSERT_GT(v.At().x, 4.5f) << "the tour leads";
  v.Do(Holding({"s"}), 30);
  EXPECT_FALSE(v.controls.follows_tour);
  const Vec2 left = v.At();
  v.Do({}, 60);
  EXPECT_LT(Length(v.At() - left), 0.05f) << "and does not any more";
  v.Tap("tab");
  v.Do({}, 120);
  EXPECT_GT(Length(v.At() - left), 1);
}

TEST(Controls, PausingNextAndBackAreWishesOfOneStep) {
  Visitor v({}, true, 20);
  v.Do({}, 30);
  v.Do(Holding({"space"}), 20);
  EXPECT_TRUE(v.s.visitor.tour.paused) << "held, not toggled again and again";
  v.Do({});
  v.Tap("space");
  EXPECT_FALSE(v.s.visitor.tour.paused);
  EXPECT_EQ(HaltOf(v.s.visitor.tour), 1u);
  v.Do(Holding({"n"}), 20);
  EXPECT_EQ(HaltOf(v.s.visitor.tour), 3u);
  v.Do({});
  v.Tap("b");
  EXPECT_EQ(HaltOf(v.s.visitor.tour), 1u);
}

TEST(Controls, LookingAboutOnTheTourComesBackByItself) {
  Visitor v({}, true, 0);
  v.Do({}, 60);
  const float ahead = v.s.visitor.camera.view.yaw_rad;
  WindowInput aside;
  aside.turned_px = {-300, 0};
  v.Do(aside);
  v.Do({}, 30);
  EXPECT_GT(std::abs(WrapAngle(v.s.visitor.camera.view.yaw_rad - ahead)), 0.5f);
  EXPECT_TRUE(v.controls.follows_tour);
  v.Do({}, 150);
  Visitor undisturbed({}, true, 0);
  undisturbed.Do({}, 241);
  EXPECT_LT(std::abs(WrapAngle(v.s.visitor.camera.view.yaw_rad - undisturbed.s.visitor.camera.view.yaw_rad)), 0.3f);
}

TEST(Pointing, FindsTheGroundThatIsSeenThere) {
  Visitor v;
  v.Stand({22, 20}, 0);
  v.s.visitor.camera.pitch_rad = 0;
  const auto middle_low = v.Ground({0.5f, 0.9f});
  ASSERT_TRUE(middle_low);
  const float down = 0.8f * std::tan(v.s.visitor.camera.view.fov_rad / 2) / kAspect;
  EXPECT_NEAR(middle_low->x, 22 + kEyeHeight_m / down, 0.2f);
  EXPECT_NEAR(middle_low->y, 20, 0.05f);
  const auto right = v.Ground({0.9f, 0.9f});
  ASSERT_TRUE(right);
  EXPECT_LT(right->y, 19);
  EXPECT_FALSE(v.Ground({0.5f, 0.1f}) && v.Ground({0.5f, 0.1f})->x > 45) << "no farther than the wall";
  v.Stand({10, 15}, 0);
  const auto house = v.Ground({0.5f, 0.5f});
  ASSERT_TRUE(house);
  EXPECT_FALSE(InsideObstacle(v.s.town.walkable, *house)) << "before the house";
  EXPECT_NEAR(house->x, 12, 0.4f);
}

TEST(Pointing, LeadsRoundObstaclesWithoutTouchingThem) {
  Visitor v({}, false, 60);
  v.Stand({10, 15}, 0);
  v.controls.follows_tour = false;
  SetOut({40, 10}, InTown(&v.s));  // behind a house, and beyond the wall with its lane
  int steps = 0;
  for (; steps < 30 * 120 && !v.s.visitor.point_walk.route.points.empty(); ++steps) {
    v.Do({});
    ASSERT_FALSE(InsideObstacle(v.s.town.walkable, v.At()));
  }
  EXPECT_LT(Length(v.At() - Vec2{40, 10}), 0.6f) << steps;
}

TEST(Pointing, IntoAHouseLeadsBesideItAndAKeyEndsIt) {
  Visitor v;
  v.Stand({8, 15}, 0);
  SetOut({12.5f, 15}, InTown(&v.s));
  v.Do({}, 300);
  EXPECT_LT(Length(v.At() - Vec2{12, 15}), 1.2f);
  SetOut({22, 30}, InTown(&v.s));
  v.Do({}, 30);
  v.Do(Holding({"s"}), 2);
  const Vec2 here = v.At();
  v.Do({}, 60);
  EXPECT_LT(Length(v.At() - here), 0.05f);
}

// Walking against a wall at every angle: along it as fast as the way along it goes, never nearer than one's own width.
TEST(Walking, SlidesAlongWalls) {
  for (float angle_deg = 10; angle_deg <= 170; angle_deg += 20) {
    Visitor v;
    v.Stand({15, 10.5f}, angle_deg * kPi / 180);
    const float along_mps = 1.5f * std::cos(angle_deg * kPi / 180);
    v.Do(Holding({"w"}), 45);
    EXPECT_FALSE(InsideObstacle(v.s.town.walkable, v.At()));
    EXPECT_LT(v.At().y, 12 - kCameraRadius_m + 0.01f) << angle_deg;
    EXPECT_NEAR(v.At().x - 15, std::clamp(1.5f * along_mps, -3.5f, 3.5f), 0.25f) << angle_deg;
  }
}

// 20 % up to a terrace, by a ramp; then down its steps.
TEST(Walking, TheEyeFollowsSlopesAndStepsSmoothly) {
  TourPack pack = TourTown(0);
  pack.path.clear();
  pack.obstacles = {};
  GroundRaster ground = *pack.ground;
  for (int row = 0; row < 80; ++row) {
    for (int column = 0; column < 120; ++column) {
      const float x = 0.5f * static_cast<float>(column);
      const float ramp = std::clamp(0.2f * (x - 10), 0.0f, 2.0f);
      const float steps = x < 30 ? 0 : std::min(2.0f, 0.16f * (1 + std::floor((x - 30) / 0.5f)));
      ground.height_m[static_cast<size_t>(row * 120 + column)] = ramp - steps;
    }
  }
  pack.ground = Share(std::move(ground));
  Simulation s = Started(pack);
  s.visitor.camera.view.position = {8, 20};
  CameraInput ahead;
  ahead.active = true;
  ahead.direction = {1, 0};
  ahead.speed_mps = 1.5f;
  float last_m = HeightAt(s.town.walkable, s.visitor.camera.view.position), highest_m = 0;
  for (int step = 0; step < 30 * 24; ++step) {
    StepSimulation(ahead, 0, &s);
    const float now_m = HeightAt(s.town.walkable, s.visitor.camera.view.position);
    EXPECT_LT(std::abs(now_m - last_m), 0.04f) << "no jolt";
    highest_m = std::max(highest_m, now_m);
    last_m = now_m;
  }
  EXPECT_NEAR(highest_m, 2, 0.05f);
  EXPECT_NEAR(last_m, 0, 0.05f);
}

}  // namespace
}  // namespace flaneur
