#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "pipeline/io/scene_reader.h"
#include "runtime/base/array.h"
#include "runtime/base/png.h"
#include "runtime/base/srgb.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;

class ScanFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string ReadThere(const fs::path& path, UpAxis up = UpAxis::kJudged) {
    scene_ = {};
    warnings_.clear();
    return ReadScene(path, &scene_, &warnings_, {"", up}).message;
  }
  std::string Read(const std::string& name, const std::string& bytes, UpAxis up = UpAxis::kJudged) {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return ReadThere(folder_ / name, up);
  }
  static fs::path Shipped(const std::string& name) { return fs::path(FLANEUR_SOURCE_DIR) / "tests/data/towns" / name; }

  // Of all vertices, z up.
  Vec3 Low() const { return Extent(-1) * -1; }
  Vec3 High() const { return Extent(1); }

  fs::path folder_;
  Scene scene_;
  std::vector<std::string> warnings_;

 private:
  Vec3 Extent(float sign) const {
    Vec3 most{-1e9f, -1e9f, -1e9f};
    for (const SceneNode& node : scene_.nodes) {
      for (const int mesh : node.meshes) {
        for (const Vec3 position : At(scene_.meshes, mesh).positions) {
          const Vec3 p = GroundFromGltf(TransformPoint(node.world, position)) * sign;
          most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
        }
      }
    }
    return most;
  }
};

std::string Ply(const std::string& faces, const std::string& comment = "") {
  return "ply\r\nformat ascii 1.0\r\n" + comment +
         "element vertex 4\r\nproperty float x\r\nproperty float y\r\nproperty double z\r\nproperty uchar red\r\n"
         "property uchar green\r\nproperty uchar blue\r\nproperty float s\r\nproperty float t\r\n"
         "element face 1\r\nproperty list uchar int vertex_indices\r\nend_header\r\n"
         "0 0 0 255 0 0 0 0\r\n40 0 0 0 255 0 1 0\r\n40 0 9 0 0 255 1 1\r\n0 40 9 9 9 9 0 1\r\n" +
         faces;
}

TEST_F(ScanFile, APlyOfAnyEncodingAndAnStlAreTheSameTown) {
  for (const char* name : {"houses.ply", "houses_big_endian.ply", "houses.stl"}) {
    SCOPED_TRACE(name);
    ASSERT_EQ(ReadThere(Shipped(name)), "");
    EXPECT_LT(Length(Low() - Vec3{-20, -20, -0.3f}), 1e-5f);
    EXPECT_LT(Length(High() - Vec3{20, 20, 6}), 1e-5f);
    size_t corners = 0;
    for (const Mesh& mesh : scene_.meshes) corners += mesh.indices.size();
    EXPECT_EQ(corners, 3u * 22);
  }
}

TEST_F(ScanFile, APlyHasItsColours) {
  ASSERT_EQ(Read("scan.ply", Ply("3 0 1 2\r\n")), "");
  const Mesh& mesh = scene_.meshes.at(0);
  ASSERT_EQ(mesh.colors.size(), 3u);
  EXPECT_EQ(mesh.colors[0].x, 1);
  EXPECT_EQ(mesh.colors[1].x, 0);
  EXPECT_EQ(mesh.colors[1].y, 1);
  EXPECT_EQ(At(scene_.materials, mesh.material).base_color.y, 1) << "on white";
}

TEST_F(ScanFile, APlyHasItsPictureAndNotItsColoursOverIt) {
  const std::vector<uint8_t> png = EncodePng(1, 1, 3, {10, 20, 30});
  std::ofstream(folder_ / "the scan.png", std::ios::binary)
      .write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
  ASSERT_EQ(Read("scan.ply", Ply("3 0 1 2\r\n", "comment TextureFile C:\\scans\\the scan.png\r\n")), "");
  ASSERT_EQ(scene_.images.size(), 1u);
  const Mesh& mesh = scene_.meshes.at(0);
  EXPECT_EQ(At(scene_.materials, mesh.material).base_color_image, 0);
  EXPECT_TRUE(mesh.colors.empty());
  ASSERT_EQ(mesh.uvs.size(), 3u);
  EXPECT_EQ(mesh.uvs[0].y, 1) << "glTF counts from the upper edge";
  EXPECT_EQ(mesh.uvs[2].y, 0);
  fs::remove(folder_ / "the scan.png");
  ASSERT_EQ(ReadThere(folder_ / "scan.ply"), "");
  ASSERT_EQ(warnings_.size(), 2u) << "which way is up, and";
  EXPECT_NE((warnings_[0] + warnings_[1]).find("the scan.png' is not beside it"), std::string::npos);
}

TEST_F(ScanFile, BadScansAreOneLine) {
  const auto says = [&](const std::string& text, const char* what) {
    const std::string error = Read("scan.ply", text);
    EXPECT_NE(error.find("scan.ply"), std::string::npos) << error;
    EXPECT_NE(error.find(what), std::string::npos) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  };
  says(Ply("3 0 1 4\r\n"), "face 0 names vertex 4 of 4");
  says(Ply("3 0 1 -1\r\n"), "names vertex -1");
  says(Ply("3 0 1"), "face 0 of 1");
  says(Ply("3 0 1 house\r\n"), "no number");
  says(Ply("2 0 1\r\n"), "4 points and no face");
  says("ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nend_header\n1\n2\n", "vertex 0 has no x, y and z");
  says("ply\nformat ascii 1.0\nelement vertex 1\nproperty quad x\nend_header\n", "line 4: 'quad' is no type");
  says("ply\nformat middle_endian 1.0\n", "line 2");
  says("ply\nformat ascii 1.0\nelement vertex 1\n", "has no end");
  says("plain text", "first line is not 'ply'");
  // A list of four thousand million.
  says(
      "ply\nformat binary_little_endian 1.0\nelement face 1\n"
      "property list uint uint vertex_indices\nend_header\n\xff\xff\xff\xff",
      "face 0 of 1");
  EXPECT_NE(Read("scan.stl", "solid house\nfacet\n").find("not an STL file, or cut off"), std::string::npos);
  EXPECT_NE(Read("scan.stl", "").find("not an STL"), std::string::npos);
  EXPECT_NE(Read("scan.e57", "ASTM-E57").find("no town that is known"), std::string::npos);
}

// What lies the other way is turned, whatever the format, and never mirrored.
TEST_F(ScanFile, AnyAxisMayPointUp) {
  const struct {
    UpAxis up;
    const char* point;  // a point 9 m up and 2 m along what becomes x
  } kWays[] = {{UpAxis::kZ, "2 0 9"},       {UpAxis::kMinusZ, "2 0 -9"}, {UpAxis::kY, "2 9 0"},
               {UpAxis::kMinusY, "2 -9 0"}, {UpAxis::kX, "9 2 0"},       {UpAxis::kMinusX, "-9 2 0"}};
  for (const auto& way : kWays) {
    SCOPED_TRACE(way.point);
    ASSERT_EQ(Read("scan.ply",
                   "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                   "element face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0\n1 1 1\n" +
                       std::string(way.point) + "\n3 0 1 2\n",
                   way.up),
              "");
    EXPECT_TRUE(warnings_.empty()) << "it was said";
    EXPECT_FLOAT_EQ(High().z, 9);
    EXPECT_FLOAT_EQ(High().x, 2);
    const Vec3 x = WithZUp(Vec3{1, 0, 0}, way.up), y = WithZUp(Vec3{0, 1, 0}, way.up);
    EXPECT_LT(Length(Cross(x, y) - WithZUp(Vec3{0, 0, 1}, way.up)), 1e-6f) << "mirrored";
  }
}

// A tool wrote a glTF with z up, which the format forbids.
TEST_F(ScanFile, AGltfThatLiesOnItsSideIsSaidAndTurned) {
  Scene town;
  UpAxis thin = UpAxis::kJudged;
  town.meshes.resize(1);
  for (const float x : {0.0f, 200.0f})
    for (const float y : {0.0f, 180.0f})
      for (const float z : {0.0f, 20.0f}) town.meshes[0].positions.push_back({x, y, z});
  town.nodes.resize(1);
  town.nodes[0].meshes = {0};
  EXPECT_TRUE(LiesOnItsSide(town, &thin));
  EXPECT_EQ(thin, UpAxis::kZ);
  StandUp(UpAxis::kZ, &town);
  EXPECT_FALSE(LiesOnItsSide(town, &thin));
  EXPECT_LT(Length(TransformPoint(town.nodes[0].world, {0, 180, 20}) - Vec3{0, 20, -180}), 1e-4f);
  // Neither a wall of a kit nor a tower nor a row of houses does.
  town.nodes[0].world = FromTranslationRotationScale({}, {}, {0.02f, 0.02f, 0.02f});
  EXPECT_FALSE(LiesOnItsSide(town, &thin));
  town.nodes[0].world = FromTranslationRotationScale({}, {}, {0.05f, 0.3f, 0.5f});
  EXPECT_FALSE(LiesOnItsSide(town, &thin));
  town.nodes[0].world = FromTranslationRotationScale({}, {}, {1, 0.08f, 0.5f});
  EXPECT_FALSE(LiesOnItsSide(town, &thin));
}

TEST_F(ScanFile, ACityModelIsNotTurned) {
  EXPECT_NE(Read("town.json", R"({"type":"CityJSON","version":"2.0","CityObjects":{},"vertices":[]})", UpAxis::kY)
                .find("a city model's up is known"),
            std::string::npos);
}

}  // namespace
}  // namespace flaneur
