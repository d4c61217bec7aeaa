#include "pipeline/rig/humanoid.h"

#include <gtest/gtest.h>

#include "pipeline/rig/rig.h"
#include "tests/unit/pipeline/test_human.h"

namespace flaneur {
namespace {

struct Convention {
  const char* of;
  std::vector<std::string> names;  // as HumanShape::names
};

// What programs, suits and libraries call a human's joints.
const std::vector<Convention> kConventions = {
    {"Mixamo in capitals",
     {"HIPS", "SPINE", "NECK", "HEAD", "LEFTARM", "LEFTFOREARM", "LEFTHAND", "RIGHTARM", "RIGHTFOREARM", "RIGHTHAND",
      "LEFTUPLEG", "LEFTLEG", "LEFTFOOT", "LEFTTOEBASE", "RIGHTUPLEG", "RIGHTLEG", "RIGHTFOOT", "RIGHTTOEBASE"}},
    {"Unreal",
     {"pelvis", "spine_01", "neck_01", "head", "upperarm_l", "lowerarm_l", "hand_l", "upperarm_r", "lowerarm_r",
      "hand_r", "thigh_l", "calf_l", "foot_l", "ball_l", "thigh_r", "calf_r", "foot_r", "ball_r"}},
    {"SMPL",
     {"Pelvis", "Spine1", "Neck", "Head", "L_Shoulder", "L_Elbow", "L_Wrist", "R_Shoulder", "R_Elbow", "R_Wrist",
      "L_Hip", "L_Knee", "L_Ankle", "L_Foot", "R_Hip", "R_Knee", "R_Ankle", "R_Foot"}},
    {"old BVH",
     {"Hips", "Chest", "Neck", "Head", "LeftShoulder", "LeftElbow", "LeftWrist", "RightShoulder", "RightElbow",
      "RightWrist", "LeftHip", "LeftKnee", "LeftAnkle", "LeftToe", "RightHip", "RightKnee", "RightAnkle", "RightToe"}},
    {"OptiTrack",
     {"Hip", "Ab", "Neck", "Head", "LUArm", "LFArm", "LHand", "RUArm", "RFArm", "RHand", "LThigh", "LShin", "LFoot",
      "LToe", "RThigh", "RShin", "RFoot", "RToe"}},
    {"Kinect",
     {"SpineBase", "SpineMid", "Neck", "Head", "ShoulderLeft", "ElbowLeft", "WristLeft", "ShoulderRight", "ElbowRight",
      "WristRight", "HipLeft", "KneeLeft", "AnkleLeft", "FootLeft", "HipRight", "KneeRight", "AnkleRight",
      "FootRight"}},
    {"Advanced Skeleton",
     {"Root_M", "Spine1_M", "Neck_M", "Head_M", "Shoulder_L", "Elbow_L", "Wrist_L", "Shoulder_R", "Elbow_R", "Wrist_R",
      "Hip_L", "Knee_L", "Ankle_L", "Toes_L", "Hip_R", "Knee_R", "Ankle_R", "Toes_R"}},
    {"Second Life",
     {"mPelvis", "mTorso", "mNeck", "mHead", "mShoulderLeft", "mElbowLeft", "mWristLeft", "mShoulderRight",
      "mElbowRight", "mWristRight", "mHipLeft", "mKneeLeft", "mAnkleLeft", "mFootLeft", "mHipRight", "mKneeRight",
      "mAnkleRight", "mFootRight"}},
    {"Daz",
     {"pelvis", "abdomenLower", "neckLower", "head", "lShldrBend", "lForearmBend", "lHand", "rShldrBend",
      "rForearmBend", "rHand", "lThighBend", "lShin", "lFoot", "lToe", "rThighBend", "rShin", "rFoot", "rToe"}},
    {"Maya",
     {"C_hips_JNT", "C_spine01_JNT", "C_neck_JNT", "C_head_JNT", "L_arm_JNT", "L_forearm_JNT", "L_hand_JNT",
      "R_arm_JNT", "R_forearm_JNT", "R_hand_JNT", "L_upleg_JNT", "L_leg_JNT", "L_foot_JNT", "L_toe_JNT", "R_upleg_JNT",
      "R_leg_JNT", "R_foot_JNT", "R_toe_JNT"}},
    {"Xsens",
     {"Pelvis", "L5", "Neck", "Head", "LeftUpperArm", "LeftForeArm", "LeftHand", "RightUpperArm", "RightForeArm",
      "RightHand", "LeftUpperLeg", "LeftLowerLeg", "LeftFoot", "LeftToe", "RightUpperLeg", "RightLowerLeg", "RightFoot",
      "RightToe"}},
    {"3ds Max",
     {"Bip001 Pelvis", "Bip001 Spine", "Bip001 Neck", "Bip001 Head", "Bip001 L UpperArm", "Bip001 L Forearm",
      "Bip001 L Hand", "Bip001 R UpperArm", "Bip001 R Forearm", "Bip001 R Hand", "Bip001 L Thigh", "Bip001 L Calf",
      "Bip001 L Foot", "Bip001 L Toe0", "Bip001 R Thigh", "Bip001 R Calf", "Bip001 R Foot", "Bip001 R Toe0"}},
};

TEST(Humanoid, IsKnownByTheNamesOfManyPrograms) {
  for (const Convention& convention : kConventions) {
    SCOPED_TRACE(convention.of);
    const Avatar human = MadeHuman({.names = convention.names});
    Humanoid h;
    std::string why;
    ASSERT_TRUE(FindHumanoid(human.joints, BindPose(human.joints).positions, {}, &h, &why)) << why;
    EXPECT_FALSE(h.by_shape);
    EXPECT_EQ(h.hips, 0);
    EXPECT_EQ(h.head, 3);
    EXPECT_EQ(h.arms[kLeft].upper, 4);
    EXPECT_EQ(h.arms[kLeft].lower, 5);
    EXPECT_EQ(h.arms[kLeft].hand, 6);
    EXPECT_EQ(h.legs[kLeft].upper, 10);
    EXPECT_EQ(h.legs[kLeft].lower, 11);
    EXPECT_EQ(h.legs[kLeft].foot, 12);
    EXPECT_EQ(h.legs[kRight].upper, 14);
    EXPECT_EQ(h.legs[kRight].toes, 17);
  }
}

// Without toes whole feet pitch about the ball, and their tips push the ground ahead.
TEST(Humanoid, WhatBendsTheFootIsItsToesWhateverItIsCalled) {
  std::vector<std::string> names = HumanShape{}.names;
  names[13] = "left paw", names[17] = "right paw";
  Avatar human = MadeHuman({.names = names});
  std::vector<Vec3> positions = BindPose(human.joints).positions;
  const auto toes_of_right = [&] {
    Humanoid h;
    std::string why;
    EXPECT_TRUE(FindHumanoid(human.joints, positions, {}, &h, &why)) << why;
    return h.legs[kRight].toes;
  };
  EXPECT_EQ(toes_of_right(), -1) << "an end alone is a tip";
  for (const int paw : {13, 17}) {
    human.joints.push_back({"tip", paw, {}, {}});
    positions.push_back(positions[static_cast<size_t>(paw)] + Vec3{0, 0, 0.06f});
  }
  EXPECT_EQ(toes_of_right(), 17);
}

}  // namespace
}  // namespace flaneur
