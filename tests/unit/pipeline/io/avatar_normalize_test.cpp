#include "pipeline/io/avatar_normalize.h"

#include <gtest/gtest.h>

#include "pipeline/rig/clip_loop.h"
#include "pipeline/rig/rig.h"
#include "tests/unit/pipeline/test_human.h"

namespace flaneur {
namespace {

constexpr size_t kLeftThigh = 10, kRightThigh = 14;
constexpr uint16_t kHand = 6;

// The middle between the thighs' joints, the mean over a clip; on the ground.
Vec3 HipsIn(const Avatar& person, const std::string& name) {
  const Clip& clip = *FindClip(person, name);
  Vec3 sum;
  for (int k = 0; k + 1 < clip.keys; ++k) {
    const Pose pose = PoseOf(person.joints, clip.transforms.data() + static_cast<size_t>(k) * person.joints.size());
    sum = sum + (pose.positions[kLeftThigh] + pose.positions[kRightThigh]) * 0.5f;
  }
  sum = sum * (1 / static_cast<float>(clip.keys - 1));
  return {sum.x, 0, sum.z};
}

// Who walks, idles and sits, 0.3 m behind where they stand, at that place of their file.
Avatar Person(Vec3 place) {
  Avatar person = MadeHuman({});
  person.clips = {MadeWalk(person)};
  for (const std::string name : {"idle", "sit"}) {
    Clip still{name, 1, 2, {}};
    for (int k = 0; k < 2; ++k) {
      for (const Joint& joint : person.joints) still.transforms.push_back(joint.rest);
    }
    if (name == "sit") ShiftClip(person.joints, &still, {0, -0.3f, -0.3f});
    person.clips.push_back(still);
  }
  for (Clip& clip : person.clips) ShiftClip(person.joints, &clip, place);
  for (Vec3& p : person.meshes[0].positions) p = p + place;
  for (Joint& joint : person.joints) {
    if (joint.parent < 0) joint.rest.translation = joint.rest.translation + place;
    joint.inverse_bind = joint.inverse_bind * FromTranslationRotationScale(place * -1, {}, {1, 1, 1});
  }
  return person;
}

// Many things of many vertices, held out before the chest.
void HoldOut(Avatar* person) {
  for (int i = 0; i < 40; ++i)
    AddBox({0.5f, 1.2f, 0.3f}, {0.5f, 1.2f, 1.0f}, 0.03f + 0.001f * static_cast<float>(i), kHand, &person->meshes[0]);
}

void Normalize(Avatar* person, const NormalizeOptions& options = {}) {
  std::vector<std::string> warnings;
  const Mesh body = person->meshes[0];
  const Error e = NormalizeAvatar(options, body, person, &warnings);
  ASSERT_FALSE(e) << e.message;
}

TEST(NormalizeAvatar, WhoHoldsThingsOutStandsOverTheirOwnHips) {
  Avatar person = Person({});
  HoldOut(&person);
  Normalize(&person);
  EXPECT_LT(Length(HipsIn(person, "walk")), 0.01f);
  EXPECT_LT(Length(HipsIn(person, "idle")), 0.01f);
}

TEST(NormalizeAvatar, NobodyLeavesTheirPlaceInAnyClipWhereverTheyStoodInTheirFile) {
  for (const Vec3 place : {Vec3{}, Vec3{0.15f, 0, -0.12f}, Vec3{-37, 0, 24}}) {
    Avatar person = Person(place);
    Normalize(&person);
    EXPECT_LT(Length(HipsIn(person, "walk")), 0.01f) << place.x;
    EXPECT_LT(Length(HipsIn(person, "idle")), 0.01f) << place.x;
    EXPECT_LT(Length(HipsIn(person, "sit") - Vec3{0, 0, -0.3f}), 0.01f) << place.x;
  }
}

// Bound on a chair, as a file may be saved: as high as it stands, not as it sits.
TEST(NormalizeAvatar, WhoIsBoundSeatedIsAsHighAsTheyStand) {
  Avatar stands = Person({}), seated = Person({});
  BindSeated(1.5f, 1.5f, 0, &seated);
  Normalize(&stands);
  Normalize(&seated);
  EXPECT_NEAR(seated.height_m, stands.height_m, 0.02f);
  NormalizeOptions told;
  told.height_m = 1.6f;
  Avatar again = Person({});
  BindSeated(1.5f, 1.5f, 0, &again);
  Normalize(&again, told);
  const auto thigh = [](const Avatar& person) { return Length(person.joints[kLeftThigh + 1].rest.translation); };
  EXPECT_NEAR(thigh(again) / thigh(seated), 1.6f / stands.height_m, 0.02f);
}

}  // namespace
}  // namespace flaneur
