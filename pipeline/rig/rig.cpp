#include "pipeline/rig/rig.h"

#include <algorithm>
#include <cmath>

#include "pipeline/core/rotation.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

constexpr float kOwnWeight = 0.4f;      // a vertex of the sole hangs on its foot by as much
constexpr float kSoleBand = 0.05f;      // of the leg's length, above its lowest point
constexpr size_t kSoleDirections = 16;  // that the sole's outline is kept in
constexpr std::array<float, 6> kPitches_deg{-90, -60, -35, 35, 60, 90};  // in which the foot's tips are looked for
constexpr float kAnkleHeight = 0.09f;                                    // of the leg's length, where nothing tells
constexpr int kPoses = 16;                                               // of a clip, whose mean tells how it stands
constexpr float kOwnPart = 0.6f;        // a vertex that tells how its foot or toes lie hangs on them by as much
constexpr float kLying_rad = 1.1f;      // of a shin: whose foot stands on nothing
constexpr float kFlatBand = 0.02f;      // of the leg's length, that a sole on the ground is uneven by
constexpr float kShortestSole = 0.04f;  // of the leg's length
constexpr float kFlatShare = 0.4f;      // of the part's length, that its sole's flat takes at least
constexpr float kAhead = 0.5f;          // of 1: how far toes point ahead that tell where their foot does
constexpr float kLevel_rad = 0.2f, kSteepest_rad = 1.4f;  // of a sole that is turned level
constexpr float kLies = 0.7f;         // of 1: how far ahead a thigh points that is no longer upright
constexpr float kFolded = 0.92f;      // cosine of a knee's bend that tells its hinge better than the front does
constexpr float kBent = 0.35f;        // sine of a knee's bend that tells its hinge
constexpr float kUpright = 0.6f;      // of 1: how far up the trunk of who walks points
constexpr float kShortestLeg = 0.2f;  // of the trunk's length
constexpr float kMinAnkle = 0.03f, kMaxAnkle = 0.25f;            // of the leg's length: where y = 0 may be the ground
constexpr float kBall = 0.19f, kToeTip = 0.27f, kHeel = -0.06f;  // of the leg's length, before the ankle

Vec3 InFrame(const Pose& pose, int joint, Vec3 place) {
  return Rotated(Conjugate(At(pose.rotations, joint)), place - At(pose.positions, joint));
}

// Of the longest edge that `points` (ahead, up) can stand on. False where it is shorter than `least`, or they are
// round.
bool SlopeBelow(std::vector<Vec2> points, float least, float* slope_rad) {
  if (points.empty()) return false;
  std::sort(points.begin(), points.end(), [](Vec2 a, Vec2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  std::vector<Vec2> hull;
  for (const Vec2 p : points) {
    const auto turns_up = [&] {
      const Vec2 a = hull[hull.size() - 2], b = hull.back();
      return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) > 0;
    };
    while (hull.size() > 1 && !turns_up()) hull.pop_back();
    hull.push_back(p);
  }
  float longest = std::max(least, kFlatShare * (hull.back().x - hull[0].x));
  bool found = false;
  for (size_t i = 1; i < hull.size(); ++i) {
    const float ahead = hull[i].x - hull[i - 1].x, up = hull[i].y - hull[i - 1].y, length = std::hypot(ahead, up);
    if (length > longest) found = true, longest = length, *slope_rad = std::atan2(up, ahead);
  }
  return found;
}

class RigMaker {
 public:
  RigMaker(const Avatar& person, Rig* rig) : person_(person), rig_(*rig) {}

  void Make() {
    for (const size_t side : {kLeft, kRight}) MakeLeg(side);
    rig_.leg_m = 0.5f * (rig_.legs[kLeft].thigh_m + rig_.legs[kLeft].shin_m + rig_.legs[kRight].thigh_m +
                         rig_.legs[kRight].shin_m);
    for (const RigLeg& leg : rig_.legs) {
      if (leg.foot < 0 || leg.lower < 0) continue;
      const Quat upright = ArcBetween(Place(leg.foot) - Place(leg.lower), {0, -1, 0});
      if (AngleOf(upright) < kLying_rad && StandsFlat(leg.foot)) continue;
      Level(leg.foot, leg.toes, upright);
      if (leg.toes >= 0) Level(leg.toes, -1, {});
    }
    for (const size_t side : {kLeft, kRight}) MakeSole(side);
    PutOnGround();
    for (const size_t side : {kLeft, kRight}) {
      MakeArm(side);
      const RigLeg& leg = rig_.legs[side];
      const Vec3 knee = leg.lower >= 0 ? Place(leg.lower) : PlaceOf(leg.ankle, rig_.reference);
      const Vec3 thigh = knee - Place(leg.upper), shin = PlaceOf(leg.ankle, rig_.reference) - knee;
      rig_.leg_upper[side] = LegFrame(thigh, FrontOfLeg(thigh, thigh, shin));
      rig_.leg_lower[side] = leg.lower < 0 ? rig_.leg_upper[side] : LegFrame(shin, FrontOfLeg(shin, thigh, shin));
    }
  }

 private:
  Vec3 Place(int joint) const { return At(rig_.reference.positions, joint); }

  // Of the thigh or the shin. Knees point ahead in a bind pose that stands; of who is bound seated or running they turn
  // about the hinge that they are bent about or, where they are straight, the thighs were raised about.
  static Vec3 FrontOfLeg(Vec3 part, Vec3 thigh, Vec3 shin) {
    const Vec3 along = Normalized(thigh), below = Normalized(shin);
    const Vec3 bent = Cross(along, below);
    const bool lies = along.z > kLies, folded = Dot(along, below) < kFolded;
    if ((lies || folded) && bent.x > kBent) return Cross(bent, part * -1);
    return lies ? Cross(Cross(along, {0, -1, 0}), part * -1) : Vec3{0, 0, 1};
  }

  void MakeLeg(size_t side) {
    const HumanoidLeg& h = rig_.humanoid.legs[side];
    RigLeg& leg = rig_.legs[side];
    leg.upper = h.upper, leg.lower = h.lower, leg.foot = h.foot, leg.toes = h.toes;
    const Vec3 hip = Place(leg.upper);
    if (leg.foot >= 0 && leg.lower >= 0) {
      leg.ankle = {leg.foot, {}};
    } else {
      const int last = leg.lower >= 0 ? leg.lower : leg.upper;
      leg.foot = leg.toes = -1;
      const Vec3 from = Place(last);
      const float bottom = LowestOf(last, from);
      leg.ankle = {last, InFrame(rig_.reference, last, {from.x, bottom + kAnkleHeight * (hip.y - bottom), from.z})};
    }
    const Vec3 ankle = PlaceOf(leg.ankle, rig_.reference);
    const Vec3 knee = leg.lower >= 0 ? Place(leg.lower) : ankle;
    leg.thigh_m = Length(knee - hip);
    leg.shin_m = leg.lower >= 0 ? Length(ankle - knee) : 0;
  }

  // Calls with the place of every vertex that hangs on the joint or on what is below it, and its mesh and number.
  template <typename Use>
  void ForOwnVertices(int joint, Use use) const {
    const std::vector<bool> own = Below(joint);
    for (const Mesh& mesh : person_.meshes) {
      for (size_t v = 0; v < mesh.joints.size(); ++v) {
        if (WeightOn(own, mesh, v) < kOwnWeight) continue;
        Vec3 place = Rotated(rig_.turn, mesh.positions[v]) + rig_.shift;
        for (const Levelled& part : levelled_) {
          const Vec3 arm = place - Place(part.joint);
          place = place + (Rotated(part.turn, arm) - arm) * WeightOn(part.below, mesh, v);
        }
        use(place, mesh, v);
      }
    }
  }

  // Whether half of the foot's length, toes and all, is on the ground that its lowest point is on.
  bool StandsFlat(int foot) const {
    std::vector<Vec2> outline;  // ahead, up
    ForOwnVertices(foot, [&](Vec3 place, const Mesh&, size_t) { outline.push_back({place.z, place.y}); });
    const auto length_below = [&](float height) {
      float back = 1e30f, front = -1e30f;
      for (const Vec2 p : outline) {
        if (p.y <= height) back = std::min(back, p.x), front = std::max(front, p.x);
      }
      return front - back;
    };
    float lowest = 1e30f;
    for (const Vec2 p : outline) lowest = std::min(lowest, p.y);
    return outline.empty() || length_below(lowest + kFlatBand * rig_.leg_m) > 0.5f * length_below(1e30f);
  }

  // Feet of who is bound in a stride stand on their toes or their heels, or are in the air behind: turns the part that
  // its sole lies level, in the reference pose and in what is read of the meshes. `upright` first: what brings the shin
  // upright. `toes`: a part of its own that hangs on it, -1: none.
  void Level(int joint, int toes, Quat upright) {
    std::vector<bool> below = Below(joint), part = below;
    for (int j = 0; toes >= 0 && j < Count(rig_.joints); ++j) {
      if (IsBelow(rig_.joints, j, toes)) At(part, j) = false;
    }
    const Vec3 pivot = Place(joint);
    Vec3 ahead = toes >= 0 ? Rotated(upright, Place(toes) - pivot) : Vec3{0, 0, 1};
    ahead = Normalized(Vec3{ahead.x, 0, ahead.z});
    if (!(ahead.z > kAhead)) ahead = {0, 0, 1};
    std::vector<Vec2> outline;
    ForOwnVertices(joint, [&](Vec3 place, const Mesh& mesh, size_t v) {
      const Vec3 arm = Rotated(upright, place - pivot);
      if (WeightOn(part, mesh, v) > kOwnPart) outline.push_back({Dot(arm, ahead), arm.y});
    });
    float slope_rad = 0;
    if (!SlopeBelow(std::move(outline), kShortestSole * rig_.leg_m, &slope_rad)) return;
    const Quat turn = Product(TurnAbout(Cross({0, 1, 0}, ahead), slope_rad), upright);
    if (std::abs(slope_rad) > kSteepest_rad || AngleOf(turn) < kLevel_rad) return;
    for (int j = 0; j < Count(rig_.joints); ++j) {
      if (!At(below, j)) continue;
      Vec3& place = At(rig_.reference.positions, j);
      place = pivot + Rotated(turn, place - pivot);
      At(rig_.reference.rotations, j) = Normalized(Product(turn, At(rig_.reference.rotations, j)));
    }
    levelled_.push_back({joint, std::move(below), turn});
  }

  std::vector<bool> Below(int joint) const {
    std::vector<bool> below(rig_.joints.size());
    for (int j = 0; j < Count(rig_.joints); ++j) At(below, j) = IsBelow(rig_.joints, j, joint);
    return below;
  }

  float LowestOf(int joint, Vec3 otherwise) const {
    float lowest = 1e30f;
    ForOwnVertices(joint, [&](Vec3 place, const Mesh&, size_t) { lowest = std::min(lowest, place.y); });
    if (lowest < 1e29f) return lowest;
    const float ground = -rig_.shift.y;  // the file's own, where the leg stands on it
    if (otherwise.y - ground > kShortestLeg * TrunkLength()) return ground;
    for (int j = 0; j < Count(rig_.joints); ++j) {
      if (IsBelow(rig_.joints, j, joint)) lowest = std::min(lowest, Place(j).y);
    }
    return std::min(lowest, otherwise.y - 1e-3f);
  }

  float TrunkLength() const {
    const Humanoid& h = rig_.humanoid;
    const int top = h.head >= 0 ? h.head : h.arms[kLeft].upper;
    return top < 0 ? 0 : Length(Place(top) - Place(h.hips));
  }

  // The outlines of what is lowest of the foot and of its toes, else what a foot of that length would have.
  void MakeSole(size_t side) {
    RigLeg& leg = rig_.legs[side];
    const Vec3 ankle = PlaceOf(leg.ankle, rig_.reference);
    float lowest = 1e30f;
    ForOwnVertices(leg.ankle.joint, [&](Vec3 place, const Mesh&, size_t) { lowest = std::min(lowest, place.y); });
    if (lowest > ankle.y) return SoleOfBones(&leg, ankle);
    const std::vector<bool> toes = leg.toes >= 0 ? Below(leg.toes) : std::vector<bool>(rig_.joints.size(), false);
    std::vector<bool> foot = Below(leg.ankle.joint), shin(rig_.joints.size(), false);
    if (leg.foot >= 0) At(shin, leg.lower) = true;
    for (const bool on_toes : {false, true}) {
      std::array<FarPoint, kSoleDirections> outline;
      ForOwnVertices(leg.ankle.joint, [&](Vec3 place, const Mesh& mesh, size_t v) {
        const float toes_weight = WeightOn(toes, mesh, v), foot_weight = WeightOn(foot, mesh, v);
        if (place.y > lowest + kSoleBand * rig_.leg_m || (toes_weight > 0.5f * foot_weight) != on_toes) return;
        const float shin_weight = WeightOn(shin, mesh, v), all = foot_weight + shin_weight;
        Extend({0, place, toes_weight / all, shin_weight / all}, &outline);
      });
      for (const FarPoint& far : outline) {
        if (far.reach > -1e29f) leg.sole.push_back(SolePointAt(leg, far));
      }
    }
    MakeTips(toes, foot, shin, &leg);
    leg.ankle_height_m = ankle.y - lowest;
  }

  void MakeTips(const std::vector<bool>& toes, const std::vector<bool>& foot, const std::vector<bool>& shin,
                RigLeg* leg) const {
    std::array<FarPoint, kPitches_deg.size()> tips;
    ForOwnVertices(leg->ankle.joint, [&](Vec3 place, const Mesh& mesh, size_t v) {
      const float foot_weight = WeightOn(foot, mesh, v), shin_weight = WeightOn(shin, mesh, v);
      const float all = foot_weight + shin_weight;
      for (size_t i = 0; i < tips.size(); ++i) {
        const float pitch = kPitches_deg[i] * kPi / 180;
        const float reach = place.z * std::sin(pitch) - place.y * std::cos(pitch);
        if (reach > tips[i].reach) tips[i] = {reach, place, WeightOn(toes, mesh, v) / all, shin_weight / all};
      }
    });
    for (const FarPoint& tip : tips) leg->tips.push_back(SolePointAt(*leg, tip));
  }

  struct FarPoint {
    float reach = -1e30f;
    Vec3 place;
    float toes_weight = 0, shin_weight = 0;
  };

  static void Extend(FarPoint far, std::array<FarPoint, kSoleDirections>* outline) {
    for (size_t d = 0; d < kSoleDirections; ++d) {
      const float angle = 2 * kPi * static_cast<float>(d) / kSoleDirections;
      // Of two as far out the lower one is the sole's.
      far.reach = far.place.x * std::cos(angle) + far.place.z * std::sin(angle) - 2 * far.place.y;
      if (far.reach > (*outline)[d].reach) (*outline)[d] = far;
    }
  }

  SolePoint SolePointAt(const RigLeg& leg, const FarPoint& far) const {
    const auto on = [&](int joint) { return JointPoint{joint, InFrame(rig_.reference, joint, far.place)}; };
    SolePoint point{on(leg.ankle.joint), {}, {}, far.toes_weight, far.shin_weight};
    if (far.toes_weight > 0) point.toes = on(leg.toes);
    if (far.shin_weight > 0) point.shin = on(leg.lower);
    return point;
  }

  void SoleOfBones(RigLeg* leg, Vec3 ankle) const {
    Vec3 way{0, 0, kBall * rig_.leg_m};
    float lowest = ankle.y;
    Vec3 tip;
    for (int j = 0; leg->foot >= 0 && j < Count(rig_.joints); ++j) {
      if (!IsBelow(rig_.joints, j, leg->foot)) continue;
      lowest = std::min(lowest, Place(j).y);
      if (Length(Place(j) - ankle) > Length(tip)) tip = Place(j) - ankle;
    }
    tip.y = 0;
    if (leg->toes >= 0) way = Place(leg->toes) - ankle;
    else if (Length(tip) > 0.5f * kBall * rig_.leg_m) way = tip * 0.75f;
    way.y = 0;
    const float length = Length(way) / kBall;
    const Vec3 ahead = Normalized(way);
    // The file's own ground, where it is one; else soles are a little below the lowest bone.
    const float at_zero = ankle.y + InOwnSpace();
    float height = ankle.y - lowest + 0.02f * rig_.leg_m;
    if (height < kMinAnkle * rig_.leg_m || leg->toes < 0) height = std::max(height, kAnkleHeight * rig_.leg_m);
    if (at_zero > kMinAnkle * rig_.leg_m && at_zero < kMaxAnkle * rig_.leg_m) height = at_zero;
    leg->ankle_height_m = height;
    const Vec3 across = Cross({0, 1, 0}, ahead) * (0.05f * rig_.leg_m);
    for (const float along : {kHeel, kBall, kToeTip}) {
      for (const float side : {-1.0f, 1.0f}) {
        Vec3 place = ankle + ahead * (along * length) + across * side;
        place.y = ankle.y - height;
        leg->sole.push_back(SolePointAt(*leg, {0, place, along > kBall && leg->toes >= 0 ? 1.0f : 0.0f, 0}));
      }
    }
  }

  // Added to a reference height it gives the height in the file.
  float InOwnSpace() const { return -rig_.shift.y; }

  void PutOnGround() {
    float ground = 0;
    for (const RigLeg& leg : rig_.legs) {
      ground += 0.5f * (PlaceOf(leg.ankle, rig_.reference).y - leg.ankle_height_m);
    }
    const Vec3 middle = (Place(rig_.legs[kLeft].upper) + Place(rig_.legs[kRight].upper)) * 0.5f;
    const Vec3 by{-middle.x, -ground, -middle.z};
    rig_.shift = rig_.shift + by;
    for (Vec3& p : rig_.reference.positions) p = p + by;
  }

  void MakeArm(size_t side) {
    const HumanoidArm& h = rig_.humanoid.arms[side];
    if (h.upper < 0) return;
    RigArm& arm = rig_.arms[side];
    const Vec3 out{side == kLeft ? 1.0f : -1.0f, 0, 0};
    const int next = h.lower >= 0 ? h.lower : h.hand;
    const Vec3 way = next >= 0 ? Place(next) - Place(h.upper) : EndOf(h.upper) - Place(h.upper);
    arm.upper = ArcBetween(out, way);
    const Vec3 fore = h.lower >= 0 && h.hand >= 0 ? Place(h.hand) - Place(h.lower) : way;
    arm.lower = Product(ArcBetween(way, fore), arm.upper);
    arm.hand = arm.lower;
    if (h.hand < 0) return;
    const auto knuckle = [&](size_t finger) { return h.fingers[finger].empty() ? -1 : h.fingers[finger].front(); };
    const int middle = knuckle(2) >= 0 ? knuckle(2) : knuckle(1);
    if (middle < 0) return;
    const Vec3 along = Place(middle) - Place(h.hand);
    arm.hand = Product(ArcBetween(fore, along), arm.lower);
    const int first = knuckle(1) >= 0 ? knuckle(1) : middle, last = knuckle(4) >= 0 ? knuckle(4) : knuckle(3);
    if (last < 0 || first == last) return;
    // The knuckles from the little finger to the first go where the T-pose has +Z.
    Vec3 across = Place(first) - Place(last);
    across = Normalized(across - Normalized(along) * Dot(Normalized(along), across));
    if (Length(across) > 0.5f) arm.hand = Product(ArcBetween(Rotated(arm.hand, {0, 0, 1}), across), arm.hand);
  }

  // Of a one-bone arm, by what hangs on it.
  Vec3 EndOf(int joint) const {
    Vec3 sum;
    float count = 0;
    ForOwnVertices(joint, [&](Vec3 place, const Mesh&, size_t) { sum = sum + place, count += 1; });
    return count > 0 ? sum * (1 / count) : Place(joint) + Vec3{0, -1, 0};
  }

  struct Levelled {
    int joint;
    std::vector<bool> below;  // it, and itself
    Quat turn;
  };

  const Avatar& person_;
  Rig& rig_;
  std::vector<Levelled> levelled_;
};

}  // namespace

Pose PoseOf(const std::vector<Joint>& joints, const Transform* transforms) {
  Pose pose;
  std::vector<Mat4> world(joints.size());
  for (size_t j = 0; j < joints.size(); ++j) {
    const Transform& t = transforms[j];
    const Mat4 local = FromTranslationRotationScale(t.translation, t.rotation, t.scale);
    world[j] = joints[j].parent < 0 ? local : At(world, joints[j].parent) * local;
    pose.positions.push_back(TransformPoint(world[j], {}));
    pose.rotations.push_back(RotationOf(world[j]));
  }
  return pose;
}

Pose BindPose(const std::vector<Joint>& joints) {
  Pose pose;
  for (const Joint& joint : joints) {
    const Mat4 bind = Inverse(joint.inverse_bind);
    pose.positions.push_back(TransformPoint(bind, {}));
    pose.rotations.push_back(RotationOf(bind));
  }
  return pose;
}

void TurnPose(Quat turn, Pose* pose) {
  for (Vec3& p : pose->positions) p = Rotated(turn, p);
  for (Quat& q : pose->rotations) q = Product(turn, q);
}

Vec3 PlaceOf(const JointPoint& point, const Pose& pose) {
  return At(pose.positions, point.joint) + Rotated(At(pose.rotations, point.joint), point.offset);
}

Vec3 PlaceOf(const SolePoint& point, const Pose& pose) {
  Vec3 place = PlaceOf(point.foot, pose) * (1 - point.toes_weight - point.shin_weight);
  if (point.toes_weight > 0) place = place + PlaceOf(point.toes, pose) * point.toes_weight;
  if (point.shin_weight > 0) place = place + PlaceOf(point.shin, pose) * point.shin_weight;
  return place;
}

Quat QuarterTurn(Vec3 up, Vec3 forward) {
  const std::array<Vec3, 6> axes = {Vec3{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  Vec3 best_up{0, 1, 0}, best_forward{0, 0, 1};
  float best = -1e30f;
  for (const Vec3 u : axes) {
    for (const Vec3 f : axes) {
      if (std::abs(Dot(u, f)) > 0.5f) continue;
      const float fits = 2 * Dot(u, up) + Dot(f, forward);
      if (fits > best + 1e-4f) best = fits, best_up = u, best_forward = f;
    }
  }
  return Normalized(Conjugate(QuatFromBasis(Cross(best_up, best_forward), best_up, best_forward)));
}

Quat TurnToFront(Vec3 up, Vec3 forward, float least_rad) {
  const Quat quarters = QuarterTurn(up, forward);
  const Vec3 ahead = Rotated(quarters, forward);
  const float left_rad = std::atan2(ahead.x, ahead.z);
  return std::abs(left_rad) > least_rad ? Product(TurnAbout({0, 1, 0}, -left_rad), quarters) : quarters;
}

Quat LegFrame(Vec3 along, Vec3 front) {
  const Vec3 y = Normalized(along) * -1;
  Vec3 z = front - y * Dot(front, y);
  if (!(Length(z) > 1e-4f)) z = Cross(Vec3{1, 0, 0}, y);
  z = Normalized(z);
  return Normalized(QuatFromBasis(Cross(y, z), y, z));
}

float HighestHip(const RigLeg& leg, Vec3 off) {
  const float reach = kStraightest * (leg.thigh_m + leg.shin_m);
  return std::sqrt(std::max(reach * reach - off.x * off.x - off.z * off.z, 0.01f * reach * reach));
}

Pose PoseAt(const Rig& rig, const Clip& clip, int key) {
  Pose pose = PoseOf(rig.joints, clip.transforms.data() + static_cast<size_t>(key) * rig.joints.size());
  TurnPose(rig.turn, &pose);
  return pose;
}

bool FindStance(const Humanoid& humanoid, const std::vector<Joint>& joints, const Clip& clip, Vec3* up, Vec3* forward) {
  Vec3 ups, forwards;
  for (int i = 0; i < kPoses; ++i) {
    const size_t key = static_cast<size_t>(i * (clip.keys - 1) / kPoses);
    const Pose pose = PoseOf(joints, clip.transforms.data() + key * joints.size());
    Vec3 u, f;
    if (FindStance(humanoid, pose.positions, &u, &f)) ups = ups + u, forwards = forwards + f;
  }
  if (Length(ups) < 0.7f * kPoses) return false;
  *up = Normalized(ups);
  *forward = Normalized(forwards);
  return true;
}

Quat HeadingOf(const Rig& rig, const Clip& clip) {
  Vec3 up, forward;
  if (!FindStance(rig.humanoid, rig.joints, clip, &up, &forward)) return {};
  up = Rotated(rig.turn, up), forward = Rotated(rig.turn, forward);
  const float heading_rad = std::atan2(forward.x, forward.z);
  if (std::abs(heading_rad) < kSways_rad || up.y < kUpright) return {};
  return Product(Conjugate(rig.turn), Product(TurnAbout({0, 1, 0}, heading_rad), rig.turn));
}

bool BendsKnees(const Rig& rig) { return rig.legs[kLeft].shin_m > 0 && rig.legs[kRight].shin_m > 0; }

bool MakeRig(const Avatar& person, const std::vector<NamedBone>& told, Rig* rig, std::string* why) {
  *rig = {};
  rig->joints = person.joints;
  rig->reference = BindPose(person.joints);
  if (!FindHumanoid(person.joints, rig->reference.positions, told, &rig->humanoid, why)) return false;
  if (rig->humanoid.quadruped) {
    *why = "it goes on four legs";
    return false;
  }
  Vec3 up, forward;
  if (!FindStance(rig->humanoid, rig->reference.positions, &up, &forward)) {
    *why = "its limbs all lie at one place";
    return false;
  }
  rig->turn = TurnToFront(up, forward);
  TurnPose(rig->turn, &rig->reference);
  RigMaker(person, rig).Make();
  if (rig->leg_m > 1e-6f) return true;
  *why = "its legs have no length";
  return false;
}

}  // namespace flaneur
