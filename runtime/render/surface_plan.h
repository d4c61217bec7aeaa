// Which pictures share a texture array, and which surfaces are therefore drawn together. Internal to runtime/render; no
// OpenGL.
#pragma once
#include <utility>
#include <vector>

#include "runtime/pack/tour_pack.h"

namespace flaneur {

struct TextureArrayPlan {
  int side_px = 1, layers = 0;
  bool blocks = false;
};  // blocks: Bc1Blocks instead of texels

// Surfaces that differ in nothing but the layer of one texture array.
struct SurfaceGroup {
  int array = -1;  // -1: no picture at all
  bool masked = false, double_sided = false;
  float alpha_cutoff = 0;
  bool operator==(const SurfaceGroup&) const = default;
};

struct Surface {
  int group = 0, layer = -1;
};  // layer -1: white
struct PicturePlace {
  int array = -1, layer = 0;
};

struct SurfacePlan {
  std::vector<TextureArrayPlan> arrays;
  std::vector<PicturePlace> pictures;  // by image of the pack; array -1: no surface shows it
  std::vector<SurfaceGroup> groups;
  std::vector<Surface> surfaces;  // by material; the last one of primitives without material
};

struct PictureLimits {
  int town_px = 4096, people_px = 1024;  // longest sides; larger pictures are made smaller
  bool blocks = false;                   // of pictures whose alpha nothing is cut out by
};

// Pictures become squares of a power of two, at least as large as they were within the limits, so that few arrays hold
// all of them. Only the images' sizes are looked at.
SurfacePlan PlanSurfaces(const TourPack& pack, const PictureLimits& limits);

const Surface& SurfaceOf(int material, const SurfacePlan& plan);

// A picture as its array holds it: side_px square, then half of that, down to one pixel.
std::vector<PackImage> PreparePicture(const PackImage& image, int side_px);
// By level the bytes that are uploaded.
std::vector<std::vector<uint8_t>> PrepareLayer(const PackImage& image, const TextureArrayPlan& array);
// The same in a few steps, for who has no thread for it. The image outlives it.
class LayerBuilder {
 public:
  LayerBuilder(const PackImage& image, const TextureArrayPlan& array);
  bool Advance();  // true: this was the last step
  std::vector<std::vector<uint8_t>> Take() { return std::move(bytes_); }

 private:
  const PackImage* image_;
  TextureArrayPlan array_;
  std::vector<PackImage> levels_;
  std::vector<std::vector<uint8_t>> bytes_;
};

}  // namespace flaneur
