#include "pipeline/rig/retarget.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "pipeline/core/rotation.h"
#include "pipeline/rig/source_motion.h"
#include "pipeline/rig/steps.h"
#include "pipeline/rig/stiff_legs.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

// Of the source's, in legs; toys swing their legs of one bone farther than any other leg reaches.
constexpr float kShortestStride = 0.5f, kShortestOfStiff = 0.35f, kStrideStep = 0.025f;
constexpr std::ptrdiff_t kEasedShare = 10;  // of a cycle's keys, one of so many, hips take to sink
// Of the leg's length: how much lower hips may be for their steps' sake, and than they are whatever the steps.
constexpr float kSunk = 0.024f, kSunkMore = 0.01f;
constexpr float kMaxFlatten_rad = 0.6f;       // that a standing foot may be turned to lie flat
constexpr float kCurl_rad = 0.25f;            // of each finger joint of a hand whose source has no fingers
constexpr float kStraightFinger_rad = 0.35f;  // fingers that rest more bent than this stay as they are
constexpr float kStiffFoot = 0.35f;           // of the turn of a leg of one bone that a foot with an ankle makes
constexpr float kToeBend_rad = 0.75f;         // at most, where the source has no toes
constexpr float kToeLift = 0.07f;             // of the leg's length above the ground: toes bend no more

Quat Between(Quat a, Quat b, float t) { return Slerp(a, b, std::clamp(t, 0.0f, 1.0f)); }

float Mean(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0f) / static_cast<float>(values.size());
}

// What is decided about the target's joints in one key.
struct Wanted {
  std::map<int, Quat> rotations;  // world
  Vec3 middle;                    // of the hip joints
  std::map<int, Vec3> positions;  // world, of joints that hang elsewhere than on their limb
  std::map<int, float> lifts;     // of legs of one bone
};

class Retargeter {
 public:
  Retargeter(const Rig& source, const Clip& clip, const Rig& target, const RetargetOptions& options)
      : source_(source, clip, options.walks),
        s_(source),
        t_(target),
        keys_(source_.motion().poses.size()),
        scale_(target.leg_m / source.leg_m),
        walks_(options.walks),
        wider_(options.wider * target.leg_m) {}

  Retargeted Make(const Clip& clip) {
    wanted_.resize(keys_);
    for (const size_t side : {kLeft, kRight}) FlattenFeet(side);
    for (size_t k = 0; k < keys_; ++k) {
      TurnTrunk(k);
      for (const size_t side : {kLeft, kRight}) {
        TurnLeg(k, side);
        TurnArm(k, side);
      }
      const Vec3 rest = ReferenceMiddle(t_), from = ReferenceMiddle(s_);
      Vec3 now = source_.Middle(k);
      if (source_.stiff()) now.y = from.y;  // who can bend knees need not bob
      wanted_[k].middle = {rest.x + scale_ * (now.x - from.x), HipHeight(now.y), rest.z + scale_ * (now.z - from.z)};
    }
    const bool stiff = !BendsKnees(t_);
    const float stiff_mps = stiff ? StandOnStiffLegs() : 0;
    if (!stiff) SetStride();
    Retargeted out;
    for (size_t k = 0; k < keys_; ++k) poses_.push_back(stiff ? Posed(k) : Finish(k));
    out.source_slide = source_.slide();
    out.walk_speed_mps = stiff ? stiff_mps : scale_ * stride_ * source_.motion().speed;
    out.clip = ClipOf(clip);
    return out;
  }

 private:
  static Vec3 ReferenceMiddle(const Rig& rig) {
    return (At(rig.reference.positions, rig.legs[kLeft].upper) + At(rig.reference.positions, rig.legs[kRight].upper)) *
           0.5f;
  }

  static float AnkleHeight(const Rig& rig) {
    return 0.5f * (rig.legs[kLeft].ankle_height_m + rig.legs[kRight].ankle_height_m);
  }

  float HipHeight(float source_height) const { return AnkleHeight(t_) + scale_ * (source_height - AnkleHeight(s_)); }

  Quat ReferenceOf(int joint) const { return At(t_.reference.rotations, joint); }

  // The target joint turned from its reference by `turn`.
  void Turn(size_t key, int joint, Quat turn) { wanted_[key].rotations[joint] = Product(turn, ReferenceOf(joint)); }

  // The source's frame of a limb, now.
  Quat SourceFrame(size_t key, int joint, Quat reference_frame) const {
    return Product(source_.Turned(key, joint), reference_frame);
  }

  void TurnTrunk(size_t k) {
    const Humanoid &from = s_.humanoid, &to = t_.humanoid;
    std::vector<Quat> turns{source_.Turned(k, from.hips)};
    for (const int joint : from.spine) turns.push_back(source_.Turned(k, joint));
    const auto spread = [](const std::vector<Quat>& list, float share) {
      const float at = share * static_cast<float>(list.size() - 1);
      const size_t i = std::min(static_cast<size_t>(at), list.size() - 1);
      return i + 1 < list.size() ? Between(list[i], list[i + 1], at - static_cast<float>(i)) : list[i];
    };
    Turn(k, to.hips, turns.front());
    for (size_t i = 0; i < to.spine.size(); ++i) {
      Turn(k, to.spine[i], spread(turns, static_cast<float>(i + 1) / static_cast<float>(to.spine.size())));
    }
    if (to.head < 0 || from.head < 0) return;
    std::vector<Quat> upper{turns.back()};
    for (const int joint : from.neck) upper.push_back(source_.Turned(k, joint));
    upper.push_back(source_.Turned(k, from.head));
    for (size_t i = 0; i < to.neck.size(); ++i) {
      Turn(k, to.neck[i], spread(upper, static_cast<float>(i + 1) / static_cast<float>(to.neck.size() + 1)));
    }
    Turn(k, to.head, upper.back());
  }

  void TurnLeg(size_t k, size_t side) {
    const RigLeg &from = s_.legs[side], &to = t_.legs[side];
    const Quat upper = SourceFrame(k, from.upper, s_.leg_upper[side]);
    const Quat lower = from.lower >= 0 ? SourceFrame(k, from.lower, s_.leg_lower[side]) : upper;
    SetLeg(k, side, upper, lower);
    if (to.foot < 0) return;
    Quat foot = Product(flatten_[side], source_.Turned(k, from.ankle.joint));
    if (source_.stiff()) foot = Between({}, foot, kStiffFoot);
    Turn(k, to.foot, foot);
    if (to.toes < 0) return;
    if (from.toes >= 0) {
      const Quat bend = Product(Conjugate(source_.Turned(k, from.ankle.joint)), source_.Turned(k, from.toes));
      Turn(k, to.toes, Product(foot, bend));
    } else {
      Turn(k, to.toes, Product(foot, ToeBend(k, side, foot)));
    }
  }

  // Toes lie on the ground while the heel rises.
  Quat ToeBend(size_t k, size_t side, Quat foot) const {
    const Vec3 ahead = Rotated(foot, {0, 0, 1});
    float low = 1e30f;
    for (const SolePoint& point : s_.legs[side].sole) {
      low = std::min(low, PlaceOf(point, source_.motion().poses[k]).y);
    }
    const float near = std::clamp(1 - low / (kToeLift * s_.leg_m), 0.0f, 1.0f);
    const float down = std::clamp(std::asin(std::clamp(-ahead.y, -1.0f, 1.0f)), 0.0f, kToeBend_rad);
    return TurnAbout({1, 0, 0}, -down * near);
  }

  void SetLeg(size_t k, size_t side, Quat upper, Quat lower) {
    const RigLeg& to = t_.legs[side];
    Turn(k, to.upper, Product(upper, Conjugate(t_.leg_upper[side])));
    if (to.lower >= 0) Turn(k, to.lower, Product(lower, Conjugate(t_.leg_lower[side])));
    frames_[{k, side}] = {upper, lower};
  }

  void TurnArm(size_t k, size_t side) {
    const HumanoidArm &from = s_.humanoid.arms[side], &to = t_.humanoid.arms[side];
    if (to.upper < 0 || from.upper < 0) return;
    const RigArm &rest = s_.arms[side], &own = t_.arms[side];
    if (to.clavicle >= 0 && !t_.humanoid.spine.empty()) {
      const int chest = s_.humanoid.spine.empty() ? s_.humanoid.hips : s_.humanoid.spine.back();
      const Quat lift =
          from.clavicle >= 0 ? Product(Conjugate(source_.Turned(k, chest)), source_.Turned(k, from.clavicle)) : Quat{};
      Turn(k, to.clavicle, Product(source_.Turned(k, chest), lift));
    }
    Quat upper = SourceFrame(k, from.upper, rest.upper);
    const Quat lower = from.lower >= 0 ? SourceFrame(k, from.lower, rest.lower) : upper;
    const Quat hand = from.hand >= 0 ? SourceFrame(k, from.hand, rest.hand) : lower;
    if (to.lower < 0 && from.lower >= 0 && from.hand >= 0) {  // one bone points where the hand is
      const Vec3 out{side == kLeft ? 1.0f : -1.0f, 0, 0};
      const Vec3 way = source_.Place(k, from.hand) - source_.Place(k, from.upper);
      upper = Product(ArcBetween(Rotated(upper, out), way), upper);
    }
    Turn(k, to.upper, Product(upper, Conjugate(own.upper)));
    if (to.lower >= 0) Turn(k, to.lower, Product(lower, Conjugate(own.lower)));
    if (to.hand < 0) return;
    Turn(k, to.hand, Product(hand, Conjugate(own.hand)));
    for (size_t f = 0; f < to.fingers.size(); ++f) TurnFinger(k, side, f, hand);
  }

  const std::vector<int>& SourceFinger(size_t side, size_t finger) const {
    const auto& fingers = s_.humanoid.arms[side].fingers;
    if (!fingers[finger].empty() || finger == 0) return fingers[finger];
    for (const size_t other : {size_t{2}, size_t{1}, size_t{3}, size_t{4}}) {
      if (!fingers[other].empty()) return fingers[other];
    }
    return fingers[finger];
  }

  void TurnFinger(size_t k, size_t side, size_t finger, Quat hand) {
    const std::vector<int>& own = t_.humanoid.arms[side].fingers[finger];
    const std::vector<int>& theirs = SourceFinger(side, finger);
    const Quat rest = t_.arms[side].hand;
    const Quat hand_turn = Product(hand, Conjugate(rest));
    Quat bent;
    for (size_t i = 0; i < own.size(); ++i) {
      Quat bend = bent;
      if (theirs.empty()) {
        if (finger == 0 || IsBent(own, side)) return;
        bent = Product(bent, TurnAbout({0, 0, 1}, side == kLeft ? -kCurl_rad : kCurl_rad));
        bend = bent;
      } else {
        const int joint = theirs[std::min(i, theirs.size() - 1)];
        const Quat source_rest = s_.arms[side].hand;
        const Quat now = Product(Conjugate(source_.Turned(k, s_.humanoid.arms[side].hand)), source_.Turned(k, joint));
        bend = Product(Conjugate(source_rest), Product(now, source_rest));
      }
      Turn(k, own[i], Product(hand_turn, Product(rest, Product(bend, Conjugate(rest)))));
    }
  }

  bool IsBent(const std::vector<int>& finger, size_t side) const {
    if (finger.size() < 2) return true;
    const auto& at = t_.reference.positions;
    const Vec3 out{side == kLeft ? 1.0f : -1.0f, 0, 0};
    return AngleBetween(At(at, finger.back()) - At(at, finger.front()), Rotated(t_.arms[side].hand, out)) >
           kStraightFinger_rad;
  }

  // What the source's foot is off lying flat in the middle of its stands is taken out of all keys: a rig that rests on
  // tiptoe, or stands a little askew, is no reason to do so too.
  void FlattenFeet(size_t side) {
    const RigLeg& leg = s_.legs[side];
    Vec3 up;
    const auto& stands = source_.stands(side);
    for (size_t k = 1; k + 1 < keys_; ++k) {
      if (!stands[k] || !stands[k - 1] || !stands[k + 1]) continue;
      float low = 1e30f, high = -1e30f;
      for (const SolePoint& point : leg.sole) {
        const float y = PlaceOf(point, source_.motion().poses[k]).y;
        low = std::min(low, y), high = std::max(high, y);
      }
      const float flat = std::max(0.0f, 1 - (high - low) / (0.12f * s_.leg_m));
      up = up + Rotated(source_.Turned(k, leg.ankle.joint), {0, 1, 0}) * flat;
    }
    flatten_[side] = {};
    if (leg.foot < 0 || !(Length(up) > 0)) return;
    const Quat level = ArcBetween(up, {0, 1, 0});
    if (AngleOf(level) < kMaxFlatten_rad) flatten_[side] = level;
  }

  // Steps as long as the source's, in legs, or as much shorter as keeps the hips up: who has larger feet rolls farther
  // over them than these legs reach.
  void SetStride() {
    const auto sinks = [&](float stride) {
      stride_ = stride;
      for (const size_t side : {kLeft, kRight}) SetFeet(side);
      lower_ = Eased(LoweredHips());
      return Mean(lower_);
    };
    const float theirs = source_.stiff() ? 0 : scale_ * Mean(Eased(source_.Sinks()));
    const float least_stride = source_.stiff() ? kShortestOfStiff : kShortestStride;
    const float least = std::max(theirs, sinks(least_stride));
    const float enough = std::max(kSunk * t_.leg_m, least + kSunkMore * t_.leg_m);
    const float shortest = source_.motion().speed > 0 ? least_stride : 1.0f;
    float stride = 1;
    while (sinks(stride) > enough && stride > shortest) stride -= kStrideStep;
    for (size_t k = 0; k < keys_; ++k) wanted_[k].middle.y -= lower_[k];
    for (const size_t side : {kLeft, kRight}) {  // again, now that it is known how shins stand, which heels go with
      for (size_t k = 0; k < keys_; ++k) MeetFoot(k, side);
      SetFeet(side);
    }
  }

  void SetFeet(size_t side) {
    const float step_m = scale_ * stride_ * source_.motion().speed * source_.motion().step_s;
    const RigLeg &from = s_.legs[side], &to = t_.legs[side];
    FootTrack track;
    const Vec3 own_hip = At(t_.reference.positions, to.upper) - ReferenceMiddle(t_);
    const Vec3 their_hip = At(s_.reference.positions, from.upper) - ReferenceMiddle(s_);
    const Vec3 rest = ReferenceMiddle(t_), their_rest = ReferenceMiddle(s_);
    const float wider = own_hip.x < 0 ? -wider_ : wider_;
    for (size_t k = 0; k < keys_; ++k) {
      const Vec3 ankle = source_.Ankle(k, side);
      track.wanted.push_back({rest.x + own_hip.x + wider + scale_ * (ankle.x - their_rest.x - their_hip.x),
                              to.ankle_height_m + scale_ * (ankle.y - from.ankle_height_m),
                              rest.z + own_hip.z + scale_ * stride_ * (ankle.z - their_rest.z - their_hip.z)});
      const Pose foot = FootAgainstAnkle(k, side);
      track.sole.push_back(SoleOf(foot, side));
      track.lowest.push_back(0);
      for (const Vec3 p : track.sole.back()) track.lowest.back() = std::min(track.lowest.back(), p.y);
      for (const SolePoint& tip : to.tips) track.lowest.back() = std::min(track.lowest.back(), PlaceOf(tip, foot).y);
    }
    track.stands = source_.stands(side);
    const bool loops = source_.motion().loops && keys_ > 1;
    if (loops) {
      track.stands.pop_back();
      track.wanted.pop_back();
      track.sole.pop_back();
      track.lowest.pop_back();
    }
    ankles_[side] = RollFoot(track, step_m, t_.leg_m, loops);
    if (loops) ankles_[side].push_back(ankles_[side].front());
  }

  // The foot alone, its ankle at the origin.
  Pose FootAgainstAnkle(size_t k, size_t side) const {
    const RigLeg& leg = t_.legs[side];
    const auto& turned = wanted_[k].rotations;
    Pose pose;
    pose.positions.resize(t_.joints.size());
    pose.rotations.resize(t_.joints.size());
    const auto set = [&](int joint, Vec3 place) {
      At(pose.rotations, joint) = turned.at(joint);
      At(pose.positions, joint) = place;
    };
    const int foot = leg.ankle.joint;
    set(foot, Rotated(turned.at(foot), leg.ankle.offset) * -1);
    if (leg.toes >= 0) set(leg.toes, Hung(leg.toes, foot, pose));
    if (leg.foot >= 0) {
      const Vec3 out = At(t_.reference.positions, leg.lower) - PlaceOf(leg.ankle, t_.reference);
      set(leg.lower, Rotated(Product(turned.at(leg.lower), Conjugate(ReferenceOf(leg.lower))), out));
    }
    return pose;
  }

  // Hip joint of a leg against the middle of both, in the key.
  Vec3 HipOffset(size_t k, size_t side) const {
    const Vec3 out = At(t_.reference.positions, t_.legs[side].upper) - ReferenceMiddle(t_);
    return Rotated(Product(wanted_[k].rotations.at(t_.humanoid.hips), Conjugate(ReferenceOf(t_.humanoid.hips))), out);
  }

  // By how much, a key, so that every standing foot is within reach.
  std::vector<float> LoweredHips() const {
    std::vector<float> lower(keys_, 0.0f);
    for (size_t k = 0; k < keys_; ++k) {
      for (const size_t side : {kLeft, kRight}) {
        if (!source_.stands(side)[k]) continue;
        const RigLeg& leg = t_.legs[side];
        const Vec3 off = wanted_[k].middle + HipOffset(k, side) - ankles_[side][k];
        lower[k] = std::max(lower[k], off.y - HighestHip(leg, off));
      }
    }
    return lower;
  }

  // No less than `lower` anywhere, without sudden steps.
  std::vector<float> Eased(const std::vector<float>& lower) const {
    const auto n = static_cast<std::ptrdiff_t>(keys_);
    const bool loops = source_.motion().loops && keys_ > 1;
    const std::ptrdiff_t period = loops ? n - 1 : n;
    const std::ptrdiff_t reach = std::clamp<std::ptrdiff_t>(period / kEasedShare, 1, 4);  // keys to either side
    const auto at = [&](const std::vector<float>& list, std::ptrdiff_t k) {
      const std::ptrdiff_t i = loops ? (k % period + period) % period : std::clamp<std::ptrdiff_t>(k, 0, n - 1);
      return list[static_cast<size_t>(i)];
    };
    std::vector<float> widest(keys_), eased(keys_);
    for (std::ptrdiff_t k = 0; k < n; ++k) {
      for (std::ptrdiff_t d = -reach; d <= reach; ++d) {
        widest[static_cast<size_t>(k)] = std::max(widest[static_cast<size_t>(k)], at(lower, k + d));
      }
    }
    for (std::ptrdiff_t k = 0; k < n; ++k) {
      float sum = 0, weights = 0;
      for (std::ptrdiff_t d = -reach; d <= reach; ++d) {
        const float weight = static_cast<float>(reach + 1 - std::abs(d));
        sum += weight * at(widest, k + d), weights += weight;
      }
      eased[static_cast<size_t>(k)] = sum / weights;
    }
    return eased;
  }

  Pose Finish(size_t k) {
    for (const size_t side : {kLeft, kRight}) MeetFoot(k, side);
    return Posed(k);
  }

  // Hips and all else where the hip joints' middle is.
  Pose Posed(size_t k) {
    const Vec3 hips = At(t_.reference.positions, t_.humanoid.hips) - ReferenceMiddle(t_);
    const Quat turn = Product(wanted_[k].rotations.at(t_.humanoid.hips), Conjugate(ReferenceOf(t_.humanoid.hips)));
    wanted_[k].positions[t_.humanoid.hips] = wanted_[k].middle + Rotated(turn, hips);
    return Solve(k);
  }

  std::vector<Vec3> SoleOf(const Pose& pose, size_t side) const {
    std::vector<Vec3> sole;
    for (const SolePoint& point : t_.legs[side].sole) sole.push_back(PlaceOf(point, pose));
    return sole;
  }

  // Legs of one bone point where the source's ankles are. Who walks on them steps from one to the other; else the hips
  // are as high as the lower one of them stands. Returns how fast they walk.
  float StandOnStiffLegs() {
    const std::array<Soles, 2> soles = PointStiffLegs(0);
    if (!walks_ || !source_.motion().loops) return 0;
    const StiffWalk walk = Stepped(PointStiffLegs(-Stepped(soles).aside_rad));
    for (size_t k = 0; k < walk.middle.size(); ++k) {
      wanted_[k].middle = walk.middle[k];
      for (const size_t side : {kLeft, kRight}) wanted_[k].lifts[t_.legs[side].upper] = walk.lift[side][k];
    }
    return walk.speed;
  }

  StiffWalk Stepped(const std::array<Soles, 2>& soles) const {
    return WalkOnStiffLegs(soles, source_.motion().step_s, t_.leg_m);
  }

  // Turned so much to the left. Returns the soles against the middle of the hips.
  std::array<Soles, 2> PointStiffLegs(float turn_rad) {
    const Quat turn = TurnAbout({0, 1, 0}, turn_rad);
    std::array<Soles, 2> soles;
    for (size_t k = 0; k < keys_; ++k) {
      for (const size_t side : {kLeft, kRight}) {
        const Vec3 way = source_.Ankle(k, side) - source_.Place(k, s_.legs[side].upper);
        const Quat own = SourceFrame(k, s_.legs[side].upper, s_.leg_upper[side]);
        const Quat frame = Product(turn, LegFrame(way, Cross(way, Rotated(own, {1, 0, 0}))));
        SetLeg(k, side, frame, frame);
      }
      const Pose pose = Posed(k);
      float lowest = 1e30f;
      for (const size_t side : {kLeft, kRight}) {
        soles[side].push_back(SoleOf(pose, side));
        for (Vec3& p : soles[side].back()) lowest = std::min(lowest, p.y), p = p - wanted_[k].middle;
      }
      wanted_[k].middle.y -= lowest;
    }
    return soles;
  }

  // Bends the knee so that the ankle is where the foot is set.
  void MeetFoot(size_t k, size_t side) {
    const RigLeg& leg = t_.legs[side];
    const Vec3 hip = wanted_[k].middle + HipOffset(k, side);
    Vec3 line = ankles_[side][k] - hip;
    const auto [upper, lower] = frames_.at({k, side});
    // The knee's axis, which stays where it is however far the knee bends.
    const Vec3 axis = Normalized(Rotated(upper, {1, 0, 0}) + Rotated(lower, {1, 0, 0}));
    const auto front = [&](Vec3 along) { return Cross(along, axis); };
    const float longest = kStraightest * (leg.thigh_m + leg.shin_m);
    const float shortest = 1.05f * std::abs(leg.thigh_m - leg.shin_m) + 0.1f * longest;
    const float distance = std::clamp(Length(line), shortest, longest);
    line = Normalized(line);
    Vec3 across = front(line);
    across = Length(across) > 1e-3f ? Normalized(across) : Normalized(Vec3{0, 0, 1} - line * line.z);
    const float along = (leg.thigh_m * leg.thigh_m - leg.shin_m * leg.shin_m + distance * distance) / (2 * distance);
    const float out = std::sqrt(std::max(leg.thigh_m * leg.thigh_m - along * along, 0.0f));
    const Vec3 thigh = line * along + across * out;
    const Vec3 shin = line * distance - thigh;
    SetLeg(k, side, LegFrame(thigh, front(thigh)), LegFrame(shin, front(shin)));
    if (leg.foot >= 0) wanted_[k].positions[leg.foot] = hip + line * distance;
  }

  // The limb that a joint belongs to, whatever it hangs on in the file.
  int LimbOf(int joint) const {
    for (const size_t side : {kLeft, kRight}) {
      if (joint == t_.humanoid.arms[side].hand) return t_.humanoid.arms[side].lower;
    }
    return -1;
  }

  bool HangsOn(int joint, int above) const {
    for (int a = joint; a >= 0; a = At(t_.joints, a).parent) {
      if (a == above) return true;
    }
    return false;
  }

  Pose Solve(size_t k) const {
    const size_t joints = t_.joints.size();
    Pose pose = t_.reference;
    const Wanted& wanted = wanted_[k];
    const auto place = [&](size_t j) {
      const int joint = static_cast<int>(j), parent = t_.joints[j].parent;
      if (const auto own = wanted.rotations.find(joint); own != wanted.rotations.end()) {
        pose.rotations[j] = own->second;
      } else if (parent >= 0) {
        const Quat local = Product(Conjugate(ReferenceOf(parent)), ReferenceOf(joint));
        pose.rotations[j] = Product(At(pose.rotations, parent), local);
      }
      const auto set = wanted.positions.find(joint);
      const bool hips = joint == t_.humanoid.hips;
      const bool detached = IsFoot(joint) && !HangsOn(joint, LowerOf(joint));
      if (set != wanted.positions.end() && (hips || detached)) {
        pose.positions[j] = set->second;
      } else if (parent >= 0) {
        pose.positions[j] = Hung(joint, parent, pose);
      }
      if (const auto lift = wanted.lifts.find(joint); lift != wanted.lifts.end()) pose.positions[j].y += lift->second;
    };
    for (size_t j = 0; j < joints; ++j) place(j);
    // Hands that hang elsewhere than on their arms come to them, and all that is on them follows.
    for (const size_t side : {kLeft, kRight}) {
      const int hand = t_.humanoid.arms[side].hand, lower = t_.humanoid.arms[side].lower;
      if (hand < 0 || lower < 0 || HangsOn(hand, lower)) continue;
      At(pose.positions, hand) = Hung(hand, lower, pose);
      for (size_t j = static_cast<size_t>(hand) + 1; j < joints; ++j) {
        if (HangsOn(static_cast<int>(j), hand)) place(j);
      }
    }
    return pose;
  }

  bool IsFoot(int joint) const { return joint == t_.legs[kLeft].foot || joint == t_.legs[kRight].foot; }
  int LowerOf(int foot) const { return t_.legs[foot == t_.legs[kLeft].foot ? kLeft : kRight].lower; }

  // Where the joint is, as far from `on` as in the reference pose.
  Vec3 Hung(int joint, int on, const Pose& pose) const {
    const Vec3 out = At(t_.reference.positions, joint) - At(t_.reference.positions, on);
    return At(pose.positions, on) + Rotated(Product(At(pose.rotations, on), Conjugate(ReferenceOf(on))), out);
  }

  // In the target's own space, relative to the parents.
  Clip ClipOf(const Clip& source) const {
    Clip clip;
    clip.name = source.name;
    clip.keys = static_cast<int>(keys_);
    clip.duration_s = keys_ > 1 ? source_.motion().step_s * static_cast<float>(keys_ - 1) : source.duration_s;
    const size_t joints = t_.joints.size();
    const Quat back = Conjugate(t_.turn);
    for (size_t k = 0; k < keys_; ++k) {
      Pose pose = poses_[k];
      for (Vec3& p : pose.positions) p = Rotated(back, p - t_.shift);
      for (Quat& q : pose.rotations) q = Product(back, q);
      for (size_t j = 0; j < joints; ++j) {
        const int parent = t_.joints[j].parent;
        Transform local{pose.positions[j], pose.rotations[j], {1, 1, 1}};
        if (parent >= 0) {
          const Quat up = Conjugate(At(pose.rotations, parent));
          local.translation = Rotated(up, pose.positions[j] - At(pose.positions, parent));
          local.rotation = Normalized(Product(up, pose.rotations[j]));
        }
        if (k > 0) {
          const Quat b = clip.transforms[clip.transforms.size() - joints].rotation;
          Quat& q = local.rotation;
          if (q.x * b.x + q.y * b.y + q.z * b.z + q.w * b.w < 0) q = {-q.x, -q.y, -q.z, -q.w};
        }
        clip.transforms.push_back(local);
      }
    }
    return clip;
  }

  const SourceMotion source_;
  const Rig &s_, &t_;
  size_t keys_;
  float scale_;
  std::vector<Wanted> wanted_;
  std::map<std::pair<size_t, size_t>, std::pair<Quat, Quat>> frames_;  // of the legs, by key and side
  std::array<Quat, 2> flatten_;
  std::array<std::vector<Vec3>, 2> ankles_;
  bool walks_;
  float wider_;
  float stride_ = 1;  // of the source's, in legs
  std::vector<float> lower_;
  std::vector<Pose> poses_;
};

}  // namespace

Retargeted Retarget(const Rig& source, const Clip& clip, const Rig& target, const RetargetOptions& options) {
  return Retargeter(source, clip, target, options).Make(clip);
}

}  // namespace flaneur
