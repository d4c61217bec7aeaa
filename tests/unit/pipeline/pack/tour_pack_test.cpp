// Packs written and read again: both halves of the contract at once, and what a reader does with broken bytes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>
#include <set>

#include "pipeline/core/temporary_folder.h"
#include "pipeline/pack/write_tour_pack.h"
#include "runtime/base/file.h"
#include "runtime/base/png.h"
#include "runtime/pack/ktx2.h"
#include "runtime/pack/title_page.h"
#include "runtime/pack/tour_pack.h"
#include "tests/unit/pipeline/pack/small_tour.h"

namespace flaneur {
namespace {

TourPack Read(const std::vector<uint8_t>& bytes, const LoadOptions& options = {}) {
  TourPack pack;
  EXPECT_EQ(ParseTourPack(bytes, "small.glb", options, &pack).message, "");
  return pack;
}

TEST(TourPack, TheSamePartsGiveTheSameBytes) { EXPECT_EQ(Written(SmallTour()), Written(SmallTour())); }

// A visitor would see nothing of it, and the bake would have said that all is well.
TEST(TourPack, OneThatThePlayerRefusesIsNoResult) {
  TourParts parts = SmallTour();
  parts.avatars[0].share = 0;
  TemporaryFolder folder;
  ASSERT_FALSE(folder.Create("flaneur_test_"));
  size_t size = 0;
  const std::string message = WriteWhole(folder.path() / "small.glb", parts, &size).message;
  EXPECT_NE(message.find("the player refuses"), std::string::npos) << message;
  EXPECT_NE(message.find("small.glb: "), std::string::npos) << message;
  EXPECT_NE(message.find("share"), std::string::npos) << message;
  EXPECT_EQ(message.find(folder.path().string()), std::string::npos) << "a temporary folder's name helps nobody";
}

TEST(TourPack, BringsTheTourAcross) {
  const TourPack pack = Read(Written(SmallTour()));
  EXPECT_EQ(pack.name, "small");
  ASSERT_EQ(pack.obstacles.polygons.size(), 1u);
  EXPECT_EQ(pack.obstacles.polygons[0].outer.size(), 4u);
  ASSERT_EQ(pack.obstacles.polygons[0].holes.size(), 1u);
  EXPECT_EQ(pack.obstacles.polygons[0].holes[0][1].y, 2);
  ASSERT_EQ(pack.obstacles.circles.size(), 1u);
  EXPECT_FLOAT_EQ(pack.obstacles.circles[0].radius_m, 0.4f);
  EXPECT_FLOAT_EQ(pack.obstacles.circles[0].center.x, -3);
  EXPECT_EQ(pack.ground->columns, 4);
  EXPECT_EQ(pack.ground->rows, 3);
  EXPECT_EQ(pack.ground->height_m[5], -1.5f);
  EXPECT_EQ(pack.ground->kind, std::vector<uint8_t>(12, 3));
  ASSERT_EQ(pack.places.size(), 3u);
  EXPECT_EQ(pack.places[2].kind, "play");
  EXPECT_EQ(pack.places[2].width_m, 9);
  EXPECT_EQ(pack.places[2].clip, "run");
  EXPECT_EQ(pack.places[2].people, 5);
  EXPECT_FALSE(pack.places[0].yaw_rad);
  EXPECT_FLOAT_EQ(pack.places[1].yaw_rad.value_or(0), 0.5f);
  EXPECT_EQ(pack.painting.columns, 2);
  EXPECT_EQ(pack.painting.people, (std::vector<uint8_t>{0, 200}));
  EXPECT_EQ(pack.painting.loiter, (std::vector<uint8_t>{30, 0}));
  EXPECT_EQ(pack.places[0].kind, "exit");
  ASSERT_EQ(pack.path.size(), 1u);
  EXPECT_EQ(pack.path[0].caption, "Grüß Gott");
  EXPECT_EQ(pack.guide, "made");
  EXPECT_EQ(pack.thanks.at("en"), "Thanks!");
  EXPECT_EQ(pack.home_after_s, 12);
  EXPECT_EQ(pack.language, "de");
  EXPECT_EQ(pack.titles.at("en"), "Little market");
  EXPECT_EQ(pack.path[0].captions.at("en"), "Good day");
  ASSERT_EQ(pack.path[0].sounds.size(), 2u);
  EXPECT_FLOAT_EQ(pack.path[0].sounds.at("de").duration_s, 2.5f);
  EXPECT_EQ(pack.sounds[static_cast<size_t>(pack.path[0].sounds.at("de").sound)], (std::vector<uint8_t>{1, 2, 3}));
  EXPECT_EQ(pack.crowd.people, 17);
  EXPECT_EQ(pack.control.method, LimitMethod::kFrameTime);
  EXPECT_EQ(pack.control.r_high_m, ControlSettings{}.r_high_m);
  EXPECT_EQ(pack.light.day_length_s, 0);
}

TEST(TourPack, BringsWhatVisitorsFindAcross) {
  const TourPack pack = Read(Written(SmallTour()));
  ASSERT_EQ(pack.hotspots.size(), 1u);
  const Hotspot& hotspot = pack.hotspots[0];
  EXPECT_EQ(hotspot.position_m.y, -4);
  EXPECT_EQ(hotspot.height_m, 2.5f);
  EXPECT_EQ(hotspot.radius_m, 9);
  EXPECT_EQ(TextIn(hotspot.titles, "en", "de"), "Brunnen");
  EXPECT_EQ(TextIn(hotspot.texts, "en", "de"), "Deep.");
  ASSERT_GE(hotspot.picture, 0);
  EXPECT_EQ(pack.pictures[static_cast<size_t>(hotspot.picture)], (std::vector<uint8_t>{9, 8, 7}));
  EXPECT_EQ(pack.sounds[static_cast<size_t>(hotspot.sounds.at("en").sound)],
            (std::vector<uint8_t>{'O', 'g', 'g', 'S'}));
  ASSERT_EQ(pack.streets.size(), 1u);
  EXPECT_EQ(pack.streets[0].points.size(), 3u);
  EXPECT_EQ(TextIn(pack.streets[0].names, "fr", "de"), "Lange Straße");
  ASSERT_EQ(pack.sound_places.size(), 2u);
  EXPECT_EQ(pack.sound_places[0].kind, SoundKind::kWater);
  EXPECT_EQ(pack.sound_places[0].volume, 0.75f);
  EXPECT_EQ(pack.sound_places[0].sound, -1);
  EXPECT_EQ(pack.sounds[static_cast<size_t>(pack.sound_places[1].sound)], (std::vector<uint8_t>{1, 2, 3}));
  EXPECT_EQ(pack.photo.link, "https://example.org/{file}");
  EXPECT_EQ(pack.photo.lines.at("de"), "Grüße");
  ASSERT_EQ(pack.flocks.size(), 1u);
  EXPECT_EQ(pack.flocks[0].avatar, "made");
  EXPECT_EQ(pack.flocks[0].position_m.y, 5);
  EXPECT_EQ(pack.flocks[0].radius_m, 3.5f);
  EXPECT_EQ(pack.flocks[0].birds, 9);
  EXPECT_EQ(pack.flocks[0].shy_m, 2);
  EXPECT_EQ(pack.flocks[0].clip, "fly");
  ASSERT_EQ(pack.smokes.size(), 1u);
  EXPECT_EQ(pack.smokes[0].position_m.z, 14);
  EXPECT_EQ(pack.smokes[0].width_m, 0.1f);
  EXPECT_EQ(pack.smokes[0].density, 0.25f);
  EXPECT_EQ(pack.wind.yaw_rad, 1.5f);
  EXPECT_EQ(pack.wind.speed_mps, 2.5f);
}

TEST(TourPack, WhatVisitorsFindMayBeMissing) {
  TourParts parts = SmallTour();
  parts.hotspots.clear();
  parts.streets.clear();
  parts.sound_places.clear();
  parts.photo = {};
  parts.flocks.clear();
  const TourPack pack = Read(Written(parts));
  EXPECT_TRUE(pack.hotspots.empty() && pack.streets.empty() && pack.sound_places.empty() && pack.photo.link.empty() &&
              pack.flocks.empty());
}

TEST(TourPack, BringsTheTownAcross) {
  const TourPack pack = Read(Written(SmallTour()));
  ASSERT_EQ(pack.town.size(), 3u);
  for (const TownInstance& part : pack.town) {
    const int i = part.name.back() - '0';
    const PackPrimitive& quad = pack.meshes[static_cast<size_t>(part.mesh)].primitives.at(0);
    EXPECT_EQ(quad.indices.size(), 6u);
    ASSERT_GE(quad.material, 0);
    EXPECT_GE(pack.materials[static_cast<size_t>(quad.material)].base_color_image, 0);
    float least_x = 1e9f;
    for (const Vec3& p : quad.positions) least_x = std::min(least_x, TransformPoint(part.world, p).x);
    EXPECT_NEAR(least_x, 50 * i - 20, 0.01);
  }
}

// Houses that a modeller mirrored, or a town with its whole root mirrored: outside stays outside, also where it shears.
TEST(TourPack, MirroredPartsShowTheirOutside) {
  TourParts parts = SmallTour();
  Mesh& mesh = parts.town.meshes[0];
  for (size_t i = 0; i < mesh.indices.size(); i += 3) std::swap(mesh.indices[i], mesh.indices[i + 1]);  // as readers do
  for (SceneNode& node : parts.town.nodes) {
    node.meshes = {0};
    for (float& x : node.world.m[0]) x = -x;
  }
  const TourPack pack = Read(Written(parts));
  ASSERT_EQ(pack.town.size(), 3u);
  for (const TownInstance& part : pack.town) {
    const PackPrimitive& quad = pack.meshes[static_cast<size_t>(part.mesh)].primitives.at(0);
    const auto at = [&](size_t i) { return TransformPoint(part.world, quad.positions[quad.indices[i]]); };
    Vec3 outside = Cross(at(1) - at(0), at(2) - at(0));
    const auto column = [&](size_t c) { return Vec3{part.world.m[c][0], part.world.m[c][1], part.world.m[c][2]}; };
    if (Dot(Cross(column(0), column(1)), column(2)) < 0) outside = outside * -1;  // as glTF says
    EXPECT_GT(outside.y, 0) << part.name << ": ground is seen from above";
  }
}

TEST(TourPack, BringsWhatTurnsInTheTownAcross) {
  TourParts parts = SmallTour();
  SceneNode node;
  node.name = "hand";
  node.meshes = {0};
  node.turns = TurnsBy::kHourHand;
  node.world = FromTranslationRotationScale({3, 12, -7}, Quat{0, std::sqrt(0.5f), 0, std::sqrt(0.5f)}, {2, 2, 2});
  parts.town.nodes.push_back(node);
  const TourPack pack = Read(Written(parts));
  ASSERT_EQ(pack.turning.size(), 1u);
  ASSERT_EQ(pack.town.size(), 4u);
  for (const TownInstance& part : pack.town) EXPECT_EQ(part.turning, part.name == "hand" ? 0 : -1);
  const TurningPart& hand = pack.turning[0];
  EXPECT_EQ(hand.by, TurnsBy::kHourHand);
  EXPECT_NEAR(Length(hand.pivot_m - Vec3{3, 7, 12}), 0, 1e-4f);
  EXPECT_NEAR(Length(hand.axis - Vec3{1, 0, 0}), 0, 1e-4f) << "its face looks east";

  parts.town.nodes[2].turns = TurnsBy::kWind;
  TemporaryFolder folder;
  EXPECT_FALSE(folder.Create("flaneur_test_"));
  size_t size = 0;
  const std::string refused = WriteWhole(folder.path() / "sheared.glb", parts, &size).message;
  EXPECT_NE(refused.find("part_2"), std::string::npos) << refused;
  EXPECT_NE(refused.find("sheared"), std::string::npos) << refused;
}

TEST(TourPack, BringsAvatarsAcross) {
  const TourParts parts = SmallTour();
  const TourPack pack = Read(Written(parts));
  ASSERT_EQ(pack.avatars.size(), 1u);
  const PackAvatar& avatar = pack.avatars[0];
  EXPECT_EQ(avatar.name, "made");
  EXPECT_EQ(avatar.share, 2.5f);
  EXPECT_EQ(avatar.walk_speed_mps, 1.2f);
  ASSERT_EQ(avatar.props.size(), 1u);
  EXPECT_EQ(avatar.props[0].name, "stick");
  EXPECT_EQ(avatar.props[0].slot, "hand");
  EXPECT_EQ(avatar.props[0].share, 0.5f);
  EXPECT_EQ(avatar.props[0].triangles, 1);
  EXPECT_EQ(pack.meshes[static_cast<size_t>(avatar.props[0].mesh)].primitives[0].indices.size(), 3u);
  ASSERT_EQ(avatar.tints.size(), 1u);
  EXPECT_EQ(avatar.tints[0].reach, 0.1f);
  EXPECT_NEAR(avatar.tints[0].color.z, 0.6f, 1e-6f);
  ASSERT_EQ(avatar.tints[0].colors.size(), 2u);
  EXPECT_TRUE(avatar.tints[0].materials.empty()) << "bound to nothing";
  EXPECT_EQ(avatar.height_spread, 0.05f);
  EXPECT_EQ(avatar.breadth_spread, 0.03f);
  EXPECT_NEAR(avatar.tints[0].colors[1].y, 0.6f, 1e-6f);
  ASSERT_EQ(avatar.levels.size(), 2u);
  EXPECT_EQ(avatar.levels[0].switch_px, 90);
  EXPECT_EQ(avatar.levels[1].posed_error_mm, 12.5f);
  for (const PackLevel& level : avatar.levels) {
    size_t triangles = 0;
    for (const PackPrimitive& p : pack.meshes[static_cast<size_t>(level.mesh)].primitives) {
      triangles += p.indices.size() / 3;
      EXPECT_EQ(p.joints.size(), p.positions.size());
      for (const auto& w : p.weights) EXPECT_EQ(w[0] + w[1] + w[2] + w[3], 255);
    }
    EXPECT_EQ(triangles, static_cast<size_t>(level.triangles));
  }
  const PackImpostor& impostor = avatar.impostor;
  EXPECT_EQ(impostor.albedo.format, TextureFormat::kBc7Srgb);
  EXPECT_EQ(impostor.albedo.width_px, 32);
  ASSERT_EQ(impostor.albedo.levels.size(), 2u);
  EXPECT_EQ(impostor.albedo.levels[1].size(), LevelBytes(TextureFormat::kBc7Srgb, 16, 32));
  EXPECT_EQ(impostor.albedo.levels[1][5], 6);
  EXPECT_EQ(impostor.motion.height_px, 32);
  ASSERT_EQ(impostor.cells.size(), 24u);
  EXPECT_EQ(impostor.cells[9].x, 4);
  EXPECT_EQ(impostor.cells[9].origin_y, 15);
  ASSERT_EQ(avatar.impostor.clips.size(), 2u);
  EXPECT_EQ(avatar.impostor.clips[1].first_frame, 2);
}

TEST(TourPack, ItsPersonMovesAsTheEditableOneDid) {
  const TourParts parts = SmallTour();
  const Avatar& source = parts.avatars[0].levels.avatar;
  const PackAvatar avatar = Read(Written(parts)).avatars.at(0);
  EXPECT_EQ(avatar.walk.frames, 30);
  EXPECT_FLOAT_EQ(avatar.walk.duration_s, 1);
  EXPECT_EQ(avatar.idle.frames, 1);  // has none: stands
  const size_t joints = static_cast<size_t>(avatar.joints);
  ASSERT_EQ(avatar.walk.matrices.size(), 30 * joints);
  for (int frame = 0; frame < 30; ++frame) {
    const std::vector<Mat4> wanted = SkinningMatrices(source, source.clips[0], static_cast<float>(frame) / 30);
    for (size_t j = 0; j < joints; ++j) {
      const Vec3 foot{0.1f, 0, 0.1f};
      const Vec3 a = TransformPoint(wanted[j], foot);
      const Vec3 b = TransformPoint(avatar.walk.matrices[static_cast<size_t>(frame) * joints + j], foot);
      EXPECT_LT(Length(a - b), 0.002f) << frame << ' ' << j;
    }
  }
}

TEST(TourPack, WithoutGeometryTheCrowdHasAllItNeeds) {
  const TourPack pack = Read(Written(SmallTour()), LoadOptions{false});
  for (const PackImage& image : pack.images) EXPECT_TRUE(image.rgba.empty());
  EXPECT_EQ(pack.obstacles.circles.size(), 1u);
  EXPECT_EQ(pack.obstacles.polygons.size(), 1u);
  EXPECT_EQ(pack.ground->height_m.size(), 12u);
  EXPECT_EQ(pack.avatars.at(0).levels.size(), 2u);
}

bool Refused(std::vector<uint8_t> bytes) {
  TourPack pack;
  pack.name = "untouched";
  const Error error = ParseTourPack(std::move(bytes), "small.glb", LoadOptions{}, &pack);
  if (error) {
    EXPECT_EQ(error.message.rfind("small.glb: ", 0), 0u) << error.message;
    EXPECT_EQ(error.message.find('\n'), std::string::npos);
    EXPECT_EQ(pack.name, "untouched");
  }
  return static_cast<bool>(error);
}

// Without the care that WriteFile takes, thousands of times.
void Put(const std::filesystem::path& path, const std::vector<uint8_t>& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

TEST(TourPack, TheTitlePageIsReadBeforeAllElse) {
  const std::vector<uint8_t> whole = Written(SmallTour());
  TemporaryFolder folder;
  ASSERT_FALSE(folder.Create("flaneur_test_"));
  const auto path = folder.path() / "small.glb";
  const auto read = [&](const std::vector<uint8_t>& bytes, PackTitle* title) {
    Put(path, bytes);
    *title = {};
    return ReadPackTitle(path, "en", title);
  };
  PackTitle title;
  ASSERT_TRUE(read(whole, &title));
  EXPECT_EQ(title.title, "Little market");
  EXPECT_EQ(title.page.picture, SmallTour().title_page.picture);
  EXPECT_EQ(title.page.logo, SmallTour().title_page.logo);
  EXPECT_EQ(title.page.background.z, 1);
  const size_t read_first = 20 + GetWord(whole, 12) + 8 + 16;
  ASSERT_TRUE(read({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(read_first)}, &title));
  EXPECT_EQ(title.page.logo, SmallTour().title_page.logo) << "the rest need not be there yet";
  for (size_t size = 0; size < read_first; size += 19) {  // of what is cut nothing wrong comes out
    read({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}, &title);
    ASSERT_TRUE(title.page.logo.empty() || title.page.logo == SmallTour().title_page.logo) << size;
  }
}

TEST(TourPack, ADamagedTitlePageNeverCrashesItsReader) {
  const std::vector<uint8_t> whole = Written(SmallTour());
  const size_t end = 20 + GetWord(whole, 12);
  TemporaryFolder folder;
  ASSERT_FALSE(folder.Create("flaneur_test_"));
  std::mt19937 random(3);
  for (size_t i = 0; i < end; i += 1 + random() % 60) {
    std::vector<uint8_t> bytes = whole;
    if (bytes[i] >= '0' && bytes[i] <= '9') bytes[i] = static_cast<uint8_t>("0123456789-e"[random() % 12]);
    else bytes[i] ^= static_cast<uint8_t>(1u << (random() % 8));
    Put(folder.path() / "small.glb", bytes);
    PackTitle title;
    ReadPackTitle(folder.path() / "small.glb", "de", &title);
    ASSERT_LE(title.page.picture.size(), whole.size());
  }
}

TEST(TourPack, EveryPrefixIsRefused) {
  const std::vector<uint8_t> whole = Written(SmallTour());
  for (size_t size = 0; size < whole.size(); ++size) {
    ASSERT_TRUE(Refused({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)})) << size;
  }
}

// The container's own lengths agree with the shorter file, so that the cut is met further in.
TEST(TourPack, EveryPrefixWithFittingLengthsIsRefused) {
  const std::vector<uint8_t> whole = Written(SmallTour());
  const size_t binary = 20 + GetWord(whole, 12);
  for (size_t size = binary; size < whole.size(); size += 37) {
    std::vector<uint8_t> cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    PutWord(&cut, 8, size);
    if (size >= binary + 8) PutWord(&cut, binary, size - binary - 8);
    ASSERT_TRUE(Refused(std::move(cut))) << size;
  }
}

TEST(TourPack, RandomDamageNeverCrashesTheReader) {
  const std::vector<uint8_t> whole = Written(SmallTour());
  std::mt19937 random(1);
  int refused = 0;
  for (int round = 0; round < 3000; ++round) {
    std::vector<uint8_t> bytes = whole;
    for (int flips = 1 + static_cast<int>(random() % 4); flips > 0; --flips) {
      bytes[random() % bytes.size()] ^= static_cast<uint8_t>(1u << (random() % 8));
    }
    refused += Refused(std::move(bytes)) ? 1 : 0;
  }
  EXPECT_GT(refused, 1000);
}

// Digits of the JSON are the counts, offsets and indices: the damage that hurts most.
TEST(TourPack, WrongNumbersNeverCrashTheReader) {
  const std::vector<uint8_t> whole = Written(SmallTour());
  const size_t end = 20 + GetWord(whole, 12);
  std::mt19937 random(2);
  for (size_t i = 20; i < end; ++i) {
    if (whole[i] < '0' || whole[i] > '9') continue;
    std::vector<uint8_t> bytes = whole;
    bytes[i] = static_cast<uint8_t>("0123456789-e"[random() % 12]);
    Refused(std::move(bytes));
  }
}

// Pointers to all that stands under `at`, itself included.
void Places(const Json& json, const Json::json_pointer& at, std::vector<Json::json_pointer>* places) {
  places->push_back(at);
  if (!json.is_structured()) return;
  for (const auto& [key, value] : json.items()) {
    Places(value, json.is_array() ? at / static_cast<size_t>(std::stoul(key)) : at / key, places);
  }
}

// How messages call it: FLANEUR_tour.places[0].kind.
std::string Called(const Json& json, const Json::json_pointer& at) {
  if (at.to_string() == "/extensions/FLANEUR_tour") return "FLANEUR_tour";
  const std::string parent = Called(json, at.parent_pointer());
  return json.at(at.parent_pointer()).is_array() ? parent + "[" + at.back() + "]" : parent + "." + at.back();
}

TEST(TourPack, AMemberOfAnotherTypeIsRefusedByItsPlace) {
  const std::vector<uint8_t> whole = Written(SmallTour());
  const Json json = JsonOf(whole);
  const Json::json_pointer root("/extensions/FLANEUR_tour");
  std::vector<Json::json_pointer> places;
  Places(json.at(root), root, &places);
  ASSERT_GT(places.size(), 100u);
  for (const Json::json_pointer& at : places) {
    for (const Json& other : {Json(nullptr), Json(true), Json("x"), Json(0.5), Json::array({7}), Json{{"a", 1}}}) {
      if (other.type_name() == std::string(json.at(at).type_name()) && !json.at(at).is_number_integer()) continue;
      Json changed = json;
      changed[at] = other;
      TourPack pack;
      const std::string message = ParseTourPack(WithJson(whole, changed), "small.glb", LoadOptions{}, &pack).message;
      ASSERT_NE(message.find(Called(json, at)), std::string::npos)
          << at.to_string() << " = " << other << ": " << message;
    }
  }
}

TEST(TourPack, ATintKeepsToItsMaterialsOnEveryLevelAndTheImpostor) {
  TourParts parts = SmallTour();
  TourAvatar& avatar = parts.avatars[0];
  avatar.levels.avatar.materials.push_back(avatar.levels.avatar.materials[0]);
  avatar.levels.avatar.materials[0].tints = 0xFE;
  for (AvatarLevel& level : avatar.levels.levels) {
    Mesh other = level.meshes[0];
    other.material = 1;
    level.meshes.push_back(other);
    level.triangles += TriangleCount(other);
  }
  avatar.impostor.tint_regions = true;
  avatar.impostor.tints_ktx2 = Ktx2(TextureFormat::kBc7, 16, 32);
  const std::vector<uint8_t> whole = Written(parts);
  TourPack pack;
  ASSERT_EQ(ParseTourPack(whole, "small.glb", LoadOptions{}, &pack).message, "");
  for (const PackLevel& level : pack.avatars[0].levels) {
    for (const PackPrimitive& p : pack.meshes[static_cast<size_t>(level.mesh)].primitives) {
      const bool first = p.material == pack.avatars[0].tints[0].materials.at(0) - 1;
      EXPECT_EQ(pack.materials[static_cast<size_t>(p.material)].tints, first ? 0xFE : 0xFF);
    }
  }
  EXPECT_EQ(pack.avatars[0].impostor.tints.width_px, 16);
  Json json = JsonOf(whole);
  json[Json::json_pointer("/extensions/FLANEUR_tour/avatars/0/tints/0/materials/0")] = 1000;
  EXPECT_TRUE(Refused(WithJson(whole, json)));
}

TEST(TourPack, AMissingMemberIsRefusedUnlessADefaultStandsForIt) {
  const std::vector<uint8_t> whole = Written(SmallTour());
  const Json json = JsonOf(whole);
  const std::set<std::string> optional{"painting",  "guide",         "titles",         "language",   "captions",
                                       "sounds",    "tints",         "props",          "title_page", "picture_view",
                                       "logo_view", "photo",         "hotspots",       "streets",    "texts",
                                       "reach_m",   "height_spread", "breadth_spread", "thanks",     "home_after_s",
                                       "flocks",    "play",          "smokes",         "wind",       "yaw_rad"};
  for (const char* object :
       {"", "/avatars/0", "/avatars/0/levels/1", "/avatars/0/tints/0", "/avatars/0/props/0", "/avatars/0/impostor",
        "/avatars/0/impostor/clips/0", "/obstacles/1", "/ground", "/title_page", "/places/0", "/painting", "/path/0",
        "/hotspots/0", "/sounds/1", "/flocks/0", "/play/0", "/smokes/0"}) {
    const Json::json_pointer at(std::string("/extensions/FLANEUR_tour") + object);
    for (const auto& [key, unused] : json.at(at).items()) {
      Json changed = json;
      changed.at(at).erase(key);
      if (optional.contains(key)) continue;
      EXPECT_TRUE(Refused(WithJson(whole, changed))) << object << "/" << key;
    }
  }
}

// Packs of before have no reach_m: it is measured, from the outlines of the impostor and from the props' meshes.
TEST(TourPack, HowFarPeopleReachIsKnownWhereThePackDoesNotSayIt) {
  const std::vector<uint8_t> whole = Written(SmallTour());
  TourPack pack, older;
  ASSERT_FALSE(ParseTourPack(whole, "small.glb", LoadOptions{}, &pack));
  Json json = JsonOf(whole);
  for (Json& avatar : json["extensions"]["FLANEUR_tour"]["avatars"]) avatar.erase("reach_m");
  ASSERT_FALSE(ParseTourPack(WithJson(whole, json), "small.glb", LoadOptions{}, &older));
  ASSERT_EQ(pack.avatars.size(), older.avatars.size());
  for (size_t k = 0; k < pack.avatars.size(); ++k) {
    for (const PackProp& prop : pack.avatars[k].props) {
      for (const PackPrimitive& p : pack.meshes[static_cast<size_t>(prop.mesh)].primitives) {
        for (const Vec3 v : p.positions) EXPECT_GE(older.avatars[k].reach_m, std::hypot(v.x, v.z) - 0.05f);
      }
    }
    EXPECT_GE(pack.avatars[k].reach_m, pack.avatars[k].radius_m);
    EXPECT_GE(older.avatars[k].reach_m, older.avatars[k].radius_m);
    EXPECT_LT(older.avatars[k].reach_m, 20.001f);
  }
  json = JsonOf(whole);
  json["extensions"]["FLANEUR_tour"]["avatars"][0]["reach_m"] = -1;
  EXPECT_TRUE(Refused(WithJson(whole, json)));
}

TEST(TourPack, UnknownKindsAreRefusedWithTheKnownOnes) {
  const std::vector<uint8_t> whole = Written(SmallTour());
  for (const char* member : {"/places/0/kind", "/obstacles/0/kind", "/control/method", "/sounds/0/kind",
                             "/avatars/0/impostor/clips/0/name"}) {
    Json json = JsonOf(whole);
    json[Json::json_pointer(std::string("/extensions/FLANEUR_tour") + member)] = "portal";
    TourPack pack;
    const std::string message = ParseTourPack(WithJson(whole, json), "small.glb", LoadOptions{}, &pack).message;
    EXPECT_NE(message.find("'portal', it must be one of: "), std::string::npos) << message;
  }
}

TEST(TourPack, TheGltfPartOfAnotherTypeIsRefusedInPlainWords) {
  const std::vector<uint8_t> whole = Written(SmallTour());
  const Json json = JsonOf(whole);
  std::vector<Json::json_pointer> places;
  for (const char* part :
       {"/nodes", "/meshes", "/accessors", "/skins", "/animations", "/materials", "/textures", "/images"}) {
    const Json::json_pointer at(part);
    Places(json.at(at), at, &places);
  }
  const std::vector<Json> others{nullptr, "x", -7, Json::array({7}), {{"a", 1}}};
  for (size_t i = 0; i < places.size(); ++i) {  // one after the other, to be done in a second
    Json changed = json;
    changed[places[i]] = others[i % others.size()];
    TourPack pack;
    const std::string message = ParseTourPack(WithJson(whole, changed), "small.glb", LoadOptions{}, &pack).message;
    EXPECT_EQ(message.find("json.exception"), std::string::npos) << message;
  }
}

TEST(TourPack, OtherVersionsAreRefusedByNumber) {
  std::vector<uint8_t> bytes = Written(SmallTour());
  const std::string member = "\"version\":" + std::to_string(kTourPackVersion);
  const auto at = std::search(bytes.begin(), bytes.end(), member.begin(), member.end());
  ASSERT_NE(at, bytes.end());
  at[static_cast<std::ptrdiff_t>(member.size()) - 1] = '9';
  TourPack pack;
  const std::string message = ParseTourPack(bytes, "small.glb", LoadOptions{}, &pack).message;
  EXPECT_NE(message.find("version 9"), std::string::npos) << message;
}

TEST(TourPack, TheVersionBeforeIsReadAsWell) {
  std::vector<uint8_t> bytes = Written(SmallTour());
  const std::string member = "\"version\":" + std::to_string(kTourPackVersion);
  const auto at = std::search(bytes.begin(), bytes.end(), member.begin(), member.end());
  ASSERT_NE(at, bytes.end());
  at[static_cast<std::ptrdiff_t>(member.size()) - 1] = static_cast<uint8_t>('0' + kOldestTourPackVersion);
  TourPack pack;
  EXPECT_EQ(ParseTourPack(bytes, "small.glb", LoadOptions{}, &pack).message, "");
}

TEST(TourPack, AGlbWithoutATourIsNamedSo) {
  TourPack pack;
  const std::vector<uint8_t> whole = Written(SmallTour());
  Json json = JsonOf(whole);
  json.erase("extensions");
  const std::string message = ParseTourPack(WithJson(whole, json), "x.glb", LoadOptions{}, &pack).message;
  EXPECT_NE(message.find("FLANEUR_tour"), std::string::npos) << message;
  EXPECT_NE(message.find("flaneur bake"), std::string::npos) << message;
}

}  // namespace
}  // namespace flaneur
