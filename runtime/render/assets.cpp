#include "runtime/render/assets.h"

#include <algorithm>
#include <iterator>

#include "runtime/render/asset_content.h"
#include "runtime/render/frame.h"

namespace flaneur {
namespace {

constexpr float kShadowCells_m[] = {0.07f, 0.34f};

std::vector<bool> ImagesOfTown(const TourPack& pack) {
  std::vector<bool> of_town(pack.images.size(), false);
  for (const TownInstance& instance : pack.town) {
    for (const PackPrimitive& p : pack.meshes[static_cast<size_t>(instance.mesh)].primitives) {
      const int image = p.material < 0 ? -1 : pack.materials[static_cast<size_t>(p.material)].base_color_image;
      if (image >= 0) of_town[static_cast<size_t>(image)] = true;
    }
  }
  return of_town;
}

int MeshOf(const PackAvatar& avatar, int level) {
  const auto index = static_cast<size_t>(level);
  return index < avatar.levels.size() ? avatar.levels[index].mesh : avatar.props[index - avatar.levels.size()].mesh;
}

}  // namespace

Asset::Asset() = default;
Asset::Asset(Asset&&) noexcept = default;
Asset& Asset::operator=(Asset&&) noexcept = default;
Asset::~Asset() = default;

std::vector<AssetId> AssetsOf(const TourPack& pack) {
  std::vector<AssetId> ids{{AssetKind::kTown, 0, 0}};
  const std::vector<bool> of_town = ImagesOfTown(pack);
  const auto add_pictures = [&](bool town) {
    for (size_t i = 0; i < of_town.size(); ++i) {
      if (of_town[i] == town) ids.push_back({AssetKind::kPicture, static_cast<int>(i), 0});
    }
  };
  const int avatars = static_cast<int>(pack.avatars.size());
  const auto add_level = [&](int avatar, size_t from_coarsest) {
    const size_t levels = pack.avatars[static_cast<size_t>(avatar)].levels.size();
    if (from_coarsest < levels)
      ids.push_back({AssetKind::kLevel, avatar, static_cast<int>(levels - 1 - from_coarsest)});
  };
  add_pictures(true);
  for (int a = 0; a < avatars; ++a) {
    if (pack.avatars[static_cast<size_t>(a)].impostor_of < 0) ids.push_back({AssetKind::kAtlas, a, 0});
    add_level(a, 0);
  }
  add_pictures(false);
  for (int a = 0; a < avatars; ++a) {
    const PackAvatar& avatar = pack.avatars[static_cast<size_t>(a)];
    for (size_t k = 0; k < avatar.props.size(); ++k)
      ids.push_back({AssetKind::kLevel, a, static_cast<int>(avatar.levels.size() + k)});
  }
  size_t most = 0;
  for (const PackAvatar& avatar : pack.avatars) most = std::max(most, avatar.levels.size());
  for (size_t k = 1; k < most; ++k) {
    for (int a = 0; a < avatars; ++a) add_level(a, k);
  }
  return ids;
}

AssetStages StagesOf(const std::vector<AssetId>& assets) {
  const auto first = [&](AssetKind kind) {
    return static_cast<size_t>(
        std::find_if(assets.begin(), assets.end(), [&](const AssetId& a) { return a.kind == kind; }) - assets.begin());
  };
  size_t likenesses = first(AssetKind::kAtlas);
  const size_t town = likenesses;
  while (likenesses < assets.size() && assets[likenesses].kind != AssetKind::kPicture) ++likenesses;
  return {town, likenesses};
}

std::vector<int> MeshesOf(const AssetId& asset, const TourPack& pack) {
  std::vector<int> meshes;
  if (asset.kind == AssetKind::kLevel) {
    meshes.push_back(MeshOf(pack.avatars[static_cast<size_t>(asset.index)], asset.level));
  }
  if (asset.kind == AssetKind::kTown) {
    for (const TownInstance& instance : pack.town) meshes.push_back(instance.mesh);
    std::sort(meshes.begin(), meshes.end());
    meshes.erase(std::unique(meshes.begin(), meshes.end()), meshes.end());
  }
  return meshes;
}

TourPack PartsForAssets(const TourPack& pack) {
  TourPack parts;
  parts.images = pack.images;
  parts.materials = pack.materials;
  parts.meshes = pack.meshes;
  parts.town = pack.town;
  parts.turning = pack.turning;
  parts.obstacles = pack.obstacles;
  parts.ground = pack.ground;
  for (const PackAvatar& avatar : pack.avatars) {
    PackAvatar part;
    part.height_m = avatar.height_m;
    part.skeleton = avatar.skeleton;
    part.levels = avatar.levels;
    part.props = avatar.props;
    part.impostor = avatar.impostor;
    part.impostor_of = avatar.impostor_of;
    parts.avatars.push_back(std::move(part));
  }
  return parts;
}

Asset PrepareLevel(const TourPack& pack, const AssetId& id, const PackMesh& mesh, const SurfacePlan& plan) {
  Asset asset;
  asset.id = id;
  asset.content = std::make_unique<Asset::Content>();
  const PackAvatar& avatar = pack.avatars[static_cast<size_t>(id.index)];
  asset.content->person = BuildPersonGeometry(pack, mesh, plan);
  const bool coarsest = static_cast<size_t>(id.level) + 1 == avatar.levels.size();
  for (size_t k = 0; k < std::size(kShadowCells_m) && coarsest; ++k) {
    asset.content->shadows[k] =
        ShadowGeometry(asset.content->person, kShadowCells_m[k], static_cast<size_t>(kMaxShadowTriangles[k]));
  }
  return asset;
}

Asset PrepareTown(const TourPack& pack, const AssetId& id, TownGeometry geometry) {
  Asset asset;
  asset.id = id;
  asset.content = std::make_unique<Asset::Content>();
  asset.content->town = std::move(geometry);
  if (!GroundHasShade(pack)) asset.content->wall_shade = BuildWallShade(pack.obstacles, *pack.ground);
  return asset;
}

Asset PreparePicture(const AssetId& id, std::vector<std::vector<uint8_t>> layer) {
  Asset asset;
  asset.id = id;
  asset.content = std::make_unique<Asset::Content>();
  asset.content->picture = std::move(layer);
  return asset;
}

Asset PrepareAtlas(const AssetId& id, std::array<AtlasPicture, kAtlasPictures> pictures) {
  Asset asset;
  asset.id = id;
  asset.content = std::make_unique<Asset::Content>();
  asset.content->atlas = std::move(pictures);
  return asset;
}

Asset PrepareAsset(const TourPack& pack, const AssetId& id, const SurfacePlan& plan, const AtlasFormats& formats) {
  Asset asset;
  asset.id = id;
  asset.content = std::make_unique<Asset::Content>();
  const auto index = static_cast<size_t>(id.index);
  switch (id.kind) {
    case AssetKind::kTown:
      return PrepareTown(pack, id, BuildTownGeometry(pack, plan));
    case AssetKind::kPicture:
      if (plan.pictures[index].array >= 0) {
        asset.content->picture =
            PrepareLayer(pack.images[index], plan.arrays[static_cast<size_t>(plan.pictures[index].array)]);
      }
      break;
    case AssetKind::kLevel:
      return PrepareLevel(pack, id, pack.meshes[static_cast<size_t>(MeshOf(pack.avatars[index], id.level))], plan);
    case AssetKind::kAtlas:
      return PrepareAtlas(id, BuildAtlas(pack.avatars[index].impostor, formats));
  }
  return asset;
}

}  // namespace flaneur
