// The tour pack: a glTF binary with the root extension FLANEUR_tour, as the runtime sees it after loading.
// Geometry in glTF axes (Y up), everything of the tour on the ground plane (x east, y north, z up). Metres, seconds, radians.
// The extension's JSON mirrors these structs name for name (see docs/pack-format.md and runtime/pack/FLANEUR_tour.schema.json).
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/base/math.h"
#include "runtime/pack/texture.h"
#include "runtime/pack/tint.h"

namespace flaneur {

inline constexpr int kTourPackVersion = 3;
inline constexpr const char* kTourExtension = "FLANEUR_tour";

struct PackImage {           // decoded, 8 bits a channel
  int width_px = 0, height_px = 0;
  std::vector<uint8_t> rgba; // top row first; empty where only the size has been read
};

struct PackMaterial {
  std::string name;
  Vec4 base_color{1, 1, 1, 1};  // linear
  int base_color_image = -1;    // index into TourPack::images, sRGB
  bool double_sided = false;
  bool alpha_mask = false;      // BLEND is drawn as a mask too
  float alpha_cutoff = 0.5f;
};

struct PackPrimitive {
  int material = -1;
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;
  std::vector<Vec2> uvs;                        // empty: none
  std::vector<Vec4> colors;                     // empty: white
  std::vector<std::array<uint16_t, 4>> joints;  // empty: not skinned
  std::vector<std::array<float, 4>> weights;
  std::vector<uint32_t> indices;
};

struct PackMesh { std::vector<PackPrimitive> primitives; };

struct TownInstance {
  std::string name;
  int mesh = 0;  // index into TourPack::meshes
  Mat4 world;
};

// Skinning matrices (avatar space), sampled at a constant rate; frame `frames` would equal frame 0.
struct PackClip {
  float duration_s = 0;
  int frames = 0;
  std::vector<Mat4> matrices;  // frames x joints, frame by frame
};

struct PackLevel {
  int mesh = 0;
  int triangles = 0;
  float error_mm = 0, posed_error_mm = 0, switch_px = 0;
};

// What some people of an avatar have: a mesh on the avatar's joints, drawn beside any of its levels and its impostor.
struct PackProp {
  std::string name;
  int mesh = 0, triangles = 0;
  float share = 0;           // of the people
  std::string slot;          // of those with the same one a person has one at most; empty: its own
};
inline constexpr size_t kMostProps = 7;

struct PackImpostorClip { std::string name; int first_frame = 0, phases = 0; };

struct PackImpostorCell { int16_t x = 0, y = 0, width = 0, height = 0, origin_x = 0, origin_y = 0; };

// Meaning of the fields: docs/pack-format.md says how an atlas is laid out.
struct PackImpostor {
  int directions = 0, frames = 0;
  std::vector<float> elevations_deg;
  int width_px = 0, height_px = 0;
  float texel_m = 0, depth_range_m = 0, motion_range_m = 0, bend_range_m = 0;
  std::vector<PackImpostorClip> clips;
  std::vector<PackImpostorCell> cells;
  PackTexture albedo, normal, depth, motion;  // without levels where a pack is loaded without its pictures
};

struct PackAvatar {
  std::string name;
  float share = 1;           // of the crowd, relative to the others'
  float height_m = 1.75f, radius_m = 0.25f;
  float walk_speed_mps = 1.3f;  // at which the walk clip's feet don't slide
  int joints = 0;
  PackClip walk, idle, talk; // always present: a missing talk is the idle, a missing idle a standing pose
  std::vector<PackLevel> levels;  // finest first, at least one
  std::vector<PackTint> tints;    // at most kMostTints
  std::vector<PackProp> props;    // at most kMostProps
  PackImpostor impostor;
  int impostor_of = -1;      // index of the avatar whose impostor stands for this one too, which brings none; -1: its own
};

struct PackObstacle {        // a polygon with holes, or a circle where radius_m > 0
  std::string name, kind;
  std::vector<Vec2> outer;   // anticlockwise
  std::vector<std::vector<Vec2>> holes;
  Vec2 center;
  float radius_m = 0;
};

// Raster of the walkable surface; the layout is GroundRaster's (pipeline/core/footprint.h).
// kind: 0 none, 1 carriageway, 2 pavement, 3 square, 4 grass.
struct PackGround {
  Vec2 min_m;
  float cell_m = 0;
  int columns = 0, rows = 0;
  std::vector<float> height_m;
  std::vector<uint8_t> kind;
};

// Where people come from and go to. kind: door, exit, goal (go there), loiter (stand there a while), spawn (start there).
struct PackPlace {
  std::string name, kind;
  Vec2 position_m;
  float width_m = 1;
  std::optional<float> yaw_rad = std::nullopt;  // loiter: where people look; door, exit: the way out of it
};

// Where people are, painted over the town: strengths by cell of the area, row 0 the southernmost. No columns: nothing is painted.
struct PackPainting {
  Vec2 min_m;
  float cell_m = 0;
  int columns = 0, rows = 0;
  std::vector<uint8_t> people;  // share of those who start there and go there; all 0: everywhere alike
  std::vector<uint8_t> loiter;  // where people stand about; all 0: at the loiter places
};

// The cell at p, -1 outside.
inline int PaintingCell(const PackPainting& painting, Vec2 p) {
  const Vec2 off = (p - painting.min_m) * (1 / painting.cell_m);
  if (!(off.x >= 0 && off.y >= 0 && off.x < static_cast<float>(painting.columns) && off.y < static_cast<float>(painting.rows))) return -1;
  return static_cast<int>(off.y) * painting.columns + static_cast<int>(off.x);
}

struct StopSound { int sound = 0; float duration_s = 0; };  // sound: index into TourPack::sounds

struct TourStop {
  Vec2 position_m;
  float yaw_rad = 0, pause_s = 0;
  std::string caption = {};                         // in the pack's language
  std::map<std::string, std::string> captions = {};  // by language, in all others
  std::map<std::string, StopSound> sounds = {};      // by language, what is said there
};

struct CrowdSettings {
  int people = 200;
  uint64_t seed = 1;
  float preferred_speed_mps = 1.3f, speed_spread_mps = 0.2f, top_speed_mps = 1.9f;
  float loiter_share = 0.15f;  // of the people, standing at loiter places at any time
  float group_share = 0.4f;    // of the people, who walk in groups of 2 to 4
};

struct ControlSettings {
  std::string method = "count";   // count | frame_time
  std::string adaptation = "full"; // off | paper | full
  int high_limit = 12;
  float target_ms = 16.7f;
  int budget_triangles = 200000;  // for all visible people together
  float r_personal_m = 0.6f, r_high_m = 10, r_unimportant_m = 40, r_far_m = 200;
  float fov_rad = kPi / 3;        // horizontal
  float step_hz = 30;
  float max_yaw_rate_dps = 120, camera_speed_mps = 1.4f;
};

struct LightSettings {
  float sun_azimuth_rad = 0.75f * kPi, sun_elevation_rad = kPi / 4.5f;  // direction to the sun at the start
  float day_length_s = 600;  // time for the sun's way across the sky; 0: it stands still
};

struct TourPack {
  std::string name;
  std::vector<PackImage> images;
  std::vector<PackMaterial> materials;
  std::vector<PackMesh> meshes;
  std::vector<TownInstance> town;
  std::vector<PackAvatar> avatars;
  std::vector<PackObstacle> obstacles;
  PackGround ground;
  std::vector<PackPlace> places;
  PackPainting painting;
  std::vector<TourStop> path;  // guided path, in order; pause 0 and no caption: only a waypoint
  std::map<std::string, std::string> titles;  // what visitors read, by language; empty: the name
  std::string language = "en"; // of the stops' captions, where nothing else is said
  std::vector<std::vector<uint8_t>> sounds;  // files: WAV, FLAC, Ogg Vorbis or Opus, MP3
  std::string guide;           // name of the avatar who leads the way along the path; empty: nobody does
  CrowdSettings crowd;
  ControlSettings control;
  LightSettings light;
};

// A tour pack that stands open. Everything but its bulk is read at once, which is enough for a run without drawing; of images the
// sizes and of meshes the primitives' materials are there as well. The bulk is read piece by piece, in any order, from any thread.
// Errors: those of LoadTourPack, each of the piece that it is about.
class PackFile {
 public:
  PackFile();
  PackFile(PackFile&&) noexcept;
  PackFile& operator=(PackFile&&) noexcept;
  ~PackFile();
  Error Open(const std::filesystem::path& path, TourPack* pack);
  Error Open(std::vector<uint8_t> bytes, const std::string& name, TourPack* pack);
  Error ReadImage(int image, PackImage* out) const;
  Error ReadMesh(int mesh, PackMesh* out) const;
  Error ReadAtlas(int avatar, PackImpostor* out) const;  // with its pictures

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

struct LoadOptions { bool geometry_and_images = true; };  // false: enough for a run without drawing

// The bytes are not trusted: every offset, count and index is checked.
// Errors: no such file, not a glTF binary, truncated, no FLANEUR_tour, a newer version, an index out of range (names it).
Error LoadTourPack(const std::filesystem::path& path, const LoadOptions& options, TourPack* pack);

// The same from memory; `name` stands for the path in messages.
Error ParseTourPack(std::vector<uint8_t> bytes, const std::string& name, const LoadOptions& options, TourPack* pack);

}  // namespace flaneur
