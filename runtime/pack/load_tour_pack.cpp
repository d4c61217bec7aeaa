#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>

#include "runtime/base/array.h"
#include "runtime/base/file.h"
#include "runtime/base/limits.h"
#include "runtime/base/pixels.h"
#include "runtime/base/text.h"
#include "runtime/pack/allowance.h"
#include "runtime/pack/gltf_file.h"
#include "runtime/pack/ktx2.h"
#include "runtime/pack/reach.h"
#include "runtime/pack/read_clip.h"
#include "runtime/pack/read_life.h"
#include "runtime/pack/read_mesh.h"
#include "runtime/pack/read_visitor_data.h"
#include "runtime/pack/tour_object.h"
#include "runtime/pack/tour_pack.h"
#include "runtime/tour_data/settings.h"

namespace flaneur {
namespace {

float Finite(const Json& json) {
  const float value = json.get<float>();
  if (!std::isfinite(value)) throw PackRefused("has a number that is not finite");
  return value;
}

std::string NameOf(const GltfFile& file, int image) {
  const Json& json = Element(file.json, "images", image);
  const std::string name = json.value("name", "");
  return "image " + std::to_string(image) + (name.empty() ? "" : " '" + name + "'");
}

int ImageView(const GltfFile& file, int image) {
  return Member(Element(file.json, "images", image), "bufferView").get<int>();
}

std::span<const uint8_t> ImageBytes(const GltfFile& file, int image) {
  return BufferView(file, ImageView(file, image));
}

PackImage ReadImageSize(const GltfFile& file, int index) {
  const auto size = DecodedSize(BeginningOfView(file, ImageView(file, index)));
  if (!size || size->width > kMostPictureSide_px || size->height > kMostPictureSide_px) {
    throw PackRefused("has " + NameOf(file, index) + " that is neither PNG nor JPEG, or too large");
  }
  PackImage image;
  image.width_px = size->width;
  image.height_px = size->height;
  return image;
}

PackImage ReadImage(const GltfFile& file, int index) {
  PackImage image = ReadImageSize(file, index);
  auto pixels = Decoded(ImageBytes(file, index));
  if (!pixels) throw PackRefused("has " + NameOf(file, index) + " that cannot be decoded; bake the tour again");
  image.rgba = std::move(pixels->rgba);
  return image;
}

PackMaterial ReadMaterial(const GltfFile& file, const Json& json) {
  PackMaterial material;
  material.name = json.value("name", "");
  material.double_sided = json.value("doubleSided", false);
  material.alpha_mask = json.value("alphaMode", "OPAQUE") != "OPAQUE";
  material.alpha_cutoff = json.value("alphaCutoff", 0.5f);
  static const Json kNothing = Json::object();
  const auto found = json.find("pbrMetallicRoughness");
  const Json& pbr = found != json.end() ? *found : kNothing;
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
    const auto [entry, fresh] = indices_.try_emplace(gltf_mesh, Count(used_));
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
  if (node.contains("translation"))
    t = {node["translation"].at(0), node["translation"].at(1), node["translation"].at(2)};
  if (node.contains("rotation")) {
    const Json& q = node["rotation"];
    r = {q.at(0), q.at(1), q.at(2), q.at(3)};
  }
  if (node.contains("scale")) s = {node["scale"].at(0), node["scale"].at(1), node["scale"].at(2)};
  return FromTranslationRotationScale(t, r, s);
}

// -1: it stands still.
int ReadTurning(const Json& node, const Mat4& world, TourPack* pack) {
  if (!node.contains("extras") || !node["extras"].is_object()) return -1;
  const std::string name = node["extras"].value("flaneur_turns", "");
  if (name.empty()) return -1;
  for (const TurnsBy by : {TurnsBy::kWind, TurnsBy::kHourHand, TurnsBy::kMinuteHand}) {
    if (name != TurnsByName(by)) continue;
    if (Count(pack->turning) >= kMaxTurningParts)
      throw PackRefused("has more than " + std::to_string(kMaxTurningParts) + " turning parts");
    const Vec3 front = Normalized(GroundFromGltf(TransformDirection(world, {0, 0, 1})));
    TurningPart part{by, GroundFromGltf(TransformPoint(world, {})), front, std::atan2(front.y, front.x)};
    if (by == TurnsBy::kWind) part.axis = {0, 0, 1};
    pack->turning.push_back(part);
    return Count(pack->turning) - 1;
  }
  return -1;  // a newer version's
}

// Neither beyond the world nor blown up out of it.
void CheckPlacement(const Mat4& world, size_t node) {
  for (const auto& column : world.m) {
    for (const float number : column) {
      if (!(std::abs(static_cast<double>(number)) <= kMostCoordinate_m))
        throw PackRefused("has node " + std::to_string(node) + " placed out of range");
    }
  }
}

void ReadTown(const GltfFile& file, MeshTable* meshes, TourPack* pack) {
  const Json& nodes = Member(file.json, "nodes");
  struct Visit {
    size_t node;
    Mat4 parent;
  };
  std::vector<Visit> stack;
  std::vector<bool> seen(nodes.size(), false);
  const auto visit_later = [&](const Json& node, const Mat4& parent) {
    const auto n = node.get<size_t>();
    if (n >= nodes.size() || seen[n]) throw PackRefused("has a broken node tree");
    seen[n] = true;
    stack.push_back({n, parent});
  };
  const auto visit_list_later = [&](const Json& of, const char* list, const Mat4& parent) {
    if (!of.contains(list)) return;
    for (const Json& node : of[list]) visit_later(node, parent);
  };
  visit_list_later(Element(file.json, "scenes", 0), "nodes", Mat4{});
  while (!stack.empty()) {
    const Visit visit = stack.back();
    stack.pop_back();
    const Json& node = nodes[visit.node];
    const Mat4 world = visit.parent * LocalMatrix(node);
    if (node.contains("mesh")) {
      CheckPlacement(world, visit.node);
      const int mesh = Index(node, "mesh", Member(file.json, "meshes").size());
      pack->town.push_back({node.value("name", ""), meshes->Get(mesh), world, ReadTurning(node, world, pack)});
    }
    visit_list_later(node, "children", world);
  }
}

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
  const double last = static_cast<double>(Member(file.json, "bufferViews").size()) - 1;
  out.cells = ReadCells(file, BufferView(file, json.Whole("cells_view", 0, last)), out);
  return out;
}

// halved: how often the picture's sides are half the atlas's.
struct AtlasView {
  const char* name;
  int halved;
};
constexpr AtlasView kAtlasViews[] = {
    {"albedo_view", 0}, {"normal_view", 0}, {"depth_view", 0}, {"motion_view", 1}, {"tints_view", 1}};

void ReadAtlasPicture(const GltfFile& file, const TourObject& json, const char* view, TextureFormat format,
                      const PackImpostor& impostor, int halved, PackTexture* picture) {
  const double last = static_cast<double>(Member(file.json, "bufferViews").size()) - 1;
  const int index = json.Whole(view, 0, last);
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

void ReadAtlas(const GltfFile& file, const TourObject& json, PackImpostor* impostor) {
  ReadAtlasPicture(file, json, "albedo_view", TextureFormat::kBc7Srgb, *impostor, 0, &impostor->albedo);
  ReadAtlasPicture(file, json, "normal_view", TextureFormat::kBc5, *impostor, 0, &impostor->normal);
  ReadAtlasPicture(file, json, "depth_view", TextureFormat::kBc4, *impostor, 0, &impostor->depth);
  ReadAtlasPicture(file, json, "motion_view", TextureFormat::kBc7, *impostor, 1, &impostor->motion);
  if (json.Has("tints_view"))
    ReadAtlasPicture(file, json, "tints_view", TextureFormat::kBc7, *impostor, 1, &impostor->tints);
  LeaveOutLevels(impostor);
}

void CheckJoints(const PackPrimitive& primitive, int joints) {
  for (const auto& four : primitive.joints) {
    for (uint16_t j : four) {
      if (j >= joints) throw PackRefused("has a joint index beyond its skin");
    }
  }
}

// Whoever cannot stand but walk: the joints' rest pose would stretch out the arms.
PackClip FirstFrame(const PackClip& clip, int joints) {
  PackClip still{0, 1, clip.matrices};
  still.matrices.resize(std::min(still.matrices.size(), static_cast<size_t>(joints)));
  return still;
}

Tint ReadTint(const GltfFile& file, const TourObject& json) {
  Tint tint;
  tint.color = json.Color("color");
  tint.reach = json.Real("reach", kMinTintReach, 1);
  tint.colors = json.Colors("colors");
  if (tint.colors.size() > kMaxTintColors) json.Refuse("has more than eight colors");
  if (json.Has("materials")) {
    const size_t materials = CountOf(file.json, "materials");
    tint.materials = json.Wholes("materials", 0, static_cast<double>(materials) - 1);
    tint.by_material = true;
    if (tint.materials.empty()) json.Refuse("may dye none of the materials");
  }
  return tint;
}

PackProp ReadProp(const GltfFile& file, int skin, const TourObject& json, MeshTable* meshes) {
  const Json& nodes = Member(file.json, "nodes");
  const Json& node = At(nodes, json.Whole("node", 0, static_cast<double>(nodes.size()) - 1));
  if (Index(node, "skin", Member(file.json, "skins").size()) != skin) json.Refuse("has another skin than the levels");
  PackProp prop;
  prop.name = json.Text("name");
  prop.mesh = meshes->Get(Index(node, "mesh", Member(file.json, "meshes").size()));
  prop.triangles = json.Whole("triangles", 1, 1e6);
  prop.share = json.Real("share", 0, 1);
  prop.slot = json.Text("slot");
  if (json.Has("clip")) prop.clip = json.Text("clip");
  return prop;
}

std::vector<PackOtherClip> ReadOtherClips(const GltfFile& file, const Skin& skin, const TourObject& avatar) {
  std::vector<PackOtherClip> clips;
  if (!avatar.Has("other_clips")) return clips;
  const double last = static_cast<double>(CountOf(file.json, "animations")) - 1;
  const std::vector<TourObject> objects = avatar.Objects("other_clips", kMaxOtherClips);
  for (const TourObject& c : objects) {
    clips.push_back({c.Text("name"), ReadClip(file, skin, c.Whole("animation", 0, last))});
    if (c.Has("seat_m")) clips.back().seat_m = c.Real("seat_m", 0, kMaxSeat_m);
    if (c.Has("speed_mps")) clips.back().speed_mps = c.Real("speed_mps", 0, kMaxRun_mps);
  }
  return clips;
}

PackAvatar ReadAvatar(const GltfFile& file, const TourObject& json, MeshTable* meshes) {
  constexpr double kAboveZero = TourObject::kAboveZero, kAnything = TourObject::kAnything;
  PackAvatar avatar;
  avatar.name = json.Text("name");
  avatar.share = json.Real("share", 0, kMostShare);
  avatar.height_m = json.Real("height_m", kLeastPerson_m, kMostPerson_m);
  avatar.radius_m = json.Real("radius_m", kAboveZero, kMostPersonRadius_m);
  avatar.reach_m = json.Has("reach_m") ? json.Real("reach_m", kAboveZero, kMostReach_m) : 0;
  avatar.walk_speed_mps = json.Real("walk_speed_mps", kAboveZero, kMostWalk_mps);
  if (json.Has("height_spread")) avatar.height_spread = json.Real("height_spread", 0, kMaxHeightSpread);
  if (json.Has("breadth_spread")) avatar.breadth_spread = json.Real("breadth_spread", 0, kMaxBreadthSpread);
  const Json& nodes = Member(file.json, "nodes");
  int skin_index = -1;
  for (const TourObject& level_json : json.Objects("levels", kMostLevels)) {
    const Json& node = At(nodes, level_json.Whole("node", 0, static_cast<double>(nodes.size()) - 1));
    PackLevel level;
    level.mesh = meshes->Get(Index(node, "mesh", Member(file.json, "meshes").size()));
    level.triangles = level_json.Whole("triangles", 1, 1e9);
    level.error_mm = level_json.Real("error_mm", 0, kAnything);
    level.posed_error_mm = level_json.Real("posed_error_mm", 0, kAnything);
    level.switch_px = level_json.Real("switch_px", 0, kAnything);
    const int level_skin = Index(node, "skin", Member(file.json, "skins").size());
    if (skin_index >= 0 && level_skin != skin_index) level_json.Refuse("has another skin than the level before");
    skin_index = level_skin;
    avatar.levels.push_back(level);
  }
  if (avatar.levels.empty()) json.Refuse("has no levels");
  const Skin skin = ReadSkin(file, skin_index);
  avatar.joints = Count(skin.joints);
  avatar.skeleton = ReadSkeleton(file, skin);
  const double last = static_cast<double>(CountOf(file.json, "animations")) - 1;
  const TourObject clips = json.Object("clips");
  const auto clip = [&](const char* name) { return ReadClip(file, skin, clips.Whole(name, -1, last)); };
  avatar.walk = clip("walk");
  avatar.idle = clips.Has("idle") ? clip("idle") : FirstFrame(avatar.walk, avatar.joints);
  avatar.talk = clips.Has("talk") ? clip("talk") : avatar.idle;
  avatar.other_clips = ReadOtherClips(file, skin, json);
  avatar.impostor = ReadImpostor(file, json.Object("impostor"));
  if (json.Has("props")) {
    for (const TourObject& prop : json.Objects("props", kMaxProps))
      avatar.props.push_back(ReadProp(file, skin_index, prop, meshes));
  }
  if (json.Has("tints")) {
    for (const TourObject& tint : json.Objects("tints", kMaxTints)) avatar.tints.push_back(ReadTint(file, tint));
  }
  return avatar;
}

void ReadObstacle(const TourObject& json, size_t* points, Obstacles* obstacles) {
  json.Text("name");
  json.OneOf("kind", {"building", "wall", "tree", "lamp", "other"});
  if (json.Has("radius_m")) {
    const float radius_m = json.Real("radius_m", TourObject::kAboveZero, kMostSide_m);
    obstacles->circles.push_back({json.Point("center_m"), radius_m});
    return;
  }
  PolygonObstacle polygon{json.Ring("outer_m"), {}};
  if (json.Has("holes_m")) polygon.holes = json.Rings("holes_m");
  *points += polygon.outer.size();
  for (const auto& hole : polygon.holes) *points += hole.size();
  if (*points > kMostObstaclePoints) json.Refuse("and those before it have more points than a tour may have");
  obstacles->polygons.push_back(std::move(polygon));
}

// Where a raster lies; how many cells it has.
template <typename Raster>
size_t ReadRasterFrame(const TourObject& json, Raster* raster) {
  raster->min_m = json.Point("min_m");
  raster->cell_m = json.Real("cell_m", kLeastCell_m, kMostCell_m);
  const double most = std::floor(kMostSide_m / static_cast<double>(raster->cell_m));
  raster->columns = json.Whole("columns", 1, most);
  raster->rows = json.Whole("rows", 1, most);
  return static_cast<size_t>(raster->columns) * static_cast<size_t>(raster->rows);
}

GroundRaster ReadGround(const GltfFile& file, const TourObject& json) {
  GroundRaster ground;
  const size_t cells = ReadRasterFrame(json, &ground);
  const double last = static_cast<double>(Member(file.json, "bufferViews").size()) - 1;
  const auto heights = BufferView(file, json.Whole("height_view", 0, last));
  const auto kinds = BufferView(file, json.Whole("kind_view", 0, last));
  if (heights.size() != cells * 4 || kinds.size() != cells) json.Refuse("has views of the wrong size");
  file.allowance->TakeMemory(5 * cells, "the ground");
  ground.height_m.resize(cells);
  std::memcpy(ground.height_m.data(), heights.data(), heights.size());
  for (float h : ground.height_m) {
    if (!(std::abs(static_cast<double>(h)) <= kMostCoordinate_m))
      throw PackRefused("has a ground height that is not finite, or out of range");
  }
  ground.kind.assign(kinds.begin(), kinds.end());
  return ground;
}

Painting ReadPainting(const GltfFile& file, const TourObject& json) {
  Painting painting;
  const size_t cells = ReadRasterFrame(json, &painting);
  const double last = static_cast<double>(Member(file.json, "bufferViews").size()) - 1;
  const auto people = BufferView(file, json.Whole("people_view", 0, last));
  const auto loiter = BufferView(file, json.Whole("loiter_view", 0, last));
  if (people.size() != cells || loiter.size() != cells) json.Refuse("has views of the wrong size");
  file.allowance->TakeMemory(2 * cells, "the painting");
  painting.people.assign(people.begin(), people.end());
  painting.loiter.assign(loiter.begin(), loiter.end());
  return painting;
}

TourStop ReadStop(const GltfFile& file, const TourObject& json, TourPack* pack) {
  TourStop stop{json.Point("position_m")};
  if (json.Has("yaw_rad")) stop.yaw_rad = json.Yaw("yaw_rad");
  stop.pause_s = json.Real("pause_s", 0, kMostPause_s);
  stop.caption = json.Text("caption", kMostText_bytes);
  stop.captions = ReadTranslations(json, "captions");
  stop.sounds = ReadSounds(file, json, pack);
  return stop;
}

Place ReadPlay(const TourObject& json) {
  Place place{json.Text("name"), "play", json.Point("position_m")};
  place.width_m = json.Real("width_m", TourObject::kAboveZero, kMaxPlay_m);
  place.clip = json.Text("clip");
  place.people = json.Whole("people", 1, kMaxPlayers);
  if (json.Has("avatars")) place.avatars = json.Texts("avatars");
  return place;
}

Place ReadWork(const TourObject& json) {
  Place place{json.Text("name"), "work", json.Point("position_m")};
  place.yaw_rad = json.Yaw("yaw_rad");
  if (json.Has("clip")) place.clip = json.Text("clip");
  if (json.Has("avatars")) place.avatars = json.Texts("avatars");
  if (json.Has("seat_m")) place.seat_m = json.Real("seat_m", 0, kMaxSeat_m);
  if (json.Has("stay_s")) place.stay_s = json.Real("stay_s", 0, kMaxStay_s);
  return place;
}

void ReadTour(const GltfFile& file, const TourObject& tour, TourPack* pack) {
  pack->name = tour.Text("name");
  pack->titles = ReadTranslations(tour, "titles");
  size_t points = 0;
  for (const TourObject& o : tour.Objects("obstacles", kMostObstacles)) ReadObstacle(o, &points, &pack->obstacles);
  for (const TourObject& p : tour.Objects("places", kMostPlaces)) {
    pack->places.push_back({p.Text("name"), p.OneOf("kind", {"door", "exit", "goal", "loiter", "spawn"}),
                            p.Point("position_m"), p.Real("width_m", TourObject::kAboveZero, kMostSide_m)});
    if (p.Has("yaw_rad")) pack->places.back().yaw_rad = p.Yaw("yaw_rad");
  }
  if (tour.Has("work")) {
    for (const TourObject& w : tour.Objects("work", kMostPlaces)) pack->places.push_back(ReadWork(w));
  }
  if (tour.Has("play")) {
    for (const TourObject& p : tour.Objects("play", kMostPlaces)) pack->places.push_back(ReadPlay(p));
  }
  if (tour.Has("painting")) pack->painting = ReadPainting(file, tour.Object("painting"));
  for (const TourObject& s : tour.Objects("path", kMostStops)) pack->path.push_back(ReadStop(file, s, pack));
  if (tour.Has("language")) pack->language = tour.Text("language");
  if (tour.Has("guide")) pack->guide = tour.Text("guide");
  if (tour.Has("title_page")) {
    const TourObject page = tour.Object("title_page");
    page.Color("background");
    for (const char* view : {"picture_view", "logo_view"}) {
      if (page.Has(view)) page.View(view, Member(file.json, "bufferViews").size());
    }
  }
  ReadVisitorData(file, tour, pack);
  ReadLife(tour, pack);
  pack->thanks = ReadTranslations(tour, "thanks");
  if (tour.Has("home_after_s")) pack->home_after_s = tour.Real("home_after_s", 0, kLongestIdle_s);
  VisitFields(tour.Object("crowd"), &pack->crowd);
  VisitFields(tour.Object("control"), &pack->control);
  VisitFields(tour.Object("light"), &pack->light);
}

// The materials alone.
PackMesh ReadOutline(const GltfFile& file, int mesh) {
  PackMesh out;
  for (const Json& json : Member(Element(file.json, "meshes", mesh), "primitives")) {
    PackPrimitive primitive;
    primitive.material = IndexOrNone(json, "material", Member(file.json, "materials").size());
    out.primitives.push_back(std::move(primitive));
  }
  return out;
}

// Notes in the materials of an avatar's levels which tints may dye them.
void BindTints(const PackAvatar& avatar, const std::vector<PackMesh>& meshes, Allowance* allowance,
               std::vector<PackMaterial>* materials) {
  for (size_t t = 0; t < avatar.tints.size(); ++t) {
    const std::vector<int>& dyed = avatar.tints[t].materials;
    if (dyed.empty()) continue;
    for (const PackLevel& level : avatar.levels) {
      allowance->TakeWork(Product(At(meshes, level.mesh).primitives.size(), dyed.size()), "a tint's materials");
      for (const PackPrimitive& primitive : At(meshes, level.mesh).primitives) {
        if (primitive.material < 0 || std::find(dyed.begin(), dyed.end(), primitive.material) != dyed.end()) continue;
        uint8_t& tints = At(*materials, primitive.material).tints;
        tints = static_cast<uint8_t>(tints & ~(1u << t));
      }
    }
  }
}

TourObject TourOf(const GltfFile& file) {
  const auto extensions = file.json.find("extensions");
  if (extensions == file.json.end() || !extensions->contains(kTourExtension)) {
    throw PackRefused(std::string("is a glTF binary but no tour pack: it has no ") + kTourExtension +
                      "; make one with 'flaneur bake'");
  }
  return TourObject((*extensions)[kTourExtension], kTourExtension);
}

void CheckVersion(const TourObject& tour) {
  const int version = tour.Whole("version", 0, 1e9);
  if (version >= kOldestTourPackVersion && version <= kTourPackVersion) return;
  throw PackRefused("is a tour pack of version " + std::to_string(version) + ", this player reads version " +
                    std::to_string(kTourPackVersion) +
                    (version > kTourPackVersion ? "; use a newer player" : "; bake the tour again"));
}

}  // namespace

struct PackFile::Impl {
  GltfFile file;
  std::string name;
  std::vector<int> meshes;            // of the file, by mesh of the pack
  std::vector<TourObject> impostors;  // by avatar
  std::vector<PackImpostor> atlases;  // their sizes
  std::vector<int> joints;            // by mesh; 0: of the town

  PackMesh Mesh(size_t mesh) const {
    PackMesh read = flaneur::ReadMesh(file, meshes[mesh]);
    for (const PackPrimitive& primitive : read.primitives) CheckJointsOf(mesh, primitive);
    return read;
  }

  void CheckJointsOf(size_t mesh, const PackPrimitive& primitive) const {
    if (joints[mesh] > 0) CheckJoints(primitive, joints[mesh]);
  }

  void TakeReach(const PackAvatar& avatar, int mesh) const {
    constexpr uint64_t kVertexWork = 8;
    const auto frames = static_cast<uint64_t>(avatar.walk.frames + avatar.idle.frames + avatar.talk.frames);
    file.allowance->TakeWork(Product(SizeOfMesh(file, At(meshes, mesh)).vertices, frames * kVertexWork), "a prop");
  }

  // Packs of before do not say it.
  void FindReach(PackAvatar* avatar) const {
    const bool said = avatar->reach_m > 0;
    avatar->reach_m = std::max(avatar->reach_m, avatar->radius_m);
    if (said) return;
    avatar->reach_m = std::max(avatar->reach_m, std::min(kMostReach_m, ReachOfPictures_m(avatar->impostor)));
    for (const PackProp& prop : avatar->props) {
      TakeReach(*avatar, prop.mesh);
      const PackMesh mesh = Mesh(static_cast<size_t>(prop.mesh));
      for (const PackClip* clip : {&avatar->walk, &avatar->idle, &avatar->talk})
        avatar->reach_m = std::max(avatar->reach_m, std::min(kMostReach_m, PosedReach_m(mesh, *clip, avatar->joints)));
    }
  }

  void Read(TourPack* pack) {
    const TourObject tour = TourOf(file);
    CheckVersion(tour);
    ReadTour(file, tour, pack);
    pack->ground = Share(ReadGround(file, tour.Object("ground")));
    for (size_t m = 0; m < CountOf(file.json, "materials"); ++m)
      pack->materials.push_back(ReadMaterial(file, file.json["materials"][m]));
    MeshTable table;
    ReadTown(file, &table, pack);
    for (const TourObject& a : tour.Objects("avatars", kMostAvatars)) {
      pack->avatars.push_back(ReadAvatar(file, a, &table));
      impostors.push_back(a.Object("impostor"));
      atlases.push_back(pack->avatars.back().impostor);
    }
    if (pack->avatars.empty()) tour.Refuse("has no avatars");
    const auto has_share = [](const PackAvatar& a) { return a.share > 0; };
    if (std::none_of(pack->avatars.begin(), pack->avatars.end(), has_share))
      tour.Refuse("has no avatar with a share above 0: nobody could live there");
    const auto is_guide = [&](const PackAvatar& a) { return a.name == pack->guide; };
    if (!pack->guide.empty() && std::none_of(pack->avatars.begin(), pack->avatars.end(), is_guide)) {
      tour.Refuse("has a guide '" + pack->guide + "' who is none of its avatars");
    }
    meshes = table.used();
    TakeBulk(*pack);
    joints.resize(meshes.size());
    for (int mesh : meshes) pack->meshes.push_back(ReadOutline(file, mesh));
    for (const PackAvatar& avatar : pack->avatars) {
      for (const PackLevel& level : avatar.levels) At(joints, level.mesh) = avatar.joints;
      for (const PackProp& prop : avatar.props) At(joints, prop.mesh) = avatar.joints;
      BindTints(avatar, pack->meshes, file.allowance, &pack->materials);
    }
    for (PackAvatar& avatar : pack->avatars) {
      FindReach(&avatar);
      avatar.reach_m =
          std::min(kMostReach_m, avatar.reach_m * (1 + avatar.height_spread) * (1 + avatar.breadth_spread));
    }
    for (size_t i = 0; i < CountOf(file.json, "images"); ++i) {
      pack->images.push_back(ReadImageSize(file, static_cast<int>(i)));
      const PackImage& image = pack->images.back();
      file.allowance->TakePicture(image.width_px, image.height_px, NameOf(file, static_cast<int>(i)));
    }
  }

  // A mesh that is read for each who shows it, and drawn as often.
  void TakeMesh(int mesh) {
    const MeshSize size = SizeOfMesh(file, At(meshes, mesh));
    const std::string what = "mesh " + std::to_string(At(meshes, mesh));
    constexpr uint64_t kVertex_bytes = 64, kIndex_bytes = 4, kVertexWork = 20, kIndexWork = 5;
    file.allowance->TakeMemory(Product(size.vertices, kVertex_bytes) + Product(size.indices, kIndex_bytes), what);
    file.allowance->TakeWork(Product(size.vertices, kVertexWork) + Product(size.indices, kIndexWork) + size.primitives,
                             what);
  }

  // What will be read and drawn later: who shares something has it all the same.
  void TakeBulk(const TourPack& pack) {
    for (const TownInstance& instance : pack.town) TakeMesh(instance.mesh);
    for (size_t a = 0; a < pack.avatars.size(); ++a) {
      for (const PackLevel& level : pack.avatars[a].levels) TakeMesh(level.mesh);
      for (const PackProp& prop : pack.avatars[a].props) TakeMesh(prop.mesh);
      for (const AtlasView& view : kAtlasViews) {
        if (!impostors[a].Has(view.name)) continue;
        const int index = impostors[a].View(view.name, CountOf(file.json, "bufferViews"));
        const uint64_t bytes =
            std::max<uint64_t>(RangeOfView(file, index).bytes, Ktx2BytesInMemory(BeginningOfView(file, index)));
        file.allowance->TakeMemory(bytes, std::string("an impostor's ") + view.name);
      }
    }
  }
};

namespace {

Error Caught(const std::string& name, auto read) {
  try {
    read();
    return Ok();
  } catch (const std::bad_alloc&) {
    return Fail(name + ": there is not enough memory for it");
  } catch (const std::exception& e) {
    return Fail(name + ": " + OneLine(Complaint(e)));
  }
}

}  // namespace

PackFile::PackFile() = default;
PackFile::PackFile(PackFile&&) noexcept = default;
PackFile& PackFile::operator=(PackFile&&) noexcept = default;
PackFile::~PackFile() = default;

Error PackFile::Open(const std::filesystem::path& path, TourPack* pack, const PackLimits& limits) {
  FileBytes bytes;
  if (Error e = ReadFile(path, &bytes)) return e;
  return Open(std::move(bytes), path.string(), pack, limits);
}

Error PackFile::Open(FileBytes bytes, const std::string& name, TourPack* pack, const PackLimits& limits) {
  return OpenPart(std::move(bytes), {}, name, pack, limits);
}

Error PackFile::Open(FileBytes bytes, ByteRanges there, const std::string& name, TourPack* pack) {
  if (there.Holds({0, bytes.size()})) return Open(std::move(bytes), name, pack);
  return OpenPart(std::move(bytes), std::move(there), name, pack, {});
}

Error PackFile::OpenPart(FileBytes bytes, std::optional<ByteRanges> there, const std::string& name, TourPack* pack,
                         const PackLimits& limits) {
  return Caught(name, [&] {
    auto impl = std::make_unique<Impl>();
    Allowance allowance(bytes.size(), limits);
    impl->file = OpenGltf(std::move(bytes), std::move(there), &allowance);
    impl->name = name;
    TourPack read;
    impl->Read(&read);
    impl->file.allowance = nullptr;
    impl_ = std::move(impl);
    *pack = std::move(read);
  });
}

Error PackFile::ReadImage(int image, PackImage* out) const {
  return Caught(impl_->name, [&] { *out = flaneur::ReadImage(impl_->file, image); });
}

Error PackFile::ReadMesh(int mesh, PackMesh* out) const {
  return Caught(impl_->name, [&] { *out = impl_->Mesh(static_cast<size_t>(mesh)); });
}

Error PackFile::ReadPrimitive(int mesh, size_t primitive, PackPrimitive* out) const {
  return Caught(impl_->name, [&] {
    PackPrimitive read = flaneur::ReadPrimitive(impl_->file, At(impl_->meshes, mesh), primitive);
    impl_->CheckJointsOf(static_cast<size_t>(mesh), read);
    *out = std::move(read);
  });
}

Error PackFile::ReadAtlas(int avatar, PackImpostor* out) const {
  return Caught(impl_->name, [&] {
    const auto index = static_cast<size_t>(avatar);
    PackImpostor read = impl_->atlases[index];
    flaneur::ReadAtlas(impl_->file, impl_->impostors[index], &read);
    *out = std::move(read);
  });
}

template <typename Collect>
std::vector<ByteRange> PackFile::Ranges(Collect collect) const {
  std::vector<ByteRange> ranges;
  if (!impl_ || Caught(impl_->name, [&] { collect(impl_->file, &ranges); })) ranges.clear();
  return ranges;
}

Error PackFile::Arrive(size_t offset, std::span<const uint8_t> bytes) {
  if (!impl_) return Ok();  // nobody reads any more
  const std::span<uint8_t> all = impl_->file.bytes.span();
  if (offset > all.size() || bytes.size() > all.size() - offset)
    return Fail(impl_->name + ": has a piece beyond its end");
  std::optional<ByteRanges>& there = impl_->file.there;
  if (!there) return Ok();
  std::copy(bytes.begin(), bytes.end(), all.begin() + static_cast<std::ptrdiff_t>(offset));
  there->Add({offset, bytes.size()});
  if (there->Holds({0, all.size()})) there.reset();
  return Ok();
}

bool PackFile::IsWhole() const { return !impl_ || !impl_->file.there; }

bool PackFile::Holds(const std::vector<ByteRange>& ranges) const {
  return IsWhole() || std::all_of(ranges.begin(), ranges.end(),
                                  [&](const ByteRange& range) { return impl_->file.there->Holds(range); });
}

std::vector<ByteRange> PackFile::RangesOfImage(int image) const {
  return Ranges([&](const GltfFile& file, std::vector<ByteRange>* ranges) {
    ranges->push_back(RangeOfView(file, ImageView(file, image)));
  });
}

std::vector<ByteRange> PackFile::RangesOfMesh(int mesh) const {
  return Ranges([&](const GltfFile& file, std::vector<ByteRange>* ranges) {
    for (int view : ViewsOfMesh(file, At(impl_->meshes, mesh))) ranges->push_back(RangeOfView(file, view));
  });
}

std::vector<ByteRange> PackFile::RangesOfAtlas(int avatar, int finest_level) const {
  return Ranges([&](const GltfFile& file, std::vector<ByteRange>* ranges) {
    const TourObject& json = At(impl_->impostors, avatar);
    const double last = static_cast<double>(Member(file.json, "bufferViews").size()) - 1;
    const int width_px = At(impl_->atlases, avatar).width_px;
    for (const AtlasView& view : kAtlasViews) {
      if (!json.Has(view.name)) continue;
      const int index = json.Whole(view.name, 0, last);
      ByteRange range = RangeOfView(file, index);
      if (finest_level > 0)
        range.bytes =
            Ktx2BytesOfWidth(BeginningOfView(file, index), range.bytes, width_px >> (view.halved + finest_level));
      ranges->push_back(range);
    }
  });
}

Error LoadTourPack(const std::filesystem::path& path, const LoadOptions& options, TourPack* pack) {
  FileBytes bytes;
  if (Error e = ReadFile(path, &bytes)) return e;
  return ParseTourPack(std::move(bytes), path.string(), options, pack);
}

Error ParseTourPack(FileBytes bytes, const std::string& name, const LoadOptions& options, TourPack* pack) {
  PackFile file;
  TourPack loaded;
  if (Error e = file.Open(std::move(bytes), name, &loaded, options.limits)) return e;
  if (options.geometry_and_images) {
    const size_t images = loaded.images.size(), meshes = loaded.meshes.size(),
                 count = images + meshes + loaded.avatars.size();
    std::vector<Error> errors(count);
    ParallelFor(options.jobs, count, [&](size_t i) {
      if (i < images) errors[i] = file.ReadImage(static_cast<int>(i), &loaded.images[i]);
      else if (i < images + meshes) errors[i] = file.ReadMesh(static_cast<int>(i - images), &loaded.meshes[i - images]);
      else
        errors[i] =
            file.ReadAtlas(static_cast<int>(i - images - meshes), &loaded.avatars[i - images - meshes].impostor);
    });
    for (const Error& e : errors) {
      if (e) return e;
    }
  }
  *pack = std::move(loaded);
  return Ok();
}

}  // namespace flaneur
