#include "pipeline/rig/plant_feet.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/core/rotation.h"
#include "pipeline/rig/clip_loop.h"
#include "tests/unit/pipeline/test_human.h"

namespace flaneur {
namespace {

// The same, played from its end.
Clip Reversed(const Clip& clip, size_t joints) {
  Clip reversed = clip;
  reversed.transforms.clear();
  for (int k = clip.keys - 1; k >= 0; --k) {
    const auto key = clip.transforms.begin() + static_cast<std::ptrdiff_t>(static_cast<size_t>(k) * joints);
    reversed.transforms.insert(reversed.transforms.end(), key, key + static_cast<std::ptrdiff_t>(joints));
  }
  return reversed;
}

// Its body goes to and fro, and the feet with it.
Clip Dragging(Clip clip, const std::vector<Joint>& joints) {
  for (int k = 0; k < clip.keys; ++k) {
    const float phase = 2 * kPi * static_cast<float>(k) / static_cast<float>(clip.keys - 1);
    ShiftClip(joints, &clip, k, {0, 0, 0.12f * std::sin(2 * phase)});
  }
  return clip;
}

TEST(PlantFeet, AWalkThatIsPlayedFromItsEndGoesBackwards) {
  for (const HumanShape& shape :
       {HumanShape{}, HumanShape{.unit = 100}, HumanShape{.turn = TurnAbout({0, 1, 0}, kPi)}}) {
    const Avatar person = MadeHuman(shape);
    Rig rig;
    std::string why;
    ASSERT_TRUE(MakeRig(person, {}, &rig, &why)) << why;
    const Clip walk = MadeWalk(person);
    EXPECT_FALSE(GoesBackwards(rig, walk));
    EXPECT_TRUE(GoesBackwards(rig, Reversed(walk, person.joints.size())));
  }
}

// A figure bound as it idles, aside of where it walks: its clips keep their headings to each other.
TEST(PlantFeet, AWalkKeepsItsHeadingAsideOfTheBindPose) {
  const Avatar person = MadeHuman({});
  Rig rig;
  std::string why;
  ASSERT_TRUE(MakeRig(person, {}, &rig, &why)) << why;
  for (const float heading_deg : {0.0f, 45.0f, -50.0f, 90.0f, 180.0f}) {
    Retargeted walk{Dragging(MadeWalk(person), person.joints)};
    TurnClip(TurnAbout({0, 1, 0}, heading_deg * kPi / 180), person.joints, &walk.clip);
    ASSERT_TRUE(PlantFeet(rig, &walk)) << heading_deg;
    Vec3 up, forward;
    ASSERT_TRUE(FindStance(rig.humanoid, person.joints, walk.clip, &up, &forward));
    const float off_rad = std::atan2(forward.x, forward.z) - heading_deg * kPi / 180;
    EXPECT_NEAR(std::remainder(off_rad, 2 * kPi), 0, 0.02f) << heading_deg;
  }
}

}  // namespace
}  // namespace flaneur
