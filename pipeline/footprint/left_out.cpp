#include "pipeline/footprint/left_out.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <utility>

#include "pipeline/core/listed.h"
#include "pipeline/footprint/constants.h"
#include "pipeline/footprint/object_shape.h"

namespace flaneur {
namespace {

std::string Number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

void WarnOfFlat(const std::vector<std::string>& flat, std::vector<std::string>* warnings) {
  if (flat.empty()) return;
  warnings->push_back(std::to_string(flat.size()) + " untagged objects no higher than " + Number(kMaxFlatHeight_m) +
                      " m were taken for ground and block nobody: " + Listed(flat, flat.size(), "'"));
}

void WarnOfUntold(const std::vector<std::string>& untold, std::vector<std::string>* warnings) {
  if (untold.empty()) return;
  constexpr size_t kNamed = 8;
  warnings->push_back("the town's ground was found by its shape, in " + Listed(untold, kNamed, "'") +
                      ": tag what it is, or give it a name");
}

bool IsRound(const TownObject& object) {
  return object.kind == ObstacleKind::kTree || object.kind == ObstacleKind::kLamp;
}

// Who has most of the ground on which an object stands; null: nobody.
const TownObject* Taker(const TownObjects& town, const std::vector<Shape>& shapes, const std::vector<Rings>& outlines,
                        size_t of) {
  const TownObject* taker = nullptr;
  const BoundingBox box = BoundingBoxOf(shapes[of].solid);
  double most_m2 = 0;
  for (size_t i = 0; i < outlines.size(); ++i) {
    const TownObject& other = town.obstacles[i];
    if (i == of || other.max_m.x < box.min.x || box.max.x < other.min_m.x || other.max_m.y < box.min.y ||
        box.max.y < other.min_m.y)
      continue;
    const double shared_m2 = Area(Intersection(shapes[of].solid, outlines[i]));
    if (shared_m2 > most_m2) most_m2 = shared_m2, taker = &other;
  }
  return taker;
}

// Of the ground that an object covers, what its parts beneath the terrain alone cover.
double Buried_m2(const LocalGround& ground, const TownObject& object, const Shape& shape) {
  const auto is_below = [&](const Point3& p) { return p.z < ground.Height(p.x, p.y) - kRoofOverFloor_m; };
  std::vector<Triangle3> below;
  for (const Triangle3& t : object.triangles)
    if (std::all_of(t.begin(), t.end(), is_below)) below.push_back(t);
  return below.empty() ? 0 : Area(Difference(InPlan(below), shape.solid));
}

// Instances of one thing have one name, and the same happens to them: said once, with how often.
void AddOnce(const std::vector<std::string>& said, std::vector<std::string>* warnings) {
  std::map<std::string, int> times;
  for (const std::string& each : said) ++times[each];
  for (const std::string& each : said) {
    const int n = std::exchange(times[each], 0);
    if (n > 0) warnings->push_back(n == 1 ? each : each + " (" + std::to_string(n) + " times)");
  }
}

}  // namespace

void WarnOfLeftOut(const Site& site, const TownObjects& town, const std::vector<Shape>& shapes,
                   const std::vector<Rings>& outlines, const std::vector<bool>& has_obstacle,
                   std::vector<std::string>* warnings) {
  WarnOfFlat(town.flat, warnings);
  WarnOfUntold(town.untold, warnings);
  std::vector<std::string> said;
  for (size_t i = 0; i < town.obstacles.size(); ++i) {
    const TownObject& object = town.obstacles[i];
    const Shape& shape = shapes[i];
    const double buried_m2 =
        site.ground && object.kind == ObstacleKind::kBuilding ? Buried_m2(*site.ground, object, shape) : 0;
    if (has_obstacle[i]) {
      if (buried_m2 > kMinBuried_m2)
        said.push_back("'" + object.name + "': parts over " + Number(buried_m2) +
                       " m2 lie beneath the town's terrain and were left out");
    } else if (IsRound(object) || (shape.lines == 0 && shape.solid.empty())) {
      said.push_back("'" + object.name + "' leaves nothing in the way: it has no part between " +
                     Number(site.options.band_m[0]) + " and " + Number(site.options.band_m[1]) + " m over the ground" +
                     (buried_m2 > 0 ? "; it lies beneath the town's terrain" : ""));
    } else if (object.is_bridge) {
      said.push_back("'" + object.name + "' leaves nothing in the way: it is a bridge, and is walked over");
    } else if (!site.options.merge_blocks) {
      const TownObject* taker = Taker(town, shapes, outlines, i);
      said.push_back("'" + object.name + "' (" + Number(Area(shape.solid)) + " m2) has no obstacle of its own: " +
                     (taker ? "it stands within '" + taker->name + "'" : "what is left of it is too small"));
    }
  }
  AddOnce(said, warnings);
}

}  // namespace flaneur
