// What an asset holds between its preparation and its upload. Internal to runtime/render.
#pragma once
#include <array>

#include "runtime/render/assets.h"
#include "runtime/render/person_geometry.h"
#include "runtime/render/textures.h"
#include "runtime/render/town_geometry.h"
#include "runtime/render/wall_shade.h"

namespace flaneur {

struct Asset::Content {
  TownGeometry town;
  WallShade wall_shade;                       // with the town
  std::vector<std::vector<uint8_t>> picture;  // by level
  PersonGeometry person;
  ShadowLevels shadows;                            // with the coarsest level alone
  std::array<AtlasPicture, kAtlasPictures> atlas;  // as BuildAtlas
};

}  // namespace flaneur
