#include "pipeline/cli/tint_reach.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "runtime/base/array.h"
#include "runtime/base/pixels.h"
#include "runtime/base/random.h"
#include "runtime/base/srgb.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

constexpr int kPlaces = 4;         // a triangle
constexpr float kOneCloth = 0.1f;  // apart, as tints measure it
constexpr float kBoxes = 12;       // along each side of the colours
constexpr int kRounds = 3;
constexpr size_t kMaxMainColors = 6;
constexpr int kMaxTries = 30;  // many of small parts of the surface
constexpr float kMinShare = 1.0f / 30;

Vec3 Texel(const Pixels& picture, Vec2 uv) {
  const auto at = [](float t, int size) {
    return std::min(size - 1, static_cast<int>((t - std::floor(t)) * static_cast<float>(size)));
  };
  const auto row = static_cast<size_t>(at(uv.y, picture.height)), column = static_cast<size_t>(at(uv.x, picture.width));
  const size_t first = 4 * (row * static_cast<size_t>(picture.width) + column);
  const auto channel = [&](size_t k) { return static_cast<float>(picture.rgba[first + k]) / 255; };
  return {channel(0), channel(1), channel(2)};
}

// Of a linear factor, times a picture's sRGB as the player multiplies them.
Vec3 Shown(Vec3 picture, Vec4 factor) {
  return {picture.x * SrgbFromLinear(std::clamp(factor.x, 0.0f, 1.0f)),
          picture.y * SrgbFromLinear(std::clamp(factor.y, 0.0f, 1.0f)),
          picture.z * SrgbFromLinear(std::clamp(factor.z, 0.0f, 1.0f))};
}

struct Place {
  Vec3 color;
  float area = 0;
  uint8_t tints = kEveryTint;  // that may dye it
};

// Places all over the mesh.
void AddPlaces(const Mesh& mesh, const Material& material, const Pixels* picture, std::vector<Place>* places) {
  Random random;
  for (size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    const auto corner = [&](const auto& values, size_t k) { return values[mesh.indices[t + k]]; };
    const Vec3 a = corner(mesh.positions, 0), ab = corner(mesh.positions, 1) - a, ac = corner(mesh.positions, 2) - a;
    for (int k = 0; k < kPlaces; ++k) {
      float u = random.Uniform(), v = random.Uniform();
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const auto mixed = [&](const auto& values) {
        return corner(values, 0) * (1 - u - v) + corner(values, 1) * u + corner(values, 2) * v;
      };
      Vec4 factor = material.base_color;
      if (!mesh.colors.empty()) {
        const Vec4 c = mixed(mesh.colors);
        factor = {factor.x * c.x, factor.y * c.y, factor.z * c.z, 1};
      }
      const Vec3 own = picture != nullptr && !mesh.uvs.empty() ? Texel(*picture, mixed(mesh.uvs)) : Vec3{1, 1, 1};
      places->push_back({Shown(own, factor), Length(Cross(ab, ac)), material.tints});
    }
  }
}

Error PlacesOf(const Avatar& avatar, std::vector<Place>* places) {
  std::map<int, Pixels> pictures;
  for (const Mesh& mesh : avatar.meshes) {
    const Material material = mesh.material >= 0 ? At(avatar.materials, mesh.material) : Material{};
    const int image = material.base_color_image;
    if (image >= 0 && !pictures.contains(image)) {
      auto decoded = Decoded(At(avatar.images, image).bytes);
      if (!decoded)
        return Fail("avatar '" + avatar.name + "': image '" + At(avatar.images, image).name + "' cannot be decoded");
      pictures[image] = std::move(*decoded);
    }
    AddPlaces(mesh, material, image >= 0 ? &pictures[image] : nullptr, places);
  }
  return Ok();
}

float AreaOf(const std::vector<Place>& places) {
  float whole = 0;
  for (const Place& place : places) whole += place.area;
  return std::max(whole, 1e-9f);
}

bool IsNear(Vec3 a, Vec3 b) { return Length(WithHalfLightness(a) - WithHalfLightness(b)) < kOneCloth; }

// The middle of the most crowded box of colours.
Vec3 Densest(const std::vector<Place>& places) {
  std::map<std::array<int, 3>, float> boxes;
  const auto box = [](float v) { return static_cast<int>(v * kBoxes); };
  for (const Place& p : places) boxes[{box(p.color.x), box(p.color.y), box(p.color.z)}] += p.area;
  const auto most =
      std::max_element(boxes.begin(), boxes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  const auto middle = [](int k) { return (static_cast<float>(k) + 0.5f) / kBoxes; };
  return {middle(most->first[0]), middle(most->first[1]), middle(most->first[2])};
}

// Of all near it; its share is their area.
MainColor Mean(const std::vector<Place>& places, Vec3 near) {
  MainColor mean;
  for (const Place& p : places) {
    if (!IsNear(p.color, near)) continue;
    mean.color = mean.color + p.color * p.area;
    mean.share += p.area;
  }
  mean.color = mean.color * (1 / std::max(mean.share, 1e-9f));
  return mean;
}

}  // namespace

Error MainColors(const Avatar& avatar, std::vector<MainColor>* colors) {
  std::vector<Place> places;
  if (Error e = PlacesOf(avatar, &places)) return e;
  const float whole = AreaOf(places);
  colors->clear();
  for (int k = 0; k < kMaxTries && !places.empty() && colors->size() < kMaxMainColors; ++k) {
    MainColor found = Mean(places, Densest(places));
    for (int round = 0; round < kRounds; ++round) found = Mean(places, found.color);
    const Vec3 color = found.color;
    const auto rest =
        std::remove_if(places.begin(), places.end(), [&](const Place& p) { return IsNear(p.color, color); });
    if (rest == places.end()) break;
    places.erase(rest, places.end());
    found.share /= whole;
    if (found.share >= kMinShare) colors->push_back(found);
  }
  std::sort(colors->begin(), colors->end(), [](const MainColor& a, const MainColor& b) { return a.share > b.share; });
  return Ok();
}

Error TintReach(const Avatar& avatar, const std::vector<Tint>& tints, std::vector<float>* shares) {
  std::vector<Place> places;
  if (Error e = PlacesOf(avatar, &places)) return e;
  const float whole = AreaOf(places);
  shares->assign(tints.size(), 0);
  for (const Place& place : places) {
    for (size_t t = 0; t < tints.size(); ++t) {
      if (place.tints >> t & 1) (*shares)[t] += place.area * TintShare(tints[t], place.color);
    }
  }
  for (float& share : *shares) share /= whole;
  return Ok();
}

Error BindTints(const std::vector<std::vector<std::string>>& names, Avatar* avatar) {
  for (size_t t = 0; t < names.size(); ++t) {
    if (names[t].empty()) continue;
    const auto bit = static_cast<uint8_t>(1u << t);
    for (Material& material : avatar->materials) material.tints = static_cast<uint8_t>(material.tints & ~bit);
    for (const std::string& name : names[t]) {
      bool found = false;
      for (Material& material : avatar->materials) {
        if (material.name != name) continue;
        found = true;
        material.tints = static_cast<uint8_t>(material.tints | bit);
      }
      if (found) continue;
      std::string known;
      for (const Material& material : avatar->materials) known += (known.empty() ? "" : ", ") + OneLine(material.name);
      return Fail("avatar '" + OneLine(avatar->name) + "': a tint is bound to the material '" + OneLine(name) +
                  "', which it has not; it has: " + known);
    }
  }
  return Ok();
}

}  // namespace flaneur
