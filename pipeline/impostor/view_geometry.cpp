#include "pipeline/impostor/view_geometry.h"

#include <algorithm>
#include <cmath>

namespace flaneur {
namespace {

Vec4 BaseColor(const Avatar& avatar, const Mesh& mesh) {
  return mesh.material < 0 ? Vec4{1, 1, 1, 1}
                           : avatar.materials[static_cast<size_t>(mesh.material)].base_color;
}

Vec4 Product(Vec4 a, Vec4 b) { return {a.x * b.x, a.y * b.y, a.z * b.z, a.w * b.w}; }

// What stays the same in all frames.
void AppendSurface(const Avatar& avatar, const Mesh& mesh, uint32_t material,
                   ViewGeometry* geometry) {
  const auto first = static_cast<uint32_t>(geometry->uvs.size());
  const Vec4 base = BaseColor(avatar, mesh);
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    geometry->uvs.push_back(mesh.uvs.empty() ? Vec2{} : mesh.uvs[i]);
    geometry->colors.push_back(mesh.colors.empty() ? base : Product(base, mesh.colors[i]));
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
      return Fail("avatar '" + avatar.name + "': mesh '" + mesh.name + "', vertex " +
                  std::to_string(i) + ": not a number in clip '" + clip.name +
                  "'; export the avatar again");
    }
    geometry->positions.insert(geometry->positions.end(), posed.positions.begin(),
                               posed.positions.end());
    geometry->normals.insert(geometry->normals.end(), posed.normals.begin(), posed.normals.end());
  }
  return Ok();
}

std::string Names(const std::vector<ImpostorClipOptions>& clips) {
  std::string names;
  for (const ImpostorClipOptions& clip : clips) names += (names.empty() ? "" : ", ") + clip.name;
  return names;
}

int UsableImage(const Avatar& avatar, const Mesh& mesh, const Material& material,
                std::vector<std::string>* warnings) {
  const int image = material.base_color_image;
  if (image < 0) return -1;
  std::string why;
  if (static_cast<size_t>(image) >= avatar.images.size() ||
      avatar.images[static_cast<size_t>(image)].bytes.empty()) {
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
      const Material& material = avatar.materials[static_cast<size_t>(mesh.material)];
      view.image = UsableImage(avatar, mesh, material, warnings);
      view.mask = material.alpha != Material::Alpha::kOpaque;
      view.cutoff = material.alpha_cutoff;
      view.double_sided = material.double_sided;
    }
    all.push_back(view);
  }
  return all;
}

Error PoseFrames(const Avatar& avatar, const std::vector<ImpostorClipOptions>& clips,
                 ViewGeometry* geometry) {
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
      const float time_s =
          clip->duration_s * static_cast<float>(phase) / static_cast<float>(wanted.phases);
      if (Error error = AppendPose(avatar, *clip, time_s, geometry)) return error;
    }
  }
  if (geometry->frames == 0) return Fail(name + " has none of the clips " + Names(clips));
  return Ok();
}

ViewExtent MeasureExtent(const ViewGeometry& geometry, int directions,
                         const std::vector<float>& elevations_deg) {
  std::vector<bool> drawn(geometry.uvs.size(), false);
  for (uint32_t index : geometry.indices) drawn[index] = true;
  ViewExtent extent;
  extent.bottom_m = extent.top_m = 0;
  for (float elevation_deg : elevations_deg) {
    const float elevation = elevation_deg * kPi / 180;
    const float e_cos = std::cos(elevation), e_sin = std::sin(elevation);
    for (int d = 0; d < directions; ++d) {
      const float azimuth = 2 * kPi * static_cast<float>(d) / static_cast<float>(directions);
      const float a_cos = std::cos(azimuth), a_sin = std::sin(azimuth);
      for (size_t i = 0; i < geometry.positions.size(); ++i) {
        if (!drawn[i % drawn.size()]) continue;
        const Vec3 p = geometry.positions[i];
        const float right = p.x * a_cos - p.z * a_sin;
        const float near = p.x * a_sin + p.z * a_cos;
        const float up = p.y * e_cos - near * e_sin;
        extent.half_width_m = std::max(extent.half_width_m, std::abs(right));
        extent.bottom_m = std::min(extent.bottom_m, up);
        extent.top_m = std::max(extent.top_m, up);
        extent.depth_m = std::max(extent.depth_m, std::abs(near * e_cos + p.y * e_sin));
      }
    }
  }
  return extent;
}

}  // namespace flaneur
