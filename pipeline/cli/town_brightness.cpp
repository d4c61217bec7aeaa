#include "pipeline/cli/town_brightness.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "runtime/base/array.h"
#include "runtime/base/jobs.h"
#include "runtime/base/pixels.h"

namespace flaneur {
namespace {

constexpr float kMadeFor = 0.23f, kLeast = 0.4f;
constexpr size_t kLooks = 4096;   // pixels of a picture
constexpr float kUpwards = 0.5f;  // of a normal
constexpr Vec3 kLuminance{0.2126f, 0.7152f, 0.0722f};

float Linear(uint8_t value) { return std::pow(static_cast<float>(value) / 255, 2.2f); }

// White where it cannot be read: the pack says so itself.
Vec3 MeanOf(const Image& image) {
  const auto pixels = Decoded(image.bytes);
  if (!pixels) return {1, 1, 1};
  const size_t count = pixels->rgba.size() / 4, step = std::max<size_t>(1, count / kLooks);
  Vec3 sum;
  float weight = 0;
  for (size_t k = 0; k < count; k += step) {
    const uint8_t* p = &pixels->rgba[4 * k];
    const float alpha = static_cast<float>(p[3]) / 255;
    sum = sum + Vec3{Linear(p[0]), Linear(p[1]), Linear(p[2])} * alpha;
    weight += alpha;
  }
  return weight > 0 ? sum * (1 / weight) : Vec3{1, 1, 1};
}

struct Surfaces {
  double area_m2 = 0, light = 0;
  double Mean() const { return area_m2 > 0 ? light / area_m2 : 0; }
};

void AddMesh(const Mesh& mesh, const Mat4& world, Vec3 color, Surfaces* level, Surfaces* upright) {
  const auto tint = [&](uint32_t i) {
    if (mesh.colors.empty()) return Vec3{1, 1, 1};
    const Vec4& c = mesh.colors[i];
    return Vec3{c.x, c.y, c.z};
  };
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const uint32_t* t = &mesh.indices[i];
    const auto at = [&](size_t k) { return TransformPoint(world, mesh.positions[t[k]]); };
    const Vec3 normal = Cross(at(1) - at(0), at(2) - at(0));
    const float twice_m2 = Length(normal);
    if (!(twice_m2 > 0)) continue;
    const Vec3 mean = (tint(t[0]) + tint(t[1]) + tint(t[2])) * (1.0f / 3);
    Surfaces* of = std::abs(normal.y) > kUpwards * twice_m2 ? level : upright;
    of->area_m2 += static_cast<double>(twice_m2);
    of->light +=
        static_cast<double>(twice_m2 * Dot(kLuminance, Vec3{mean.x * color.x, mean.y * color.y, mean.z * color.z}));
  }
}

}  // namespace

float BrightnessOf(const Scene& town, Jobs* jobs) {
  std::vector<Vec3> pictures(town.images.size(), Vec3{1, 1, 1});
  ParallelFor(jobs, pictures.size(), [&](size_t i) { pictures[i] = MeanOf(town.images[i]); });
  Surfaces level, upright;
  for (const SceneNode& node : town.nodes) {
    for (const int m : node.meshes) {
      const Mesh& mesh = At(town.meshes, m);
      Vec3 color{1, 1, 1};
      if (mesh.material >= 0) {
        const Material& material = At(town.materials, mesh.material);
        color = {material.base_color.x, material.base_color.y, material.base_color.z};
        if (material.base_color_image >= 0) {
          const Vec3 picture = At(pictures, material.base_color_image);
          color = {color.x * picture.x, color.y * picture.y, color.z * picture.z};
        }
      }
      AddMesh(mesh, node.world, color, &level, &upright);
    }
  }
  return static_cast<float>(0.5 * (level.Mean() + upright.Mean()));
}

float ExposureFor(float brightness) { return std::clamp(kMadeFor / std::max(brightness, 1e-3f), kLeast, 1.0f); }

}  // namespace flaneur
