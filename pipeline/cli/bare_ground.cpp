#include "pipeline/cli/bare_ground.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <tuple>
#include <utility>

#include "pipeline/footprint/disjoint_sets.h"

namespace flaneur {
namespace {

constexpr double kLevel_m = 0.3;  // feet that differ by less stand on a flat square
constexpr double kNear_m = 25;    // things in cells of this size, and in those beside them, are near each other
constexpr double kLikeOthers_m = 2,
                 kSteep = 0.25;    // of the feet near it one at least differs by less, or it is no foot
constexpr double kOver_m = 0.5;    // what begins so much higher, with its middle over another, is a part of it,
constexpr double kBeside_m = 0.5;  // or before its wall, as windows lie,
constexpr double kHouse_m = 60;    // unless that is larger, as a town wall's is
constexpr double kLeastCell_m = 2.5;
constexpr int kMostCells = 100;  // a side

// A thing's box on the map, and how high it begins.
struct Foot {
  double left_m, bottom_m, right_m, top_m;
  double height_m, reaches_m;
};

using Cell = std::pair<int, int>;

int CellIndex(double m) { return static_cast<int>(std::floor(m / kNear_m)); }
Cell CellOf(const Foot& f) { return {CellIndex((f.left_m + f.right_m) / 2), CellIndex((f.bottom_m + f.top_m) / 2)}; }

bool IsLarge(const Foot& f) { return f.right_m - f.left_m > kHouse_m || f.top_m - f.bottom_m > kHouse_m; }

bool IsOver(const Foot& part, const Foot& house) {
  const double x = (part.left_m + part.right_m) / 2, y = (part.bottom_m + part.top_m) / 2;
  return house.height_m < part.height_m - kOver_m && house.reaches_m > part.height_m - kOver_m &&
         house.left_m - kBeside_m <= x && x <= house.right_m + kBeside_m && house.bottom_m - kBeside_m <= y &&
         y <= house.top_m + kBeside_m;
}

// By the cells that a part of them may have its middle in.
std::map<Cell, std::vector<const Foot*>> HousesByCell(const std::vector<Foot>& all) {
  std::map<Cell, std::vector<const Foot*>> houses;
  for (const Foot& f : all) {
    if (IsLarge(f)) continue;
    for (int y = CellIndex(f.bottom_m - kBeside_m); y <= CellIndex(f.top_m + kBeside_m); ++y) {
      for (int x = CellIndex(f.left_m - kBeside_m); x <= CellIndex(f.right_m + kBeside_m); ++x) {
        houses[{x, y}].push_back(&f);
      }
    }
  }
  return houses;
}

// Without roofs, windows and what else is modelled apart.
std::vector<Foot> WithoutParts(const std::vector<Foot>& all) {
  const std::map<Cell, std::vector<const Foot*>> houses = HousesByCell(all);
  std::vector<Foot> feet;
  std::copy_if(all.begin(), all.end(), std::back_inserter(feet), [&](const Foot& f) {
    const auto here = houses.find(CellOf(f));
    return here == houses.end() ||
           std::none_of(here->second.begin(), here->second.end(), [&](const Foot* house) { return IsOver(f, *house); });
  });
  return feet;
}

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Whether one could walk from foot to foot, were there ground.
bool AreAlike(const Foot& a, const Foot& b) {
  const double dx = (a.left_m + a.right_m - b.left_m - b.right_m) / 2;
  const double dy = (a.bottom_m + a.top_m - b.bottom_m - b.top_m) / 2;
  return std::abs(a.height_m - b.height_m) < kLikeOthers_m + kSteep * std::hypot(dx, dy);
}

// Without cellars, and what flies.
std::vector<Foot> WithoutStrays(const std::vector<Foot>& all) {
  std::map<Cell, std::vector<const Foot*>> cells;
  for (const Foot& f : all) cells[CellOf(f)].push_back(&f);
  std::vector<Foot> feet;
  std::copy_if(all.begin(), all.end(), std::back_inserter(feet), [&](const Foot& f) {
    size_t near = 0, alike = 0;  // itself among them
    for (const int x : {-1, 0, 1}) {
      for (const int y : {-1, 0, 1}) {
        const Cell cell = CellOf(f);
        const auto found = cells.find({cell.first + x, cell.second + y});
        if (found == cells.end()) continue;
        near += found->second.size();
        for (const Foot* other : found->second) alike += static_cast<size_t>(AreAlike(f, *other));
      }
    }
    return alike > 1 || near < 3;
  });
  return feet;
}

// Of a model of many houses in one mesh, a box for each of its connected pieces.
void AddPieces(const TownObject& thing, std::vector<Foot>* feet) {
  std::map<std::tuple<double, double, double>, size_t> corners;
  DisjointSets pieces;
  std::vector<size_t> first;
  for (const Triangle3& triangle : thing.triangles) {
    size_t before = 0;
    for (size_t k = 0; k < 3; ++k) {
      const Point3& p = triangle[k];
      const auto [corner, is_new] = corners.try_emplace({p.x, p.y, p.z}, pieces.size());
      if (is_new) pieces.Add();
      if (k > 0) pieces.Join(before, corner->second);
      before = corner->second;
    }
    first.push_back(before);
  }
  std::map<size_t, Foot> boxes;
  for (size_t t = 0; t < first.size(); ++t) {
    for (const Point3& p : thing.triangles[t]) {
      Foot& f = boxes.try_emplace(pieces.Root(first[t]), Foot{p.x, p.y, p.x, p.y, p.z, p.z}).first->second;
      f.left_m = std::min(f.left_m, p.x), f.right_m = std::max(f.right_m, p.x);
      f.bottom_m = std::min(f.bottom_m, p.y), f.top_m = std::max(f.top_m, p.y);
      f.height_m = std::min(f.height_m, p.z), f.reaches_m = std::max(f.reaches_m, p.z);
    }
  }
  for (const auto& [root, box] : boxes) feet->push_back(box);
}

std::vector<Foot> FeetOf(const std::vector<TownObject>& things) {
  std::vector<Foot> feet;
  for (const TownObject& t : things) {
    const Foot whole{t.min_m.x, t.min_m.y, t.max_m.x, t.max_m.y, t.min_m.z, t.max_m.z};
    if (IsLarge(whole) && !t.triangles.empty()) AddPieces(t, &feet);
    else feet.push_back(whole);
  }
  const std::vector<Foot> alone = WithoutStrays(WithoutParts(feet));
  return alone.empty() ? feet : alone;
}

double HeightAt(const std::vector<Foot>& feet, double x, double y) {
  double sum = 0, weights = 0;
  for (const Foot& f : feet) {
    const double dx = std::max({f.left_m - x, x - f.right_m, 0.0}), dy = std::max({f.bottom_m - y, y - f.top_m, 0.0});
    const double distance2 = dx * dx + dy * dy + 1;
    const double weight = 1 / (distance2 * distance2);
    sum += weight * f.height_m, weights += weight;
  }
  return sum / weights;
}

bool IsLevel(const std::vector<Foot>& feet) {
  const auto lower = [](const Foot& a, const Foot& b) { return a.height_m < b.height_m; };
  const auto [least, most] = std::minmax_element(feet.begin(), feet.end(), lower);
  return most->height_m - least->height_m <= kLevel_m;
}

// A lattice over the map, and its heights, row by row.
struct Lattice {
  double left_m = 0, bottom_m = 0, width_m = 0, depth_m = 0;
  int columns = 1, rows = 1;  // of cells
  std::vector<double> heights_m{};
};

Lattice Over(const std::vector<Foot>& feet, bool level, double margin_m) {
  Foot around = feet.front();
  std::vector<double> heights_m;
  for (const Foot& f : feet) {
    around.left_m = std::min(around.left_m, f.left_m), around.bottom_m = std::min(around.bottom_m, f.bottom_m);
    around.right_m = std::max(around.right_m, f.right_m), around.top_m = std::max(around.top_m, f.top_m);
    heights_m.push_back(f.height_m);
  }
  Lattice l{around.left_m - margin_m, around.bottom_m - margin_m, around.right_m - around.left_m + 2 * margin_m,
            around.top_m - around.bottom_m + 2 * margin_m};
  if (level) {
    l.heights_m.assign(4, Median(std::move(heights_m)));
    return l;
  }
  const auto cells = [](double m) { return std::clamp(static_cast<int>(m / kLeastCell_m) + 1, 1, kMostCells); };
  l.columns = cells(l.width_m), l.rows = cells(l.depth_m);
  for (int row = 0; row <= l.rows; ++row) {
    for (int column = 0; column <= l.columns; ++column) {
      l.heights_m.push_back(
          HeightAt(feet, l.left_m + l.width_m * column / l.columns, l.bottom_m + l.depth_m * row / l.rows));
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
  const std::vector<Foot> feet = FeetOf(things);
  const Lattice l = Over(feet, on_one_level || IsLevel(feet), static_cast<double>(margin_m));
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
