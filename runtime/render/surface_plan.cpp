#include "runtime/render/surface_plan.h"

#include <algorithm>

#define STB_IMAGE_RESIZE_IMPLEMENTATION
#define STB_IMAGE_RESIZE_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wsign-compare"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb/stb_image_resize.h>
#pragma GCC diagnostic pop

#include "runtime/render/block_picture.h"
#include "runtime/render/mip_chain.h"

namespace flaneur {
namespace {

constexpr int kMaxLayers = 127;  // a vertex holds its layer in a signed byte
constexpr int kMinSide_px = 64;
constexpr int kMaxMipLevel = 16;

int Side_px(const PackImage& image, int most_px) {
  const int longest = std::max(image.width_px, image.height_px);
  int side = kMinSide_px;
  while (side < longest && side * 2 <= most_px) side *= 2;
  return side;
}

// By material: whether people alone show it.
std::vector<bool> MaterialsOfPeople(const TourPack& pack) {
  std::vector<bool> of_people(pack.materials.size(), false);
  const auto mark = [&](int mesh, bool people) {
    for (const PackPrimitive& p : pack.meshes[static_cast<size_t>(mesh)].primitives) {
      if (p.material >= 0) of_people[static_cast<size_t>(p.material)] = people;
    }
  };
  for (const PackAvatar& avatar : pack.avatars) {
    for (const PackLevel& level : avatar.levels) mark(level.mesh, true);
    for (const PackProp& prop : avatar.props) mark(prop.mesh, true);
  }
  for (const TownInstance& instance : pack.town) mark(instance.mesh, false);
  return of_people;
}

int ArrayFor(int side_px, bool blocks, std::vector<TextureArrayPlan>* arrays) {
  for (size_t k = 0; k < arrays->size(); ++k) {
    const TextureArrayPlan& a = (*arrays)[k];
    if (a.side_px == side_px && a.blocks == blocks && a.layers < kMaxLayers) return static_cast<int>(k);
  }
  arrays->push_back({side_px, 0, blocks});
  return static_cast<int>(arrays->size()) - 1;
}

int GroupFor(const SurfaceGroup& group, std::vector<SurfaceGroup>* groups) {
  const auto found = std::find(groups->begin(), groups->end(), group);
  if (found != groups->end()) return static_cast<int>(found - groups->begin());
  groups->push_back(group);
  return static_cast<int>(groups->size()) - 1;
}

}  // namespace

SurfacePlan PlanSurfaces(const TourPack& pack, const PictureLimits& limits) {
  SurfacePlan plan;
  plan.pictures.resize(pack.images.size());
  const std::vector<bool> of_people = MaterialsOfPeople(pack);
  std::vector<int> most_px(pack.images.size(), 0);
  std::vector<bool> cuts_out(pack.images.size(), false);
  for (size_t m = 0; m < pack.materials.size(); ++m) {
    const int image = pack.materials[m].base_color_image;
    if (image < 0) continue;
    if (pack.materials[m].alpha_mask) cuts_out[static_cast<size_t>(image)] = true;
    int& most = most_px[static_cast<size_t>(image)];
    most = std::max(most, of_people[m] ? limits.people_px : limits.town_px);
  }
  for (size_t i = 0; i < pack.images.size(); ++i) {
    if (most_px[i] == 0) continue;
    const int array = ArrayFor(Side_px(pack.images[i], most_px[i]), limits.blocks && !cuts_out[i], &plan.arrays);
    plan.pictures[i] = {array, plan.arrays[static_cast<size_t>(array)].layers++};
  }
  // Surfaces without a picture are drawn along with those of the first array.
  const int any = plan.arrays.empty() ? -1 : 0;
  for (const PackMaterial& m : pack.materials) {
    const PicturePlace place =
        m.base_color_image >= 0 ? plan.pictures[static_cast<size_t>(m.base_color_image)] : PicturePlace{any, -1};
    const int group =
        GroupFor({place.array, m.alpha_mask, m.double_sided, m.alpha_mask ? m.alpha_cutoff : 0}, &plan.groups);
    plan.surfaces.push_back({group, place.layer});
  }
  plan.surfaces.push_back({GroupFor({any, false, false, 0}, &plan.groups), -1});
  return plan;
}

const Surface& SurfaceOf(int material, const SurfacePlan& plan) {
  return material >= 0 ? plan.surfaces[static_cast<size_t>(material)] : plan.surfaces.back();
}

PackImage SquarePicture(const PackImage& image, int side_px) {
  if (image.width_px == side_px && image.height_px == side_px) return image;
  for (int k = 1; k < kMaxMipLevel; ++k) {  // a mip level of it, which takes a fraction of the time
    if (image.width_px == side_px << k && image.height_px == side_px << k) return MakeMipChain(image, true, k).back();
  }
  const size_t side = static_cast<size_t>(side_px);
  PackImage square{side_px, side_px, std::vector<uint8_t>(side * side * 4)};
  stbir_resize_uint8_srgb_edgemode(image.rgba.data(), image.width_px, image.height_px, 0, square.rgba.data(), side_px,
                                   side_px, 0, 4, 3, 0, STBIR_EDGE_WRAP);
  return square;
}

std::vector<PackImage> PreparePicture(const PackImage& image, int side_px) {
  std::vector<PackImage> levels{SquarePicture(image, side_px)};
  std::vector<PackImage> smaller = MakeMipChain(levels[0], true, kMaxMipLevel);
  for (PackImage& level : smaller) levels.push_back(std::move(level));
  return levels;
}

LayerBuilder::LayerBuilder(const PackImage& image, const TextureArrayPlan& array) : image_(&image), array_(array) {}

bool LayerBuilder::Advance() {
  if (levels_.empty()) {
    levels_.push_back(SquarePicture(*image_, array_.side_px));
    return false;
  }
  if (bytes_.empty()) {
    for (PackImage& level : MakeMipChain(levels_[0], true, kMaxMipLevel)) levels_.push_back(std::move(level));
    bytes_.resize(levels_.size());
    if (array_.blocks) return false;
  }
  for (size_t k = 0; k < levels_.size(); ++k)
    bytes_[k] = array_.blocks ? Bc1Blocks(levels_[k]) : std::move(levels_[k].rgba);
  return true;
}

std::vector<std::vector<uint8_t>> PrepareLayer(const PackImage& image, const TextureArrayPlan& array) {
  LayerBuilder builder(image, array);
  while (!builder.Advance()) {}
  return builder.Take();
}

}  // namespace flaneur
