#include "pipeline/io/avatar_stance.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/core/rotation.h"
#include "pipeline/rig/clip_loop.h"
#include "pipeline/rig/rig.h"
#include "runtime/base/array.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

constexpr float kUpright_rad = 0.9f;  // a skeleton further off vertical than this lies
constexpr float kCrouches = 0.05f;    // of its height: a head that is lower in the bind pose than standing
constexpr float kHeadJoint = 0.87f;   // of a person's height: where the head's joint is

bool Stance(const Avatar& avatar, const std::vector<NamedBone>& told, Humanoid* h, Vec3* up, Vec3* forward) {
  const Pose bind = BindPose(avatar.joints);
  std::string why;
  return FindHumanoid(avatar.joints, bind.positions, told, h, &why) && !h->quadruped &&
         FindStance(*h, bind.positions, up, forward);
}

// By quarters, so that +Y is up; the figure's facing comes nearest to +Z.
bool Lies(Vec3 up) { return AngleBetween(up, {0, 1, 0}) > kUpright_rad; }

// Vertices that hang on one of the joints or what is below it.
std::vector<bool> OnOrBelow(const Avatar& avatar, const std::vector<int>& joints, const Mesh& mesh) {
  std::vector<bool> theirs(avatar.joints.size(), false);
  for (int j = 0; j < Count(avatar.joints); ++j) {
    for (const int above : joints) At(theirs, j) = At(theirs, j) || IsBelow(avatar.joints, j, above);
  }
  std::vector<bool> on(mesh.positions.size(), false);
  for (size_t v = 0; v < mesh.joints.size(); ++v) on[v] = WeightOn(theirs, mesh, v) > 0.5f;
  return on;
}

}  // namespace

Error ReadAxis(const std::string& text, Vec3* axis) {
  static constexpr std::array<std::pair<const char*, Vec3>, 9> kAxes = {std::pair{"x", Vec3{1, 0, 0}},
                                                                        {"y", {0, 1, 0}},
                                                                        {"z", {0, 0, 1}},
                                                                        {"+x", {1, 0, 0}},
                                                                        {"+y", {0, 1, 0}},
                                                                        {"+z", {0, 0, 1}},
                                                                        {"-x", {-1, 0, 0}},
                                                                        {"-y", {0, -1, 0}},
                                                                        {"-z", {0, 0, -1}}};
  for (const auto& [name, way] : kAxes) {
    if (text != name) continue;
    *axis = way;
    return Ok();
  }
  return Fail("'" + OneLine(text) + "' is no direction; one of x, -x, y, -y, z and -z is");
}

void TurnFigure(Quat turn, bool clips, Avatar* avatar, Mesh* body) {
  const Mat4 matrix = FromTranslationRotationScale({}, turn, {1, 1, 1});
  const auto turn_mesh = [&](Mesh* mesh) {
    for (Vec3& p : mesh->positions) p = TransformPoint(matrix, p);
    for (Vec3& n : mesh->normals) n = TransformDirection(matrix, n);
  };
  for (Mesh* mesh : AllMeshes(avatar)) turn_mesh(mesh);
  turn_mesh(body);
  for (Joint& joint : avatar->joints) {
    joint.inverse_bind = joint.inverse_bind * Inverse(matrix);
    if (joint.parent >= 0) continue;
    joint.rest.translation = TransformPoint(matrix, joint.rest.translation);
    joint.rest.rotation = Normalized(Product(turn, joint.rest.rotation));
  }
  if (!clips) return;
  for (Clip& clip : avatar->clips) TurnClip(turn, avatar->joints, &clip);
}

Error StandUp(const std::string& up_text, const std::string& forward_text, const std::vector<NamedBone>& told,
              Avatar* avatar, Mesh* body, std::vector<std::string>* warnings) {
  if (!up_text.empty() || !forward_text.empty()) {
    Vec3 up{0, 1, 0}, forward{0, 0, 1};
    if (Error e = up_text.empty() ? Ok() : ReadAxis(up_text, &up)) return Fail("up: " + e.message);
    if (forward_text.empty() && std::abs(up.z) > 0.5f) forward = {0, -up.z, 0};  // as Blender has it
    if (Error e = forward_text.empty() ? Ok() : ReadAxis(forward_text, &forward)) return Fail("forward: " + e.message);
    if (std::abs(Dot(up, forward)) > 0.5f) return Fail("up and forward must not lie along one axis");
    TurnFigure(QuarterTurn(up, forward), true, avatar, body);
    return Ok();
  }
  Humanoid h;
  Vec3 up, forward;
  if (!Stance(*avatar, told, &h, &up, &forward)) return Ok();
  if (Lies(up)) {
    TurnFigure(QuarterTurn(up, forward), false, avatar, body);
    warnings->push_back(std::string("the figure ") + (up.y < -0.6f ? "stands on its head" : "lies") +
                        " in its bind pose; it is stood up: set up and forward to have it otherwise");
  }
  const Clip* walk = FindClip(*avatar, "walk");
  if (walk == nullptr || !FindStance(h, avatar->joints, *walk, &up, &forward) || !Lies(up)) return Ok();
  const Quat turn = QuarterTurn(up, forward);
  for (Clip& clip : avatar->clips) TurnClip(turn, avatar->joints, &clip);
  warnings->push_back(std::string("the figure ") + (up.y < -0.6f ? "stands on its head" : "lies") +
                      " in its walk; its clips are stood up: set up and forward to have it otherwise");
  return Ok();
}

bool FacingInWalk(const Avatar& avatar, const std::vector<NamedBone>& told, const Clip& walk, Vec3* forward,
                  bool* by_shape) {
  Humanoid h;
  Vec3 up, bound, walks;
  if (!Stance(avatar, told, &h, &up, &bound) || !FindStance(h, avatar.joints, walk, &up, &walks)) return false;
  bound.y = walks.y = 0;
  *by_shape = h.by_shape;
  *forward = Normalized(AngleBetween(bound, walks) < kSways_rad ? bound : walks);
  return Length(*forward) > 0.5f;
}

float BoundLowerBy(const Avatar& avatar, const std::vector<NamedBone>& told) {
  Humanoid h;
  Vec3 up, forward;
  const Clip* clip = FindClip(avatar, "idle");
  if (clip == nullptr) clip = FindClip(avatar, "walk");
  if (clip == nullptr || !Stance(avatar, told, &h, &up, &forward) || h.head < 0) return 0;
  const auto head_over_feet = [&](const Pose& pose) {
    float feet = 1e30f;
    for (const HumanoidLeg& leg : h.legs) {
      const int lowest = leg.foot >= 0 ? leg.foot : leg.lower >= 0 ? leg.lower : leg.upper;
      feet = std::min(feet, At(pose.positions, lowest).y);
    }
    return At(pose.positions, h.head).y - feet;
  };
  const float bound = head_over_feet(BindPose(avatar.joints));
  const float stands = head_over_feet(PoseOf(avatar.joints, clip->transforms.data()));
  return stands - bound > kCrouches * stands ? stands - bound : 0;
}

float HeightOfSkeleton(const Avatar& avatar, const std::vector<NamedBone>& told) {
  Humanoid h;
  Vec3 up, forward;
  if (!Stance(avatar, told, &h, &up, &forward)) return 0;
  const Pose bind = BindPose(avatar.joints);
  const int top = h.head >= 0 ? h.head : h.spine.empty() ? -1 : h.spine.back();
  if (top < 0) return 0;
  float lowest = 1e30f;
  for (const Mesh& mesh : avatar.meshes) {
    const std::vector<bool> feet = OnFeet(avatar, told, mesh);
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
      if (!feet.empty() && feet[v]) lowest = std::min(lowest, Dot(mesh.positions[v], up));
    }
  }
  if (lowest > 1e29f) return 0;
  return (Dot(At(bind.positions, top), up) - lowest) / (h.head >= 0 ? kHeadJoint : 0.75f);
}

float UnitOf(float height) {
  constexpr float kLeast_m = 1.3f, kMost_m = 2.4f;
  for (const float unit_m : {0.01f, 0.001f, 0.1f, 10.0f, 100.0f, 0.0254f, 0.3048f}) {
    if (height * unit_m >= kLeast_m && height * unit_m <= kMost_m) return unit_m;
  }
  return 0;
}

std::vector<bool> OnFeet(const Avatar& avatar, const std::vector<NamedBone>& told, const Mesh& mesh) {
  Humanoid h;
  std::string why;
  if (!FindHumanoid(avatar.joints, BindPose(avatar.joints).positions, told, &h, &why) || h.quadruped) return {};
  std::vector<int> feet;
  for (const HumanoidLeg& leg : h.legs)
    feet.push_back(leg.foot >= 0 ? leg.foot : leg.lower >= 0 ? leg.lower : leg.upper);
  return OnOrBelow(avatar, feet, mesh);
}

bool IsHeadless(const Avatar& avatar, const std::vector<NamedBone>& told) {
  Humanoid h;
  std::string why;
  if (!FindHumanoid(avatar.joints, BindPose(avatar.joints).positions, told, &h, &why) || h.head < 0) return false;
  return std::none_of(avatar.meshes.begin(), avatar.meshes.end(), [&](const Mesh& mesh) {
    const std::vector<bool> on = OnOrBelow(avatar, {h.head}, mesh);
    return std::find(on.begin(), on.end(), true) != on.end();
  });
}

bool HasSecondPerson(const std::vector<Joint>& joints, std::string* which) {
  int first = -1;
  for (int j = 0; j < Count(joints); ++j) {
    const BoneName name = ReadBoneName(At(joints, j).name);
    if (name.part != BodyPart::kHead || name.side != BodySide::kNone) continue;
    if (first < 0) {
      first = j;
      continue;
    }
    bool below = false;
    for (int a = j; a >= 0; a = At(joints, a).parent) below = below || a == first;
    // A mirror for the rig's own use stands beside its original; another person has a root of their own.
    int own_root = j, first_root = first;
    while (At(joints, own_root).parent >= 0) own_root = At(joints, own_root).parent;
    while (At(joints, first_root).parent >= 0) first_root = At(joints, first_root).parent;
    if (below || own_root == first_root) continue;
    *which = At(joints, j).name;
    return true;
  }
  return false;
}

}  // namespace flaneur
