#include "pipeline/impostor/view_geometry.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/array.h"
#include "runtime/base/srgb.h"

namespace flaneur {
namespace {

Vec4 BaseColor(const Avatar& avatar, const Mesh& mesh) {
  return mesh.material < 0 ? Vec4{1, 1, 1, 1} : At(avatar.materials, mesh.material).base_color;
}

Vec4 Product(Vec4 a, Vec4 b) { return {a.x * b.x, a.y * b.y, a.z * b.z, a.w * b.w}; }

Vec4 Stored(Vec4 linear) {
  const auto stored = [](float v) { return SrgbFromLinear(std::clamp(v, 0.0f, 1.0f)); };
  return {stored(linear.x), stored(linear.y), stored(linear.z), linear.w};
}

// What stays the same in all frames.
void AppendSurface(const Avatar& avatar, const Mesh& mesh, uint32_t material, ViewGeometry* geometry) {
  const auto first = static_cast<uint32_t>(geometry->uvs.size());
  const Vec4 base = BaseColor(avatar, mesh);
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    geometry->uvs.push_back(mesh.uvs.empty() ? Vec2{} : mesh.uvs[i]);
    geometry->colors.push_back(Stored(mesh.colors.empty() ? base : Product(base, mesh.colors[i])));
  }
  for (uint32_t index : mesh.indices) geometry->indices.push_back(first + index);
  geometry->materials.resize(geometry->indices.size() / 3, material);
}

bool Finite(Vec3 p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

Error AppendPose(const Avatar& avatar, const Clip& clip, float time_s, ViewGeometry* geometry) {
  const std::vector<Mat4> matrices = SkinningMatrices(avatar, clip, time_s);
  for (const Mesh& mesh : avatar.meshes) {
    const Mesh posed = Skinned(mesh, matrices);
    for (size_t i = 0; i < posed.positions.size(); ++i) {
      if (Finite(posed.positions[i]) && Finite(posed.normals[i])) continue;
      return Fail("avatar '" + avatar.name + "': mesh '" + mesh.name + "', vertex " + std::to_string(i) +
                  ": not a number in clip '" + clip.name + "'; export the avatar again");
    }
    geometry->positions.insert(geometry->positions.end(), posed.positions.begin(), posed.positions.end());
    geometry->normals.insert(geometry->normals.end(), posed.normals.begin(), posed.normals.end());
  }
  return Ok();
}

// Between two moments of the clip, whose middle is the frame that was appended last.
void AppendMotion(const Avatar& avatar, const Clip& clip, float from_s, float to_s, ViewGeometry* geometry) {
  const std::vector<Mat4> from = SkinningMatrices(avatar, clip, from_s);
  const std::vector<Mat4> to = SkinningMatrices(avatar, clip, to_s);
  for (const Mesh& mesh : avatar.meshes) {
    const Mesh before = Skinned(mesh, from), after = Skinned(mesh, to);
    for (size_t i = 0; i < before.positions.size(); ++i) {
      const Vec3 middle = geometry->positions[geometry->motions.size()];
      geometry->motions.push_back(after.positions[i] - before.positions[i]);
      geometry->bends.push_back((before.positions[i] + after.positions[i]) * 0.5f - middle);
    }
  }
}

// Vertices of triangles.
std::vector<size_t> DrawnVertices(const ViewGeometry& geometry) {
  std::vector<bool> drawn(geometry.uvs.size(), false);
  for (uint32_t index : geometry.indices) drawn[index] = true;
  std::vector<size_t> list;
  for (size_t i = 0; i < drawn.size(); ++i) {
    if (drawn[i]) list.push_back(i);
  }
  return list;
}

ViewBounds BoundsOf(const Vec3* positions, const std::vector<size_t>& drawn, const ViewAxes& axes) {
  constexpr float kFar = 1e30f;
  ViewBounds b{kFar, -kFar, kFar, -kFar, 0};
  for (size_t i : drawn) {
    const float right = Dot(positions[i], axes.right), up = Dot(positions[i], axes.up);
    b.left_m = std::min(b.left_m, right);
    b.right_m = std::max(b.right_m, right);
    b.bottom_m = std::min(b.bottom_m, up);
    b.top_m = std::max(b.top_m, up);
    b.depth_m = std::max(b.depth_m, std::abs(Dot(positions[i], axes.near)));
  }
  return b;
}

std::string Names(const std::vector<ImpostorClipOptions>& clips) {
  std::string names;
  for (const ImpostorClipOptions& clip : clips) names += (names.empty() ? "" : ", ") + clip.name;
  return names;
}

int UsableImage(const Avatar& avatar, const Mesh& mesh, const Material& material, std::vector<std::string>* warnings) {
  const int image = material.base_color_image;
  if (image < 0) return -1;
  std::string why;
  if (static_cast<size_t>(image) >= avatar.images.size() || At(avatar.images, image).bytes.empty()) {
    why = "its texture is missing";
  } else if (mesh.uvs.empty()) {
    why = "it has a texture but no texture coordinates";
  } else {
    return image;
  }
  warnings->push_back("avatar '" + avatar.name + "': mesh '" + mesh.name + "': " + why +
                      "; the impostor shows its base colour instead");
  return -1;
}

}  // namespace

std::vector<ViewMaterial> ViewMaterials(const Avatar& avatar, std::vector<std::string>* warnings) {
  std::vector<ViewMaterial> all;
  for (const Mesh& mesh : avatar.meshes) {
    ViewMaterial view;
    if (mesh.material >= 0) {
      const Material& material = At(avatar.materials, mesh.material);
      view.image = UsableImage(avatar, mesh, material, warnings);
      view.mask = material.alpha != Material::Alpha::kOpaque;
      view.cutoff = material.alpha_cutoff;
      view.double_sided = material.double_sided;
      view.tints = material.tints;
    }
    all.push_back(view);
  }
  return all;
}

float TexelsPerMetre(const Mesh& mesh, int width_px, int height_px) {
  float area_m2 = 0, area_uv = 0;  // twice
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const uint32_t* v = &mesh.indices[i];
    area_m2 += Length(Cross(mesh.positions[v[1]] - mesh.positions[v[0]], mesh.positions[v[2]] - mesh.positions[v[0]]));
    const Vec2 a = mesh.uvs[v[1]] - mesh.uvs[v[0]], b = mesh.uvs[v[2]] - mesh.uvs[v[0]];
    area_uv += std::abs(a.x * b.y - a.y * b.x);
  }
  return area_m2 > 0 ? std::sqrt(area_uv * static_cast<float>(width_px) * static_cast<float>(height_px) / area_m2) : 0;
}

Error PoseFrames(const Avatar& avatar, const std::vector<ImpostorClipOptions>& clips, ViewGeometry* geometry) {
  *geometry = {};
  const std::string name = "avatar '" + avatar.name + "'";
  for (size_t m = 0; m < avatar.meshes.size(); ++m) {
    const Mesh& mesh = avatar.meshes[m];
    if (mesh.normals.size() != mesh.positions.size()) {
      return Fail(name + ": mesh '" + mesh.name + "' has no normals; export them");
    }
    AppendSurface(avatar, mesh, static_cast<uint32_t>(m), geometry);
  }
  if (geometry->indices.empty()) return Fail(name + " has no triangles; nothing can be drawn");
  for (const ImpostorClipOptions& wanted : clips) {
    const Clip* clip = FindClip(avatar, wanted.name);
    if (!clip) continue;
    geometry->clips.push_back({wanted.name, geometry->frames, wanted.phases});
    geometry->frames += wanted.phases;
    for (int phase = 0; phase < wanted.phases; ++phase) {
      const float time_s = clip->duration_s * static_cast<float>(phase) / static_cast<float>(wanted.phases);
      const float half_s = clip->duration_s / static_cast<float>(2 * wanted.phases);
      if (Error error = AppendPose(avatar, *clip, time_s, geometry)) return error;
      AppendMotion(avatar, *clip, time_s - half_s, time_s + half_s, geometry);
    }
  }
  if (geometry->frames == 0) return Fail(name + " has none of the clips " + Names(clips));
  return Ok();
}

ViewAxes AxesOf(int direction, int directions, float elevation_deg) {
  const float azimuth = 2 * kPi * static_cast<float>(direction) / static_cast<float>(directions);
  const float elevation = elevation_deg * kPi / 180;
  const float a_cos = std::cos(azimuth), a_sin = std::sin(azimuth);
  const float e_cos = std::cos(elevation), e_sin = std::sin(elevation);
  return {{a_cos, 0, -a_sin}, {-a_sin * e_sin, e_cos, -a_cos * e_sin}, {a_sin * e_cos, e_sin, a_cos * e_cos}};
}

std::vector<ViewBounds> MeasureViews(const ViewGeometry& geometry, int directions,
                                     const std::vector<float>& elevations_deg) {
  const std::vector<size_t> drawn = DrawnVertices(geometry);
  std::vector<ViewBounds> all;
  for (int frame = 0; frame < geometry.frames; ++frame) {
    const Vec3* positions = &geometry.positions[static_cast<size_t>(frame) * geometry.uvs.size()];
    for (float elevation_deg : elevations_deg) {
      for (int d = 0; d < directions; ++d) {
        all.push_back(BoundsOf(positions, drawn, AxesOf(d, directions, elevation_deg)));
      }
    }
  }
  return all;
}

float Longest(const std::vector<Vec3>& ways, const ViewGeometry& geometry) {
  const std::vector<size_t> drawn = DrawnVertices(geometry);
  float longest = 0;
  for (size_t first = 0; first < ways.size(); first += geometry.uvs.size()) {
    for (size_t i : drawn) longest = std::max(longest, Length(ways[first + i]));
  }
  return longest;
}

}  // namespace flaneur
