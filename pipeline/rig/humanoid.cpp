#include "pipeline/rig/humanoid.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/core/rotation.h"
#include "pipeline/rig/humanoid_shape.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

constexpr float kStraight_rad = 0.6f;  // between two bones that are one limb's upper part
constexpr int kFingers = 5;
constexpr float kLeastFoot = 0.1f;  // of the shin, from ankle to toes: nearer ones split the ankle's twist

using Joints = std::vector<Joint>;

int DepthOf(const Joints& joints, int joint) {
  int depth = 0;
  for (int a = joint; a >= 0; a = At(joints, a).parent) ++depth;
  return depth;
}

int CommonAncestor(const Joints& joints, int a, int b) {
  for (int up = a; up >= 0; up = At(joints, up).parent) {
    if (IsBelow(joints, b, up)) return up;
  }
  return -1;
}

// From below `above` down to `joint`, both left out.
std::vector<int> PathBetween(const Joints& joints, int above, int joint) {
  std::vector<int> path;
  for (int a = At(joints, joint).parent; a >= 0 && a != above; a = At(joints, a).parent) path.push_back(a);
  std::reverse(path.begin(), path.end());
  return path;
}

class NameReader {
 public:
  NameReader(const Joints& joints, const std::vector<Vec3>& positions, std::vector<BoneName> names,
             const std::vector<NamedBone>& told)
      : joints_(joints), positions_(positions), names_(std::move(names)) {
    told_ = !told.empty();
    if (told_) {
      for (BoneName& name : names_) name = {};
    }
    for (const NamedBone& bone : told) {
      if (InRange(names_, bone.joint)) At(names_, bone.joint) = {bone.part, bone.side, -1};
    }
  }

  void Read(Humanoid* h) const {
    h->head = Find(BodyPart::kHead, BodySide::kNone);
    for (const size_t side : {kLeft, kRight}) {
      h->legs[side] = Leg(side == kLeft ? BodySide::kLeft : BodySide::kRight);
      h->arms[side] = Arm(side == kLeft ? BodySide::kLeft : BodySide::kRight);
    }
  }

 private:
  // The one nearest to the root; those that a rig is steered by stand before or beside those that move the skin, whose
  // names then begin with DEF.
  int Find(BodyPart part, BodySide side, int below = -1) const {
    int best = -1;
    int best_rank = 0;
    for (int j = 0; j < Count(joints_); ++j) {
      const BoneName& name = At(names_, j);
      if (name.part != part || name.side != side || (below >= 0 && (j == below || !IsBelow(joints_, j, below))))
        continue;
      const bool deforms = At(joints_, j).name.starts_with("DEF");
      const bool steers = At(joints_, j).name.starts_with("ORG") || At(joints_, j).name.starts_with("MCH");
      const int rank = (deforms ? 0 : steers ? 2000 : 1000) + DepthOf(joints_, j);
      if (best < 0 || rank < best_rank) best = j, best_rank = rank;
    }
    return best;
  }

  // Below the joint above it where the rig has it so, else anywhere: feet may hang on the root.
  int FindBelow(BodyPart part, BodySide side, int above) const {
    const int below = above >= 0 ? Find(part, side, above) : -1;
    return below >= 0 ? below : Find(part, side);
  }

  // The one joint on it that others hang on. -1: none, or several.
  int OnlyBoneOn(int joint) const {
    int only = -1;
    for (const Joint& end : joints_) {
      const int bone = end.parent;
      if (bone < 0 || At(joints_, bone).parent != joint || bone == only) continue;
      if (only >= 0) return -1;
      only = bone;
    }
    return only;
  }

  // A foot below an ankle, or what else bends the foot before its tip.
  int UnnamedToes(BodySide side, const HumanoidLeg& leg) const {
    int toes = Find(BodyPart::kFoot, side, leg.foot);
    if (toes < 0) toes = OnlyBoneOn(leg.foot);
    if (toes < 0) return -1;
    const Vec3 ankle = At(positions_, leg.foot);
    const float shin_m = Length(ankle - At(positions_, leg.lower));
    return Length(At(positions_, toes) - ankle) > kLeastFoot * shin_m ? toes : -1;
  }

  HumanoidLeg Leg(BodySide side) const {
    HumanoidLeg leg;
    leg.upper = Find(BodyPart::kUpperLeg, side);
    const bool named = leg.upper >= 0;
    if (!named) leg.upper = Find(BodyPart::kLeg, side);
    const int lower = Find(BodyPart::kLowerLeg, side);
    if (leg.upper < 0 && lower >= 0) leg.upper = Find(BodyPart::kHips, side);
    if (leg.upper < 0) return leg;
    leg.lower = FindBelow(BodyPart::kLowerLeg, side, leg.upper);
    if (leg.lower < 0) leg.lower = Find(BodyPart::kLeg, side, leg.upper);  // "Leg1" and "Leg2" too
    if (leg.lower >= 0 && !IsBelow(joints_, leg.lower, leg.upper)) leg.lower = -1;
    leg.foot = FindBelow(BodyPart::kFoot, side, leg.lower);
    leg.toes = FindBelow(BodyPart::kToes, side, leg.foot);
    if (leg.lower >= 0 && leg.foot >= 0 && leg.toes < 0) leg.toes = UnnamedToes(side, leg);
    if (leg.foot >= 0 && leg.toes >= 0 && !IsBelow(joints_, leg.toes, leg.foot)) leg.toes = -1;
    if (leg.lower < 0) leg.toes = leg.foot = -1;
    return leg;
  }

  HumanoidArm Arm(BodySide side) const {
    HumanoidArm arm;
    arm.upper = Find(BodyPart::kUpperArm, side);
    if (arm.upper < 0) arm.upper = Find(BodyPart::kArm, side);
    const int shoulder = Find(BodyPart::kShoulder, side), clavicle = Find(BodyPart::kClavicle, side);
    if (arm.upper < 0) arm.upper = shoulder;
    if (arm.upper < 0) return arm;
    arm.lower = FindBelow(BodyPart::kLowerArm, side, arm.upper);
    if (arm.lower < 0) arm.lower = Find(BodyPart::kArm, side, arm.upper);
    if (arm.lower >= 0 && !IsBelow(joints_, arm.lower, arm.upper)) arm.lower = -1;
    arm.hand = FindBelow(BodyPart::kHand, side, arm.lower);
    if (arm.lower >= 0 && clavicle >= 0 && shoulder >= 0 && arm.upper != shoulder &&
        IsBelow(joints_, arm.upper, shoulder) && IsStraight(shoulder, arm.upper, arm.lower))
      arm.upper = shoulder;  // a bone that splits the upper arm's twist
    arm.clavicle = clavicle >= 0 ? clavicle : shoulder != arm.upper ? shoulder : -1;
    if (arm.clavicle >= 0 && !IsBelow(joints_, arm.upper, arm.clavicle)) arm.clavicle = -1;
    if (arm.hand >= 0) Fingers(side, &arm);
    return arm;
  }

  bool IsStraight(int a, int b, int c) const {
    return AngleBetween(At(positions_, b) - At(positions_, a), At(positions_, c) - At(positions_, b)) < kStraight_rad;
  }

  void Fingers(BodySide side, HumanoidArm* arm) const {
    int first = 1;  // number of the thumb where fingers have numbers
    for (size_t j = 0; j < joints_.size(); ++j) {
      if (names_[j].part == BodyPart::kFinger && names_[j].number == 0) first = 0;
    }
    for (int j = 0; j < Count(joints_); ++j) {
      const BoneName& name = At(names_, j);
      if (name.side != side || j == arm->hand || !IsBelow(joints_, j, arm->hand)) continue;
      int finger = static_cast<int>(name.part) - static_cast<int>(BodyPart::kThumb);
      if (name.part == BodyPart::kFinger) {
        int number = name.number;
        while (number > 9) number /= 10;  // Finger21 is the second finger's second bone
        finger = number < 0 ? 2 : number - first;
      }
      if (finger < 0 || finger >= kFingers) continue;
      arm->fingers[static_cast<size_t>(finger)].push_back(j);
    }
  }

  const Joints& joints_;
  const std::vector<Vec3>& positions_;
  std::vector<BoneName> names_;
  bool told_ = false;
};

// Hips, spine and neck are what lies between the limbs, whatever they are called.
bool FindTrunk(const Joints& joints, Humanoid* h) {
  const int legs = CommonAncestor(joints, h->legs[kLeft].upper, h->legs[kRight].upper);
  const int arms = h->has_arms() ? CommonAncestor(joints, h->arms[kLeft].upper, h->arms[kRight].upper) : -1;
  const int above = arms >= 0 ? arms : h->head;
  if (legs < 0 || above < 0) return false;
  h->hips = CommonAncestor(joints, legs, above);
  if (h->hips < 0) return false;
  const int chest = arms >= 0 ? arms : At(joints, h->head).parent;
  h->spine = chest >= 0 && chest != h->hips ? PathBetween(joints, h->hips, chest) : std::vector<int>{};
  if (chest >= 0 && chest != h->hips) h->spine.push_back(chest);
  if (h->head >= 0 && chest >= 0 && IsBelow(joints, h->head, chest)) h->neck = PathBetween(joints, chest, h->head);
  return true;
}

bool IsComplete(const Joints& joints, Humanoid* h, std::string* why) {
  if (!h->has_legs()) {
    *why = "no two legs are found";
    return false;
  }
  if (!FindTrunk(joints, h)) {
    *why = "no head and no arms are found above the legs";
    return false;
  }
  return true;
}

Vec3 Between(const std::vector<Vec3>& positions, int a, int b) { return (At(positions, a) + At(positions, b)) * 0.5f; }

// Arms that reach as far down as the legs do and a trunk that lies: four legs.
bool IsQuadruped(const Humanoid& h, const std::vector<Vec3>& positions) {
  if (!h.has_arms()) return false;
  for (const size_t side : {kLeft, kRight})
    if (h.legs[side].lower < 0 || h.arms[side].lower < 0) return false;
  const Vec3 hips = Between(positions, h.legs[kLeft].upper, h.legs[kRight].upper);
  const Vec3 shoulders = Between(positions, h.arms[kLeft].upper, h.arms[kRight].upper);
  const Vec3 knees = Between(positions, h.legs[kLeft].lower, h.legs[kRight].lower);
  const Vec3 elbows = Between(positions, h.arms[kLeft].lower, h.arms[kRight].lower);
  const Vec3 trunk = shoulders - hips;
  const float across = AngleBetween(trunk, knees - hips), across_arms = AngleBetween(trunk, elbows - shoulders);
  const bool square = across > 0.8f && across < 2.2f && across_arms > 0.8f && across_arms < 2.4f;
  const float width = Length(At(positions, h.arms[kLeft].lower) - At(positions, h.arms[kRight].lower));
  return square && AngleBetween(knees - hips, elbows - shoulders) < 0.9f && width < 1.2f * Length(trunk);
}

// Of both feet, away from their joints, as if the shins stood upright under `trunk`; square to it.
Vec3 ToesOf(const Humanoid& h, const std::vector<Vec3>& positions, Vec3 trunk) {
  Vec3 toes;
  for (const HumanoidLeg& leg : h.legs) {
    if (leg.foot < 0 || leg.toes < 0) continue;
    const Vec3 shin = leg.lower >= 0 ? At(positions, leg.foot) - At(positions, leg.lower) : trunk * -1;
    toes = toes + Rotated(ArcBetween(shin, trunk * -1), At(positions, leg.toes) - At(positions, leg.foot));
  }
  return toes - trunk * Dot(toes, trunk);
}

// Whose toes point behind has its sides the wrong way round: a mirrored figure, or names that were mixed up.
void SetSides(const std::vector<Vec3>& positions, Humanoid* h) {
  Vec3 up, forward;
  if (!h->sides_known || !FindStance(*h, positions, &up, &forward)) return;
  const float ahead = Dot(ToesOf(*h, positions, up), forward);
  float feet = 0;
  for (const HumanoidLeg& leg : h->legs) {
    if (leg.foot >= 0 && leg.toes >= 0) feet += Length(At(positions, leg.toes) - At(positions, leg.foot));
  }
  if (ahead >= -0.5f * feet || !(feet > 0)) return;
  std::swap(h->legs[kLeft], h->legs[kRight]);
  std::swap(h->arms[kLeft], h->arms[kRight]);
}

std::vector<BoneName> NamesWithoutOwner(const Joints& joints) {
  std::vector<std::string> names;
  for (const Joint& joint : joints) names.push_back(joint.name);
  return ReadWithoutOwner(names);
}

}  // namespace

bool FindHumanoid(const Joints& joints, const std::vector<Vec3>& positions, const std::vector<NamedBone>& told,
                  Humanoid* humanoid, std::string* why) {
  *humanoid = {};
  std::vector<BoneName> names;
  for (const Joint& joint : joints) names.push_back(ReadBoneName(joint.name));
  NameReader(joints, positions, std::move(names), told).Read(humanoid);
  bool complete = IsComplete(joints, humanoid, why);
  if (!complete && told.empty()) {
    Humanoid owned;
    std::string nothing;
    if (std::vector<BoneName> without = NamesWithoutOwner(joints); !without.empty()) {
      NameReader(joints, positions, std::move(without), {}).Read(&owned);
      complete = IsComplete(joints, &owned, &nothing);
    }
    if (complete) *humanoid = std::move(owned);
  }
  if (!complete) {
    Humanoid shaped;
    if (!FindHumanoidByShape(joints, positions, &shaped)) return false;
    shaped.by_shape = true;
    std::string nothing;
    if (!IsComplete(joints, &shaped, &nothing)) return false;
    if (shaped.quadruped && !IsQuadruped(shaped, positions)) return false;
    *humanoid = std::move(shaped);
  }
  humanoid->quadruped = IsQuadruped(*humanoid, positions);
  if (!humanoid->quadruped) SetSides(positions, humanoid);
  return true;
}

bool FindStance(const Humanoid& h, const std::vector<Vec3>& positions, Vec3* up, Vec3* forward) {
  if (!h.has_legs()) return false;
  const auto at = [&](int joint) { return At(positions, joint); };
  const Vec3 hips = Between(positions, h.legs[kLeft].upper, h.legs[kRight].upper);
  Vec3 above = h.has_arms() ? Between(positions, h.arms[kLeft].upper, h.arms[kRight].upper) : at(h.head);
  if (h.head >= 0) above = at(h.head);
  Vec3 trunk = Normalized(above - hips);
  const auto end = [&](const HumanoidLeg& leg) { return leg.foot >= 0 ? leg.foot : leg.lower; };
  if (end(h.legs[kLeft]) >= 0 && end(h.legs[kRight]) >= 0) {
    const Vec3 legs = Normalized(hips - Between(positions, end(h.legs[kLeft]), end(h.legs[kRight])));
    if (Dot(legs, trunk) > 0.7f) trunk = Normalized(trunk + legs);
  }
  Vec3 left = at(h.legs[kLeft].upper) - at(h.legs[kRight].upper);
  if (h.has_arms()) left = left + at(h.arms[kLeft].upper) - at(h.arms[kRight].upper);
  left = Normalized(left - trunk * Dot(left, trunk));
  if (!(Length(trunk) > 0.5f) || !(Length(left) > 0.5f)) return false;
  *up = trunk;
  *forward = Cross(left, trunk);
  const Vec3 toes = ToesOf(h, positions, trunk);
  if (!h.sides_known && Dot(Normalized(toes), *forward) < -0.5f) *forward = *forward * -1;
  return true;
}

}  // namespace flaneur
