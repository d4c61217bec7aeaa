#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <limits>

#include "pipeline/io/gltf.h"
#include "pipeline/io/motion_reader.h"
#include "pipeline/rig/clip_loop.h"
#include "pipeline/rig/motion_quality.h"
#include "runtime/base/file.h"
#include "tests/unit/pipeline/test_human.h"
#include "tests/unit/pipeline/test_person.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;

class AvatarFile : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        fs::temp_directory_path() / (std::string("flaneur_avatar_file_") + info->name() + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path Write(const Avatar& avatar, const DracoOptions& draco = {}) {
    const fs::path path = folder_ / "person.glb";
    EXPECT_EQ(WriteAvatarGlb(path, OneLevel(avatar), draco).message, "");
    return path;
  }

  // Reads back; the message of the error.
  std::string Read(const fs::path& path, const ReadAvatarOptions& options = {}) {
    avatar_ = {};
    warnings_.clear();
    const std::string message = ReadAvatar(path, options, &avatar_, &warnings_).message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
    return message;
  }

  // The file with the first `from` in its JSON replaced by `to`, padded to the same length.
  fs::path Changed(const fs::path& path, const std::string& from, std::string to) {
    std::vector<uint8_t> bytes;
    EXPECT_EQ(ReadFile(path, &bytes).message, "");
    const auto at = std::search(bytes.begin(), bytes.end(), from.begin(), from.end());
    EXPECT_TRUE(at != bytes.end()) << from;
    EXPECT_LE(to.size(), from.size());
    to.resize(from.size(), ' ');
    std::copy(to.begin(), to.end(), at);
    const fs::path changed = folder_ / "changed.glb";
    EXPECT_EQ(WriteFile(changed, bytes).message, "");
    return changed;
  }

  fs::path folder_;
  Avatar avatar_;
  std::vector<std::string> warnings_;
};

// `dip_m`: how deep a toe goes into the ground.
void ExpectSoundAvatar(const Avatar& avatar, float dip_m = 0) {
  ASSERT_NE(FindClip(avatar, "walk"), nullptr);
  for (size_t j = 0; j < avatar.joints.size(); ++j) {
    EXPECT_LT(avatar.joints[j].parent, static_cast<int>(j));
  }
  for (const Clip& clip : avatar.clips) {
    ASSERT_EQ(clip.transforms.size(), static_cast<size_t>(clip.keys) * avatar.joints.size());
    const size_t last = clip.transforms.size() - avatar.joints.size();
    for (size_t j = 0; j < avatar.joints.size(); ++j) {
      EXPECT_EQ(clip.transforms[j].rotation.x, clip.transforms[last + j].rotation.x);
      EXPECT_EQ(clip.transforms[j].translation.y, clip.transforms[last + j].translation.y);
    }
  }
  for (const Mesh& mesh : avatar.meshes) {
    ASSERT_EQ(mesh.joints.size(), mesh.positions.size());
    ASSERT_EQ(mesh.weights.size(), mesh.positions.size());
    for (size_t v = 0; v < mesh.weights.size(); ++v) {
      const auto& w = mesh.weights[v];
      ASSERT_NEAR(w[0] + w[1] + w[2] + w[3], 1, 1e-5f);
      for (const uint16_t joint : mesh.joints[v]) ASSERT_LT(joint, avatar.joints.size());
    }
  }
  // Lowest point of the walk on the ground.
  const Clip& walk = *FindClip(avatar, "walk");
  float lowest = 1e30f;
  for (int k = 0; k + 1 < walk.keys; ++k) {
    const float t = walk.duration_s * static_cast<float>(k) / static_cast<float>(walk.keys - 1);
    for (const Mesh& mesh : avatar.meshes) {
      for (const Vec3 p : Skinned(mesh, SkinningMatrices(avatar, walk, t)).positions) {
        lowest = std::min(lowest, p.y);
      }
    }
  }
  EXPECT_NEAR(lowest, -dip_m, 0.002f);
}

TEST_F(AvatarFile, ComesBackAsItWasWritten) {
  const Avatar made = MadePerson();
  for (const bool compress : {true, false}) {
    DracoOptions draco;
    draco.compress = compress;
    ASSERT_EQ(Read(Write(made, draco)), "");
    ExpectSoundAvatar(avatar_);
    EXPECT_EQ(avatar_.joints.size(), 3u);
    EXPECT_EQ(TriangleCount(avatar_.meshes[0]), TriangleCount(made.meshes[0]));
    EXPECT_NEAR(avatar_.height_m, 1.8f, 0.001f);
    EXPECT_NEAR(avatar_.walk_speed_mps, 1.2f, 1e-5f) << "told by the file";
    const Clip& walk = *FindClip(avatar_, "walk");
    EXPECT_NEAR(walk.duration_s, 1, 1e-5f);
    for (const float t : {0.1f, 0.3f, 0.77f}) {
      const auto a = SkinningMatrices(made, made.clips[0], t);
      const auto b = SkinningMatrices(avatar_, walk, t);
      for (size_t j = 0; j < 3; ++j) {
        const Vec3 hip = TransformPoint(Inverse(made.joints[j].inverse_bind), {});
        const Vec3 foot = hip + Vec3{0, -0.8f, 0};
        // The walk's lowest point is on the ground, so the whole figure may have moved up or down.
        const Vec3 moved = TransformPoint(b[j], foot) - TransformPoint(a[j], foot);
        EXPECT_NEAR(moved.x, 0, 0.003f);
        EXPECT_NEAR(moved.z, 0, 0.003f);
        EXPECT_NEAR(moved.y, 0, 0.03f);
      }
    }
  }
}

TEST_F(AvatarFile, MeasuresTheSpeedOfTheSoles) {
  Avatar made = MadePerson();
  made.walk_speed_mps = 0;
  ASSERT_EQ(Read(Write(made)), "");
  // A stance leg of 0.9 m swings at up to 0.3 * 2 pi rad/s; the median is below that and well above
  // nothing.
  EXPECT_GT(avatar_.walk_speed_mps, 0.8f);
  EXPECT_LT(avatar_.walk_speed_mps, 0.9f * 0.3f * 2 * kPi + 0.05f);
}

TEST_F(AvatarFile, TakesTravelOutOfTheWalkAsItsSpeed) {
  Avatar made = MadePerson();
  made.walk_speed_mps = 0;
  Clip& walk = made.clips[0];
  for (int k = 0; k < walk.keys; ++k) {
    walk.transforms[static_cast<size_t>(3 * k)].translation.z += 1.4f * static_cast<float>(k) / 30;
  }
  ASSERT_EQ(Read(Write(made)), "");
  EXPECT_NEAR(avatar_.walk_speed_mps, 1.4f, 0.01f);
  ExpectSoundAvatar(avatar_);
  for (const Transform& t : FindClip(avatar_, "walk")->transforms) {
    EXPECT_LT(std::abs(t.translation.z), 0.1f);
  }
}

TEST_F(AvatarFile, ScalesToTheAskedHeight) {
  ReadAvatarOptions options;
  options.height_m = 0.9f;
  ASSERT_EQ(Read(Write(MadePerson()), options), "");
  EXPECT_NEAR(avatar_.height_m, 0.9f, 1e-5f);
  EXPECT_NEAR(avatar_.walk_speed_mps, 0.6f, 0.001f);
  ExpectSoundAvatar(avatar_);
}

TEST_F(AvatarFile, FaultsAreOneClearLine) {
  const fs::path good = Write(MadePerson());
  EXPECT_NE(Read(folder_ / "absent.glb").find("absent.glb"), std::string::npos);
  ASSERT_EQ(WriteTextFile(folder_ / "text.glb", "not a picture of a person").message, "");
  EXPECT_NE(Read(folder_ / "text.glb").find("text.glb"), std::string::npos);

  Avatar swimmer = MadePerson();
  swimmer.clips[0].name = "swim";
  swimmer.clips.push_back(swimmer.clips[0]);
  swimmer.clips[1].name = "dive";
  const std::string message = Read(Write(swimmer));
  EXPECT_NE(message.find("'swim', 'dive'"), std::string::npos) << message;
  ReadAvatarOptions options;
  options.walk = "swum";
  EXPECT_NE(Read(Write(swimmer), options).find("did you mean 'swim'"), std::string::npos);
  options.walk = "SWIM";
  EXPECT_EQ(Read(Write(swimmer), options), "");
  options = {};
  options.hide = {"level9"};
  EXPECT_NE(Read(Write(MadePerson()), options).find("did you mean 'level0'"), std::string::npos);
  options = {};
  options.max_joints = 2;
  EXPECT_NE(Read(Write(MadePerson()), options).find("joints"), std::string::npos);
}

TEST_F(AvatarFile, NamesTheNodeOfANonFiniteVertex) {
  Avatar broken = MadePerson();
  broken.meshes[0].positions[5].x = std::numeric_limits<float>::quiet_NaN();
  DracoOptions plain;
  plain.compress = false;
  const std::string message = Read(Write(broken, plain));
  EXPECT_NE(message.find("level0"), std::string::npos) << message;
  EXPECT_NE(message.find("not finite"), std::string::npos) << message;
}

TEST_F(AvatarFile, RefusesWhatItCannotDecode) {
  const fs::path path = Changed(Write(MadePerson()), "\"KHR_draco_mesh_compression\"]", "\"KHR_meshopt_compression\"]");
  EXPECT_NE(Read(path).find("KHR_meshopt_compression"), std::string::npos);
}

TEST_F(AvatarFile, RefusesABrokenCompressedClip) {
  const fs::path path = Changed(Write(MadePerson()), "\"mode\":\"ATTRIBUTES\"", "\"mode\":\"TRIANGLES\"");
  EXPECT_NE(Read(path).find("broken compressed data"), std::string::npos);
}

TEST_F(AvatarFile, WithoutASkinIsRefused) {
  const fs::path path = Changed(Write(MadePerson()), "\"skin\":0", "\"skim\":0");
  EXPECT_NE(Read(path).find("no skin"), std::string::npos);
}

TEST_F(AvatarFile, EveryPrefixIsAnError) {
  for (const bool compress : {true, false}) {
    DracoOptions draco;
    draco.compress = compress;
    std::vector<uint8_t> bytes;
    ASSERT_EQ(ReadFile(Write(MadePerson(), draco), &bytes).message, "");
    const fs::path cut = folder_ / "cut.glb";
    const size_t step = std::max<size_t>(bytes.size() / 300, 1);
    for (size_t size = 0; size < bytes.size(); size += size < 64 ? 1 : step) {
      ASSERT_EQ(WriteFile(cut, std::span(bytes).first(size)).message, "");
      ASSERT_NE(Read(cut), "") << size << " of " << bytes.size() << " bytes";
    }
  }
}

// Flipped bytes may still make a readable file; they must not make a crash.
TEST_F(AvatarFile, BrokenBytesDoNotCrash) {
  std::vector<uint8_t> bytes;
  ASSERT_EQ(ReadFile(Write(MadePerson()), &bytes).message, "");
  const fs::path broken = folder_ / "broken.glb";
  uint32_t random = 1;
  for (int round = 0; round < 300; ++round) {
    std::vector<uint8_t> changed = bytes;
    for (int i = 0; i < 3; ++i) {
      random = random * 1664525u + 1013904223u;
      changed[20 + (random >> 8) % (changed.size() - 20)] = static_cast<uint8_t>(random >> 3);
    }
    ASSERT_EQ(WriteFile(broken, changed).message, "");
    Avatar avatar;
    std::vector<std::string> warnings;
    if (ReadAvatar(broken, {}, &avatar, &warnings)) continue;
    for (const Mesh& mesh : avatar.meshes) {
      for (const uint32_t i : mesh.indices) ASSERT_LT(i, mesh.positions.size());
    }
  }
}

// A flag high above the head, on the last joint.
Avatar WithFlag(Avatar person) {
  Mesh flag;
  flag.positions = {{0, 3, 0}, {1, 3, 0}, {0, 4, 0}};
  flag.normals.assign(3, {0, 0, 1});
  flag.joints.assign(3, {static_cast<uint16_t>(person.joints.size() - 1), 0, 0, 0});
  flag.weights.assign(3, {1, 0, 0, 0});
  flag.indices = {0, 1, 2};
  person.props = {{"flag", {flag}}};
  return person;
}

TEST_F(AvatarFile, PropsStandApartAndDoNotMakeThePersonHigher) {
  const fs::path path = Write(WithFlag(MadePerson()));
  const int own = [&] {
    int triangles = 0;
    for (const Mesh& mesh : MadePerson().meshes) triangles += TriangleCount(mesh);
    return triangles;
  }();
  const auto triangles = [&] {
    int count = 0;
    for (const Mesh& mesh : avatar_.meshes) count += TriangleCount(mesh);
    return count;
  };
  ReadAvatarOptions options;
  options.props = {"flag"};
  ASSERT_EQ(Read(path, options), "");
  EXPECT_EQ(triangles(), own);
  EXPECT_NEAR(avatar_.height_m, MadePerson().height_m, 0.02f);
  ASSERT_EQ(avatar_.props.size(), 1u);
  ASSERT_EQ(avatar_.props[0].meshes.size(), 1u);
  EXPECT_EQ(TriangleCount(avatar_.props[0].meshes[0]), 1);
  for (const auto& joints : avatar_.props[0].meshes[0].joints) EXPECT_LT(joints[0], avatar_.joints.size());
  float highest = 0;
  for (const Vec3 p : avatar_.props[0].meshes[0].positions) highest = std::max(highest, p.y);
  EXPECT_NEAR(highest, 4, 0.1f);
  ASSERT_EQ(Read(path), "") << "nobody says that it is a prop";
  EXPECT_EQ(triangles(), own + 1);
  options.props = {"flg"};
  EXPECT_NE(Read(path, options).find("no node 'flg' for the prop of that name; did you mean 'flag'?"),
            std::string::npos);
  options.props = {"flag"};
  options.hide = {"flag"};
  EXPECT_NE(Read(path, options).find("prop 'flag' shows no mesh"), std::string::npos);
}

TEST_F(AvatarFile, WhoHasNoClipsAndNoLegsGlides) {
  Avatar ghost = MadePerson();
  ghost.clips.clear();
  ASSERT_EQ(Read(Write(ghost)), "");
  ExpectSoundAvatar(avatar_);
  ASSERT_FALSE(warnings_.empty());
  EXPECT_NE(warnings_[0].find("glides"), std::string::npos) << warnings_[0];
  EXPECT_GT(avatar_.walk_speed_mps, 0.5f);
}

// Whether the walk moves its feet, stands upright on the ground and goes ahead.
void ExpectWalks(const Avatar& avatar, float most_slide = 0.1f) {
  ExpectSoundAvatar(avatar);
  const Clip& walk = *FindClip(avatar, "walk");
  EXPECT_GT(avatar.walk_speed_mps, 0.5f);
  EXPECT_LT(avatar.walk_speed_mps, 4.0f);  // MakeHuman's is in a hurry
  EXPECT_LT(FootSlide(avatar, walk, avatar.walk_speed_mps), most_slide);
  float highest = 0, lowest = 1;
  for (int k = 0; k < walk.keys; ++k) {
    const float time_s = walk.duration_s * static_cast<float>(k) / static_cast<float>(walk.keys);
    for (const Mesh& mesh : avatar.meshes) {
      for (const Vec3 p : SkinnedPositions(mesh, SkinningMatrices(avatar, walk, time_s))) {
        highest = std::max(highest, p.y), lowest = std::min(lowest, p.y);
      }
    }
  }
  EXPECT_NEAR(lowest, 0, 0.01f);
  EXPECT_NEAR(highest, avatar.height_m, 0.12f);
}

TEST_F(AvatarFile, WhoHasNoClipsWalksByThoseThatComeWithTheProgram) {
  for (const HumanShape& shape :
       {HumanShape{}, HumanShape{.unit = 100}, HumanShape{.arm_down_deg = 60},
        HumanShape{.turn = TurnAbout({1, 0, 0}, kPi / 2)}, HumanShape{.turn = TurnAbout({1, 0, 0}, kPi)},
        HumanShape{.turn = TurnAbout({0, 1, 0}, kPi)}, HumanShape{.feet_on_root = true}}) {
    ASSERT_EQ(Read(Write(MadeHuman(shape))), "");
    ExpectWalks(avatar_);
    EXPECT_NEAR(avatar_.height_m, 1.74f, 0.03f) << "the unit is found, and what lies is stood up";
    EXPECT_NE(FindClip(avatar_, "idle"), nullptr);
    EXPECT_NE(FindClip(avatar_, "talk"), nullptr);
  }
  ReadAvatarOptions options;
  options.walk = "walk_old";
  options.other_clips = {{"sit"}, {"sweep", "sweep", "flaneur"}};
  ASSERT_EQ(Read(Write(MadeHuman({})), options), "");
  EXPECT_LT(avatar_.walk_speed_mps, 0.9f);
  EXPECT_NE(FindClip(avatar_, "sweep"), nullptr);
}

// A figure downloaded with its stance alone does not glide by it.
TEST_F(AvatarFile, WhoseOnlyClipIsAStanceWalksByOneThatComesWithTheProgram) {
  for (const char* const name : {"Idle", "mixamo.com"}) {
    Avatar person = MadeHuman({});
    Clip stance = MadeWalk(person);
    stance.name = name;
    for (size_t i = 0; i < stance.transforms.size(); ++i) {
      const size_t joint = i % person.joints.size();
      if (joint == 0 || joint >= 10) stance.transforms[i] = person.joints[joint].rest;
    }
    person.clips = {stance};
    ASSERT_EQ(Read(Write(person)), "");
    ExpectWalks(avatar_);
    ASSERT_NE(FindClip(avatar_, "idle"), nullptr);
    EXPECT_NEAR(FindClip(avatar_, "idle")->duration_s, stance.duration_s, 0.05f) << "it stands by it";
    EXPECT_TRUE(std::any_of(warnings_.begin(), warnings_.end(), [&](const std::string& w) {
      return w.find("it has no walk clip ('" + std::string(name) + "' ") != std::string::npos;
    })) << name;
  }
}

// As Mixamo's files come: the figure with a walk that has no name of its own, a stance beside it.
TEST_F(AvatarFile, AStanceInAnotherFileIsNotTakenForTheWalk) {
  Avatar walker = MadeHuman({}), stander = MadeHuman({});
  walker.clips = {MadeWalk(walker)};
  walker.clips[0].name = "mixamo.com";
  walker.clips[0].duration_s = 0.7f;
  stander.clips = {MadeWalk(stander)};
  stander.clips[0].name = "Idle";
  stander.clips[0].duration_s = 3;
  const fs::path clips = folder_ / "idle.glb";
  ASSERT_EQ(WriteAvatarGlb(clips, OneLevel(stander)).message, "");
  ReadAvatarOptions options;
  options.clip_files = {clips};
  ASSERT_EQ(Read(Write(walker), options), "");
  EXPECT_NEAR(FindClip(avatar_, "walk")->duration_s, 0.7f, 0.05f);
  EXPECT_NEAR(FindClip(avatar_, "idle")->duration_s, 3, 0.05f);
}

// As figures of a toy set are, each file in itself a person.
TEST_F(AvatarFile, WhoIsSmallerThanAChildWhoWalksOrTallerThanPeopleInHatsIsAskedAbout) {
  const auto asked = [&] {
    return std::any_of(warnings_.begin(), warnings_.end(), [](const std::string& w) {
      return w.find("scale for all people of its pack") != std::string::npos;
    });
  };
  for (const float unit : {0.4f, 0.6f, 1.0f, 1.15f, 1.3f}) {
    ASSERT_EQ(Read(Write(MadeHuman({.unit = unit}))), "");
    EXPECT_EQ(asked(), unit == 0.4f || unit == 1.3f) << unit;
    EXPECT_NEAR(avatar_.height_m, 1.74f * unit, 0.03f) << "as it is all the same";
  }
  ReadAvatarOptions options;
  options.height_m = 0.7f;
  ASSERT_EQ(Read(Write(MadeHuman({.unit = 0.4f})), options), "");
  EXPECT_FALSE(asked()) << "it was said";
}

// From the right hip to the left, in the clip's first key.
Vec3 AcrossHips(const Avatar& avatar, const Clip& clip, const HumanShape& shape) {
  const Pose pose = PoseOf(avatar.joints, clip.transforms.data());
  std::array<Vec3, 2> hips;
  for (size_t j = 0; j < avatar.joints.size(); ++j) {
    if (avatar.joints[j].name == shape.names[10]) hips[0] = pose.positions[j];
    if (avatar.joints[j].name == shape.names[14]) hips[1] = pose.positions[j];
  }
  return Normalized(hips[0] - hips[1]);
}

TEST_F(AvatarFile, WhoStandsAtAnOddAngleIsTurnedByIt) {
  HumanShape nameless;
  for (size_t j = 0; j < nameless.names.size(); ++j) nameless.names[j] = "bone " + std::to_string(j);
  for (HumanShape shape : {HumanShape{}, nameless}) {
    for (const float angle_rad : {0.35f, 0.65f, -1.2f, -2.8f}) {
      shape.turn = TurnAbout({0, 1, 0}, angle_rad);
      Avatar walker = MadeHuman(shape);
      walker.clips = {MadeWalk(walker)};
      ASSERT_EQ(Read(Write(walker)), "");
      EXPECT_GT(AcrossHips(avatar_, avatar_.clips[0], shape).x, 0.998f) << angle_rad << " " << shape.names[0];
      if (shape.names == nameless.names) continue;
      walker.clips.clear();
      ASSERT_EQ(Read(Write(walker)), "");
      for (const Clip& clip : avatar_.clips)
        EXPECT_GT(AcrossHips(avatar_, clip, shape).x, 0.98f) << angle_rad << " " << clip.name;
    }
  }
}

// Bound aside of where its own walk goes: it stands by what comes with the program as it walks.
TEST_F(AvatarFile, WhoseWalkGoesAsideOfTheBindPoseStandsTheSameWay) {
  for (const float heading_rad : {0.8f, -1.2f, 2.8f}) {
    Avatar walker = MadeHuman({});
    walker.clips = {MadeWalk(walker)};
    TurnClip(TurnAbout({0, 1, 0}, heading_rad), walker.joints, &walker.clips[0]);
    ASSERT_EQ(Read(Write(walker)), "");
    ASSERT_NE(FindClip(avatar_, "idle"), nullptr);
    for (const Clip& clip : avatar_.clips)
      EXPECT_GT(AcrossHips(avatar_, clip, {}).x, 0.98f) << heading_rad << " " << clip.name;
  }
}

TEST_F(AvatarFile, ClipsOfAnotherFileAreTakenAsTheyAreWhereTheSkeletonIsOne) {
  Avatar walker = MadeHuman({});
  walker.clips = {MadeWalk(walker)};
  const fs::path clips = folder_ / "clips.glb";
  ASSERT_EQ(WriteAvatarGlb(clips, OneLevel(walker)).message, "");
  ASSERT_EQ(Read(clips), "");
  const Clip own = *FindClip(avatar_, "walk");
  ReadAvatarOptions options;
  options.clip_files = {clips};
  ASSERT_EQ(Read(Write(MadeHuman({})), options), "");
  const Clip& taken = *FindClip(avatar_, "walk");
  ASSERT_EQ(taken.transforms.size(), own.transforms.size());
  for (size_t i = 0; i < own.transforms.size(); ++i)
    EXPECT_NEAR(taken.transforms[i].rotation.x, own.transforms[i].rotation.x, 1e-4f);
}

TEST_F(AvatarFile, ClipsOfAnotherSkeletonAreMadeToFit) {
  Avatar walker = MadeHuman({.unit = 100, .arm_down_deg = 70, .turn = TurnAbout({1, 0, 0}, -kPi / 2)});
  walker.clips = {MadeWalk(walker)};
  const fs::path clips = folder_ / "clips.glb";
  ASSERT_EQ(WriteAvatarGlb(clips, OneLevel(walker)).message, "");
  HumanShape other{.leg_m = 0.6f};
  for (size_t j = 0; j < other.names.size(); ++j) other.names[j] = "bone " + std::to_string(j);
  ReadAvatarOptions options;
  options.clip_files = {clips};
  ASSERT_EQ(Read(Write(MadeHuman(other)), options), "");
  ExpectSoundAvatar(avatar_);
  EXPECT_GT(avatar_.walk_speed_mps, 0.3f);
  EXPECT_EQ(avatar_.clips.size(), 3u) << "idle and talk come with the program";
}

TEST_F(AvatarFile, ASpeedThatTheFileTellsIsThatOfItsOwnWalk) {
  Avatar walker = MadeHuman({}), other = MadeHuman({.leg_m = 0.6f});
  walker.clips = {MadeWalk(walker)};
  other.clips = {MadeWalk(other)};
  other.walk_speed_mps = 3;
  const fs::path clips = folder_ / "clips.glb";
  ASSERT_EQ(WriteAvatarGlb(clips, OneLevel(walker)).message, "");
  ASSERT_EQ(Read(Write(other)), "");
  EXPECT_NEAR(avatar_.walk_speed_mps, 3, 1e-3f);
  for (const float told : {1.1f, 110.0f}) {  // of a file in centimetres
    Avatar large = MadeHuman({.unit = 100});
    large.clips = {MadeWalk(large)};
    large.walk_speed_mps = told;
    ASSERT_EQ(Read(Write(large)), "");
    EXPECT_NEAR(avatar_.walk_speed_mps, 1.1f, 1e-3f) << told;
  }
  ReadAvatarOptions options;
  options.clip_files = {clips};
  ASSERT_EQ(Read(Write(other), options), "");
  EXPECT_LT(avatar_.walk_speed_mps, 2);
}

TEST_F(AvatarFile, FeetThatSlideInAWalkAreSetAnew) {
  Avatar walker = MadeHuman({});
  walker.clips = {MadeWalk(walker)};
  Clip& walk = walker.clips[0];  // the feet hurry and drag, twice a cycle
  std::vector<Transform> even = walk.transforms;
  for (int k = 0; k < walk.keys; ++k) {
    const float phase = static_cast<float>(k) / static_cast<float>(walk.keys - 1);
    const float warped = phase + 0.07f * std::sin(4 * kPi * phase);
    const auto from = static_cast<size_t>(std::lround(warped * static_cast<float>(walk.keys - 1))) * 18;
    std::copy_n(even.begin() + static_cast<std::ptrdiff_t>(from), 18, walk.transforms.begin() + k * 18);
  }
  ASSERT_EQ(Read(Write(walker)), "");
  ASSERT_EQ(warnings_.size(), 2u);
  EXPECT_NE(warnings_[0].find("they are set anew"), std::string::npos);
  EXPECT_LT(FootSlide(avatar_, *FindClip(avatar_, "walk"), avatar_.walk_speed_mps), 0.05f);
}

constexpr const char* kWalkBvh = R"(HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Head
  { OFFSET 0 60 0 CHANNELS 3 Zrotation Xrotation Yrotation End Site { OFFSET 0 15 0 } }
  JOINT LeftUpLeg
  { OFFSET 9 0 0 CHANNELS 3 Zrotation Xrotation Yrotation
    JOINT LeftLeg
    { OFFSET 0 -42 1 CHANNELS 3 Zrotation Xrotation Yrotation
      JOINT LeftFoot { OFFSET 0 -42 -1 CHANNELS 3 Zrotation Xrotation Yrotation End Site { OFFSET 0 -6 16 } } } }
  JOINT RightUpLeg
  { OFFSET -9 0 0 CHANNELS 3 Zrotation Xrotation Yrotation
    JOINT RightLeg
    { OFFSET 0 -42 1 CHANNELS 3 Zrotation Xrotation Yrotation
      JOINT RightFoot { OFFSET 0 -42 -1 CHANNELS 3 Zrotation Xrotation Yrotation End Site { OFFSET 0 -6 16 } } } }
}
MOTION
Frames: 31
Frame Time: 0.0333333
)";

std::string WalkBvh() {
  std::string text = kWalkBvh;
  for (int k = 0; k < 31; ++k) {
    const float phase = 2 * kPi * static_cast<float>(k) / 30;
    const auto turn = [](float degrees) { return "0 " + std::to_string(degrees) + " 0 "; };
    text += "0 90 " + std::to_string(4.0f * static_cast<float>(k)) + " 0 0 0 " + turn(0);
    for (const float own : {phase, phase + kPi}) {
      const float swing = -24 * std::sin(own), bend = 40 * std::max(0.0f, std::cos(own));
      text += turn(swing) + turn(bend) + turn(-swing - bend);
    }
    text += "\n";
  }
  return text;
}

TEST_F(AvatarFile, WalksByMotionCapture) {
  const fs::path bvh = folder_ / "walking.bvh";
  ASSERT_EQ(WriteTextFile(bvh, WalkBvh()).message, "");
  ReadAvatarOptions options;
  options.clip_files = {bvh};
  ASSERT_EQ(Read(Write(MadeHuman({})), options), "");
  ExpectSoundAvatar(avatar_);
  EXPECT_NEAR(avatar_.walk_speed_mps, 1.2f, 0.1f) << "1.2 m in a second, on legs of the same length";
}

TEST_F(AvatarFile, BrokenMotionCaptureNamesTheLine) {
  const fs::path bvh = folder_ / "broken.bvh", person = Write(MadeHuman({}));
  ReadAvatarOptions options;
  options.clip_files = {bvh};
  const std::string whole = WalkBvh();
  for (size_t length = 0; length + 40 < whole.size(); length += 97) {
    ASSERT_EQ(WriteTextFile(bvh, whole.substr(0, length)).message, "");
    EXPECT_NE(Read(person, options).find("broken.bvh: line "), std::string::npos) << length;
  }
}

TEST_F(AvatarFile, ClipsThatFitNoWayAreRefused) {
  const fs::path clips = Write(MadePerson());
  fs::copy(clips, folder_ / "clips.glb");
  ReadAvatarOptions options;
  options.clip_files = {folder_ / "clips.glb"};
  EXPECT_NE(Read(Write(MadeHuman({})), options).find("does not fit"), std::string::npos);
}

TEST(Unscaled, TakesMirroringOffToo) {
  const Mat4 rest = FromTranslationRotationScale({1, 2, 3}, TurnAbout({0, 1, 0}, 0.5f), {-2, 2, 2});
  const Mat4 own = rest * Unscaled(rest);
  const Vec3 x = TransformDirection(own, {1, 0, 0}), y = TransformDirection(own, {0, 1, 0});
  EXPECT_NEAR(Length(x), 1, 1e-5f);
  EXPECT_NEAR(Length(Cross(x, y) - TransformDirection(own, {0, 0, 1})), 0, 1e-5f) << "right-handed";
}

// Its vertices hang on joints that its skin does not have; only its clips are wanted.
TEST_F(AvatarFile, ABrokenFigureInAFileOfClipsDoesNotMatter) {
  Avatar walker = MadeHuman({.leg_m = 0.6f});
  walker.clips = {MadeWalk(walker)};
  const fs::path clips = folder_ / "clips.glb";
  ASSERT_EQ(WriteAvatarGlb(clips, OneLevel(walker)).message, "");
  ReadAvatarOptions options;
  options.clip_files = {Changed(clips, ",5,6,7,8,9,10,11,12,13,14,15,16,17,18]", "]")};
  EXPECT_EQ(Read(Write(MadeHuman({})), options), "");
  EXPECT_NE(FindClip(avatar_, "walk"), nullptr);
}

TEST_F(AvatarFile, PartsOfOneSkeletonAreOnePerson) {
  Avatar body = MadeHuman({}), hair = MadeHuman({});
  body.clips = {MadeWalk(body)};
  hair.meshes[0] = {};
  hair.meshes[0].material = 0;
  AddBox({0, 1.6f, 0}, {0, 1.7f, 0}, 0.1f, 3, &hair.meshes[0]);
  hair.materials[0].name = "hair";
  const fs::path part = folder_ / "hair.glb";
  ASSERT_EQ(WriteAvatarGlb(part, OneLevel(hair)).message, "");
  ReadAvatarOptions options;
  options.parts = {part};
  ASSERT_EQ(Read(Write(body), options), "");
  ASSERT_EQ(avatar_.meshes.size(), 2u);
  EXPECT_EQ(avatar_.materials[1].name, "hair");
  EXPECT_EQ(avatar_.joints.size(), body.joints.size()) << "one skeleton";
  options.parts = {Write(MadePerson())};
  fs::copy(options.parts[0], folder_ / "other.glb");
  options.parts = {folder_ / "other.glb"};
  EXPECT_NE(Read(Write(body), options).find("other.glb: is for another skeleton"), std::string::npos);
}

TEST_F(AvatarFile, ReadsPeopleOfManyRigs) {
  if (SharedData().empty()) GTEST_SKIP() << "the folder of real data is not there";
  const fs::path people = SharedData() / "avatars";
  for (const char* file :
       {"kaykit-adventurers2/Rogue.glb", "quaternius-outfits/Male_Peasant.gltf", "vrm/Godette_vrm_v4.vrm"}) {
    SCOPED_TRACE(file);
    ASSERT_EQ(Read(people / file), "");
    ExpectWalks(avatar_);
    ReadAvatarOptions options;
    options.clip_files = {people / "bvh/makehuman_walk1.bvh"};
    ASSERT_EQ(Read(people / file, options), "");
    ExpectWalks(avatar_, 0.4f);
  }
}

TEST_F(AvatarFile, BlinksAndSpeaksByMorphTargets) {
  if (SharedData().empty()) GTEST_SKIP() << "the folder of real data is not there";
  Avatar avatar;
  std::vector<std::string> warnings;
  ASSERT_EQ(ReadAvatar(SharedData() / "avatars/vrm/Godette_vrm_v4.vrm", {}, &avatar, &warnings).message, "");
  const Clip &idle = *FindClip(avatar, "idle"), &talk = *FindClip(avatar, "talk");
  const size_t joints = avatar.joints.size();
  const auto moves = [&](const Clip& clip, const std::string& name) {
    for (size_t i = 0; i < clip.transforms.size(); ++i) {
      if (avatar.joints[i % joints].name == name && Length(clip.transforms[i].translation) > 0.01f) return true;
    }
    return false;
  };
  EXPECT_TRUE(moves(idle, "Blink"));
  EXPECT_FALSE(moves(idle, "OpenMouth"));
  EXPECT_TRUE(moves(talk, "OpenMouth"));
}

TEST_F(AvatarFile, SaysOfAnOutfitWithoutABodyThatItHasNoHead) {
  if (SharedData().empty()) GTEST_SKIP() << "the folder of real data is not there";
  const auto headless = [&] {
    return std::any_of(warnings_.begin(), warnings_.end(), [](const auto& w) {
      return w.find("nothing hangs on the skeleton's head") != std::string::npos;
    });
  };
  const fs::path people = SharedData() / "avatars";
  ASSERT_EQ(Read(people / "quaternius-outfits/Male_Peasant.gltf"), "");
  EXPECT_TRUE(headless());
  for (const char* file :
       {"kaykit/Knight.glb", "vrm/Godette_vrm_v4.vrm", "quaternius-ubc/Superhero_Female_FullBody.gltf"}) {
    ASSERT_EQ(Read(people / file), "");
    EXPECT_FALSE(headless()) << file;
  }
}

TEST_F(AvatarFile, WalksByAStylizedWalkAsAPersonWould) {
  if (SharedData().empty()) GTEST_SKIP() << "the folder of real data is not there";
  const fs::path people = SharedData() / "avatars";
  ReadAvatarOptions options;
  for (const char* clips : {"kaykit/Knight.glb", "robot-expressive/RobotExpressive.glb"}) {
    SCOPED_TRACE(clips);
    options.clip_files = {people / clips};
    ASSERT_EQ(Read(people / "quaternius-outfits/Male_Peasant.gltf", options), "");
    const Clip& walk = *FindClip(avatar_, "walk");
    Rig rig;
    std::string why;
    ASSERT_TRUE(MakeRig(avatar_, {}, &rig, &why)) << why;
    EXPECT_LT(FootSlide(avatar_, walk, avatar_.walk_speed_mps), 0.1f);
    EXPECT_LT(PastLimits(rig, walk), 0.1f);
  }
}

TEST_F(AvatarFile, ReadsRealPeople) {
  if (SharedData().empty()) GTEST_SKIP() << "the folder of real data is not there";
  const fs::path people = SharedData() / "avatars";
  ASSERT_EQ(Read(people / "khronos/CesiumMan.glb"), "");
  ExpectSoundAvatar(avatar_, 0.022f);
  EXPECT_EQ(TriangleCount(avatar_.meshes[0]), 4672);
  EXPECT_NE(std::find_if(warnings_.begin(), warnings_.end(),
                         [](const auto& w) { return w.find("210 vertices") != std::string::npos; }),
            warnings_.end());
  EXPECT_NEAR(avatar_.walk_speed_mps, 0.9f, 0.2f);

  ReadAvatarOptions options;
  options.hide = {"1H_Sword_Offhand", "Badge_Shield", "Rectangle_Shield", "Spike_Shield", "2H_Sword"};
  ASSERT_EQ(Read(people / "kaykit/Knight.glb", options), "");
  EXPECT_EQ(avatar_.meshes.size(), 1u) << "one a material";
  EXPECT_LT(TriangleCount(avatar_.meshes[0]), 6952);
  EXPECT_TRUE(avatar_.props.empty());
  const float height_m = avatar_.height_m;
  options.props = {"Round_Shield", "1H_Sword"};
  ASSERT_EQ(Read(people / "kaykit/Knight.glb", options), "");
  ASSERT_EQ(avatar_.props.size(), 2u);
  EXPECT_EQ(TriangleCount(avatar_.props[0].meshes[0]), 284);
  EXPECT_EQ(TriangleCount(avatar_.props[1].meshes[0]), 300);
  EXPECT_EQ(avatar_.props[0].meshes[0].material, avatar_.meshes[0].material) << "one picture for all";
  EXPECT_EQ(avatar_.height_m, height_m);
  EXPECT_EQ(avatar_.clips.size(), 2u);
  EXPECT_NEAR(FindClip(avatar_, "walk")->duration_s, 1.0667f, 0.001f) << "Walking_A";
  ASSERT_EQ(Read(people / "khronos/RiggedFigure.glb"), "");
  ExpectSoundAvatar(avatar_);
}

}  // namespace
}  // namespace flaneur
