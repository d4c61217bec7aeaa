#include "pipeline/impostor/bake_impostor.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "pipeline/core/subprocess.h"
#include "pipeline/core/temporary_folder.h"
#include "pipeline/impostor/atlas_image.h"
#include "pipeline/impostor/view_geometry.h"
#include "runtime/base/file.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kMostAtlasPixels = 8192;  // what every desktop graphics card takes

Error CheckRange(const char* name, double value, double least, double most) {
  if (value >= least && value <= most) return Ok();
  return Fail(std::string("impostor: ") + name + " is " + json(value).dump() + ", must be " +
              json(least).dump() + " to " + json(most).dump());
}

Error CheckOptions(const ImpostorOptions& options) {
  if (Error e = CheckRange("directions", options.directions, 1, 64)) return e;
  if (Error e = CheckRange("height_px", options.height_px, 16, 1024)) return e;
  if (Error e = CheckRange("border_px", options.border_px, 1, 16)) return e;
  if (Error e = CheckRange("height_px less both borders", options.height_px - 2 * options.border_px,
                           8, 1024)) {
    return e;
  }
  if (Error e = CheckRange("samples", options.samples, 1, 4096)) return e;
  if (Error e = CheckRange("seed", options.seed, 0, 0x7FFFFFFF)) return e;
  if (Error e = CheckRange("threads", options.threads, 0, 1024)) return e;
  if (Error e = CheckRange("number of elevations",
                           static_cast<double>(options.elevations_deg.size()), 1, 8)) {
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

// Square texels; the border stays free.
Error LayOut(const ViewGeometry& geometry, const ImpostorOptions& options, ImpostorAtlas* atlas) {
  const ViewExtent extent = MeasureExtent(geometry, options.directions, options.elevations_deg);
  const float texel_m = (extent.top_m - extent.bottom_m) /
                        static_cast<float>(options.height_px - 2 * options.border_px);
  if (!(texel_m > 0)) return Fail("impostor: the avatar is flat; nothing stands upright in it");
  const float border_m = texel_m * static_cast<float>(options.border_px);
  const double width_px = std::ceil(2 * (extent.half_width_m + border_m) / texel_m / 4) * 4;
  const int rows = geometry.frames * static_cast<int>(options.elevations_deg.size());
  if (width_px * options.directions > kMostAtlasPixels ||
      rows * options.height_px > kMostAtlasPixels) {
    return Fail("impostor: the atlas would be " +
                std::to_string(static_cast<int64_t>(width_px * options.directions)) + " x " +
                std::to_string(rows * options.height_px) + " px, more than " +
                std::to_string(kMostAtlasPixels) +
                "; ask for fewer directions or phases, or a "
                "smaller height");
  }
  *atlas = {};
  atlas->directions = options.directions;
  atlas->elevations_deg = options.elevations_deg;
  atlas->frames = geometry.frames;
  atlas->clips = geometry.clips;
  atlas->cell_width_px = static_cast<int>(width_px);
  atlas->cell_height_px = options.height_px;
  atlas->window_width_m = texel_m * static_cast<float>(atlas->cell_width_px);
  atlas->window_height_m = texel_m * static_cast<float>(atlas->cell_height_px);
  atlas->bottom_m = extent.bottom_m - border_m;
  atlas->depth_range_m = std::max(extent.depth_m, texel_m);
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
  if (Error e = WriteArray(folder / "uvs.f32", geometry.uvs)) return e;
  if (Error e = WriteArray(folder / "colors.f32", geometry.colors)) return e;
  if (Error e = WriteArray(folder / "indices.u32", geometry.indices)) return e;
  return WriteArray(folder / "materials.u32", geometry.materials);
}

fs::path TexturePath(const fs::path& folder, const Image& image, int index) {
  const size_t slash = image.mime_type.find('/');
  const std::string kind = slash == std::string::npos ? "png" : image.mime_type.substr(slash + 1);
  return folder / ("texture_" + std::to_string(index) + (kind == "jpeg" ? ".jpg" : "." + kind));
}

Error WriteTextures(const fs::path& folder, const Avatar& avatar,
                    const std::vector<ViewMaterial>& materials) {
  for (const ViewMaterial& material : materials) {
    if (material.image < 0) continue;
    const Image& image = avatar.images[static_cast<size_t>(material.image)];
    if (Error e = WriteFile(TexturePath(folder, image, material.image), image.bytes)) return e;
  }
  return Ok();
}

json MaterialSettings(const fs::path& folder, const Avatar& avatar, const ViewMaterial& material) {
  std::string texture;
  if (material.image >= 0) {
    const Image& image = avatar.images[static_cast<size_t>(material.image)];
    texture = TexturePath(folder, image, material.image).string();
  }
  return {{"texture", texture},
          {"mask", material.mask},
          {"cutoff", material.cutoff},
          {"double_sided", material.double_sided}};
}

json Settings(const fs::path& folder, const Avatar& avatar,
              const std::vector<ViewMaterial>& materials, const ViewGeometry& geometry,
              const ImpostorOptions& options, const ImpostorAtlas& atlas) {
  json material_settings = json::array();
  for (const ViewMaterial& material : materials) {
    material_settings.push_back(MaterialSettings(folder, avatar, material));
  }
  return {{"output", folder.string()},
          {"seed", options.seed},
          {"geometry", folder.string()},
          {"vertices", geometry.uvs.size()},
          {"triangles", geometry.materials.size()},
          {"frames", geometry.frames},
          {"materials", material_settings},
          {"directions", atlas.directions},
          {"elevations_deg", atlas.elevations_deg},
          {"cell_width_px", atlas.cell_width_px},
          {"cell_height_px", atlas.cell_height_px},
          {"window_width_m", atlas.window_width_m},
          {"window_height_m", atlas.window_height_m},
          {"bottom_m", atlas.bottom_m},
          {"options", {{"samples", options.samples}}}};
}

fs::path FramePath(const fs::path& folder, int frame) {
  std::string digits = std::to_string(frame);
  digits.insert(0, 4 - std::min<size_t>(4, digits.size()), '0');
  return folder / ("frame_" + digits + ".exr");
}

Pixels EmptyPixels(const ImpostorAtlas& atlas) {
  Pixels pixels;
  pixels.width = atlas.directions * atlas.cell_width_px;
  pixels.height =
      atlas.frames * static_cast<int>(atlas.elevations_deg.size()) * atlas.cell_height_px;
  pixels.rgba.assign(4 * static_cast<size_t>(pixels.width) * static_cast<size_t>(pixels.height), 0);
  return pixels;
}

Error Assemble(const fs::path& folder, ImpostorAtlas* atlas, ImpostorStatistics* statistics) {
  AtlasPixels pixels{EmptyPixels(*atlas), EmptyPixels(*atlas)};
  const int frame_rows = static_cast<int>(atlas->elevations_deg.size()) * atlas->cell_height_px;
  for (int frame = 0; frame < atlas->frames; ++frame) {
    if (Error error = ReadLayers(FramePath(folder, frame), frame * frame_rows, atlas->depth_range_m,
                                 &pixels)) {
      return error;
    }
  }
  statistics->width_px = pixels.albedo.width;
  statistics->height_px = pixels.albedo.height;
  statistics->fill_rate = FillRate(pixels.albedo);
  FillGutters(atlas->cell_width_px, atlas->cell_height_px, &pixels);
  if (Error error = EncodePng(pixels.albedo, true, &atlas->albedo)) return error;
  return EncodePng(pixels.normal, false, &atlas->normal);
}

json Description(const ImpostorAtlas& atlas) {
  json clips = json::array();
  for (const ImpostorClip& clip : atlas.clips) {
    clips.push_back(
        {{"name", clip.name}, {"first_frame", clip.first_frame}, {"phases", clip.phases}});
  }
  return {{"version", 1},
          {"directions", atlas.directions},
          {"elevations_deg", atlas.elevations_deg},
          {"frames", atlas.frames},
          {"cell_width_px", atlas.cell_width_px},
          {"cell_height_px", atlas.cell_height_px},
          {"window_width_m", atlas.window_width_m},
          {"window_height_m", atlas.window_height_m},
          {"bottom_m", atlas.bottom_m},
          {"depth_range_m", atlas.depth_range_m},
          {"clips", clips},
          {"albedo", "albedo.png"},
          {"normal", "normal.png"}};
}

Error WriteFiles(const fs::path& folder, const ImpostorAtlas& atlas) {
  TemporaryFolder temporary;
  if (Error error = temporary.Create(".flaneur_impostor_", folder)) return error;
  const fs::path& from = temporary.path();
  if (Error e = WriteFile(from / "albedo.png", atlas.albedo.bytes)) return e;
  if (Error e = WriteFile(from / "normal.png", atlas.normal.bytes)) return e;
  if (Error e = WriteTextFile(from / "impostor.json", Description(atlas).dump(2) + "\n")) return e;
  for (const char* name : {"albedo.png", "normal.png", "impostor.json"}) {
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
  if (Error error = LayOut(geometry, options, &made)) return error;
  TemporaryFolder folder;
  if (Error error = folder.Create("flaneur_impostor_")) return error;
  if (Error error = WriteGeometry(folder.path(), geometry)) return error;
  if (Error error = WriteTextures(folder.path(), avatar, materials)) return error;
  ProcessResult process;
  const json settings = Settings(folder.path(), avatar, materials, geometry, options, made);
  if (Error error = RunBlenderScript("bake/impostor.py", settings.dump(1),
                                     {options.log_file, options.threads}, &process)) {
    return Fail("avatar '" + avatar.name + "': " + error.message);
  }
  if (Error error = Assemble(folder.path(), &made, statistics)) return error;
  statistics->frames = made.frames;
  statistics->cells = made.frames * made.directions * static_cast<int>(made.elevations_deg.size());
  statistics->triangles = static_cast<int>(geometry.materials.size());
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
  const Error error = WriteFiles(folder, atlas);
  if (error && made) fs::remove(folder, code);
  return error;
}

}  // namespace flaneur
