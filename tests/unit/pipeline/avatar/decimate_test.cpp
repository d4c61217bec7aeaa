#include "pipeline/avatar/decimate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "pipeline/avatar/surface_distance.h"
#include "pipeline/avatar/wedge_surface.h"
#include "pipeline/io/gltf.h"
#include "tests/unit/pipeline/test_person.h"

namespace flaneur {
namespace {

int Triangles(const std::vector<Mesh>& meshes) {
  int count = 0;
  for (const Mesh& mesh : meshes) count += TriangleCount(mesh);
  return count;
}

// What holds for the levels of any person.
void ExpectSoundLevels(const Avatar& avatar, const AvatarLevels& levels) {
  for (size_t k = 0; k < levels.levels.size(); ++k) {
    const AvatarLevel& level = levels.levels[k];
    EXPECT_EQ(level.triangles, Triangles(level.meshes));
    ASSERT_EQ(level.meshes.size(), avatar.meshes.size());
    if (k > 0) {
      EXPECT_LE(level.switch_px, levels.levels[k - 1].switch_px);
    }
    for (size_t m = 0; m < level.meshes.size(); ++m) {
      const Mesh& mesh = level.meshes[m];
      EXPECT_EQ(mesh.material, avatar.meshes[m].material);
      ASSERT_EQ(mesh.weights.size(), mesh.positions.size());
      for (size_t v = 0; v < mesh.weights.size(); ++v) {
        const auto& w = mesh.weights[v];
        EXPECT_NEAR(w[0] + w[1] + w[2] + w[3], 1, 1e-4f);
        for (const uint16_t joint : mesh.joints[v]) EXPECT_LT(joint, avatar.joints.size());
      }
      for (const uint32_t i : mesh.indices) ASSERT_LT(i, mesh.positions.size());
    }
  }
  EXPECT_EQ(levels.levels.back().switch_px, 0);
}

TEST(BuildLevels, HitsItsTargetsAndMeasuresThem) {
  const Avatar avatar = MadePerson();
  const int original = Triangles(avatar.meshes);
  LevelsOptions options;
  options.ratios = {1, 0.5f, 0.25f, 0.1f};
  AvatarLevels levels;
  std::vector<std::string> warnings;
  ASSERT_EQ(BuildLevels(avatar, options, &levels, &warnings).message, "");
  EXPECT_TRUE(warnings.empty());
  ASSERT_EQ(levels.levels.size(), 4u);
  EXPECT_EQ(levels.levels[0].triangles, original);
  EXPECT_EQ(levels.levels[0].error_mm, 0);
  for (size_t k = 1; k < 4; ++k) {
    const float target = std::max(options.ratios[k] * static_cast<float>(original), 200.0f);
    EXPECT_NEAR(static_cast<float>(levels.levels[k].triangles), target, 0.02f * target + 2);
    // Round tubes lose little: the section of 16 corners can always become one of 8.
    EXPECT_LT(levels.levels[k].error_mm, 80);
  }
  ExpectSoundLevels(avatar, levels);
}

TEST(BuildLevels, SwitchesWhereTheNextErrorIsAPixel) {
  const Avatar avatar = MadePerson();
  LevelsOptions options;
  options.ratios = {1, 0.02f};  // tubes of so few triangles are no longer round
  options.min_triangles = 20;
  AvatarLevels levels;
  std::vector<std::string> warnings;
  ASSERT_EQ(BuildLevels(avatar, options, &levels, &warnings).message, "");
  const AvatarLevel& last = levels.levels.back();
  const float error_mm = std::max(last.error_mm, last.posed_error_mm);
  ASSERT_GT(error_mm, 0);
  EXPECT_NEAR(levels.levels[levels.levels.size() - 2].switch_px * error_mm, 1800, 1);
}

Avatar PersonWithoutBody() {
  Avatar avatar = MadePerson();
  avatar.meshes[0] = {};
  avatar.meshes[0].name = "body";
  avatar.meshes[0].material = 0;
  return avatar;
}

// The chain that makes itself.
AvatarLevels ChainOf(const Avatar& avatar) {
  AvatarLevels levels;
  std::vector<std::string> warnings;
  EXPECT_EQ(BuildLevels(avatar, {}, &levels, &warnings).message, "");
  return levels;
}

// For tubes of so many rings: 96 triangles a ring.
AvatarLevels OwnChain(int rings) {
  Avatar avatar = PersonWithoutBody();
  Mesh& mesh = avatar.meshes[0];
  AddTube(0, 0.9f, 1.8f, 0.2f, rings, 0, &mesh);
  AddTube(0.1f, 0, 0.9f, 0.08f, rings, 1, &mesh);
  AddTube(-0.1f, 0, 0.9f, 0.08f, rings, 2, &mesh);
  const AvatarLevels levels = ChainOf(avatar);
  ExpectSoundLevels(avatar, levels);
  return levels;
}

TEST(BuildLevels, MakesAsManyLevelsAsTheErrorsAskFor) {
  // Rings of straight tubes are worth nothing: whatever their number, one level without most of
  // them serves every size on screen, and the few triangles of the last serve no one any better.
  const AvatarLevels few = OwnChain(4), many = OwnChain(300);
  EXPECT_EQ(few.levels.size(), 1u);
  ASSERT_GE(many.levels.size(), 2u);
  EXPECT_LT(many.levels[1].triangles, many.levels[0].triangles / 9);
  for (size_t k = 1; k < many.levels.size(); ++k) {
    EXPECT_GT(many.levels[k].triangles, 240);
    EXPECT_LT(many.levels[k].triangles, many.levels[k - 1].triangles);
  }
}

// A dome's levels lose a little of its shape each: 0.4 m wide on a person of 1.8 m, of 2 n^2 triangles.
AvatarLevels DomesChain(int n) {
  Avatar avatar = PersonWithoutBody();
  Mesh& mesh = avatar.meshes[0];
  for (int k = 0; k < (n + 1) * (n + 1); ++k) {
    const float x = static_cast<float>(k % (n + 1)) / static_cast<float>(n),
                y = static_cast<float>(k / (n + 1)) / static_cast<float>(n);
    const Vec3 p{0.4f * (x - 0.5f), 0.4f * (y - 0.5f),
                 0.15f * std::cos(7 * kPi * (x - 0.5f)) * std::cos(7 * kPi * (y - 0.5f))};
    mesh.positions.push_back(p + Vec3{0, 0.9f, 0});
    const float a = 7 * kPi * (x - 0.5f), b = 7 * kPi * (y - 0.5f), slope = 0.15f * 7 * kPi / 0.4f;
    mesh.normals.push_back(Normalized(Vec3{slope * std::sin(a) * std::cos(b), slope * std::cos(a) * std::sin(b), 1}));
    mesh.joints.push_back({});
    mesh.weights.push_back({1, 0, 0, 0});
  }
  for (uint32_t k = 0; k < static_cast<uint32_t>(n * n); ++k) {
    const auto width = static_cast<uint32_t>(n);
    const uint32_t a = k / width * (width + 1) + k % width;
    mesh.indices.insert(mesh.indices.end(), {a, a + 1, a + width + 2, a, a + width + 2, a + width + 1});
  }
  return ChainOf(avatar);
}

TEST(BuildLevels, MakesNoLevelForSizesThatImpostorsHave) {
  const AvatarLevels levels = DomesChain(50);
  ASSERT_GE(levels.levels.size(), 3u);
  for (size_t k = 1; k + 1 < levels.levels.size(); ++k) EXPECT_GT(levels.levels[k].switch_px, 64) << "level " << k + 1;
}

TEST(BuildLevels, ShowsNoLevelLargeWhoseLightLooksUnlikeTheOriginals) {
  const AvatarLevels levels = DomesChain(50);
  ASSERT_GE(levels.levels.size(), 3u);
  EXPECT_GT(levels.levels.back().normal_deg, 2.5f);
  for (size_t k = 1; k < levels.levels.size(); ++k) {
    EXPECT_GT(levels.levels[k].normal_deg, levels.levels[k - 1].normal_deg);
    if (levels.levels[k].normal_deg > 2.5f) {
      EXPECT_LE(levels.levels[k - 1].switch_px, 128) << "level " << k;
    }
  }
}

TEST(BuildLevels, SwitchesNearerWhereMorePixelsMayShow) {
  const Avatar avatar = MadePerson();
  LevelsOptions fine, coarse;
  fine.ratios = coarse.ratios = {1, 0.02f};
  coarse.error_px = 2;
  AvatarLevels a, b;
  std::vector<std::string> warnings;
  ASSERT_EQ(BuildLevels(avatar, fine, &a, &warnings).message, "");
  ASSERT_EQ(BuildLevels(avatar, coarse, &b, &warnings).message, "");
  EXPECT_NEAR(b.levels[0].switch_px, 2 * a.levels[0].switch_px, 0.01f * b.levels[0].switch_px);
}

TEST(BuildLevels, LimitsTheFinestLevel) {
  const Avatar avatar = MadePerson();
  LevelsOptions options;
  options.max_triangles = 1000;
  AvatarLevels levels;
  std::vector<std::string> warnings;
  ASSERT_EQ(BuildLevels(avatar, options, &levels, &warnings).message, "");
  EXPECT_NEAR(levels.levels[0].triangles, 1000, 20);
  EXPECT_EQ(Triangles(levels.avatar.meshes), levels.levels[0].triangles);
}

TEST(BuildLevels, RefusesNonsenseByName) {
  AvatarLevels levels;
  std::vector<std::string> warnings;
  Avatar avatar = MadePerson();
  avatar.meshes[0].positions[7].y = std::numeric_limits<float>::quiet_NaN();
  const Error broken = BuildLevels(avatar, {}, &levels, &warnings);
  EXPECT_NE(broken.message.find("body"), std::string::npos) << broken.message;
  EXPECT_NE(broken.message.find("7"), std::string::npos) << broken.message;
  avatar = MadePerson();
  avatar.meshes.clear();
  EXPECT_TRUE(BuildLevels(avatar, {}, &levels, &warnings));
  LevelsOptions rising;
  rising.ratios = {0.5f, 0.7f};
  EXPECT_TRUE(BuildLevels(MadePerson(), rising, &levels, &warnings));
}

// Three leaves on one edge: no two-sided surface, but every leaf must stay, and stay joined.
TEST(JoinWedges, LosesNoFaceAtACrossedEdge) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 0, 1}};
  mesh.indices = {0, 1, 2, 0, 1, 3, 0, 1, 4};
  const WedgeSurface surface = JoinWedges({mesh});
  EXPECT_EQ(surface.faces.size(), 3u);
  EXPECT_EQ(surface.vertices.size(), 5u);
}

// Coats lie on bodies: what only touches in the bind pose must not be sewn together.
TEST(JoinWedges, KeepsApartWhatMovesApart) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {0, -1, 0}};
  mesh.joints.assign(6, {0, 0, 0, 0});
  for (size_t v = 3; v < 6; ++v) mesh.joints[v][0] = 1;
  mesh.weights.assign(6, {1, 0, 0, 0});
  mesh.indices = {0, 1, 2, 4, 3, 5};
  const std::vector<Mat4> still(2), moved{Mat4{}, Moved({0, -0.1f, 0})};
  EXPECT_EQ(JoinWedges({mesh}, {still}).vertices.size(), 4u);
  EXPECT_EQ(JoinWedges({mesh}, {moved}).vertices.size(), 6u);
}

TEST(JoinWedges, JoinsAcrossUvSeamsAndMaterials) {
  Mesh a, b;
  a.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  b.positions = {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  a.indices = b.indices = {0, 1, 2};
  const WedgeSurface surface = JoinWedges({a, b});
  EXPECT_EQ(surface.wedges.size(), 6u);
  EXPECT_EQ(surface.vertices.size(), 4u);
}

TEST(SurfaceTree, AgreesWithAPlainSearchOfKnownDistances) {
  const Avatar avatar = MadePerson();
  const Mesh& mesh = avatar.meshes[0];
  std::vector<std::array<Vec3, 3>> triangles;
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    triangles.push_back(
        {mesh.positions[mesh.indices[i]], mesh.positions[mesh.indices[i + 1]], mesh.positions[mesh.indices[i + 2]]});
  }
  const SurfaceTree tree(triangles);
  for (const Vec3 p : mesh.positions) EXPECT_NEAR(tree.Distance(p), 0, 1e-5f);
  // Far beside the trunk the nearest point is its wall.
  EXPECT_NEAR(tree.Distance({1.2f, 1.4f, 0}), 1.0f, 1e-4f);
  EXPECT_NEAR(tree.Distance({0.2f, 2.8f, 0}), 1.0f, 1e-4f);
}

// Every bit of what a level is drawn by.
std::vector<uint8_t> BytesOf(const AvatarLevels& levels) {
  std::vector<uint8_t> bytes;
  const auto add = [&](const auto& values) {
    const auto* first = reinterpret_cast<const uint8_t*>(values.data());
    bytes.insert(bytes.end(), first, first + values.size() * sizeof values[0]);
  };
  for (const AvatarLevel& level : levels.levels) {
    add(std::array{level.error_mm, level.posed_error_mm, level.normal_deg, level.switch_px});
    for (const Mesh& mesh : level.meshes) {
      add(mesh.positions);
      add(mesh.normals);
      add(mesh.uvs);
      add(mesh.colors);
      add(mesh.joints);
      add(mesh.weights);
      add(mesh.indices);
    }
  }
  return bytes;
}

TEST(BuildLevels, AreTheSameOnAnyNumberOfThreads) {
  Avatar avatar = MadePerson();
  std::vector<std::string> warnings;
  if (!SharedData().empty()) {
    const auto man = SharedData() / "avatars/khronos/CesiumMan.glb";
    ASSERT_EQ(ReadAvatar(man, {}, &avatar, &warnings).message, "");
  }
  std::vector<uint8_t> first;
  for (const size_t threads : {0, 1, 2, 6}) {
    Jobs jobs(threads);
    LevelsOptions options;
    options.jobs = &jobs;
    AvatarLevels levels;
    EXPECT_EQ(BuildLevels(avatar, options, &levels, &warnings).message, "");
    if (first.empty()) first = BytesOf(levels);
    EXPECT_EQ(BytesOf(levels), first) << threads;
  }
}

TEST(BuildLevels, PropsKeepTheirJointsAndHaveFewTriangles) {
  if (SharedData().empty()) GTEST_SKIP() << "the folder of real data is not there";
  Avatar avatar;
  std::vector<std::string> warnings;
  ReadAvatarOptions read;
  read.props = {"Spike_Shield", "Knight_Helmet", "Round_Shield"};
  ASSERT_EQ(ReadAvatar(SharedData() / "avatars/kaykit/Knight.glb", read, &avatar, &warnings).message, "");
  const auto joint_of = [](const Avatar& a, size_t prop) {
    return a.joints[a.props[prop].meshes[0].joints[0][0]].name;
  };
  AvatarLevels levels;
  ASSERT_EQ(BuildLevels(avatar, {}, &levels, &warnings).message, "");
  ASSERT_EQ(levels.avatar.props.size(), 3u);
  for (size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(joint_of(levels.avatar, k), joint_of(avatar, k));
    EXPECT_LE(Triangles(levels.avatar.props[k].meshes), 306);
    EXPECT_GE(Triangles(levels.avatar.props[k].meshes), 280);
  }
  EXPECT_EQ(Triangles(levels.levels[0].meshes), Triangles(avatar.meshes)) << "they are in no level";
}

TEST(BuildLevels, HandlesRealPeople) {
  if (SharedData().empty()) GTEST_SKIP() << "the folder of real data is not there";
  for (const char* file : {"kaykit/Knight.glb", "kaykit/Mage.glb", "khronos/CesiumMan.glb"}) {
    SCOPED_TRACE(file);
    Avatar avatar;
    std::vector<std::string> warnings;
    ASSERT_EQ(ReadAvatar(SharedData() / "avatars" / file, {}, &avatar, &warnings).message, "");
    const int original = Triangles(avatar.meshes);
    AvatarLevels levels;
    warnings.clear();
    LevelsOptions options;
    options.ratios = {1, 0.5f, 0.25f, 0.1f};
    options.walk_poses = 2;
    ASSERT_EQ(BuildLevels(avatar, options, &levels, &warnings).message, "");
    EXPECT_TRUE(warnings.empty());
    ASSERT_EQ(levels.levels.size(), 4u);
    for (size_t k = 0; k < 4; ++k) {
      const float target = options.ratios[k] * static_cast<float>(original);
      EXPECT_NEAR(static_cast<float>(levels.levels[k].triangles), target, 0.02f * target);
    }
    ExpectSoundLevels(avatar, levels);
  }
}

}  // namespace
}  // namespace flaneur
