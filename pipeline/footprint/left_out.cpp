#include "pipeline/footprint/left_out.h"

#include <algorithm>
#include <cstdio>
#include <map>

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

// What happens to an object, and its name with what concerns it alone.
struct Loss {
  std::string one, several;  // "leaves nothing", "leave nothing"
  std::string object;
};

// One line for all to whom the same happens. Instances of one thing have one name: said once, with how often.
void AddTogether(const std::vector<Loss>& losses, std::vector<std::string>* warnings) {
  std::vector<const Loss*> first;  // of its kind
  std::map<std::string, std::vector<std::string>> objects;
  std::map<std::string, int> times;
  for (const Loss& loss : losses) {
    if (++times[loss.several + loss.object] > 1) continue;
    if (objects[loss.several].empty()) first.push_back(&loss);
    objects[loss.several].push_back(loss.object);
  }
  for (const Loss* const loss : first) {
    std::vector<std::string>& own = objects[loss->several];
    for (std::string& object : own) {
      if (const int n = times[loss->several + object]; n > 1) object += " (" + std::to_string(n) + " times)";
    }
    warnings->push_back(own.size() == 1 ? own.front() + " " + loss->one
                                        : std::to_string(own.size()) + " objects " + loss->several + ": " +
                                              Listed(own, own.size()));
  }
}

}  // namespace

void WarnOfLeftOut(const Site& site, const TownObjects& town, const std::vector<Shape>& shapes,
                   const std::vector<Rings>& outlines, const std::vector<bool>& has_obstacle,
                   std::vector<std::string>* warnings) {
  WarnOfFlat(town.flat, warnings);
  WarnOfUntold(town.untold, warnings);
  const std::string band = "part between " + Number(site.options.band_m[0]) + " and " + Number(site.options.band_m[1]) +
                           " m over the ground";
  std::vector<Loss> losses;
  for (size_t i = 0; i < town.obstacles.size(); ++i) {
    const TownObject& object = town.obstacles[i];
    const Shape& shape = shapes[i];
    const std::string name = "'" + object.name + "'";
    const double buried_m2 =
        site.ground && object.kind == ObstacleKind::kBuilding ? Buried_m2(*site.ground, object, shape) : 0;
    if (has_obstacle[i]) {
      if (buried_m2 > kMinBuried_m2)
        losses.push_back({"has parts beneath the town's terrain, which were left out",
                          "have parts beneath the town's terrain, which were left out",
                          name + " (" + Number(buried_m2) + " m2)"});
    } else if (IsRound(object) || (shape.lines == 0 && shape.solid.empty())) {
      losses.push_back(
          buried_m2 > 0
              ? Loss{"leaves nothing in the way: it has no " + band + "; it lies beneath the town's terrain",
                     "leave nothing in the way, with no " + band + ", as they lie beneath the town's terrain", name}
              : Loss{"leaves nothing in the way: it has no " + band, "leave nothing in the way, with no " + band,
                     name});
    } else if (object.is_bridge) {
      losses.push_back({"leaves nothing in the way: it is a bridge, and is walked over",
                        "leave nothing in the way: they are bridges, and are walked over", name});
    } else if (!site.options.merge_blocks) {
      const TownObject* taker = Taker(town, shapes, outlines, i);
      const std::string own = name + " (" + Number(Area(shape.solid)) + " m2)", lacks = " no obstacle of ";
      losses.push_back(taker ? Loss{"has" + lacks + "its own: it stands within '" + taker->name + "'",
                                    "have" + lacks + "their own, as they stand within '" + taker->name + "'", own}
                             : Loss{"has" + lacks + "its own: what is left of it is too small",
                                    "have" + lacks + "their own, as what is left of them is too small", own});
    }
  }
  AddTogether(losses, warnings);
}

}  // namespace flaneur
