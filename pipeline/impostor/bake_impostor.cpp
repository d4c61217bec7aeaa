#include "pipeline/impostor/bake_impostor.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "pipeline/core/blender.h"
#include "pipeline/core/temporary_folder.h"
#include "pipeline/impostor/atlas_image.h"
#include "pipeline/impostor/atlas_layers.h"
#include "pipeline/impostor/atlas_layout.h"
#include "pipeline/impostor/compress_atlas.h"
#include "pipeline/impostor/view_geometry.h"
#include "pipeline/pictures/picture_files.h"
#include "runtime/base/array.h"
#include "runtime/base/file.h"
#include "runtime/base/jobs.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kMaxAtlasPixels = 8192;    // what every desktop graphics card takes
constexpr int kPicturePixels = 1 << 21;  // that Blender renders at once
constexpr float kMaxShrink = 4;          // of a low person's cells
constexpr float kMaxTexels =
    3;  // of a person's picture, a texel of the atlas: players filter as much where the impostor takes over

Error CheckRange(const char* name, double value, double least, double most) {
  if (value >= least && value <= most) return Ok();
  return Fail(std::string("impostor: ") + name + " is " + json(value).dump() + ", must be " + json(least).dump() +
              " to " + json(most).dump());
}

Error CheckOptions(const ImpostorOptions& options) {
  if (Error e = CheckRange("directions", options.directions, 1, 64)) return e;
  if (Error e = CheckRange("height_px", options.height_px, 16, 1024)) return e;
  if (Error e = CheckRange("full_height_m", static_cast<double>(options.full_height_m), 0, 10)) return e;
  if (Error e = CheckRange("border_px", options.border_px, 1, 16)) return e;
  if (Error e = CheckRange("height_px less both borders", options.height_px - 2 * options.border_px, 8, 1024)) {
    return e;
  }
  if (Error e = CheckRange("memory_kb", options.memory_kb, 0, 1e6)) return e;
  if (Error e = CheckRange("samples", options.samples, 1, 4096)) return e;
  if (Error e = CheckRange("seed", options.seed, 0, 0x7FFFFFFF)) return e;
  if (Error e = CheckRange("threads", options.threads, 0, 1024)) return e;
  if (Error e = CheckRange("number of elevations", static_cast<double>(options.elevations_deg.size()), 1, 8)) {
    return e;
  }
  for (float elevation_deg : options.elevations_deg) {
    if (Error e = CheckRange("elevation", elevation_deg, -89, 89)) return e;
  }
  for (const ImpostorClipOptions& clip : options.clips) {
    if (Error e = CheckRange("number of phases", clip.phases, 1, 256)) return e;
  }
  return Ok();
}

std::string TooLarge(int most_px) {
  return "impostor: the atlas would be larger than " + std::to_string(most_px) + " x " + std::to_string(most_px) +
         " px; ask for fewer directions or phases, or a smaller height";
}

float HeightOf(const std::vector<ViewBounds>& views) {
  float bottom_m = 0, top_m = 0;
  for (const ViewBounds& view : views) {
    bottom_m = std::min(bottom_m, view.bottom_m);
    top_m = std::max(top_m, view.top_m);
  }
  return top_m - bottom_m;
}

// Square texels, of the wanted size where that fits into the memory, else larger ones.
Error LayOut(const ViewGeometry& geometry, const ImpostorOptions& options, ImpostorAtlas* atlas) {
  atlas->directions = options.directions;
  atlas->elevations_deg = options.elevations_deg;
  atlas->frames = geometry.frames;
  atlas->clips = geometry.clips;
  const auto views = MeasureViews(geometry, options.directions, options.elevations_deg);
  const float own_m = HeightOf(views);
  if (!(own_m > 0)) return Fail("impostor: the avatar is flat; nothing stands upright in it");
  const float height_m = std::clamp(options.full_height_m, own_m, kMaxShrink * own_m);
  const size_t most_bytes = static_cast<size_t>(options.memory_kb) * 1000;
  const int wanted_px = options.height_px - 2 * options.border_px;
  for (int inner_px = wanted_px; 2 * inner_px >= wanted_px; --inner_px) {
    atlas->texel_m = height_m / static_cast<float>(inner_px);
    if (!LayOutCells(views, options.border_px, atlas)) {
      if (options.memory_kb == 0) return Fail(TooLarge(kMaxAtlasPixels));
      continue;
    }
    if (most_bytes == 0 || TextureMemory(*atlas) <= most_bytes) break;
    atlas->width_px = 0;
  }
  if (atlas->width_px == 0)
    return Fail("impostor: so many pictures do not fit into " + std::to_string(options.memory_kb) +
                " kB; ask for fewer directions or phases, or for more memory");
  for (const ViewBounds& view : views) atlas->depth_range_m = std::max(atlas->depth_range_m, view.depth_m);
  atlas->depth_range_m = std::max(atlas->depth_range_m, atlas->texel_m);
  atlas->motion_range_m = std::max(Longest(geometry.motions, geometry), atlas->texel_m);
  atlas->bend_range_m = std::max(Longest(geometry.bends, geometry), atlas->texel_m);
  return Ok();
}

template <typename Element>
Error WriteArray(const fs::path& path, const std::vector<Element>& elements) {
  const auto* bytes = reinterpret_cast<const uint8_t*>(elements.data());
  return WriteFile(path, {bytes, elements.size() * sizeof(Element)});
}

Error WriteGeometry(const fs::path& folder, const ViewGeometry& geometry) {
  if (Error e = WriteArray(folder / "positions.f32", geometry.positions)) return e;
  if (Error e = WriteArray(folder / "normals.f32", geometry.normals)) return e;
  if (Error e = WriteArray(folder / "motions.f32", geometry.motions)) return e;
  if (Error e = WriteArray(folder / "bends.f32", geometry.bends)) return e;
  if (Error e = WriteArray(folder / "uvs.f32", geometry.uvs)) return e;
  if (Error e = WriteArray(folder / "colors.f32", geometry.colors)) return e;
  if (Error e = WriteArray(folder / "indices.u32", geometry.indices)) return e;
  return WriteArray(folder / "materials.u32", geometry.materials);
}

fs::path TexturePath(const fs::path& folder, size_t mesh) { return folder / ("texture_" + std::to_string(mesh)); }

// As fine as a mesh's picture is looked up where the impostor takes over.
Error ReduceToSeen(const Mesh& mesh, float texel_m, Image* image) {
  std::optional<Pixels> pixels = Decoded(image->bytes);
  if (!pixels) return Ok();  // Blender says why
  float excess = TexelsPerMetre(mesh, pixels->width, pixels->height) * texel_m;
  if (!(excess > kMaxTexels)) return Ok();
  for (; excess > kMaxTexels && std::min(pixels->width, pixels->height) > 1; excess /= 2) pixels = Halved(*pixels);
  return EncodePng(*pixels, true, image);
}

// One a mesh that has one.
Error WriteTextures(const fs::path& folder, const Avatar& avatar, const std::vector<ViewMaterial>& materials,
                    float texel_m) {
  for (size_t m = 0; m < materials.size(); ++m) {
    if (materials[m].image < 0) continue;
    Image image = At(avatar.images, materials[m].image);
    if (!materials[m].mask) {
      if (Error e = ReduceToSeen(avatar.meshes[m], texel_m, &image)) return e;
    }
    if (Error e = WriteFile(TexturePath(folder, m), image.bytes)) return e;
  }
  return Ok();
}

json MaterialSettings(const fs::path& folder, size_t mesh, const ViewMaterial& material) {
  return {{"texture", material.image >= 0 ? TexturePath(folder, mesh).string() : ""},
          {"mask", material.mask},
          {"cutoff", material.cutoff},
          {"double_sided", material.double_sided},
          {"tints", {material.tints & 1, material.tints >> 1 & 1, material.tints >> 2 & 1}}};
}

int BandRows(const ImpostorAtlas& atlas) { return std::clamp(kPicturePixels / atlas.width_px, 1, atlas.height_px); }

json CellSettings(const ImpostorAtlas& atlas) {
  json cells = json::array();
  const size_t directions = static_cast<size_t>(atlas.directions), elevations = atlas.elevations_deg.size();
  for (size_t i = 0; i < atlas.cells.size(); ++i) {
    cells.push_back({{"frame", i / directions / elevations},
                     {"direction", i % directions},
                     {"elevation_deg", atlas.elevations_deg[i / directions % elevations]},
                     {"origin_px", {atlas.cells[i].origin_x, atlas.cells[i].origin_y}}});
  }
  return cells;
}

json Settings(const fs::path& folder, const std::vector<ViewMaterial>& materials, const ViewGeometry& geometry,
              const ImpostorOptions& options, const ImpostorAtlas& atlas) {
  json material_settings = json::array();
  for (size_t m = 0; m < materials.size(); ++m) material_settings.push_back(MaterialSettings(folder, m, materials[m]));
  return {{"output", folder.string()},
          {"seed", options.seed},
          {"geometry", folder.string()},
          {"vertices", geometry.uvs.size()},
          {"triangles", geometry.materials.size()},
          {"frames", geometry.frames},
          {"materials", material_settings},
          {"directions", atlas.directions},
          {"width_px", atlas.width_px},
          {"height_px", atlas.height_px},
          {"band_px", BandRows(atlas)},
          {"texel_m", atlas.texel_m},
          {"cells", CellSettings(atlas)},
          {"tint_regions", atlas.tint_regions},
          {"options", {{"samples", options.samples}}}};
}

fs::path BandPath(const fs::path& folder, int band) {
  std::string digits = std::to_string(band);
  digits.insert(0, 4 - std::min<size_t>(4, digits.size()), '0');
  return folder / ("band_" + digits + ".exr");
}

Error Assemble(const fs::path& folder, int threads, ImpostorAtlas* atlas, ImpostorStatistics* statistics) {
  AtlasLevel finest{atlas->width_px, atlas->height_px, {}};
  finest.texels.resize(static_cast<size_t>(finest.width) * static_cast<size_t>(finest.height));
  const int rows = BandRows(*atlas);
  for (int first = 0; first < finest.height; first += rows) {
    if (Error error = ReadLayers(BandPath(folder, first / rows), first, &finest)) return error;
  }
  statistics->width_px = finest.width;
  statistics->height_px = finest.height;
  statistics->fill_rate = CoveredShare(finest, 1e-6f);
  statistics->memory_bytes = TextureMemory(*atlas);
  TurnIntoCells(*atlas, &finest);
  std::vector<AtlasLevel> levels = MakeLevels(std::move(finest));
  FillGutters(&levels);
  KeepCoverage(&levels, kAtlasLevels);
  Jobs others(OtherThreads(threads));
  CompressAtlas(levels, &others, atlas);
  return EncodeAtlas(levels.front(), &others, atlas);
}

json Description(const ImpostorAtlas& atlas) {
  json clips = json::array(), cells = json::array();
  for (const ImpostorClip& clip : atlas.clips) {
    clips.push_back({{"name", clip.name}, {"first_frame", clip.first_frame}, {"phases", clip.phases}});
  }
  for (const ImpostorCell& c : atlas.cells) cells.push_back({c.x, c.y, c.width, c.height, c.origin_x, c.origin_y});
  return {{"version", 3},
          {"directions", atlas.directions},
          {"elevations_deg", atlas.elevations_deg},
          {"frames", atlas.frames},
          {"width_px", atlas.width_px},
          {"height_px", atlas.height_px},
          {"texel_m", atlas.texel_m},
          {"depth_range_m", atlas.depth_range_m},
          {"motion_range_m", atlas.motion_range_m},
          {"bend_range_m", atlas.bend_range_m},
          {"clips", clips},
          {"cells", cells},
          {"albedo", "albedo.ktx2"},
          {"normal", "normal.ktx2"},
          {"depth", "depth.ktx2"},
          {"motion", "motion.ktx2"},
          {"tints", atlas.tint_regions ? "tints.ktx2" : ""}};
}

Error WriteFiles(const fs::path& folder, const ImpostorAtlas& atlas) {
  TemporaryFolder temporary;
  if (Error error = temporary.Create(".flaneur_impostor_", folder)) return error;
  const fs::path& from = temporary.path();
  std::vector<std::pair<const char*, const std::vector<uint8_t>*>> files = {
      {"albedo.png", &atlas.albedo.bytes}, {"normal.png", &atlas.normal.bytes}, {"albedo.ktx2", &atlas.albedo_ktx2},
      {"normal.ktx2", &atlas.normal_ktx2}, {"depth.ktx2", &atlas.depth_ktx2},   {"motion.ktx2", &atlas.motion_ktx2}};
  if (atlas.tint_regions)
    files.insert(files.end(), {{"tints.png", &atlas.tints.bytes}, {"tints.ktx2", &atlas.tints_ktx2}});
  for (const auto& [name, bytes] : files) {
    if (Error e = WriteFile(from / name, *bytes)) return e;
  }
  if (Error e = WriteTextFile(from / "impostor.json", Description(atlas).dump(1) + "\n")) return e;
  files.emplace_back("impostor.json", nullptr);
  for (const auto& [name, bytes] : files) {
    std::error_code code;
    fs::rename(from / name, folder / name, code);
    if (code) return Fail((folder / name).string() + ": cannot write: " + code.message());
  }
  return Ok();
}

}  // namespace

Error BakeImpostor(const Avatar& avatar, const ImpostorOptions& options, ImpostorAtlas* atlas,
                   ImpostorStatistics* statistics, std::vector<std::string>* warnings) {
  std::vector<std::string> unheard;
  *statistics = {};
  if (Error error = CheckOptions(options)) return error;
  const std::vector<ViewMaterial> materials = ViewMaterials(avatar, warnings ? warnings : &unheard);
  ViewGeometry geometry;
  if (Error error = PoseFrames(avatar, options.clips, &geometry)) return error;
  ImpostorAtlas made;
  made.tint_regions = std::any_of(materials.begin(), materials.end(),
                                  [](const ViewMaterial& material) { return material.tints != kEveryTint; });
  if (Error error = LayOut(geometry, options, &made)) return error;
  TemporaryFolder folder;
  if (Error error = folder.Create("flaneur_impostor_")) return error;
  if (Error error = WriteGeometry(folder.path(), geometry)) return error;
  if (Error error = WriteTextures(folder.path(), avatar, materials, made.texel_m)) return error;
  ProcessResult process;
  const json settings = Settings(folder.path(), materials, geometry, options, made);
  BlenderOptions blender;
  blender.log_file = options.log_file;
  blender.threads = options.threads;
  blender.progress = options.progress;
  if (Error error = RunBlenderScript("bake/impostor.py", settings.dump(1), blender, &process)) {
    return Fail("avatar '" + avatar.name + "': " + error.message);
  }
  if (Error error = Assemble(folder.path(), options.threads, &made, statistics)) return error;
  statistics->frames = made.frames;
  statistics->cells = made.frames * made.directions * Count(made.elevations_deg);
  statistics->triangles = Count(geometry.materials);
  statistics->blender_cpu_s = process.cpu_s;
  statistics->blender_wall_s = process.wall_s;
  statistics->blender_peak_memory_bytes = process.peak_memory_bytes;
  *atlas = std::move(made);
  return Ok();
}

Error WriteImpostor(const fs::path& folder, const ImpostorAtlas& atlas) {
  std::error_code code;
  const bool made = fs::create_directories(folder, code);
  if (code) return Fail(folder.string() + ": cannot make this folder: " + code.message());
  Error error = WriteFiles(folder, atlas);
  if (error && made) fs::remove(folder, code);
  return error;
}

}  // namespace flaneur
