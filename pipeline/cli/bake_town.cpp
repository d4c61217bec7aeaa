#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "pipeline/cli/assemble_town.h"
#include "pipeline/cli/baking.h"
#include "pipeline/cli/far_town.h"
#include "pipeline/cli/stage_inputs.h"
#include "pipeline/cli/town_brightness.h"
#include "pipeline/cli/visit_places.h"
#include "pipeline/cli/work_clips.h"
#include "pipeline/core/temporary_folder.h"
#include "pipeline/footprint/check.h"
#include "pipeline/footprint/map.h"
#include "pipeline/footprint/polygon_sets.h"
#include "pipeline/io/gltf.h"
#include "runtime/base/array.h"
#include "runtime/base/file.h"
#include "runtime/base/limits.h"
#include "runtime/base/text.h"

namespace flaneur {

// For stage_cache.h.
template <typename A>
void Fields(A& a, TownFacts* v) {
  a(&v->places, &v->streets, &v->triangles, &v->brightness, &v->origin_m, &v->moved_m, &v->lowered_m,
    &v->reference_system);
}

namespace {

namespace fs = std::filesystem;

// Streets of tour.toml stand for those of the same name in the town.
void AddUnlessNamed(Street street, TourData* tour) {
  const std::string name = TextIn(street.names, tour->language, tour->language);
  const auto same = [&](const Street& s) { return TextIn(s.names, tour->language, tour->language) == name; };
  if (std::none_of(tour->streets.begin(), tour->streets.end(), same)) tour->streets.push_back(std::move(street));
}

std::string ShapeKey(Baking* baking) {
  std::vector<std::string> contents;
  if (!baking->settings.town.file.empty()) contents.push_back(ContentOf(baking, 0));
  for (const TownPart& part : baking->settings.parts) contents.push_back(ContentOfFile(baking, part.file));
  return TownShapeInputs(baking->settings, contents);
}

// Its warnings are those of reading it, which other steps may do for it first.
Error MakeTown(Baking* baking, StageReport* report) {
  if (Error e = ReadTownOnce(baking)) return e;
  const Scene& town = baking->parts.town;
  baking->town.brightness = BrightnessOf(town, baking->jobs);
  baking->town.places = TaggedPlaces(town);
  baking->town.streets = TaggedStreets(town, baking->settings.language);
  baking->town.origin_m = town.origin_m;
  baking->town.moved_m = baking->town_moved_m;
  baking->town.lowered_m = baking->town_lowered_m;
  baking->town.reference_system = town.reference_system;
  for (const SceneNode& node : town.nodes) {
    for (int m : node.meshes) baking->town.triangles += TriangleCount(At(town.meshes, m));
  }
  report->figures = {{"triangles", baking->town.triangles}};
  return Ok();
}

Error UseTown(Baking* baking, Warnings* warnings) {
  TourParts* parts = &baking->parts;
  parts->places = baking->settings.places;
  TakeIntoMovedTown(baking->town.moved_m, baking->town.lowered_m, parts);
  if (parts->light.exposure == 0) parts->light.exposure = ExposureFor(baking->town.brightness);
  parts->places.insert(parts->places.begin(), baking->town.places.begin(), baking->town.places.end());
  for (const Street& street : baking->town.streets) AddUnlessNamed(street, parts);
  std::vector<AvatarSettings>& avatars = baking->settings.avatars;
  if (Error e = ChooseWorkClips(parts->places, baking->settings.flocks, &avatars, warnings)) return e;
  for (size_t i = 0; i < avatars.size(); ++i) {
    for (const ClipSettings& clip : avatars[i].clips)
      parts->avatars[i].clips.push_back({clip.name, clip.seat_m, clip.speed_mps});
  }
  return Ok();
}

bool Covers(const Obstacle& o, Point2 p) {
  if (o.outer.empty()) return std::hypot(p.x - o.center.x, p.y - o.center.y) <= o.radius_m;
  return Contains(o.outer, p) &&
         std::none_of(o.holes.begin(), o.holes.end(), [&](const auto& hole) { return Contains(hole, p); });
}

// Somewhere there must be ground that nothing stands on.
bool AnywhereToWalk(const GroundRaster& ground, const Footprints& footprints) {
  const double cell_m = static_cast<double>(ground.cell_m);
  for (size_t k = 0; k < ground.kind.size(); ++k) {
    if (ground.kind[k] == 0) continue;
    const size_t columns = static_cast<size_t>(ground.columns), row = k / columns;
    const Point2 p{static_cast<double>(ground.min_m.x) + (static_cast<double>(k % columns) + 0.5) * cell_m,
                   static_cast<double>(ground.min_m.y) + (static_cast<double>(row) + 0.5) * cell_m};
    const auto& obstacles = footprints.obstacles;
    if (std::none_of(obstacles.begin(), obstacles.end(), [&](const Obstacle& o) { return Covers(o, p); })) return true;
  }
  return false;
}

// The player takes no wider one.
Error CheckWidth(const GroundRaster& ground) {
  const double side_m = std::max(ground.columns, ground.rows) * static_cast<double>(ground.cell_m);
  if (side_m <= kMostSide_m) return Ok();
  return Fail("the town is " + Compact(std::ceil(side_m / 1000)) + " km wide, and a tour's may be " +
              Compact(kMostSide_m / 1000) + " km; are its units metres? See the option for the scale");
}

Error MakeFootprints(Baking* baking, StageReport* report, Warnings* warnings) {
  const TourSettings& s = baking->settings;
  TourParts* parts = &baking->parts;
  if (Error e = ReadTownOnce(baking)) return e;
  if (Error e = RasterizeGround(parts->town, s.ground, &parts->ground)) return e;
  if (Error e = CheckWidth(parts->ground)) return e;
  FootprintStats stats;
  if (Error e = ExtractFootprints(parts->town, s.footprints, &parts->footprints, &stats, warnings)) return e;
  if (!AnywhereToWalk(parts->ground, parts->footprints)) {
    return Fail("the town has no walkable ground: " +
                (stats.doubt_of_units.empty()
                     ? "obstacles cover all of it; mark the ground's nodes with flaneur_kind \"ground\""
                     : stats.doubt_of_units));
  }
  report->figures = {{"obstacles", stats.obstacles}, {"covered_m2", stats.covered_m2}};
  return Ok();
}

// The doors and exits of tour.toml; the check finds the town's own by itself.
std::vector<Gate> GatesOfSettings(const Baking& baking) {
  std::vector<Gate> gates;
  for (const Place& place : baking.settings.places) {
    if (place.kind != "door" && place.kind != "exit") continue;
    const Point2 at{static_cast<double>(place.position_m.x), static_cast<double>(place.position_m.y)};
    gates.push_back({place.name, InMovedTown(at, baking.town.moved_m), {}, place.kind == "exit"});
  }
  return gates;
}

// One line for each kind of error: how often, and the first place.
void SummarizeErrors(const std::vector<Finding>& findings, std::vector<std::string>* warnings) {
  std::map<int, std::pair<int, const Finding*>> by_code;
  for (const Finding& f : findings) {
    if (f.severity != Severity::kError) continue;
    auto& [count, first] = by_code[f.code];
    if (count++ == 0) first = &f;
  }
  for (const auto& [code, entry] : by_code) {
    char place[64];
    std::snprintf(place, sizeof place, " at (%.1f, %.1f): ", entry.second->at_m.x, entry.second->at_m.y);
    warnings->push_back(std::to_string(code) + " " + KindOf(code).title + ", " + std::to_string(entry.first) +
                        (entry.first == 1 ? " time: " : " times, first: ") + entry.second->feature + place +
                        entry.second->message);
  }
}

void ReportFindings(const std::vector<Finding>& findings, StageReport* stage, BakeReport* report) {
  double errors = 0, warnings = 0;
  for (const Finding& f : findings) {
    const FindingKind& kind = KindOf(f.code);
    errors += f.severity == Severity::kError ? 1 : 0;
    warnings += f.severity == Severity::kWarning ? 1 : 0;
    report->findings.push_back({f.code,
                                SeverityName(f.severity),
                                kind.title,
                                f.feature,
                                f.reason.empty() ? f.message : f.message + " (accepted: " + f.reason + ")",
                                kind.advice,
                                {static_cast<float>(f.at_m.x), static_cast<float>(f.at_m.y)}});
  }
  stage->figures = {{"errors", errors}, {"warnings", warnings}};
}

std::string ThinCrowd(const Baking& baking) {
  const TourSettings& s = baking.settings;
  if (!s.painting_file.file.empty()) return {};
  return DoubtOfThinCrowd(baking.parts.footprints, baking.parts.ground, baking.parts.places, s.crowd.people,
                          static_cast<float>(CheckOptions{}.person_radius_m));
}

// Findings do not stop a bake: the designer reads them in the report and decides.
Error CheckTown(Baking* baking, StageReport* report, Warnings* warnings) {
  BakeReport* whole = &baking->report;
  CheckOptions options;
  options.gates = GatesOfSettings(*baking);
  MapOptions map;
  map.title = baking->settings.name;
  map.ground = &baking->parts.ground;
  for (const TourStop& stop : baking->parts.path)
    map.stops.push_back({static_cast<double>(stop.position_m.x), static_cast<double>(stop.position_m.y)});
  if (Error e = ReadTownOnce(baking)) return e;
  if (Error e = Check(baking->parts.footprints, &baking->parts.town, options, &map.findings)) return e;
  const std::vector<AcceptedFinding> accepted = InMovedTown(baking->settings.accepted, baking->town.moved_m);
  for (const size_t idle : AcceptFindings(accepted, &map.findings))
    warnings->push_back("footprints.accept " + std::to_string(accepted[idle].code) + " (" + accepted[idle].reason +
                        ") meets no finding any more; remove it, or correct its at_m");
  SummarizeErrors(map.findings, warnings);
  const auto& parts = baking->parts;
  for (std::string& nobody : PlacesNobodyReaches(parts.footprints, parts.ground, parts.path, parts.places,
                                                 static_cast<float>(options.person_radius_m)))
    warnings->push_back(std::move(nobody));
  if (std::string thin = ThinCrowd(*baking); !thin.empty()) warnings->push_back(std::move(thin));
  ReportFindings(map.findings, report, whole);
  TemporaryFolder folder;
  if (Error e = folder.Create("flaneur_map_")) return e;
  const fs::path svg = folder.path() / "map.svg";
  if (Error e = WriteMap(svg, baking->parts.footprints, map)) return e;
  return ReadTextFile(svg, &whole->map_svg);
}

}  // namespace

Error ReadTownOnce(Baking* baking) {
  std::call_once(baking->town_read_once,
                 [&] { baking->town_read = ReadTown(baking, &baking->parts.town, &baking->town_warnings); });
  return baking->town_read;
}

void AddTownSteps(Baking* baking) {
  const TourSettings& s = baking->settings;
  Step* town = AddStep(baking, "town", s.name);
  baking->town_step = static_cast<int>(IndexOf(*baking, town));
  if (baking->source_steps[0] >= 0) town->needs.push_back(static_cast<size_t>(baking->source_steps[0]));
  else if (!s.town.file.empty()) town->inputs.push_back(s.town.file);
  for (const TownPart& part : s.parts) town->inputs.push_back(part.file);
  town->key = [baking] { return TownInputs(baking->settings, ShapeKey(baking)); };
  town->make = [baking](StageReport* report, Warnings* warnings) {
    Error error = MakeTown(baking, report);
    *warnings = baking->town_warnings;
    return error;
  };
  town->then = [baking](Warnings* warnings) { return UseTown(baking, warnings); };
  Keep(town, &baking->town);

  Step* footprints = AddStep(baking, "footprints", s.name);
  footprints->needs = {IndexOf(*baking, town)};
  footprints->key = [baking] { return FootprintsInputs(baking->settings, ShapeKey(baking)); };
  footprints->make = [baking](StageReport* r, Warnings* w) { return MakeFootprints(baking, r, w); };
  Keep(footprints, &baking->parts.footprints, &baking->parts.ground);

  Step* meshes = AddStep(baking, "meshes", s.name);
  meshes->needs = {IndexOf(*baking, town)};
  meshes->key = [baking] { return TownMeshesInputs(ShapeKey(baking)); };
  meshes->make = [baking](StageReport*, Warnings*) {
    if (Error e = ReadTownOnce(baking)) return e;
    return EncodeTown(baking->parts.town, baking->jobs, &baking->parts.encoded_town);
  };
  Keep(meshes, &baking->parts.encoded_town);
  if (s.painting_file.file.empty()) return;

  Step* painting = AddStep(baking, "painting", s.name);  // before the people are made, for it may be wrong
  baking->painting_step = static_cast<int>(IndexOf(*baking, painting));
  painting->needs = {IndexOf(*baking, footprints)};
  painting->inputs = {s.painting_file.file};
  painting->key = [baking, footprints] {
    return footprints->key() + ContentOfFile(baking, baking->settings.painting_file.file);
  };
  painting->make = [baking](StageReport*, Warnings*) {
    const PaintingSettings painted = InMovedTown(baking->settings.painting_file, baking->town.moved_m);
    return ReadPainting(painted, baking->parts.ground, &baking->parts.painting);
  };
}

void AddCheckStep(Baking* baking) {
  Step* check = AddStep(baking, "check", baking->settings.name);
  for (size_t i = 0; i < baking->steps.size(); ++i) {
    if (baking->steps[i].stage == "footprints") check->needs.push_back(i);
  }
  check->key = [baking] { return CheckInputs(baking->settings, FootprintsInputs(baking->settings, ShapeKey(baking))); };
  check->make = [baking](StageReport* r, Warnings* w) { return CheckTown(baking, r, w); };
  Keep(check, &baking->report.findings, &baking->report.map_svg);
}

}  // namespace flaneur
