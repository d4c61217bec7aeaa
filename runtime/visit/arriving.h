// What the loader reads of a pack that arrives in pieces, and when. Internal to runtime/visit.
#pragma once
#include <vector>

#include "runtime/pack/tour_pack.h"
#include "runtime/render/assets.h"

namespace flaneur {

// Of AssetsOf the town stands twice: first what of it is there at the beginning, at the end all of it, as index 1; and
// of each atlas level 1 comes before level 0, which is all of it.
inline constexpr int kWholeTown = 1, kBeginningOfAtlas = 1;

// In order: what is there, as far as a first picture with people takes it, and then everything else. `stages` as of
// StagesOf.
std::vector<AssetId> AssetsWhileArriving(const PackFile& file, const TourPack& pack, AssetStages* stages);

// Of a level, a picture or an atlas: whether it can be read. pack: with the guide's figure.
bool IsThere(const AssetId& asset, const PackFile& file, const TourPack& pack);
// Of a mesh.
bool IsThere(int mesh, const PackFile& file);

}  // namespace flaneur
