#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

#include <cmath>
#include <cstring>
#include <map>

#include "runtime/base/file.h"
#include "runtime/base/text.h"
#include "runtime/pack/gltf_file.h"
#include "runtime/pack/read_clip.h"
#include "runtime/pack/read_mesh.h"
#include "runtime/pack/settings_fields.h"
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

float Number(const Json& object, const char* key) { return Finite(Member(object, key)); }
Vec2 Point(const Json& json) { return {Finite(json.at(0)), Finite(json.at(1))}; }

std::vector<Vec2> Points(const Json& json) {
  std::vector<Vec2> points;
  for (const Json& p : json) points.push_back(Point(p));
  return points;
}

// Reads the settings that VisitFields lists; a member that is missing keeps its default.
struct SettingsReader {
  const Json& json;

  template <typename T>
  void Number(const char* name, T* value, double least, double most) const {
    if (!json.contains(name)) return;
    const double number = json[name].get<double>();
    if (!(number >= least && number <= most)) throw PackRefused("has '" + std::string(name) + "' out of range");
    *value = static_cast<T>(number);
  }
  void Angle(const char* stem, float* radians, double least_deg, double most_deg) const {
    const double to_rad = static_cast<double>(kPi) / 180, slack = 1e-3;
    Number((std::string(stem) + "_rad").c_str(), radians, least_deg * to_rad - slack, most_deg * to_rad + slack);
  }
  void Choice(const char* name, std::string* value, std::initializer_list<const char*> allowed) const {
    if (!json.contains(name)) return;
    const std::string text = json[name].get<std::string>();
    for (const char* a : allowed) {
      if (text == a) {
        *value = text;
        return;
      }
    }
    throw PackRefused("has '" + std::string(name) + "' of unknown value '" + text + "'");
  }
};

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

// Meshes are decoded once each, when first asked for.
class MeshTable {
 public:
  MeshTable(const GltfFile& file, bool decode, TourPack* pack) : file_(file), decode_(decode), pack_(pack) {}

  int Get(int gltf_mesh) {
    const auto [entry, fresh] = indices_.try_emplace(gltf_mesh, static_cast<int>(pack_->meshes.size()));
    if (fresh) pack_->meshes.push_back(decode_ ? ReadMesh(file_, gltf_mesh) : PackMesh{});
    return entry->second;
  }

 private:
  const GltfFile& file_;
  bool decode_;
  TourPack* pack_;
  std::map<int, int> indices_;
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

PackImpostor ReadImpostor(const GltfFile& file, const Json& json) {
  PackImpostor out;
  const size_t images = file.json.value("images", Json::array()).size();
  out.directions = Index(json, "directions", 1025);
  out.frames = Index(json, "frames", 4097);
  for (const Json& e : Member(json, "elevations_deg")) out.elevations_deg.push_back(Finite(e));
  out.cell_width_px = Index(json, "cell_width_px", kMaxImageSide_px);
  out.cell_height_px = Index(json, "cell_height_px", kMaxImageSide_px);
  out.window_width_m = Number(json, "window_width_m");
  out.window_height_m = Number(json, "window_height_m");
  out.bottom_m = Number(json, "bottom_m");
  out.depth_range_m = Number(json, "depth_range_m");
  for (const Json& c : Member(json, "clips")) {
    const PackImpostorClip clip{Member(c, "name").get<std::string>(), Index(c, "first_frame", 4097),
                                Index(c, "phases", 4097)};
    if (clip.phases < 1 || clip.first_frame + clip.phases > out.frames) {
      throw PackRefused("has an impostor clip '" + clip.name + "' beyond the atlas");
    }
    out.clips.push_back(clip);
  }
  if (out.directions < 1 || out.elevations_deg.empty() || out.clips.empty()) {
    throw PackRefused("has an impostor without pictures");
  }
  out.albedo_image = Index(json, "albedo_image", images);
  out.normal_image = Index(json, "normal_image", images);
  return out;
}

// Every cell of the atlas lies in both images. Without images there is nothing to check.
void CheckAtlas(const PackImpostor& impostor, const std::vector<PackImage>& images) {
  if (images.empty()) return;
  const int64_t width = int64_t{impostor.directions} * impostor.cell_width_px;
  const int64_t height = int64_t{impostor.frames} * static_cast<int64_t>(impostor.elevations_deg.size()) *
                         impostor.cell_height_px;
  for (int i : {impostor.albedo_image, impostor.normal_image}) {
    const PackImage& image = images[static_cast<size_t>(i)];
    if (width < 1 || height < 1 || width > image.width_px || height > image.height_px) {
      throw PackRefused("has an impostor whose cells do not fit in image " + std::to_string(i));
    }
  }
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

PackAvatar ReadAvatar(const GltfFile& file, const Json& json, MeshTable* meshes, const TourPack& pack) {
  PackAvatar avatar;
  avatar.name = Member(json, "name").get<std::string>();
  avatar.share = Number(json, "share");
  avatar.height_m = Number(json, "height_m");
  avatar.radius_m = Number(json, "radius_m");
  avatar.walk_speed_mps = Number(json, "walk_speed_mps");
  if (avatar.share < 0 || avatar.height_m <= 0 || avatar.radius_m <= 0 || avatar.walk_speed_mps <= 0) {
    throw PackRefused("has an avatar '" + avatar.name + "' with a size or speed that is not positive");
  }
  const Json& nodes = Member(file.json, "nodes");
  int skin = -1;
  for (const Json& level_json : Member(json, "levels")) {
    const Json& node = nodes[static_cast<size_t>(Index(level_json, "node", nodes.size()))];
    PackLevel level;
    level.mesh = meshes->Get(Index(node, "mesh", Member(file.json, "meshes").size()));
    level.triangles = Index(level_json, "triangles", 1000000000);
    level.error_mm = Number(level_json, "error_mm");
    level.posed_error_mm = Number(level_json, "posed_error_mm");
    level.switch_px = Number(level_json, "switch_px");
    const int level_skin = Index(node, "skin", Member(file.json, "skins").size());
    if (skin >= 0 && level_skin != skin) throw PackRefused("has an avatar '" + avatar.name + "' with two skins");
    skin = level_skin;
    avatar.levels.push_back(level);
  }
  if (avatar.levels.empty()) throw PackRefused("has an avatar '" + avatar.name + "' without levels");
  avatar.joints = static_cast<int>(Member(Element(file.json, "skins", skin), "joints").size());
  if (avatar.joints < 1 || static_cast<size_t>(avatar.joints) > kMaxJoints) throw PackRefused("has too many joints");
  for (const PackLevel& level : avatar.levels) {
    CheckJoints(pack.meshes[static_cast<size_t>(level.mesh)], avatar.joints);
  }
  const size_t animations = file.json.value("animations", Json::array()).size();
  const Json& clips = Member(json, "clips");
  avatar.walk = ReadClip(file, skin, IndexOrNone(clips, "walk", animations));
  avatar.idle = ReadClip(file, skin, IndexOrNone(clips, "idle", animations));
  avatar.talk = clips.contains("talk") ? ReadClip(file, skin, IndexOrNone(clips, "talk", animations)) : avatar.idle;
  avatar.impostor = ReadImpostor(file, Member(json, "impostor"));
  CheckAtlas(avatar.impostor, pack.images);
  return avatar;
}

PackObstacle ReadObstacle(const Json& json) {
  PackObstacle obstacle;
  obstacle.name = json.value("name", "");
  obstacle.kind = json.value("kind", "other");
  if (json.contains("radius_m")) {
    obstacle.center = Point(Member(json, "center_m"));
    obstacle.radius_m = Number(json, "radius_m");
    if (obstacle.radius_m <= 0) throw PackRefused("has an obstacle '" + obstacle.name + "' of no size");
    return obstacle;
  }
  obstacle.outer = Points(Member(json, "outer_m"));
  for (const Json& hole : json.value("holes_m", Json::array())) obstacle.holes.push_back(Points(hole));
  if (obstacle.outer.size() < 3) throw PackRefused("has an obstacle '" + obstacle.name + "' of under three points");
  return obstacle;
}

PackGround ReadGround(const GltfFile& file, const Json& json) {
  PackGround ground;
  ground.min_m = Point(Member(json, "min_m"));
  ground.cell_m = Number(json, "cell_m");
  ground.columns = Index(json, "columns", 100001);
  ground.rows = Index(json, "rows", 100001);
  const size_t cells = static_cast<size_t>(ground.columns) * static_cast<size_t>(ground.rows);
  const auto heights = BufferView(file, Member(json, "height_view").get<int>());
  const auto kinds = BufferView(file, Member(json, "kind_view").get<int>());
  if (!(ground.cell_m > 0) || cells == 0 || heights.size() != cells * 4 || kinds.size() != cells) {
    throw PackRefused("has a ground raster of the wrong size");
  }
  ground.height_m.resize(cells);
  std::memcpy(ground.height_m.data(), heights.data(), heights.size());
  for (float h : ground.height_m) {
    if (!std::isfinite(h)) throw PackRefused("has a ground height that is not finite");
  }
  ground.kind.assign(kinds.begin(), kinds.end());
  return ground;
}

void ReadTour(const Json& tour, TourPack* pack) {
  pack->name = tour.value("name", "");
  for (const Json& o : tour.value("obstacles", Json::array())) pack->obstacles.push_back(ReadObstacle(o));
  for (const Json& p : tour.value("places", Json::array())) {
    pack->places.push_back({p.value("name", ""), Member(p, "kind").get<std::string>(), Point(Member(p, "position_m")),
                            p.value("width_m", 1.0f)});
  }
  for (const Json& s : tour.value("path", Json::array())) {
    pack->path.push_back({Point(Member(s, "position_m")), s.value("yaw_rad", 0.0f), s.value("pause_s", 0.0f),
                          s.value("caption", "")});
  }
  VisitFields(SettingsReader{tour.value("crowd", Json::object())}, &pack->crowd);
  VisitFields(SettingsReader{tour.value("control", Json::object())}, &pack->control);
  VisitFields(SettingsReader{tour.value("light", Json::object())}, &pack->light);
}

void Load(std::vector<uint8_t> bytes, const LoadOptions& options, TourPack* pack) {
  const GltfFile file = OpenGltf(std::move(bytes));
  const Json extensions = file.json.value("extensions", Json::object());
  if (!extensions.contains(kTourExtension)) {
    throw PackRefused(std::string("is a glTF binary but no tour pack: it has no ") + kTourExtension +
                      "; make one with 'flaneur bake'");
  }
  const Json& tour = extensions[kTourExtension];
  const int version = Member(tour, "version").get<int>();
  if (version != kTourPackVersion) {
    throw PackRefused("is a tour pack of version " + std::to_string(version) + ", this player reads version " +
                      std::to_string(kTourPackVersion));
  }
  ReadTour(tour, pack);
  pack->ground = ReadGround(file, Member(tour, "ground"));
  if (options.geometry_and_images) {
    const size_t images = file.json.value("images", Json::array()).size();
    for (size_t i = 0; i < images; ++i) pack->images.push_back(ReadImage(file, static_cast<int>(i)));
  }
  for (const Json& m : file.json.value("materials", Json::array())) pack->materials.push_back(ReadMaterial(file, m));
  MeshTable meshes(file, options.geometry_and_images, pack);
  ReadTown(file, &meshes, pack);
  for (const Json& a : Member(tour, "avatars")) pack->avatars.push_back(ReadAvatar(file, a, &meshes, *pack));
  if (pack->avatars.empty()) throw PackRefused("has no avatars");
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
    return Fail(name + ": " + OneLine(e.what()));
  }
}

}  // namespace flaneur
