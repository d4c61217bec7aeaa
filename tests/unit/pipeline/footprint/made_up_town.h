// Random towns whose footprints are known, as scenes and as files: houses with and without walls between them, yards,
// passages, towers on roofs, basins, steps of terrain.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "pipeline/footprint/polygon_sets.h"
#include "pipeline/io/town_builder.h"

namespace flaneur::made_up {

struct Face {
  size_t house;
  SurfaceKind kind;
  std::vector<std::vector<Point3>> rings;
};

struct Town {
  std::vector<std::string> names;  // of the houses
  std::vector<Rings> truth;        // where each stands
  std::vector<Face> faces;
};

enum class PartyWalls {
  kBoth,     // each house is closed
  kNone,     // neighbours share the air between them
  kOneOwner  // likewise, and one house of the block owns all of its outer walls
};

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double In(double low, double high) { return low + (high - low) * static_cast<double>(engine_() % 100'001) / 100'000; }
  int Below(int count) { return static_cast<int>(engine_() % static_cast<unsigned>(count)); }
  bool OneIn(int count) { return Below(count) == 0; }

 private:
  std::mt19937 engine_;
};

// A cell of a block's grid: what stands there and how high. Roofs rise along y only.
struct Cell {
  int house = -1;
  double low_m = 0;         // its foot, or the ceiling of a passage
  bool is_passage = false;  // nothing below low_m
  double south_top_m = 0, north_top_m = 0;
};

// A block of houses, cut along lines that are parallel to its sides.
class Block {
 public:
  Block(std::vector<double> xs, std::vector<double> ys) : xs_(std::move(xs)), ys_(std::move(ys)) {
    cells_.resize(Columns() * Rows());
  }
  size_t Columns() const { return xs_.size() - 1; }
  size_t Rows() const { return ys_.size() - 1; }
  Cell& At(size_t column, size_t row) { return cells_[row * Columns() + column]; }

  // Adds its houses to the town, turned about (0, 0) and moved.
  void AddTo(Town* town, Point3 at, double angle_rad, PartyWalls walls) const;

 private:
  struct Piece {  // of a wall over an edge of the grid
    int house;
    double low0, low1, high0, high1;  // at its two ends
    double from, to;
    bool upper;
  };
  const Cell& Get(size_t column, size_t row) const {
    static const Cell nothing;
    return column < Columns() && row < Rows() ? cells_[row * Columns() + column] : nothing;
  }
  static void AddPieces(const Cell& a, const Cell& b, const std::array<double, 2>& top_a,
                        const std::array<double, 2>& top_b, PartyWalls walls, double from, double to,
                        std::vector<Piece>* out);
  std::vector<double> xs_, ys_;
  std::vector<Cell> cells_;
};

inline void Block::AddPieces(const Cell& a, const Cell& b, const std::array<double, 2>& top_a,
                             const std::array<double, 2>& top_b, PartyWalls walls, double from, double to,
                             std::vector<Piece>* out) {
  if (a.house < 0 && b.house < 0) return;
  if (a.house < 0 || b.house < 0) {
    const Cell& c = a.house < 0 ? b : a;
    const std::array<double, 2>& top = a.house < 0 ? top_b : top_a;
    out->push_back(
        {walls == PartyWalls::kOneOwner ? 0 : c.house, c.low_m, c.low_m, top[0], top[1], from, to, c.is_passage});
    return;
  }
  if (a.house != b.house && walls == PartyWalls::kBoth) {
    out->push_back({a.house, a.low_m, a.low_m, top_a[0], top_a[1], from, to, a.is_passage});
    out->push_back({b.house, b.low_m, b.low_m, top_b[0], top_b[1], from, to, b.is_passage});
    return;
  }
  if (a.low_m != b.low_m) {
    const double low = std::min(a.low_m, b.low_m), high = std::max(a.low_m, b.low_m);
    out->push_back({a.low_m < b.low_m ? a.house : b.house, low, low, high, high, from, to, false});
  }
  const bool a_higher = top_a[0] + top_a[1] > top_b[0] + top_b[1];
  const std::array<double, 2>&high = a_higher ? top_a : top_b, &low = a_higher ? top_b : top_a;
  if (std::max(high[0] - low[0], high[1] - low[1]) > 0.01)
    out->push_back({a_higher ? a.house : b.house, low[0], low[1], high[0], high[1], from, to, true});
}

inline void Block::AddTo(Town* town, Point3 at, double angle_rad, PartyWalls walls) const {
  const auto mm = [](double v) { return std::round(v * 1000) / 1000; };
  const auto place = [&](double x, double y, double z) {
    return Point3{mm(at.x + x * std::cos(angle_rad) - y * std::sin(angle_rad)),
                  mm(at.y + x * std::sin(angle_rad) + y * std::cos(angle_rad)), mm(at.z + z)};
  };
  std::map<int, size_t> house_of;
  for (const Cell& cell : cells_) {
    if (cell.house < 0 || house_of.contains(cell.house)) continue;
    house_of[cell.house] = town->names.size();
    town->names.push_back("house_" + std::to_string(town->names.size()));
    town->truth.emplace_back();
  }
  for (size_t j = 0; j < Rows(); ++j) {
    for (size_t i = 0; i < Columns(); ++i) {
      const Cell& c = Get(i, j);
      if (c.house < 0) continue;
      const size_t house = house_of[c.house];
      const double x0 = xs_[i], x1 = xs_[i + 1], y0 = ys_[j], y1 = ys_[j + 1];
      town->faces.push_back({house,
                             SurfaceKind::kRoof,
                             {{place(x0, y0, c.south_top_m), place(x1, y0, c.south_top_m), place(x1, y1, c.north_top_m),
                               place(x0, y1, c.north_top_m)}}});
      const std::vector<Point3> below{place(x0, y1, c.low_m), place(x1, y1, c.low_m), place(x1, y0, c.low_m),
                                      place(x0, y0, c.low_m)};
      town->faces.push_back({house, c.is_passage ? SurfaceKind::kOther : SurfaceKind::kGround, {below}});
      if (c.is_passage) continue;
      Ring ring;
      for (const Point3& p : below) ring.push_back({p.x, p.y});
      town->truth[house].push_back(ring);
    }
  }
  for (const auto& [_, house] : house_of) town->truth[house] = UnionOfRings(town->truth[house]);
  // Walls along the lines of the grid, what goes on straight in one face.
  const auto add_line = [&](const std::vector<Piece>& pieces, const std::function<Point3(double, double)>& point) {
    std::vector<bool> done(pieces.size(), false);
    for (size_t k = 0; k < pieces.size(); ++k) {
      if (done[k]) continue;
      std::vector<Point3> bottom, top;
      const Piece* last = nullptr;
      for (size_t l = k; l < pieces.size(); ++l) {
        const Piece& p = pieces[l];
        if (done[l] || p.house != pieces[k].house || p.upper != pieces[k].upper) continue;
        if (last && (p.from != last->to || std::max(p.low0, last->low1) >= std::min(p.high0, last->high1))) continue;
        done[l] = true;
        for (const auto& [s, low, high] : {std::tuple(p.from, p.low0, p.high0), std::tuple(p.to, p.low1, p.high1)}) {
          const auto add = [](Point3 q, std::vector<Point3>* to) {
            if (to->empty() || to->back().x != q.x || to->back().y != q.y || to->back().z != q.z) to->push_back(q);
          };
          add(point(s, low), &bottom), add(point(s, high), &top);
        }
        last = &p;
      }
      bottom.insert(bottom.end(), top.rbegin(), top.rend());
      const auto found = house_of.find(pieces[k].house);
      town->faces.push_back(
          {found == house_of.end() ? house_of.begin()->second : found->second, SurfaceKind::kWall, {bottom}});
    }
  };
  for (size_t i = 0; i < xs_.size(); ++i) {
    std::vector<Piece> pieces;
    for (size_t j = 0; j < Rows(); ++j) {
      const Cell &a = Get(i - 1, j), &b = Get(i, j);
      AddPieces(a, b, {a.south_top_m, a.north_top_m}, {b.south_top_m, b.north_top_m}, walls, ys_[j], ys_[j + 1],
                &pieces);
    }
    add_line(pieces, [&](double y, double z) { return place(xs_[i], y, z); });
  }
  for (size_t j = 0; j < ys_.size(); ++j) {
    std::vector<Piece> pieces;
    for (size_t i = 0; i < Columns(); ++i) {
      const Cell &a = Get(i, j - 1), &b = Get(i, j);
      AddPieces(a, b, {a.north_top_m, a.north_top_m}, {b.south_top_m, b.south_top_m}, walls, xs_[i], xs_[i + 1],
                &pieces);
    }
    add_line(pieces, [&](double x, double z) { return place(x, ys_[j], z); });
  }
}

// ---- Kinds of blocks ----

inline void Stand(Cell* cell, int house, double low_m, double top_m) { *cell = {house, low_m, false, top_m, top_m}; }

// A row of houses of different widths, depths and heights under pitched roofs, some with lower parts behind; sheds of 5
// to 10 m2 lean on some.
inline Block Row(Random* random, int houses) {
  std::vector<double> xs{0};
  for (int i = 0; i < houses; ++i) xs.push_back(xs.back() + random->In(4.5, 9));
  const double front = random->In(4, 6), back = front + random->In(3, 5), annex = back + random->In(2, 4);
  std::vector<double> with_sheds = xs;
  for (int i = 0; i < houses; ++i) with_sheds.push_back(xs[static_cast<size_t>(i)] + 3);
  std::sort(with_sheds.begin(), with_sheds.end());
  Block block(with_sheds, {0, front, back, annex});
  int shed = houses;
  for (int i = 0; i < houses; ++i) {
    const double eaves = random->In(3, 9), ridge = eaves + random->In(1, 4);
    const int behind = random->Below(3);  // nothing, an annex, a shed
    for (const size_t column : {static_cast<size_t>(2 * i), static_cast<size_t>(2 * i + 1)}) {
      block.At(column, 0) = {i, 0, false, eaves, ridge};
      block.At(column, 1) = {i, 0, false, ridge, eaves};
      if (behind == 1) Stand(&block.At(column, 2), i, 0, random->In(2.3, 3));
    }
    if (behind == 2) Stand(&block.At(static_cast<size_t>(2 * i), 2), shed++, 0, 2.4);
  }
  return block;
}

// Houses round a yard, some with passages into it.
inline Block Yard(Random* random, int side) {
  const auto n = static_cast<size_t>(side);
  std::vector<double> xs{0, 9}, ys{0, 9};
  for (int i = 0; i < side; ++i) xs.push_back(xs.back() + random->In(6, 9)), ys.push_back(ys.back() + random->In(6, 9));
  xs.push_back(xs.back() + 9), ys.push_back(ys.back() + 9);
  Block block(xs, ys);
  const size_t last = n + 1;
  int house = 0;
  const auto stand = [&](size_t i, size_t j) {
    Stand(&block.At(i, j), house++, 0, random->In(6, 18));
    const bool corner = (i == 0 || i == last) && (j == 0 || j == last);
    if (corner || !random->OneIn(5)) return;
    Cell& cell = block.At(i, j);
    cell.is_passage = true, cell.low_m = 3;
    // The passage's house stands on its neighbour.
    cell.house = house - 2 < 0 ? cell.house : house - 2;
    --house;
  };
  for (size_t i = 0; i <= last; ++i) stand(i, 0);
  for (size_t j = 1; j <= last; ++j) stand(last, j);
  for (size_t i = last; i-- > 0;) stand(i, last);
  for (size_t j = last; j-- > 1;) stand(0, j);
  return block;
}

// One large building of many heights, towers standing in its roofs.
inline Block Huge(Random* random, int cells) {
  std::vector<double> xs{0}, ys{0};
  for (int i = 0; i < cells; ++i)
    xs.push_back(xs.back() + random->In(5, 14)), ys.push_back(ys.back() + random->In(5, 14));
  Block block(xs, ys);
  const double hall = random->In(5, 9);
  for (size_t j = 0; j < block.Rows(); ++j)
    for (size_t i = 0; i < block.Columns(); ++i)
      Stand(&block.At(i, j), 0, 0, random->OneIn(3) ? hall + random->In(2, 20) : hall);
  return block;
}

// A house with a tower or set back storeys on its roof, and a lower porch.
inline Block Towered(Random* random) {
  const double set_back = random->In(0.4, 3), w = random->In(8, 30), d = random->In(8, 20);
  Block block({0, set_back, w - set_back, w, w + 3}, {0, set_back, d - set_back, d});
  const double low = random->In(3, 12);
  for (size_t j = 0; j < 3; ++j)
    for (size_t i = 0; i < 3; ++i) Stand(&block.At(i, j), 0, 0, low);
  block.At(1, 1).south_top_m = block.At(1, 1).north_top_m = low + random->In(2.5, 30);
  if (random->OneIn(2)) Stand(&block.At(3, 1), 0, 0, 2.8);
  return block;
}

// A basin: thick walls round a floor whose height changes from place to place, all modelled as one building.
inline Block Basin(Random* random) {
  std::vector<double> xs{0, 1.5}, ys{0, 1.5};
  for (int i = 0; i < 40; ++i) xs.push_back(xs.back() + random->In(2, 4));
  for (int i = 0; i < 6; ++i) ys.push_back(ys.back() + random->In(2, 4));
  xs.push_back(xs.back() + 1.5), ys.push_back(ys.back() + 1.5);
  Block block(xs, ys);
  for (size_t j = 0; j < block.Rows(); ++j) {
    for (size_t i = 0; i < block.Columns(); ++i) {
      const bool rim = i == 0 || j == 0 || i + 1 == block.Columns() || j + 1 == block.Rows();
      const double south = rim ? 5 : random->In(0.02, 4), north = rim ? 5 : random->In(0.02, 4);
      block.At(i, j) = {0, 0, false, south, north};
    }
  }
  return block;
}

// A house on two terraces.
inline Block Terraced(Random* random) {
  Block block({0, 6, 12}, {0, 9});
  const double step = random->In(0.4, 1.9);
  Stand(&block.At(0, 0), 0, 0, 8);
  Stand(&block.At(1, 0), 0, step, random->OneIn(2) ? 8 : 8 + step);
  return block;
}

struct Mix {
  const char* name;
  PartyWalls walls;
  bool rows, yards, huge, towers, basins, terraces;
};

// So many blocks of the kinds that `mix` names, in turn, on a slope.
inline Town Build(const Mix& mix, int blocks, unsigned seed) {
  Random random(seed);
  Town town;
  std::vector<std::function<Block()>> kinds;
  if (mix.rows) kinds.emplace_back([&] { return Row(&random, 3 + random.Below(6)); });
  if (mix.yards) kinds.emplace_back([&] { return Yard(&random, 2 + random.Below(3)); });
  if (mix.huge) kinds.emplace_back([&] { return Huge(&random, 6 + random.Below(6)); });
  if (mix.towers) kinds.emplace_back([&] { return Towered(&random); });
  if (mix.basins) kinds.emplace_back([&] { return Basin(&random); });
  if (mix.terraces) kinds.emplace_back([&] { return Terraced(&random); });
  const int side = static_cast<int>(std::ceil(std::sqrt(blocks)));
  for (int k = 0; k < blocks; ++k) {
    const Block block = kinds[static_cast<size_t>(k) % kinds.size()]();
    const Point3 at{300'000 + 150.0 * (k % side), 5'000'000 + 150.0 * (k / side), 50 + 0.3 * k};
    block.AddTo(&town, at, random.In(0, 6.28), mix.walls);
  }
  return town;
}

// ---- As scenes and files ----

enum class Tags { kCityModel, kNone };  // none: as of an OBJ, one untagged node a house

inline Scene ToScene(const Town& town, Tags tags) {
  TownBuilder builder;
  for (const std::string& name : town.names)
    builder.AddNode(name, tags == Tags::kNone ? NodeKind::kUntagged : NodeKind::kBuilding);
  for (const Face& face : town.faces) {
    const int house = static_cast<int>(face.house);
    const bool ground = face.kind == SurfaceKind::kGround && tags == Tags::kCityModel;
    builder.AddPolygon(ground ? builder.FoundationOf(house) : house, face.kind, face.rings);
  }
  Scene scene;
  if (const Error error = builder.Finish("made-up", {"EPSG:25832", false}, &scene, nullptr, nullptr)) std::abort();
  return scene;
}

}  // namespace flaneur::made_up
