// How somebody is drawn: by one of their avatar's meshes, by its impostor, or not at all.
#pragma once
#include <cstdint>

namespace flaneur {

enum class LevelKind : uint8_t { kNotDrawn, kImpostor, kMesh };

struct Level {
  LevelKind kind = LevelKind::kNotDrawn;
  int mesh = 0;  // of a mesh: which of the avatar's levels, 0 the finest

  bool operator==(const Level&) const = default;
};

inline constexpr Level kNotDrawn{}, kImpostor{LevelKind::kImpostor, 0};
constexpr Level MeshLevel(int mesh) { return {LevelKind::kMesh, mesh}; }
constexpr bool IsDrawn(Level level) { return level.kind != LevelKind::kNotDrawn; }
constexpr bool IsMesh(Level level) { return level.kind == LevelKind::kMesh; }

}  // namespace flaneur
