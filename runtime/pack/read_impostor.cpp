#include "runtime/pack/read_impostor.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "runtime/base/array.h"
#include "runtime/base/limits.h"
#include "runtime/pack/allowance.h"
#include "runtime/pack/ktx2.h"

namespace flaneur {
namespace {

std::vector<ImpostorCell> ReadCells(const GltfFile& file, std::span<const uint8_t> bytes,
                                    const PackImpostor& impostor) {
  const size_t count =
      static_cast<size_t>(impostor.directions) * static_cast<size_t>(impostor.frames) * impostor.elevations_deg.size();
  using CellNumbers = std::array<int16_t, 6>;
  if (bytes.size() != count * sizeof(CellNumbers)) throw PackRefused("has an impostor with a wrong number of cells");
  constexpr uint64_t kCell_bytes = sizeof(CellNumbers) + 2 * sizeof(ImpostorCell);
  file.allowance->TakeMemory(Product(count, kCell_bytes), "an impostor's cells");
  file.allowance->TakeWork(count, "an impostor's cells");
  std::vector<CellNumbers> numbers(count);
  std::memcpy(numbers.data(), bytes.data(), bytes.size());
  std::vector<ImpostorCell> cells;
  cells.reserve(count);
  for (const auto& [x, y, width, height, origin_x, origin_y] : numbers)
    cells.push_back({x, y, width, height, origin_x, origin_y});
  for (const ImpostorCell& c : cells) {
    if (c.x < 0 || c.y < 0 || c.width < 1 || c.height < 1 || c.x + c.width > impostor.width_px ||
        c.y + c.height > impostor.height_px) {
      throw PackRefused("has an impostor with a cell outside its atlas");
    }
  }
  return cells;
}

ImpostorClip ReadPhases(const TourObject& json, std::string name, int frames) {
  ImpostorClip clip{std::move(name), json.Whole("first_frame", 0, 4095), json.Whole("phases", 1, 4096)};
  if (clip.first_frame + clip.phases > frames) json.Refuse("reaches beyond the atlas's frames");
  return clip;
}

void ReadOtherPhases(const TourObject& json, PackImpostor* impostor) {
  for (const TourObject& c : json.Objects("other_clips", kMaxOtherClips))
    impostor->clips.push_back(ReadPhases(c, c.Text("name"), impostor->frames));
}

void ReadAtlasPicture(const GltfFile& file, const TourObject& json, const char* view, TextureFormat format,
                      const PackImpostor& impostor, int halved, PackTexture* picture) {
  const int index = json.View(view, Member(file.json, "bufferViews").size());
  if (Error e = ReadKtx2Beginning(BeginningOfView(file, index), RangeOfView(file, index).bytes, picture))
    json.Refuse(std::string(view) + " " + e.message);
  int left_out = 0;  // levels
  while (left_out < kCoarsestAtlasLevel && picture->width_px < impostor.width_px >> (halved + left_out)) ++left_out;
  if (picture->format != format || picture->width_px != impostor.width_px >> (halved + left_out) ||
      picture->height_px != impostor.height_px >> (halved + left_out)) {
    json.Refuse(std::string(view) + " is a picture of another format or size than the atlas");
  }
}

// The same levels of all pictures, as many as the one has of which the fewest are there; normals are looked up on their
// own.
void LeaveOutLevels(PackImpostor* impostor) {
  const auto left_out = [&](const PackTexture& picture, int halved) {
    size_t count = 0;
    while (picture.width_px < impostor->width_px >> (static_cast<size_t>(halved) + count)) ++count;
    return count;
  };
  struct Halved {
    PackTexture* picture;
    int halved;
  };
  const Halved all[] = {{&impostor->albedo, 0}, {&impostor->depth, 0}, {&impostor->motion, 1}, {&impostor->tints, 1}};
  size_t most = 0;
  for (const Halved& h : all) most = std::max(most, h.picture->levels.empty() ? 0 : left_out(*h.picture, h.halved));
  for (const Halved& h : all) {
    for (size_t k = h.picture->levels.empty() ? most : left_out(*h.picture, h.halved);
         k < most && h.picture->levels.size() > 1; ++k) {
      h.picture->levels.erase(h.picture->levels.begin());
      h.picture->width_px >>= 1;
      h.picture->height_px >>= 1;
    }
  }
}

}  // namespace

PackImpostor ReadImpostor(const GltfFile& file, const TourObject& json) {
  constexpr double kAboveZero = TourObject::kAboveZero;
  PackImpostor out;
  out.directions = json.Whole("directions", 1, 1024);
  out.frames = json.Whole("frames", 1, 4096);
  out.elevations_deg = json.Reals("elevations_deg", -90, 90);
  if (out.elevations_deg.size() > kMostElevations) json.Refuse("has more than 64 elevations_deg");
  out.width_px = json.Whole("width_px", 1, kMostPictureSide_px);
  out.height_px = json.Whole("height_px", 1, kMostPictureSide_px);
  out.texel_m = json.Real("texel_m", kAboveZero, kMostSide_m);
  out.depth_range_m = json.Real("depth_range_m", kAboveZero, kMostSide_m);
  out.motion_range_m = json.Real("motion_range_m", kAboveZero, kMostSide_m);
  out.bend_range_m = json.Real("bend_range_m", kAboveZero, kMostSide_m);
  for (const TourObject& c : json.Objects("clips", 3))
    out.clips.push_back(ReadPhases(c, c.OneOf("name", {"walk", "idle", "talk"}), out.frames));
  if (out.clips.empty()) json.Refuse("has no clips");
  if (json.Has("other_clips")) ReadOtherPhases(json, &out);
  out.cells = ReadCells(file, BufferView(file, json.View("cells_view", Member(file.json, "bufferViews").size())), out);
  return out;
}

void ReadAtlas(const GltfFile& file, const TourObject& json, PackImpostor* impostor) {
  ReadAtlasPicture(file, json, "albedo_view", TextureFormat::kBc7Srgb, *impostor, 0, &impostor->albedo);
  ReadAtlasPicture(file, json, "normal_view", TextureFormat::kBc5, *impostor, 0, &impostor->normal);
  ReadAtlasPicture(file, json, "depth_view", TextureFormat::kBc4, *impostor, 0, &impostor->depth);
  ReadAtlasPicture(file, json, "motion_view", TextureFormat::kBc7, *impostor, 1, &impostor->motion);
  if (json.Has("tints_view"))
    ReadAtlasPicture(file, json, "tints_view", TextureFormat::kBc7, *impostor, 1, &impostor->tints);
  LeaveOutLevels(impostor);
}

}  // namespace flaneur
