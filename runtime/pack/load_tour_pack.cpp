#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include "runtime/base/file.h"
#include "runtime/base/parallel.h"
#include "runtime/base/text.h"
#include "runtime/pack/gltf_file.h"
#include "runtime/pack/ktx2.h"
#include "runtime/pack/read_clip.h"
#include "runtime/pack/read_mesh.h"
#include "runtime/pack/settings_fields.h"
#include "runtime/pack/tour_object.h"
#include "runtime/pack/tour_pack.h"

namespace flaneur {
namespace {

constexpr int kMaxImageSide_px = 16384;
constexpr size_t kMaxJoints = 1024;

float Finite(const Json& json) {
  const float value = json.get<float>();
  if (!std::isfinite(value)) throw PackRefused("has a number that is not finite");
  return value;
}

PackImage ReadImage(const GltfFile& file, int index) {
  const Json& json = Element(file.json, "images", index);
  const auto bytes = BufferView(file, Member(json, "bufferView").get<int>());
  int width = 0, height = 0, channels = 0;
  const int size = static_cast<int>(bytes.size());
  if (!stbi_info_from_memory(bytes.data(), size, &width, &height, &channels) || width > kMaxImageSide_px ||
      height > kMaxImageSide_px) {
    throw PackRefused("has image " + std::to_string(index) + " that is neither PNG nor JPEG, or too large");
  }
  stbi_uc* pixels = stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 4);
  if (pixels == nullptr) throw PackRefused("has image " + std::to_string(index) + " that cannot be decoded");
  PackImage image{width, height, {}};
  image.rgba.assign(pixels, pixels + static_cast<size_t>(width) * static_cast<size_t>(height) * 4);
  stbi_image_free(pixels);
  return image;
}

PackMaterial ReadMaterial(const GltfFile& file, const Json& json) {
  PackMaterial material;
  material.name = json.value("name", "");
  material.double_sided = json.value("doubleSided", false);
  material.alpha_mask = json.value("alphaMode", "OPAQUE") != "OPAQUE";
  material.alpha_cutoff = json.value("alphaCutoff", 0.5f);
  const Json pbr = json.value("pbrMetallicRoughness", Json::object());
  if (pbr.contains("baseColorFactor")) {
    const Json& c = pbr["baseColorFactor"];
    material.base_color = {c.at(0), c.at(1), c.at(2), c.at(3)};
  }
  if (pbr.contains("baseColorTexture")) {
    const Json& texture = Element(file.json, "textures", Member(pbr["baseColorTexture"], "index").get<int>());
    material.base_color_image = Index(texture, "source", Member(file.json, "images").size());
  }
  return material;
}

// Which of the file's meshes are used, each once, in the order of their first use.
class MeshTable {
 public:
  int Get(int gltf_mesh) {
    const auto [entry, fresh] = indices_.try_emplace(gltf_mesh, static_cast<int>(used_.size()));
    if (fresh) used_.push_back(gltf_mesh);
    return entry->second;
  }
  const std::vector<int>& used() const { return used_; }

 private:
  std::map<int, int> indices_;
  std::vector<int> used_;
};

Mat4 LocalMatrix(const Json& node) {
  if (node.contains("matrix")) {
    Mat4 m;
    for (size_t k = 0; k < 16; ++k) m.m[k / 4][k % 4] = Finite(node["matrix"].at(k));
    return m;
  }
  Vec3 t, s{1, 1, 1};
  Quat r;
  if (node.contains("translation")) t = {node["translation"].at(0), node["translation"].at(1), node["translation"].at(2)};
  if (node.contains("rotation")) {
    const Json& q = node["rotation"];
    r = {q.at(0), q.at(1), q.at(2), q.at(3)};
  }
  if (node.contains("scale")) s = {node["scale"].at(0), node["scale"].at(1), node["scale"].at(2)};
  return FromTranslationRotationScale(t, r, s);
}

void ReadTown(const GltfFile& file, MeshTable* meshes, TourPack* pack) {
  const Json& nodes = Member(file.json, "nodes");
  struct Visit { size_t node; Mat4 parent; size_t depth; };
  std::vector<Visit> stack;
  for (const Json& root : Element(file.json, "scenes", 0).value("nodes", Json::array())) {
    stack.push_back({root.get<size_t>(), Mat4{}, 0});
  }
  while (!stack.empty()) {
    const Visit visit = stack.back();
    stack.pop_back();
    if (visit.node >= nodes.size() || visit.depth > 64 || pack->town.size() > nodes.size()) {
      throw PackRefused("has a broken node tree");
    }
    const Json& node = nodes[visit.node];
    const Mat4 world = visit.parent * LocalMatrix(node);
    if (node.contains("mesh")) {
      const int mesh = Index(node, "mesh", Member(file.json, "meshes").size());
      pack->town.push_back({node.value("name", ""), meshes->Get(mesh), world});
    }
    for (const Json& child : node.value("children", Json::array())) {
      stack.push_back({child.get<size_t>(), world, visit.depth + 1});
    }
  }
}

std::vector<PackImpostorCell> ReadCells(std::span<const uint8_t> bytes, const PackImpostor& impostor) {
  const size_t count = static_cast<size_t>(impostor.directions) * static_cast<size_t>(impostor.frames) * impostor.elevations_deg.size();
  if (bytes.size() != count * sizeof(PackImpostorCell)) throw PackRefused("has an impostor with a wrong number of cells");
  std::vector<PackImpostorCell> cells(count);
  std::memcpy(cells.data(), bytes.data(), bytes.size());
  for (const PackImpostorCell& c : cells) {
    if (c.x < 0 || c.y < 0 || c.width < 1 || c.height < 1 || c.x + c.width > impostor.width_px || c.y + c.height > impostor.height_px) {
      throw PackRefused("has an impostor with a cell outside its atlas");
    }
  }
  return cells;
}

PackImpostor ReadImpostor(const GltfFile& file, const TourObject& json) {
  constexpr double kAboveZero = TourObject::kAboveZero, kAnything = TourObject::kAnything;
  PackImpostor out;
  out.directions = json.Whole("directions", 1, 1024);
  out.frames = json.Whole("frames", 1, 4096);
  out.elevations_deg = json.Reals("elevations_deg", -90, 90);
  out.width_px = json.Whole("width_px", 1, kMaxImageSide_px);
  out.height_px = json.Whole("height_px", 1, kMaxImageSide_px);
  out.texel_m = json.Real("texel_m", kAboveZero, kAnything);
  out.depth_range_m = json.Real("depth_range_m", kAboveZero, kAnything);
  out.motion_range_m = json.Real("motion_range_m", kAboveZero, kAnything);
  for (const TourObject& c : json.Objects("clips")) {
    const PackImpostorClip clip{c.OneOf("name", {"walk", "idle", "talk"}), c.Whole("first_frame", 0, 4095),
                                c.Whole("phases", 1, 4096)};
    if (clip.first_frame + clip.phases > out.frames) c.Refuse("reaches beyond the atlas's frames");
    out.clips.push_back(clip);
  }
  if (out.clips.empty()) json.Refuse("has no clips");
  const double last = static_cast<double>(Member(file.json, "bufferViews").size()) - 1;
  out.cells = ReadCells(BufferView(file, json.Whole("cells_view", 0, last)), out);
  return out;
}

// `halved`: how often the picture's sides are half the atlas's.
void ReadAtlasPicture(const GltfFile& file, const TourObject& json, const char* view, TextureFormat format,
                      const PackImpostor& impostor, int halved, PackTexture* picture) {
  const double last = static_cast<double>(Member(file.json, "bufferViews").size()) - 1;
  if (Error e = ReadKtx2(BufferView(file, json.Whole(view, 0, last)), picture)) json.Refuse(std::string(view) + " " + e.message);
  if (picture->format != format || picture->width_px != impostor.width_px >> halved ||
      picture->height_px != impostor.height_px >> halved) {
    json.Refuse(std::string(view) + " is a picture of another format or size than the atlas");
  }
}

void ReadAtlas(const GltfFile& file, const TourObject& json, PackImpostor* impostor) {
  ReadAtlasPicture(file, json, "albedo_view", TextureFormat::kBc7Srgb, *impostor, 0, &impostor->albedo);
  ReadAtlasPicture(file, json, "normal_view", TextureFormat::kBc5, *impostor, 0, &impostor->normal);
  ReadAtlasPicture(file, json, "depth_view", TextureFormat::kBc4, *impostor, 0, &impostor->depth);
  ReadAtlasPicture(file, json, "motion_view", TextureFormat::kBc5, *impostor, 1, &impostor->motion);
}

void CheckJoints(const PackMesh& mesh, int joints) {
  for (const PackPrimitive& primitive : mesh.primitives) {
    for (const auto& four : primitive.joints) {
      for (uint16_t j : four) {
        if (j >= joints) throw PackRefused("has a joint index beyond its skin");
      }
    }
  }
}

PackAvatar ReadAvatar(const GltfFile& file, const TourObject& json, const LoadOptions& options, MeshTable* meshes) {
  constexpr double kAboveZero = TourObject::kAboveZero, kAnything = TourObject::kAnything;
  PackAvatar avatar;
  avatar.name = json.Text("name");
  avatar.share = json.Real("share", 0, kAnything);
  avatar.height_m = json.Real("height_m", kAboveZero, kAnything);
  avatar.radius_m = json.Real("radius_m", kAboveZero, kAnything);
  avatar.walk_speed_mps = json.Real("walk_speed_mps", kAboveZero, kAnything);
  const Json& nodes = Member(file.json, "nodes");
  int skin = -1;
  for (const TourObject& level_json : json.Objects("levels")) {
    const Json& node = nodes[static_cast<size_t>(level_json.Whole("node", 0, static_cast<double>(nodes.size()) - 1))];
    PackLevel level;
    level.mesh = meshes->Get(Index(node, "mesh", Member(file.json, "meshes").size()));
    level.triangles = level_json.Whole("triangles", 1, 1e9);
    level.error_mm = level_json.Real("error_mm", 0, kAnything);
    level.posed_error_mm = level_json.Real("posed_error_mm", 0, kAnything);
    level.switch_px = level_json.Real("switch_px", 0, kAnything);
    const int level_skin = Index(node, "skin", Member(file.json, "skins").size());
    if (skin >= 0 && level_skin != skin) level_json.Refuse("has another skin than the level before");
    skin = level_skin;
    avatar.levels.push_back(level);
  }
  if (avatar.levels.empty()) json.Refuse("has no levels");
  avatar.joints = static_cast<int>(Member(Element(file.json, "skins", skin), "joints").size());
  if (avatar.joints < 1 || static_cast<size_t>(avatar.joints) > kMaxJoints) throw PackRefused("has too many joints");
  const double last = static_cast<double>(file.json.value("animations", Json::array()).size()) - 1;
  const TourObject clips = json.Object("clips");
  const auto clip = [&](const char* name) { return ReadClip(file, skin, clips.Whole(name, -1, last)); };
  avatar.walk = clip("walk");
  avatar.idle = clips.Has("idle") ? clip("idle") : ReadClip(file, skin, -1);
  avatar.talk = clips.Has("talk") ? clip("talk") : avatar.idle;
  avatar.impostor = ReadImpostor(file, json.Object("impostor"));
  if (options.geometry_and_images) ReadAtlas(file, json.Object("impostor"), &avatar.impostor);
  return avatar;
}

PackObstacle ReadObstacle(const TourObject& json) {
  PackObstacle obstacle;
  obstacle.name = json.Text("name");
  obstacle.kind = json.OneOf("kind", {"building", "wall", "tree", "lamp", "other"});
  if (json.Has("radius_m")) {
    obstacle.center = json.Point("center_m");
    obstacle.radius_m = json.Real("radius_m", TourObject::kAboveZero, TourObject::kAnything);
    return obstacle;
  }
  obstacle.outer = json.Ring("outer_m");
  if (json.Has("holes_m")) obstacle.holes = json.Rings("holes_m");
  return obstacle;
}

// Where a raster lies; how many cells it has.
template <typename Raster>
size_t ReadRasterFrame(const TourObject& json, Raster* raster) {
  raster->min_m = json.Point("min_m");
  raster->cell_m = json.Real("cell_m", TourObject::kAboveZero, TourObject::kAnything);
  raster->columns = json.Whole("columns", 1, 100000);
  raster->rows = json.Whole("rows", 1, 100000);
  return static_cast<size_t>(raster->columns) * static_cast<size_t>(raster->rows);
}

PackGround ReadGround(const GltfFile& file, const TourObject& json) {
  PackGround ground;
  const size_t cells = ReadRasterFrame(json, &ground);
  const double last = static_cast<double>(Member(file.json, "bufferViews").size()) - 1;
  const auto heights = BufferView(file, json.Whole("height_view", 0, last));
  const auto kinds = BufferView(file, json.Whole("kind_view", 0, last));
  if (heights.size() != cells * 4 || kinds.size() != cells) json.Refuse("has views of the wrong size");
  ground.height_m.resize(cells);
  std::memcpy(ground.height_m.data(), heights.data(), heights.size());
  for (float h : ground.height_m) {
    if (!std::isfinite(h)) throw PackRefused("has a ground height that is not finite");
  }
  ground.kind.assign(kinds.begin(), kinds.end());
  return ground;
}

PackPainting ReadPainting(const GltfFile& file, const TourObject& json) {
  PackPainting painting;
  const size_t cells = ReadRasterFrame(json, &painting);
  const double last = static_cast<double>(Member(file.json, "bufferViews").size()) - 1;
  const auto people = BufferView(file, json.Whole("people_view", 0, last));
  const auto loiter = BufferView(file, json.Whole("loiter_view", 0, last));
  if (people.size() != cells || loiter.size() != cells) json.Refuse("has views of the wrong size");
  painting.people.assign(people.begin(), people.end());
  painting.loiter.assign(loiter.begin(), loiter.end());
  return painting;
}

void ReadTour(const GltfFile& file, const TourObject& tour, TourPack* pack) {
  pack->name = tour.Text("name");
  for (const TourObject& o : tour.Objects("obstacles")) pack->obstacles.push_back(ReadObstacle(o));
  for (const TourObject& p : tour.Objects("places")) {
    pack->places.push_back({p.Text("name"), p.OneOf("kind", {"door", "exit", "goal", "loiter", "spawn"}), p.Point("position_m"),
                            p.Real("width_m", TourObject::kAboveZero, TourObject::kAnything)});
    if (p.Has("yaw_rad")) pack->places.back().yaw_rad = p.Real("yaw_rad");
  }
  if (tour.Has("painting")) pack->painting = ReadPainting(file, tour.Object("painting"));
  for (const TourObject& s : tour.Objects("path")) {
    pack->path.push_back({s.Point("position_m"), s.Real("yaw_rad"), s.Real("pause_s", 0, TourObject::kAnything),
                          s.Text("caption")});
  }
  if (tour.Has("guide")) pack->guide = tour.Text("guide");
  VisitFields(tour.Object("crowd"), &pack->crowd);
  VisitFields(tour.Object("control"), &pack->control);
  VisitFields(tour.Object("light"), &pack->light);
}

// The bulk of loading, on all cores.
void DecodeGeometryAndImages(const GltfFile& file, const std::vector<int>& meshes, TourPack* pack) {
  pack->images.resize(file.json.value("images", Json::array()).size());
  const size_t images = pack->images.size();
  ParallelFor(images + meshes.size(), [&](size_t i) {
    if (i < images) pack->images[i] = ReadImage(file, static_cast<int>(i));
    else pack->meshes[i - images] = ReadMesh(file, meshes[i - images]);
  });
  for (const PackAvatar& avatar : pack->avatars) {
    for (const PackLevel& level : avatar.levels) CheckJoints(pack->meshes[static_cast<size_t>(level.mesh)], avatar.joints);
  }
}

void Load(std::vector<uint8_t> bytes, const LoadOptions& options, TourPack* pack) {
  const GltfFile file = OpenGltf(std::move(bytes));
  const Json extensions = file.json.value("extensions", Json::object());
  if (!extensions.contains(kTourExtension)) {
    throw PackRefused(std::string("is a glTF binary but no tour pack: it has no ") + kTourExtension +
                      "; make one with 'flaneur bake'");
  }
  const TourObject tour(extensions[kTourExtension], kTourExtension);
  const int version = tour.Whole("version", 0, 1e9);
  if (version != kTourPackVersion) {
    throw PackRefused("is a tour pack of version " + std::to_string(version) + ", this player reads version " +
                      std::to_string(kTourPackVersion));
  }
  ReadTour(file, tour, pack);
  pack->ground = ReadGround(file, tour.Object("ground"));
  for (const Json& m : file.json.value("materials", Json::array())) pack->materials.push_back(ReadMaterial(file, m));
  MeshTable meshes;
  ReadTown(file, &meshes, pack);
  for (const TourObject& a : tour.Objects("avatars")) pack->avatars.push_back(ReadAvatar(file, a, options, &meshes));
  if (pack->avatars.empty()) tour.Refuse("has no avatars");
  const auto is_guide = [&](const PackAvatar& a) { return a.name == pack->guide; };
  if (!pack->guide.empty() && std::none_of(pack->avatars.begin(), pack->avatars.end(), is_guide)) {
    tour.Refuse("has a guide '" + pack->guide + "' who is none of its avatars");
  }
  pack->meshes.resize(meshes.used().size());
  if (options.geometry_and_images) DecodeGeometryAndImages(file, meshes.used(), pack);
}

}  // namespace

Error LoadTourPack(const std::filesystem::path& path, const LoadOptions& options, TourPack* pack) {
  std::vector<uint8_t> bytes;
  if (Error e = ReadFile(path, &bytes)) return e;
  return ParseTourPack(std::move(bytes), path.string(), options, pack);
}

Error ParseTourPack(std::vector<uint8_t> bytes, const std::string& name, const LoadOptions& options, TourPack* pack) {
  try {
    TourPack loaded;
    Load(std::move(bytes), options, &loaded);
    *pack = std::move(loaded);
    return Ok();
  } catch (const std::exception& e) {
    return Fail(name + ": " + OneLine(Complaint(e)));
  }
}

}  // namespace flaneur
