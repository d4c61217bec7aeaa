// Small models that ask for much, or for what is no file: each comes to an end in one line.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "pipeline/core/child_policy.h"
#include "pipeline/core/temporary_folder.h"
#include "pipeline/io/gltf.h"
#include "pipeline/io/motion_reader.h"
#include "runtime/base/file.h"

namespace flaneur {
namespace {

using Json = nlohmann::json;

class ModelLimits : public testing::Test {
 protected:
  void SetUp() override { ASSERT_FALSE(folder_.Create("flaneur_test_")); }

  // A triangle on one joint, which turns.
  void SetUpPerson() {
    const float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1.8f, 0}, times[2] = {0, 1};
    const float turns[8] = {0, 0, 0, 1, 0, 0.1f, 0, 0.995f}, weights[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    const uint8_t joints[12] = {};
    Add(positions, sizeof positions, 5126, "VEC3", 3);
    Add(joints, sizeof joints, 5121, "VEC4", 3);
    Add(weights, sizeof weights, 5126, "VEC4", 3);
    Add(times, sizeof times, 5126, "SCALAR", 2);
    Add(turns, sizeof turns, 5126, "VEC4", 2);
    json["asset"] = {{"version", "2.0"}};
    json["scene"] = 0;
    json["scenes"] = {{{"nodes", {0, 1}}}};
    json["nodes"] = {{{"mesh", 0}, {"skin", 0}}, Json::object()};
    json["skins"] = {{{"joints", {1}}}};
    json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", 0}, {"JOINTS_0", 1}, {"WEIGHTS_0", 2}}}}}}}};
    json["animations"] = {{{"name", "walk"},
                           {"samplers", {{{"input", 3}, {"output", 4}}}},
                           {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "rotation"}}}}}}}};
  }

  std::string Message(const std::string& name = "person.gltf") {
    json["buffers"] = buffers.is_null() ? Json{{{"uri", "person.bin"}, {"byteLength", bytes_.size()}}} : buffers;
    EXPECT_FALSE(WriteFile(folder_.path() / "person.bin", bytes_));
    EXPECT_FALSE(WriteTextFile(folder_.path() / name, json.dump()));
    Avatar avatar;
    std::vector<std::string> warnings;
    const std::string message = ReadAvatar(folder_.path() / name, {}, &avatar, &warnings).message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
    EXPECT_LT(message.size(), 5000u);
    return message;
  }

  Json json, buffers;
  TemporaryFolder folder_;

 private:
  void Add(const void* data, size_t size, int component_type, const char* type, int count) {
    json["accessors"].push_back({{"bufferView", json["bufferViews"].size()},
                                 {"componentType", component_type},
                                 {"type", type},
                                 {"count", count}});
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", size}});
    const auto* first = static_cast<const uint8_t*>(data);
    bytes_.insert(bytes_.end(), first, first + size);
  }
  std::vector<uint8_t> bytes_;
};

TEST_F(ModelLimits, APersonWhoseWeightsAreAllZeroFollowsTheFirstJoint) {
  SetUpPerson();
  EXPECT_EQ(Message(), "") << "as it is";
  json["accessors"][2].erase("bufferView");  // stands for zeros
  EXPECT_EQ(Message(), "");
}

TEST_F(ModelLimits, AnAccessorWithoutDataMayNotBeLarge) {
  SetUpPerson();
  for (int k : {0, 1, 2}) {
    json["accessors"][k].erase("bufferView");
    json["accessors"][k]["count"] = 100000000;
  }
  EXPECT_NE(Message().find("MiB of memory"), std::string::npos);
}

TEST_F(ModelLimits, WhatManyPrimitivesNameIsCountedForEach) {
  SetUpPerson();
  json["accessors"][0].erase("bufferView");
  json["accessors"][0]["count"] = 100000;
  Json& primitives = json["meshes"][0]["primitives"];
  for (int k = 0; k < 3000; ++k) primitives.push_back({{"attributes", {{"POSITION", 0}}}});
  EXPECT_NE(Message().find("MiB of memory"), std::string::npos);
}

TEST_F(ModelLimits, NodesMayNotHangInALongChain) {
  SetUpPerson();
  for (size_t k = 2; k < 50000; ++k) json["nodes"].push_back({{"children", {k + 1}}});
  json["nodes"].push_back(Json::object());
  EXPECT_NE(Message().find("nodes in each other"), std::string::npos);
}

TEST_F(ModelLimits, MorphTargetsAreCounted) {
  SetUpPerson();
  json["accessors"].push_back({{"componentType", 5126}, {"type", "VEC3"}, {"count", 1000000}});
  Json& primitive = json["meshes"][0]["primitives"][0];
  for (int k = 0; k < 100; ++k) primitive["targets"].push_back({{"POSITION", json["accessors"].size() - 1}});
  EXPECT_NE(Message().find("MiB of memory"), std::string::npos);
}

TEST_F(ModelLimits, AMeshMayNotBeShownForever) {
  SetUpPerson();
  json["accessors"][0]["count"] = 10000;
  json["accessors"][0].erase("bufferView");
  for (int k = 0; k < 20000; ++k) json["nodes"].push_back({{"mesh", 0}});
  EXPECT_NE(Message().find("larger than the file is worth"), std::string::npos);
}

TEST_F(ModelLimits, ChannelsMayStandInAnyOrder) {
  SetUpPerson();
  for (int k = 0; k < 20000; ++k) json["nodes"].push_back(Json::object());
  Json& channels = json["animations"][0]["channels"];
  for (int k = 0; k < 60000; ++k)  // never two of one node beside each other
    channels.push_back({{"sampler", 0}, {"target", {{"node", 2 + k % 20000}, {"path", "rotation"}}}});
  const auto start = std::chrono::steady_clock::now();
  Message();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20)) << "a minute where it is looked for";
}

TEST_F(ModelLimits, BuffersLieWhereTheyMay) {
  SetUpPerson();
  EXPECT_EQ(Message(), "");
  TemporaryFolder outside;
  ASSERT_FALSE(outside.Create("flaneur_test_"));
  std::filesystem::copy_file(folder_.path() / "person.bin", outside.path() / "person.bin");
  std::filesystem::create_symlink(outside.path() / "person.bin", folder_.path() / "link.bin");
  buffers = {{{"uri", "link.bin"}, {"byteLength", 36 + 12 + 48 + 8 + 32}}};
  EXPECT_EQ(Message(), "") << "where nothing is said";
  ChildPolicy policy;
  policy.roots = {folder_.path()};
  SetChildPolicy(policy);
  EXPECT_NE(Message().find("outside the tour's folder"), std::string::npos);
  SetChildPolicy({});
}

TEST_F(ModelLimits, AClipMayNotLastForDays) {
  SetUpPerson();
  json["accessors"][3]["bufferView"] = 0;  // 0, 0, 0, ...: the times are the positions
  json["accessors"][3]["byteOffset"] = 24;
  const std::string message = Message();  // 0 and 1.8 s: that may be
  EXPECT_EQ(message, "");
  json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 36}});
  json["accessors"][3] = {{"bufferView", json["bufferViews"].size() - 1},
                          {"componentType", 5125},
                          {"type", "SCALAR"},
                          {"count", 2},
                          {"byteOffset", 8}};  // as whole numbers: 0 and 1065353216 s
  EXPECT_EQ(Message(), "") << "its first minute is looked at";
}

TEST_F(ModelLimits, AClipMayNotMoveTooMuch) {
  SetUpPerson();
  json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 36}});
  json["accessors"][3] = {{"bufferView", json["bufferViews"].size() - 1},
                          {"componentType", 5125},
                          {"type", "SCALAR"},
                          {"count", 2},
                          {"byteOffset", 8}};
  for (int k = 0; k < 10000; ++k) json["nodes"].push_back(Json::object());
  EXPECT_NE(Message().find("too long for so many nodes"), std::string::npos);
}

class MotionLimits : public ModelLimits {
 protected:
  std::string Read(const std::string& text) {
    EXPECT_FALSE(WriteTextFile(folder_.path() / "walk.bvh", text));
    MotionFile motion;
    return OpenMotion(folder_.path() / "walk.bvh", &motion).message;
  }

  static std::string Joints(int count, const std::string& root, const char* kind) {
    std::string text = "HIERARCHY\nROOT " + root + "\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n";
    for (int k = 1; k < count; ++k) text += std::string(kind) + "\n{\nOFFSET 0 1 0\n";
    for (int k = 0; k < count; ++k) text += "}\n";
    return text;
  }
};

TEST_F(MotionLimits, AShortRecordingIsRead) {
  EXPECT_EQ(Read(Joints(3, "hips", "JOINT a") + "MOTION\nFrames: 2\nFrame Time: 0.1\n0\n10\n"), "");
}

TEST_F(MotionLimits, NamesMayNotGrowFromJointToJoint) {
  const std::string text = Joints(4000, std::string(1000000, 'a'), "End Site");
  EXPECT_NE(Read(text + "MOTION\nFrames: 1\nFrame Time: 1\n0\n").find("name is longer"), std::string::npos);
}

TEST_F(MotionLimits, AMinuteOfThousandsOfJointsIsTooMuch) {
  std::string text = Joints(4000, "hips", "JOINT a") + "MOTION\nFrames: 1801\nFrame Time: 0.0333\n";
  for (int k = 0; k < 1801; ++k) text += "0\n";
  EXPECT_NE(Read(text).find("too long for so many joints"), std::string::npos);
}

TEST_F(MotionLimits, FramesMayBeAnyNumber) {
  for (const char* motion : {"Frames: 1e38\nFrame Time: 1e-38\n0\n", "Frames: 1e38\nFrame Time: 1e38\n0\n",
                             "Frames: 1.5\nFrame Time: 1e30\n0\n", "Frames: nan\nFrame Time: 1\n0\n"})
    Read(Joints(1, "hips", "") + "MOTION\n" + motion);
}

TEST_F(ModelLimits, BuffersAreFilesOfTheDisk) {
  SetUpPerson();
  ASSERT_EQ(::mkfifo((folder_.path() / "pipe").c_str(), 0600), 0);
  for (const char* uri : {"pipe", "/dev/zero"}) {
    buffers = {{{"uri", uri}, {"byteLength", 1000}}};
    EXPECT_NE(Message(), "") << uri;
  }
}

TEST_F(ModelLimits, ASkinWithoutJointsIsRefused) {
  SetUpPerson();
  json["skins"][0]["joints"] = Json::array();
  EXPECT_NE(Message(), "");
}

}  // namespace
}  // namespace flaneur
