#include <gtest/gtest.h>
#include <meshoptimizer.h>
#include <unistd.h>

#include <algorithm>
#include <limits>

#include "pipeline/io/encode_avatar.h"
#include "pipeline/io/gltf.h"
#include "runtime/base/file.h"
#include "runtime/base/pixels.h"
#include "tests/unit/pipeline/test_person.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;

class SceneFile : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        fs::temp_directory_path() / (std::string("flaneur_scene_file_") + info->name() + std::to_string(::getpid()));
    fs::create_directories(folder_);
    Mesh quad;
    quad.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    quad.normals.assign(4, {0, 0, 1});
    quad.indices = {0, 1, 2, 0, 2, 3};
    quad_ = quad;
  }
  void TearDown() override { fs::remove_all(folder_); }

  int AddQuad(const std::string& name) {
    DracoOptions plain;
    plain.compress = false;
    int mesh = -1;
    EncodedMesh encoded;
    EXPECT_EQ(EncodeMesh({&quad_, 1}, plain, &encoded).message, "");
    EXPECT_EQ(builder_.AddMesh(name, encoded, {}, &mesh).message, "");
    return mesh;
  }

  fs::path Finish(std::vector<int> roots) {
    builder_.AddScene("town", roots);
    std::vector<uint8_t> glb;
    EXPECT_EQ(builder_.Finish(&glb).message, "");
    EXPECT_EQ(WriteFile(folder_ / "town.glb", glb).message, "");
    return folder_ / "town.glb";
  }

  fs::path folder_;
  GltfBuilder builder_;
  Mesh quad_;
  Scene scene_;
};

GltfNode NodeWith(const std::string& name, int parent, int mesh, const std::string& extras) {
  GltfNode node;
  node.name = name;
  node.parent = parent;
  node.mesh = mesh;
  node.extras = extras;
  return node;
}

TEST_F(SceneFile, TagsGoDownToChildrenUnlessTheyHaveTheirOwn) {
  const int mesh = AddQuad("quad");
  const int town = builder_.AddNode(NodeWith("house", -1, -1, R"({"flaneur_kind": "building"})"));
  builder_.AddNode(NodeWith("wall", town, mesh, ""));
  builder_.AddNode(NodeWith("door", town, -1, R"({"flaneur_kind": "door", "flaneur_width_m": 1.2})"));
  const int ground =
      builder_.AddNode(NodeWith("street", -1, mesh, R"({"flaneur_kind": "ground", "flaneur_ground": "carriageway"})"));
  builder_.AddNode(NodeWith("kerb", ground, mesh, ""));
  ASSERT_EQ(ReadScene(Finish({town, ground}), &scene_).message, "");
  ASSERT_EQ(scene_.nodes.size(), 5u);
  EXPECT_EQ(scene_.nodes[1].kind, NodeKind::kBuilding);
  EXPECT_EQ(scene_.nodes[2].kind, NodeKind::kDoor);
  EXPECT_NEAR(scene_.nodes[2].width_m, 1.2f, 1e-6f);
  EXPECT_EQ(scene_.nodes[4].ground, GroundKind::kCarriageway);
  EXPECT_EQ(scene_.meshes.size(), 1u) << "shared";
}

TEST_F(SceneFile, APlaceOfWorkSaysWhatIsDoneThereAndByWhom) {
  const int work = builder_.AddNode(NodeWith("bench", -1, -1, R"({"flaneur_kind": "work", "flaneur_clip": "sit",
      "flaneur_avatars": " maid, old man,,farmer ", "flaneur_seat_m": 0.45, "flaneur_stay_s": 60})"));
  const int house = builder_.AddNode(NodeWith("house", -1, AddQuad("quad"), R"({"flaneur_kind": "building"})"));
  ASSERT_EQ(ReadScene(Finish({work, house}), &scene_).message, "");
  const SceneNode& read = scene_.nodes[0];
  EXPECT_EQ(read.kind, NodeKind::kWork);
  EXPECT_EQ(read.clip, "sit");
  EXPECT_EQ(read.avatars, (std::vector<std::string>{"maid", "old man", "farmer"}));
  EXPECT_NEAR(read.seat_m, 0.45f, 1e-6f);
  EXPECT_EQ(read.stay_s, 60);
}

TEST_F(SceneFile, WhatTurnsSaysByWhatAndItsChildrenStandStill) {
  const int vane = builder_.AddNode(NodeWith("vane", -1, AddQuad("quad"), R"({"flaneur_turns": "wind"})"));
  builder_.AddNode(NodeWith("nail", vane, AddQuad("nail"), ""));
  ASSERT_EQ(ReadScene(Finish({vane}), &scene_).message, "");
  EXPECT_EQ(scene_.nodes[0].turns, TurnsBy::kWind);
  EXPECT_EQ(scene_.nodes[1].turns, TurnsBy::kNothing);
}

TEST_F(SceneFile, AnUnknownTagIsAnErrorWithAdvice) {
  const int node = builder_.AddNode(NodeWith("house 7", -1, AddQuad("quad"), R"({"flaneur_kind": "bulding"})"));
  const std::string message = ReadScene(Finish({node}), &scene_).message;
  EXPECT_NE(message.find("house 7"), std::string::npos) << message;
  EXPECT_NE(message.find("did you mean 'building'"), std::string::npos) << message;
}

TEST_F(SceneFile, MirroredNodesKeepTheirOutside) {
  GltfNode node = NodeWith("mirrored", -1, AddQuad("quad"), "");
  node.transform.scale = {-1, 1, 1};
  ASSERT_EQ(ReadScene(Finish({builder_.AddNode(node)}), &scene_).message, "");
  const SceneNode& read = scene_.nodes[0];
  const Mesh& mesh = scene_.meshes[static_cast<size_t>(read.meshes[0])];
  const auto at = [&](size_t i) { return TransformPoint(read.world, mesh.positions[mesh.indices[i]]); };
  EXPECT_GT(Cross(at(1) - at(0), at(2) - at(0)).z, 0);
}

TEST_F(SceneFile, MissingNormalsAreThoseOfTheFaces) {
  quad_.normals.clear();
  ASSERT_EQ(ReadScene(Finish({builder_.AddNode(NodeWith("a", -1, AddQuad("quad"), ""))}), &scene_).message, "");
  for (const Vec3 n : scene_.meshes[0].normals) EXPECT_NEAR(n.z, 1, 1e-6f);
  EXPECT_EQ(scene_.meshes[0].normals.size(), scene_.meshes[0].positions.size());
}

TEST_F(SceneFile, WithoutTrianglesIsAnError) {
  const std::string message = ReadScene(Finish({builder_.AddNode(NodeWith("empty", -1, -1, ""))}), &scene_).message;
  EXPECT_NE(message.find("no triangle"), std::string::npos) << message;
}

TEST_F(SceneFile, ANonFiniteVertexNamesNodeAndMesh) {
  quad_.positions[2].y = std::numeric_limits<float>::infinity();
  const std::string message =
      ReadScene(Finish({builder_.AddNode(NodeWith("house_17", -1, AddQuad("gable"), ""))}), &scene_).message;
  EXPECT_NE(message.find("house_17"), std::string::npos) << message;
  EXPECT_NE(message.find("gable"), std::string::npos) << message;
}

// Text files with strips, fans, no indices, and quantised positions.
TEST_F(SceneFile, ReadsStripsFansAndQuantisedText) {
  // Four 16-bit corners of a quad as a strip: (0,0) (1,0) (0,1) (1,1), z = 0.
  const char* text = R"({"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_mesh_quantization"],
    "extensionsRequired": ["KHR_mesh_quantization"], "scene": 0,
    "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "scale": [2, 2, 2]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 5},
                               {"attributes": {"POSITION": 0}, "mode": 6},
                               {"attributes": {"POSITION": 0}, "mode": 1}]}],
    "accessors": [{"bufferView": 0, "componentType": 5122, "count": 4, "type": "VEC3",
                   "min": [0, 0, 0], "max": [1, 1, 0]}],
    "bufferViews": [{"buffer": 0, "byteLength": 32, "byteStride": 8}],
    "buffers": [{"byteLength": 32, "uri": "corners of it.bin"}]})";
  const int16_t corners[16] = {0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0};
  const auto* bytes = reinterpret_cast<const uint8_t*>(corners);
  ASSERT_EQ(WriteFile(folder_ / "corners of it.bin", {bytes, sizeof corners}).message, "");
  ASSERT_EQ(WriteTextFile(folder_ / "town.gltf", text).message, "");
  ASSERT_EQ(ReadScene(folder_ / "town.gltf", &scene_).message, "");
  ASSERT_EQ(scene_.meshes.size(), 2u) << "lines are left out";
  for (const Mesh& mesh : scene_.meshes) EXPECT_EQ(TriangleCount(mesh), 2);
  for (const Vec3 n : scene_.meshes[0].normals) EXPECT_NEAR(n.z, 1, 1e-6f) << "strip";
  fs::remove(folder_ / "corners of it.bin");
  EXPECT_NE(ReadScene(folder_ / "town.gltf", &scene_).message.find("town.gltf"), std::string::npos);
}

// As `gltfpack -c` writes them: the buffer that the views name is not there.
TEST_F(SceneFile, ReadsWhatMeshoptimizerCompressed) {
  std::vector<uint8_t> bytes(1000), indices(1000);
  bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), quad_.positions.data(), 4, 12));
  indices.resize(meshopt_encodeIndexBuffer(indices.data(), indices.size(), quad_.indices.data(), 6));
  const size_t first = bytes.size(), second = indices.size();
  bytes.insert(bytes.end(), indices.begin(), indices.end());
  const auto view = [](size_t at, size_t length, const std::string& numbers) {
    return R"("extensions": {"EXT_meshopt_compression": {"buffer": 0, "byteOffset": )" + std::to_string(at) +
           ", \"byteLength\": " + std::to_string(length) + ", " + numbers + "}}}";
  };
  const std::string text =
      R"({"asset": {"version": "2.0"}, "extensionsUsed": ["EXT_meshopt_compression"],
    "extensionsRequired": ["EXT_meshopt_compression"], "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
                  {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
    "bufferViews": [{"buffer": 1, "byteLength": 48, "byteStride": 12, )" +
      view(0, first, R"("byteStride": 12, "count": 4, "mode": "ATTRIBUTES")") +
      R"(, {"buffer": 1, "byteOffset": 48, "byteLength": 12, )" +
      view(first, second, R"("byteStride": 2, "count": 6, "mode": "TRIANGLES")") + R"(], "buffers": [{"byteLength": )" +
      std::to_string(bytes.size()) +
      R"(, "uri": "quad.bin"}, {"byteLength": 60, "extensions": {"EXT_meshopt_compression": {"fallback": true}}}]})";
  ASSERT_EQ(WriteFile(folder_ / "quad.bin", bytes).message, "");
  ASSERT_EQ(WriteTextFile(folder_ / "town.gltf", text).message, "");
  ASSERT_EQ(ReadScene(folder_ / "town.gltf", &scene_).message, "");
  ASSERT_EQ(scene_.meshes.size(), 1u);
  EXPECT_EQ(TriangleCount(scene_.meshes[0]), 2);
  for (const Vec3 n : scene_.meshes[0].normals) EXPECT_NEAR(n.z, 1, 1e-6f);
  bytes[0] = 0;
  ASSERT_EQ(WriteFile(folder_ / "quad.bin", bytes).message, "");
  const std::string message = ReadScene(folder_ / "town.gltf", &scene_).message;
  EXPECT_NE(message.find("bufferView 0 holds broken compressed data"), std::string::npos) << message;
}

TEST_F(SceneFile, ReadsARealBuilding) {
  if (SharedData().empty()) GTEST_SKIP() << "the folder of real data is not there";
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(SharedData() / "towns/kaykit-medieval")) {
    if (entry.path().extension() != ".gltf") continue;
    ++files;
    ASSERT_EQ(ReadScene(entry.path(), &scene_).message, "");
    EXPECT_FALSE(scene_.meshes.empty());
    ASSERT_EQ(scene_.images.size(), 1u);
    EXPECT_EQ(scene_.images[0].mime_type, "image/png");
  }
  EXPECT_GT(files, 0);
}

// A tree in three places of one node, with a WebP picture, and a ground whose mesh hangs on a nameless node, as
// gltfpack writes it.
TEST(GltfScene, PlacesInstancesAndNamesWhatHangsBetween) {
  const fs::path file = fs::path(FLANEUR_SOURCE_DIR) / "tests/data/towns/instances.gltf";
  Scene scene;
  ASSERT_EQ(ReadGltfScene(file, &scene).message, "");
  std::vector<Vec3> trees;
  int grounds = 0;
  for (const SceneNode& node : scene.nodes) {
    if (node.meshes.empty()) continue;
    if (node.name == "Tree") trees.push_back(TransformPoint(node.world, {1, 3, 0}));
    grounds += node.name == "Ground";
  }
  ASSERT_EQ(trees.size(), 3u);
  EXPECT_LT(Length(trees[0] - Vec3{2, 3, 0}), 1e-3f);
  EXPECT_LT(Length(trees[1] - Vec3{5, 3, -5}), 1e-3f) << "turned half round";
  EXPECT_LT(Length(trees[2] - Vec3{-6, 6, 2}), 1e-3f) << "turned by a quarter, and twice as high";
  EXPECT_EQ(grounds, 1);
  ASSERT_EQ(scene.images.size(), 1u);
  EXPECT_EQ(scene.images[0].mime_type, "image/png");
  const auto pixels = Decoded(scene.images[0].bytes);
  ASSERT_TRUE(pixels && pixels->width == 4);
  EXPECT_EQ(pixels->rgba[3], 255);
  EXPECT_EQ(pixels->rgba[4 * 3 + 3], 0);
  EXPECT_EQ(pixels->rgba[1], 140);
}

TEST(GltfScene, InstancesMustAgree) {
  const fs::path file = fs::path(FLANEUR_SOURCE_DIR) / "tests/data/towns/instances.gltf";
  std::vector<uint8_t> bytes;
  ASSERT_EQ(ReadFile(file, &bytes).message, "");
  std::string text(bytes.begin(), bytes.end());
  const std::string scale = "\"SCALE\": ";
  text[text.find(scale) + scale.size()] = '0';  // that of the four corners
  const fs::path changed = fs::path(testing::TempDir()) / ("instances_" + std::to_string(::getpid()) + ".gltf");
  ASSERT_EQ(WriteFile(changed, std::vector<uint8_t>(text.begin(), text.end())).message, "");
  Scene scene;
  const std::string message = ReadGltfScene(changed, &scene).message;
  EXPECT_NE(message.find("node 'Tree': EXT_mesh_gpu_instancing: "), std::string::npos) << message;
  fs::remove(changed);
}

}  // namespace
}  // namespace flaneur
