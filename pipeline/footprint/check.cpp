#include "pipeline/footprint/check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "pipeline/footprint/blocks.h"
#include "pipeline/footprint/check_parts.h"
#include "pipeline/footprint/constants.h"
#include "pipeline/footprint/extract_footprints.h"
#include "pipeline/footprint/feet.h"
#include "pipeline/footprint/lost_triangles.h"
#include "pipeline/footprint/rasterize_ground.h"

namespace flaneur {

void CheckState::Add(int code, const std::string& feature, Point2 at, double value, double limit,
                     const std::string& detail, const std::string& other) {
  const FindingKind& kind = KindOf(code);
  findings->push_back({code, kind.severity, feature, other, at, value, limit,
                       detail.empty() ? kind.title : std::string(kind.title) + ": " + detail});
}

BoxGrid GridOf(const std::vector<CheckedObstacle>& obstacles) {
  std::vector<BoundingBox> boxes;
  for (const CheckedObstacle& entry : obstacles)
    boxes.push_back(entry.rings.empty() ? BoundingBox{} : BoundingBox{entry.min, entry.max});
  return BoxGrid(std::move(boxes));
}

std::string Metres(double value) {
  char text[40];
  std::snprintf(text, sizeof text, std::abs(value) < 0.1 ? "%.3f m" : "%.2f m", value);
  return text;
}

std::string SquareMetres(double value) {
  char text[40];
  std::snprintf(text, sizeof text, value < 0.1 ? "%.4f m2" : "%.2f m2", value);
  return text;
}

const std::vector<CheckNumber>& CheckNumbers() {
  using O = CheckOptions;
  static const std::vector<CheckNumber> numbers = {
      {"tolerance-m", "Distances may be off by this", &O::tolerance_m, false},
      {"person-radius-m", "Of the people who are to pass", &O::person_radius_m, false},
      {"same-point-m", "Neighbours in a ring that are nearer are reported (102)", &O::same_point_m, false},
      {"least-area-m2", "Of a ring (106), and of what a hole covers wrongly (201, 202)", &O::least_area_m2, true},
      {"largest-coordinate-m", "Coordinates beyond are reported (107)", &O::largest_coordinate_m, false},
      {"spike-width-m", "What an opening with this radius takes away is a spike (203),", &O::spike_width_m, false},
      {"spike-length-m", "where it is longer than this", &O::spike_length_m, false},
      {"over-cover-share", "Of a footprint's area that may be covered too much (303)", &O::over_cover_share, true},
      {"headroom-m", "Over a passage (307)", &O::headroom_m, false},
      {"overlap-m2", "Obstacles may overlap by this (401)", &O::overlap_m2, true},
      {"least-ground-m2", "Smaller ground out of reach is not reported (501)", &O::least_ground_m2, false},
      {"dead-end-m", "Deeper dead ends are reported (502)", &O::dead_end_m, false},
      {"high-resolution-radius-m", "Round the visitor, for traps (503)", &O::high_resolution_radius_m, false},
      {"scale", "Metres per unit of the town's file", &O::scale, false},
  };
  return numbers;
}

Error Validate(const CheckOptions& options) {
  for (const CheckNumber& number : CheckNumbers()) {
    const double value = options.*number.value;
    if (std::isfinite(value) && (number.may_be_zero ? value >= 0 : value > 0)) continue;
    return Fail(std::string("the check's ") + number.name + " must be " +
                (number.may_be_zero ? "at least" : "greater than") + " zero");
  }
  if (options.most_points < 3) return Fail("the check's most-points must be at least 3");
  return Ok();
}

namespace {

// 306, as the extraction has noted it; once for each building.
void AddOpenShells(CheckState* state) {
  std::set<std::string> told;
  for (const Obstacle& o : state->footprints.obstacles)
    if (o.open_shell && told.insert(o.source.empty() ? o.name : o.source).second)
      state->Add(306, o.name, o.outer.empty() ? o.center : o.outer[0], 0, 0,
                 "the extraction had to guess at '" + o.name + "'");
}

}  // namespace

Error PrepareTown(const Scene& town, const Footprints& footprints, const CheckOptions& options,
                  PreparedTown* prepared) {
  FootprintOptions extraction;
  extraction.clearance_m = std::max(options.clearance_m >= 0 ? options.clearance_m : footprints.clearance_m, 0.0);
  extraction.band_m = footprints.band_m;
  extraction.scale = options.scale;
  extraction.tolerance_m = 0;
  extraction.threads = options.threads;
  FootprintStats stats;
  *prepared = {};
  prepared->scene = &town;
  if (Error error = ExtractFootprints(town, extraction, &prepared->own, &stats)) return error;
  prepared->open_shells = std::move(stats.open_shells);
  prepared->objects = SortTown(town, options.scale);
  if (prepared->objects.ground.empty()) {  // what stands on no ground stands where the extraction says
    std::vector<TownObject>& objects = prepared->objects.obstacles;
    prepared->adjoining = Adjoining(objects);
    FindLevelFeet(BlocksOf(prepared->adjoining), options.threads, &objects);
    FindFloors(extraction, kMinFloor, &objects);
  }
  if (!prepared->objects.ground.empty() && HasBridge(prepared->objects)) {
    GroundRasterOptions below_bridges;
    below_bridges.with_decks = false;
    if (Error error = RasterizeGround(prepared->objects, below_bridges, &prepared->below_bridges.emplace()))
      return error;
  }
  return RasterizeGround(prepared->objects, {}, &prepared->ground);
}

Error Check(const Footprints& footprints, const Scene* town, const CheckOptions& options,
            std::vector<Finding>* findings) {
  if (Error error = Validate(options)) return error;
  if (!town) return CheckPrepared(footprints, nullptr, options, findings);
  PreparedTown prepared;
  if (Error error = PrepareTown(*town, footprints, options, &prepared)) return error;
  return CheckPrepared(footprints, &prepared, options, findings);
}

Error CheckPrepared(const Footprints& footprints, const PreparedTown* town, const CheckOptions& options,
                    std::vector<Finding>* findings) {
  if (Error error = Validate(options)) return error;
  findings->clear();
  const double clearance = options.clearance_m >= 0 ? options.clearance_m : footprints.clearance_m;
  CheckState state{footprints, options, clearance, {}, findings};
  for (const Obstacle& o : footprints.obstacles) state.obstacles.emplace_back().obstacle = &o;
  CheckRings(&state);
  CheckPairs(&state);
  if (town) {
    CheckAgainstTown(*town, &state);
  } else {
    AddOpenShells(&state);
  }
  if (Error error = CheckWays(town, &state)) return error;
  CheckStreets(&state);
  SortFindings(findings);
  JoinFindings(footprints.obstacles.size(), findings);
  return Ok();
}

std::vector<Gate> GatesOf(const Scene& town, double scale) {
  std::vector<Gate> gates;
  for (const SceneNode& node : town.nodes) {
    if (node.kind != NodeKind::kDoor && node.kind != NodeKind::kExit) continue;
    const Vec3 at = GroundFromGltf(TransformPoint(node.world, {0, 0, 0}));
    const Vec3 ahead = GroundFromGltf(TransformDirection(node.world, {0, 0, 1}));
    const double length = std::hypot(ahead.x, ahead.y);
    Gate gate{node.name, {at.x * scale, at.y * scale}, {}, node.kind == NodeKind::kExit};
    if (length > 1e-6) gate.ahead = {ahead.x / length, ahead.y / length};
    gates.push_back(std::move(gate));
  }
  return gates;
}

}  // namespace flaneur
