#include "pipeline/core/fingerprint.h"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "pipeline/core/temporary_folder.h"
#include "runtime/base/file.h"

namespace flaneur {
namespace {

class FingerprintFiles : public testing::Test {
 protected:
  void SetUp() override { ASSERT_FALSE(folder_.Create("flaneur_test_")); }
  void Put(const std::string& name, const std::string& text) { ASSERT_FALSE(WriteTextFile(At(name), text)); }
  std::filesystem::path At(const std::string& name) const { return folder_.path() / name; }
  std::string Of(const std::string& name) const { return Fingerprint().AddFile(At(name)).Hex(); }
  TemporaryFolder folder_;
};

TEST(Fingerprint, KeepsPartsAndNumbersApart) {
  EXPECT_NE(Fingerprint().Add("ab").Add("c").Hex(), Fingerprint().Add("a").Add("bc").Hex());
  EXPECT_NE(Fingerprint().Add(0.1).Hex(), Fingerprint().Add(0.1 + 1e-16 * 2).Hex());
  EXPECT_EQ(Fingerprint().Add("x").Add(2).Hex(), Fingerprint().Add("x").Add(2.0).Hex());
}

TEST_F(FingerprintFiles, FollowTheContentNotTheName) {
  Put("a.glb", "one");
  Put("b.glb", "one");
  EXPECT_EQ(Of("a.glb"), Of("b.glb"));
  Put("b.glb", "two");
  EXPECT_NE(Of("a.glb"), Of("b.glb"));
}

TEST_F(FingerprintFiles, OfAGltfFollowTheFilesItNames) {
  Put("house.gltf", R"({"buffers": [{"uri" : "house.bin"}], "images": [{"uri":"data:image/png;base64,AAAA"}]})");
  Put("house.bin", "walls");
  const std::string before = Of("house.gltf");
  Put("house.bin", "other walls");
  EXPECT_NE(Of("house.gltf"), before);
}

TEST_F(FingerprintFiles, OfOtherModelsFollowTheirLooks) {
  Put("town.obj", "v 0 0 0\nmtllib the town.mtl\n");
  Put("town.gml", "<app:imageURI>wall.jpg</app:imageURI>");
  Put("scan.ply", "ply\nformat ascii 1.0\ncomment TextureFile wall.jpg\nend_header\n");
  Put("the town.mtl", "newmtl a\nmap_Kd -s 1 1 1 wall.jpg\n");
  const std::string obj = Of("town.obj"), gml = Of("town.gml"), ply = Of("scan.ply");
  Put("wall.jpg", "other");
  EXPECT_NE(Of("town.obj"), obj);
  EXPECT_NE(Of("town.gml"), gml);
  EXPECT_NE(Of("scan.ply"), ply);
  const std::string now = Of("town.obj");
  Put("the town.mtl", "newmtl b\nmap_Kd -s 1 1 1 wall.jpg\n");
  EXPECT_NE(Of("town.obj"), now);
}

TEST_F(FingerprintFiles, OfModelsThatNameThemselvesAndEachOtherComeToAnEnd) {
  Put("self.gltf", R"({"buffers": [{"uri": "self.gltf"}]})");
  Put("a.gltf", R"({"buffers": [{"uri": "b.gltf"}]})");
  Put("b.gltf", R"({"images": [{"uri": "a.gltf"}]})");
  EXPECT_FALSE(Of("self.gltf").empty());
  const std::string before = Of("a.gltf");
  Put("b.gltf", R"({"images": [{"uri": "./a.gltf"}]})");
  EXPECT_NE(Of("a.gltf"), before);
}

// Contents are kept by what the file system says of a file.
TEST_F(FingerprintFiles, NoticeEveryChangeOfAFileThatWasReadBefore) {
  const auto write_in_place = [&](const std::string& text) { std::ofstream(At("a.py")) << text; };
  write_in_place("one");
  const std::string one = Of("a.py");
  const auto age = std::filesystem::last_write_time(At("a.py"));
  write_in_place("two");
  std::filesystem::last_write_time(At("a.py"), age);
  const std::string two = Of("a.py");
  EXPECT_NE(two, one) << "as large and as old, a moment later";
  std::this_thread::sleep_for(std::chrono::milliseconds(3200));
  EXPECT_EQ(Of("a.py"), two);
  write_in_place("one");
  std::filesystem::last_write_time(At("a.py"), age);
  EXPECT_EQ(Of("a.py"), one) << "long after it was read";
}

TEST_F(FingerprintFiles, OfAFolderFollowItsScripts) {
  Put("scripts/build.py", "a");
  Put("scripts/notes.txt", "b");
  const std::string before = Of("scripts");
  Put("scripts/notes.txt", "c");
  EXPECT_EQ(Of("scripts"), before);
  Put("scripts/parts/house.py", "d");
  EXPECT_NE(Of("scripts"), before);
}

}  // namespace
}  // namespace flaneur
