// Everything a bake made, written as one tour pack: a glTF binary that any viewer opens, with the tour in its root
// extension.
#pragma once
#include <filesystem>
#include <vector>

#include "pipeline/core/avatar.h"
#include "pipeline/core/footprint.h"
#include "pipeline/core/impostor.h"
#include "pipeline/core/scene.h"
#include "runtime/base/error.h"
#include "runtime/base/jobs.h"
#include "runtime/pack/tour_pack.h"
#include "runtime/tour_data/title_page.h"

namespace flaneur {

// Of one of the avatar's clips besides walk, idle and talk.
struct TourClip {
  std::string name;
  float seat_m = 0;     // height of the seat that it is made for; 0: it does not sit
  float speed_mps = 0;  // at which its feet don't slide; 0: it is on the spot
};

struct TourAvatar {
  AvatarLevels levels;
  ImpostorAtlas impostor;
  float share = 1;
  std::vector<Tint> tints = {};
  std::vector<Prop> props = {};  // one for each of the avatar's
  std::vector<TourClip> clips = {};
  float height_spread = 0;  // as PackAvatar's
};

struct TourParts : TourData {
  Scene town;
  std::vector<TourAvatar> avatars;
  Footprints footprints;
  GroundRaster ground;
  std::vector<std::vector<uint8_t>> sounds;    // files, as stops, hotspots and sound places number them
  std::vector<std::vector<uint8_t>> pictures;  // files (PNG or JPEG), as hotspots number them
  TitlePage title_page;
};

// Scene 0 is the town; one scene more holds each avatar. The same parts give the same bytes.
// Errors: geometry that cannot be compressed (names the mesh); as for WriteFile.
Error WriteTourPack(const std::filesystem::path& path, const TourParts& parts, Jobs* jobs, size_t* bytes);

}  // namespace flaneur
