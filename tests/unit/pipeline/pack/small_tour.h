// A small tour of everything that a pack may hold, and the pack's JSON changed.
#pragma once
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <vector>

#include "pipeline/core/temporary_folder.h"
#include "pipeline/pack/write_tour_pack.h"
#include "runtime/base/file.h"
#include "runtime/base/png.h"
#include "runtime/pack/ktx2.h"
#include "tests/unit/pipeline/test_person.h"

namespace flaneur {

using Json = nlohmann::json;

inline Image Png(const std::string& name, int width, int height) {
  std::vector<uint8_t> pixels(static_cast<size_t>(width * height) * 4);
  for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<uint8_t>(i * 7 + name.size());
  return {name, "image/png", EncodePng(width, height, 4, pixels)};
}

inline Mesh Quad() {
  Mesh mesh;
  mesh.name = "quad";
  mesh.material = 0;
  mesh.positions = {{-20, 0, -20}, {20, 0, -20}, {20, 0, 20}, {-20, 0, 20}};
  mesh.normals.assign(4, Vec3{0, 1, 0});
  mesh.uvs = {{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  mesh.indices = {0, 2, 1, 0, 3, 2};
  return mesh;
}

inline Scene SmallTown() {
  Scene town;
  Material material;
  material.name = "cobbles";
  material.base_color_image = 0;
  town.materials = {material};
  town.images = {Png("cobbles", 4, 4)};
  town.meshes = {Quad()};
  for (int i = 0; i < 3; ++i) {  // the last one shears, which no glTF node can say
    SceneNode node;
    node.name = "part_" + std::to_string(i);
    node.meshes = {0};
    node.kind = NodeKind::kGround;
    node.ground = GroundKind::kSquare;
    node.world = Moved({static_cast<float>(50 * i), 0, 0});
    if (i == 2) node.world.m[1][0] = 0.5f;
    town.nodes.push_back(node);
  }
  return town;
}

// Two levels of bytes that count up.
inline std::vector<uint8_t> Ktx2(TextureFormat format, int width, int height) {
  PackTexture texture{format, width, height, {}};
  for (int k = 0; k < 2; ++k) {
    texture.levels.emplace_back(LevelBytes(format, width >> k, height >> k));
    std::iota(texture.levels.back().begin(), texture.levels.back().end(), uint8_t{1});
  }
  return WriteKtx2(texture, Supercompression::kZstandard);
}

inline ImpostorAtlas SmallAtlas() {
  ImpostorAtlas atlas;
  atlas.directions = 4;
  atlas.elevations_deg = {0, 20};
  atlas.frames = 3;
  atlas.width_px = 32;
  atlas.height_px = 64;
  atlas.texel_m = 0.25f;
  atlas.depth_range_m = 0.5f;
  atlas.motion_range_m = atlas.bend_range_m = 0.125f;
  atlas.clips = {{"walk", 0, 2}, {"idle", 2, 1}};
  for (int i = 0; i < 4 * 2 * 3; ++i) atlas.cells.push_back({i % 8 * 4, i / 8 * 8, 4, 8, i % 8 * 4 + 2, i / 8 * 8 + 7});
  atlas.albedo_ktx2 = Ktx2(TextureFormat::kBc7Srgb, 32, 64);
  atlas.normal_ktx2 = Ktx2(TextureFormat::kBc5, 32, 64);
  atlas.depth_ktx2 = Ktx2(TextureFormat::kBc4, 32, 64);
  atlas.motion_ktx2 = Ktx2(TextureFormat::kBc7, 16, 32);
  return atlas;
}

inline AvatarLevels TwoLevels() {
  AvatarLevels levels = OneLevel(MadePerson());
  AvatarLevel coarse = levels.levels[0];
  for (Mesh& mesh : coarse.meshes) mesh.indices.resize(mesh.indices.size() / 6 * 3);
  coarse.triangles = 0;
  for (const Mesh& mesh : coarse.meshes) coarse.triangles += TriangleCount(mesh);
  coarse.posed_error_mm = 12.5f;
  levels.levels[0].switch_px = 90;
  levels.levels.push_back(coarse);
  Mesh stick = coarse.meshes[0];
  stick.indices.resize(3);
  levels.avatar.props = {{"stick", {stick}}};
  return levels;
}

inline Footprints SmallFootprints() {
  Footprints footprints;
  Obstacle house, tree;
  house.name = "house_1";
  house.outer = {{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  house.holes = {{{1, 1}, {1, 2}, {2, 2}, {2, 1}}};
  tree.name = "tree_1";
  tree.kind = ObstacleKind::kTree;
  tree.center = {-3, 2};
  tree.radius_m = 0.4;
  footprints.obstacles = {house, tree};
  return footprints;
}

inline TourParts SmallTour() {
  TourParts parts;
  parts.name = "small";
  parts.town = SmallTown();
  parts.avatars = {{TwoLevels(),
                    SmallAtlas(),
                    2.5f,
                    {{{0.2f, 0.4f, 0.6f}, 0.1f, {{1, 0, 0}, {0, 0.6f, 0}}}},
                    {{"stick", 0.5f, "hand"}},
                    {},
                    0.05f,
                    0.03f}};
  parts.footprints = SmallFootprints();
  parts.ground = {{-20, -20}, 10, 4, 3, std::vector<float>(12, 0.25f), std::vector<uint8_t>(12, 3)};
  parts.ground.height_m[5] = -1.5f;
  parts.places = {{"west", "exit", {-18, 0}, 2}, {"stall", "loiter", {3, 0}, 1, 0.5f}};
  Place green{"green", "play", {1, 3}, 9};
  green.clip = "run";
  green.people = 5;
  parts.places.push_back(green);
  parts.painting = {{-4, -2}, 2, 2, 1, {0, 200}, {30, 0}};
  parts.path = {{{1, 2}, 0.5f, 3, "Grüß Gott"}};
  parts.language = "de";
  parts.titles = {{"de", "Kleiner Markt"}, {"en", "Little market"}};
  parts.path[0].captions["en"] = "Good day";
  parts.sounds = {{'O', 'g', 'g', 'S'}, {1, 2, 3}};
  parts.path[0].sounds = {{"de", {1, 2.5f}}, {"en", {0, 3.5f}}};
  parts.pictures = {{9, 8, 7}};
  parts.hotspots = {
      {{3, -4}, 2.5f, 9, {{"de", "Brunnen"}}, {{"de", "Tief."}, {"en", "Deep."}}, 0, {{"en", {0, 3.5f}}}}};
  parts.streets = {{{{"de", "Lange Straße"}}, {{0, 1}, {5, 1}, {9, 3}}}};
  parts.sound_places = {{SoundKind::kWater, {1, 1}, 0.5f, 12, 0.75f, -1}, {SoundKind::kLoop, {2, 2}, 1, 30, 1, 1}};
  parts.photo = {{{"de", "Grüße"}}, "https://example.org/{file}"};
  parts.flocks = {{"made", {4, 5}, 3.5f, 9, 2, "fly"}};
  parts.smokes = {{{1, -2, 14}, 0.1f, 0.25f}};  // as narrow as may be
  parts.wind = {1.5f, 2.5f};
  parts.guide = parts.avatars[0].levels.avatar.name;
  parts.title_page = {{'J', 'F', 'I', 'F'}, {'P', 'N', 'G'}, {0, 0.2f, 1}};
  parts.thanks = {{"de", "Danke!"}, {"en", "Thanks!"}};
  parts.home_after_s = 12;
  parts.crowd.people = 17;
  parts.control.method = LimitMethod::kFrameTime;
  parts.light.day_length_s = 0;
  return parts;
}

// As a bake writes it.
inline Error WriteWhole(const std::filesystem::path& path, TourParts parts, size_t* size) {
  for (TourAvatar& avatar : parts.avatars) {
    if (Error e = EncodeTourAvatar(&avatar, nullptr)) return e;
  }
  if (Error e = EncodeTown(parts.town, nullptr, &parts.encoded_town)) return e;
  TourModels models;
  if (Error e = BuildModels(parts, &models)) return e;
  for (TourAvatar& avatar : parts.avatars) avatar = WithoutBulk(avatar);
  parts.town = {};
  parts.encoded_town = {};
  return WriteTourPack(path, parts, models, size);
}

inline std::vector<uint8_t> Written(const TourParts& parts) {
  TemporaryFolder folder;
  EXPECT_FALSE(folder.Create("flaneur_test_"));
  size_t size = 0;
  EXPECT_EQ(WriteWhole(folder.path() / "small.glb", parts, &size).message, "");
  std::vector<uint8_t> bytes;
  EXPECT_FALSE(ReadFile(folder.path() / "small.glb", &bytes));
  EXPECT_EQ(bytes.size(), size);
  return bytes;
}

inline uint32_t GetWord(const std::vector<uint8_t>& bytes, size_t offset) {
  uint32_t word = 0;
  std::memcpy(&word, bytes.data() + offset, 4);
  return word;
}

inline void PutWord(std::vector<uint8_t>* bytes, size_t offset, size_t value) {
  const uint32_t word = static_cast<uint32_t>(value);
  std::memcpy(bytes->data() + offset, &word, 4);
}

// The pack with other JSON in its first chunk.
inline std::vector<uint8_t> WithJson(const std::vector<uint8_t>& pack, const Json& json) {
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::vector<uint8_t> bytes = pack;
  bytes.erase(bytes.begin() + 20, bytes.begin() + 20 + GetWord(pack, 12));
  bytes.insert(bytes.begin() + 20, text.begin(), text.end());
  PutWord(&bytes, 8, bytes.size());
  PutWord(&bytes, 12, text.size());
  return bytes;
}

inline Json JsonOf(const std::vector<uint8_t>& pack) {
  return Json::parse(pack.begin() + 20, pack.begin() + 20 + GetWord(pack, 12));
}

}  // namespace flaneur
