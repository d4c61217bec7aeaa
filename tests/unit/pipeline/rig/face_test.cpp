#include "pipeline/rig/face.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/unit/pipeline/test_person.h"

namespace flaneur {
namespace {

struct Case {
  const char* name;
  FaceMove move;
  BodySide side;
};

TEST(FaceNames, AreReadInTheWordsOfManyPrograms) {
  using enum FaceMove;
  const BodySide none = BodySide::kNone, left = BodySide::kLeft, right = BodySide::kRight;
  const Case cases[] = {
      {"eyeBlinkLeft", kBlink, left},  // ARKit
      {"blendShape1.eyeBlink_R", kBlink, right},
      {"jawOpen", kOpenMouth, none},
      {"blink", kBlink, none},  // VRM
      {"Blink_L", kBlink, left},
      {"aa", kOpenMouth, none},
      {"Fcl_EYE_Close", kBlink, none},  // VRoid
      {"Fcl_EYE_Close_R", kBlink, right},
      {"Fcl_MTH_A", kOpenMouth, none},
      {"vrc.v_aa", kOpenMouth, none},  // VRChat
      {"vrc.blink", kBlink, none},
      {"eyesClosed", kBlink, none},  // Ready Player Me
      {"mouthOpen", kOpenMouth, none},
      {"viseme_aa", kOpenMouth, none},  // Oculus
      {"Eye_Blink_L", kBlink, left},    // Character Creator
      {"A25_Jaw_Open", kOpenMouth, none},
      {"V_Open", kOpenMouth, none},
      {"eCTRLEyesClosedR", kBlink, right},  // Daz
      {"facs_bs_EyeBlinkLeft", kBlink, left},
      {"eCTRLMouthOpen", kOpenMouth, none},
      {"eCTRLvAA", kOpenMouth, none},
      {"Blink_Right", kBlink, right},        // Mixamo
      {"LeftUpperLidClosed", kBlink, left},  // MakeHuman
      {"まばたき", kBlink, none},            // MikuMikuDance
      {"あ", kOpenMouth, none},
      {"eyeLookDownLeft", kNone, left},
      {"mouthSmileLeft", kNone, left},
      {"mouthClose", kNone, none},
      {"eyeSquintRight", kNone, right},
      {"Happy", kNone, none},
      {"viseme_oh", kNone, none},
      {"", kNone, none},
  };
  for (const Case& each : cases) {
    const FaceName read = ReadFaceName(each.name);
    EXPECT_EQ(static_cast<int>(read.move), static_cast<int>(each.move)) << each.name;
    if (each.move == kNone) continue;
    EXPECT_EQ(static_cast<int>(read.side), static_cast<int>(each.side)) << each.name;
  }
  EXPECT_LT(ReadFaceName("blink").rank, ReadFaceName("blinkLeft").rank) << "both eyes at once are one target";
}

// The made person's trunk is its head: the front above 1.6 m are lids, below 1.5 m is a chin.
FaceShape Lids(const Avatar& avatar) {
  FaceShape shape{FaceMove::kBlink, {{}}};
  for (const Vec3 p : avatar.meshes[0].positions) {
    const bool lid = p.y > 1.6f && p.z > 0.1f;
    shape.offsets[0].push_back(lid ? Vec3{0, -0.02f * (p.y - 1.6f) / 0.2f, 0.003f} : Vec3{});
  }
  return shape;
}

// Lips part: one goes up, the other down, as no one direction does.
FaceShape Lips(const Avatar& avatar) {
  FaceShape shape{FaceMove::kOpenMouth, {{}}};
  for (const Vec3 p : avatar.meshes[0].positions) {
    const bool lip = p.y > 1.3f && p.y < 1.5f && p.z > 0.1f;
    shape.offsets[0].push_back(lip ? Vec3{0, p.y > 1.4f ? 0.01f : -0.03f, 0} : Vec3{});
  }
  return shape;
}

Avatar Blinking(const std::string& name, std::vector<FaceShape> shapes) {
  Avatar avatar = MadePerson();
  avatar.name = name;
  std::vector<std::string> warnings;
  const std::vector<FaceJoint> face = AddFaceJoints(shapes, &avatar, &warnings);
  EXPECT_TRUE(warnings.empty());
  MoveFace(face, &avatar);
  return avatar;
}

// How far the joints of a movement are from rest, a key, as shares of the farthest.
std::vector<float> Amounts(const Avatar& avatar, const char* clip_name, const char* joint_name) {
  const Clip* clip = FindClip(avatar, clip_name);
  std::vector<float> amounts;
  for (size_t j = 0; j < avatar.joints.size() && amounts.empty(); ++j) {
    if (avatar.joints[j].name != joint_name) continue;
    for (size_t i = j; i < clip->transforms.size(); i += avatar.joints.size())
      amounts.push_back(Length(clip->transforms[i].translation));
  }
  return amounts;
}

// When a lid is nearly closed for the first key, in seconds.
std::vector<float> Blinks(const Avatar& avatar) {
  const std::vector<float> amounts = Amounts(avatar, "idle", "Blink");
  const Clip& idle = *FindClip(avatar, "idle");
  const float most = *std::max_element(amounts.begin(), amounts.end());
  std::vector<float> begins;
  for (size_t k = 1; k < amounts.size(); ++k) {
    if (amounts[k] > 0.9f * most && amounts[k - 1] <= 0.9f * most)
      begins.push_back(idle.duration_s * static_cast<float>(k) / static_cast<float>(idle.keys - 1));
  }
  return begins;
}

TEST(Face, JointsTakeVerticesWhereTheShapeDoes) {
  Avatar avatar = MadePerson();
  const Avatar before = avatar;
  const std::vector<FaceShape> shapes{Lids(avatar), Lips(avatar)};
  std::vector<std::string> warnings;
  const std::vector<FaceJoint> face = AddFaceJoints(shapes, &avatar, &warnings);
  EXPECT_TRUE(warnings.empty());
  ASSERT_GE(face.size(), 3u) << "lips part by two joints";
  std::vector<Transform> pose;
  for (const Joint& joint : avatar.joints) pose.push_back(joint.rest);
  const auto positions = SkinnedPositions(avatar.meshes[0], SkinningMatrices(avatar.joints, pose));
  for (size_t v = 0; v < positions.size(); ++v) {
    const Vec3 wanted = before.meshes[0].positions[v] + shapes[0].offsets[0][v] + shapes[1].offsets[0][v];
    EXPECT_LT(Length(positions[v] - wanted), 0.003f) << v << ", of 20 and 30 mm";
    const auto& weights = avatar.meshes[0].weights[v];
    EXPECT_NEAR(weights[0] + weights[1] + weights[2] + weights[3], 1, 1e-5f);
  }
  // In the clips that are there the face lies still: everybody walks as before.
  const Clip& walk = *FindClip(avatar, "walk");
  const auto walked = SkinnedPositions(avatar.meshes[0], SkinningMatrices(avatar, walk, 0.3f));
  const auto as_before = SkinnedPositions(before.meshes[0], SkinningMatrices(before, before.clips[0], 0.3f));
  for (size_t v = 0; v < walked.size(); ++v) EXPECT_LT(Length(walked[v] - as_before[v]), 1e-5f) << v;
}

TEST(Face, EyesBlinkForAMomentAtIrregularTimes) {
  const Avatar avatar = Blinking("made", {Lids(MadePerson())});
  const std::vector<float> begins = Blinks(avatar);
  const Clip& idle = *FindClip(avatar, "idle");
  ASSERT_GE(begins.size(), 2u);
  std::set<int> gaps_tenths;
  for (size_t i = 0; i < begins.size(); ++i) {
    const float gap_s = i + 1 < begins.size() ? begins[i + 1] - begins[i] : begins[0] + idle.duration_s - begins[i];
    EXPECT_GT(gap_s, 1.2f);
    EXPECT_LT(gap_s, 8);
    gaps_tenths.insert(static_cast<int>(10 * gap_s));
  }
  EXPECT_GT(gaps_tenths.size(), 1u) << "not by the clock";
  const std::vector<float> amounts = Amounts(avatar, "idle", "Blink");
  const auto busy = std::count_if(amounts.begin(), amounts.end(), [](float amount) { return amount > 0; });
  EXPECT_LT(static_cast<float>(busy) / 30 / static_cast<float>(begins.size()), 0.25f);
  EXPECT_EQ(amounts.front(), 0);
  EXPECT_EQ(amounts.back(), 0);
}

TEST(Face, NoTwoAvatarsBlinkInStep) {
  EXPECT_NE(Blinks(Blinking("monk", {Lids(MadePerson())})), Blinks(Blinking("nun", {Lids(MadePerson())})));
}

TEST(Face, TheMouthOpensInTalkAlone) {
  const Avatar avatar = Blinking("made", {Lips(MadePerson())});
  const std::vector<float> talk = Amounts(avatar, "talk", "OpenMouth"), idle = Amounts(avatar, "idle", "OpenMouth");
  int openings = 0;
  for (size_t k = 1; k + 1 < talk.size(); ++k) openings += talk[k] > talk[k - 1] && talk[k] >= talk[k + 1];
  EXPECT_GT(openings, 8);
  EXPECT_EQ(talk.front(), 0);
  EXPECT_EQ(talk.back(), 0);
  EXPECT_EQ(std::count(idle.begin(), idle.end(), 0.0f), static_cast<std::ptrdiff_t>(idle.size()));
}

TEST(Face, WhatMovesTheWholeFigureIsNoFace) {
  Avatar avatar = MadePerson();
  const FaceShape lift{FaceMove::kBlink, {std::vector<Vec3>(avatar.meshes[0].positions.size(), Vec3{0, 0.5f, 0})}};
  std::vector<std::string> warnings;
  EXPECT_TRUE(AddFaceJoints({lift}, &avatar, &warnings).empty());
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("closing the eyes is left out"), std::string::npos) << warnings[0];
  EXPECT_EQ(avatar.joints.size(), 3u);
}

TEST(Face, WithoutAShapeNothingChanges) {
  Avatar avatar = MadePerson();
  std::vector<std::string> warnings;
  FaceShape still = Lids(avatar);
  for (Vec3& d : still.offsets[0]) d = d * 0.001f;
  MoveFace(AddFaceJoints({{FaceMove::kBlink, {}}, still}, &avatar, &warnings), &avatar);
  EXPECT_EQ(avatar.joints.size(), 3u);
  EXPECT_EQ(avatar.clips.size(), 1u);
  EXPECT_TRUE(warnings.empty());
}

}  // namespace
}  // namespace flaneur
