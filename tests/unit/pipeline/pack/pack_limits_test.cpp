// Small packs that ask for much: each is refused in one line before anything is allocated or done for it.
#include <gtest/gtest.h>

#include <algorithm>

#include "pipeline/io/meshopt_codec.h"
#include "runtime/pack/tour_pack.h"
#include "tests/unit/pipeline/pack/small_tour.h"

namespace flaneur {
namespace {

const std::string kTour = "/extensions/FLANEUR_tour";

struct Asking {
  std::vector<uint8_t> whole = Written(SmallTour());
  Json json = JsonOf(whole);

  Json& At(const std::string& place) { return json[Json::json_pointer(place)]; }
  std::string Message(const PackLimits& limits = {}) const {
    PackFile file;
    TourPack pack;
    return file.Open(WithJson(whole, json), "small.glb", &pack, limits).message;
  }
  // Behind the binary data. The number of its buffer view.
  size_t Append(const void* data, size_t size) {
    const size_t binary = 20 + GetWord(whole, 12) + 8, offset = whole.size() - binary;
    const auto* first = static_cast<const uint8_t*>(data);
    whole.insert(whole.end(), first, first + size);
    whole.resize((whole.size() + 3) / 4 * 4, 0);
    PutWord(&whole, 8, whole.size());
    PutWord(&whole, binary - 8, whole.size() - binary);
    At("/buffers/0/byteLength") = whole.size() - binary;
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}});
    return json["bufferViews"].size() - 1;
  }
  void IsRefused(const std::string& why, const PackLimits& limits = {}) const {
    const std::string message = Message(limits);
    EXPECT_NE(message.find(why), std::string::npos) << message.substr(0, 500);
    EXPECT_EQ(message.find('\n'), std::string::npos);
    EXPECT_LT(message.size(), 2000u);
  }
};

TEST(PackLimits, AreFarFromASmallTour) { EXPECT_EQ(Asking().Message(), ""); }

TEST(PackLimits, LettersOfAllKindsMayBeLongButNotEndless) {
  Asking pack;
  pack.At(kTour + "/path/0/caption") = std::string(20000, 'a');
  EXPECT_EQ(pack.Message(), "");
  pack.At(kTour + "/path/0/caption") = std::string(2000000, 'a');
  pack.IsRefused("caption is text of more than 20000 bytes");
}

TEST(PackLimits, NumbersWithoutSenseAreRefused) {
  const struct {
    const char* place;
    double number;
    const char* why;
  } cases[] = {{"/ground/cell_m", 2000, "cell_m is 2000"},
               {"/ground/cell_m", 1e9, "cell_m"},
               {"/ground/min_m/0", 1e8, "min_m"},
               {"/avatars/0/height_m", 1e38, "height_m"},
               {"/avatars/0/share", 0, "share"},
               {"/avatars/0/radius_m", 1e6, "radius_m"},
               {"/path/0/yaw_rad", 1e9, "yaw_rad"},
               {"/places/1/yaw_rad", -1e9, "yaw_rad"},
               {"/path/0/position_m/1", -1e300, "position_m"},
               {"/control/budget_triangles", 0, "budget_triangles"}};
  for (const auto& c : cases) {
    Asking pack;
    pack.At(kTour + c.place) = c.number;
    pack.IsRefused(c.why);
  }
}

TEST(PackLimits, PlacesInTheFileAreWholeNumbers) {
  for (const double number : {1e308, 0.5, -7.0}) {
    Asking pack;
    pack.At("/bufferViews/0/byteOffset") = number;
    pack.IsRefused("byteOffset");
  }
  Asking pack;
  pack.At("/nodes/0/translation") = {1e300, 0, 0};
  pack.IsRefused("translation");
}

TEST(PackLimits, ATurnedYawIsTheSameDirection) {
  Asking asking;
  asking.At(kTour + "/path/0/yaw_rad") = 0.5 + 20 * 3.14159265358979;
  PackFile file;
  TourPack pack;
  ASSERT_EQ(file.Open(WithJson(asking.whole, asking.json), "small.glb", &pack).message, "");
  EXPECT_NEAR(pack.path[0].yaw_rad.value(), 0.5f, 1e-4f);
}

// Sixty layers of two nodes that both name both of the next: 2^60 ways down.
TEST(PackLimits, NodesThatShareTheirChildrenAreNoTree) {
  Asking pack;
  const size_t first = pack.json["nodes"].size();
  for (size_t layer = 0; layer < 60; ++layer) {
    const size_t next = first + 2 * (layer + 1);
    for (int k = 0; k < 2; ++k) pack.json["nodes"].push_back({{"children", {next, next + 1}}});
  }
  for (int k = 0; k < 2; ++k) pack.json["nodes"].push_back({{"mesh", 0}});
  pack.At("/scenes/0/nodes").push_back(first);
  pack.IsRefused("broken node tree");
}

TEST(PackLimits, NodesMayNotHangInALongChain) {
  Asking pack;
  const size_t first = pack.json["nodes"].size();
  for (size_t k = 1; k <= 100000; ++k) pack.json["nodes"].push_back({{"children", {first + k}}});
  pack.json["nodes"].push_back(Json::object());
  pack.IsRefused("in each other");
  Asking ring;
  ring.json["nodes"].push_back({{"children", {first + 1}}});
  ring.json["nodes"].push_back({{"children", {first}}});
  ring.IsRefused("in a loop");
}

// 600 s at 30 frames a second are 18,000 matrices a joint: nothing for ten joints, a gigabyte for a thousand.
TEST(PackLimits, ALongClipOfManyJointsIsRefused) {
  Asking pack;
  const Json animation = pack.At("/animations/0");
  const Json& channel = animation["channels"][0];
  const size_t sampler = channel["sampler"].get<size_t>();
  const size_t input = animation["samplers"][sampler]["input"].get<size_t>();
  Json& accessor = pack.At("/accessors/" + std::to_string(input));
  std::vector<float> times(accessor["count"].get<size_t>());
  for (size_t k = 0; k < times.size(); ++k)
    times[k] = 599.9f * static_cast<float>(k) / static_cast<float>(times.size() - 1);
  accessor = {{"bufferView", pack.Append(times.data(), times.size() * sizeof(float))},
              {"componentType", 5126},
              {"type", "SCALAR"},
              {"count", times.size()}};
  EXPECT_EQ(pack.Message(), "") << "few joints may";
  const size_t first = pack.json["nodes"].size();
  Json& joints = pack.At("/skins/0/joints");
  for (size_t k = 0; k < 1000; ++k) {
    pack.json["nodes"].push_back(Json::object());
    joints.push_back(first + k);
  }
  pack.At("/skins/0").erase("inverseBindMatrices");
  pack.IsRefused("a clip");
}

TEST(PackLimits, APictureThatIsNamedManyTimesCountsAsOften) {
  Asking pack;
  const std::vector<uint8_t> black(size_t{4000} * 4000 * 3, 0);
  const std::vector<uint8_t> png = EncodePng(4000, 4000, 3, black);  // 16 million pixels in a few bytes
  const size_t view = pack.Append(png.data(), png.size());
  pack.json["images"].push_back({{"bufferView", view}, {"mimeType", "image/png"}});
  EXPECT_EQ(pack.Message(), "");
  for (int k = 0; k < 7; ++k) pack.json["images"].push_back(pack.json["images"].back());
  pack.IsRefused("pixels");
}

// Each would become a square of 64 MB on the graphics card.
TEST(PackLimits, AThinPictureCountsAsTheSquareThatItBecomes) {
  Asking pack;
  const std::vector<uint8_t> line(size_t{4096} * 3, 0);
  const std::vector<uint8_t> png = EncodePng(4096, 1, 3, line);
  const size_t binary = 20 + GetWord(pack.whole, 12) + 8, offset = pack.whole.size() - binary;
  pack.whole.insert(pack.whole.end(), png.begin(), png.end());
  pack.whole.resize((pack.whole.size() + 3) / 4 * 4, 0);
  PutWord(&pack.whole, 8, pack.whole.size());
  PutWord(&pack.whole, binary - 8, pack.whole.size() - binary);
  pack.At("/buffers/0/byteLength") = pack.whole.size() - binary;
  const size_t view = pack.json["bufferViews"].size();
  pack.json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", png.size()}});
  for (int k = 0; k < 40; ++k) pack.json["images"].push_back({{"bufferView", view}, {"mimeType", "image/png"}});
  pack.IsRefused("memory for pictures");
}

TEST(PackLimits, ASoundThatManyNameIsThereOnce) {
  Asking asking;
  const Json place = asking.At(kTour + "/sounds/1");
  for (int k = 0; k < 900; ++k) asking.At(kTour + "/sounds").push_back(place);
  PackFile file;
  TourPack pack;
  ASSERT_EQ(file.Open(WithJson(asking.whole, asking.json), "small.glb", &pack).message, "");
  EXPECT_EQ(pack.sound_places.size(), 902u);
  EXPECT_LE(pack.sounds.size(), 2u);
  EXPECT_EQ(pack.sounds[static_cast<size_t>(pack.sound_places.back().sound)],
            pack.sounds[static_cast<size_t>(pack.sound_places[1].sound)]);
}

TEST(PackLimits, AMeshThatSaysToHoldMoreThanItDoesIsRefused) {
  Asking pack;
  for (Json& accessor : pack.json["accessors"]) {
    if (!accessor.contains("bufferView")) accessor["count"] = 400000000;  // a compressed mesh says so itself
  }
  pack.IsRefused("memory");
  Asking more;
  for (Json& accessor : more.json["accessors"]) {
    if (!accessor.contains("bufferView")) accessor["count"] = 3;
  }
  PackFile file;
  TourPack read;
  ASSERT_EQ(file.Open(WithJson(more.whole, more.json), "small.glb", &read).message, "");
  PackMesh mesh;
  const std::string message = file.ReadMesh(read.avatars[0].levels[0].mesh, &mesh).message;
  EXPECT_NE(message.find("than it says"), std::string::npos) << message;
}

TEST(PackLimits, ACompressedViewThatIsNamedOftenCountsAsOften) {
  Asking pack;
  constexpr size_t kCount = 100000, kStride = 4;
  const std::vector<uint8_t> packed = EncodeMeshopt(std::vector<uint8_t>(kCount * kStride), kStride);
  const size_t view = pack.Append(packed.data(), packed.size());
  Json compressed = pack.json["bufferViews"][view];
  compressed["extensions"]["EXT_meshopt_compression"] = compressed;
  compressed["extensions"]["EXT_meshopt_compression"].update(
      {{"mode", "ATTRIBUTES"}, {"count", kCount}, {"byteStride", kStride}});
  compressed["byteLength"] = kCount * kStride;
  pack.json["bufferViews"].push_back(compressed);
  EXPECT_EQ(pack.Message(), "");
  for (int k = 0; k < 200; ++k) pack.json["bufferViews"].push_back(compressed);
  pack.IsRefused("work");
}

TEST(PackLimits, TheMemoryMayBeLessOrMore) {
  Asking pack;
  pack.IsRefused("memory", {1000, kPackPictures_bytes});
  pack.IsRefused("memory for pictures", {kPackMemory_bytes, 20});
  EXPECT_EQ(pack.Message({4 * kPackMemory_bytes, 4 * kPackPictures_bytes}), "");
}

TEST(PackLimits, DeepJsonIsRefusedBeforeItIsParsed) {
  Asking pack;
  std::string deep = "{\"a\":" + std::string(200000, '[') + std::string(200000, ']') + "}";
  deep.resize((deep.size() + 3) / 4 * 4, ' ');
  std::vector<uint8_t> bytes = pack.whole;
  bytes.resize(20 + deep.size());
  std::copy(deep.begin(), deep.end(), bytes.begin() + 20);
  PutWord(&bytes, 8, bytes.size());
  PutWord(&bytes, 12, deep.size());
  PackFile file;
  TourPack read;
  EXPECT_NE(file.Open(bytes, "small.glb", &read).message.find("200 deep"), std::string::npos);
}

}  // namespace
}  // namespace flaneur
