#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "runtime/control/crowd_influence.h"
#include "runtime/control/head_view.h"
#include "runtime/control/level_control.h"
#include "runtime/control/view_volumes.h"

namespace flaneur {
namespace {

// The inner wedge by angles, as the design states it: an independent formulation.
bool InWedgeByAngle(Vec2 p, Vec2 apex, float yaw_rad, float fov_rad) {
  const Vec2 off = p - apex;
  float angle = std::atan2(off.y, off.x) - yaw_rad;
  while (angle > kPi) angle -= 2 * kPi;
  while (angle < -kPi) angle += 2 * kPi;
  return std::abs(angle) <= fov_rad / 2;
}

TEST(Props, AreSpreadByTheirSharesAndNobodyHasTwoOfASlot) {
  const std::vector<Prop> props{{"a", 0.25f, "hand", 100}, {"b", 0.5f, "hand", 60}, {"c", 0.3f, "", 80}};
  int count[3] = {0, 0, 0}, both = 0;
  constexpr int kPeople = 20000;
  for (int id = 0; id < kPeople; ++id) {
    const uint8_t chosen = PropsOf(props, id);
    for (int k = 0; k < 3; ++k) count[k] += chosen >> k & 1;
    EXPECT_NE(chosen & 3, 3) << "two of one slot";
    both += (chosen & 3) != 0 && (chosen & 4) != 0 ? 1 : 0;
    EXPECT_EQ(chosen, PropsOf(props, id));
  }
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(static_cast<float>(count[k]) / kPeople, props[static_cast<size_t>(k)].share, 0.02f) << k;
  EXPECT_NEAR(static_cast<float>(both) / kPeople, 0.75f * 0.3f, 0.02f) << "slots don't know each other";
}

TEST(Props, StayWithinTheirRoomAndNeitherComeNorGoInView) {
  const std::vector<Prop> props{{"a", 1, "", 100}};
  Props state;
  const auto step = [&](const std::vector<int>& ids, int64_t room) {
    state.bearers.clear();
    for (int id : ids) state.bearers.push_back({id, id, &props, static_cast<float>(id)});
    ChooseProps(room, &state);
    std::vector<int> shown;
    for (int id = 0; id < 10; ++id) {
      if (ShownProps(state, id, id) != 0) shown.push_back(id);
    }
    EXPECT_EQ(state.triangles, 100 * static_cast<int64_t>(shown.size()));
    EXPECT_LE(state.triangles, room);
    return shown;
  };
  EXPECT_EQ(step({5, 6, 7}, 250), (std::vector<int>{5, 6})) << "the nearest";
  EXPECT_EQ(step({3, 5, 6, 7}, 250), (std::vector<int>{5, 6})) << "who has them keeps them";
  EXPECT_EQ(step({3, 6, 7}, 250), (std::vector<int>{6})) << "nothing appears on who is in view";
  EXPECT_EQ(step({3, 4, 6, 7}, 250), (std::vector<int>{4, 6})) << "but who comes has what is left";
  EXPECT_EQ(step({3, 4, 6, 7}, 150), (std::vector<int>{4})) << "less room";
  EXPECT_EQ(step({4}, 150), (std::vector<int>{4}));
  EXPECT_EQ(step({3, 4}, 250), (std::vector<int>{3, 4})) << "was out of view and is back";
}

TEST(Shadows, TakeNoMoreThanTheirRoomFromTheFarthestFirstAndComeBackSlowly) {
  Shadows state;
  const auto step = [&](int64_t room) {
    state.casters.clear();
    for (int k = 0; k < 60; ++k) state.casters.push_back({static_cast<float>(k) + 0.3f, {1000, 100}});
    ChooseShadows(room, 1.0f / 30, &state);
    int64_t triangles = 0;
    for (const ShadowCaster& c : state.casters) {
      const int coarse = c.cost.coarse_triangles * (c.distance_m < kTwoShadows_m ? 2 : 1);
      triangles += c.distance_m < state.reach_m ? coarse : 0;
      triangles += c.distance_m < state.fine_m ? c.cost.fine_triangles - c.cost.coarse_triangles : 0;
    }
    EXPECT_EQ(state.triangles, triangles);
    EXPECT_LE(state.triangles, room);
  };
  step(100000);
  EXPECT_EQ(state.fine_m, kFineShadow_m);
  EXPECT_EQ(state.reach_m, kShadowReach_m);
  step(10000);
  EXPECT_EQ(state.reach_m, kShadowReach_m) << "everybody's coarse shadow before anybody's fine one";
  EXPECT_NEAR(state.fine_m, 2, 0.5f);
  step(2000);
  EXPECT_NEAR(state.reach_m, 10, 0.5f);
  EXPECT_LT(state.fine_m, 0.5f);
  float before_m = state.reach_m;
  for (int k = 0; k < 3000 && state.fine_m < kFineShadow_m; ++k) {
    step(100000);
    EXPECT_LT(state.reach_m, before_m + 0.05f);
    before_m = state.reach_m;
  }
  EXPECT_EQ(state.fine_m, kFineShadow_m);
  step(0);
  EXPECT_EQ(state.triangles, 0);
}

// Of all that pictures until the next step draw people with, but for props.
int64_t DrawnTriangles(const Crowd& crowd, const std::vector<AvatarCosts>& avatars, const LevelState& state) {
  const auto triangles = [&](size_t i, Level level) -> int64_t {
    return IsMesh(level)
               ? avatars[static_cast<size_t>(crowd.avatar[i])].levels[static_cast<size_t>(level.mesh)].triangles
           : IsDrawn(level) ? kImpostorTriangles
                            : 0;
  };
  int64_t sum = 0;
  for (size_t i = 0; i < crowd.size(); ++i) {
    const PersonLevel& p = state.people[i];
    sum += triangles(i, p.level) + triangles(i, p.from);
  }
  return sum;
}

TEST(ChooseLevels, TheBudgetHoldsForPropsAndShadowsAsWell) {
  Random random{5};
  for (int budget : {40, 300, 2000, 20000, 200000}) {
    std::vector<AvatarCosts> avatars{{{{9000, 400}, {3000, 200}, {700, 0}},
                                      1.75f,
                                      128,
                                      {{"hat", 0.7f, "head", 250}, {"bag", 0.3f, "hand", 90}},
                                      {700, 90}},
                                     {{{500, 0}}, 1.75f, 128, {}, {500, 50}}};
    Crowd crowd;
    for (int k = 0; k < 300; ++k) {
      Person person;
      person.position = {random.Uniform(1, 60), random.Uniform(-30, 30)};
      person.avatar = k % 2;
      AddPerson(person, &crowd);
    }
    ControlSettings settings;
    settings.budget_triangles = budget;
    LevelState state;
    for (int step = 0; step < 120; ++step) {
      for (size_t i = 0; i < crowd.size(); ++i) {
        crowd.position[i] = crowd.position[i] + Vec2{random.Uniform(-0.3f, 0.3f), random.Uniform(-0.3f, 0.3f)};
        crowd.view[i] = Classify(crowd.position[i], crowd.reach_m[i], ViewCamera{}, 3);
      }
      ChooseLevels(crowd, avatars, settings, {ViewCamera{}, {}, 0}, &state);
      ASSERT_LE(state.triangles + state.shadows.triangles, budget);
      ASSERT_LE(state.props.triangles, budget / 10);
      ASSERT_LE(state.shadows.triangles, budget / 5);
      int64_t shadows = 0;
      int64_t drawn = state.props.triangles + DrawnTriangles(crowd, avatars, state);
      for (size_t i = 0; i < crowd.size(); ++i) {
        const ShadowCost& shadow = avatars[static_cast<size_t>(crowd.avatar[i])].shadow;
        const float distance_m = Length(crowd.position[i]);
        EXPECT_TRUE(state.casts_shadow[i] != 0 || crowd.view[i] != ViewClass::kVisible || distance_m >= kShadowReach_m);
        if (state.casts_shadow[i] == 0) continue;
        if (distance_m >= state.shadows.reach_m) continue;
        shadows += shadow.coarse_triangles * (distance_m < kTwoShadows_m ? 2 : 1);
        shadows += distance_m < state.shadows.fine_m ? shadow.fine_triangles - shadow.coarse_triangles : 0;
      }
      ASSERT_EQ(state.triangles, drawn);
      ASSERT_EQ(state.shadows.triangles, shadows);
    }
    EXPECT_GT(state.props.triangles, budget >= 20000 ? 0 : -1);
    EXPECT_GT(state.shadows.triangles, budget >= 2000 ? 0 : -1);
  }
}

TEST(ViewVolumes, AgreeWithTheDefinitionByAngles) {
  Random random{3};
  for (int i = 0; i < 100000; ++i) {
    const Vec2 p{random.Uniform(-50, 50), random.Uniform(-50, 50)};
    const Vec2 c{random.Uniform(-5, 5), random.Uniform(-5, 5)};
    const float yaw = random.Uniform(-kPi, kPi), fov = random.Uniform(0.3f, 2.4f);
    const Vec2 off = p - c;
    const float edge = std::abs(std::abs(std::remainder(std::atan2(off.y, off.x) - yaw, 2 * kPi)) - fov / 2);
    if (edge < 1e-4f) continue;
    ASSERT_EQ(Classify(p, 0, {c, yaw, fov}, 0) != ViewClass::kOutside, InWedgeByAngle(p, c, yaw, fov));
  }
}

// Whether any point of the disc is in the wedge, by its rim: an independent formulation.
bool DiscShows(Vec2 p, float reach_m, const ViewCamera& c) {
  constexpr int kPoints = 720;
  if (InWedgeByAngle(p, c.position, c.yaw_rad, c.fov_rad)) return true;
  for (int k = 0; k < kPoints; ++k) {
    const float angle = 2 * kPi * static_cast<float>(k) / kPoints;
    const Vec2 rim = p + Vec2{std::cos(angle), std::sin(angle)} * reach_m;
    if (InWedgeByAngle(rim, c.position, c.yaw_rad, c.fov_rad)) return true;
  }
  return Length(p - c.position) < reach_m;
}

TEST(ViewVolumes, WhoseArmReachesIntoTheViewIsInIt) {
  Random random{8};
  int only_partly = 0;
  for (int i = 0; i < 20000; ++i) {
    const ViewCamera camera{
        {random.Uniform(-5, 5), random.Uniform(-5, 5)}, random.Uniform(-kPi, kPi), random.Uniform(0.3f, 2.4f)};
    const Vec2 p = camera.position + Vec2{random.Uniform(-4, 4), random.Uniform(-4, 4)};
    const float reach_m = random.Uniform(0.1f, 1.2f);
    const bool visible = Classify(p, reach_m, camera, 3) == ViewClass::kVisible;
    const bool shows = DiscShows(p, reach_m, camera);
    ASSERT_TRUE(visible || !shows);
    ASSERT_TRUE(!visible || DiscShows(p, reach_m * 1.01f + 0.001f, camera));
    only_partly += visible && Classify(p, 0, camera, 0) == ViewClass::kOutside;
  }
  EXPECT_GT(only_partly, 1000);
}

// Points of upright people against the four sides of the picture, through a camera as a renderer has it.
TEST(ViewVolumes, APitchedViewSeesNobodyOutsideIt) {
  Random random{21};
  constexpr float kAspect = 16.0f / 9, kEye_m = 1.65f;
  int shown = 0;
  for (int i = 0; i < 400000; ++i) {
    const float fov = random.Uniform(0.5f, 2.0f), pitch = random.Uniform(-1.5f, 1.5f);
    const ViewCamera camera{{}, 0, fov};
    const Vec2 p{random.Uniform(-4, 8), random.Uniform(-6, 6)};
    const float feet_m = random.Uniform(-2, 2), height_m = 1.8f, reach_m = 0.5f;
    const float angle = random.Uniform(-kPi, kPi), z = feet_m + random.Uniform(0, height_m) - kEye_m;
    const Vec2 at = p + Vec2{std::cos(angle), std::sin(angle)} * reach_m;
    const float depth = at.x * std::cos(pitch) + z * std::sin(pitch), up = z * std::cos(pitch) - at.x * std::sin(pitch);
    const float half = std::tan(fov / 2);
    if (depth < 0.01f || std::abs(at.y) > half * depth || std::abs(up) > half / kAspect * depth) continue;
    ++shown;
    const float feet_above_eye_m = feet_m - kEye_m;
    const ViewTilt tilt = TiltOf(pitch, fov, kAspect);
    const float tilted_m = TiltReach_m(tilt, feet_above_eye_m, feet_above_eye_m + height_m);
    ASSERT_EQ(Classify(p, reach_m + tilted_m + 1e-4f, camera, 0), ViewClass::kVisible)
        << p.x << ", " << p.y << " pitch " << pitch << " fov " << fov;
    ASSERT_LE(std::max(tilt.below, tilt.above), MostTilt(fov, kAspect) + 1e-4f);
  }
  EXPECT_GT(shown, 20000);
}

TEST(ViewVolumes, ALevelViewIsTheWedge) {
  const ViewTilt level = TiltOf(0, 1.05f, 1.78f), slight = TiltOf(-0.1f, 1.05f, 1.78f);
  EXPECT_NEAR(std::max(level.below, level.above), 0, 1e-6f);
  EXPECT_LT(slight.below, 0.1f) << "somebody's feet are 1.65 m below the eye";
}

// How many become visible straight from outside within so many steps of random camera motion, of people who stand just
// outside the outer volume and walk towards the view as fast as they can.
int UnforeseenPeople(int steps, float back_share) {
  constexpr float kReach_m = 0.7f;
  Random random{11};
  MotionLimits limits;
  limits.reach_grows_m = 0.4f;
  limits.reach_m = 120;
  ViewCamera camera{{0, 0}, 0, 1.05f};
  const float back_m = OuterApexBack_m(limits, camera.fov_rad) * back_share;
  int unforeseen = 0;
  for (int step = 0; step < steps; ++step) {
    const ViewCamera before = camera;
    const float turn = random.Uniform() < 0.5f ? std::copysign(1.0f, random.Uniform(-1, 1)) : random.Uniform(-1, 1);
    camera.yaw_rad = std::remainder(camera.yaw_rad + turn * limits.yaw_rate_radps * limits.step_s, 2 * kPi);
    const float way = random.Uniform(-kPi, kPi);
    camera.position = camera.position + Vec2{std::cos(way), std::sin(way)} * (limits.camera_speed_mps * limits.step_s);
    for (const float side : {-1.0f, 1.0f}) {
      const float edge = before.yaw_rad + side * before.fov_rad / 2;
      const Vec2 apex = before.position - Vec2{std::cos(before.yaw_rad), std::sin(before.yaw_rad)} * back_m;
      const Vec2 along{std::cos(edge), std::sin(edge)}, outwards = Vec2{-along.y, along.x} * side;
      const Vec2 person = apex + along * random.Uniform(0, 125) + outwards * (kReach_m + random.Uniform(0.01f, 0.3f));
      if (Length(person - before.position) > limits.reach_m ||
          Classify(person, kReach_m, before, back_m) != ViewClass::kOutside)
        continue;
      const Vec2 moved = person - outwards * (limits.person_speed_mps * limits.step_s);
      unforeseen += Classify(moved, kReach_m + limits.reach_grows_m, camera, back_m) == ViewClass::kVisible ? 1 : 0;
    }
  }
  return unforeseen;
}

TEST(ViewVolumes, NobodyBecomesVisibleWithoutAStepInTheBoundary) { EXPECT_EQ(UnforeseenPeople(1'000'000, 1), 0); }

TEST(ViewVolumes, TheGapIsNoWiderThanItHasToBe) { EXPECT_GT(UnforeseenPeople(100'000, 0.9f), 0); }

// A head somewhere, and both its eyes, which a headset has look past their own middle.
struct Head {
  Vec3 place{0, 0, 1.6f};
  float yaw_rad = 0, pitch_rad = 0, roll_rad = 0;
  float outer_tangent = 1.2f, inner_tangent = 0.9f, upper_tangent = 0.9f, lower_tangent = 1.1f;
};

std::array<EyeFrustum, 2> EyesOf(const Head& h) {
  constexpr float kHalf_m = 0.032f;
  const float cy = std::cos(h.yaw_rad), sy = std::sin(h.yaw_rad), cp = std::cos(h.pitch_rad),
              sp = std::sin(h.pitch_rad);
  const Vec3 ahead{cy * cp, sy * cp, sp}, level{sy, -cy, 0}, above = Cross(level, ahead);
  const Vec3 right = level * std::cos(h.roll_rad) + above * std::sin(h.roll_rad), up = Cross(right, ahead);
  std::array<EyeFrustum, 2> eyes;
  for (size_t k = 0; k < 2; ++k) {
    const float side = k == 0 ? -1.0f : 1.0f;
    eyes[k] = {h.place + right * (side * kHalf_m),
               ahead,
               right,
               up,
               k == 0 ? -h.outer_tangent : -h.inner_tangent,
               k == 0 ? h.inner_tangent : h.outer_tangent,
               -h.lower_tangent,
               h.upper_tangent};
  }
  return eyes;
}

bool Shows(const EyeFrustum& e, Vec3 point) {
  const Vec3 off = point - e.place;
  const float ahead = Dot(off, e.ahead), right = Dot(off, e.right), up = Dot(off, e.up);
  return ahead > 0 && right >= e.left_tangent * ahead && right <= e.right_tangent * ahead &&
         up >= e.lower_tangent * ahead && up <= e.upper_tangent * ahead;
}
bool Shows(const Head& head, Vec3 point) {
  const auto eyes = EyesOf(head);
  return Shows(eyes[0], point) || Shows(eyes[1], point);
}

Head SomeHead(Random* random) {
  Head h;
  h.yaw_rad = random->Uniform(-kPi, kPi);
  h.pitch_rad = random->Uniform(-1.4f, 1.4f);
  h.roll_rad = random->Uniform(-1, 1);
  for (float* tangent : {&h.outer_tangent, &h.inner_tangent, &h.upper_tangent, &h.lower_tangent})
    *tangent = random->Uniform(0.4f, 1.6f);
  return h;
}

TEST(HeadView, HoldsWhateverEitherEyeSees) {
  Random random{31};
  int shown = 0, around = 0;
  for (int i = 0; i < 400000; ++i) {
    Head h = SomeHead(&random);
    h.place = h.place + Vec3{random.Uniform(-0.06f, 0.06f), random.Uniform(-0.06f, 0.06f), 0};  // it leans
    const HeadView view = ViewOfHead({0, 0}, EyesOf(h));
    around += view.is_bounded ? 0 : 1;
    const Vec3 point{random.Uniform(-9, 9), random.Uniform(-9, 9), random.Uniform(-1, 3)};
    if (!view.is_bounded || !Shows(h, point) || Length(Vec2{point.x, point.y}) < kNearestToHead_m) continue;
    ++shown;
    const ViewCamera camera{{}, view.yaw_rad, view.fov_rad};
    ASSERT_EQ(Classify({point.x, point.y}, 1e-3f, camera, 0), ViewClass::kVisible)
        << point.x << ", " << point.y << ", " << point.z << " yaw " << h.yaw_rad << " pitch " << h.pitch_rad;
  }
  EXPECT_GT(shown, 30000);
  EXPECT_GT(around, 1000) << "nobody looks at the sky";
  EXPECT_LT(around, 300000) << "hardly a view is bounded";
}

TEST(HeadView, IsNoWiderThanALevelHeadSees) {
  Head h;
  const HeadView view = ViewOfHead({0, 0}, EyesOf(h));
  EXPECT_NEAR(view.fov_rad, 2 * std::atan(h.outer_tangent) + 2 * std::asin(0.032f / kNearestToHead_m), 1e-3f);
  EXPECT_NEAR(view.yaw_rad, 0, 1e-3f);
  EXPECT_NEAR(view.pitch_rad, 0, 1e-3f);
}

// Turns by about an angle, about any axis; the body walks and the head leans.
Head Moved(Head h, float turn_rad, float step_m, Random* random) {
  const float share = random->Uniform(-1, 1), rest = std::sqrt(1 - share * share);
  const float roll = random->Uniform(-1, 1) * rest * turn_rad;
  h.yaw_rad += share * turn_rad * 0.7f;  // yaw, pitch and roll of a turn are not its parts: together less than it
  h.pitch_rad = std::clamp(h.pitch_rad + rest * turn_rad * random->Uniform(-0.5f, 0.5f), -1.4f, 1.4f);
  h.roll_rad = std::clamp(h.roll_rad + roll * 0.3f, -1.0f, 1.0f);
  const float way = random->Uniform(-kPi, kPi);
  h.place = h.place + Vec3{std::cos(way), std::sin(way), 0} * step_m;
  return h;
}

// Of guarantee 4.3.1 for both eyes of a head that turns as fast as heads do, in steps as long as pictures at 30, 72 and
// 90 a second: people of whom no eye could see anything and who were outside the outer volume, and whom one sees next.
int UnforeseenByHead(int steps, float back_share) {
  constexpr float kReach_m = 0.7f, kTallestOffEye_m = 2;
  Random random{17};
  int unforeseen = 0;
  for (int step = 0; step < steps; ++step) {
    MotionLimits limits;
    limits.reach_m = 60;
    limits.step_s = 1 / (step % 3 == 0 ? 30.0f : step % 3 == 1 ? 72.0f : 90.0f);
    limits.yaw_rate_radps = kHeadTurn_radps;
    const Head before = SomeHead(&random);
    const HeadView view = ViewOfHead({before.place.x, before.place.y}, EyesOf(before));
    if (!view.is_bounded) continue;
    const ViewCamera camera{{before.place.x, before.place.y}, view.yaw_rad, view.fov_rad};
    limits.reach_grows_m =
        std::tan(view.fov_rad / 2) * kTallestOffEye_m;  // as the simulation allows for a pitched view
    const float back_m = OuterApexBack_m(limits, view.fov_rad) * back_share;
    const Head after =
        Moved(before, limits.yaw_rate_radps * limits.step_s, limits.camera_speed_mps * limits.step_s, &random);
    const ViewVolumes volumes = VolumesOf(camera, back_m);
    for (int k = 0; k < 8; ++k) {
      const float side = k % 2 == 0 ? 1.0f : -1.0f, edge = camera.yaw_rad + side * camera.fov_rad / 2;
      const Vec2 along{std::cos(edge), std::sin(edge)}, outwards = Vec2{-along.y, along.x} * side;
      const Vec2 person = volumes.outer_apex + along * random.Uniform(0, 60 + back_m) +
                          outwards * (kReach_m + random.Uniform(0.01f, 0.3f));
      if (Length(person - camera.position) > limits.reach_m) continue;
      if (Classify(person, kReach_m, volumes) != ViewClass::kOutside) continue;
      const Vec2 moved = person - outwards * (limits.person_speed_mps * limits.step_s);
      const float angle = random.Uniform(-kPi, kPi);
      const Vec2 part = moved + Vec2{std::cos(angle), std::sin(angle)} * kReach_m;
      unforeseen += Shows(after, {part.x, part.y, random.Uniform(0, 1.9f)}) ? 1 : 0;
    }
  }
  return unforeseen;
}

TEST(HeadView, NobodyIsSeenByAnEyeWithoutAStepInTheBoundary) { EXPECT_EQ(UnforeseenByHead(300'000, 1), 0); }

TEST(HeadView, AHandsBoundaryWouldNotDoForAHead) { EXPECT_GT(UnforeseenByHead(300'000, 0.15f), 0); }

Crowd PeopleInView(int count, Random* random) {
  Crowd crowd;
  for (int i = 0; i < count; ++i) {
    Person p;
    p.position = {random->Uniform(1, 60), random->Uniform(-15, 15)};
    AddPerson(p, &crowd);
    crowd.view.back() = ViewClass::kVisible;
  }
  return crowd;
}

TEST(LevelControl, TheBudgetAlwaysHoldsAndCountsAgree) {
  Random random{5};
  const std::vector<AvatarCosts> avatars{{{{9000, 300}, {4000, 120}, {900, 0}}, 1.75f, 128}};
  for (int round = 0; round < 200; ++round) {
    Crowd crowd = PeopleInView(random.Below(300), &random);
    ControlSettings settings;
    settings.high_limit = random.Below(30);
    settings.budget_triangles = random.Below(150000);
    LevelState state;
    for (int step = 0; step < 5; ++step) {
      ChooseLevels(crowd, avatars, settings, {ViewCamera{}, {}, 0}, &state);
      const int64_t triangles = DrawnTriangles(crowd, avatars, state);
      const auto high =
          std::count_if(state.people.begin(), state.people.end(), [](const PersonLevel& p) { return IsMesh(p.level); });
      ASSERT_LE(triangles, settings.budget_triangles);
      ASSERT_EQ(triangles, state.triangles);
      ASSERT_LE(high, settings.high_limit);
      ASSERT_EQ(high, state.high);
    }
  }
}

// The hand turns the view at once, and pictures come between steps: who is beside the view in this step is drawn too.
TEST(LevelControl, LimitAndBudgetAreAboutEverybodyWhoIsDrawnWhileTheViewTurns) {
  Random random{15};
  const std::vector<AvatarCosts> avatars{{{{9000, 300}, {4000, 120}, {900, 0}}, 1.75f, 128}};
  Crowd crowd;
  for (int k = 0; k < 400; ++k) {
    Person p;
    p.position = {random.Uniform(-15, 15), random.Uniform(-15, 15)};
    p.reach_m = 0.6f;
    AddPerson(p, &crowd);
  }
  ControlSettings settings;
  settings.budget_triangles = 60000;
  LevelState state;
  ViewCamera camera;
  int beside = 0;
  for (int step = 0; step < 600; ++step) {
    const float rate_radps = step < 300 ? 2.0f : -1.0f;
    camera.yaw_rad = std::remainder(camera.yaw_rad + rate_radps / 30, 2 * kPi);
    for (size_t i = 0; i < crowd.size(); ++i) {
      crowd.was_visible[i] = crowd.view[i] == ViewClass::kVisible;
      crowd.view[i] = Classify(crowd.position[i], crowd.reach_m[i], camera, 20);
    }
    ChooseLevels(crowd, avatars, settings, {camera, {{}, rate_radps}, 0}, &state);
    int meshes = 0;
    for (size_t i = 0; i < crowd.size(); ++i) {
      meshes += IsMesh(state.people[i].level);
      beside += IsDrawn(state.people[i].level) && crowd.view[i] != ViewClass::kVisible;
      ASSERT_TRUE(IsDrawn(state.people[i].level) || crowd.view[i] != ViewClass::kVisible);
    }
    ASSERT_LE(meshes, settings.high_limit);
    ASSERT_EQ(state.triangles, DrawnTriangles(crowd, avatars, state));
    ASSERT_LE(state.triangles, settings.budget_triangles);
  }
  EXPECT_GT(beside, 1000);
}

TEST(LevelControl, NobodyNearIsAnImpostorWhileThereIsRoom) {
  const std::vector<AvatarCosts> avatars{{{{9000, 300}, {900, 0}}, 1.75f, 128}};
  Crowd crowd;
  Person p;
  p.position = {3, 2.1f};  // the middle is out of view
  p.reach_m = 0.6f;
  AddPerson(p, &crowd);
  ControlSettings settings;
  settings.high_limit = 0;
  LevelState state;
  const ViewCamera camera;
  crowd.view[0] = Classify(p.position, p.reach_m, camera, 3);
  ASSERT_EQ(crowd.view[0], ViewClass::kVisible);
  crowd.velocity[0] = {0, 1.4f};  // and about to leave
  ChooseLevels(crowd, avatars, settings, {camera, {}, 0}, &state);
  EXPECT_EQ(state.people[0].level, kImpostor);
  settings.high_limit = 1;
  ChooseLevels(crowd, avatars, settings, {camera, {}, 0}, &state);
  EXPECT_TRUE(IsMesh(state.people[0].level));
}

TEST(LevelControl, NobodyFlickersWhereNothingMoves) {
  Random random{9};
  const std::vector<AvatarCosts> avatars{{{{9000, 300}, {900, 0}}, 1.75f, 128}};
  Crowd crowd = PeopleInView(100, &random);
  LevelState state;
  for (int step = 0; step < 600; ++step) ChooseLevels(crowd, avatars, ControlSettings{}, {ViewCamera{}, {}, 0}, &state);
  for (int step = 0; step < 100; ++step) {
    ChooseLevels(crowd, avatars, ControlSettings{}, {ViewCamera{}, {}, 0}, &state);
    ASSERT_EQ(state.switches_in_view, 0);
  }
}

TEST(LevelControl, WhoComesIntoViewWhileThereIsRoomIsAMeshAndStaysOne) {
  const std::vector<AvatarCosts> avatars{{{{9000, 300}, {900, 0}}, 1.75f, 128}};
  Random random{3};
  Crowd crowd = PeopleInView(8, &random);
  LevelState state;
  for (int step = 0; step < 900; ++step) {  // the visitor walks past all of them and they drop behind
    const ViewCamera camera{{0.1f * static_cast<float>(step), 0}, 0, kPi / 3};
    for (size_t i = 0; i < crowd.size(); ++i) {
      if (crowd.position[i].x < camera.position.x) crowd.view[i] = ViewClass::kOutside;
    }
    ChooseLevels(crowd, avatars, ControlSettings{}, {camera, {{3, 0}}, 0}, &state);
    ASSERT_EQ(state.switches_in_view, 0);
    ASSERT_EQ(state.low, 0);
  }
}

// People whom the visitor walks past stay as they are; once the visitor stands still, the nearest become meshes.
TEST(LevelControl, InADenseViewTheNearestAreMeshesWhoeverCameFirst) {
  const std::vector<AvatarCosts> avatars{{{{9000, 300}, {900, 0}}, 1.75f, 128}};
  Random random{4};
  Crowd crowd = PeopleInView(60, &random);
  LevelState state;
  const auto step = [&](Vec2 position, Vec2 velocity) {
    const ViewCamera camera{position, 0, kPi / 3};
    for (size_t i = 0; i < crowd.size(); ++i) {
      crowd.view[i] = Classify(crowd.position[i], crowd.reach_m[i], camera, 0) != ViewClass::kOutside
                          ? ViewClass::kVisible
                          : ViewClass::kOutside;
    }
    ChooseLevels(crowd, avatars, ControlSettings{}, {camera, {velocity}, 0}, &state);
  };
  Vec2 position;
  for (; position.x < 30; position.x += 0.1f) step(position, {3, 0});
  for (int k = 0; k < 60; ++k) step(position, {});
  for (size_t i = 0; i < crowd.size(); ++i) {
    const bool near = crowd.view[i] == ViewClass::kVisible && Length(crowd.position[i] - position) < state.r_high_m - 2;
    EXPECT_TRUE(!near || IsMesh(state.people[i].level));
  }
}

// Those who are seen as impostors when r_high reaches them, 9 m away, and walk on like this.
Level LevelOfWhoWalks(Vec2 position, Vec2 velocity) {
  const std::vector<AvatarCosts> avatars{{{{9000, 300}, {900, 0}}, 1.75f, 128}};
  Crowd crowd;
  AddPerson({}, &crowd);
  crowd.view[0] = ViewClass::kVisible;
  ControlSettings settings;
  settings.high_limit = 0;
  LevelState state;
  for (int k = 0; k < 30; ++k) {
    crowd.position[0] = position;
    crowd.velocity[0] = velocity;
    ChooseLevels(crowd, avatars, settings, {ViewCamera{}, {}, 0}, &state);
    settings.high_limit = k < 20 ? 0 : 12;
  }
  return state.people[0].level;
}

TEST(LevelControl, WhoIsAboutToLeaveTheViewIsNotSwitchedAnyMoreUnlessTheyPassClose) {
  EXPECT_TRUE(IsMesh(LevelOfWhoWalks({9, 4}, {})));
  EXPECT_EQ(LevelOfWhoWalks({9, 4}, {0, 1.4f}), kImpostor);
  EXPECT_TRUE(IsMesh(LevelOfWhoWalks({9, 0.7f}, {-3, 0})));  // soon past the visitor's shoulder
  EXPECT_EQ(LevelOfWhoWalks({9, 3}, {-3, 0}), kImpostor);    // on the other side of the street
}

// The place in high resolution goes to the one who comes here, though the other, who walks away, is nearer yet: nobody
// has to change.
TEST(LevelControl, WhoComesNearHasAPlaceBeforeWhoLeaves) {
  const std::vector<AvatarCosts> avatars{{{{9000, 300}, {900, 0}}, 1.75f, 128}};
  for (const bool known : {true, false}) {  // in the first step nobody has a way yet
    Crowd crowd;
    const Vec2 goals[] = {{60, 0}, {2, 0}};
    for (int k = 0; k < 2; ++k) {
      Person p;
      p.position = {k == 0 ? 13.0f : 16.0f, k == 0 ? 1.0f : -1.0f};
      p.preferred_mps = 1.3f;
      p.field = FieldFor(goals[k], &crowd);
      const size_t i = static_cast<size_t>(AddPerson(p, &crowd));
      crowd.view[i] = ViewClass::kVisible;
      if (known) crowd.way[i] = {k == 0 ? 1.0f : -1.0f, 0};
    }
    ControlSettings settings;
    settings.high_limit = 1;
    LevelState state;
    for (int step = 0; step < 300; ++step) {
      ChooseLevels(crowd, avatars, settings, {ViewCamera{}, {}, 0}, &state);
      ASSERT_EQ(state.switches_in_view, 0);
      ASSERT_TRUE(IsMesh(state.people[1].level));
      for (size_t i = 0; i < 2; ++i) crowd.position[i].x += (i == 0 ? 1.0f : -1.0f) * 1.3f / 30;
    }
  }
}

// A machine that takes 5 ms, and 100 ms for a million triangles of people. The visitor walks backwards, so that nobody
// leaves the view.
float FrameTime_ms(const LevelState& state) { return 5 + 1e-4f * static_cast<float>(state.triangles); }

TEST(LevelControl, TheSecondMethodSettlesAtTheFrameTimeAskedForAndLowerWhileTheCameraRuns) {
  const std::vector<AvatarCosts> avatars{{{{9000, 300}, {4000, 120}, {900, 0}}, 1.75f, 128}};
  Random random{6};
  Crowd crowd = PeopleInView(120, &random);
  for (Vec2& p : crowd.position) p = {3 + p.x * 0.11f, p.y * 0.08f};  // within r_high
  ControlSettings settings;
  settings.method = LimitMethod::kFrameTime;
  LevelState state;
  for (const float speed_mps : {0.0f, 3.0f, 1.4f}) {
    const float target_ms = speed_mps > 2 ? 0.85f * settings.target_ms : settings.target_ms;
    float least_ms = 1e9f, most_ms = 0;
    for (int step = 0; step < 600; ++step) {
      ChooseLevels(crowd, avatars, settings, {ViewCamera{}, {{-speed_mps, 0}}, FrameTime_ms(state)}, &state);
      ASSERT_LE(state.triangles, settings.budget_triangles);
      if (step < 300) continue;
      least_ms = std::min(least_ms, FrameTime_ms(state)), most_ms = std::max(most_ms, FrameTime_ms(state));
    }
    const float one_person_ms = 1e-4f * static_cast<float>(avatars[0].levels[0].triangles);
    EXPECT_LE(most_ms, target_ms + one_person_ms) << speed_mps;
    EXPECT_GE(least_ms, target_ms - 2 * one_person_ms) << speed_mps;
    EXPECT_LE(state.high, state.limit);
  }
}

TEST(LevelControl, ABudgetThatNobodyUsesDoesNotGrow) {
  const std::vector<AvatarCosts> avatars{{{{9000, 300}, {900, 0}}, 1.75f, 128}};
  Random random{6};
  Crowd crowd = PeopleInView(120, &random);
  ControlSettings settings;
  settings.method = LimitMethod::kFrameTime;
  LevelState state;
  for (int step = 0; step < 300; ++step)
    ChooseLevels(crowd, avatars, settings, {ViewCamera{}, {}, FrameTime_ms(state)}, &state);
  const float settled = state.budget_triangles;
  std::fill(crowd.view.begin(), crowd.view.end(), ViewClass::kOutside);
  for (int step = 0; step < 300; ++step)
    ChooseLevels(crowd, avatars, settings, {ViewCamera{}, {}, FrameTime_ms(state)}, &state);
  EXPECT_NEAR(state.budget_triangles / settled, 1, 0.01f);
}

TEST(CrowdInfluence, OnlyLowResolutionVisiblePeopleAvoidTheCameraAndOnlyAtTheLimit) {
  Random random{13};
  Crowd crowd = PeopleInView(60, &random);
  LevelState state;
  state.people.assign(60, PersonLevel{kImpostor, kNotDrawn});
  state.people[0].level = MeshLevel(0);
  state.limit = ControlSettings{}.high_limit;
  ControlSettings settings;
  settings.adaptation = Adaptation::kPaper;
  std::vector<MovingObstacle> obstacles;
  state.high = settings.high_limit - 1;
  ForesightState foresight;
  InfluenceCrowd(ViewCamera{}, {}, state, Walkable{}, settings, &crowd, &obstacles, &foresight);
  EXPECT_TRUE(obstacles.empty());
  state.high = settings.high_limit;
  InfluenceCrowd(ViewCamera{}, {}, state, Walkable{}, settings, &crowd, &obstacles, &foresight);
  EXPECT_EQ(obstacles.size(), 2u);
  EXPECT_FALSE(crowd.avoids_camera[0]);
  for (size_t i = 1; i < crowd.size(); ++i) {
    EXPECT_EQ(crowd.avoids_camera[i] != 0, Length(crowd.position[i]) <= settings.r_unimportant_m);
  }
}

}  // namespace
}  // namespace flaneur
