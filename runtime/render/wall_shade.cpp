#include "runtime/render/wall_shade.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <unordered_map>
#include <utility>

namespace flaneur {
namespace {

constexpr float kWidth_m = 0.5f;     // of a strip
constexpr float kPiece_m = 0.75f;    // of a strip's length, as it follows the ground
constexpr float kTouches_m = 0.05f;  // apart: one wall
constexpr float kCell_m = 2;         // of the grid of edges
constexpr float kBlock_m = 16;
constexpr float kSteep = 1;  // rise of a strip over its width, from which it lies on no ground of one piece
constexpr int kFan = 3;      // pieces about a corner
constexpr int kRound = 12;   // pieces about a trunk

struct Edge {
  Vec2 a, b;
  int obstacle = 0;
};

// Edges by the cells that they cross.
struct EdgeGrid {
  std::vector<Edge> edges;
  std::unordered_map<int64_t, std::vector<int>> cells;
};

int64_t CellAt(Vec2 p) {
  const auto x = static_cast<int64_t>(std::floor(p.x / kCell_m)), y = static_cast<int64_t>(std::floor(p.y / kCell_m));
  return x * (int64_t{1} << 32) + y;
}

void Insert(const Edge& edge, EdgeGrid* grid) {
  const int index = static_cast<int>(grid->edges.size());
  grid->edges.push_back(edge);
  const Vec2 low{std::min(edge.a.x, edge.b.x) - kTouches_m, std::min(edge.a.y, edge.b.y) - kTouches_m};
  const Vec2 high{std::max(edge.a.x, edge.b.x) + kTouches_m, std::max(edge.a.y, edge.b.y) + kTouches_m};
  const float last_x = std::floor(high.x / kCell_m) * kCell_m, last_y = std::floor(high.y / kCell_m) * kCell_m;
  for (float x = std::floor(low.x / kCell_m) * kCell_m; x <= last_x; x += kCell_m) {
    for (float y = std::floor(low.y / kCell_m) * kCell_m; y <= last_y; y += kCell_m)
      grid->cells[CellAt({x + kCell_m / 2, y + kCell_m / 2})].push_back(index);
  }
}

float DistanceTo(const Edge& e, Vec2 p) {
  const Vec2 along = e.b - e.a, to = p - e.a;
  const float square = Dot(along, along), t = square > 0 ? std::clamp(Dot(to, along) / square, 0.0f, 1.0f) : 0;
  return Length(to - along * t);
}

bool TouchesAnother(const EdgeGrid& grid, int obstacle, Vec2 p) {
  const auto cell = grid.cells.find(CellAt(p));
  if (cell == grid.cells.end()) return false;
  return std::any_of(cell->second.begin(), cell->second.end(), [&](int i) {
    const Edge& e = grid.edges[static_cast<size_t>(i)];
    return e.obstacle != obstacle && DistanceTo(e, p) < kTouches_m;
  });
}

// By the ground's cells about it; none where there is none.
std::optional<float> HeightOfGround(const GroundRaster& ground, Vec2 p) {
  const float x = (p.x - ground.min_m.x) / ground.cell_m - 0.5f, y = (p.y - ground.min_m.y) / ground.cell_m - 0.5f;
  float sum = 0, weights = 0;
  for (int k = 0; k < 4; ++k) {
    const float column = std::floor(x) + static_cast<float>(k % 2), row = std::floor(y) + static_cast<float>(k / 2);
    if (!(column >= 0 && row >= 0 && column < static_cast<float>(ground.columns) &&
          row < static_cast<float>(ground.rows)))
      continue;
    const size_t cell = static_cast<size_t>(row) * static_cast<size_t>(ground.columns) + static_cast<size_t>(column);
    if (ground.kind[cell] == 0) continue;
    const float weight = (1 - std::abs(x - column)) * (1 - std::abs(y - row)) + 1e-3f;
    sum += weight * ground.height_m[cell];
    weights += weight;
  }
  return weights > 0 ? std::optional(sum / weights) : std::nullopt;
}

class Strips {
 public:
  explicit Strips(const GroundRaster& ground) : ground_(ground) {}

  // From the wall's points a and b to the points beyond them where the shade ends.
  void Add(Vec2 a, Vec2 b, Vec2 beyond_a, Vec2 beyond_b) {
    const auto ends_a = Place(beyond_a, 1), ends_b = Place(beyond_b, 1);
    if (!ends_a || !ends_b) return;
    // Under walls the ground may end: there it goes on as it is before them.
    const WallShadeVertex at_a = Place(a, 0).value_or(WallShadeVertex{At(a, ends_a->position.y), 0});
    const WallShadeVertex at_b = Place(b, 0).value_or(WallShadeVertex{At(b, ends_b->position.y), 0});
    if (Steep(at_a, *ends_a) || Steep(at_b, *ends_b) || Steep(*ends_a, *ends_b)) return;
    std::vector<WallShadeVertex>& corners = blocks_[{Block(a.x), Block(a.y)}];
    corners.insert(corners.end(), {at_a, *ends_a, *ends_b, at_a, *ends_b, at_b});
  }

  WallShade Take() {
    WallShade shade;
    for (const auto& [place, corners] : blocks_) {
      WallShadeBlock block{{}, static_cast<uint32_t>(shade.corners.size()), static_cast<uint32_t>(corners.size())};
      for (const WallShadeVertex& v : corners) Include(v.position, &block.box);
      shade.blocks.push_back(block);
      shade.corners.insert(shade.corners.end(), corners.begin(), corners.end());
    }
    return shade;
  }

 private:
  static int Block(float meters) { return static_cast<int>(std::floor(meters / kBlock_m)); }
  static Vec3 At(Vec2 p, float height_m) { return GltfFromGround({p.x, p.y, height_m}); }
  static bool Steep(const WallShadeVertex& a, const WallShadeVertex& b) {
    return std::abs(a.position.y - b.position.y) > kSteep * kWidth_m;
  }
  std::optional<WallShadeVertex> Place(Vec2 p, float out) const {
    const std::optional<float> height_m = HeightOfGround(ground_, p);
    return height_m ? std::optional(WallShadeVertex{At(p, *height_m), out}) : std::nullopt;
  }

  const GroundRaster& ground_;
  std::map<std::pair<int, int>, std::vector<WallShadeVertex>> blocks_;
};

float SignedArea(const std::vector<Vec2>& ring) {
  float area = 0;
  for (size_t i = 0; i < ring.size(); ++i) area += Cross(ring[i], ring[(i + 1) % ring.size()]) / 2;
  return area;
}

// With the obstacle on its left.
std::vector<Vec2> Turned(std::vector<Vec2> ring, bool outer) {
  if ((SignedArea(ring) > 0) != outer) std::reverse(ring.begin(), ring.end());
  return ring;
}

Vec2 OutOf(Vec2 a, Vec2 b) {
  const Vec2 along = b - a;
  const float length = Length(along);
  return length > 0 ? Vec2{along.y / length, -along.x / length} : Vec2{};
}

void AddEdge(Vec2 a, Vec2 b, int obstacle, const EdgeGrid& grid, Strips* strips) {
  const Vec2 out = OutOf(a, b) * kWidth_m, along = b - a;
  const int pieces = std::max(1, static_cast<int>(std::ceil(Length(along) / kPiece_m)));
  for (int k = 0; k < pieces; ++k) {
    const auto at = [&](int i) { return a + along * (static_cast<float>(i) / static_cast<float>(pieces)); };
    const Vec2 from = at(k), to = at(k + 1);
    if (!TouchesAnother(grid, obstacle, (from + to) * 0.5f)) strips->Add(from, to, from + out, to + out);
  }
}

// About p, where the outline turns away from `before` to `after`, both unit.
void AddFan(Vec2 p, Vec2 before, Vec2 after, Strips* strips) {
  const float begin_rad = std::atan2(before.y, before.x);
  const float turn_rad = std::atan2(Cross(before, after), Dot(before, after));
  const auto beyond = [&](int k) {
    const float angle_rad = begin_rad + turn_rad * static_cast<float>(k) / kFan;
    return p + Vec2{std::cos(angle_rad), std::sin(angle_rad)} * kWidth_m;
  };
  for (int k = 0; k < kFan; ++k) strips->Add(p, p, beyond(k), beyond(k + 1));
}

void AddRing(const std::vector<Vec2>& ring, int obstacle, const EdgeGrid& grid, Strips* strips) {
  const size_t count = ring.size();
  for (size_t i = 0; i < count; ++i) {
    const Vec2 a = ring[i], b = ring[(i + 1) % count], before = ring[(i + count - 1) % count];
    AddEdge(a, b, obstacle, grid, strips);
    const Vec2 out_before = OutOf(before, a), out = OutOf(a, b);
    if (Cross(out_before, out) > 0.1f && !TouchesAnother(grid, obstacle, a)) AddFan(a, out_before, out, strips);
  }
}

void AddTrunk(const CircleObstacle& trunk, Strips* strips) {
  const auto at = [&](int k, float radius_m) {
    const float angle_rad = 2 * kPi * static_cast<float>(k) / kRound;
    return trunk.center + Vec2{std::cos(angle_rad), std::sin(angle_rad)} * radius_m;
  };
  const float wide_m = trunk.radius_m + kWidth_m;
  for (int k = 0; k < kRound; ++k)
    strips->Add(at(k, trunk.radius_m), at(k + 1, trunk.radius_m), at(k, wide_m), at(k + 1, wide_m));
}

bool LooksUp(const PackPrimitive& p, const Mat4& world) {
  constexpr float kUp = 0.9f, kMost = 0.9f;
  size_t up = 0;
  for (const Vec3& n : p.normals) up += Normalized(TransformDirection(world, n)).y > kUp ? 1u : 0u;
  return static_cast<float>(up) > kMost * static_cast<float>(p.normals.size());
}

bool IsShaded(const std::vector<Vec4>& colors) {
  constexpr float kDiffers = 0.05f;
  float least = 1, most = 0;
  for (const Vec4& c : colors) {
    const float light = (c.x + c.y + c.z) / 3;
    least = std::min(least, light);
    most = std::max(most, light);
  }
  return most - least > kDiffers;
}

}  // namespace

WallShade BuildWallShade(const Obstacles& obstacles, const GroundRaster& ground) {
  EdgeGrid grid;
  std::vector<std::pair<int, std::vector<Vec2>>> rings;
  int obstacle = 0;
  for (const PolygonObstacle& polygon : obstacles.polygons) {
    rings.emplace_back(obstacle, Turned(polygon.outer, true));
    for (const std::vector<Vec2>& hole : polygon.holes) rings.emplace_back(obstacle, Turned(hole, false));
    ++obstacle;
  }
  for (const auto& [of, ring] : rings) {
    for (size_t i = 0; i < ring.size(); ++i) Insert({ring[i], ring[(i + 1) % ring.size()], of}, &grid);
  }
  Strips strips(ground);
  for (const auto& [of, ring] : rings) AddRing(ring, of, grid, &strips);
  for (const CircleObstacle& trunk : obstacles.circles) AddTrunk(trunk, &strips);
  return strips.Take();
}

bool GroundHasShade(const TourPack& pack) {
  for (const TownInstance& instance : pack.town) {
    for (const PackPrimitive& p : pack.meshes[static_cast<size_t>(instance.mesh)].primitives) {
      if (!p.colors.empty() && IsShaded(p.colors) && LooksUp(p, instance.world)) return true;
    }
  }
  return false;
}

}  // namespace flaneur
