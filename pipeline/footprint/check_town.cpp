#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "pipeline/footprint/band.h"
#include "pipeline/footprint/base_ground.h"
#include "pipeline/footprint/box_grid.h"
#include "pipeline/footprint/check_parts.h"
#include "pipeline/footprint/constants.h"
#include "pipeline/footprint/passages.h"
#include "pipeline/footprint/town_objects.h"

namespace flaneur {
namespace {

bool Meet(Point2 min, Point2 max, const BoundingBox& box, double reach = 0) {
  return min.x <= box.max.x + reach && box.min.x <= max.x + reach && min.y <= box.max.y + reach &&
         box.min.y <= max.y + reach;
}

// What the town itself says should be covered, by object.
struct Footprint {
  const Obstacle* obstacle;
  Rings rings;
  BoundingBox box;
};

class TownCheck {
 public:
  TownCheck(const PreparedTown& town, CheckState* state)
      : town_(town),
        objects_(town.objects),
        state_(*state),
        truth_(FootprintsOf(town.own)),
        truth_grid_(BoxesOf(truth_)),
        obstacle_grid_(GridOf(state->obstacles)) {
    for (const CheckedObstacle& entry : state_.obstacles)
      if (!entry.sound) broken_.push_back(&entry);
  }

  void Run() {
    if (LieApart()) return;
    FindMissing();
    FindWalls();
    FindStrange();
    FindOverCover();
    std::map<std::string, const TownObject*> by_name;
    for (const TownObject& o : objects_.obstacles) by_name.try_emplace(o.name, &o);
    for (const std::string& name : town_.open_shells) {
      const auto found = by_name.find(name);
      const Point2 at = found == by_name.end() ? Point2{}
                                               : Point2{(found->second->min_m.x + found->second->max_m.x) / 2,
                                                        (found->second->min_m.y + found->second->max_m.y) / 2};
      state_.Add(306, name, at, 0, 0, "some walls of '" + name + "' enclose nothing");
    }
  }

 private:
  static std::vector<Footprint> FootprintsOf(const Footprints& own) {
    std::vector<Footprint> all;
    for (const Obstacle& o : own.obstacles) {
      Rings rings{o.outer};
      if (o.outer.empty()) rings = {CircleRing(o.center, o.radius_m)};
      else rings.insert(rings.end(), o.holes.begin(), o.holes.end());
      all.push_back({&o, rings, BoundingBoxOf(rings)});
    }
    return all;
  }
  static std::vector<BoundingBox> BoxesOf(const std::vector<Footprint>& all) {
    std::vector<BoundingBox> boxes;
    for (const Footprint& f : all) boxes.push_back(f.box);
    return boxes;
  }

  // 907. Then every building would lack its obstacle and every obstacle its building.
  bool LieApart() {
    BoundingBox town;
    for (const Footprint& f : truth_) {
      town.min = {std::min(town.min.x, f.box.min.x), std::min(town.min.y, f.box.min.y)};
      town.max = {std::max(town.max.x, f.box.max.x), std::max(town.max.y, f.box.max.y)};
    }
    size_t usable = 0;
    const CheckedObstacle* some = nullptr;
    for (const CheckedObstacle& entry : state_.obstacles) {
      if (entry.rings.empty()) continue;
      if (Meet(entry.min, entry.max, town)) return false;
      ++usable, some = &entry;
    }
    if (usable < 2 || truth_.size() < 2) return false;
    state_.Add(907, "", some->rings[0][0], 0, 0, "no obstacle stands where the town has anything");
    return true;
  }

  // The obstacle that stands for an object has a broken ring, which is said already; what follows from it is not.
  bool IsBroken(const std::string& source, const BoundingBox& box) const {
    return std::any_of(broken_.begin(), broken_.end(), [&](const CheckedObstacle* entry) {
      const Obstacle& o = *entry->obstacle;
      if (o.source == source || o.name == source) return true;
      return std::any_of(o.outer.begin(), o.outer.end(), [&](Point2 p) { return Meet(p, p, box); });
    });
  }

  // 304: objects of which most is uncovered; their walls are not reported once more.
  void FindMissing() {
    struct Cover {
      double all = 0, covered = 0;
      Point2 at;
      BoundingBox box;
    };
    std::map<std::string, Cover> covers;  // by source
    for (const Footprint& f : truth_) {
      Cover& cover = covers[f.obstacle->source];
      if (cover.all == 0) cover.at = f.rings[0][0], cover.box = f.box;
      cover.all += Area(f.rings);
      Rings near;
      for (const size_t i : obstacle_grid_.Near(f.box))
        if (!state_.obstacles[i].duplicate) AddWhole(state_.obstacles[i], &near);
      if (!near.empty()) cover.covered += Area(Intersection(f.rings, UnionOfAreas(near)));
    }
    for (const auto& [source, cover] : covers) {
      if (cover.covered >= kMinMissingShare * cover.all) continue;
      missing_.insert(source);
      if (!IsBroken(source, cover.box))
        state_.Add(304, source, cover.at, cover.covered / cover.all, kMinMissingShare, "'" + source + "'");
    }
  }

  // Spikes cover too.
  static void AddWhole(const CheckedObstacle& entry, Rings* all) {
    all->insert(all->end(), entry.rings.begin(), entry.rings.end());
    all->insert(all->end(), entry.spikes.begin(), entry.spikes.end());
  }

  // What obstacles cover in and round a box, cracks welded.
  Rings CoverNear(const BoundingBox& box) const {
    Rings all;
    for (const size_t i : obstacle_grid_.Near(box, kNearWall_m)) {
      const CheckedObstacle& entry = state_.obstacles[i];
      if (entry.duplicate) continue;
      Rings whole;
      AddWhole(entry, &whole);
      const Rings grown = Offset(UnionOfAreas(whole), kSeam_m);
      all.insert(all.end(), grown.begin(), grown.end());
    }
    return Offset(UnionOfAreas(all), -kSeam_m);
  }

  Rings TruthNear(const BoundingBox& box, double reach = kNearWall_m) const {
    Rings all;
    for (const size_t i : truth_grid_.Near(box, reach))
      all.insert(all.end(), truth_[i].rings.begin(), truth_[i].rings.end());
    return UnionOfAreas(all);
  }

  // Walls without the whole clearance.
  struct Narrow {
    const TownObject* object;
    BoundingBox box;
    std::vector<Segment> walls;
  };

  // 301, 302: once for each object, at the worst place.
  void FindWalls() {
    std::vector<LocalGround> terrain;
    std::vector<Neighbours> neighbours;
    if (!objects_.ground.empty()) terrain.emplace_back(town_.below_bridges ? *town_.below_bridges : town_.ground);
    else neighbours = TellingOfGround(objects_.obstacles, town_.adjoining);
    std::vector<Narrow> narrow;
    for (size_t i = 0; i < objects_.obstacles.size(); ++i) {
      const TownObject& object = objects_.obstacles[i];
      if (missing_.contains(object.name)) continue;
      const BoundingBox box{{object.min_m.x, object.min_m.y}, {object.max_m.x, object.max_m.y}};
      if (IsBroken(object.name, box)) continue;
      if (object.is_bridge || object.kind == ObstacleKind::kTree || object.kind == ObstacleKind::kLamp)
        CheckWalls(object, box, OwnWithoutClearance(object, box), &narrow);
      else
        CheckWalls(object, box, WallsInBand(object, terrain.empty() ? GroundsUnder(object, neighbours[i]) : terrain),
                   &narrow);
    }
    std::stable_sort(narrow.begin(), narrow.end(),
                     [](const Narrow& a, const Narrow& b) { return Length(a.walls) > Length(b.walls); });
    for (const Narrow& n : narrow) TellNarrow(n);
  }

  // Over the same ground as the extraction's.
  std::vector<Segment> WallsInBand(const TownObject& object, const std::vector<LocalGround>& grounds) const {
    std::vector<Segment> walls;
    for (const LocalGround& ground : grounds) {
      const std::vector<Segment> more = Lines(CutToBand(object.triangles, ground, state_.footprints.band_m));
      walls.insert(walls.end(), more.begin(), more.end());
    }
    return walls;
  }

  // What the extraction covers, less the clearance: of trunks, and of bridges, whose decks are ways.
  std::vector<Segment> OwnWithoutClearance(const TownObject& object, const BoundingBox& box) const {
    const double clearance_m = std::max(state_.clearance_m, 0.0);
    std::vector<Segment> lines;
    for (const size_t i : truth_grid_.Near(box, kNearWall_m)) {
      const Footprint& f = truth_[i];
      if (f.obstacle->source != object.name) continue;
      const double radius = f.obstacle->radius_m - clearance_m;
      if (f.obstacle->outer.empty() && radius <= 0) continue;
      const std::vector<Segment> more = Outline(
          f.obstacle->outer.empty() ? Rings{CircleRing(f.obstacle->center, radius)} : Offset(f.rings, -clearance_m));
      lines.insert(lines.end(), more.begin(), more.end());
    }
    return lines;
  }

  void CheckWalls(const TownObject& object, const BoundingBox& box, const std::vector<Segment>& walls,
                  std::vector<Narrow>* narrow) {
    const double tolerance = state_.options.tolerance_m, short_of = state_.clearance_m - tolerance;
    const Rings cover = CoverNear(box);
    const std::vector<Segment> bare = Outside(walls, Offset(cover, tolerance));
    if (Length(bare) > kMinWallFinding_m) {
      const auto [depth, at] = Worst(bare, AreaIndex(cover, std::max(1.0, 2 * state_.clearance_m)));
      wrong_.insert(object.name);
      state_.Add(301, object.name, at, -depth, tolerance,
                 "a wall of '" + object.name + "' stands out by " + Metres(-depth));
      return;
    }
    if (short_of <= 0) return;
    const Rings enough = Offset(cover, -(short_of - kOutlineRounding_m));
    const std::vector<Segment> near = Outside(walls, enough);
    if (Length(near) > kMinWallFinding_m) narrow->push_back({&object, box, PiecesOutside(near, enough)});
  }

  // A wall that is shared with a house whose own obstacle is missing or wrong is told of there.
  void TellNarrow(const Narrow& n) {
    const double short_of = state_.clearance_m - state_.options.tolerance_m;
    Rings told;
    for (const size_t i : truth_grid_.Near(n.box, kNearWall_m)) {
      const std::string& source = truth_[i].obstacle->source;
      if (source != n.object->name && (missing_.contains(source) || wrong_.contains(source) || IsBroken(source, n.box)))
        told.insert(told.end(), truth_[i].rings.begin(), truth_[i].rings.end());
    }
    const std::vector<Segment> walls =
        told.empty() ? n.walls
                     : PiecesOutside(n.walls, Offset(UnionOfAreas(told), state_.clearance_m + kOutlineRounding_m));
    if (!told.empty() && Length(walls) <= kMinWallFinding_m) return;
    const auto [depth, at] = Worst(walls, AreaIndex(CoverNear(n.box), std::max(1.0, 2 * state_.clearance_m)));
    const double left = std::max(depth, 0.0);
    if (left >= short_of) return;
    wrong_.insert(n.object->name);
    state_.Add(302, n.object->name, at, left, state_.clearance_m,
               "only " + Metres(left) + " beside a wall of '" + n.object->name + "'");
  }

  static std::pair<double, Point2> Worst(const std::vector<Segment>& walls, const AreaIndex& cover) {
    constexpr int kSamples = 8;  // along each piece
    std::pair<double, Point2> worst{1e300, {}};
    for (const Segment& s : walls) {
      for (int i = 0; i <= kSamples; ++i) {
        const double t = static_cast<double>(i) / kSamples;
        const Point2 p{s.a.x + t * (s.b.x - s.a.x), s.a.y + t * (s.b.y - s.a.y)};
        const double depth = cover.Depth(p);
        if (depth < worst.first) worst = {depth, p};
      }
    }
    return worst;
  }

  // 305
  void FindStrange() {
    for (const CheckedObstacle& entry : state_.obstacles) {
      if (entry.rings.empty() || entry.duplicate || entry.points_missing) continue;
      const double share = Area(Intersection(entry.rings, TruthNear({entry.min, entry.max}))) / Area(entry.rings);
      if (share >= (entry.sound ? kMaxStrangeShare : 1e-9)) continue;
      strange_.insert(&entry);
      state_.Add(305, entry.obstacle->name, entry.rings[0][0], share, kMaxStrangeShare,
                 "'" + entry.obstacle->name + "'");
    }
  }

  // Outlines that were simplified may lie so far out.
  double Outwards_m() const { return std::max(state_.options.tolerance_m, state_.footprints.tolerance_m); }

  // 303 and 307, each once for an obstacle, at its largest piece.
  void FindOverCover() {
    PassageTest::Options options;
    options.headroom_m = state_.options.headroom_m;
    options.person_radius_m = state_.options.person_radius_m;
    const double outwards_m = Outwards_m();
    options.slack_m = outwards_m + kOutlineRounding_m;
    options.ends_m = state_.clearance_m + 2 * state_.options.tolerance_m;
    const PassageTest passages(objects_, town_.ground, options);
    for (const CheckedObstacle& entry : state_.obstacles) {
      if (!entry.sound || entry.rings.empty() || entry.duplicate || strange_.contains(&entry)) continue;
      const Rings truth = TruthNear({entry.min, entry.max});
      const Rings beyond = Difference(entry.rings, Offset(truth, outwards_m + kOutlineRounding_m));
      double free = 0, blocked = 0, largest_free = 0, largest_blocked = 0;
      Point2 free_at, blocked_at;
      for (const Polygon& piece : ToPolygons(beyond)) {
        Rings rings{piece.outer};
        rings.insert(rings.end(), piece.holes.begin(), piece.holes.end());
        const double area = Area(rings);
        if (area < kMinFinding_m2) continue;
        const PassageParts parts =
            passages.Sort(rings, TruthNear({entry.min, entry.max}, PassageTest::kFarthestWall_m));
        free += parts.elsewhere_m2, blocked += parts.passage_m2;
        if (parts.elsewhere_m2 > largest_free) largest_free = parts.elsewhere_m2, free_at = parts.elsewhere_at;
        if (parts.passage_m2 > largest_blocked) largest_blocked = parts.passage_m2, blocked_at = parts.passage_at;
      }
      const std::string& name = entry.obstacle->name;
      if (blocked > 0)
        state_.Add(307, name, blocked_at, blocked, 0,
                   "'" + name + "' covers " + SquareMetres(blocked) + " of a way under a building");
      if (free > 0)
        state_.Add(303, name, free_at, free, kMinFinding_m2,
                   "'" + name + "' takes " + SquareMetres(free) + " of free ground");
      else if (blocked == 0) FindExcess(entry, truth);
    }
  }

  // Within the tolerance everywhere, but all in all too much.
  void FindExcess(const CheckedObstacle& entry, const Rings& truth) {
    const double share = state_.options.over_cover_share;
    const Rings excess = Difference(entry.rings, truth);
    const double area = Area(excess), right = Area(entry.rings) - area;
    if (area <= share * right || area <= Outwards_m() / 2 * Length(Outline(entry.rings))) return;
    const std::string& name = entry.obstacle->name;
    state_.Add(303, name, excess[0][0], area / right, share,
               "'" + name + "' takes " + SquareMetres(area) + " all round");
  }

  const PreparedTown& town_;
  const TownObjects& objects_;
  CheckState& state_;
  std::vector<Footprint> truth_;
  BoxGrid truth_grid_, obstacle_grid_;
  std::vector<const CheckedObstacle*> broken_;
  std::set<std::string> missing_, wrong_;  // objects without an obstacle, and those whose walls theirs do not hold
  std::set<const CheckedObstacle*> strange_;
};

}  // namespace

void CheckAgainstTown(const PreparedTown& town, CheckState* state) { TownCheck(town, state).Run(); }

}  // namespace flaneur
