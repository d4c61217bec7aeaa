// An editable person: skinned meshes, one skeleton, clips. Metres, glTF axes, feet at the origin, facing +Z.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "pipeline/core/mesh.h"
#include "runtime/base/math.h"

namespace flaneur {

struct Transform {
  Vec3 translation;
  Quat rotation;
  Vec3 scale{1, 1, 1};
};

struct Joint {
  std::string name;
  int parent = -1;    // index of an earlier joint; -1: a root
  Transform rest;     // relative to the parent
  Mat4 inverse_bind;  // bind pose: avatar space to joint space
};

// Keys at a constant rate; the last key equals the first where the clip loops.
struct Clip {
  std::string name;
  float duration_s = 0;
  int keys = 0;                       // >= 1; key k is at k * duration_s / (keys - 1)
  std::vector<Transform> transforms;  // keys x joints, key by key, relative to the parent
};

// What some people of an avatar carry or wear and others don't, on the avatar's own joints and materials.
struct AvatarProp {
  std::string name;
  std::vector<Mesh> meshes;
};

struct Avatar {
  std::string name;
  std::vector<Mesh> meshes;  // one a material; what everybody has
  std::vector<Material> materials;
  std::vector<Image> images;
  std::vector<Joint> joints;  // parents before children
  std::vector<Clip> clips;    // among them "walk"; "idle" and "talk" where the source has them
  std::vector<AvatarProp> props;
  float height_m = 0;        // of the bind pose, without props
  float radius_m = 0;        // of the circle that stands for the person on the ground
  float walk_speed_mps = 0;  // at which the walk's stance foot does not slide
};

struct AvatarLevel {
  std::vector<Mesh> meshes;
  int triangles = 0;
  float error_mm = 0;        // greatest surface deviation from the original in the bind pose
  float posed_error_mm = 0;  // the same over poses of the walk, and what joints left out may add
  float normal_deg = 0;      // mean angle between the normals and the original's in the bind pose; 0: not measured
  int joints = 0;            // that move a vertex
  float switch_px = 0;       // person's height on screen in pixels at or above which this level is needed
};

// The chain, finest first; level 0 is the original's own geometry (or its reduction to max_triangles).
struct AvatarLevels {
  Avatar avatar;  // meshes are those of level 0
  std::vector<AvatarLevel> levels;
};

// Whether a joint is `above` or hangs on it.
bool IsBelow(const std::vector<Joint>& joints, int joint, int above);

// How much of a vertex of a mesh with joints hangs on those that are marked, 0 to 1.
float WeightOn(const std::vector<bool>& joints, const Mesh& mesh, size_t vertex);

// What everybody has, then the props' meshes.
std::vector<Mesh*> AllMeshes(Avatar* avatar);

// Skinning matrices (global * inverse bind) of joints, parents first, whose local transforms these are.
std::vector<Mat4> SkinningMatrices(std::span<const Joint> joints, std::span<const Transform> transforms);

// The same, one a joint, at `time_s` of the clip (wrapped into its duration).
std::vector<Mat4> SkinningMatrices(const Avatar& avatar, const Clip& clip, float time_s);

// The mesh's positions under these matrices; those of a mesh without joints come back unchanged.
std::vector<Vec3> SkinnedPositions(const Mesh& mesh, const std::vector<Mat4>& matrices);

// The mesh's positions and normals under these matrices; a mesh without joints comes back unchanged.
Mesh Skinned(const Mesh& mesh, const std::vector<Mat4>& matrices);

// The clip of that name, or null.
const Clip* FindClip(const Avatar& avatar, const std::string& name);

}  // namespace flaneur
