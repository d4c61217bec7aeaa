#include "pipeline/cli/tint_reach.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "runtime/base/pixels.h"
#include "runtime/base/random.h"
#include "runtime/base/srgb.h"

namespace flaneur {
namespace {

constexpr int kPlaces = 4;  // a triangle

Vec3 Texel(const Pixels& picture, Vec2 uv) {
  const auto at = [](float t, int size) { return std::min(size - 1, static_cast<int>((t - std::floor(t)) * static_cast<float>(size))); };
  const size_t first = 4 * (static_cast<size_t>(at(uv.y, picture.height)) * static_cast<size_t>(picture.width) + static_cast<size_t>(at(uv.x, picture.width)));
  const auto channel = [&](size_t k) { return static_cast<float>(picture.rgba[first + k]) / 255; };
  return {channel(0), channel(1), channel(2)};
}

// Of a linear factor, times a picture's sRGB as the player multiplies them.
Vec3 Shown(Vec3 picture, Vec4 factor) {
  return {picture.x * SrgbFromLinear(std::clamp(factor.x, 0.0f, 1.0f)), picture.y * SrgbFromLinear(std::clamp(factor.y, 0.0f, 1.0f)),
          picture.z * SrgbFromLinear(std::clamp(factor.z, 0.0f, 1.0f))};
}

struct Place { Vec3 color; float area = 0; };

// Places all over the mesh.
void AddPlaces(const Mesh& mesh, const Material& material, const Pixels* picture, std::vector<Place>* places) {
  Random random;
  for (size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const auto corner = [&](const auto& values, size_t k) { return values[mesh.indices[t + k]]; };
    const Vec3 a = corner(mesh.positions, 0), ab = corner(mesh.positions, 1) - a, ac = corner(mesh.positions, 2) - a;
    for (int k = 0; k < kPlaces; ++k) {
      float u = random.Uniform(), v = random.Uniform();
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const auto mixed = [&](const auto& values) { return corner(values, 0) * (1 - u - v) + corner(values, 1) * u + corner(values, 2) * v; };
      Vec4 factor = material.base_color;
      if (!mesh.colors.empty()) {
        const Vec4 c = mixed(mesh.colors);
        factor = {factor.x * c.x, factor.y * c.y, factor.z * c.z, 1};
      }
      const Vec3 own = picture != nullptr && !mesh.uvs.empty() ? Texel(*picture, mixed(mesh.uvs)) : Vec3{1, 1, 1};
      places->push_back({Shown(own, factor), Length(Cross(ab, ac))});
    }
  }
}

}  // namespace

Error TintReach(const Avatar& avatar, const std::vector<PackTint>& tints, std::vector<float>* shares) {
  std::map<int, Pixels> pictures;
  std::vector<Place> places;
  for (const Mesh& mesh : avatar.meshes) {
    const Material material = mesh.material >= 0 ? avatar.materials[static_cast<size_t>(mesh.material)] : Material{};
    const int image = material.base_color_image;
    if (image >= 0 && !pictures.contains(image)) {
      auto decoded = Decoded(avatar.images[static_cast<size_t>(image)].bytes);
      if (!decoded) return Fail("avatar '" + avatar.name + "': image '" + avatar.images[static_cast<size_t>(image)].name + "' cannot be decoded");
      pictures[image] = std::move(*decoded);
    }
    AddPlaces(mesh, material, image >= 0 ? &pictures[image] : nullptr, &places);
  }
  float whole = 0;
  shares->assign(tints.size(), 0);
  for (const Place& place : places) {
    whole += place.area;
    for (size_t t = 0; t < tints.size(); ++t) (*shares)[t] += place.area * TintShare(tints[t], place.color);
  }
  for (float& share : *shares) share /= std::max(whole, 1e-9f);
  return Ok();
}

}  // namespace flaneur
