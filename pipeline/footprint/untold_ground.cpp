#include "pipeline/footprint/untold_ground.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "pipeline/footprint/constants.h"
#include "pipeline/footprint/disjoint_sets.h"
#include "pipeline/footprint/plan_raster.h"
#include "pipeline/footprint/welded_shell.h"

namespace flaneur {
namespace {

constexpr double kCell_m = 0.5, kMaxCells = 500'000;  // of the raster; larger ones in a wide town
constexpr double kUpwards = 0.6;                      // of a face's normal, what shows upwards where one could walk
constexpr double kStep_m = 0.3, kSlope = 0.7;         // from cell to cell: a step, and as much of the cell's width
constexpr double kRises_m = 1;                        // a wall; lower ones are steps, kerbs and parapets
constexpr double kMaxRoofed = 0.6;                    // of a piece lies under something: more, and it is a floor
constexpr double kMaxHanging = 0.15;         // of its area, walls that hang below it: more than a model's edge has
constexpr double kMaxHangingOfRising = 0.4;  // or of the walls on it, where a town wall is sunk into a slope
constexpr double kBare = 0.5;                // of the town: ground alone, on which nothing stands
constexpr double kMinGround = 0.1;           // of the town, the largest piece; of sheets: of all that shows upwards
constexpr double kSheet = 0.7;               // of what hangs together shows upwards: it is no body
constexpr double kMinBesideLargest = 0.02;   // of that, any other
constexpr double kEnoughGround = 0.3;        // of the largest piece: the town has ground already
constexpr double kOnGround_m = 0.15;         // faces so little over it are kerbs and roads, and ground too
constexpr double kMinLeft = 0.02;            // of an object's area, or nothing of it is left
constexpr size_t kNone = static_cast<size_t>(-1);

double AreaOf(const Triangle3& t) {
  const Point3 n = NormalOf(t);
  return std::hypot(n.x, n.y, n.z) / 2;
}

// Which side of its faces a model shows.
enum class Shown { kFront, kBack, kEither };

bool ShowsUpwards(const Triangle3& t, Shown shown) {
  const Point3 n = NormalOf(t);
  const double up = shown == Shown::kFront ? n.z : shown == Shown::kBack ? -n.z : std::abs(n.z);
  return up > kUpwards * std::hypot(n.x, n.y, n.z);
}

// The highest of the faces that count, cell by cell; heights are turned over, since rasters keep the lowest.
template <typename Counts>
GroundRaster SeenFromAbove(GroundRaster blank, const std::vector<TownObject>& objects, Counts counts) {
  for (const TownObject& object : objects) {
    for (Triangle3 t : object.triangles) {
      if (!counts(t)) continue;
      for (Point3& p : t) p.z = -p.z;
      DrawArea(t, &blank);
    }
  }
  return blank;
}

// A piece of surface that one could walk on.
struct Region {
  size_t cells = 0, roofed = 0, of_sheets = 0;
  double rising_m2 = 0, hanging_m2 = 0;  // walls
};

class Finder {
 public:
  Finder(const std::vector<size_t>& untagged, TownObjects* town) : untagged_(untagged), town_(*town) {}

  void Take() {
    Measure();
    if (known_m2_ > kEnoughGround * town_m2_) return;
    if (!Find(IsInsideOut() ? Shown::kBack : Shown::kFront)) Find(Shown::kEither);
  }

 private:
  bool Find(Shown shown) {
    shown_ = shown;
    regions_.clear();
    ground_.clear();
    Draw();
    Join();
    if (std::none_of(regions_.begin(), regions_.end(), [&](const Region& r) { return IsLarge(r); })) return false;
    LookAtWalls();
    LookUp();
    return Choose() && Move();
  }

  template <typename Use>
  void ForTriangles(Use use) const {
    for (const size_t i : untagged_)
      for (const Triangle3& t : town_.obstacles[i].triangles) use(t);
  }

  void Measure() {
    for (const size_t i : untagged_) {
      const TownObject& o = town_.obstacles[i];
      min_m_ = {std::min(min_m_.x, o.min_m.x), std::min(min_m_.y, o.min_m.y)};
      max_m_ = {std::max(max_m_.x, o.max_m.x), std::max(max_m_.y, o.max_m.y)};
    }
    town_m2_ = (max_m_.x - min_m_.x) * (max_m_.y - min_m_.y);
    flat_alone_ = !town_.flat.empty() && town_.flat.size() == town_.ground.size();
    for (const GroundPatch& patch : town_.ground) known_m2_ += flat_alone_ ? 0 : PlanArea(patch.triangles);
  }

  GroundRaster Blank() const {
    double cell_m = kCell_m;
    while (town_m2_ / (cell_m * cell_m) > kMaxCells) cell_m *= 2;
    return BlankRaster(min_m_, max_m_, cell_m);
  }

  // Whether what is seen from above are mostly the backs of faces, as where a mirrored model was written.
  bool IsInsideOut() const {
    const auto seen = [&](Shown shown) {
      return SeenFromAbove(Blank(), town_.obstacles, [&](const Triangle3& t) { return ShowsUpwards(t, shown); });
    };
    const GroundRaster fronts = seen(Shown::kFront), backs = seen(Shown::kBack);
    size_t front = 0, back = 0;
    for (size_t cell = 0; cell < fronts.height_m.size(); ++cell) {
      const float f = fronts.height_m[cell], b = backs.height_m[cell];
      if (f != kNoHeight && (b == kNoHeight || f <= b)) ++front;
      else if (b != kNoHeight) ++back;
    }
    return back > front;
  }

  // The lowest face that shows upwards, cell by cell.
  void Draw() {
    surface_ = Blank();
    sheets_ = Blank();
    if (flat_alone_)
      for (const GroundPatch& patch : town_.ground)
        for (const Triangle3& t : patch.triangles) DrawArea(t, &surface_), DrawArea(t, &sheets_);
    for (const size_t i : untagged_) {
      const std::vector<Triangle3>& triangles = town_.obstacles[i].triangles;
      const std::vector<bool> of_sheets = AreOfSheets(i);
      for (size_t t = 0; t < triangles.size(); ++t) {
        if (!ShowsUpwards(triangles[t], shown_)) continue;
        DrawArea(triangles[t], &surface_);
        if (of_sheets[t]) DrawArea(triangles[t], &sheets_);
      }
    }
    shown_m2_ = ShownArea();
  }

  // What hangs together in an object: of each triangle the first of its part; kNone: it repeats another.
  const std::vector<size_t>& PartsOf(size_t object) {
    std::vector<size_t>& parts = parts_[object];
    const std::vector<Triangle3>& triangles = town_.obstacles[object].triangles;
    if (parts.size() == triangles.size()) return parts;
    const WeldedShell shell = Weld(triangles);
    DisjointSets sets(shell.points.size());
    for (const Corners& t : shell.triangles) sets.Join(t[0], t[1]), sets.Join(t[0], t[2]);
    std::vector<size_t> first(shell.points.size(), kNone);
    parts.assign(triangles.size(), kNone);
    for (size_t i = 0; i < shell.triangles.size(); ++i) {
      size_t& part = first[sets.Root(shell.triangles[i][0])];
      if (part == kNone) part = shell.source[i];
      parts[shell.source[i]] = part;
    }
    return parts;
  }

  // Of each triangle of an object, whether its part is a sheet.
  std::vector<bool> AreOfSheets(size_t object) {
    const std::vector<size_t>& parts = PartsOf(object);
    const std::vector<Triangle3>& triangles = town_.obstacles[object].triangles;
    std::vector<double> all_m2(triangles.size(), 0), upwards_m2 = all_m2;
    for (size_t t = 0; t < triangles.size(); ++t) {
      if (parts[t] == kNone) continue;
      all_m2[parts[t]] += AreaOf(triangles[t]);
      if (ShowsUpwards(triangles[t], shown_)) upwards_m2[parts[t]] += AreaOf(triangles[t]);
    }
    std::vector<bool> of_sheets;
    for (const size_t part : parts) of_sheets.push_back(part != kNone && upwards_m2[part] > kSheet * all_m2[part]);
    return of_sheets;
  }

  // In plan, however patchy the town is.
  double ShownArea() const {
    const auto known = std::count_if(surface_.height_m.begin(), surface_.height_m.end(),
                                     [](float height_m) { return height_m != kNoHeight; });
    return static_cast<double>(known) * CellArea();
  }

  bool Known(size_t cell) const { return surface_.height_m[cell] != kNoHeight; }

  template <typename Use>
  void ForCells(Use use) const {
    for (int row = 0; row < surface_.rows; ++row)
      for (int column = 0; column < surface_.columns; ++column) use(column, row, CellAt(surface_, column, row));
  }

  void Join() {
    DisjointSets sets(surface_.height_m.size());
    const double step_m = kStep_m + kSlope * static_cast<double>(surface_.cell_m);
    const auto join = [&](size_t a, size_t b) {
      const bool on =
          Known(a) && Known(b) && std::abs(static_cast<double>(surface_.height_m[a] - surface_.height_m[b])) <= step_m;
      if (on) sets.Join(a, b);
    };
    ForCells([&](int column, int row, size_t cell) {
      if (column > 0) join(cell, cell - 1);
      if (row > 0) join(cell, CellAt(surface_, column, row - 1));
    });
    std::vector<size_t> region_of_root(surface_.height_m.size(), kNone);
    region_.assign(surface_.height_m.size(), kNone);
    for (size_t cell = 0; cell < region_.size(); ++cell) {
      if (!Known(cell)) continue;
      size_t& region = region_of_root[sets.Root(cell)];
      if (region == kNone) region = regions_.size(), regions_.emplace_back();
      region_[cell] = region;
      ++regions_[region].cells;
      if (sheets_.height_m[cell] == surface_.height_m[cell]) ++regions_[region].of_sheets;
    }
  }

  // Calls with each cell at and beside a place.
  template <typename Use>
  void ForCellsBeside(int column, int row, Use use) const {
    for (int r = std::max(row - 1, 0); r <= std::min(row + 1, surface_.rows - 1); ++r)
      for (int c = std::max(column - 1, 0); c <= std::min(column + 1, surface_.columns - 1); ++c)
        use(CellAt(surface_, c, r));
  }

  void LookAtWalls() {
    ForTriangles([&](const Triangle3& t) {
      if (!IsWall(t)) return;
      const double low = std::min({t[0].z, t[1].z, t[2].z}), high = std::max({t[0].z, t[1].z, t[2].z});
      const double x = (t[0].x + t[1].x + t[2].x) / 3, y = (t[0].y + t[1].y + t[2].y) / 3;
      std::vector<size_t> seen;
      ForCellsBeside(ColumnAt(surface_, x), RowAt(surface_, y), [&](size_t cell) {
        const size_t region = region_[cell];
        if (region == kNone || std::find(seen.begin(), seen.end(), region) != seen.end()) return;
        seen.push_back(region);
        const auto z = static_cast<double>(surface_.height_m[cell]);
        if (high > z + kRises_m && low < z + kRises_m) regions_[region].rising_m2 += AreaOf(t);
        if (low < z - kRises_m && high < z + kRises_m) regions_[region].hanging_m2 += AreaOf(t);
      });
    });
  }

  // Counts the cells of each region that something covers.
  void LookUp() {
    const GroundRaster under = SeenFromAbove(Blank(), town_.obstacles, [](const Triangle3& t) { return !IsWall(t); });
    for (size_t cell = 0; cell < region_.size(); ++cell) {
      const bool covered = region_[cell] != kNone && under.height_m[cell] != kNoHeight &&
                           -under.height_m[cell] > surface_.height_m[cell] + static_cast<float>(kRises_m);
      if (covered) ++regions_[region_[cell]].roofed;
    }
  }

  double CellArea() const { return static_cast<double>(surface_.cell_m) * static_cast<double>(surface_.cell_m); }

  double Area(const Region& region) const { return static_cast<double>(region.cells) * CellArea(); }

  bool IsOfSheets(const Region& region) const { return 2 * region.of_sheets > region.cells; }

  // A meadow beside the town, on which nothing stands.
  bool IsBareSheet(const Region& region) const {
    return IsOfSheets(region) && region.rising_m2 + region.hanging_m2 == 0 && region.roofed == 0;
  }

  // Streets and meadows that are objects of their own need no town around them to be known; a court within walls does.
  bool IsLarge(const Region& region) const {
    return Area(region) >= kMinGround * (IsOfSheets(region) ? shown_m2_ : town_m2_);
  }

  bool IsGround(const Region& region) const {
    const bool carries = region.rising_m2 > region.hanging_m2;
    const bool is_bare = region.rising_m2 + region.hanging_m2 == 0 && Area(region) > kBare * town_m2_;
    const double most_hanging_m2 = std::max(kMaxHanging * Area(region), kMaxHangingOfRising * region.rising_m2);
    return (carries || is_bare) && region.hanging_m2 < most_hanging_m2 &&
           static_cast<double>(region.roofed) < kMaxRoofed * static_cast<double>(region.cells);
  }

  bool Choose() {
    double largest_m2 = 0;
    for (const Region& region : regions_)
      if (IsGround(region) && IsLarge(region)) largest_m2 = std::max(largest_m2, Area(region));
    if (largest_m2 == 0 || known_m2_ > kEnoughGround * largest_m2) return false;
    for (const Region& region : regions_)
      ground_.push_back((IsGround(region) || IsBareSheet(region)) && Area(region) >= kMinBesideLargest * largest_m2);
    return true;
  }

  // Of the cells under its middle and its corners, as many as tell.
  bool IsOnGround(const Triangle3& t) const {
    if (!ShowsUpwards(t, shown_)) return false;
    int on = 0, off = 0;
    const auto ask = [&](double x, double y, double z) {
      const int column = ColumnAt(surface_, x), row = RowAt(surface_, y);
      if (column < 0 || row < 0 || column >= surface_.columns || row >= surface_.rows) return;
      double low = 1e300, high = -1e300;
      ForCellsBeside(column, row, [&](size_t cell) {
        if (region_[cell] == kNone || !ground_[region_[cell]]) return;
        low = std::min(low, static_cast<double>(surface_.height_m[cell]));
        high = std::max(high, static_cast<double>(surface_.height_m[cell]));
      });
      const size_t here = region_[CellAt(surface_, column, row)];
      const bool is_on = here != kNone && ground_[here] && z > low - kOnGround_m && z < high + kOnGround_m;
      ++(is_on ? on : off);
    };
    constexpr int kAsked = 6;  // a side
    for (int i = 0; i < kAsked; ++i) {
      for (int j = 0; i + j < kAsked; ++j) {
        const double u = (i + 1.0 / 3) / kAsked, v = (j + 1.0 / 3) / kAsked, w = 1 - u - v;
        ask(w * t[0].x + u * t[1].x + v * t[2].x, w * t[0].y + u * t[1].y + v * t[2].y,
            w * t[0].z + u * t[1].z + v * t[2].z);
      }
    }
    return on > off;
  }

  bool Move() {
    GroundPatch ground{GroundKind::kSquare, {}};
    std::vector<TownObject> left;
    std::vector<bool> asked(town_.obstacles.size(), false);
    for (const size_t i : untagged_) asked[i] = true;
    for (size_t i = 0; i < town_.obstacles.size(); ++i) {
      TownObject& object = town_.obstacles[i];
      if (!asked[i] || Rest(i, &ground)) left.push_back(std::move(object));
    }
    town_.obstacles = std::move(left);
    if (ground.triangles.empty()) return false;
    town_.ground.push_back(std::move(ground));
    return true;
  }

  // Takes the ground out of an object; false where nothing of it is left.
  bool Rest(size_t index, GroundPatch* ground) {
    TownObject* object = &town_.obstacles[index];
    std::vector<bool> asked(object->triangles.size(), true);
    if (flat_alone_) asked = AreOfSheets(index);
    std::vector<Triangle3> rest;
    double all_m2 = 0, rest_m2 = 0;
    for (size_t i = 0; i < object->triangles.size(); ++i) {
      const Triangle3& t = object->triangles[i];
      const bool on = asked[i] && IsOnGround(t);
      all_m2 += AreaOf(t), rest_m2 += on ? 0 : AreaOf(t);
      (on ? ground->triangles : rest).push_back(t);
    }
    if (rest.size() == object->triangles.size()) return true;
    town_.untold.push_back(object->name);
    if (rest.empty() || rest_m2 < kMinLeft * all_m2) return false;
    object->triangles = std::move(rest);
    object->min_m = object->max_m = object->triangles[0][0];
    Grow(object->triangles, &object->min_m, &object->max_m);
    return true;
  }

  const std::vector<size_t>& untagged_;  // of the obstacles
  Shown shown_ = Shown::kFront;
  TownObjects& town_;
  Point2 min_m_{1e300, 1e300}, max_m_{-1e300, -1e300};
  double town_m2_ = 0, known_m2_ = 0, shown_m2_ = 0;
  bool flat_alone_ = false;  // what ground the town has was taken for it since it is flat: there may be more beside it
  GroundRaster surface_, sheets_;
  std::vector<size_t> region_;  // of each cell; kNone: of no surface
  std::vector<Region> regions_;
  std::map<size_t, std::vector<size_t>> parts_;  // of obstacles, as far as they are known
  std::vector<bool> ground_;                     // of each region
};

}  // namespace

void TakeUntoldGround(const std::vector<size_t>& untagged, TownObjects* town) {
  if (untagged.empty()) return;
  Finder(untagged, town).Take();
}

}  // namespace flaneur
