#include "pipeline/rig/retarget.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "pipeline/core/rotation.h"
#include "pipeline/rig/steps.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

constexpr float kShortestStride = 0.5f, kStrideStep = 0.025f;  // of the source's, in legs
constexpr std::ptrdiff_t kEasedShare = 10;                     // of a cycle's keys, one of so many, hips take to sink
// Of the leg's length: how much lower hips may be for their steps' sake, and than they are whatever the steps.
constexpr float kSunk = 0.024f, kSunkMore = 0.01f;
constexpr float kStraightest = 0.998f;        // of a leg's length: a knee never stretches further
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

// How high a hip may be above its ankle, which is so far away on the level.
float HighestHip(const RigLeg& leg, Vec3 off) {
  const float reach = kStraightest * (leg.thigh_m + leg.shin_m);
  return std::sqrt(std::max(reach * reach - off.x * off.x - off.z * off.z, 0.01f * reach * reach));
}

// The source's motion by body part, free of any skeleton; lengths in source units, upright, on the spot or travelling.
struct Motion {
  float step_s = 1.0f / 30;
  bool loops = true;
  std::vector<Pose> poses;
  float speed = 0;  // source units a second along +Z, already taken out of the poses
};

class Source {
 public:
  Source(const Rig& rig, const Clip& clip, bool walks) : rig_(rig), walks_(walks) {
    const size_t joints = rig.joints.size();
    motion_.step_s = clip.keys > 1 ? clip.duration_s / static_cast<float>(clip.keys - 1) : 1.0f / 30;
    for (int k = 0; k < clip.keys; ++k) {
      motion_.poses.push_back(PoseOf(rig.joints, clip.transforms.data() + static_cast<size_t>(k) * joints));
    }
    StandUp();
    TakeTravel();
    CloseLoop();
    PutOnGround();
    FindSpeed();
  }

  const Motion& motion() const { return motion_; }
  const std::vector<bool>& stands(size_t side) const { return stands_[side]; }
  const Rig& rig() const { return rig_; }
  float slide() const { return slide_; }
  bool stiff() const { return walks_ && !BendsKnees(rig_); }

  // How far the joint has turned from its reference.
  Quat Turned(size_t key, int joint) const {
    return Product(At(motion_.poses[key].rotations, joint), Conjugate(At(rig_.reference.rotations, joint)));
  }

  Vec3 Place(size_t key, int joint) const { return At(motion_.poses[key].positions, joint); }
  Vec3 Ankle(size_t key, size_t side) const { return PlaceOf(rig_.legs[side].ankle, motion_.poses[key]); }
  // By how much the hips would be lower, a key, if all feet that stand stood on the ground.
  std::vector<float> Sinks() const {
    std::vector<float> lower(motion_.poses.size(), 0.0f);
    for (size_t k = 0; k < lower.size(); ++k) {
      for (const size_t side : {kLeft, kRight}) {
        if (!stands_[side][k]) continue;
        const RigLeg& leg = rig_.legs[side];
        float low = 1e30f;
        for (const SolePoint& point : leg.sole) low = std::min(low, PlaceOf(point, motion_.poses[k]).y);
        const Vec3 off = Place(k, leg.upper) - Ankle(k, side);
        lower[k] = std::max(lower[k], off.y + low - HighestHip(leg, off));
      }
    }
    return lower;
  }

  Vec3 Middle(size_t key) const {
    return (Place(key, rig_.legs[kLeft].upper) + Place(key, rig_.legs[kRight].upper)) * 0.5f;
  }

 private:
  // By quarters about the level axes, so that who bends or sits is not straightened; fully about the vertical.
  void StandUp() {
    Vec3 up, forward;
    for (const Pose& pose : motion_.poses) {
      Vec3 u, f;
      if (!FindStance(rig_.humanoid, pose.positions, &u, &f)) continue;
      up = up + u, forward = forward + f;
    }
    const Quat turn = TurnToFront(Normalized(up), Normalized(forward), 0);
    for (Pose& pose : motion_.poses) TurnPose(turn, &pose);
  }

  void TakeTravel() {
    const size_t last = motion_.poses.size() - 1;
    if (last == 0) return;
    Vec3 travel = Middle(last) - Middle(0);
    travel.y = 0;
    if (Length(travel) > 0.15f * rig_.leg_m * static_cast<float>(last) * motion_.step_s) {
      const Quat ahead = TurnAbout({0, 1, 0}, -std::atan2(travel.x, travel.z));
      if (std::abs(std::atan2(travel.x, travel.z)) < 0.8f) {  // else it goes sideways or backwards, and is let
        for (Pose& pose : motion_.poses) TurnPose(ahead, &pose);
        travel = Rotated(ahead, travel);
      }
      motion_.speed = travel.z / (static_cast<float>(last) * motion_.step_s);
    } else {
      travel = {};
    }
    Vec3 mean;
    for (size_t k = 0; k <= last; ++k) {
      const float share = static_cast<float>(k) / static_cast<float>(last);
      Shift(travel * -share, &motion_.poses[k]);
      mean = mean + Middle(k) * (1 / static_cast<float>(last + 1));
    }
    for (Pose& pose : motion_.poses) Shift({-mean.x, 0, -mean.z}, &pose);
  }

  float Gap(const Pose& a, const Pose& b) const {
    float sum = 0;
    for (size_t j = 0; j < rig_.joints.size(); ++j) sum += Length(a.positions[j] - b.positions[j]);
    return sum / static_cast<float>(rig_.joints.size());
  }

  // The last pose becomes the first: it nearly is, or just one more is missing, or the end is led over into it.
  void CloseLoop() {
    auto& poses = motion_.poses;
    if (poses.size() < 3) return;
    float step = 0;
    for (size_t k = 1; k < poses.size(); ++k)
      step += Gap(poses[k - 1], poses[k]) / static_cast<float>(poses.size() - 1);
    const float gap = Gap(poses.front(), poses.back());
    if (gap > 0.5f * step && gap <= 2 * step) {
      poses.push_back(poses.front());
    } else if (gap > 2 * step) {
      const size_t blended = std::max<size_t>(1, poses.size() / 4);
      for (size_t i = 0; i < blended; ++i) {
        Pose& pose = poses[poses.size() - blended + i];
        const float t = static_cast<float>(i + 1) / static_cast<float>(blended);
        const float share = t * t * (3 - 2 * t);
        for (size_t j = 0; j < rig_.joints.size(); ++j) {
          pose.positions[j] = pose.positions[j] * (1 - share) + poses.front().positions[j] * share;
          pose.rotations[j] = Slerp(pose.rotations[j], poses.front().rotations[j], share);
        }
      }
    }
    poses.back() = poses.front();
  }

  static void Shift(Vec3 by, Pose* pose) {
    for (Vec3& p : pose->positions) p = p + by;
  }

  Soles SolesOf(size_t side) const {
    Soles soles;
    for (const Pose& pose : motion_.poses) {
      std::vector<Vec3>& points = soles.emplace_back();
      for (const SolePoint& point : rig_.legs[side].sole) points.push_back(PlaceOf(point, pose));
    }
    return soles;
  }

  void PutOnGround() {
    std::vector<float> lowest;
    for (const Pose& pose : motion_.poses) {
      float low = 1e30f;
      for (const RigLeg& leg : rig_.legs) {
        for (const SolePoint& point : leg.sole) low = std::min(low, PlaceOf(point, pose).y);
      }
      lowest.push_back(low);
    }
    // Legs of one bone cannot bend, so clips for them hop; walking, each pose stands.
    const float ground = GroundUnder(lowest, rig_.leg_m, walks_);
    for (size_t k = 0; k < lowest.size(); ++k) Shift({0, stiff() ? -lowest[k] : -ground, 0}, &motion_.poses[k]);
  }

  void FindSpeed() {
    motion_.loops = motion_.poses.size() > 2;
    if (stiff()) FindStiffSteps();
    else FindSteps();
    for (std::vector<bool>& stands : stands_) {
      if (motion_.loops) stands.push_back(stands.front());  // the last key is the first
    }
  }

  void FindSteps() {
    const auto left = SolesOf(kLeft), right = SolesOf(kRight);
    if (motion_.speed == 0) motion_.speed = SpeedOfSoles(left, right, motion_.step_s, rig_.leg_m);
    std::array<Soles, 2> soles{left, right};
    for (const size_t side : {kLeft, kRight}) {
      if (motion_.loops) soles[side].pop_back();
      stands_[side] = FindStance(soles[side], motion_.speed, motion_.step_s, rig_.leg_m, motion_.loops);
    }
    slide_ = SlideOfSoles(left, right, motion_.step_s, rig_.leg_m, motion_.speed);
    StandSomewhere(soles[kLeft], soles[kRight], rig_.leg_m, walks_ && motion_.speed != 0, &stands_[kLeft],
                   &stands_[kRight]);
  }

  // Both legs of one bone pass the ground at one height: that which goes back stands.
  void FindStiffSteps() {
    float way = 0, keys = 0;
    for (size_t k = 0; k + 1 < motion_.poses.size(); ++k) {
      for (const size_t side : {kLeft, kRight}) {
        const float back = Ankle(k, side).z - Ankle(k + 1, side).z;
        const float other = Ankle(k, 1 - side).z - Ankle(k + 1, 1 - side).z;
        stands_[side].push_back(back >= other);
        if (back >= other) way += back, keys += 1;
      }
    }
    if (motion_.speed == 0 && keys > 0) motion_.speed = way / (keys * motion_.step_s);
    if (!motion_.loops) stands_[kLeft].push_back(true), stands_[kRight].push_back(true);
    const Soles level(stands_[kLeft].size(), {Vec3{}});
    StandSomewhere(level, level, rig_.leg_m, true, &stands_[kLeft], &stands_[kRight]);
  }

  const Rig& rig_;
  bool walks_;
  float slide_ = 0;
  Motion motion_;
  std::array<std::vector<bool>, 2> stands_;
};

// What is decided about the target's joints in one key.
struct Wanted {
  std::map<int, Quat> rotations;  // world
  Vec3 middle;                    // of the hip joints
  std::map<int, Vec3> positions;  // world, of joints that hang elsewhere than on their limb
};

class Retargeter {
 public:
  Retargeter(const Rig& source, const Clip& clip, const Rig& target, const RetargetOptions& options)
      : source_(source, clip, options.walks),
        s_(source),
        t_(target),
        keys_(source_.motion().poses.size()),
        scale_(target.leg_m / source.leg_m),
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
    if (stiff) StandOnStiffLegs();
    else SetStride();
    Retargeted out;
    for (size_t k = 0; k < keys_; ++k) poses_.push_back(stiff ? Posed(k) : Finish(k));
    out.source_slide = source_.slide();
    out.walk_speed_mps = stiff ? 0 : scale_ * stride_ * source_.motion().speed;
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
    const float least = std::max(scale_ * Mean(Eased(source_.Sinks())), sinks(kShortestStride));
    const float enough = std::max(kSunk * t_.leg_m, least + kSunkMore * t_.leg_m);
    const float shortest = source_.motion().speed > 0 ? kShortestStride : 1.0f;
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

  // Legs of one bone point where the source's ankles are, and the hips are as high as the lower one of them stands.
  void StandOnStiffLegs() {
    for (size_t k = 0; k < keys_; ++k) {
      for (const size_t side : {kLeft, kRight}) {
        const Vec3 way = source_.Ankle(k, side) - source_.Place(k, s_.legs[side].upper);
        const Quat frame = LegFrame(way, Cross(way, Rotated(frames_.at({k, side}).first, {1, 0, 0})));
        SetLeg(k, side, frame, frame);
      }
      const Pose pose = Posed(k);
      float lowest = 1e30f;
      for (const size_t side : {kLeft, kRight}) {
        for (const Vec3 p : SoleOf(pose, side)) lowest = std::min(lowest, p.y);
      }
      wanted_[k].middle.y -= lowest;
    }
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

  const Source source_;
  const Rig &s_, &t_;
  size_t keys_;
  float scale_;
  std::vector<Wanted> wanted_;
  std::map<std::pair<size_t, size_t>, std::pair<Quat, Quat>> frames_;  // of the legs, by key and side
  std::array<Quat, 2> flatten_;
  std::array<std::vector<Vec3>, 2> ankles_;
  float wider_;
  float stride_ = 1;  // of the source's, in legs
  std::vector<float> lower_;
  std::vector<Pose> poses_;
};

std::map<std::string, int> ByName(const std::vector<Joint>& joints) {
  std::map<std::string, int> by_name;
  for (int j = 0; j < Count(joints); ++j) by_name.try_emplace(BareName(At(joints, j).name), j);
  return by_name;
}

constexpr float kSlides = 0.15f;  // of the walking speed: what soles may slide before feet are set anew
constexpr float kPlanted = 0.5f;  // of the slide before, that may be left then
// Legs, hips, what they hang on, and limbs that hang on neither: the joints that PlantFeet moves.
std::vector<bool> SteppingJoints(const Rig& rig) {
  std::vector<bool> above_legs(rig.joints.size(), false), on_hips(rig.joints.size(), false);
  for (const RigLeg& leg : rig.legs) {
    for (const int from : {leg.upper, leg.lower, leg.foot, leg.toes}) {
      for (int a = from; a >= 0; a = At(rig.joints, a).parent) At(above_legs, a) = true;
    }
  }
  for (size_t j = 0; j < on_hips.size(); ++j) {
    const int parent = rig.joints[j].parent;
    on_hips[j] = parent >= 0 && (parent == rig.humanoid.hips || At(on_hips, parent));
  }
  std::vector<bool> stepping(rig.joints.size());
  for (size_t j = 0; j < stepping.size(); ++j) stepping[j] = above_legs[j] || !on_hips[j];
  return stepping;
}

constexpr float kSameTurn_rad = 0.09f;  // between the rests of two joints that are the same
constexpr float kSameLength = 0.03f;    // of the skeleton's mean bone, how much one may be off
constexpr float kMostJoints = 0.9f;     // of the target's, that the source must have

}  // namespace

std::string BareName(const std::string& name) {
  const size_t space = name.find_last_of("|:");
  return space == std::string::npos || space + 1 == name.size() ? name : name.substr(space + 1);
}

bool SameSkeleton(const std::vector<Joint>& source, const std::vector<Joint>& target, float* scale) {
  const std::map<std::string, int> by_name = ByName(source);
  std::vector<float> ratios, off_rad;
  std::vector<std::pair<Vec3, Vec3>> bones;
  for (const Joint& joint : target) {
    const auto found = by_name.find(BareName(joint.name));
    if (found == by_name.end()) continue;
    const Joint& other = At(source, found->second);
    const bool rooted = joint.parent < 0 || other.parent < 0;
    if (!rooted && BareName(At(target, joint.parent).name) != BareName(At(source, other.parent).name)) continue;
    if (!rooted) off_rad.push_back(AngleOf(Product(Conjugate(joint.rest.rotation), other.rest.rotation)));
    if (!rooted) bones.emplace_back(joint.rest.translation, other.rest.translation);
    if (rooted) off_rad.push_back(0);
  }
  if (static_cast<float>(off_rad.size()) < kMostJoints * static_cast<float>(target.size())) return false;
  float own = 0, theirs = 0;
  for (const auto& [a, b] : bones) own += Length(a), theirs += Length(b);
  if (!(own > 0) || !(theirs > 0)) return false;
  *scale = own / theirs;
  const float mean = own / static_cast<float>(bones.size());
  for (const auto& [a, b] : bones) {
    if (Length(a - b * *scale) > kSameLength * (Length(a) + mean)) return false;
  }
  return std::all_of(off_rad.begin(), off_rad.end(), [](float off) { return off < kSameTurn_rad; });
}

int CopyClip(const std::vector<Joint>& source, const Clip& clip, const std::vector<Joint>& target, Clip* copied) {
  const std::map<std::string, int> by_name = ByName(source);
  std::vector<int> from(target.size(), -1);
  float own = 0, theirs = 0;
  int found = 0;
  for (size_t j = 0; j < target.size(); ++j) {
    const auto known = by_name.find(BareName(target[j].name));
    if (known == by_name.end()) continue;
    from[j] = known->second;
    ++found;
    own += Length(target[j].rest.translation), theirs += Length(At(source, from[j]).rest.translation);
  }
  const float scale = own > 0 && theirs > 0 ? own / theirs : 1;
  *copied = {clip.name, clip.duration_s, clip.keys, {}};
  for (int k = 0; k < clip.keys; ++k) {
    for (size_t j = 0; j < target.size(); ++j) {
      Transform t = target[j].rest;
      if (from[j] >= 0) {
        const Transform& rest = At(source, from[j]).rest;
        const Transform& now = clip.transforms[static_cast<size_t>(k) * source.size() + static_cast<size_t>(from[j])];
        t.rotation = Normalized(Product(t.rotation, Product(Conjugate(rest.rotation), now.rotation)));
        const Quat turned = Product(target[j].rest.rotation, Conjugate(rest.rotation));
        t.translation = t.translation + Rotated(turned, now.translation - rest.translation) * scale;
        t.scale = now.scale;
      }
      copied->transforms.push_back(t);
    }
  }
  return found;
}

Retargeted Retarget(const Rig& source, const Clip& clip, const Rig& target, const RetargetOptions& options) {
  return Retargeter(source, clip, target, options).Make(clip);
}

float SlideOfWalk(const Rig& rig, const Clip& walk) { return Retarget(rig, walk, rig, {.walks = true}).source_slide; }

bool PlantFeet(const Rig& rig, Retargeted* walk) {
  if (rig.humanoid.by_shape || !BendsKnees(rig) || walk->clip.keys < 3) return false;
  Retargeted planted = Retarget(rig, walk->clip, rig, {.walks = true});
  if (planted.source_slide < kSlides || !(planted.walk_speed_mps > 0)) return false;
  if (SlideOfWalk(rig, planted.clip) > kPlanted * planted.source_slide) return false;
  const std::vector<bool> stepping = SteppingJoints(rig);
  for (size_t i = 0; i < planted.clip.transforms.size(); ++i) {
    const size_t joint = i % rig.joints.size(), key = i / rig.joints.size();
    const size_t last = static_cast<size_t>(walk->clip.keys) - 1;
    if (!stepping[joint])
      planted.clip.transforms[i] = walk->clip.transforms[std::min(key, last) * rig.joints.size() + joint];
  }
  planted.clip.name = walk->clip.name;
  *walk = std::move(planted);
  return true;
}

}  // namespace flaneur
