#include "pipeline/cli/bare_ground.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <tuple>
#include <utility>

#include "pipeline/footprint/box_grid.h"
#include "pipeline/footprint/disjoint_sets.h"
#include "pipeline/footprint/polygon_sets.h"

namespace flaneur {
namespace {

constexpr double kLevel_m = 0.3;  // feet that differ by less stand on a flat square
// Of the feet so near one at least differs by no more than this, and this share of how far it is, or it is no foot.
constexpr double kNear_m = 25, kLikeOthers_m = 2, kSteep = 0.25;
constexpr double kOver_m = 0.5;    // what begins so much higher, with its middle over another, is a part of it,
constexpr double kBeside_m = 0.5;  // or before its wall, as windows lie,
constexpr double kHouse_m = 60;    // unless that is larger, as a town wall's is
constexpr double kLeastCell_m = 2.5;
constexpr int kMostCells = 128;  // a side

// A thing's box on the map, and from where to where it reaches above it.
struct Foot {
  BoundingBox box;
  double height_m = 1e300, top_m = -1e300;
  const TownObject* thing = nullptr;  // null: a piece of one
};

void Grow(const Point3& p, Foot* f) {
  f->box.min = {std::min(f->box.min.x, p.x), std::min(f->box.min.y, p.y)};
  f->box.max = {std::max(f->box.max.x, p.x), std::max(f->box.max.y, p.y)};
  f->height_m = std::min(f->height_m, p.z), f->top_m = std::max(f->top_m, p.z);
}

Point2 Middle(const BoundingBox& box) { return {(box.min.x + box.max.x) / 2, (box.min.y + box.max.y) / 2}; }

BoxGrid GridOf(const std::vector<Foot>& feet) {
  std::vector<BoundingBox> boxes;
  for (const Foot& f : feet) boxes.push_back(f.box);
  return BoxGrid(std::move(boxes));
}

template <typename Point>
bool IsLarge(const Point& min, const Point& max) {
  return max.x - min.x > kHouse_m || max.y - min.y > kHouse_m;
}

// On the map, or beside it by no more than a window before its wall. Of houses that stand askew the box says little.
bool Covers(const Foot& house, Point2 p) {
  if (!house.thing || house.thing->triangles.empty()) return true;
  const std::vector<Triangle3>& triangles = house.thing->triangles;
  return std::any_of(triangles.begin(), triangles.end(), [&](const Triangle3& t) {
    const Ring plan{{t[0].x, t[0].y}, {t[1].x, t[1].y}, {t[2].x, t[2].y}};
    return Contains(plan, p) || DistanceToBoundary({plan}, p) < kBeside_m;
  });
}

// Of what lies over each other on the map.
bool IsPartOf(const Foot& part, const Foot& house) {
  return !IsLarge(house.box.min, house.box.max) && house.height_m < part.height_m - kOver_m &&
         house.top_m > part.height_m - kOver_m && Covers(house, Middle(part.box));
}

// Without roofs, windows and what else is modelled apart.
std::vector<Foot> WithoutParts(const std::vector<Foot>& all) {
  const BoxGrid grid = GridOf(all);
  std::vector<Foot> feet;
  std::copy_if(all.begin(), all.end(), std::back_inserter(feet), [&](const Foot& f) {
    if (f.thing && !f.thing->foundation.empty()) return true;  // the model says what it stands on
    const Point2 middle = Middle(f.box);
    const std::vector<size_t> here = grid.Near({middle, middle}, kBeside_m);
    return std::none_of(here.begin(), here.end(), [&](size_t house) { return IsPartOf(f, all[house]); });
  });
  return feet;
}

// Whether one could walk from foot to foot, were there ground.
bool AreAlike(const Foot& a, const Foot& b) {
  const Point2 from = Middle(a.box), to = Middle(b.box);
  return std::abs(a.height_m - b.height_m) < kLikeOthers_m + kSteep * std::hypot(from.x - to.x, from.y - to.y);
}

// Without cellars, and what flies.
std::vector<Foot> WithoutStrays(const std::vector<Foot>& all) {
  const BoxGrid grid = GridOf(all);
  std::vector<Foot> feet;
  std::copy_if(all.begin(), all.end(), std::back_inserter(feet), [&](const Foot& f) {
    const std::vector<size_t> near = grid.Near(f.box, kNear_m);  // itself among them
    const auto alike = std::count_if(near.begin(), near.end(), [&](size_t k) { return AreAlike(f, all[k]); });
    return alike > 1 || near.size() < 3;
  });
  return feet;
}

// Of a model of many houses in one mesh, one for each of its connected pieces.
void AddPieces(const TownObject& thing, std::vector<Foot>* feet) {
  std::map<std::tuple<double, double, double>, size_t> corners;
  DisjointSets pieces;
  const auto corner = [&](const Point3& p) {
    const auto [entry, is_new] = corners.try_emplace({p.x, p.y, p.z}, pieces.size());
    if (is_new) pieces.Add();
    return entry->second;
  };
  for (const auto& [a, b, c] : thing.triangles) {
    pieces.Join(corner(a), corner(b));
    pieces.Join(corner(b), corner(c));
  }
  std::map<size_t, Foot> by_piece;
  for (const Triangle3& triangle : thing.triangles) {
    Foot& foot = by_piece[pieces.Root(corner(triangle[0]))];
    for (const Point3& p : triangle) Grow(p, &foot);
  }
  for (const auto& [root, foot] : by_piece) feet->push_back(foot);
}

std::vector<Foot> FeetOf(const std::vector<TownObject>& things) {
  std::vector<Foot> feet;
  for (const TownObject& t : things) {
    if (IsLarge(t.min_m, t.max_m) && !t.triangles.empty()) {
      AddPieces(t, &feet);
      continue;
    }
    Grow(t.min_m, &feet.emplace_back());
    Grow(t.max_m, &feet.back());
    feet.back().thing = &t;
  }
  const std::vector<Foot> alone = WithoutStrays(WithoutParts(feet));
  return alone.empty() ? feet : alone;
}

// At a corner of cells of this size. Where a cell touches a thing its corners are no lower than the foot: nobody's
// walls hang in the air, while a city model's feet lie as deep as the lowest ground under them.
double HeightAt(const std::vector<Foot>& feet, double x, double y, double cell_x_m, double cell_y_m) {
  double sum = 0, weights = 0, highest_foot = -1e300;
  for (const Foot& f : feet) {
    const double dx = std::max({f.box.min.x - x, x - f.box.max.x, 0.0});
    const double dy = std::max({f.box.min.y - y, y - f.box.max.y, 0.0});
    const double distance2 = dx * dx + dy * dy + 1;
    const double weight = 1 / (distance2 * distance2);
    sum += weight * f.height_m, weights += weight;
    if (dx < cell_x_m && dy < cell_y_m) highest_foot = std::max(highest_foot, f.height_m);
  }
  return std::max(sum / weights, highest_foot);
}

// A lattice over the map, and its heights, row by row.
struct Lattice {
  double left_m = 0, bottom_m = 0, width_m = 0, depth_m = 0;
  int columns = 1, rows = 1;  // of cells
  std::vector<double> heights_m{};
};

// around: all things; the ground is wider by the margin.
Lattice Over(const Foot& around, const std::vector<Foot>& feet, bool on_one_level, double margin_m) {
  Lattice l{around.box.min.x - margin_m, around.box.min.y - margin_m,
            around.box.max.x - around.box.min.x + 2 * margin_m, around.box.max.y - around.box.min.y + 2 * margin_m};
  std::vector<double> heights_m;
  for (const Foot& f : feet) heights_m.push_back(f.height_m);
  std::sort(heights_m.begin(), heights_m.end());
  if (on_one_level || heights_m.back() - heights_m.front() <= kLevel_m) {
    l.heights_m.assign(4, heights_m[heights_m.size() / 2]);
    return l;
  }
  const auto cells = [](double m) { return std::clamp(static_cast<int>(m / kLeastCell_m) + 1, 1, kMostCells); };
  l.columns = cells(l.width_m), l.rows = cells(l.depth_m);
  for (int row = 0; row <= l.rows; ++row) {
    for (int column = 0; column <= l.columns; ++column) {
      l.heights_m.push_back(HeightAt(feet, l.left_m + l.width_m * column / l.columns,
                                     l.bottom_m + l.depth_m * row / l.rows, l.width_m / l.columns, l.depth_m / l.rows));
    }
  }
  return l;
}

size_t IndexIn(const Lattice& l, int column, int row) { return static_cast<size_t>(row * (l.columns + 1) + column); }

Vec3 NormalAt(const Lattice& l, int column, int row) {
  const int west = std::max(column - 1, 0), east = std::min(column + 1, l.columns);
  const int south = std::max(row - 1, 0), north = std::min(row + 1, l.rows);
  const auto rise = [&](int from_column, int from_row, int to_column, int to_row) {
    return l.heights_m[IndexIn(l, to_column, to_row)] - l.heights_m[IndexIn(l, from_column, from_row)];
  };
  const double x = rise(west, row, east, row) / (l.width_m / l.columns * (east - west));
  const double y = rise(column, south, column, north) / (l.depth_m / l.rows * (north - south));
  return Normalized(GltfFromGround({static_cast<float>(-x), static_cast<float>(-y), 1}));
}

}  // namespace

Mesh BareGround(const std::vector<TownObject>& things, bool on_one_level, float margin_m) {
  Foot around;
  for (const TownObject& t : things) Grow(t.min_m, &around), Grow(t.max_m, &around);
  const Lattice l = Over(around, FeetOf(things), on_one_level, static_cast<double>(margin_m));
  Mesh mesh;
  mesh.name = "ground";
  for (int row = 0; row <= l.rows; ++row) {
    for (int column = 0; column <= l.columns; ++column) {
      mesh.positions.push_back(GltfFromGround({static_cast<float>(l.left_m + l.width_m * column / l.columns),
                                               static_cast<float>(l.bottom_m + l.depth_m * row / l.rows),
                                               static_cast<float>(l.heights_m[IndexIn(l, column, row)])}));
      mesh.normals.push_back(NormalAt(l, column, row));
      if (column == l.columns || row == l.rows) continue;
      const auto corner = [&](int dx, int dy) { return static_cast<uint32_t>(IndexIn(l, column + dx, row + dy)); };
      mesh.indices.insert(mesh.indices.end(),
                          {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 0), corner(1, 1), corner(0, 1)});
    }
  }
  return mesh;
}

}  // namespace flaneur
