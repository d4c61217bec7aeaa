#include "pipeline/rig/still_legs.h"

#include <gtest/gtest.h>

#include "tests/unit/pipeline/test_human.h"

namespace flaneur {
namespace {

constexpr float kLevel = kPi / 2;

// Two keys in which arms alone move; thighs are lifted and shins hang by these angles.
Clip Gesture(const Avatar& human, float thigh, float shin) {
  Clip clip{"clip", 1, 2, {}};
  for (const float arm : {0.0f, 0.4f}) {
    for (size_t j = 0; j < human.joints.size(); ++j) {
      Transform t = human.joints[j].rest;
      float angle = 0;
      if (j == 10 || j == 14) angle = -thigh;
      if (j == 11 || j == 15) angle = shin;
      if (j == 4 || j == 7) angle = arm;
      t.rotation = Normalized(Product(t.rotation, TurnAbout({1, 0, 0}, angle)));
      clip.transforms.push_back(t);
    }
  }
  return clip;
}

struct Made {
  Avatar person;
  Rig rig;
};

std::vector<Made> People() {
  std::vector<Made> people;
  for (const HumanShape& shape : {HumanShape{}, HumanShape{.unit = 100}, HumanShape{.leg_m = 0.5f},
                                  HumanShape{.turn = TurnAbout({1, 0, 0}, kPi / 2)}}) {
    Made& made = people.emplace_back();
    made.person = MadeHuman(shape);
    std::string why;
    EXPECT_TRUE(MakeRig(made.person, {}, &made.rig, &why)) << why;
  }
  return people;
}

TEST(StillLegs, WhoWalksMovesThem) {
  for (const Made& made : People()) {
    EXPECT_FALSE(KeepsLegsStill(made.rig, MadeWalk(made.person)));
    EXPECT_TRUE(KeepsLegsStill(made.rig, Gesture(made.person, 0, 0)));
    EXPECT_TRUE(KeepsLegsStill(made.rig, Gesture(made.person, kLevel, kLevel)));
  }
}

TEST(StillLegs, WhoSitsHasLevelThighs) {
  for (const Made& made : People()) {
    EXPECT_FALSE(Sits(made.rig, MadeWalk(made.person)));
    EXPECT_FALSE(Sits(made.rig, Gesture(made.person, 0, 0)));
    EXPECT_FALSE(Sits(made.rig, Gesture(made.person, 0.3f, 0.3f))) << "knees a little bent";
    EXPECT_TRUE(Sits(made.rig, Gesture(made.person, kLevel, kLevel)));
  }
}

TEST(StillLegs, WhoSitsKeepsTheSeatAndMovesTheArms) {
  for (const Made& made : People()) {
    const Clip seated = Gesture(made.person, kLevel, kLevel), idle = Gesture(made.person, 0, 0);
    Clip kept = idle;
    KeepSeated(made.rig, seated, &kept);
    EXPECT_TRUE(Sits(made.rig, kept));
    const size_t joints = made.person.joints.size();
    for (const size_t arm : {size_t{4}, size_t{7}}) {
      EXPECT_EQ(kept.transforms[joints + arm].rotation.x, idle.transforms[joints + arm].rotation.x);
    }
  }
}

}  // namespace
}  // namespace flaneur
