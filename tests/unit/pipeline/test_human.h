// A small made-up human figure for tests, in any rest pose, unit and naming; every number is known.
#pragma once
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "pipeline/core/avatar.h"
#include "pipeline/core/rotation.h"

namespace flaneur {

struct HumanShape {
  float unit = 1;             // of lengths: 100 for centimetres
  float leg_m = 0.84f;        // hip to ankle
  float arm_down_deg = 0;     // of the rest pose: 0 a T-pose, 45 an A-pose
  Quat turn{};                // of the whole rest pose
  bool feet_on_root = false;  // as rigs have them whose feet are steered
  std::vector<std::string> names = {"Hips",        "Spine",     "Neck",        "Head",         "LeftArm",
                                    "LeftForeArm", "LeftHand",  "RightArm",    "RightForeArm", "RightHand",
                                    "LeftUpLeg",   "LeftLeg",   "LeftFoot",    "LeftToeBase",  "RightUpLeg",
                                    "RightLeg",    "RightFoot", "RightToeBase"};
};

inline void PrintTo(const HumanShape& shape, std::ostream* out) {
  *out << "unit " << shape.unit << ", leg " << shape.leg_m << ", arms " << shape.arm_down_deg << " down, turned by "
       << AngleOf(shape.turn) << (shape.feet_on_root ? ", feet on root" : "");
}

inline void AddBox(Vec3 from, Vec3 to, float half, uint16_t joint, Mesh* mesh) {
  const Vec3 low{std::min(from.x, to.x) - half, std::min(from.y, to.y) - half, std::min(from.z, to.z) - half};
  const Vec3 high{std::max(from.x, to.x) + half, std::max(from.y, to.y) + half, std::max(from.z, to.z) + half};
  const auto base = static_cast<uint32_t>(mesh->positions.size());
  const Vec3 middle = (low + high) * 0.5f;
  for (int c = 0; c < 8; ++c) {
    const Vec3 p{c & 1 ? high.x : low.x, c & 2 ? high.y : low.y, c & 4 ? high.z : low.z};
    mesh->positions.push_back(p);
    mesh->normals.push_back(Normalized(p - middle));
    mesh->uvs.push_back({0, 0});
    mesh->joints.push_back({joint, 0, 0, 0});
    mesh->weights.push_back({1, 0, 0, 0});
  }
  for (const uint32_t i : {0u, 2u, 1u, 1u, 2u, 3u, 4u, 5u, 6u, 5u, 7u, 6u, 0u, 1u, 4u, 1u, 5u, 4u,
                           2u, 6u, 3u, 3u, 6u, 7u, 0u, 4u, 2u, 2u, 4u, 6u, 1u, 3u, 5u, 3u, 7u, 5u}) {
    mesh->indices.push_back(base + i);
  }
}

// Sets the rest transforms and bind matrices that put joints to these places, turned as given.
inline void BindAt(const std::vector<Vec3>& places, Quat turn, Avatar* avatar) {
  for (size_t j = 0; j < places.size(); ++j) {
    Joint& joint = avatar->joints[j];
    const Vec3 place = Rotated(turn, places[j]);
    joint.inverse_bind = Inverse(FromTranslationRotationScale(place, turn, {1, 1, 1}));
    const size_t p = static_cast<size_t>(std::max(joint.parent, 0));
    joint.rest.rotation = joint.parent < 0 ? turn : Quat{};
    joint.rest.translation = joint.parent < 0 ? place : places[j] - places[p];
  }
}

// No clips. Soles at y = 0, facing +Z, before `turn`.
inline Avatar MadeHuman(const HumanShape& shape) {
  const float leg = shape.leg_m, hip = leg + 0.08f, down = shape.arm_down_deg * kPi / 180;
  const auto arm = [&](float sign, float along) {
    return Vec3{sign * (0.18f + along * std::cos(down)), hip + 0.48f - along * std::sin(down), 0};
  };
  std::vector<Vec3> places = {{0, hip + 0.04f, 0}, {0, hip + 0.2f, 0}, {0, hip + 0.54f, 0}, {0, hip + 0.62f, 0}};
  for (const float sign : {1.0f, -1.0f}) {
    for (const float along : {0.0f, 0.28f, 0.53f}) places.push_back(arm(sign, along));
  }
  for (const float sign : {1.0f, -1.0f}) {
    places.push_back({sign * 0.09f, hip, 0});
    places.push_back({sign * 0.09f, 0.08f + leg * 0.5f, 0.01f});
    places.push_back({sign * 0.09f, 0.08f, 0});
    places.push_back({sign * 0.09f, 0.02f, 0.13f});
  }
  const std::vector<int> parents = {-1, 0, 1, 2, 1, 4, 5, 1, 7, 8, 0, 10, 11, 12, 0, 14, 15, 16};
  Avatar avatar;
  avatar.name = "human";
  Mesh body;
  body.name = "body";
  body.material = 0;
  AddBox(places[0], places[1], 0.11f, 0, &body);
  AddBox(places[1], places[2], 0.12f, 1, &body);
  AddBox(places[3], places[3] + Vec3{0, 0.12f, 0}, 0.08f, 3, &body);
  for (const size_t j : {size_t{4}, size_t{5}, size_t{7}, size_t{8}})
    AddBox(places[j], places[j + 1], 0.04f, static_cast<uint16_t>(j), &body);
  for (const size_t j : {size_t{6}, size_t{9}}) AddBox(places[j], places[j], 0.05f, static_cast<uint16_t>(j), &body);
  for (const size_t j : {size_t{10}, size_t{11}, size_t{14}, size_t{15}})
    AddBox(places[j], places[j + 1], 0.05f, static_cast<uint16_t>(j), &body);
  for (const size_t j : {size_t{12}, size_t{16}}) {
    const float x = places[j].x;
    AddBox({x, 0.03f, -0.03f}, {x, 0.03f, 0.10f}, 0.03f, static_cast<uint16_t>(j), &body);
    AddBox({x, 0.02f, 0.15f}, {x, 0.02f, 0.18f}, 0.02f, static_cast<uint16_t>(j + 1), &body);
  }
  for (Vec3& p : body.positions) p = Rotated(shape.turn, p * shape.unit);
  for (Vec3& n : body.normals) n = Rotated(shape.turn, n);
  for (Vec3& p : places) p = p * shape.unit;
  for (size_t j = 0; j < places.size(); ++j) avatar.joints.push_back({shape.names[j], parents[j], {}, {}});
  if (shape.feet_on_root) avatar.joints[12].parent = avatar.joints[16].parent = 0;
  BindAt(places, shape.turn, &avatar);
  Material skin;
  skin.name = "skin";
  avatar.materials = {skin};
  avatar.meshes = {body};
  return avatar;
}

// A stiff walk in place: legs and arms swing, knees bend while their leg comes forward, soles stay level and the lower
// foot stands on the ground. On MadeHuman's joints.
inline Clip MadeWalk(const Avatar& human, int keys = 31) {
  Clip walk;
  walk.name = "walk";
  walk.duration_s = 1;
  walk.keys = keys;
  const Quat turn = human.joints[0].rest.rotation;
  const float unit =
      Length(human.joints[11].rest.translation) + Length(human.joints[12].rest.translation);  // about a leg
  for (int k = 0; k < keys; ++k) {
    const float phase = 2 * kPi * static_cast<float>(k) / static_cast<float>(keys - 1);
    const size_t first = walk.transforms.size();
    float longest = 0;
    for (size_t j = 0; j < human.joints.size(); ++j) {
      Transform t = human.joints[j].rest;
      const float own = j >= 14 || (j >= 7 && j <= 9) ? phase + kPi : phase;
      const float thigh = -0.42f * std::sin(own), knee = 0.7f * std::max(0.0f, std::cos(own));
      float angle = 0;
      if (j == 10 || j == 14) angle = thigh;
      if (j == 11 || j == 15) angle = knee;
      if (j == 12 || j == 16) angle = -thigh - knee;
      if (j == 4 || j == 7) angle = 0.3f * std::sin(own);
      t.rotation = Normalized(Product(t.rotation, TurnAbout({1, 0, 0}, angle)));
      if (j == 12 || j == 16) longest = std::max(longest, unit / 2 * (std::cos(thigh) + std::cos(thigh + knee)));
      walk.transforms.push_back(t);
    }
    Vec3& root = walk.transforms[first].translation;
    root = root + Rotated(turn, {0, longest - unit, 0});
  }
  return walk;
}

// Binds MadeHuman, without clips or with, as it sits: thighs raised and apart by these angles, knees bent, rad.
inline void BindSeated(float raised, float bent, float apart, Avatar* human) {
  Clip sits{"sits", 1, 1, {}};
  for (size_t j = 0; j < human->joints.size(); ++j) {
    Transform t = human->joints[j].rest;
    const float outward = j < 14 ? apart : -apart;
    if (j == 10 || j == 14)
      t.rotation = Product(t.rotation, Product(TurnAbout({0, 1, 0}, outward), TurnAbout({1, 0, 0}, -raised)));
    if (j == 11 || j == 15) t.rotation = Product(t.rotation, TurnAbout({1, 0, 0}, bent));
    sits.transforms.push_back(t);
  }
  Mesh& mesh = human->meshes[0];
  mesh.positions = SkinnedPositions(mesh, SkinningMatrices(*human, sits, 0));
  std::vector<Mat4> world;
  for (size_t j = 0; j < human->joints.size(); ++j) {
    Joint& joint = human->joints[j];
    joint.rest = sits.transforms[j];
    const Mat4 local = FromTranslationRotationScale(joint.rest.translation, joint.rest.rotation, {1, 1, 1});
    world.push_back(joint.parent < 0 ? local : world[static_cast<size_t>(joint.parent)] * local);
    joint.inverse_bind = Inverse(world.back());
  }
}

}  // namespace flaneur
