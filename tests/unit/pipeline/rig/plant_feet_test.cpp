#include "pipeline/rig/plant_feet.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace flaneur
