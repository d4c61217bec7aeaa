// The bulk of a pack, piece by piece as the renderer takes it: prepared on any thread, uploaded on the one with the
// context.
#pragma once
#include <array>
#include <memory>
#include <vector>

#include "runtime/pack/tour_pack.h"
#include "runtime/render/atlas_pictures.h"

namespace flaneur {

struct SurfacePlan;
struct TownGeometry;

// kTown: all of the town's meshes. kPicture: an image. kLevel: a level of an avatar, or
// behind them one of its props. kAtlas: an avatar's impostor.
enum class AssetKind { kTown, kPicture, kLevel, kAtlas };
struct AssetId {
  AssetKind kind = AssetKind::kTown;
  int index = 0, level = 0;
  bool operator==(const AssetId&) const = default;
};

// All pieces of a pack in the order in which they are missed: the town and its pictures, people as impostors with their
// shadows, their pictures, and their levels from the coarsest on.
std::vector<AssetId> AssetsOf(const TourPack& pack);

// How many of them are about the town, and then about everybody's first likeness.
struct AssetStages {
  size_t town = 0, likenesses = 0;
};
AssetStages StagesOf(const std::vector<AssetId>& assets);

// What a piece is made of: meshes of the pack, or an image, or an atlas, by their indices.
std::vector<int> MeshesOf(const AssetId& asset, const TourPack& pack);

// What making pieces ready needs of a pack whose bulk is read piece by piece: images, materials, meshes, the town, and
// of avatars their levels, props and atlases.
TourPack PartsForAssets(const TourPack& pack);

// Ready to be uploaded.
struct Asset {
  Asset();
  Asset(Asset&&) noexcept;
  Asset& operator=(Asset&&) noexcept;
  ~Asset();
  AssetId id;
  struct Content;
  std::unique_ptr<Content> content;
};

// A level of an avatar or a prop, made of this mesh.
Asset PrepareLevel(const TourPack& pack, const AssetId& id, const PackMesh& mesh, const SurfacePlan& plan);

// Of a pack that holds what the piece is made of.
Asset PrepareAsset(const TourPack& pack, const AssetId& id, const SurfacePlan& plan, const AtlasFormats& formats);

// The town's, of a geometry that was built in parts (town_geometry.h).
Asset PrepareTown(const TourPack& pack, const AssetId& id, TownGeometry geometry);

// An impostor's, of pictures that were made ready in steps.
Asset PrepareAtlas(const AssetId& id, std::array<AtlasPicture, kAtlasPictures> pictures);

// A picture's, of a layer that was prepared in steps (surface_plan.h).
Asset PreparePicture(const AssetId& id, std::vector<std::vector<uint8_t>> layer);

}  // namespace flaneur
