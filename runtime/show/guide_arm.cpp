#include "runtime/show/guide_arm.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <string_view>

namespace flaneur {
namespace {

// Shares of the person's height.
constexpr float kTrunk = 0.045f;                     // joints nearer to the middle belong to the trunk
constexpr float kFinger = 0.055f;                    // bones shorter than that are a hand's
constexpr float kHandLow = 0.3f, kHandHigh = 0.9f;   // of the rest pose, arms down or stretched out
constexpr float kShortest = 0.1f, kLongest = 0.55f;  // arm; short under tall hats
constexpr float kGrip = 0.045f;                      // from the wrist on
// Shares of the arm's length, from the shoulder: where the hand is, and to where the elbow points.
constexpr float kOnPalm = 0.016f;       // of the height: from the wrist's bones to what lies on the palm
constexpr float kMostTwist_rad = 1.7f;  // of the hand, half of it the forearm's
// A closed hand's joints, from the knuckles on; degrees, as a hand round a stick of 3 cm has them.
constexpr float kFingers_deg[] = {72, 88, 40}, kThumb_deg[] = {40, 20, 10};
constexpr Vec3 kHand{-0.16f, -0.60f, 0.55f}, kElbow{-0.35f, -0.6f, -0.7f};

size_t I(int joint) { return static_cast<size_t>(joint); }

bool Has(const std::string& name, std::string_view word) {
  const auto alike = [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; };
  return std::search(name.begin(), name.end(), word.begin(), word.end(), alike) != name.end();
}

bool IsCalledHand(const std::string& n) {
  return (Has(n, "hand") || Has(n, "wrist")) && !Has(n, "ik") && !Has(n, "finger") && !Has(n, "thumb");
}

// Where tools and weapons are hung into a hand.
bool IsForThings(const std::string& n) { return Has(n, "slot") || Has(n, "weapon") || Has(n, "prop") || Has(n, "ik"); }

// "finger1" as MakeHuman counts them.
bool IsCalledThumb(const std::string& name) { return Has(name, "thumb") || Has(name, "finger1"); }

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

// Whether `above` is the joint or one above it.
bool HangsOn(const std::vector<PackJoint>& s, int joint, int above) {
  while (joint >= 0 && joint != above) joint = s[I(joint)].parent;
  return joint == above;
}

struct Bent {
  Mat4 upper, fore;
  Vec3 elbow, hand;
};

// Two bones reach for the hand's place; the elbow bends towards kElbow.
std::optional<Bent> Bend(const std::vector<PackJoint>& s, float height_m, const CarryingArm& arm) {
  const Vec3 shoulder = s[I(arm.shoulder)].rest_m, elbow = s[I(arm.elbow)].rest_m, hand = s[I(arm.hand)].rest_m;
  const float upper_m = Length(elbow - shoulder), fore_m = Length(hand - elbow), whole_m = upper_m + fore_m;
  if (whole_m < kShortest * height_m || whole_m > kLongest * height_m) return std::nullopt;
  const Vec3 reach = kHand * whole_m, way = Normalized(reach);
  const float reach_m = Length(reach);
  const float along_m = (upper_m * upper_m - fore_m * fore_m + reach_m * reach_m) / (2 * reach_m);
  const float out2 = upper_m * upper_m - along_m * along_m;
  if (!(out2 > 0)) return std::nullopt;  // one bone is far longer than the other
  const Vec3 out = Normalized(kElbow - way * Dot(kElbow, way));
  const Vec3 bent = shoulder + way * along_m + out * std::sqrt(out2);
  return Bent{Carried(shoulder, shoulder, Turning(elbow - shoulder, bent - shoulder)),
              Carried(elbow, bent, Turning(hand - elbow, shoulder + reach - bent)), bent, shoulder + reach};
}

// Ways in the rest pose: along the fingers, to where the thumb is, and off the palm.
struct HandAxes {
  Vec3 fingers, thumb, palm;
};

// Thumbs point ahead in all rest poses, arms down or stretched out; few skeletons have a joint there. None where the
// fingers point ahead themselves.
std::optional<HandAxes> AxesOf(const std::vector<PackJoint>& s, const CarryingArm& arm) {
  const Vec3 at = s[I(arm.hand)].rest_m;
  Vec3 fingers = (at - s[I(arm.elbow)].rest_m) * 0.01f;  // where there are no fingers
  for (size_t j = 0; j < s.size(); ++j) {
    const bool finger = !IsCalledThumb(s[j].name) && !IsForThings(s[j].name);
    if (finger && HangsOn(s, static_cast<int>(j), arm.hand)) fingers = fingers + (s[j].rest_m - at);
  }
  const Vec3 way = Normalized(fingers), beside = Vec3{0, 0, 1} - way * way.z;
  if (Length(beside) < 0.3f) return std::nullopt;
  return HandAxes{way, Normalized(beside), Normalized(Cross(beside, way))};
}

// From the rest pose to a closed hand, of one of its joints: what those between it and the hand turn by, one after the
// other. `finger`: how many of them do.
Mat4 Closed(const std::vector<PackJoint>& s, const CarryingArm& arm, const HandAxes& axes, int joint, size_t* finger) {
  if (joint == arm.hand) {
    *finger = 0;
    return Mat4{};
  }
  const Mat4 above = Closed(s, arm, axes, s[I(joint)].parent, finger);
  const PackJoint& j = s[I(joint)];
  if (Has(j.name, "metacarpal") || IsForThings(j.name) || *finger >= std::size(kFingers_deg)) return above;
  const bool thumb = IsCalledThumb(j.name);
  const float turn_rad = kPi / 180 * (thumb ? kThumb_deg : kFingers_deg)[(*finger)++];
  const Vec3 axis = Cross(thumb ? axes.thumb : axes.fingers, axes.palm);
  return above * Carried(j.rest_m, j.rest_m, About(axis, turn_rad));
}

// How far the hand is turned about the forearm for the thumb to be up.
float Twist_rad(const Bent& bent, const HandAxes& axes) {
  const Vec3 way = Normalized(bent.hand - bent.elbow), up = Vec3{0, 1, 0} - way * way.y;
  const Vec3 thumb = TransformDirection(bent.fore, axes.thumb), side = thumb - way * Dot(thumb, way);
  const float angle = std::atan2(Dot(Cross(side, up), way), Dot(side, up));
  return std::clamp(angle, -kMostTwist_rad, kMostTwist_rad);
}

void PlaceJoints(const std::vector<PackJoint>& s, float height_m, const Bent& bent, CarryingArm* arm) {
  const std::optional<HandAxes> axes = AxesOf(s, *arm);
  const Vec3 way = Normalized(bent.hand - bent.elbow);
  const float twist_rad = axes ? Twist_rad(bent, *axes) : 0;
  const auto twisted = [&](float share) {
    return Carried(bent.hand, bent.hand, About(way, share * twist_rad)) * bent.fore;
  };
  arm->hand_bent = twisted(1);
  arm->grip_m = bent.hand + way * (kGrip * height_m);
  if (axes) arm->grip_m = arm->grip_m + TransformDirection(arm->hand_bent, axes->palm) * (kOnPalm * height_m);
  for (size_t j = 0; j < s.size(); ++j) {
    const int joint = static_cast<int>(j);
    size_t finger = 0;
    if (HangsOn(s, joint, arm->hand))
      arm->bent.push_back({joint, axes ? arm->hand_bent * Closed(s, *arm, *axes, joint, &finger) : arm->hand_bent});
    else if (HangsOn(s, joint, arm->elbow)) arm->bent.push_back({joint, twisted(0.5f)});
    else if (HangsOn(s, joint, arm->shoulder)) arm->bent.push_back({joint, bent.upper});
  }
}

}  // namespace

Quat About(Vec3 axis, float angle_rad) {
  const Vec3 v = Normalized(axis) * std::sin(angle_rad / 2);
  return {v.x, v.y, v.z, std::cos(angle_rad / 2)};
}

Mat4 Carried(Vec3 from, Vec3 to, Quat turn) {
  const Mat4 rotation = FromTranslationRotationScale(to, turn, {1, 1, 1});
  return rotation * FromTranslationRotationScale(from * -1, {}, {1, 1, 1});
}

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
  const std::optional<Bent> bent = Bend(s, height_m, arm);
  if (!bent) return std::nullopt;
  PlaceJoints(s, height_m, *bent, &arm);
  return arm;
}

void CarryInClips(const CarryingArm& arm, PackAvatar* figure) {
  const std::vector<PackJoint>& s = figure->skeleton;
  for (PackClip* clip : {&figure->walk, &figure->idle, &figure->talk}) {
    for (size_t first = 0; first + s.size() <= clip->matrices.size(); first += s.size()) {
      const Mat4 trunk = clip->matrices[first + I(arm.trunk)];
      for (const auto& [joint, bent] : arm.bent) clip->matrices[first + I(joint)] = trunk * bent;
    }
  }
}

}  // namespace flaneur
