#include <algorithm>

#include "pipeline/cli/assemble_town.h"
#include "pipeline/cli/baking.h"
#include "pipeline/cli/far_town.h"
#include "pipeline/cli/trust.h"
#include "pipeline/cli/up_option.h"
#include "pipeline/io/scene_tiles.h"

namespace flaneur {
namespace {

constexpr float kBareGroundMargin_m = 15;

// A model of the town as its file has it, and where it goes.
struct TownModel {
  TownPart part;
  Scene scene;
  SceneSource source;
};

// Nothing is said of where it goes but by its own file.
bool IsWhereItsFileSays(const TownPart& part) {
  return part.position_m.x == 0 && part.position_m.y == 0 && part.yaw_deg == 0 && part.scale == 1;
}

bool IsTile(const TownModel& m) { return IsOnMap(m.scene) && IsWhereItsFileSays(m.part); }

// The town's own file first, where it has one.
Error ReadModels(Baking* baking, std::vector<TownModel>* models, Warnings* warnings) {
  const TourSettings& s = baking->settings;
  const std::string crs = s.georeference.crs == "none" ? "" : s.georeference.crs;
  const auto read = [&](const TownPart& part, const std::string& system) -> Error {
    models->push_back({part, {}, {}});
    if (Error e = CheckFilesOfModel(part.file)) return e;
    return ReadScene(part.file, &models->back().scene, warnings, {system, UpAxisNamed(part.up)},
                     &models->back().source);
  };
  if (!s.town.file.empty()) {
    TownPart whole;
    whole.scale = s.town_scale, whole.up = s.town_up;
    if (Error e = SourceFile(baking, 0, &whole.file)) return e;
    if (Error e = read(whole, crs)) return BadSource(baking, 0, e);
  }
  for (const TownPart& part : s.parts)
    if (Error e = read(part, s.town.file.empty() ? crs : "")) return Fail(PlaceOfFile(s, part.file) + e.message);
  return Ok();
}

// Whose place on the map is the town's: its own file's, else the first tile's. Null: it has no such place.
const TownModel* Placed(const TourSettings& s, const std::vector<TownModel>& models) {
  if (!s.town.file.empty()) return &models.front();
  const auto found = std::find_if(models.begin(), models.end(), IsTile);
  return found == models.end() ? nullptr : &*found;
}

// Models that stand where their files have them on the map, and are to stand there: they become one, in the place of
// the first of them. Not where the town has a file of its own that is none.
Error JoinTiles(const TourSettings& s, std::vector<TownModel>* models, Warnings* warnings) {
  const TownModel* const placed = Placed(s, *models);
  if (placed == nullptr || !IsTile(*placed)) return Ok();
  for (TownModel& m : *models)  // what a reader leaves as far away as its file has it
    if (IsWhereItsFileSays(m.part)) MoveNearZero(FarFromZero(kFarForOthers_m, 1, m.scene), &m.scene);
  if (std::count_if(models->begin(), models->end(), IsTile) < 2) return Ok();
  Scene whole;
  TileJoiner joiner(&whole);
  std::vector<TownModel> kept;
  size_t first = models->size();
  for (TownModel& m : *models) {
    if (!IsTile(m)) {
      kept.push_back(std::move(m));
      continue;
    }
    if (Error e = joiner.Add(m.part.file, std::move(m.scene)))
      return Fail(PlaceOfFile(s, m.part.file) + e.message + "; give it a position_m to have it elsewhere");
    if (first == models->size()) first = kept.size(), kept.push_back({m.part, {}, m.source});
  }
  joiner.WarnOfTwice(warnings);
  kept[first].scene = std::move(whole);
  *models = std::move(kept);
  return Ok();
}

}  // namespace

Error ReadTown(Baking* baking, Scene* town, Warnings* warnings) {
  const TourSettings& s = baking->settings;
  std::vector<TownModel> models;
  if (Error e = ReadModels(baking, &models, warnings)) return e;
  if (Error e = JoinTiles(s, &models, warnings)) return e;
  Georeference georeference = s.georeference;
  if (const TownModel* placed = Placed(s, models)) {
    const double scale = static_cast<double>(placed->part.scale);
    town->origin_m = {placed->scene.origin_m.x * scale, placed->scene.origin_m.y * scale};
    town->reference_system = placed->scene.reference_system;
    if (!placed->source.system.empty()) georeference.crs.clear();  // brought from degrees into metres by the reader
  }
  if (s.georeference.crs.empty()) town->reference_system.clear();
  const bool on_one_level = s.town.file.empty() && town->origin_m.x == 0 && town->origin_m.y == 0;
  for (TownModel& m : models)
    AppendScene(std::move(m.scene), m.part.scale, m.part.yaw_deg * kPi / 180, m.part.position_m, town);
  const Point2 by_reader = town->origin_m;
  Point2 moved;
  if (Error e = PlaceTown(georeference, kFarToDraw_m, 1, town, &moved, warnings))
    return Fail("town.georeference: " + e.message);
  baking->town_lowered_m = LowerToZero(kFarToDraw_m, town);
  baking->town_moved_m = {by_reader.x + moved.x, by_reader.y + moved.y};
  // Parts are put on one plane, a town's own model and what has its place on a map may stand on hills.
  if (AddGroundWhereNone(on_one_level, kBareGroundMargin_m, town)) {
    warnings->push_back("most things in the town have no ground under them; a square through their feet was added");
  }
  return Ok();
}

}  // namespace flaneur
