#include "pipeline/pack/encode_town.h"

#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "pipeline/core/turn_round.h"
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

struct PlacedNode {
  const SceneNode* node = nullptr;
  std::optional<Transform> transform;  // none: it shears, and its mesh is baked
  size_t mesh = 0;                     // among those that are encoded
};

// Nodes with the same meshes share theirs.
std::vector<PlacedNode> NodesOf(const Scene& town, size_t* mesh_count) {
  std::vector<PlacedNode> nodes;
  std::map<std::vector<int>, size_t> shared;
  *mesh_count = 0;
  for (const SceneNode& node : town.nodes) {
    if (node.meshes.empty()) continue;
    PlacedNode& out = nodes.emplace_back(PlacedNode{&node, Decompose(node.world), *mesh_count});
    if (out.transform) out.mesh = shared.try_emplace(node.meshes, *mesh_count).first->second;
    if (out.mesh == *mesh_count) ++*mesh_count;
  }
  return nodes;
}

Error EncodeMeshes(const Scene& town, const std::vector<PlacedNode>& nodes, Jobs* jobs,
                   std::vector<EncodedMesh>* meshes) {
  DracoOptions draco;
  draco.position_bits = kTownPositionBits;
  draco.uv_bits = kTownUvBits;
  draco.most_triangles = kTownPrimitive_triangles;
  std::vector<const PlacedNode*> first(meshes->size(), nullptr);
  for (const PlacedNode& node : nodes) {
    if (first[node.mesh] == nullptr) first[node.mesh] = &node;
  }
  std::vector<Error> errors(meshes->size());
  ParallelFor(jobs, meshes->size(), [&](size_t k) {
    std::vector<Mesh> parts;
    for (int m : first[k]->node->meshes) parts.push_back(At(town.meshes, m));
    const std::optional<Transform>& transform = first[k]->transform;
    if (!transform) parts = Baked(std::move(parts), first[k]->node->world);
    else if (transform->scale.x < 0)  // see Decompose; glTF turns its triangles round, as the scene's already are
      for (Mesh& part : parts) TurnRound(&part);
    errors[k] = EncodeMesh(parts, draco, &(*meshes)[k]);
  });
  for (size_t k = 0; k < errors.size(); ++k) {
    if (errors[k]) return Fail("mesh '" + OneLine(first[k]->node->name) + "': " + errors[k].message);
  }
  return Ok();
}

}  // namespace

Error EncodeTown(const Scene& town, Jobs* jobs, EncodedTown* encoded) {
  size_t mesh_count = 0;
  const std::vector<PlacedNode> nodes = NodesOf(town, &mesh_count);
  *encoded = {town.materials, town.images, {}, std::vector<EncodedMesh>(mesh_count)};
  for (const PlacedNode& placed : nodes) {
    const SceneNode& node = *placed.node;
    if (node.turns != TurnsBy::kNothing && !placed.transform)
      return Fail("town: node '" + OneLine(node.name) +
                  "' turns (flaneur_turns) but is sheared by its parents' scales: apply them to its mesh");
    encoded->nodes.push_back({node.name, placed.mesh, placed.transform.value_or(Transform{}), TagExtras(node)});
  }
  return EncodeMeshes(town, nodes, jobs, &encoded->meshes);
}

}  // namespace flaneur
