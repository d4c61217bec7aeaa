#include "pipeline/footprint/town_objects.h"

#include <algorithm>
#include <map>
#include <string_view>

#include "pipeline/core/name_words.h"
#include "pipeline/footprint/box_grid.h"
#include "pipeline/footprint/constants.h"
#include "pipeline/footprint/untold_ground.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

struct Meaning {
  NodeKind kind;
  GroundKind ground = GroundKind::kNone;
  bool is_flat = false;  // and therefore ground
};

// The first line that shares a word with the name decides: a street lamp is a lamp. A word after a star is also the end
// of a longer one, as German has them: Marktplatz, Breite Herzogstraße.
struct NamedMeaning {
  std::initializer_list<std::string_view> words;
  Meaning meaning;
};
const NamedMeaning kNamedMeanings[] = {
    {{"tree", "*baum", "*bäume", "arbre", "arbres", "árbol", "arbol", "albero", "alberi", "drzewo", "树", "樹", "木"},
     {NodeKind::kTree}},
    {{"lamp", "lamppost", "streetlamp", "streetlight", "lantern", "*laterne", "*lampe", "lampadaire", "réverbère",
      "farola", "lampione", "lantaarn", "latarnia", "路灯", "街灯"},
     {NodeKind::kLamp}},
    {{"road", "street", "lane", "carriageway", "*strasse", "*straße", "*gasse", "fahrbahn", "rue", "chaussée", "calle",
      "strada", "straat", "ulica", "道路"},
     {NodeKind::kGround, GroundKind::kCarriageway}},
    {{"grass", "lawn", "meadow", "*gras", "*wiese", "*rasen", "pelouse", "herbe", "césped", "prato", "erba", "trawa",
      "草地", "芝生"},
     {NodeKind::kGround, GroundKind::kGrass}},
    {{"square", "plaza", "*platz", "parvis", "piazza", "plein", "plac", "广场", "広場"},
     {NodeKind::kGround, GroundKind::kSquare}},
    {{"ground", "terrain",  "floor",    "hex",         "path",  "pavement",  "sidewalk", "landscape", "topography",
      "*boden", "*gelände", "gelaende", "dgm",         "dtm",   "*pflaster", "*gehweg",  "sol",       "trottoir",
      "suelo",  "terreno",  "acera",    "marciapiede", "grond", "maaiveld",  "teren",    "地面",      "地形"},
     {NodeKind::kGround, GroundKind::kPavement}},
};

bool Means(const std::string& word, std::string_view known) {
  return known.starts_with('*') ? word.ends_with(known.substr(1)) : word == known;
}

Meaning FromName(const std::string& name, const Point3& min, const Point3& max) {
  const double height_m = max.z - min.z;
  const double longer_m = std::max(max.x - min.x, max.y - min.y);
  const double shorter_m = std::min(max.x - min.x, max.y - min.y);
  const std::vector<std::string> words = NameWords(name);
  for (const NamedMeaning& named : kNamedMeanings) {
    const bool matches =
        std::find_first_of(words.begin(), words.end(), named.words.begin(), named.words.end(), Means) != words.end();
    if (!matches) continue;
    const bool is_ground = named.meaning.kind == NodeKind::kGround;
    if (!is_ground || height_m <= kMaxGroundSteepness * longer_m) return named.meaning;
  }
  if (height_m <= kMaxFlatHeight_m && shorter_m >= kMinFlatWidth_m)
    return {NodeKind::kGround, GroundKind::kSquare, true};
  return {NodeKind::kBuilding};
}

std::vector<Triangle3> WorldTriangles(const Scene& scene, const SceneNode& node, double scale) {
  std::vector<Triangle3> out;
  for (const int index : node.meshes) {
    const Mesh& mesh = At(scene.meshes, index);
    std::vector<Point3> points;
    points.reserve(mesh.positions.size());
    for (const Vec3 p : mesh.positions) {
      const Vec3 g = GroundFromGltf(TransformPoint(node.world, p));
      points.push_back({g.x * scale, g.y * scale, g.z * scale});
    }
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
      out.push_back({points[mesh.indices[i]], points[mesh.indices[i + 1]], points[mesh.indices[i + 2]]});
  }
  return out;
}

// The topmost ancestor of the same kind: where the tag stands. Untagged nodes stand for themselves.
int ObjectRoot(const Scene& scene, int node) {
  const NodeKind kind = At(scene.nodes, node).kind;
  if (kind == NodeKind::kUntagged) return node;
  int root = node;
  for (int parent = At(scene.nodes, node).parent; parent >= 0 && At(scene.nodes, parent).kind == kind;
       parent = At(scene.nodes, parent).parent)
    root = parent;
  return root;
}

bool ObstacleKindOf(NodeKind kind, ObstacleKind* out) {
  switch (kind) {
    case NodeKind::kBuilding:
      *out = ObstacleKind::kBuilding;
      return true;
    case NodeKind::kWall:
      *out = ObstacleKind::kWall;
      return true;
    case NodeKind::kTree:
      *out = ObstacleKind::kTree;
      return true;
    case NodeKind::kLamp:
      *out = ObstacleKind::kLamp;
      return true;
    case NodeKind::kOther:
      *out = ObstacleKind::kOther;
      return true;
    default:
      return false;
  }
}

// An untagged object that is ground only because it is flat.
struct FlatObject {
  size_t node, patch;  // the latter of TownObjects::ground
  Point3 min_m, max_m;
};

bool LiesWithin(const Point3& min, const Point3& max, const Point3& outer_min, const Point3& outer_max) {
  return min.x > outer_min.x - kBlockReach_m && max.x < outer_max.x + kBlockReach_m &&
         min.y > outer_min.y - kBlockReach_m && max.y < outer_max.y + kBlockReach_m;
}

// Whether it lies high within another object, with nothing standing on it.
bool IsRoof(const FlatObject& flat, const std::vector<TownObject>& objects, const BoxGrid& grid) {
  bool high = false;
  for (const size_t i : grid.Near({{flat.min_m.x, flat.min_m.y}, {flat.max_m.x, flat.max_m.y}})) {
    const TownObject& o = objects[i];
    if (std::abs(o.min_m.z - flat.max_m.z) <= kFoot_m && LiesWithin(o.min_m, o.max_m, flat.min_m, flat.max_m))
      return false;
    high |= o.min_m.z < flat.min_m.z - kPassageHeight_m && LiesWithin(flat.min_m, flat.max_m, o.min_m, o.max_m);
  }
  return high;
}

std::vector<bool> AreRoofs(const std::vector<FlatObject>& flat, const std::vector<TownObject>& objects) {
  std::vector<BoundingBox> boxes;
  for (const TownObject& o : objects) boxes.push_back({{o.min_m.x, o.min_m.y}, {o.max_m.x, o.max_m.y}});
  const BoxGrid grid(std::move(boxes));
  std::vector<bool> are_roofs;
  for (const FlatObject& each : flat) are_roofs.push_back(IsRoof(each, objects, grid));
  return are_roofs;
}

// Whether what is flat and no roof is large enough beside the houses to be a town's ground.
bool MakeGround(const std::vector<FlatObject>& flat, const std::vector<bool>& are_roofs, const TownObjects& town) {
  double ground_m2 = 0, houses_m2 = 0;
  for (size_t i = 0; i < flat.size(); ++i)
    if (!are_roofs[i]) ground_m2 += PlanArea(town.ground[flat[i].patch].triangles);
  for (const TownObject& o : town.obstacles) houses_m2 += PlanArea(o.triangles) / 2;  // roofs and floors
  return ground_m2 >= kMinGroundToHouses * houses_m2;
}

// Where a town has no other ground, flat roofs that are objects of their own are not taken for it, nor are a few slabs
// among many houses.
void TakeSlabsForBuildings(const Scene& scene, const std::vector<FlatObject>& flat, TownObjects* town) {
  if (flat.empty() || flat.size() != town->ground.size()) return;
  const std::vector<bool> are_roofs = AreRoofs(flat, town->obstacles);
  const bool make_ground = MakeGround(flat, are_roofs, *town);
  std::vector<TownObject> slabs;
  std::vector<GroundPatch> ground;
  std::vector<std::string> names;
  for (size_t i = 0; i < flat.size(); ++i) {
    GroundPatch& patch = town->ground[flat[i].patch];
    if (make_ground && !are_roofs[i]) {
      ground.push_back(std::move(patch)), names.push_back(std::move(town->flat[i]));
      continue;
    }
    const std::string& name = scene.nodes[flat[i].node].name;
    TownObject& slab = slabs.emplace_back();
    slab.name = name.empty() ? "node_" + std::to_string(flat[i].node) : name;
    slab.triangles = std::move(patch.triangles);
    slab.min_m = flat[i].min_m, slab.max_m = flat[i].max_m;
    slab.is_roof = are_roofs[i];
  }
  town->ground = std::move(ground), town->flat = std::move(names);
  town->obstacles.insert(town->obstacles.end(), std::make_move_iterator(slabs.begin()),
                         std::make_move_iterator(slabs.end()));
}

}  // namespace

double PlanArea(const Triangle3& triangle) {
  const auto& [a, b, c] = triangle;
  return std::abs((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y)) / 2;
}

double PlanArea(const std::vector<Triangle3>& triangles) {
  double area_m2 = 0;
  for (const Triangle3& t : triangles) area_m2 += PlanArea(t);
  return area_m2;
}

void Grow(const std::vector<Triangle3>& triangles, Point3* min, Point3* max) {
  for (const Triangle3& t : triangles) {
    for (const Point3& p : t) {
      *min = {std::min(min->x, p.x), std::min(min->y, p.y), std::min(min->z, p.z)};
      *max = {std::max(max->x, p.x), std::max(max->y, p.y), std::max(max->z, p.z)};
    }
  }
}

bool HasBridge(const TownObjects& town) {
  return std::any_of(town.obstacles.begin(), town.obstacles.end(), [](const TownObject& o) { return o.is_bridge; });
}

TownObjects SortTown(const Scene& scene, double scale) {
  TownObjects town;
  std::map<int, size_t> object_of_root;
  std::vector<std::pair<int, std::vector<Triangle3>>> foundations;  // by root
  std::vector<FlatObject> flat;
  std::vector<size_t> untagged;  // of the obstacles, those that no name tells either
  for (size_t i = 0; i < scene.nodes.size(); ++i) {
    const SceneNode& node = scene.nodes[i];
    if (node.meshes.empty() || (node.kind == NodeKind::kNone && !node.is_foundation)) continue;
    std::vector<Triangle3> triangles = WorldTriangles(scene, node, scale);
    if (triangles.empty()) continue;
    if (node.is_foundation) {
      if (node.parent >= 0) foundations.emplace_back(ObjectRoot(scene, node.parent), std::move(triangles));
      continue;
    }
    Point3 min = triangles[0][0], max = min;
    Grow(triangles, &min, &max);
    Meaning meaning{node.kind, node.ground};
    if (node.kind == NodeKind::kUntagged) meaning = FromName(node.name, min, max);
    if (meaning.kind == NodeKind::kGround) {
      if (meaning.ground == GroundKind::kNone) meaning.ground = GroundKind::kPavement;
      town.ground.push_back({meaning.ground, std::move(triangles)});
      if (meaning.is_flat) town.flat.push_back(node.name), flat.push_back({i, town.ground.size() - 1, min, max});
      continue;
    }
    ObstacleKind kind;
    if (!ObstacleKindOf(meaning.kind, &kind)) continue;
    const int root = ObjectRoot(scene, static_cast<int>(i));
    const auto [entry, is_new] = object_of_root.try_emplace(root, town.obstacles.size());
    if (is_new) {
      const SceneNode& top = At(scene.nodes, root);
      const std::string name = top.name.empty() ? "node_" + std::to_string(root) : top.name;
      if (node.kind == NodeKind::kUntagged && kind == ObstacleKind::kBuilding)
        untagged.push_back(town.obstacles.size());
      town.obstacles.push_back({name, kind, top.radius_m, {}, {}, min, max});
      if (top.is_bridge) town.obstacles.back().kind = ObstacleKind::kOther, town.obstacles.back().is_bridge = true;
    }
    TownObject& object = town.obstacles[entry->second];
    Grow(triangles, &object.min_m, &object.max_m);
    object.triangles.insert(object.triangles.end(), triangles.begin(), triangles.end());
  }
  for (auto& [root, triangles] : foundations) {
    const auto entry = object_of_root.find(root);
    if (entry == object_of_root.end()) continue;
    std::vector<Triangle3>& foundation = town.obstacles[entry->second].foundation;
    foundation.insert(foundation.end(), triangles.begin(), triangles.end());
    town.obstacles[entry->second].foundation_is_given = true;
  }
  const size_t before_slabs = town.obstacles.size();
  TakeSlabsForBuildings(scene, flat, &town);
  for (size_t slab = before_slabs; slab < town.obstacles.size(); ++slab) untagged.push_back(slab);
  TakeUntoldGround(untagged, &town);
  return town;
}

}  // namespace flaneur
