// tour.toml: the one file that a user writes. assets_src/reference/tour.toml explains every setting.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/avatar/decimate.h"
#include "pipeline/cli/georeference.h"
#include "pipeline/cli/painting.h"
#include "pipeline/cli/title_page.h"
#include "pipeline/cli/visitor_settings.h"
#include "pipeline/footprint/extract_footprints.h"
#include "pipeline/footprint/findings.h"
#include "pipeline/footprint/rasterize_ground.h"
#include "pipeline/impostor/bake_impostor.h"
#include "runtime/base/error.h"
#include "runtime/pack/tour_pack.h"

namespace flaneur {

// A file, or a Blender script (.py) that makes one from a seed and options.
struct SourceSettings {
  std::filesystem::path file;  // relative ones are taken from tour.toml's folder
  int seed = 1;
  std::string options_json = "{}";
};

// One of several models that make up the town, placed on the ground plane.
struct TownPart {
  std::filesystem::path file;
  Vec2 position_m;
  float yaw_deg = 0;  // anticlockwise
  float scale = 1;    // metres per unit of the file
  std::string up;     // axis of the file that points up: "y", "-z", ...; empty: as the format says, else judged
};

// A clip besides walk, idle and talk.
struct ClipSettings {
  std::string name, clip;      // clip: in the avatar's file; empty: the one of that name
  float seat_m = 0;            // height of the seat that it is made for; 0: it does not sit
  float speed_mps = 0;         // at which its feet don't slide; 0: it is on the spot
  std::filesystem::path file;  // that holds it, see ClipRequest; empty: the avatar's
};

struct AvatarSettings {
  std::string name;
  SourceSettings source;
  float share = 1;                                      // of the crowd, relative to the others'
  float height_m = 0;                                   // 0: as in the file, see ReadAvatarOptions
  float height_spread = 0.04f, breadth_spread = 0.06f;  // as shares, 0 to kMaxHeightSpread and kMaxBreadthSpread
  float scale = 0;                                      // metres per unit of the file; 0: see ReadAvatarOptions
  std::string up, forward;                              // of the figure in the file; empty: found
  std::string walk, idle, talk;
  std::vector<std::string> hide;
  std::vector<std::filesystem::path> parts;  // further files on its skeleton
  // Of [[avatar.clip]] with the names walk, idle and talk, which need no place to ask for them.
  std::vector<ClipSettings> usual_clips;
  std::vector<Tint> tints;                               // at most kMaxTints
  std::vector<std::vector<std::string>> tint_materials;  // by tint: names of what it dyes; empty: all
  std::vector<Prop> props;
  std::vector<ClipSettings> clips;
};

// places: besides those tagged in the town.
struct TourSettings : TourData {
  SourceSettings town;        // empty file: only parts
  float town_scale = 1;       // metres per unit of the town's file
  std::string town_up;        // as of its parts
  Georeference georeference;  // of the town
  std::vector<TownPart> parts;
  std::vector<AvatarSettings> avatars;
  LevelsOptions levels;
  ImpostorOptions impostor;
  FootprintOptions footprints;
  GroundRasterOptions ground;
  std::vector<AcceptedFinding> accepted;  // of the check
  PaintingSettings painting_file;
  TitlePageSettings title_page;
  std::vector<FilesByLanguage> sounds;  // by stop of the path
  VisitorFiles visitor_files;
  std::map<std::filesystem::path, std::string> places_of_files;  // where tour.toml names it first: "FILE:LINE: key"
};

// The place for the beginning of a message: "tour.toml:12: avatar.file: ". Empty where it is not known.
std::string PlaceOfFile(const TourSettings& settings, const std::filesystem::path& file);
// The same of the file that a message begins with; of "person.glb: walk.bvh: ..." the last one that tour.toml names.
std::string PlaceOfMessage(const TourSettings& settings, std::string_view message);

// Errors: unreadable, not TOML, an unknown key (with the nearest known one), a wrong type, a value out of range, no
// town, no avatar, two of a name; each as FILE:LINE.
Error ReadTourSettings(const std::filesystem::path& path, TourSettings* settings);

// Every setting that may stand in tour.toml, as "section.key".
std::vector<std::string> KnownSettings();

}  // namespace flaneur
