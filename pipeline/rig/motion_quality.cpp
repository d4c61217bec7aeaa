#include "pipeline/rig/motion_quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

#include "pipeline/core/rotation.h"
#include "pipeline/rig/steps.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

constexpr size_t kTrunkPoints = 2000, kArmPoints = 300, kFootPoints = 20000;  // that are looked at
constexpr float kSoleBand = 0.024f;  // of the leg's length, about 2 cm: how near the ground a sole is on it
constexpr float kFarthest = 0.12f;   // of the leg's length: deeper than that is another side of the body
constexpr float kClear = 0.006f;     // of the leg's length: a hand may be so deep
constexpr float kMostOpen_deg = 45, kOpenStep_deg = 3;
constexpr float kWidest = 0.08f, kWiderStep = 0.01f;  // of the leg's length: how much farther out each foot may be set
constexpr int kKeys = 8, kLegKeys = 24;               // moments of a clip that are looked at
// What human joints bend to, least and most; mocap's own errors keep within.
constexpr float kKnee_deg[] = {-5, 160}, kElbow_deg[] = {-15, 160}, kAnkle_deg[] = {-50, 75};  // ankle: toes down

float Median(std::vector<float> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Which joints move what: trunk with thighs, or one arm from the elbow.
std::vector<bool> TrunkJoints(const Rig& rig) {
  std::vector<bool> trunk(rig.joints.size(), false);
  const Humanoid& h = rig.humanoid;
  At(trunk, h.hips) = true;
  for (const int joint : h.spine) At(trunk, joint) = true;
  for (const HumanoidLeg& leg : h.legs) At(trunk, leg.upper) = true;
  return trunk;
}

std::vector<bool> ArmJoints(const Rig& rig, size_t side) {
  std::vector<bool> arm(rig.joints.size(), false);
  const HumanoidArm& h = rig.humanoid.arms[side];
  const int from = h.lower >= 0 ? h.lower : h.upper;
  for (int j = 0; j < Count(rig.joints) && from >= 0; ++j) {
    At(arm, j) = IsBelow(rig.joints, j, from) || (h.hand >= 0 && IsBelow(rig.joints, j, h.hand));
  }
  return arm;
}

// From the knee.
std::vector<bool> LegJoints(const Rig& rig, size_t side) {
  std::vector<bool> leg(rig.joints.size(), false);
  const RigLeg& h = rig.legs[side];
  const int from = h.lower >= 0 ? h.lower : h.upper;
  for (int j = 0; j < Count(rig.joints); ++j) {
    At(leg, j) = IsBelow(rig.joints, j, from) || (h.foot >= 0 && IsBelow(rig.joints, j, h.foot));
  }
  return leg;
}

// What is below the ankles.
std::vector<bool> FootJoints(const Rig& rig) {
  std::vector<bool> feet(rig.joints.size(), false);
  for (int j = 0; j < Count(rig.joints); ++j) {
    for (const RigLeg& leg : rig.legs) At(feet, j) = At(feet, j) || IsBelow(rig.joints, j, leg.ankle.joint);
  }
  return feet;
}

void AddPoint(const Mesh& from, size_t v, Mesh* points) {
  points->positions.push_back(from.positions[v]);
  points->normals.push_back(from.normals[v]);
  points->joints.push_back(from.joints[v]);
  points->weights.push_back(from.weights[v]);
}

// One point where several vertices lie, with the mean of their normals, in an order of place: the same for a figure
// whatever its edges, materials and meshes split, and in whatever order.
Mesh Welded(const Mesh& mesh) {
  std::vector<size_t> order(mesh.positions.size());
  std::iota(order.begin(), order.end(), 0);
  const auto place = [&](size_t v) { return std::tie(mesh.positions[v].x, mesh.positions[v].y, mesh.positions[v].z); };
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return place(a) < place(b); });
  Mesh welded;
  for (const size_t v : order) {
    const bool same = !welded.positions.empty() && Length(welded.positions.back() - mesh.positions[v]) == 0;
    if (same) welded.normals.back() = welded.normals.back() + mesh.normals[v];
    else AddPoint(mesh, v, &welded);
  }
  for (Vec3& normal : welded.normals) normal = Normalized(normal);
  return welded;
}

// Where vertices hang mostly on these joints, thinned to `most`.
Mesh PointsOn(const Avatar& person, const std::vector<bool>& joints, size_t most) {
  Mesh all;
  for (const Mesh& mesh : person.meshes) {
    for (size_t v = 0; v < mesh.joints.size(); ++v) {
      if (WeightOn(joints, mesh, v) >= 0.6f) AddPoint(mesh, v, &all);
    }
  }
  all = Welded(all);
  Mesh thin;
  const size_t step = 1 + all.positions.size() / most;
  for (size_t v = 0; v < all.positions.size(); v += step) AddPoint(all, v, &thin);
  return thin;
}

// How deep a point lies behind the surface that its nearest trunk point is on.
float DepthOf(Vec3 point, const Mesh& trunk, float farthest) {
  float nearest = 1e30f, depth = 0;
  for (size_t v = 0; v < trunk.positions.size(); ++v) {
    const Vec3 off = point - trunk.positions[v];
    const float distance = Dot(off, off);
    if (distance >= nearest) continue;
    nearest = distance;
    depth = -Dot(off, trunk.normals[v]);
  }
  return nearest < farthest * farthest ? std::max(depth, 0.0f) : 0;
}

float DeepestIn(const Mesh& body, const std::vector<Vec3>& points, float farthest) {
  float deepest = 0;
  for (const Vec3 p : points) deepest = std::max(deepest, DepthOf(p, body, farthest));
  return deepest;
}

struct ArmOverClip {
  std::vector<Mesh> trunks;  // a key each
  std::vector<std::vector<Vec3>> arms;
  std::vector<Vec3> shoulders;
};

ArmOverClip Sampled(const Avatar& person, const Rig& rig, const Clip& clip, size_t side, int keys) {
  const Mesh trunk = PointsOn(person, TrunkJoints(rig), kTrunkPoints);
  const Mesh arm = PointsOn(person, ArmJoints(rig, side), kArmPoints);
  ArmOverClip sampled;
  for (int k = 0; k < keys; ++k) {
    const float time_s = clip.duration_s * static_cast<float>(k) / static_cast<float>(keys);
    const std::vector<Mat4> pose = SkinningMatrices(person, clip, time_s);
    sampled.trunks.push_back(Skinned(trunk, pose));
    sampled.arms.push_back(SkinnedPositions(arm, pose));
    const int upper = rig.humanoid.arms[side].upper;
    const Vec3 at = TransformPoint(Inverse(At(person.joints, upper).inverse_bind), {});
    sampled.shoulders.push_back(TransformPoint(At(pose, upper), at));
  }
  return sampled;
}

float Deepest(const ArmOverClip& sampled, Vec3 axis, float angle_rad, float farthest, float enough) {
  const Quat turn = TurnAbout(axis, angle_rad);
  float deepest = 0;
  for (size_t k = 0; k < sampled.arms.size(); ++k) {
    for (const Vec3 p : sampled.arms[k]) {
      const Vec3 turned = sampled.shoulders[k] + Rotated(turn, p - sampled.shoulders[k]);
      deepest = std::max(deepest, DepthOf(turned, sampled.trunks[k], farthest));
      if (deepest > enough) return deepest;
    }
  }
  return deepest;
}

void OpenArm(const Rig& rig, int upper, Quat turn, Clip* clip) {
  const size_t joints = rig.joints.size();
  const int parent = At(rig.joints, upper).parent;
  for (int k = 0; k < clip->keys; ++k) {
    Transform* key = clip->transforms.data() + static_cast<size_t>(k) * joints;
    const Pose pose = PoseOf(rig.joints, key);
    const Quat above = parent < 0 ? Quat{} : At(pose.rotations, parent);
    Quat& own = key[upper].rotation;
    const Quat before = own;
    own = Normalized(Product(Conjugate(above), Product(turn, At(pose.rotations, upper))));
    if (own.x * before.x + own.y * before.y + own.z * before.z + own.w * before.w < 0)
      own = {-own.x, -own.y, -own.z, -own.w};
  }
}

// How far a bend in radians is outside what a human's does.
float Past(float bend, float least_deg, float most_deg) {
  return std::max({0.0f, least_deg * kPi / 180 - bend, bend - most_deg * kPi / 180});
}

// Of the middle of three joints; negative where the last bone goes elsewhere than `towards`.
float BendOf(Vec3 first, Vec3 middle, Vec3 last, Vec3 towards) {
  const Vec3 upper = middle - first, lower = last - middle;
  const float bend = AngleBetween(upper, lower);
  return Dot(Cross(upper, lower), Cross(upper, towards)) < 0 ? -bend : bend;
}

Quat FrameOf(const Rig& rig, const Pose& pose, int joint, Quat reference_frame) {
  return Product(Product(At(pose.rotations, joint), Conjugate(At(rig.reference.rotations, joint))), reference_frame);
}

float LegPastLimits(const Rig& rig, const Pose& pose, size_t side) {
  const RigLeg& leg = rig.legs[side];
  if (leg.lower < 0) return 0;
  const Vec3 back = Rotated(FrameOf(rig, pose, leg.upper, rig.leg_upper[side]), {0, 0, -1});
  const float knee =
      BendOf(At(pose.positions, leg.upper), At(pose.positions, leg.lower), PlaceOf(leg.ankle, pose), back);
  float past = Past(knee, kKnee_deg[0], kKnee_deg[1]);
  if (leg.foot < 0) return past;
  const Quat shin = FrameOf(rig, pose, leg.lower, rig.leg_lower[side]);
  const Vec3 ahead = Rotated(Product(Conjugate(shin), FrameOf(rig, pose, leg.foot, {})), {0, 0, 1});
  return std::max(past, Past(std::asin(std::clamp(-ahead.y, -1.0f, 1.0f)), kAnkle_deg[0], kAnkle_deg[1]));
}

float ArmPastLimits(const Rig& rig, const Pose& pose, size_t side) {
  const HumanoidArm& arm = rig.humanoid.arms[side];
  if (arm.upper < 0 || arm.lower < 0 || arm.hand < 0) return 0;
  const Vec3 front = Rotated(FrameOf(rig, pose, arm.upper, rig.arms[side].upper), {0, 0, 1});
  const float elbow =
      BendOf(At(pose.positions, arm.upper), At(pose.positions, arm.lower), At(pose.positions, arm.hand), front);
  return Past(elbow, kElbow_deg[0], kElbow_deg[1]);
}

}  // namespace

float FootSlide(const Avatar& person, const Clip& walk, float speed_mps) {
  Rig rig;
  std::string why;
  const bool human = MakeRig(person, {}, &rig, &why);
  if (!(speed_mps > 0) || walk.keys < 3) return 0;
  const float step_s = walk.duration_s / static_cast<float>(walk.keys - 1);
  const float band = kSoleBand * (human ? rig.leg_m : 0.5f * person.height_m);
  const Mesh feet =
      PointsOn(person, human ? FootJoints(rig) : std::vector<bool>(person.joints.size(), true), kFootPoints);
  std::vector<std::vector<Vec3>> keys;
  for (int k = 0; k + 1 < walk.keys; ++k) {
    keys.push_back(SkinnedPositions(feet, SkinningMatrices(person, walk, step_s * static_cast<float>(k))));
  }
  float sum = 0, count = 0;
  for (size_t k = 0; k < keys.size(); ++k) {
    const std::vector<Vec3>& next = keys[(k + 1) % keys.size()];
    std::vector<float> slides;
    for (size_t v = 0; v < next.size(); ++v) {
      if (std::max(keys[k][v].y, next[v].y) > band) continue;
      Vec3 velocity = (next[v] - keys[k][v]) * (1 / step_s);
      velocity.y = 0;
      velocity.z += speed_mps;
      slides.push_back(Length(velocity) / speed_mps);
    }
    if (!slides.empty()) sum += Median(std::move(slides)), count += 1;
  }
  return count > 0 ? sum / count : 0;
}

float HipsHeight(const Rig& rig, const Clip& walk) {
  float sum = 0;
  std::vector<float> lowest;
  for (int k = 0; k < walk.keys; ++k) {
    const Pose pose = PoseAt(rig, walk, k);
    lowest.push_back(1e30f);
    for (const RigLeg& leg : rig.legs) {
      sum += 0.5f * At(pose.positions, leg.upper).y / static_cast<float>(walk.keys);
      for (const SolePoint& point : leg.sole) lowest.back() = std::min(lowest.back(), PlaceOf(point, pose).y);
    }
  }
  const float ankle = 0.5f * (rig.legs[kLeft].ankle_height_m + rig.legs[kRight].ankle_height_m);
  return (sum - GroundUnder(lowest, rig.leg_m, BendsKnees(rig)) - ankle) / rig.leg_m;
}

float PastLimits(const Rig& rig, const Clip& clip) {
  float worst = 0;
  for (int k = 0; k < clip.keys; ++k) {
    const Pose pose = PoseAt(rig, clip, k);
    for (const size_t side : {kLeft, kRight}) {
      worst = std::max({worst, LegPastLimits(rig, pose, side), ArmPastLimits(rig, pose, side)});
    }
  }
  return worst;
}

float HandDepth(const Avatar& person, const Rig& rig, const Clip& clip, size_t side, int keys) {
  if (rig.humanoid.arms[side].upper < 0) return 0;
  return Deepest(Sampled(person, rig, clip, side, keys), {0, 0, 1}, 0, kFarthest * rig.leg_m, 1e30f);
}

float LegDepth(const Avatar& person, const Rig& rig, const Clip& clip, int keys) {
  const Mesh left = PointsOn(person, LegJoints(rig, kLeft), kTrunkPoints);
  const Mesh right = PointsOn(person, LegJoints(rig, kRight), kTrunkPoints);
  float deepest = 0;
  for (int k = 0; k < keys; ++k) {
    const float time_s = clip.duration_s * static_cast<float>(k) / static_cast<float>(keys);
    const std::vector<Mat4> pose = SkinningMatrices(person, clip, time_s);
    deepest = std::max(deepest, DeepestIn(Skinned(left, pose), SkinnedPositions(right, pose), kFarthest * rig.leg_m));
  }
  return deepest;
}

Retargeted ClearLegs(const Avatar& person, const Rig& source, const Clip& walk, const Rig& rig) {
  const float farthest = kFarthest * rig.leg_m;
  const float enough =
      kClear * rig.leg_m + DeepestIn(PointsOn(person, LegJoints(rig, kLeft), kTrunkPoints),
                                     PointsOn(person, LegJoints(rig, kRight), kTrunkPoints).positions, farthest);
  RetargetOptions options{.walks = true};
  Retargeted made = Retarget(source, walk, rig, options);
  while (options.wider < kWidest && LegDepth(person, rig, made.clip, kLegKeys) > enough) {
    options.wider += kWiderStep;
    made = Retarget(source, walk, rig, options);
  }
  return made;
}

float ClearHands(const Avatar& person, const Rig& rig, Clip* clip) {
  float widest = 0;
  const Vec3 ahead = Rotated(Conjugate(rig.turn), {0, 0, 1});
  for (const size_t side : {kLeft, kRight}) {
    const int upper = rig.humanoid.arms[side].upper;
    if (upper < 0) continue;
    const ArmOverClip sampled = Sampled(person, rig, *clip, side, kKeys);
    const float sign = side == kLeft ? 1.0f : -1.0f;
    const float clear = kClear * rig.leg_m;
    float open_deg = 0;
    while (open_deg < kMostOpen_deg &&
           Deepest(sampled, ahead, sign * open_deg * kPi / 180, kFarthest * rig.leg_m, clear) > clear) {
      open_deg += kOpenStep_deg;
    }
    if (open_deg > 0) OpenArm(rig, upper, TurnAbout(ahead, sign * open_deg * kPi / 180), clip);
    widest = std::max(widest, open_deg);
  }
  return widest;
}

}  // namespace flaneur
