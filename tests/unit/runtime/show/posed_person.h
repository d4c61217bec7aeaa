// The finest mesh of somebody in a picture, where the picture shows it.
#pragma once
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "runtime/pack/tour_pack.h"
#include "runtime/render/frame.h"

namespace flaneur {

// Of a flock, and nobody who walks among people.
inline bool IsBird(const TourPack& pack, const std::string& avatar) {
  return std::any_of(pack.flocks.begin(), pack.flocks.end(),
                     [&](const Flock& flock) { return flock.avatar == avatar; });
}

inline Vec3 Posed(const PackPrimitive& p, size_t vertex, const Mat4* frame) {
  Vec3 sum;
  for (size_t k = 0; k < 4; ++k) {
    sum = sum + TransformPoint(frame[p.joints[vertex][k]], p.positions[vertex]) *
                    (static_cast<float>(p.weights[vertex][k]) / 255);
  }
  return sum;
}

// On the ground axes.
inline std::vector<Vec3> PosedPerson(const TourPack& pack, const DrawnPerson& person) {
  const PackAvatar& avatar = pack.avatars[static_cast<size_t>(person.avatar)];
  const PackClip& clip = person.moment.clip == ClipKind::kWalk   ? avatar.walk
                         : person.moment.clip == ClipKind::kIdle ? avatar.idle
                                                                 : avatar.talk;
  const float at = person.moment.phase * static_cast<float>(clip.frames);
  const int a = static_cast<int>(at) % clip.frames, b = (a + 1) % clip.frames;
  const float between = at - std::floor(at), turn = person.heading_rad + kPi / 2;
  const auto frame = [&](int f) { return &clip.matrices[static_cast<size_t>(f) * static_cast<size_t>(avatar.joints)]; };
  std::vector<Vec3> out;
  for (const PackPrimitive& p : pack.meshes[static_cast<size_t>(avatar.levels.front().mesh)].primitives) {
    for (size_t v = 0; v < p.positions.size(); ++v) {
      const Vec3 q = GroundFromGltf(Posed(p, v, frame(a)) * (1 - between) + Posed(p, v, frame(b)) * between);
      out.push_back(
          Vec3{std::cos(turn) * q.x - std::sin(turn) * q.y, std::sin(turn) * q.x + std::cos(turn) * q.y, q.z} +
          person.position);
    }
  }
  return out;
}

}  // namespace flaneur
