// What Blender is asked to draw: all meshes of a person as one, posed for every frame.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/core/avatar.h"
#include "pipeline/core/impostor.h"
#include "pipeline/impostor/bake_impostor.h"

namespace flaneur {

// Positions, normals, motions and bends stand frame by frame, each frame as long as uvs and colors.
// glTF axes, metres. A motion is the way from half a phase before the frame to half a phase after it;
// the middle of the two lies beside the frame's position by the bend.
struct ViewGeometry {
  int frames = 0;
  std::vector<ImpostorClip> clips;
  std::vector<Vec3> positions, normals, motions, bends;
  std::vector<Vec2> uvs;            // (0, 0) where the mesh has none
  std::vector<Vec4> colors;         // sRGB; vertex colour x base colour
  std::vector<uint32_t> indices;    // triangles
  std::vector<uint32_t> materials;  // one a triangle, index into ViewMaterials' result
};

struct ViewMaterial {
  int image = -1;  // index into Avatar::images, -1: none
  bool mask = false;
  float cutoff = 0.5f;
  bool double_sided = false;
  uint8_t tints = kEveryTint;
};

// What one picture shows, about the point between the feet: to the right, along the camera's up
// axis, and how far towards the camera or away from it.
struct ViewBounds {
  float left_m = 0, right_m = 0, bottom_m = 0, top_m = 0, depth_m = 0;
};

// A camera's axes in the avatar's.
struct ViewAxes {
  Vec3 right, up, near;
};

// One a mesh, in their order. Textures that cannot be used are left out with a warning.
std::vector<ViewMaterial> ViewMaterials(const Avatar& avatar, std::vector<std::string>* warnings);

// Of a picture of this size on the mesh, the root of the mean square over its surface.
float TexelsPerMetre(const Mesh& mesh, int width_px, int height_px);

// Errors: none of the clips, no triangles, a mesh without normals, a non-finite vertex (names mesh,
// clip and vertex).
Error PoseFrames(const Avatar& avatar, const std::vector<ImpostorClipOptions>& clips, ViewGeometry* geometry);

ViewAxes AxesOf(int direction, int directions, float elevation_deg);

// One a cell, in the order of ImpostorAtlas::cells.
std::vector<ViewBounds> MeasureViews(const ViewGeometry& geometry, int directions,
                                     const std::vector<float>& elevations_deg);

// The length of a drawn vertex's longest motion or bend.
float Longest(const std::vector<Vec3>& ways, const ViewGeometry& geometry);

}  // namespace flaneur
