#include "pipeline/rig/bone_names.h"

#include <gtest/gtest.h>

namespace flaneur {
namespace {

struct Case {
  const char* name;
  BodyPart part;
  BodySide side;
};

TEST(BoneNames, AreReadInTheWordsOfManyRigs) {
  using enum BodyPart;
  const BodySide none = BodySide::kNone, left = BodySide::kLeft, right = BodySide::kRight;
  const Case cases[] = {
      {"mixamorig:LeftUpLeg", kUpperLeg, left},
      {"mixamorig1:RightForeArm", kLowerArm, right},
      {"mixamorig:LeftHandIndex2", kIndex, left},
      {"J_Bip_L_UpperArm", kUpperArm, left},
      {"J_Bip_C_Hips", kHips, none},
      {"leftLowerLeg", kLowerLeg, left},
      {"rightLittleProximal", kLittle, right},
      {"DEF-thigh.L", kUpperLeg, left},
      {"DEF-forearm.R", kLowerArm, right},
      {"upperleg01.L", kUpperLeg, left},
      {"finger3-1.R", kFinger, right},
      {"UpLeg_L", kUpperLeg, left},
      {"thigh_l", kUpperLeg, left},
      {"calf_r", kLowerLeg, right},
      {"ball_r", kToes, right},
      {"Bip01 L UpperArm", kUpperArm, left},
      {"Bip01 R Toe0", kToes, right},
      {"ValveBiped.Bip01_R_Calf", kLowerLeg, right},
      {"CC_Base_L_Thigh", kUpperLeg, left},
      {"LeftToeBase", kToes, left},
      {"lShldr", kUpperArm, left},
      {"rForearmBend", kLowerArm, right},
      {"LThumb", kThumb, left},
      {"upperarm.l", kUpperArm, left},
      {"wrist.r", kHand, right},
      {"arm-left", kArm, left},
      {"UpperLegL", kUpperLeg, left},
      {"LowerArmR_47", kLowerArm, right},
      {"leftarm", kArm, left},
      {"LEFTTOEBASE", kToes, left},
      {"righthandthumb1", kThumb, right},
      {"LUArm", kUpperArm, left},
      {"mKneeRight", kLowerLeg, right},
      {"左腕", kUpperArm, left},
      {"右足首", kFoot, right},
      {"左ひざ", kLowerLeg, left},
      {"右小腿", kLowerLeg, right},
      {"頭", kHead, none},
      {"Head", kHead, none},
      {"character:Spine2", kSpine, none},
  };
  for (const Case& c : cases) {
    const BoneName read = ReadBoneName(c.name);
    EXPECT_EQ(static_cast<int>(read.part), static_cast<int>(c.part)) << c.name;
    EXPECT_EQ(static_cast<int>(read.side), static_cast<int>(c.side)) << c.name;
  }
}

TEST(BoneNames, OfWhatIsNoPartOfABodySayNothing) {
  for (const char* name :
       {"IK-foot.l", "kneeIK.r", "control-toe-roll.l", "PoleTargetL", "HeadTop_End", "upperarm_twist_01_l",
        "handslot.r", "HairBall_L", "index_04_leaf_l", "左足ＩＫ", "", ":", "____", "Armature", "root"}) {
    EXPECT_EQ(static_cast<int>(ReadBoneName(name).part), static_cast<int>(BodyPart::kNone)) << name;
  }
}

TEST(BoneNames, AreReadWithoutTheirOwnersName) {
  for (const std::string owner : {"Gandalf_", "old_man-", "knight", "x2_", "Char 01 "}) {
    std::vector<std::string> names = {"Rig"};
    for (const char* bone : {"Hips", "Spine", "Head", "L_Thigh", "R_Thigh", "L_Calf", "R_Calf", "L_Foot", "R_Foot"})
      names.push_back(owner + bone);
    const std::vector<BoneName> read = ReadWithoutOwner(names);
    ASSERT_EQ(read.size(), names.size()) << owner;
    EXPECT_EQ(read[3].part, BodyPart::kHead) << owner;
    EXPECT_EQ(read[4].part, BodyPart::kUpperLeg) << owner;
    EXPECT_EQ(read[4].side, BodySide::kLeft) << owner;
    EXPECT_EQ(read[9].part, BodyPart::kFoot) << owner;
    EXPECT_EQ(read[9].side, BodySide::kRight) << owner;
  }
  EXPECT_TRUE(ReadWithoutOwner({"Hips", "Spine", "Head", "Left_Leg", "Left_Foot", "Left_Arm", "Left_Hand"}).empty());
  EXPECT_TRUE(ReadWithoutOwner({"Left_Leg", "Left_Foot", "Left_Arm", "Left_Hand", "Left_Toe", "Left_Knee"}).empty());
}

}  // namespace
}  // namespace flaneur
