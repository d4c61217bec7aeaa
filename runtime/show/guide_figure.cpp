#include "runtime/show/guide_figure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "runtime/show/guide_arm.h"

namespace flaneur {
namespace {

// Shares of the person's height.
constexpr float kStrapLow = 0.66f, kStrapHigh = 0.80f;  // the pole at the back is tied between these
constexpr float kTop = 1.38f, kBar = 1.34f, kTails = 1.12f, kNotch = 1.165f;
constexpr float kFootAtBack = 0.52f, kFootInHand = 0.16f;
constexpr float kLeftOfPole = 0.10f, kRightOfPole = 0.10f;             // the cloth at the back,
constexpr float kLeftInHand = 0.03f, kRightInHand = 0.15f;             // and in the hand, away from the head
constexpr float kPole_m = 0.014f, kBar_m = 0.011f, kCloth_m = 0.008f;  // half as thick
constexpr float kOffBack_m = 0.03f;
constexpr float kOffHat_m = 0.03f, kMostLean_rad = 0.6f;
constexpr float kAboveShoulders = 0.06f, kMiddle = 0.06f;  // where joints carry a head or hat
constexpr float kShortFoot = 0.12f;                        // below the hand, of a pole that leans
constexpr Vec4 kWood{0.10f, 0.05f, 0.02f, 1}, kRed{0.42f, 0.015f, 0.02f, 1}, kGold{0.80f, 0.48f, 0.06f, 1};
constexpr int kTriangles = 36;  // 12 a box, 12 the cloth

// What carries the pole, and where it stands.
struct Carrier {
  Vec3 pole{0, 0, 1e9f};  // on its middle
  std::array<uint16_t, 4> joints{};
  std::array<uint8_t, 4> weights{255, 0, 0, 0};
  Mat4 to_rest;  // from where the pole stands to where it is in the joints' rest pose
  float foot = kFootAtBack, left = kLeftOfPole, right = kRightOfPole;
};

Carrier BackOf(const PackMesh& mesh, float height_m) {
  Carrier back;
  for (const PackPrimitive& p : mesh.primitives) {
    for (size_t i = 0; i < p.positions.size() && i < p.joints.size(); ++i) {
      const Vec3 v = p.positions[i];
      const bool strap = v.y > kStrapLow * height_m && v.y < kStrapHigh * height_m && std::abs(v.x) < 0.06f * height_m;
      if (strap && v.z < back.pole.z) back.pole = {0, 0, v.z}, back.joints = p.joints[i], back.weights = p.weights[i];
    }
  }
  if (back.pole.z > 1e8f) back.pole.z = 0;
  back.pole.z -= kOffBack_m;
  return back;
}

// How far a pole that is held at a point has to lean outwards to stand clear of a hat.
float Lean_rad(const PackMesh& mesh, const PackAvatar& figure, Vec3 held_m, float shoulder_m) {
  const Vec3 out = Normalized(Vec3{held_m.x, 0, held_m.z});
  const float off_m = Dot(held_m, out), least_m = shoulder_m + kAboveShoulders * figure.height_m;
  float lean_rad = 0;
  for (const PackPrimitive& p : mesh.primitives) {
    for (size_t i = 0; i < p.positions.size() && i < p.joints.size(); ++i) {
      const Vec3 v = p.positions[i];
      const size_t joint = p.joints[i][0];
      const bool middle =
          joint < figure.skeleton.size() && std::abs(figure.skeleton[joint].rest_m.x) < kMiddle * figure.height_m;
      const float far_m = std::hypot(v.x, v.z);
      if (!middle || v.y < std::max(least_m, held_m.y + kOffHat_m) || Dot(v, out) < 0.5f * far_m) continue;
      lean_rad = std::max(lean_rad, std::atan2(far_m + kOffHat_m - off_m, v.y - held_m.y));
    }
  }
  return std::min(lean_rad, kMostLean_rad);
}

Carrier CarrierOf(const PackMesh& finest, const PackAvatar& figure) {
  const std::optional<CarryingArm> arm = FindCarryingArm(figure.skeleton, figure.height_m);
  if (!arm) return BackOf(finest, figure.height_m);
  Carrier hand;
  hand.pole = arm->grip_m;
  hand.joints[0] = static_cast<uint16_t>(arm->hand);
  hand.to_rest = Inverse(arm->hand_bent);
  hand.foot = kFootInHand, hand.left = kLeftInHand, hand.right = kRightInHand;
  const float shoulder_m = figure.skeleton[static_cast<size_t>(arm->shoulder)].rest_m.y;
  const float lean_rad = Lean_rad(finest, figure, arm->grip_m, shoulder_m);
  if (lean_rad <= 0) return hand;
  const Vec3 axis = Cross({0, 1, 0}, {arm->grip_m.x, 0, arm->grip_m.z});
  hand.to_rest = hand.to_rest * Carried(arm->grip_m, arm->grip_m, About(axis, lean_rad));
  hand.foot = std::max(hand.foot, arm->grip_m.y / figure.height_m - kShortFoot);
  return hand;
}

// Avatar axes: x to the left, y up, z ahead. Corners anticlockwise as seen from outside.
void AddQuad(Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec4 color, const Carrier& carrier, PackPrimitive* out) {
  const auto first = static_cast<uint32_t>(out->positions.size());
  const Vec3 normal = TransformDirection(carrier.to_rest, Normalized(Cross(b - a, c - a)));
  for (const Vec3& corner : {a, b, c, d}) {
    out->positions.push_back(TransformPoint(carrier.to_rest, corner));
    out->normals.push_back(normal);
    out->colors.push_back(color);
    out->joints.push_back(carrier.joints);
    out->weights.push_back(carrier.weights);
  }
  for (const uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) out->indices.push_back(first + k);
}

void AddBox(Vec3 low, Vec3 high, Vec4 color, const Carrier& carrier, PackPrimitive* out) {
  const auto at = [&](int corner) {
    return Vec3{corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z};
  };
  constexpr int kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& f : kFaces) AddQuad(at(f[0]), at(f[1]), at(f[2]), at(f[3]), color, carrier, out);
}

// Three stripes, and a notch between the tails; seen from the front and from behind.
void AddCloth(float height_m, float z, const Carrier& carrier, PackPrimitive* out) {
  const float low = carrier.pole.x - carrier.right * height_m, high = carrier.pole.x + carrier.left * height_m;
  const float feet[] = {kTails, kNotch, kNotch, kTails};
  for (size_t k = 0; k < 3; ++k) {
    const Vec4 color = k == 1 ? kGold : kRed;
    const float third = (high - low) / 3, top = kBar * height_m;
    const float left = low + third * static_cast<float>(k), right = left + third;
    for (const float side : {-1.0f, 1.0f}) {
      const float at = z + side * kCloth_m;
      const Vec3 a{left, feet[k] * height_m, at}, b{right, feet[k + 1] * height_m, at}, c{right, top, at},
          d{left, top, at};
      if (side > 0) AddQuad(a, b, c, d, color, carrier, out);
      else AddQuad(d, c, b, a, color, carrier, out);
    }
  }
}

PackPrimitive Banner(float height_m, const Carrier& carrier) {
  PackPrimitive out;
  const auto [x, y, z] = carrier.pole;
  const float overhang_m = 0.02f, hang = z - kPole_m - kBar_m;
  AddBox({x - kPole_m, carrier.foot * height_m, z - kPole_m}, {x + kPole_m, kTop * height_m, z + kPole_m}, kWood,
         carrier, &out);
  AddBox({x - carrier.right * height_m - overhang_m, kBar * height_m - kBar_m, hang - kBar_m},
         {x + carrier.left * height_m + overhang_m, kBar * height_m + kBar_m, hang + kBar_m}, kWood, carrier, &out);
  AddCloth(height_m, hang, carrier, &out);
  return out;
}

}  // namespace

PackMesh GuideMesh(PackMesh level, const PackMesh& finest, const PackAvatar& figure) {
  if (!level.primitives.empty()) level.primitives.push_back(Banner(figure.height_m, CarrierOf(finest, figure)));
  return level;
}

void AddGuideFigure(TourPack* pack) {
  const auto found = std::find_if(pack->avatars.begin(), pack->avatars.end(),
                                  [&](const PackAvatar& a) { return a.name == pack->guide; });
  if (pack->guide.empty() || found == pack->avatars.end()) return;
  PackAvatar figure = *found;
  figure.share = 0;
  figure.tints.clear();  // known by the own colours
  figure.height_spread = figure.breadth_spread = 0;
  figure.props.clear();
  figure.other_clips.clear();  // does nothing but lead
  if (const auto arm = FindCarryingArm(figure.skeleton, figure.height_m)) CarryInClips(*arm, &figure);
  figure.impostor_of = static_cast<int>(found - pack->avatars.begin());
  for (PackTexture* picture : {&figure.impostor.albedo, &figure.impostor.normal, &figure.impostor.depth,
                               &figure.impostor.motion, &figure.impostor.tints}) {
    picture->levels.clear();
  }
  const auto mesh_of = [&](const PackLevel& level) { return static_cast<size_t>(level.mesh); };
  const PackMesh finest =
      mesh_of(figure.levels.front()) < pack->meshes.size() ? pack->meshes[mesh_of(figure.levels.front())] : PackMesh{};
  for (PackLevel& level : figure.levels) {
    level.triangles += kTriangles;
    if (mesh_of(level) >= pack->meshes.size()) continue;
    PackMesh mesh = GuideMesh(pack->meshes[mesh_of(level)], finest, figure);
    level.mesh = static_cast<int>(pack->meshes.size());
    pack->meshes.push_back(std::move(mesh));
  }
  pack->avatars.push_back(std::move(figure));
}

}  // namespace flaneur
