#include "pipeline/footprint/lost_triangles.h"

#include <algorithm>

#include "pipeline/footprint/constants.h"
#include "pipeline/footprint/floors.h"
#include "pipeline/footprint/for_each.h"
#include "pipeline/footprint/object_shape.h"
#include "pipeline/footprint/repair_block.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

bool IsHouse(const TownObject& object) { return object.kind == ObstacleKind::kBuilding; }

std::vector<MissingTriangle> MissingOf(const std::vector<TownObject>& objects, const std::vector<Shape>& shapes,
                                       const Block& block) {
  const bool any_open =
      std::any_of(block.begin(), block.end(), [&](size_t i) { return shapes[i].open_m > kMaxOpenShell_m; });
  if (!any_open || block.size() == 1) return {};
  std::vector<const TownObject*> houses;
  Block members;
  for (const size_t i : block)
    if (IsHouse(objects[i])) houses.push_back(&objects[i]), members.push_back(i);
  std::vector<MissingTriangle> missing = MissingTogether(houses);
  for (MissingTriangle& each : missing) each.member = members[each.member];
  return missing;
}

bool HasLostTriangles(const std::vector<TownObject>& objects, const std::vector<Shape>& shapes, int missing_together) {
  int missing = missing_together, all = 0;
  for (size_t i = 0; i < objects.size(); ++i) {
    if (!IsHouse(objects[i])) continue;
    missing += shapes[i].lost_triangles;
    all += Count(objects[i].triangles);
  }
  return missing >= kMinLostTriangles && missing >= kMinLostShare * all;
}

void PutBack(const MissingTriangle& missing, TownObject* object) {
  (missing.of_foundation ? object->foundation : object->triangles).push_back(missing.triangle);
  if (!object->foundation_is_given) object->foundation.clear();
}

}  // namespace

std::vector<char> FindFloors(const FootprintOptions& options, double least_share, std::vector<TownObject>* objects) {
  std::vector<char> found(objects->size(), false);
  ForEach(objects->size(), options.threads, [&](size_t i) {
    TownObject& object = (*objects)[i];
    if (!IsHouse(object) || !object.foundation.empty()) return;
    if (!object.is_roof && !object.has_no_floor) object.foundation = FloorOf(object.triangles, least_share);
    found[i] = !object.foundation.empty();
    object.has_no_floor = !found[i];
  });
  return found;
}

bool PutBackLost(const Site& site, const std::vector<Block>& blocks, const std::vector<Neighbours>& neighbours,
                 std::vector<TownObject>* objects, std::vector<Shape>* shapes) {
  std::vector<std::vector<MissingTriangle>> missing(blocks.size());
  const auto find_missing = [&] {
    ForEach(blocks.size(), site.options.threads,
            [&](size_t k) { missing[k] = MissingOf(*objects, *shapes, blocks[k]); });
  };
  find_missing();
  int together = 0;
  for (const std::vector<MissingTriangle>& block : missing)
    for (const MissingTriangle& each : block) together += each.is_of_face;
  if (!HasLostTriangles(*objects, *shapes, together)) return false;
  std::vector<char> changed(objects->size(), false);
  ForEach(objects->size(), site.options.threads, [&](size_t i) {
    TownObject& object = (*objects)[i];
    if (!IsHouse(object)) return;
    const std::vector<MissingTriangle> own = MissingTogether({&object}, Holes::kPartsOfFaces);
    for (const MissingTriangle& each : own) PutBack(each, &object);
    changed[i] = !own.empty();
  });
  find_missing();
  for (const std::vector<MissingTriangle>& block : missing)
    for (const MissingTriangle& each : block) PutBack(each, &(*objects)[each.member]), changed[each.member] = true;
  const std::vector<char> has_new_floor = FindFloors(site.options, kMinFloorLost, objects);
  ForEach(objects->size(), site.options.threads, [&](size_t i) {
    if (!changed[i] && !has_new_floor[i]) return;
    (*shapes)[i] = ShapeOf(site, (*objects)[i], neighbours[i]);
    (*shapes)[i].guessed |= changed[i] != 0;
  });
  return true;
}

}  // namespace flaneur
