#include "runtime/pack/read_town.h"

#include <cmath>
#include <string>

#include "runtime/base/array.h"
#include "runtime/base/limits.h"

namespace flaneur {
namespace {

float Finite(const Json& json) {
  const float value = json.get<float>();
  if (!std::isfinite(value)) throw PackRefused("has a number that is not finite");
  return value;
}

Mat4 LocalMatrix(const Json& node) {
  if (node.contains("matrix")) {
    Mat4 m;
    for (size_t k = 0; k < 16; ++k) m.m[k / 4][k % 4] = Finite(node["matrix"].at(k));
    return m;
  }
  Vec3 t, s{1, 1, 1};
  Quat r;
  if (node.contains("translation"))
    t = {node["translation"].at(0), node["translation"].at(1), node["translation"].at(2)};
  if (node.contains("rotation")) {
    const Json& q = node["rotation"];
    r = {q.at(0), q.at(1), q.at(2), q.at(3)};
  }
  if (node.contains("scale")) s = {node["scale"].at(0), node["scale"].at(1), node["scale"].at(2)};
  return FromTranslationRotationScale(t, r, s);
}

// -1: it stands still.
int ReadTurning(const Json& node, const Mat4& world, TourPack* pack) {
  if (!node.contains("extras") || !node["extras"].is_object()) return -1;
  const std::string name = node["extras"].value("flaneur_turns", "");
  if (name.empty()) return -1;
  for (const TurnsBy by : {TurnsBy::kWind, TurnsBy::kHourHand, TurnsBy::kMinuteHand}) {
    if (name != TurnsByName(by)) continue;
    if (Count(pack->turning) >= kMaxTurningParts)
      throw PackRefused("has more than " + std::to_string(kMaxTurningParts) + " turning parts");
    const Vec3 front = Normalized(GroundFromGltf(TransformDirection(world, {0, 0, 1})));
    TurningPart part{by, GroundFromGltf(TransformPoint(world, {})), front, std::atan2(front.y, front.x)};
    if (by == TurnsBy::kWind) part.axis = {0, 0, 1};
    pack->turning.push_back(part);
    return Count(pack->turning) - 1;
  }
  return -1;  // a newer version's
}

// Neither beyond the world nor blown up out of it.
void CheckPlacement(const Mat4& world, size_t node) {
  for (const auto& column : world.m) {
    for (const float number : column) {
      if (!(std::abs(static_cast<double>(number)) <= kMostCoordinate_m))
        throw PackRefused("has node " + std::to_string(node) + " placed out of range");
    }
  }
}

}  // namespace

void ReadTown(const GltfFile& file, MeshTable* meshes, TourPack* pack) {
  const Json& nodes = Member(file.json, "nodes");
  struct Visit {
    size_t node;
    Mat4 parent;
  };
  std::vector<Visit> stack;
  std::vector<bool> seen(nodes.size(), false);
  const auto visit_later = [&](const Json& node, const Mat4& parent) {
    const auto n = node.get<size_t>();
    if (n >= nodes.size() || seen[n]) throw PackRefused("has a broken node tree");
    seen[n] = true;
    stack.push_back({n, parent});
  };
  const auto visit_list_later = [&](const Json& of, const char* list, const Mat4& parent) {
    if (!of.contains(list)) return;
    for (const Json& node : of[list]) visit_later(node, parent);
  };
  visit_list_later(Element(file.json, "scenes", 0), "nodes", Mat4{});
  while (!stack.empty()) {
    const Visit visit = stack.back();
    stack.pop_back();
    const Json& node = nodes[visit.node];
    const Mat4 world = visit.parent * LocalMatrix(node);
    if (node.contains("mesh")) {
      CheckPlacement(world, visit.node);
      const int mesh = Index(node, "mesh", Member(file.json, "meshes").size());
      pack->town.push_back({node.value("name", ""), meshes->Get(mesh), world, ReadTurning(node, world, pack)});
    }
    visit_list_later(node, "children", world);
  }
}

}  // namespace flaneur
