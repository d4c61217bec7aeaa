#include "pipeline/pack/write_tour_pack.h"

#include <utility>

#include "pipeline/core/reach.h"
#include "pipeline/pack/tour_json.h"
#include "runtime/base/file.h"

namespace flaneur {
namespace {

Error AddTown(const EncodedTown& town, GltfBuilder* builder) {
  const std::vector<int> materials = builder->AddMaterials(town.materials, town.images);
  std::vector<int> meshes(town.meshes.size(), -1), roots;
  for (const EncodedTown::Node& node : town.nodes) {
    int& mesh = meshes[node.mesh];
    if (mesh < 0) {
      if (Error e = builder->AddMesh(node.name, town.meshes[node.mesh], materials, &mesh)) return e;
    }
    GltfNode out;
    out.name = node.name;
    out.mesh = mesh;
    out.transform = node.transform;
    out.extras = node.extras;
    roots.push_back(builder->AddNode(out));
  }
  builder->AddScene("town", roots);
  return Ok();
}

ImpostorViews AddImpostor(const ImpostorAtlas& atlas, GltfBuilder* builder) {
  std::vector<int16_t> cells;
  for (const ImpostorCell& c : atlas.cells) {
    for (int number : {c.x, c.y, c.width, c.height, c.origin_x, c.origin_y})
      cells.push_back(static_cast<int16_t>(number));
  }
  ImpostorViews views;
  views.cells =
      builder->AddBufferView({reinterpret_cast<const uint8_t*>(cells.data()), cells.size() * sizeof(int16_t)});
  views.albedo = builder->AddBufferView(atlas.albedo_ktx2);
  views.normal = builder->AddBufferView(atlas.normal_ktx2);
  views.depth = builder->AddBufferView(atlas.depth_ktx2);
  views.motion = builder->AddBufferView(atlas.motion_ktx2);
  if (atlas.tint_regions) views.tints = builder->AddBufferView(atlas.tints_ktx2);
  return views;
}

Error AddAvatars(const TourParts& parts, GltfBuilder* builder, TourIndices* indices) {
  for (const TourAvatar& avatar : parts.avatars) {
    const std::string& name = avatar.levels.avatar.name;
    AvatarPart part;
    if (Error e = AddAvatar(builder, avatar.levels, avatar.encoded, name + "_", &part)) return e;
    std::vector<int> roots{part.skeleton_node, part.level_nodes.front()};
    roots.insert(roots.end(), part.prop_nodes.begin(), part.prop_nodes.end());
    builder->AddScene(name, roots);
    indices->avatars.push_back(std::move(part));
    indices->impostors.push_back(AddImpostor(avatar.impostor, builder));
  }
  return Ok();
}

// By prop the clip that it is for.
std::vector<std::string> ToolsOf(const TourAvatar& avatar) {
  std::vector<std::string> clips;
  for (const Prop& prop : avatar.props) clips.push_back(prop.clip);
  return clips;
}

// As it stands on the disk.
Error CheckPlayerTakes(const std::filesystem::path& path) {
  FileBytes bytes;
  if (Error e = ReadFile(path, &bytes)) return e;
  TourPack pack;
  const Error refused = PackFile().Open(std::move(bytes), path.filename().string(), &pack);
  return refused ? Fail("a pack that the player refuses came of this tour: " + refused.message) : Ok();
}

}  // namespace

Error EncodeTourAvatar(TourAvatar* avatar, Jobs* jobs) {
  const AvatarLevels& levels = avatar->levels;
  avatar->reach_m = Reach_m(levels, ToolsOf(*avatar));
  avatar->prop_triangles.clear();
  for (const AvatarProp& prop : levels.avatar.props) avatar->prop_triangles.push_back(TriangleCount(prop.meshes));
  return EncodeAvatar(levels, DracoOptions{}, jobs, &avatar->encoded);
}

TourAvatar WithoutBulk(const TourAvatar& avatar) {
  TourAvatar light;
  light.share = avatar.share;
  light.tints = avatar.tints;
  light.props = avatar.props;
  light.clips = avatar.clips;
  light.height_spread = avatar.height_spread;
  light.breadth_spread = avatar.breadth_spread;
  light.reach_m = avatar.reach_m;
  light.prop_triangles = avatar.prop_triangles;
  const Avatar& person = avatar.levels.avatar;
  light.levels.avatar.name = person.name;
  light.levels.avatar.materials = person.materials;
  light.levels.avatar.height_m = person.height_m;
  light.levels.avatar.radius_m = person.radius_m;
  light.levels.avatar.walk_speed_mps = person.walk_speed_mps;
  for (const Clip& clip : person.clips)
    light.levels.avatar.clips.push_back({clip.name, clip.duration_s, clip.keys, {}});
  for (const AvatarProp& prop : person.props) light.levels.avatar.props.push_back({prop.name, {}});
  for (const AvatarLevel& level : avatar.levels.levels) {
    light.levels.levels.push_back(
        {{}, level.triangles, level.error_mm, level.posed_error_mm, level.normal_deg, level.joints, level.switch_px});
  }
  static_cast<ImpostorLayout&>(light.impostor) = avatar.impostor;
  light.impostor.cells.clear();
  light.impostor.tint_regions = avatar.impostor.tint_regions;
  return light;
}

Error BuildModels(const TourParts& parts, TourModels* models) {
  GltfBuilder builder;
  TourIndices& indices = models->indices = {};
  // First in the file, as they are read first.
  if (!parts.title_page.picture.empty()) indices.title_picture_view = builder.AddBufferView(parts.title_page.picture);
  if (!parts.title_page.logo.empty()) indices.title_logo_view = builder.AddBufferView(parts.title_page.logo);
  if (Error e = AddTown(parts.encoded_town, &builder)) return e;
  if (Error e = AddAvatars(parts, &builder, &indices)) return e;
  const auto& heights = parts.ground.height_m;
  indices.height_view =
      builder.AddBufferView({reinterpret_cast<const uint8_t*>(heights.data()), heights.size() * sizeof(float)});
  indices.kind_view = builder.AddBufferView(parts.ground.kind);
  if (parts.painting.columns > 0) {
    indices.people_view = builder.AddBufferView(parts.painting.people);
    indices.loiter_view = builder.AddBufferView(parts.painting.loiter);
  }
  return builder.Finish(&models->glb);
}

Error WriteTourPack(const std::filesystem::path& path, const TourParts& parts, TourModels models, size_t* bytes) {
  GltfBuilder builder;
  TourIndices& indices = models.indices;
  if (Error e = builder.Resume(std::move(models.glb))) return e;
  for (const auto& sound : parts.sounds) indices.sounds.push_back(builder.AddBufferView(sound));
  for (const auto& picture : parts.pictures) indices.pictures.push_back(builder.AddBufferView(picture));
  builder.SetRootExtension(kTourExtension, TourJson(parts, indices));
  if (Error e = builder.Write(path, bytes)) return e;
  return CheckPlayerTakes(path);
}

}  // namespace flaneur
