#include "runtime/pack/read_avatar.h"

#include <algorithm>

#include "runtime/base/array.h"
#include "runtime/base/limits.h"
#include "runtime/pack/allowance.h"
#include "runtime/pack/read_clip.h"
#include "runtime/pack/read_impostor.h"

namespace flaneur {
namespace {

// Whoever cannot stand but walk: the joints' rest pose would stretch out the arms.
PackClip FirstFrame(const PackClip& clip, int joints) {
  PackClip still{0, 1, clip.matrices};
  still.matrices.resize(std::min(still.matrices.size(), static_cast<size_t>(joints)));
  return still;
}

Tint ReadTint(const GltfFile& file, const TourObject& json) {
  Tint tint;
  tint.color = json.Color("color");
  tint.reach = json.Real("reach", kMinTintReach, 1);
  tint.colors = json.Colors("colors");
  if (tint.colors.size() > kMaxTintColors) json.Refuse("has more than eight colors");
  if (json.Has("materials")) {
    const size_t materials = CountOf(file.json, "materials");
    tint.materials = json.Wholes("materials", 0, static_cast<double>(materials) - 1);
    tint.by_material = true;
    if (tint.materials.empty()) json.Refuse("may dye none of the materials");
  }
  return tint;
}

PackProp ReadProp(const GltfFile& file, int skin, const TourObject& json, MeshTable* meshes) {
  const Json& nodes = Member(file.json, "nodes");
  const Json& node = At(nodes, json.Whole("node", 0, static_cast<double>(nodes.size()) - 1));
  if (Index(node, "skin", Member(file.json, "skins").size()) != skin) json.Refuse("has another skin than the levels");
  PackProp prop;
  prop.name = json.Text("name");
  prop.mesh = meshes->Get(Index(node, "mesh", Member(file.json, "meshes").size()));
  prop.triangles = json.Whole("triangles", 1, 1e6);
  prop.share = json.Real("share", 0, 1);
  prop.slot = json.Text("slot");
  if (json.Has("clip")) prop.clip = json.Text("clip");
  return prop;
}

std::vector<PackOtherClip> ReadOtherClips(const GltfFile& file, const Skin& skin, const TourObject& avatar) {
  std::vector<PackOtherClip> clips;
  if (!avatar.Has("other_clips")) return clips;
  const double last = static_cast<double>(CountOf(file.json, "animations")) - 1;
  const std::vector<TourObject> objects = avatar.Objects("other_clips", kMaxOtherClips);
  for (const TourObject& c : objects) {
    clips.push_back({c.Text("name"), ReadClip(file, skin, c.Whole("animation", 0, last))});
    if (c.Has("seat_m")) clips.back().seat_m = c.Real("seat_m", 0, kMaxSeat_m);
    if (c.Has("speed_mps")) clips.back().speed_mps = c.Real("speed_mps", 0, kMaxRun_mps);
  }
  return clips;
}

}  // namespace

PackAvatar ReadAvatar(const GltfFile& file, const TourObject& json, MeshTable* meshes) {
  constexpr double kAboveZero = TourObject::kAboveZero, kAnything = TourObject::kAnything;
  PackAvatar avatar;
  avatar.name = json.Text("name");
  avatar.share = json.Real("share", 0, kMostShare);
  avatar.height_m = json.Real("height_m", kLeastPerson_m, kMostPerson_m);
  avatar.radius_m = json.Real("radius_m", kAboveZero, kMostPersonRadius_m);
  avatar.reach_m = json.Has("reach_m") ? json.Real("reach_m", kAboveZero, kMostReach_m) : 0;
  avatar.walk_speed_mps = json.Real("walk_speed_mps", kAboveZero, kMostWalk_mps);
  if (json.Has("height_spread")) avatar.height_spread = json.Real("height_spread", 0, kMaxHeightSpread);
  if (json.Has("breadth_spread")) avatar.breadth_spread = json.Real("breadth_spread", 0, kMaxBreadthSpread);
  const Json& nodes = Member(file.json, "nodes");
  int skin_index = -1;
  for (const TourObject& level_json : json.Objects("levels", kMostLevels)) {
    const Json& node = At(nodes, level_json.Whole("node", 0, static_cast<double>(nodes.size()) - 1));
    PackLevel level;
    level.mesh = meshes->Get(Index(node, "mesh", Member(file.json, "meshes").size()));
    level.triangles = level_json.Whole("triangles", 1, 1e9);
    level.error_mm = level_json.Real("error_mm", 0, kAnything);
    level.posed_error_mm = level_json.Real("posed_error_mm", 0, kAnything);
    level.switch_px = level_json.Real("switch_px", 0, kAnything);
    const int level_skin = Index(node, "skin", Member(file.json, "skins").size());
    if (skin_index >= 0 && level_skin != skin_index) level_json.Refuse("has another skin than the level before");
    skin_index = level_skin;
    avatar.levels.push_back(level);
  }
  if (avatar.levels.empty()) json.Refuse("has no levels");
  const Skin skin = ReadSkin(file, skin_index);
  avatar.joints = Count(skin.joints);
  avatar.skeleton = ReadSkeleton(file, skin);
  const double last = static_cast<double>(CountOf(file.json, "animations")) - 1;
  const TourObject clips = json.Object("clips");
  const auto clip = [&](const char* name) { return ReadClip(file, skin, clips.Whole(name, -1, last)); };
  avatar.walk = clip("walk");
  avatar.idle = clips.Has("idle") ? clip("idle") : FirstFrame(avatar.walk, avatar.joints);
  avatar.talk = clips.Has("talk") ? clip("talk") : avatar.idle;
  avatar.other_clips = ReadOtherClips(file, skin, json);
  avatar.impostor = ReadImpostor(file, json.Object("impostor"));
  if (json.Has("props")) {
    for (const TourObject& prop : json.Objects("props", kMaxProps))
      avatar.props.push_back(ReadProp(file, skin_index, prop, meshes));
  }
  if (json.Has("tints")) {
    for (const TourObject& tint : json.Objects("tints", kMaxTints)) avatar.tints.push_back(ReadTint(file, tint));
  }
  return avatar;
}

void CheckJoints(const PackPrimitive& primitive, int joints) {
  for (const auto& four : primitive.joints) {
    for (uint16_t j : four) {
      if (j >= joints) throw PackRefused("has a joint index beyond its skin");
    }
  }
}

void BindTints(const PackAvatar& avatar, const std::vector<PackMesh>& meshes, Allowance* allowance,
               std::vector<PackMaterial>* materials) {
  for (size_t t = 0; t < avatar.tints.size(); ++t) {
    const std::vector<int>& dyed = avatar.tints[t].materials;
    if (dyed.empty()) continue;
    for (const PackLevel& level : avatar.levels) {
      allowance->TakeWork(Product(At(meshes, level.mesh).primitives.size(), dyed.size()), "a tint's materials");
      for (const PackPrimitive& primitive : At(meshes, level.mesh).primitives) {
        if (primitive.material < 0 || std::find(dyed.begin(), dyed.end(), primitive.material) != dyed.end()) continue;
        uint8_t& tints = At(*materials, primitive.material).tints;
        tints = static_cast<uint8_t>(tints & ~(1u << t));
      }
    }
  }
}

}  // namespace flaneur
