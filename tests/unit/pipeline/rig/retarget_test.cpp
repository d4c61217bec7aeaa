#include "pipeline/rig/retarget.h"

#include <gtest/gtest.h>

#include "pipeline/rig/clip_rig.h"
#include "pipeline/rig/motion_quality.h"
#include "pipeline/rig/steps.h"
#include "runtime/base/array.h"
#include "tests/unit/pipeline/test_human.h"

namespace flaneur {
namespace {

Rig RigOf(const Avatar& person) {
  Rig rig;
  std::string why;
  EXPECT_TRUE(MakeRig(person, {}, &rig, &why)) << why;
  return rig;
}

// Where a limb points in a key, in the reference pose's space.
Vec3 Direction(const Rig& rig, const Clip& clip, int key, int from, int to) {
  Pose pose = PoseOf(rig.joints, clip.transforms.data() + static_cast<size_t>(key) * rig.joints.size());
  TurnPose(rig.turn, &pose);
  return Normalized(pose.positions[static_cast<size_t>(to)] - pose.positions[static_cast<size_t>(from)]);
}

class Retargeting : public testing::TestWithParam<HumanShape> {};

TEST_P(Retargeting, LimbsPointAsTheSourcesDo) {
  const Avatar source = MadeHuman({});
  const Clip walk = MadeWalk(source);
  const Rig from = RigOf(source);
  const Avatar target = MadeHuman(GetParam());
  const Rig to = RigOf(target);
  const Retargeted made = Retarget(from, walk, to);
  ASSERT_EQ(made.clip.keys, walk.keys);
  ASSERT_EQ(made.clip.transforms.size(), target.joints.size() * static_cast<size_t>(walk.keys));
  for (int k = 0; k < walk.keys; k += 5) {
    for (const auto& [a, b] : {std::pair{4, 5}, {5, 6}, {7, 8}, {8, 9}, {1, 2}}) {
      EXPECT_LT(AngleBetween(Direction(from, walk, k, a, b), Direction(to, made.clip, k, a, b)), 0.02f)
          << k << " " << a;
    }
  }
  EXPECT_LT(PastLimits(to, made.clip), 0.02f);
  EXPECT_NEAR(to.leg_m * (HipsHeight(to, made.clip) - HipsHeight(from, walk)) / GetParam().unit, 0, 0.03f);
  EXPECT_GT(made.walk_speed_mps, 0.5f * GetParam().leg_m * GetParam().unit);
}

INSTANTIATE_TEST_SUITE_P(Shapes, Retargeting,
                         testing::Values(HumanShape{}, HumanShape{.leg_m = 0.55f}, HumanShape{.unit = 100},
                                         HumanShape{.arm_down_deg = 45}, HumanShape{.arm_down_deg = 80},
                                         HumanShape{.turn = TurnAbout({1, 0, 0}, kPi / 2)},
                                         HumanShape{.turn = TurnAbout({0, 1, 0}, kPi)},
                                         HumanShape{.feet_on_root = true}));

TEST(Retarget, FeetStandOnTheGround) {
  const Avatar source = MadeHuman({});
  Avatar target = MadeHuman({.leg_m = 0.6f});
  const Rig from = RigOf(source), to = RigOf(target);
  const Retargeted made = Retarget(from, MadeWalk(source), to);
  for (int k = 0; k < made.clip.keys; ++k) {
    float lowest = 1e30f;
    for (const Vec3 p : SkinnedPositions(
             target.meshes[0],
             SkinningMatrices(target, made.clip,
                              made.clip.duration_s * static_cast<float>(k) / static_cast<float>(made.clip.keys))))
      lowest = std::min(lowest, p.y);
    EXPECT_NEAR(lowest, 0, 0.03f) << k;
    EXPECT_GT(lowest, -0.005f) << k;
  }
}

// Arms at rest half down, and broader than that.
Avatar BroadHuman() {
  Avatar human = MadeHuman({.arm_down_deg = 45});
  AddBox({-0.2f, 0.9f, -0.1f}, {0.2f, 1.4f, 0.1f}, 0.12f, 1, &human.meshes[0]);
  return human;
}

Clip ArmsDown(const Avatar& human) {
  Clip down{"idle", 1, 2, {}};
  for (int k = 0; k < 2; ++k) {
    for (size_t j = 0; j < human.joints.size(); ++j) {
      Transform t = human.joints[j].rest;
      if (j == 4 || j == 7) t.rotation = TurnAbout({0, 0, 1}, (j == 4 ? -1.0f : 1.0f) * 40 * kPi / 180);
      down.transforms.push_back(t);
    }
  }
  return down;
}

TEST(Retarget, HandsAreLedOutOfABroadBody) {
  const Avatar human = BroadHuman();
  const Rig rig = RigOf(human);
  Clip down = ArmsDown(human);
  const float before = std::max(HandDepth(human, rig, down, kLeft, 2), HandDepth(human, rig, down, kRight, 2));
  ASSERT_GT(before, 0.01f);
  EXPECT_GT(ClearHands(human, rig, &down), 0);
  EXPECT_LT(std::max(HandDepth(human, rig, down, kLeft, 2), HandDepth(human, rig, down, kRight, 2)), 0.01f);
}

// Files split one body into vertices and meshes in any manner; its arms then hang as they did.
TEST(Retarget, HandsAreLedOutAlikeHoweverTheBodyIsSplit) {
  Avatar whole = BroadHuman();
  for (int i = 0; i < 200; ++i) {
    const float y = 0.9f + 0.0025f * static_cast<float>(i), x = 0.35f + 0.1f * std::sin(0.7f * static_cast<float>(i));
    AddBox({0, y, -0.1f}, {x, y, 0.1f}, 0.01f, 1, &whole.meshes[0]);
  }
  const Rig rig = RigOf(whole);
  Avatar split = whole;  // every second vertex in another mesh, and each twice, backwards
  split.meshes.assign(2, {});
  const Mesh& mesh = whole.meshes[0];
  for (int copy = 0; copy < 2; ++copy) {
    for (size_t v = mesh.positions.size(); v-- > 0;) {
      Mesh& to = split.meshes[v % 2];
      to.positions.push_back(mesh.positions[v]);
      to.normals.push_back(mesh.normals[v]);
      to.joints.push_back(mesh.joints[v]);
      to.weights.push_back(mesh.weights[v]);
    }
  }
  Clip of_whole = ArmsDown(whole), of_split = of_whole;
  EXPECT_EQ(ClearHands(whole, rig, &of_whole), ClearHands(split, rig, &of_split));
}

TEST(Retarget, KneesBendForwardHoweverHighTheyAreLifted) {
  const Avatar source = MadeHuman({});
  const Avatar target = MadeHuman({.leg_m = 0.7f});
  const Rig from = RigOf(source), to = RigOf(target);
  Clip high = MadeWalk(source);
  for (int k = 0; k < high.keys; ++k) {
    const float phase = 2 * kPi * static_cast<float>(k) / static_cast<float>(high.keys - 1);
    for (const size_t leg : {size_t{10}, size_t{14}}) {
      const float lift = std::max(0.0f, std::cos(leg == 14 ? phase + kPi : phase));
      Transform* key = high.transforms.data() + static_cast<size_t>(k) * 18;
      key[leg].rotation = TurnAbout({1, 0, 0}, -1.9f * lift);
      key[leg + 1].rotation = TurnAbout({1, 0, 0}, 2.4f * lift);
      key[leg + 2].rotation = TurnAbout({1, 0, 0}, -0.5f * lift);
    }
  }
  EXPECT_LT(PastLimits(to, Retarget(from, high, to, {.walks = true}).clip), 0.1f);
}

constexpr size_t kFeet = 104;  // of MadeHuman's vertices, the first on a foot: knees apart turn them outwards

// Against the first vertex, which is the pelvis's.
std::vector<Vec3> SkinOver(const Avatar& person, const Clip& clip, int key) {
  const float time_s = clip.duration_s * static_cast<float>(key) / static_cast<float>(clip.keys - 1);
  std::vector<Vec3> skin = SkinnedPositions(person.meshes[0], SkinningMatrices(person, clip, time_s));
  const Vec3 first = skin[0];
  for (Vec3& p : skin) p = p - first;
  return skin;
}

// As a file may be saved: on a chair, on the ground, with knees apart, on toes or heels, with the shins of who runs.
TEST(Retarget, WhoIsBoundSeatedWalksAsIfBoundStanding) {
  const Avatar person = MadeHuman({});
  const Clip walk = MadeWalk(person);
  Rig standing;
  std::string why;
  ASSERT_TRUE(MakeRig(person, {}, &standing, &why)) << why;
  const Clip expected = Retarget(standing, walk, standing, {.walks = true}).clip;
  for (const auto& [raised, bent, apart] : {std::array{1.5f, 1.5f, 0.0f},
                                            {1.4f, 1.2f, 0.4f},
                                            {1.5f, 0.0f, 0.0f},
                                            {1.75f, 1.9f, 0.2f},
                                            {1.62f, 1.4f, 0.5f},
                                            {-0.3f, 0.7f, 0.0f},
                                            {0.5f, 0.1f, 0.0f},
                                            {0.1f, 1.9f, 0.0f}}) {
    Avatar seated = MadeHuman({});
    BindSeated(raised, bent, apart, &seated);
    Rig rig;
    ASSERT_TRUE(MakeRig(seated, {}, &rig, &why)) << why;
    const Clip made = Retarget(standing, walk, rig, {.walks = true}).clip;
    ASSERT_EQ(made.keys, expected.keys);
    for (int k = 0; k + 1 < made.keys; ++k) {
      const std::vector<Vec3> here = SkinOver(seated, made, k), there = SkinOver(person, expected, k);
      for (size_t v = 0; v < (apart == 0 ? here.size() : kFeet); ++v)
        ASSERT_LT(Length(here[v] - there[v]), 0.06f) << raised << " " << bent << " " << apart << ": vertex " << v;
    }
  }
}

// Knees that give under the body, so that legs are straightest where their foot is on its heel or its toes.
Clip Giving(Clip walk) {
  for (int k = 0; k < walk.keys; ++k) {
    const float phase = 2 * kPi * static_cast<float>(k) / static_cast<float>(walk.keys - 1);
    Transform* const key = walk.transforms.data() + static_cast<size_t>(k) * 18;
    for (const size_t leg : {size_t{10}, size_t{14}}) {
      const float own = leg == 14 ? phase + kPi : phase, give = 0.9f * std::cos(own) * std::cos(own);
      for (const auto& [joint, angle] :
           {std::pair{leg, -0.5f * give}, {leg + 1, give}, {leg + 2, -0.5f * give - 0.5f * std::sin(own)}}) {
        key[joint].rotation = Normalized(Product(key[joint].rotation, TurnAbout({1, 0, 0}, angle)));
      }
    }
  }
  return walk;
}

TEST(Retarget, WhoIsBoundSeatedLeadsOthersAsIfBoundStanding) {
  const Avatar person = MadeHuman({});
  const Rig standing = RigOf(person);
  const Clip walk = Giving(MadeWalk(person));
  const Retargeted expected = Retarget(standing, walk, standing, {.walks = true});
  for (const auto& [raised, bent] : {std::array{1.5f, 1.5f}, {1.75f, 1.75f}, {0.1f, 1.9f}}) {
    Avatar seated = MadeHuman({});
    BindSeated(raised, bent, 0, &seated);
    Rig source;
    std::string why;
    ASSERT_TRUE(MakeClipRig(seated, {}, walk, &source, &why)) << why;
    const Retargeted made = Retarget(source, walk, standing, {.walks = true});
    EXPECT_NEAR(made.walk_speed_mps, expected.walk_speed_mps, 0.05f * expected.walk_speed_mps) << raised << " " << bent;
    EXPECT_NEAR(HipsHeight(standing, made.clip), HipsHeight(standing, expected.clip), 0.01f) << raised << " " << bent;
  }
}

// As a bird's: what bends back is no knee that tells where the front is.
TEST(Retarget, AKneeThatIsBoundBackwardsPointsAheadAllTheSame) {
  for (const float apart : {-0.2f, 0.0f, 0.2f}) {
    Avatar person = MadeHuman({});
    BindSeated(-0.1f, -0.8f, apart, &person);
    const Rig rig = RigOf(person);
    for (const size_t side : {kLeft, kRight}) EXPECT_GT(Rotated(rig.leg_upper[side], {0, 0, 1}).z, 0.9f) << apart;
  }
}

TEST(Retarget, AKneeIsOneHingeHoweverItIsBound) {
  for (const auto& [raised, bent, apart] : {std::array{0.0f, 0.1f, 0.0f},
                                            {1.5f, 1.5f, 0.3f},
                                            {1.75f, 1.9f, 0.2f},
                                            {0.1f, 1.9f, 0.2f},
                                            {-0.3f, 1.6f, -0.2f}}) {
    Avatar person = MadeHuman({});
    BindSeated(raised, bent, apart, &person);
    const Rig rig = RigOf(person);
    for (const size_t side : {kLeft, kRight}) {
      const Vec3 thigh = Rotated(rig.leg_upper[side], {1, 0, 0}), shin = Rotated(rig.leg_lower[side], {1, 0, 0});
      EXPECT_LT(AngleBetween(thigh, shin), 0.1f) << raised << " " << bent << " " << apart;
      EXPECT_GT(thigh.x, 0.8f) << raised << " " << bent << " " << apart;
    }
  }
}

TEST(Retarget, LegsOfOneBoneWithoutAMeshReachTheGround) {
  Avatar human = MadeHuman({});
  human.meshes.clear();
  for (const size_t j : {11u, 12u, 13u, 15u, 16u, 17u}) human.joints[j].name = "cloth", human.joints[j].parent = 0;
  const Rig rig = RigOf(human);
  EXPECT_FALSE(BendsKnees(rig));
  EXPECT_NEAR(rig.leg_m, 0.92f * 0.91f, 0.02f) << "hips at 0.92 m, ankles at a tenth of it";
}

// A toy: a box a leg, from the hip down, with a shoe of any length that nothing turns against it.
Avatar MadeToy(float leg_m, float before_m, float behind_m) {
  Avatar toy = MadeHuman({.leg_m = leg_m});
  for (const size_t j : {11u, 12u, 13u, 15u, 16u, 17u}) toy.joints[j].name = "cloth", toy.joints[j].parent = 0;
  Mesh& body = toy.meshes[0];
  body = {};
  for (const uint16_t joint : {uint16_t{10}, uint16_t{14}}) {
    const float x = joint == 10 ? 0.09f : -0.09f;
    AddBox({x, 0.05f, 0}, {x, leg_m, 0}, 0.05f, joint, &body);
    AddBox({x, 0.04f, -behind_m}, {x, 0.04f, before_m}, 0.04f, joint, &body);
  }
  return toy;
}

TEST(Retarget, LegsOfOneBoneStepWithoutSlidingOrSinking) {
  const Avatar source = MadeHuman({});
  for (const auto& [leg_m, before_m, behind_m] :
       {std::array{0.8f, 0.1f, 0.05f}, {0.5f, 0.02f, 0.02f}, {0.25f, 0.12f, 0.06f}, {0.9f, 0.3f, 0.1f}}) {
    const Avatar toy = MadeToy(leg_m, before_m, behind_m);
    const Rig rig = RigOf(toy);
    ASSERT_FALSE(BendsKnees(rig));
    const Retargeted made = Retarget(RigOf(source), MadeWalk(source), rig, {.walks = true});
    EXPECT_GT(made.walk_speed_mps, 0.5f * leg_m);
    const float step_s = made.clip.duration_s / static_cast<float>(made.clip.keys - 1);
    int swings = 0;
    for (int k = 0; k + 1 < made.clip.keys; ++k) {
      const Pose now = PoseAt(rig, made.clip, k), next = PoseAt(rig, made.clip, k + 1);
      float lowest = 1, slid = 1;
      for (const RigLeg& leg : rig.legs) {
        float low = 1;
        for (const SolePoint& point : leg.sole) {
          const Vec3 a = PlaceOf(point, now), b = PlaceOf(point, next);
          low = std::min(low, a.y);
          if (std::max(a.y, b.y) > 0.024f * leg_m) continue;
          const Vec3 way = b - a + Vec3{0, 0, made.walk_speed_mps * step_s};
          slid = std::min(slid, std::hypot(way.x, way.z) / (made.walk_speed_mps * step_s));
        }
        lowest = std::min(lowest, low);
        swings += low > 0.03f * leg_m;
      }
      EXPECT_NEAR(lowest, 0, 0.002f * leg_m) << leg_m << " " << k;
      EXPECT_LT(slid, 0.1f) << leg_m << " " << k << ": something stands";
    }
    EXPECT_GT(swings, made.clip.keys / 2) << leg_m << ": a foot is in the air most of the time";
  }
}

TEST(Retarget, WhoSwingsLegsOfOneBoneWideMakesNobodyDoTheSplits) {
  Avatar toy = MadeToy(0.16f, 0.12f, 0.1f);
  Clip wide{"walk", 0.7f, 21, {}};
  for (int k = 0; k < 21; ++k) {
    for (size_t j = 0; j < toy.joints.size(); ++j) {
      Transform t = toy.joints[j].rest;
      const float swing = 1.05f * std::sin(2 * kPi * static_cast<float>(k) / 20);
      if (j == 10 || j == 14) t.rotation = Product(TurnAbout({1, 0, 0}, j == 10 ? swing : -swing), t.rotation);
      if (j == 0) t.translation.y += 0.05f * std::abs(swing);  // and hops
      wide.transforms.push_back(t);
    }
  }
  const Rig from = RigOf(toy), to = RigOf(MadeHuman({}));
  const Clip made = Retarget(from, wide, to, {.walks = true}).clip;
  float farthest = 0;
  for (int k = 0; k < made.keys; ++k) {
    const Pose pose = PoseAt(to, made, k);
    farthest =
        std::max(farthest, std::abs(PlaceOf(to.legs[kLeft].ankle, pose).z - PlaceOf(to.legs[kRight].ankle, pose).z));
  }
  EXPECT_GT(farthest, 0.4f * to.leg_m);
  EXPECT_LT(farthest, 1.0f * to.leg_m);
}

TEST(Retarget, FeetAreSetFartherApartWhereLegsWouldMeet) {
  Avatar target = MadeHuman({});
  for (const uint16_t shin : {uint16_t{11}, uint16_t{15}}) {
    const float x = shin == 11 ? 0.09f : -0.09f;
    for (float y = 0.15f; y < 0.4f; y += 0.04f) AddBox({x, y, 0}, {x, y, 0}, 0.06f, shin, &target.meshes[0]);
  }
  Avatar source = MadeHuman({});
  const Rig from = RigOf(source), to = RigOf(target);
  Clip narrow = MadeWalk(source);
  for (size_t i = 0; i < narrow.transforms.size(); ++i) {
    if (i % 18 == 10 || i % 18 == 14)
      narrow.transforms[i].rotation =
          Product(TurnAbout({0, 0, 1}, i % 18 == 10 ? -0.05f : 0.05f), narrow.transforms[i].rotation);
  }
  const float before = LegDepth(target, to, Retarget(from, narrow, to, {.walks = true}).clip, 12);
  ASSERT_GT(before, 0.02f);
  EXPECT_LT(LegDepth(target, to, ClearLegs(target, from, narrow, to).clip, 12), 0.5f * before);
}

TEST(Steps, AToeThatDipsIntoTheGroundLiftsNobodyOffIt) {
  const std::vector<float> dips = {0.05f, 0.05f, 0.0f, 0.02f, 0.05f, 0.05f, 0.06f, 0.05f, 0.05f, 0.05f};
  EXPECT_NEAR(GroundUnder(dips, 0.8f, true), 0.05f, 1e-6f);
  EXPECT_NEAR(GroundUnder(dips, 0.8f, false), 0, 1e-6f) << "who runs is in the air";
}

TEST(Steps, ABootsCapClearsTheGroundInTheSwing) {
  FootTrack track;
  for (size_t k = 0; k < 20; ++k) {
    const bool stands = k < 10;
    track.stands.push_back(stands);
    track.wanted.push_back({0, 0.1f, 0.02f * static_cast<float>(stands ? 10 - k : k - 10)});
    track.sole.push_back({{0, -0.1f, 0.1f}});
    track.lowest.push_back(stands ? -0.1f : -0.25f);  // as the foot points down, its cap is lower than its sole
  }
  const std::vector<Vec3> ankles = RollFoot(track, 0.02f, 0.8f, true);
  for (size_t k = 0; k < 20; ++k) {
    const float low = ankles[k].y + track.lowest[k];
    EXPECT_GT(low, track.stands[k] ? -1e-5f : 0.01f) << k;
    EXPECT_LT(low, track.stands[k] ? 1e-5f : 0.1f) << k;
  }
}

TEST(Steps, ALegWithoutAFootStandsNowhere) {
  const Soles none(6), some(6, {{0, 0, 0}});
  EXPECT_EQ(FindStance(none, 0, 0.1f, 0.8f, true), std::vector<bool>(6, false));
  std::vector<bool> left(6), right(6);
  StandSomewhere(none, some, 0.8f, true, &left, &right);
  EXPECT_EQ(left, std::vector<bool>(6, false));
}

TEST(Steps, WhoWalksStandsUntilTheOtherFootDoes) {
  const Soles low(6, {Vec3{}}), high(6, {Vec3{0, 1, 0}});
  std::vector<bool> left = {true, true, false, false, false, false}, right = {false, false, false, false, true, true};
  StandSomewhere(low, high, 0.8f, true, &left, &right);
  for (size_t k = 0; k < 6; ++k) {
    const size_t next = (k + 1) % 6;
    EXPECT_TRUE((left[k] && left[next]) || (right[k] && right[next])) << k;
  }
}

// In the order of HumanShape's.
TEST(Humanoid, IsFoundByTheNamesOfManyRigs) {
  const std::vector<std::vector<std::string>> rigs = {
      {"Root_M", "Spine1_M", "Neck_M", "Head_M", "Shoulder_L", "Elbow_L", "Wrist_L", "Shoulder_R", "Elbow_R", "Wrist_R",
       "Hip_L", "Knee_L", "Ankle_L", "Toes_L", "Hip_R", "Knee_R", "Ankle_R", "Toes_R"},
      {"m_avg_Pelvis", "m_avg_Spine1", "m_avg_Neck", "m_avg_Head", "m_avg_L_Shoulder", "m_avg_L_Elbow", "m_avg_L_Wrist",
       "m_avg_R_Shoulder", "m_avg_R_Elbow", "m_avg_R_Wrist", "m_avg_L_Hip", "m_avg_L_Knee", "m_avg_L_Ankle",
       "m_avg_L_Foot", "m_avg_R_Hip", "m_avg_R_Knee", "m_avg_R_Ankle", "m_avg_R_Foot"},
      {"root.x", "spine_01.x", "neck.x", "head.x", "arm_stretch.l", "forearm_stretch.l", "hand.l", "arm_stretch.r",
       "forearm_stretch.r", "hand.r", "thigh_stretch.l", "leg_stretch.l", "foot.l", "toes_01.l", "thigh_stretch.r",
       "leg_stretch.r", "foot.r", "toes_01.r"},
      {"NPC Pelvis [Pelv]", "NPC Spine [Spn0]", "NPC Neck [Neck]", "NPC Head [Head]", "NPC L UpperArm [LUar]",
       "NPC L Forearm [LLar]", "NPC L Hand [LHnd]", "NPC R UpperArm [RUar]", "NPC R Forearm [RLar]",
       "NPC R Hand [RHnd]", "NPC L Thigh [LThg]", "NPC L Calf [LClf]", "NPC L Foot [Lft ]", "NPC L Toe0 [LToe]",
       "NPC R Thigh [RThg]", "NPC R Calf [RClf]", "NPC R Foot [Rft ]", "NPC R Toe0 [RToe]"},
      {"CATRigPelvis", "CATRigSpine1", "CATRigNeck", "CATRigHead", "CATRigLArm1", "CATRigLArm2", "CATRigLArmPalm",
       "CATRigRArm1", "CATRigRArm2", "CATRigRArmPalm", "CATRigLLeg1", "CATRigLLeg2", "CATRigLLegAnkle", "CATRigLLegToe",
       "CATRigRLeg1", "CATRigRLeg2", "CATRigRLegAnkle", "CATRigRLegToe"},
      {"Becken", "Wirbel", "Hals", "Kopf", "Oberarm_L", "Unterarm_L", "Hand_L", "Oberarm_R", "Unterarm_R", "Hand_R",
       "Oberschenkel_L", "Unterschenkel_L", "Fuss_L", "Zehen_L", "Oberschenkel_R", "Unterschenkel_R", "Fuss_R",
       "Zehen_R"},
      {"Bassin", "Colonne", "Cou", "Tete", "Bras_G", "AvantBras_G", "Main_G", "Bras_D", "AvantBras_D", "Main_D",
       "Cuisse_G", "Mollet_G", "Pied_G", "Orteils_G", "Cuisse_D", "Mollet_D", "Pied_D", "Orteils_D"},
      {"Hip", "Torso", "Neck", "Head", "Bob_L_Bicep", "Bob_L_Forearm", "Bob_L_Palm", "Bob_R_Bicep", "Bob_R_Forearm",
       "Bob_R_Palm", "Bob_L_Thigh", "Bob_L_Shank", "Bob_L_Foot", "Bob_L_Toe", "Bob_R_Thigh", "Bob_R_Shank",
       "Bob_R_Foot", "Bob_R_Toe"},
  };
  for (const std::vector<std::string>& names : rigs) {
    const Avatar person = MadeHuman({.names = names});
    Humanoid h;
    std::string why;
    ASSERT_TRUE(FindHumanoid(person.joints, BindPose(person.joints).positions, {}, &h, &why)) << why;
    EXPECT_FALSE(h.by_shape) << names[10];
    EXPECT_EQ(h.head, 3) << names[3];
    for (const size_t side : {kLeft, kRight}) {
      const int leg = side == kLeft ? 10 : 14, arm = side == kLeft ? 4 : 7;
      EXPECT_EQ(h.legs[side].upper, leg) << names[10];
      EXPECT_EQ(h.legs[side].lower, leg + 1) << names[10];
      EXPECT_EQ(h.legs[side].foot, leg + 2) << names[10];
      EXPECT_EQ(h.legs[side].toes, leg + 3) << names[10];
      EXPECT_EQ(h.arms[side].upper, arm) << names[10];
      EXPECT_EQ(h.arms[side].lower, arm + 1) << names[10];
      EXPECT_EQ(h.arms[side].hand, arm + 2) << names[10];
    }
  }
}

TEST(Humanoid, IsFoundByShapeWhereNamesSayNothing) {
  HumanShape shape;
  for (size_t j = 0; j < shape.names.size(); ++j) shape.names[j] = "node " + std::to_string(j);
  const Rig rig = RigOf(MadeHuman(shape));
  EXPECT_TRUE(rig.humanoid.by_shape);
  EXPECT_EQ(rig.humanoid.legs[kLeft].upper, 10);
  EXPECT_EQ(rig.humanoid.legs[kRight].foot, 16);
  EXPECT_EQ(rig.humanoid.arms[kLeft].upper, 4);
  EXPECT_EQ(rig.humanoid.hips, 0);
  EXPECT_EQ(rig.humanoid.head, 3);
}

TEST(Humanoid, OfAMirroredFigureLeftIsWhereItsToesSaySo) {
  const Avatar human = MadeHuman({});
  std::vector<Vec3> positions = BindPose(human.joints).positions;
  for (Vec3& p : positions) p.x = -p.x;
  Humanoid humanoid;
  std::string why;
  ASSERT_TRUE(FindHumanoid(human.joints, positions, {}, &humanoid, &why)) << why;
  EXPECT_EQ(humanoid.legs[kLeft].upper, 14) << "that is called the right one";
  EXPECT_EQ(humanoid.arms[kLeft].upper, 7);
  Vec3 up, forward;
  ASSERT_TRUE(FindStance(humanoid, positions, &up, &forward));
  EXPECT_GT(forward.z, 0.9f);
}

TEST(Humanoid, WhoseTrunkHangsOnItsMiddleGoesOnFourLegs) {
  std::vector<Joint> joints(16);
  std::vector<Vec3> places(16);
  const auto put = [&](int j, int parent, Vec3 place) {
    joints[static_cast<size_t>(j)].name = "bone " + std::to_string(j);
    joints[static_cast<size_t>(j)].parent = parent;
    places[static_cast<size_t>(j)] = place;
  };
  put(0, -1, {0, 0.6f, 0});
  put(1, 0, {0, 0.6f, -0.3f});
  put(2, 0, {0, 0.6f, 0.3f});
  put(3, 2, {0, 0.8f, 0.5f});
  for (int leg = 0; leg < 4; ++leg) {
    const float x = leg % 2 == 0 ? 0.1f : -0.1f, z = leg < 2 ? -0.3f : 0.3f;
    for (int k = 0; k < 3; ++k)
      put(4 + 3 * leg + k, k > 0 ? 3 + 3 * leg + k : (leg < 2 ? 1 : 2), {x, 0.55f - 0.25f * static_cast<float>(k), z});
  }
  Humanoid humanoid;
  std::string why;
  ASSERT_TRUE(FindHumanoid(joints, places, {}, &humanoid, &why)) << why;
  EXPECT_TRUE(humanoid.quadruped);
}

// A pirate with one arm, a statue without hands: of one side alone there may be bones.
TEST(Humanoid, MayLackAnyOneBoneAndWalks) {
  const Avatar whole = MadeHuman({});
  const Clip walk = MadeWalk(whole);
  for (size_t lacks = 1; lacks < whole.joints.size(); ++lacks) {
    HumanShape shape;
    shape.names[lacks] = "ornament";
    const Avatar person = MadeHuman(shape);
    Humanoid humanoid;
    std::string why;
    if (!FindHumanoid(person.joints, BindPose(person.joints).positions, {}, &humanoid, &why)) continue;
    EXPECT_FALSE(humanoid.quadruped) << lacks;
    for (const auto& [from, to] : {std::pair{&whole, &person}, {&person, &whole}}) {
      const Retargeted made = Retarget(RigOf(*from), walk, RigOf(*to));
      for (const Transform& t : made.clip.transforms)
        ASSERT_TRUE(std::isfinite(Length(t.translation)) && std::isfinite(t.rotation.w)) << lacks;
    }
  }
}

TEST(Humanoid, WhatHasNoLegsIsNone) {
  Avatar human = MadeHuman({});
  for (size_t j = 10; j < human.joints.size(); ++j) human.joints[j].name = "cloth";
  human.joints.resize(10);
  Humanoid humanoid;
  std::string why;
  EXPECT_FALSE(FindHumanoid(human.joints, BindPose(human.joints).positions, {}, &humanoid, &why));
  EXPECT_EQ(why, "no two legs are found");
}

}  // namespace
}  // namespace flaneur
