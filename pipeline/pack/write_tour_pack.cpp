#include "pipeline/pack/write_tour_pack.h"

#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "pipeline/core/reach.h"
#include "pipeline/pack/tour_json.h"
#include "runtime/base/array.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

// A street's ground is hundreds of metres wide, and its textures repeat: both need finer steps than a person.
constexpr int kTownPositionBits = 18, kTownUvBits = 16;

// What a page decodes between two pictures: some milliseconds.
constexpr size_t kTownPrimitive_triangles = 5000;

// The matrix as translation, rotation and scale; none where it shears.
std::optional<Transform> Decompose(const Mat4& m) {
  Vec3 axes[3];
  float lengths[3];
  for (size_t c = 0; c < 3; ++c) {
    axes[c] = {m.m[c][0], m.m[c][1], m.m[c][2]};
    lengths[c] = Length(axes[c]);
    if (!(lengths[c] > 1e-6f)) return std::nullopt;
    axes[c] = axes[c] * (1 / lengths[c]);
  }
  if (std::abs(Dot(axes[0], axes[1])) > 1e-4f || std::abs(Dot(axes[0], axes[2])) > 1e-4f ||
      std::abs(Dot(axes[1], axes[2])) > 1e-4f) {
    return std::nullopt;
  }
  if (Dot(Cross(axes[0], axes[1]), axes[2]) < 0) {
    axes[0] = axes[0] * -1;
    lengths[0] = -lengths[0];
  }
  // Shepperd's choice of the largest component keeps the square root away from zero.
  const float trace = axes[0].x + axes[1].y + axes[2].z;
  Quat q;
  if (trace > 0) {
    q = {axes[1].z - axes[2].y, axes[2].x - axes[0].z, axes[0].y - axes[1].x, 1 + trace};
  } else if (axes[0].x >= axes[1].y && axes[0].x >= axes[2].z) {
    q = {1 + axes[0].x - axes[1].y - axes[2].z, axes[0].y + axes[1].x, axes[2].x + axes[0].z, axes[1].z - axes[2].y};
  } else if (axes[1].y >= axes[2].z) {
    q = {axes[0].y + axes[1].x, 1 - axes[0].x + axes[1].y - axes[2].z, axes[1].z + axes[2].y, axes[2].x - axes[0].z};
  } else {
    q = {axes[2].x + axes[0].z, axes[1].z + axes[2].y, 1 - axes[0].x - axes[1].y + axes[2].z, axes[0].y - axes[1].x};
  }
  return Transform{{m.m[3][0], m.m[3][1], m.m[3][2]}, Normalized(q), {lengths[0], lengths[1], lengths[2]}};
}

std::vector<Mesh> Baked(std::vector<Mesh> meshes, const Mat4& world) {
  const Mat4 inverse = Inverse(world);
  for (Mesh& mesh : meshes) {
    for (Vec3& p : mesh.positions) p = TransformPoint(world, p);
    for (Vec3& n : mesh.normals) {  // by the inverse transpose
      n = Normalized(Vec3{inverse.m[0][0] * n.x + inverse.m[0][1] * n.y + inverse.m[0][2] * n.z,
                          inverse.m[1][0] * n.x + inverse.m[1][1] * n.y + inverse.m[1][2] * n.z,
                          inverse.m[2][0] * n.x + inverse.m[2][1] * n.y + inverse.m[2][2] * n.z});
    }
  }
  return meshes;
}

std::string TagExtras(const SceneNode& node) {
  std::string json;
  const auto add = [&json](const char* key, const char* value) {
    json += std::string(json.empty() ? "{\"" : ",\"") + key + "\":\"" + value + "\"";
  };
  if (node.kind != NodeKind::kUntagged) add("flaneur_kind", NodeKindName(node.kind));
  if (node.kind == NodeKind::kGround) add("flaneur_ground", GroundKindName(node.ground));
  if (node.turns != TurnsBy::kNothing) add("flaneur_turns", TurnsByName(node.turns));
  return json.empty() ? json : json + "}";
}

// A node of the town as glTF has it.
struct TownNode {
  const SceneNode* node = nullptr;
  std::optional<Transform> transform;  // none: it shears, and its mesh is baked
  size_t mesh = 0;                     // among those that are encoded
};

// Nodes with the same meshes share theirs.
std::vector<TownNode> NodesOf(const Scene& town, size_t* mesh_count) {
  std::vector<TownNode> nodes;
  std::map<std::vector<int>, size_t> shared;
  *mesh_count = 0;
  for (const SceneNode& node : town.nodes) {
    if (node.meshes.empty()) continue;
    TownNode& out = nodes.emplace_back(TownNode{&node, Decompose(node.world), *mesh_count});
    if (out.transform) out.mesh = shared.try_emplace(node.meshes, *mesh_count).first->second;
    if (out.mesh == *mesh_count) ++*mesh_count;
  }
  return nodes;
}

Error EncodeTown(const Scene& town, const std::vector<TownNode>& nodes, Jobs* jobs, std::vector<EncodedMesh>* meshes) {
  DracoOptions draco;
  draco.position_bits = kTownPositionBits;
  draco.uv_bits = kTownUvBits;
  draco.most_triangles = kTownPrimitive_triangles;
  std::vector<const TownNode*> first(meshes->size(), nullptr);
  for (const TownNode& node : nodes) {
    if (first[node.mesh] == nullptr) first[node.mesh] = &node;
  }
  std::vector<Error> errors(meshes->size());
  ParallelFor(jobs, meshes->size(), [&](size_t k) {
    std::vector<Mesh> parts;
    for (int m : first[k]->node->meshes) parts.push_back(At(town.meshes, m));
    if (!first[k]->transform) parts = Baked(std::move(parts), first[k]->node->world);
    errors[k] = EncodeMesh(parts, draco, &(*meshes)[k]);
  });
  for (size_t k = 0; k < errors.size(); ++k) {
    if (errors[k]) return Fail("mesh '" + OneLine(first[k]->node->name) + "': " + errors[k].message);
  }
  return Ok();
}

Error AddTown(const Scene& town, Jobs* jobs, GltfBuilder* builder) {
  const std::vector<int> materials = builder->AddMaterials(town.materials, town.images);
  size_t mesh_count = 0;
  const std::vector<TownNode> nodes = NodesOf(town, &mesh_count);
  for (const TownNode& node : nodes) {
    if (node.node->turns != TurnsBy::kNothing && !node.transform)
      return Fail("town: node '" + OneLine(node.node->name) +
                  "' turns (flaneur_turns) but is sheared by its parents' scales: apply them to its mesh");
  }
  std::vector<EncodedMesh> encoded(mesh_count);
  if (Error e = EncodeTown(town, nodes, jobs, &encoded)) return e;
  std::vector<int> meshes(mesh_count, -1), roots;
  for (const TownNode& node : nodes) {
    int& mesh = meshes[node.mesh];
    if (mesh < 0) {
      if (Error e = builder->AddMesh(node.node->name, encoded[node.mesh], materials, &mesh)) return e;
    }
    GltfNode out;
    out.name = node.node->name;
    out.mesh = mesh;
    out.transform = node.transform.value_or(Transform{});
    out.extras = TagExtras(*node.node);
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

Error BuildModels(const TourParts& parts, Jobs* jobs, TourModels* models) {
  GltfBuilder builder;
  TourIndices& indices = models->indices = {};
  // First in the file, as they are read first.
  if (!parts.title_page.picture.empty()) indices.title_picture_view = builder.AddBufferView(parts.title_page.picture);
  if (!parts.title_page.logo.empty()) indices.title_logo_view = builder.AddBufferView(parts.title_page.logo);
  if (Error e = AddTown(parts.town, jobs, &builder)) return e;
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
  return builder.Write(path, bytes);
}

}  // namespace flaneur
