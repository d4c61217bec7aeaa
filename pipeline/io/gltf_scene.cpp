#include <array>
#include <sstream>

#include "pipeline/core/turn_round.h"
#include "pipeline/io/gltf.h"
#include "pipeline/io/gltf_document.h"
#include "runtime/base/array.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

const std::array<NodeKind, 11> kKinds{NodeKind::kBuilding, NodeKind::kWall,   NodeKind::kTree, NodeKind::kLamp,
                                      NodeKind::kOther,    NodeKind::kGround, NodeKind::kDoor, NodeKind::kExit,
                                      NodeKind::kLoiter,   NodeKind::kWork,   NodeKind::kNone};
const std::array<TurnsBy, 3> kTurns{TurnsBy::kWind, TurnsBy::kHourHand, TurnsBy::kMinuteHand};
const std::array<GroundKind, 4> kGrounds{GroundKind::kCarriageway, GroundKind::kPavement, GroundKind::kSquare,
                                         GroundKind::kGrass};

// The value of that name, or an error that lists the known ones.
template <typename Kind, size_t n>
Error FromName(const char* tag, const std::string& name, const std::array<Kind, n>& kinds, const char* (*name_of)(Kind),
               Kind* out) {
  std::vector<std::string> names;
  for (const Kind kind : kinds) {
    names.emplace_back(name_of(kind));
    if (names.back() != name) continue;
    *out = kind;
    return Ok();
  }
  std::string known;
  for (const std::string& each : names) known += (known.empty() ? "" : ", ") + each;
  return Fail(std::string(tag) + " '" + OneLine(name) + "' is unknown" + DidYouMean(name, names) + " (known: " + known +
              ")");
}

// "maid, farmer" as names.
std::vector<std::string> Listed(const std::string& text) {
  std::vector<std::string> names;
  std::istringstream in(text);
  for (std::string name; std::getline(in, name, ',');) {
    const size_t first = name.find_first_not_of(' '), last = name.find_last_not_of(' ');
    if (first != std::string::npos) names.push_back(name.substr(first, last - first + 1));
  }
  return names;
}

// A node's own tags over its parent's; sizes belong to the tag that they stand beside.
Error ApplyTags(const NodeTags& tags, const SceneNode* parent, SceneNode* node) {
  if (parent != nullptr) {
    node->kind = parent->kind;
    node->ground = parent->ground;
    node->street = parent->street;
    if (tags.kind.empty()) {
      node->radius_m = parent->radius_m;
      node->width_m = parent->width_m;
    }
  }
  if (!tags.kind.empty()) {
    if (Error e = FromName("flaneur_kind", tags.kind, kKinds, NodeKindName, &node->kind)) return e;
  }
  if (!tags.ground.empty()) {
    if (Error e = FromName("flaneur_ground", tags.ground, kGrounds, GroundKindName, &node->ground)) {
      return e;
    }
  }
  if (!tags.turns.empty()) {
    if (Error e = FromName("flaneur_turns", tags.turns, kTurns, TurnsByName, &node->turns)) return e;
  }
  const bool is_ground = node->kind == NodeKind::kGround;
  if (!is_ground) node->ground = GroundKind::kNone;
  if (!tags.street.empty()) node->street = tags.street;
  if (is_ground && node->ground == GroundKind::kNone) node->ground = GroundKind::kPavement;
  if (tags.radius_m > 0) node->radius_m = tags.radius_m;
  if (tags.width_m > 0) node->width_m = tags.width_m;
  if (node->kind != NodeKind::kWork) return Ok();
  node->clip = tags.clip;
  node->avatars = Listed(tags.avatars);
  node->seat_m = tags.seat_m;
  node->stay_s = tags.stay_s;
  return Ok();
}

bool Mirrors(const Mat4& m) {
  const Vec3 x{m.m[0][0], m.m[0][1], m.m[0][2]};
  const Vec3 y{m.m[1][0], m.m[1][1], m.m[1][2]};
  const Vec3 z{m.m[2][0], m.m[2][1], m.m[2][2]};
  return Dot(Cross(x, y), z) < 0;
}

// Puts each of the document's meshes into the scene when first used, as it is and turned round
// apart.
class MeshTable {
 public:
  MeshTable(GltfDocument* document, Scene* scene)
      : document_(document), scene_(scene), plain_(document->meshes.size()), mirrored_(document->meshes.size()) {}

  const std::vector<int>& Use(int mesh, bool mirrored) {
    std::vector<int>& indices = At((mirrored ? mirrored_ : plain_), mesh);
    if (!indices.empty()) return indices;
    for (const DocumentPrimitive& p : At(document_->meshes, mesh).primitives) {
      indices.push_back(Count(scene_->meshes));
      scene_->meshes.push_back(p.mesh);
      if (mirrored) TurnRound(&scene_->meshes.back());
    }
    return indices;
  }

 private:
  GltfDocument* document_;
  Scene* scene_;
  std::vector<std::vector<int>> plain_, mirrored_;
};

}  // namespace

Error ReadGltfScene(const std::filesystem::path& path, Scene* scene, std::vector<std::string>* warnings,
                    const std::filesystem::path& named) {
  GltfDocument document;
  std::vector<std::string> notes;
  if (Error e = LoadGltf(path, &document, &notes, named)) return e;
  if (warnings != nullptr) warnings->insert(warnings->end(), notes.begin(), notes.end());
  *scene = {};
  scene->materials = std::move(document.materials);
  scene->images = std::move(document.images);
  const std::vector<Mat4> world = WorldMatrices(document);
  std::vector<int> index(document.nodes.size(), -1);
  MeshTable meshes(&document, scene);
  for (const int i : document.order) {
    const DocumentNode& in = At(document.nodes, i);
    if (!in.in_scene) continue;
    SceneNode node;
    node.name = in.name;
    node.parent = in.parent < 0 ? -1 : At(index, in.parent);
    node.world = At(world, i);
    const SceneNode* parent = node.parent < 0 ? nullptr : &At(scene->nodes, node.parent);
    if (Error e = ApplyTags(in.tags, parent, &node)) {
      return Fail(document.path + ": node '" + OneLine(in.name) + "': " + e.message);
    }
    if (in.mesh >= 0) node.meshes = meshes.Use(in.mesh, Mirrors(node.world));
    At(index, i) = Count(scene->nodes);
    scene->nodes.push_back(std::move(node));
  }
  if (scene->meshes.empty()) {
    return Fail(document.path + ": its scene shows no triangle; export the town's meshes");
  }
  return Ok();
}

}  // namespace flaneur
