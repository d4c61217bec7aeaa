#include "runtime/show/guide_arm.h"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace flaneur {
namespace {

// Shares of the person's height.
constexpr float kTrunk = 0.045f;                     // joints nearer to the middle belong to the trunk
constexpr float kFinger = 0.055f;                    // bones shorter than that are a hand's
constexpr float kHandLow = 0.3f, kHandHigh = 0.9f;   // of the rest pose, arms down or stretched out
constexpr float kShortest = 0.2f, kLongest = 0.55f;  // arm
constexpr float kGrip = 0.045f;                      // from the wrist on
// Shares of the arm's length, from the shoulder: where the hand is, and to where the elbow points.
constexpr Vec3 kHand{-0.16f, -0.60f, 0.55f}, kElbow{-0.35f, -0.6f, -0.7f};

size_t I(int joint) { return static_cast<size_t>(joint); }

bool IsCalledHand(const std::string& name) {
  std::string low;
  for (const char c : name) low += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const auto has = [&](const char* word) { return low.find(word) != std::string::npos; };
  return (has("hand") || has("wrist")) && !has("ik") && !has("finger") && !has("thumb");
}

bool IsRightOfTrunk(const PackJoint& joint, float height_m) { return joint.rest_m.x < -kTrunk * height_m; }

float Bone_m(const std::vector<PackJoint>& s, int joint) {
  const int parent = s[I(joint)].parent;
  return parent < 0 ? 0 : Length(s[I(joint)].rest_m - s[I(parent)].rest_m);
}

bool IsHandHigh(const PackJoint& joint, float height_m) {
  return joint.rest_m.y > kHandLow * height_m && joint.rest_m.y < kHandHigh * height_m;
}

int HandByName(const std::vector<PackJoint>& s, float height_m) {
  for (size_t j = 0; j < s.size(); ++j) {
    const bool is_first = s[j].parent < 0 || !IsCalledHand(s[I(s[j].parent)].name);
    if (IsCalledHand(s[j].name) && is_first && IsRightOfTrunk(s[j], height_m) && IsHandHigh(s[j], height_m))
      return static_cast<int>(j);
  }
  return -1;
}

// The joint farthest to the right, or that its short bones hang on.
int HandByShape(const std::vector<PackJoint>& s, float height_m) {
  int hand = -1;
  for (size_t j = 0; j < s.size(); ++j) {
    if (!IsRightOfTrunk(s[j], height_m) || !IsHandHigh(s[j], height_m)) continue;
    if (hand < 0 || s[j].rest_m.x < s[I(hand)].rest_m.x) hand = static_cast<int>(j);
  }
  while (hand >= 0 && s[I(hand)].parent >= 0 && Bone_m(s, hand) < kFinger * height_m) hand = s[I(hand)].parent;
  return hand;
}

Quat Turning(Vec3 from, Vec3 to) {
  const Vec3 a = Normalized(from), b = Normalized(to), axis = Cross(a, b);
  return Normalized(Quat{axis.x, axis.y, axis.z, 1 + Dot(a, b)});
}

// What is at `from` comes to `to`, turned about there.
Mat4 Carried(Vec3 from, Vec3 to, Quat turn) {
  const Mat4 rotation = FromTranslationRotationScale(to, turn, {1, 1, 1});
  return rotation * FromTranslationRotationScale(from * -1, {}, {1, 1, 1});
}

// Two bones reach for the hand's place; the elbow bends towards kElbow.
bool Bend(const std::vector<PackJoint>& s, float height_m, CarryingArm* arm) {
  const Vec3 shoulder = s[I(arm->shoulder)].rest_m, elbow = s[I(arm->elbow)].rest_m, hand = s[I(arm->hand)].rest_m;
  const float upper_m = Length(elbow - shoulder), fore_m = Length(hand - elbow), whole_m = upper_m + fore_m;
  if (whole_m < kShortest * height_m || whole_m > kLongest * height_m) return false;
  const Vec3 reach = kHand * whole_m, way = Normalized(reach);
  const float reach_m = Length(reach);
  const float along_m = (upper_m * upper_m - fore_m * fore_m + reach_m * reach_m) / (2 * reach_m);
  const float out2 = upper_m * upper_m - along_m * along_m;
  if (!(out2 > 0)) return false;  // one bone is far longer than the other
  const Vec3 out = Normalized(kElbow - way * Dot(kElbow, way));
  const Vec3 bent = shoulder + way * along_m + out * std::sqrt(out2);
  arm->upper = Carried(shoulder, shoulder, Turning(elbow - shoulder, bent - shoulder));
  arm->fore = Carried(elbow, bent, Turning(hand - elbow, shoulder + reach - bent));
  arm->grip_m = shoulder + reach + Normalized(shoulder + reach - bent) * (kGrip * height_m);
  return true;
}

// Whether `above` is the joint or one above it.
bool HangsOn(const std::vector<PackJoint>& s, int joint, int above) {
  while (joint >= 0 && joint != above) joint = s[I(joint)].parent;
  return joint == above;
}

}  // namespace

std::optional<CarryingArm> FindCarryingArm(const std::vector<PackJoint>& s, float height_m) {
  CarryingArm arm;
  arm.hand = HandByName(s, height_m);
  if (arm.hand < 0) arm.hand = HandByShape(s, height_m);
  if (arm.hand < 0) return std::nullopt;
  std::vector<int> chain;  // from the hand to the shoulder
  int j = arm.hand;
  for (; j >= 0 && IsRightOfTrunk(s[I(j)], height_m); j = s[I(j)].parent) chain.push_back(j);
  if (j < 0 || chain.size() < 3) return std::nullopt;
  arm.trunk = j;
  arm.shoulder = chain.back();
  const auto unlike_m = [&](int elbow) {
    const Vec3 at = s[I(elbow)].rest_m;
    return std::abs(Length(at - s[I(arm.shoulder)].rest_m) - Length(at - s[I(arm.hand)].rest_m));
  };
  arm.elbow =
      *std::min_element(chain.begin() + 1, chain.end() - 1, [&](int a, int b) { return unlike_m(a) < unlike_m(b); });
  if (!Bend(s, height_m, &arm)) return std::nullopt;
  return arm;
}

void CarryInClips(const CarryingArm& arm, PackAvatar* figure) {
  const std::vector<PackJoint>& s = figure->skeleton;
  for (PackClip* clip : {&figure->walk, &figure->idle, &figure->talk}) {
    for (size_t first = 0; first + s.size() <= clip->matrices.size(); first += s.size()) {
      const Mat4 trunk = clip->matrices[first + I(arm.trunk)];
      for (size_t j = 0; j < s.size(); ++j) {
        const int joint = static_cast<int>(j);
        if (HangsOn(s, joint, arm.elbow)) clip->matrices[first + j] = trunk * arm.fore;
        else if (HangsOn(s, joint, arm.shoulder)) clip->matrices[first + j] = trunk * arm.upper;
      }
    }
  }
}

}  // namespace flaneur
