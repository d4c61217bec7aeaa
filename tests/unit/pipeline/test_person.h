// A small made-up person for tests: a column on a root, with two legs that swing; every number is
// known.
#pragma once
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "pipeline/core/avatar.h"

namespace flaneur {

inline Mat4 Moved(Vec3 by) { return FromTranslationRotationScale(by, {}, {1, 1, 1}); }

// A tube of square section from y = bottom to top in `rings` rings, closed at both ends, all on one
// joint.
inline void AddTube(float x, float bottom, float top, float half_width, int rings, uint16_t joint, Mesh* mesh) {
  const uint32_t base = static_cast<uint32_t>(mesh->positions.size());
  for (int r = 0; r < rings; ++r) {
    const float t = static_cast<float>(r) / static_cast<float>(rings - 1);
    for (int k = 0; k < 16; ++k) {
      const float angle = 2 * kPi * static_cast<float>(k) / 16;
      const Vec3 out{std::cos(angle), 0, std::sin(angle)};
      mesh->positions.push_back(Vec3{x, bottom + t * (top - bottom), 0} + out * half_width);
      mesh->normals.push_back(out);
      mesh->uvs.push_back({static_cast<float>(k) / 16, t});
      mesh->joints.push_back({joint, 0, 0, 0});
      mesh->weights.push_back({1, 0, 0, 0});
    }
  }
  for (uint32_t r = 0; r + 1 < static_cast<uint32_t>(rings); ++r) {
    for (uint32_t k = 0; k < 16; ++k) {
      const uint32_t a = base + 16 * r + k, b = base + 16 * r + (k + 1) % 16;
      mesh->indices.insert(mesh->indices.end(), {a, a + 16, b, b, a + 16, b + 16});
    }
  }
}

// 1.8 m high, legs of 0.9 m that swing by +-0.3 rad at 1 Hz about the hips at y = 0.9.
inline Avatar MadePerson() {
  Avatar avatar;
  avatar.name = "made";
  avatar.joints = {{"root", -1, {}, {}}, {"left", 0, {}, {}}, {"right", 0, {}, {}}};
  const Vec3 hips[3] = {{0, 0.9f, 0}, {0.1f, 0.9f, 0}, {-0.1f, 0.9f, 0}};
  for (size_t j = 0; j < 3; ++j) {
    avatar.joints[j].rest.translation = j == 0 ? hips[0] : hips[j] - hips[0];
    avatar.joints[j].inverse_bind = Moved(hips[j] * -1);
  }
  Material cloth;
  cloth.name = "cloth";
  avatar.materials = {cloth};
  Mesh mesh;
  mesh.name = "body";
  mesh.material = 0;
  AddTube(0, 0.9f, 1.8f, 0.2f, 24, 0, &mesh);
  AddTube(0.1f, 0, 0.9f, 0.08f, 24, 1, &mesh);
  AddTube(-0.1f, 0, 0.9f, 0.08f, 24, 2, &mesh);
  avatar.meshes = {mesh};
  Clip walk;
  walk.name = "walk";
  walk.duration_s = 1;
  walk.keys = 31;
  for (int k = 0; k < walk.keys; ++k) {
    const float angle = 0.3f * std::sin(2 * kPi * static_cast<float>(k) / 30);
    for (size_t j = 0; j < 3; ++j) {
      Transform t = avatar.joints[j].rest;
      const float half = (j == 0 ? 0 : j == 1 ? angle : -angle) / 2;
      t.rotation = {std::sin(half), 0, 0, std::cos(half)};
      walk.transforms.push_back(t);
    }
  }
  avatar.clips = {walk};
  avatar.height_m = 1.8f;
  avatar.radius_m = 0.25f;
  avatar.walk_speed_mps = 1.2f;
  return avatar;
}

inline AvatarLevels OneLevel(const Avatar& avatar) {
  AvatarLevels levels;
  levels.avatar = avatar;
  levels.levels.resize(1);
  levels.levels[0].meshes = avatar.meshes;
  for (const Mesh& mesh : avatar.meshes) levels.levels[0].triangles += TriangleCount(mesh);
  return levels;
}

// The folder of real data beside the project; empty where there is none.
inline std::filesystem::path SharedData() {
  const char* given = std::getenv("FLANEUR_SHARED_DIR");
  const std::filesystem::path folder = given != nullptr
                                           ? std::filesystem::path(given)
                                           : std::filesystem::path(FLANEUR_SOURCE_DIR).parent_path() / "shared";
  return std::filesystem::is_directory(folder / "data") ? folder / "data" : std::filesystem::path();
}

}  // namespace flaneur
