// Everything a bake made, written as one tour pack: a glTF binary that any viewer opens, with the tour in its root
// extension.
#pragma once
#include <filesystem>
#include <vector>

#include "pipeline/core/avatar.h"
#include "pipeline/core/footprint.h"
#include "pipeline/core/impostor.h"
#include "pipeline/core/scene.h"
#include "pipeline/io/encode_avatar.h"
#include "pipeline/io/gltf_builder.h"
#include "pipeline/pack/encode_town.h"
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
  float height_spread = 0, breadth_spread = 0;  // as PackAvatar's
  // By EncodeTourAvatar:
  EncodedAvatar encoded = {};
  float reach_m = 0;                     // see Reach_m
  std::vector<int> prop_triangles = {};  // by prop
};

struct TourParts : TourData {
  Scene town;
  EncodedTown encoded_town;  // by EncodeTown
  std::vector<TourAvatar> avatars;
  Footprints footprints;
  GroundRaster ground;
  std::vector<std::vector<uint8_t>> sounds;    // files, as stops, hotspots and sound places number them
  std::vector<std::vector<uint8_t>> pictures;  // files (PNG or JPEG), as hotspots number them
  TitlePage title_page;
};

// An impostor's buffer views.
struct ImpostorViews {
  int cells = -1, albedo = -1, normal = -1, depth = -1, motion = -1, tints = -1;
};

// Where the glTF part of the pack put what the extension refers to.
struct TourIndices {
  std::vector<AvatarPart> avatars;
  std::vector<ImpostorViews> impostors;  // one an avatar
  int height_view = -1, kind_view = -1;
  int people_view = -1, loiter_view = -1;             // -1: no painting
  int title_picture_view = -1, title_logo_view = -1;  // -1: none
  std::vector<int> sounds;                            // views, by sound
  std::vector<int> pictures;                          // views, by picture
};

// The glTF part of a pack: most of the work and of the bytes. What tour.toml alone says may change without it.
struct TourModels {
  std::vector<uint8_t> glb;
  TourIndices indices;
};

// Fills in the avatar's last three fields from the others. Errors: as for EncodeAvatar.
Error EncodeTourAvatar(TourAvatar* avatar, Jobs* jobs);

// The avatar without what its models hold already: meshes, pictures, keys.
TourAvatar WithoutBulk(const TourAvatar& avatar);

// Of an encoded town and encoded avatars. Scene 0 is the town; one scene more holds each avatar. The same parts give
// the same bytes. Errors: meshes that do not fit into a glTF file (names them).
Error BuildModels(const TourParts& parts, TourModels* models);

// `parts` may be without the town, and its avatars WithoutBulk. Errors: as for WriteFile; a pack that the player would
// refuse, as of more than runtime/base/limits.h allows (says of what), stands there then all the same.
Error WriteTourPack(const std::filesystem::path& path, const TourParts& parts, TourModels models, size_t* bytes);

}  // namespace flaneur
