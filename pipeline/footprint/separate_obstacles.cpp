#include "pipeline/footprint/separate_obstacles.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pipeline/footprint/band.h"
#include "pipeline/footprint/constants.h"
#include "pipeline/footprint/for_each.h"

namespace flaneur {
namespace {

bool Apart(const BoundingBox& a, const BoundingBox& b) {
  return a.max.x < b.min.x || b.max.x < a.min.x || a.max.y < b.min.y || b.max.y < a.min.y;
}

Rings WithoutSpecks(const Rings& rings) {
  Rings out;
  for (const Polygon& polygon : ToPolygons(rings)) {
    if (SignedArea(polygon.outer) < kMinPiece_m2) continue;
    out.push_back(polygon.outer);
    out.insert(out.end(), polygon.holes.begin(), polygon.holes.end());
  }
  return out;
}

// Whether nothing is thin or short about an outline, so that there is nothing to tidy. May say no too often.
bool IsTidy(const Rings& rings, double width_m) {
  constexpr size_t kMaxPoints = 64;            // looking at each pair of more takes longer than to tidy
  constexpr double kSharpCornerCosine = -0.9;  // cosine; sharper corners are looked at more closely
  size_t points = 0;
  for (const Ring& ring : rings) {
    points += ring.size();
    if (std::abs(SignedArea(ring)) < kMinPiece_m2) return false;
  }
  if (points > kMaxPoints) return false;
  const std::vector<Segment> edges = Outline(rings);
  const auto same = [](Point2 p, Point2 q) { return p.x == q.x && p.y == q.y; };
  for (size_t i = 0; i < edges.size(); ++i) {
    const Segment& s = edges[i];
    if (Length(s) < width_m) return false;
    for (size_t j = 0; j < edges.size(); ++j) {
      const Segment& t = edges[j];
      if (i == j || same(t.b, s.a)) continue;
      if (same(t.a, s.b)) {
        const double along = (s.b.x - s.a.x) * (t.b.x - t.a.x) + (s.b.y - s.a.y) * (t.b.y - t.a.y);
        if (along < kSharpCornerCosine * Length(s) * Length(t)) return false;
      } else if (DistanceToSegment(s.a, t.a, t.b) < 2 * width_m || DistanceToSegment(s.b, t.a, t.b) < 2 * width_m) {
        return false;
      }
    }
  }
  return true;
}

// A strip or speck too small to stay with its own obstacle goes to the neighbour it lies against, so that no wall loses
// its clearance.
void AssignToNeighbours(const Rings& strips, size_t from, const std::vector<size_t>& neighbours, double width_m,
                        std::vector<BoundingBox>* boxes, std::vector<Rings>* enlarged) {
  for (const Polygon& strip : ToPolygons(strips)) {
    Rings rings{strip.outer};  // a strip may run all round a house
    rings.insert(rings.end(), strip.holes.begin(), strip.holes.end());
    if (Area(rings) < kMinStrip_m2) continue;
    const Rings grown = Offset(rings, kAgainst_m);
    size_t owner = from;
    double most = 0;
    for (const size_t j : neighbours) {
      if ((*enlarged)[j].empty() || Apart((*boxes)[j], BoundingBoxOf(grown))) continue;
      const double shared = Area(Intersection(grown, (*enlarged)[j]));
      if (shared > most) most = shared, owner = j;
    }
    if (owner == from) continue;
    (*enlarged)[owner] = Tidy(Union((*enlarged)[owner], grown), width_m);
    (*boxes)[owner] = BoundingBoxOf((*enlarged)[owner]);
  }
}

// For each box the others within reach, ascending.
std::vector<std::vector<size_t>> Neighbours(const std::vector<BoundingBox>& boxes) {
  std::vector<size_t> from_west(boxes.size());
  std::iota(from_west.begin(), from_west.end(), size_t{0});
  std::sort(from_west.begin(), from_west.end(), [&](size_t i, size_t j) { return boxes[i].min.x < boxes[j].min.x; });
  std::vector<std::vector<size_t>> neighbours(boxes.size());
  for (size_t k = 0; k < from_west.size(); ++k) {
    const size_t i = from_west[k];
    for (size_t l = k + 1; l < from_west.size(); ++l) {
      const size_t j = from_west[l];
      if (boxes[j].min.x > boxes[i].max.x + kBlockReach_m) break;
      if (boxes[j].min.y > boxes[i].max.y + kBlockReach_m || boxes[i].min.y > boxes[j].max.y + kBlockReach_m) continue;
      neighbours[i].push_back(j), neighbours[j].push_back(i);
    }
  }
  for (std::vector<size_t>& each : neighbours) std::sort(each.begin(), each.end());
  return neighbours;
}

// Those that hang together by neighbours, each group ascending.
std::vector<std::vector<size_t>> Groups(const std::vector<std::vector<size_t>>& neighbours) {
  std::vector<std::vector<size_t>> groups;
  std::vector<bool> done(neighbours.size(), false);
  for (size_t first = 0; first < neighbours.size(); ++first) {
    if (done[first]) continue;
    done[first] = true;
    std::vector<size_t> group{first};
    for (size_t k = 0; k < group.size(); ++k) {
      for (const size_t other : neighbours[group[k]]) {
        if (done[other]) continue;
        done[other] = true;
        group.push_back(other);
      }
    }
    std::sort(group.begin(), group.end());
    groups.push_back(std::move(group));
  }
  return groups;
}

// Where two houses stand in each other by more than a clumsy joint, both keep what is theirs.
Rings GroundOfBoth(const Shape& a, const BoundingBox& box_a, const Shape& b, const BoundingBox& box_b) {
  if (std::min(box_a.max.x, box_b.max.x) - std::max(box_a.min.x, box_b.min.x) < kJoint_m ||
      std::min(box_a.max.y, box_b.max.y) - std::max(box_a.min.y, box_b.min.y) < kJoint_m)
    return {};
  Rings shared;
  for (const Polygon& piece : ToPolygons(Intersection(a.solid, b.solid))) {
    Rings rings{piece.outer};
    rings.insert(rings.end(), piece.holes.begin(), piece.holes.end());
    if (!Offset(rings, -kJoint_m / 2).empty()) shared.insert(shared.end(), rings.begin(), rings.end());
  }
  return shared;
}

}  // namespace

void SeparateObstacles(const std::vector<TownObject>& objects, const std::vector<Shape>& shapes, double width_m,
                       int threads, std::vector<Rings>* enlarged) {
  const auto is_house = [&](size_t i) { return objects[i].kind == ObstacleKind::kBuilding; };
  const auto append = [](const Rings& more, Rings* to) { to->insert(to->end(), more.begin(), more.end()); };
  std::vector<BoundingBox> solid_boxes, boxes;
  for (const Shape& shape : shapes) solid_boxes.push_back(BoundingBoxOf(shape.solid));
  for (const Rings& rings : *enlarged) boxes.push_back(BoundingBoxOf(rings));
  const std::vector<std::vector<size_t>> neighbours = Neighbours(boxes);
  const auto separate = [&](size_t i) {
    Rings taken, later;
    for (const size_t j : neighbours[i]) {
      if ((*enlarged)[j].empty()) continue;
      if (j < i && !Apart(boxes[i], boxes[j])) {
        const Rings shared =
            is_house(i) && is_house(j) ? GroundOfBoth(shapes[i], solid_boxes[i], shapes[j], solid_boxes[j]) : Rings();
        append(shared.empty() ? (*enlarged)[j] : Difference((*enlarged)[j], shared), &taken);
      }
      if (j > i && !Apart(boxes[i], solid_boxes[j])) append(shapes[j].solid, &later);
    }
    append(DifferenceOfAreas(later, shapes[i].solid), &taken);
    (*enlarged)[i] = DifferenceOfAreas((*enlarged)[i], taken);
    if (IsTidy((*enlarged)[i], width_m)) return;
    const Rings kept = WithoutSpecks(Tidy((*enlarged)[i], width_m));
    const Rings strips = Difference((*enlarged)[i], Offset(kept, kAgainst_m));
    (*enlarged)[i] = kept;
    AssignToNeighbours(strips, i, neighbours[i], width_m, &boxes, enlarged);
  };
  // Tidying moves corners by hairs, and strips that were given away may reach over a third one's.
  const auto part = [&](size_t i) {
    Rings taken;
    const BoundingBox box = BoundingBoxOf((*enlarged)[i]);
    for (const size_t j : neighbours[i]) {
      if (j > i || (*enlarged)[j].empty() || Apart(box, BoundingBoxOf((*enlarged)[j]))) continue;
      const Rings both = Intersection((*enlarged)[i], (*enlarged)[j]);
      if (Area(both) < kMinOverlap_m2) continue;
      const Rings shared =
          is_house(i) && is_house(j) ? GroundOfBoth(shapes[i], solid_boxes[i], shapes[j], solid_boxes[j]) : Rings();
      append(shared.empty() ? both : Difference(both, shared), &taken);
    }
    if (Area(taken) < kMinOverlap_m2) return;
    const Rings rest = Difference((*enlarged)[i], Offset(UnionOfAreas(taken), kAgainst_m));
    (*enlarged)[i] = WithoutSpecks(Tidy(rest, width_m));
  };
  const std::vector<std::vector<size_t>> groups = Groups(neighbours);
  ForEach(groups.size(), threads, [&](size_t k) {
    std::for_each(groups[k].begin(), groups[k].end(), separate);
    std::for_each(groups[k].begin(), groups[k].end(), part);
  });
}

}  // namespace flaneur
