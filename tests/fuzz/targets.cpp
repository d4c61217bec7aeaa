#include "tests/fuzz/targets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <exception>
#include <vector>

#include "pipeline/io/basis_picture.h"
#include "pipeline/io/describe_file.h"
#include "pipeline/io/geojson.h"
#include "pipeline/io/gltf.h"
#include "pipeline/io/motion_reader.h"
#include "pipeline/io/scene_reader.h"
#include "pipeline/rig/clip_loop.h"
#include "pipeline/rig/clip_rig.h"
#include "pipeline/rig/retarget.h"
#include "runtime/base/limits.h"
#include "runtime/base/pixels.h"
#include "runtime/desktop/sound.h"
#include "runtime/pack/gltf_file.h"
#include "runtime/pack/ktx2.h"
#include "runtime/pack/meshopt_view.h"
#include "runtime/pack/title_page.h"
#include "runtime/pack/tour_pack.h"
#include "runtime/simulation/scenario.h"
#include "runtime/simulation/simulation.h"

namespace flaneur::fuzz {
namespace {

using Bytes = std::span<const uint8_t>;
constexpr int kMostPeopleHere = 20, kSteps = 3;

bool IsOneLine(const std::string& text) {
  return !text.empty() && std::none_of(text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; });
}

std::string Refused(const Error& error) {
  if (!IsOneLine(error.message)) return "not one line: " + error.message;
  if (error.message.size() > 3 * kMostMessage_bytes) return "a message of " + std::to_string(error.message.size());
  if (error.message.ends_with("there is not enough memory for it")) return "asked for all memory: " + error.message;
  return {};
}

std::string Unsound(const PackMesh& mesh) {
  for (const PackPrimitive& p : mesh.primitives) {
    if (p.indices.size() % 3 != 0) return "corners that make no triangles";
    for (const uint32_t i : p.indices) {
      if (i >= p.positions.size()) return "a vertex that is none";
    }
  }
  return {};
}

// Few people, a few steps: what the player does before the first picture.
std::string Play(const TourPack* pack, Scenario scenario) {
  scenario.crowd.people = std::min(scenario.crowd.people, kMostPeopleHere);
  if (scenario.persons.size() > static_cast<size_t>(kMostPeopleHere)) scenario.persons.resize(kMostPeopleHere);
  Simulation simulation;
  if (const Error e = StartSimulation(pack, scenario, &simulation)) return Refused(e);
  for (int step = 0; step < kSteps; ++step) StepSimulation({}, FrameTimeByModel_ms(simulation), &simulation);
  for (const Vec2 p : simulation.town.crowd.position) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) return "a person who is nowhere";
  }
  return {};
}

std::string ReadBulk(const PackFile& file, const TourPack& pack) {
  for (size_t i = 0; i < pack.images.size(); ++i) {
    PackImage image;
    if (const Error e = file.ReadImage(static_cast<int>(i), &image)) {
      if (std::string fault = Refused(e); !fault.empty()) return fault;
    }
  }
  for (size_t m = 0; m < pack.meshes.size(); ++m) {
    PackMesh mesh;
    const Error e = file.ReadMesh(static_cast<int>(m), &mesh);
    if (std::string fault = e ? Refused(e) : Unsound(mesh); !fault.empty()) return fault;
  }
  for (size_t a = 0; a < pack.avatars.size(); ++a) {
    PackImpostor atlas;
    if (const Error e = file.ReadAtlas(static_cast<int>(a), &atlas)) {
      if (std::string fault = Refused(e); !fault.empty()) return fault;
    }
  }
  return {};
}

std::string TryPack(const std::filesystem::path& path, Bytes bytes) {
  PackTitle title;
  ReadPackTitle(path, "en", &title);
  PackFile file;
  TourPack pack;
  if (const Error e = file.Open(std::vector<uint8_t>(bytes.begin(), bytes.end()), "input", &pack)) return Refused(e);
  if (std::string fault = ReadBulk(file, pack); !fault.empty()) return fault;
  return Play(&pack, ScenarioOf(pack));
}

std::string TryKtx2(const std::filesystem::path&, Bytes bytes) {
  PackTexture texture;
  if (const Error e = ReadKtx2(bytes, &texture)) return Refused(e);
  int width_px = texture.width_px, height_px = texture.height_px;
  for (const std::vector<uint8_t>& level : texture.levels) {
    const size_t texels = static_cast<size_t>(width_px) * static_cast<size_t>(height_px);
    if (DecodeLevel(texture.format, width_px, height_px, level).size() % texels != 0) return "a level of another size";
    width_px = std::max(1, width_px / 2), height_px = std::max(1, height_px / 2);
  }
  return {};
}

std::string TryBasis(const std::filesystem::path&, Bytes bytes) {
  Pixels pixels;
  if (const Error e = DecodeBasisPicture(bytes, kFreePixels, &pixels)) return Refused(e);
  const size_t texels = static_cast<size_t>(pixels.width) * static_cast<size_t>(pixels.height);
  return pixels.rgba.size() == 4 * texels ? "" : "another size than it says";
}

// Count, stride and filter stand in its first eight bytes.
std::string TryMeshopt(const std::filesystem::path&, Bytes bytes) {
  if (bytes.size() < 8) return {};
  uint32_t count = 0;
  std::memcpy(&count, bytes.data(), 4);
  static const char* const kFilters[] = {"NONE", "QUATERNION", "EXPONENTIAL", "OTHER"};
  try {
    const auto out = DecodeMeshoptView(bytes.subspan(8), count, bytes[4], kFilters[bytes[5] % 4]);
    return out.size() == size_t{count} * bytes[4] ? "" : "another number of elements";
  } catch (const PackRefused&) {
    return {};
  }
}

std::string TryScene(const std::filesystem::path& path, Bytes) {
  Scene scene;
  std::vector<std::string> warnings;
  if (const Error e = ReadScene(path, &scene, &warnings)) return Refused(e);
  for (const std::string& warning : warnings) {
    if (!IsOneLine(warning)) return "a warning is not one line: " + warning;
  }
  for (const SceneNode& node : scene.nodes) {
    if (node.parent >= static_cast<int>(scene.nodes.size())) return "a parent that is none";
    for (const int mesh : node.meshes) {
      if (mesh < 0 || mesh >= static_cast<int>(scene.meshes.size())) return "a mesh that is none";
    }
  }
  for (const Mesh& mesh : scene.meshes) {
    for (const uint32_t i : mesh.indices) {
      if (i >= mesh.positions.size()) return "a vertex that is none";
    }
  }
  return {};
}

std::string TryAvatar(const std::filesystem::path& path, Bytes) {
  Avatar avatar;
  std::vector<std::string> warnings;
  if (const Error e = ReadAvatar(path, {}, &avatar, &warnings)) return Refused(e);
  for (const Mesh& mesh : avatar.meshes) {
    for (const auto& four : mesh.joints) {
      for (const uint16_t joint : four) {
        if (joint >= avatar.joints.size()) return "a joint that is none";
      }
    }
  }
  return {};
}

std::string TryModel(const std::filesystem::path& path, Bytes bytes) {
  std::string fault = TryScene(path, bytes);
  return fault.empty() ? TryAvatar(path, bytes) : fault;
}

const Rig& ShippedRig() {
  static const Rig rig = [] {
    MotionFile motion;
    Rig made;
    std::string why;
    if (!OpenSkeleton(ShippedClips(), &motion)) MakeRig(motion.skeleton, motion.told, &made, &why);
    return made;
  }();
  return rig;
}

// What a file of clips is used for: told of, cut to a stride, made to fit another skeleton.
std::string TryMotion(const std::filesystem::path& path, Bytes) {
  std::string text;
  if (const Error e = DescribePersonFile(path, &text)) return Refused(e);
  MotionFile motion;
  if (const Error e = OpenMotion(path, &motion)) return Refused(e);
  for (size_t i = 0; i < std::min<size_t>(3, motion.clip_names.size()); ++i) {
    Clip clip;
    if (const Error e = ClipOf(motion, i, &clip)) return Refused(e);
    const std::vector<Joint>& joints = motion.skeleton.joints;
    CutToCycle(joints, &clip);
    if (clip.transforms.size() != joints.size() * static_cast<size_t>(clip.keys)) return "keys that lack joints";
    Rig source;
    std::string why;
    if (!MakeClipRig(motion.skeleton, motion.told, clip, &source, &why)) continue;
    const Retargeted made = Retarget(source, clip, ShippedRig());
    if (made.clip.transforms.size() % static_cast<size_t>(std::max(1, made.clip.keys)) != 0)
      return "fitted keys that lack joints";
  }
  return {};
}

std::string TryGeoJson(const std::filesystem::path& path, Bytes) {
  GeoJsonFile file;
  if (const Error e = ReadGeoJson(path, {}, &file)) return Refused(e);
  return {};
}

std::string TryScenario(const std::filesystem::path& path, Bytes) {
  Scenario scenario;
  if (const Error e = ReadScenario(path, &scenario)) return Refused(e);
  return scenario.has_ground ? Play(nullptr, std::move(scenario)) : "";
}

std::string TryPicture(const std::filesystem::path&, Bytes bytes) {
  const auto size = DecodedSize(bytes);
  if (!size || size->width > 4096 || size->height > 4096) return {};
  const auto pixels = Decoded(bytes);
  const auto count = static_cast<size_t>(size->width) * static_cast<size_t>(size->height);
  return pixels && pixels->rgba.size() != 4 * count ? "another size than it says" : "";
}

std::string TrySound(const std::filesystem::path&, Bytes bytes) {
  const Sound sound = DecodeSound({bytes.begin(), bytes.end()});
  return sound.samples.empty() || sound.rate_hz > 0 ? "" : "a sound without a rate";
}

constexpr std::array kTargets{
    Target{"pack", "glb", Structure::kGlb, {}, TryPack},
    Target{"ktx2", "ktx2", Structure::kBytes, {}, TryKtx2},
    Target{
        "basis",
        "ktx2",
        Structure::kBytes,
        {"tests/data/basis/etc1s_alpha.ktx2", "tests/data/basis/uastc.ktx2", "tests/data/basis/uastc_zstd_alpha.ktx2"},
        TryBasis},
    Target{"meshopt", "bin", Structure::kBytes, {}, TryMeshopt},
    Target{"model", "glb", Structure::kGlb, {"tests/data/towns/street.glb"}, TryModel},
    Target{
        "gltf", "gltf", Structure::kJson, {"tests/data/check/601.gltf", "tests/data/towns/instances.gltf"}, TryModel},
    Target{"bvh", "bvh", Structure::kText, {}, TryMotion},
    Target{"clips", "gltf", Structure::kJson, {}, TryMotion},
    Target{"citygml", "gml", Structure::kText, {"tests/data/towns/houses.gml"}, TryScene},
    Target{"cityjson",
           "city.json",
           Structure::kJson,
           {"tests/data/towns/houses.city.json", "tests/data/towns/houses.city.jsonl"},
           TryScene},
    Target{"obj", "obj", Structure::kText, {"tests/data/towns/houses.obj"}, TryScene},
    Target{"ply",
           "ply",
           Structure::kBytes,
           {"tests/data/towns/houses.ply", "tests/data/towns/houses_big_endian.ply"},
           TryScene},
    Target{"stl", "stl", Structure::kBytes, {"tests/data/towns/houses.stl"}, TryScene},
    Target{"geojson",
           "geojson",
           Structure::kJson,
           {"tests/data/check/sound.geojson", "tests/data/check/203.geojson", "tests/data/check/504.geojson"},
           TryGeoJson},
    Target{"scenario",
           "toml",
           Structure::kText,
           {"tests/scenario/classic/bottleneck.toml", "tests/scenario/sprint-market.toml",
            "tests/scenario/classic/evacuation.toml"},
           TryScenario},
    Target{"picture", "png", Structure::kBytes, {}, TryPicture},
    Target{"sound", "ogg", Structure::kBytes, {}, TrySound}};

}  // namespace

std::span<const Target> Targets() { return kTargets; }

const Target* TargetNamed(const std::string& name) {
  const auto* const found =
      std::find_if(kTargets.begin(), kTargets.end(), [&](const Target& target) { return name == target.name; });
  return found != kTargets.end() ? found : nullptr;
}

}  // namespace flaneur::fuzz
