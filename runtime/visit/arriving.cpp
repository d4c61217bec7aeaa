#include "runtime/visit/arriving.h"

#include <algorithm>

namespace flaneur {

bool IsThere(int mesh, const PackFile& file) { return file.Holds(file.RangesOfMesh(mesh)); }

bool IsThere(const AssetId& asset, const PackFile& file, const TourPack& pack) {
  switch (asset.kind) {
    case AssetKind::kTown: {
      const std::vector<int> meshes = MeshesOf(asset, pack);
      return std::all_of(meshes.begin(), meshes.end(), [&](int mesh) { return IsThere(mesh, file); });
    }
    case AssetKind::kPicture:
      return file.Holds(file.RangesOfImage(asset.index));
    case AssetKind::kAtlas:
      return file.Holds(asset.level == kBeginningOfAtlas ? file.RangesOfAtlas(asset.index, kCoarsestAtlasLevel)
                                                         : file.RangesOfAtlas(asset.index));
    case AssetKind::kLevel: {
      const PackAvatar& avatar = pack.avatars[static_cast<size_t>(asset.index)];
      if (avatar.impostor_of < 0) return IsThere(MeshesOf(asset, pack).front(), file);
      const PackAvatar& like = pack.avatars[static_cast<size_t>(avatar.impostor_of)];
      const auto level = static_cast<size_t>(asset.level);
      return level >= like.levels.size() ||
             (IsThere(like.levels[level].mesh, file) && IsThere(like.levels.front().mesh, file));
    }
  }
  return true;
}

std::vector<AssetId> AssetsWhileArriving(const PackFile& file, const TourPack& pack, AssetStages* stages) {
  std::vector<AssetId> assets{{AssetKind::kTown, 0, 0}}, likenesses, later;
  const std::vector<AssetId> all = AssetsOf(pack);
  const size_t first_likenesses = StagesOf(all).likenesses;
  for (size_t k = 0; k < all.size(); ++k) {
    AssetId asset = all[k];
    if (asset.kind == AssetKind::kTown) {
      asset.index = kWholeTown;
      if (!IsThere(asset, file, pack)) later.push_back(asset);
    } else if (k >= first_likenesses) {
      later.push_back(asset);
    } else if (IsThere(asset, file, pack)) {
      (asset.kind == AssetKind::kPicture ? assets : likenesses).push_back(asset);
    } else {
      later.push_back(asset);
      asset.level = kBeginningOfAtlas;
      if (asset.kind == AssetKind::kAtlas) likenesses.push_back(asset);
    }
  }
  stages->town = assets.size();
  stages->likenesses = assets.size() + likenesses.size();
  assets.insert(assets.end(), likenesses.begin(), likenesses.end());
  assets.insert(assets.end(), later.begin(), later.end());
  return assets;
}

}  // namespace flaneur
