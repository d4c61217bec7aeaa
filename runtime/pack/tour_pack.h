// The tour pack: a glTF binary with the root extension FLANEUR_tour, as the runtime sees it after loading.
// Geometry in glTF axes (Y up), everything of the tour on the ground plane (x east, y north, z up). Metres, seconds,
// radians. The extension's JSON mirrors these structs name for name (see docs/pack-format.md and
// runtime/pack/FLANEUR_tour.schema.json).
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/base/file_bytes.h"
#include "runtime/base/jobs.h"
#include "runtime/base/limits.h"
#include "runtime/base/math.h"
#include "runtime/pack/byte_ranges.h"
#include "runtime/pack/texture.h"
#include "runtime/tour_data/avatar_data.h"
#include "runtime/tour_data/tour_data.h"
#include "runtime/tour_data/turning_part.h"

namespace flaneur {

inline constexpr int kTourPackVersion = 4;
inline constexpr int kOldestTourPackVersion = 3;  // that is read; its atlases are not packed
inline constexpr int kCoarsestAtlasLevel = 3;     // of its mip levels: in coarser ones several cells share a texel
inline constexpr const char* kTourExtension = "FLANEUR_tour";

struct PackImage {  // decoded, 8 bits a channel
  int width_px = 0, height_px = 0;
  std::vector<uint8_t> rgba;  // top row first; empty where only the size has been read
};

struct PackMaterial {
  std::string name;
  Vec4 base_color{1, 1, 1, 1};  // linear
  int base_color_image = -1;    // index into TourPack::images, sRGB
  bool double_sided = false;
  bool alpha_mask = false;  // BLEND is drawn as a mask too
  float alpha_cutoff = 0.5f;
  uint8_t tints = 0xFF;  // bit t: its avatar's t-th tint may dye it
};

struct PackPrimitive {
  int material = -1;
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;
  std::vector<Vec2> uvs;                        // empty: none
  std::vector<Vec4> colors;                     // empty: white
  std::vector<std::array<uint16_t, 4>> joints;  // empty: not skinned
  std::vector<std::array<uint8_t, 4>> weights;  // in 1/255, which they sum to
  std::vector<uint32_t> indices;
};

struct PackMesh {
  std::vector<PackPrimitive> primitives;
};

struct TownInstance {
  std::string name;
  int mesh = 0;  // index into TourPack::meshes
  Mat4 world;
  int turning = -1;  // index into TourPack::turning; -1: it stands still
};

// Skinning matrices (avatar space), sampled at a constant rate; frame `frames` would equal frame 0.
struct PackClip {
  float duration_s = 0;
  int frames = 0;
  std::vector<Mat4> matrices;  // frames x joints, frame by frame
};

struct PackJoint {
  std::string name;  // of its node; may be empty
  int parent = -1;   // index of the joint next above it; -1: none
  Vec3 rest_m;       // where it begins in the pose that the vertices are in
};

// What some do beside walking, standing and talking: at places of work, by its name.
struct PackOtherClip {
  std::string name;
  PackClip clip;
  float seat_m = 0;     // height of the seat that it is made for; 0: it does not sit
  float speed_mps = 0;  // at which its feet don't slide; 0: it is on the spot
};

struct PackLevel {
  int mesh = 0;
  int triangles = 0;
  float error_mm = 0, posed_error_mm = 0, switch_px = 0;
};

// docs/pack-format.md says how an atlas is laid out.
struct PackImpostor : ImpostorLayout {
  PackTexture tints;  // by channel where each tint may dye; no levels: wherever the colour is right
  PackTexture albedo, normal, depth, motion;  // without levels where a pack is loaded without its pictures
};

struct PackProp : Prop {
  int mesh = 0;  // index into TourPack::meshes
};

struct PackAvatar {
  std::string name;
  float share = 1;  // of the crowd, relative to the others'
  float height_m = 1.75f, radius_m = 0.25f;
  float reach_m = 0.25f;    // of all that is drawn, about where the person stands: arms, clothes, props of the largest;
                            // radius_m or more
  float height_spread = 0;  // people are up to so much larger or smaller, as a share, 0 to kMaxHeightSpread,
  float breadth_spread = 0;     // and up to so much broader or narrower besides, 0 to kMaxBreadthSpread
  float walk_speed_mps = 1.3f;  // at which the walk clip's feet don't slide
  int joints = 0;
  std::vector<PackJoint> skeleton;         // a joint each
  PackClip walk, idle, talk;               // always present: a missing talk is the idle, a missing idle a standing pose
  std::vector<PackOtherClip> other_clips;  // at most kMaxOtherClips
  std::vector<PackLevel> levels;           // finest first, at least one
  std::vector<Tint> tints;                 // at most kMaxTints
  std::vector<PackProp> props;             // at most kMaxProps
  PackImpostor impostor;
  int impostor_of = -1;  // index of the avatar whose impostor stands for this one too, which brings none; -1: its own
};

struct TourPack : TourData {
  std::vector<PackImage> images;
  std::vector<PackMaterial> materials;
  std::vector<PackMesh> meshes;
  std::vector<TownInstance> town;
  std::vector<TurningPart> turning;
  std::vector<PackAvatar> avatars;
  Obstacles obstacles;
  SharedGround ground = Share({});
  std::vector<std::vector<uint8_t>> sounds;    // files: WAV, FLAC, Ogg Vorbis or Opus, MP3
  std::vector<std::vector<uint8_t>> pictures;  // of hotspots; files: PNG or JPEG
  // Where they stand in the pack: of one that arrives in pieces they are empty until somebody has put them together.
  std::vector<ByteRange> sound_ranges, picture_ranges;
};

// What a pack may ask for, beside the limits of runtime/base/limits.h: memory beside the file itself.
struct PackLimits {
  uint64_t memory_bytes = kPackMemory_bytes, pictures_bytes = kPackPictures_bytes;
};

// A tour pack that stands open. Everything but its bulk is read at once, which is enough for a run without drawing; of
// images the sizes and of meshes the primitives' materials are there as well. The bulk is read piece by piece, in any
// order, from any thread. What the pieces will ask for has been counted by then. Errors: those of LoadTourPack, each of
// the piece that it is about.
class PackFile {
 public:
  PackFile();
  PackFile(PackFile&&) noexcept;
  PackFile& operator=(PackFile&&) noexcept;
  ~PackFile();
  Error Open(const std::filesystem::path& path, TourPack* pack, const PackLimits& limits = {});
  Error Open(FileBytes bytes, const std::string& name, TourPack* pack, const PackLimits& limits = {});
  Error ReadImage(int image, PackImage* out) const;
  Error ReadMesh(int mesh, PackMesh* out) const;
  Error ReadPrimitive(int mesh, size_t primitive, PackPrimitive* out) const;  // one of the mesh's
  // With its pictures: of one that has not arrived as a whole the levels that are there, at least one of each.
  Error ReadAtlas(int avatar, PackImpostor* out) const;

  // A file that arrives in pieces: `bytes` are as many as it has, and of them so many are there that all but the bulk
  // can be read, and of each image what tells its size.
  Error Open(FileBytes bytes, ByteRanges there, const std::string& name, TourPack* pack);
  // More of it; whoever reads at the same time must be in this thread. Errors: beyond the file's end.
  Error Arrive(size_t offset, std::span<const uint8_t> bytes);
  bool IsWhole() const;  // or was never in pieces
  bool Holds(const std::vector<ByteRange>& ranges) const;
  // Where pieces of the bulk stand. finest_level: of an atlas's pictures this mip level, counted from the atlas's own
  // size, and coarser ones; 0: all. Empty where the file is broken: reading it says how.
  std::vector<ByteRange> RangesOfImage(int image) const;
  std::vector<ByteRange> RangesOfMesh(int mesh) const;
  std::vector<ByteRange> RangesOfAtlas(int avatar, int finest_level = 0) const;

 private:
  struct Impl;
  Error OpenPart(FileBytes bytes, std::optional<ByteRanges> there, const std::string& name, TourPack* pack,
                 const PackLimits& limits);
  template <typename Collect>
  std::vector<ByteRange> Ranges(Collect collect) const;
  std::unique_ptr<Impl> impl_;
};

struct LoadOptions {
  bool geometry_and_images = true;  // false: enough for a run without drawing
  Jobs* jobs = nullptr;             // decode with the caller
  PackLimits limits{};
};

// The bytes are not trusted: every offset, count and index is checked.
// Errors: no such file, not a glTF binary, truncated, no FLANEUR_tour, a newer version, an index out of range (names
// it), more than the limits allow.
Error LoadTourPack(const std::filesystem::path& path, const LoadOptions& options, TourPack* pack);

// The same from memory; `name` stands for the path in messages.
Error ParseTourPack(FileBytes bytes, const std::string& name, const LoadOptions& options, TourPack* pack);

}  // namespace flaneur
