#include "flaneur/footprints.h"

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "library/boundary.h"
#include "library/id_pool.h"
#include "pipeline/footprint/check.h"
#include "pipeline/footprint/extract_footprints.h"
#include "pipeline/io/town_builder.h"

namespace {

using namespace flaneur;

constexpr int kFootprintsCookie = 0x464f4f54, kCheckCookie = 0x43484543;  // "FOOT", "CHEC"
constexpr double kFarthest_m = 1e8;                                       // no map reaches farther; see TownBuilder
constexpr double kMaxArea_m2 = 1e10;

struct Town {
  Scene scene;
  Footprints footprints;
  std::vector<std::string> warnings;
  std::vector<Finding> findings;
  // What spans point to.
  std::vector<std::vector<FlaneurPoint>> points;
  std::vector<std::vector<FlaneurRing>> holes;
  std::vector<FlaneurObstacle> obstacles;
  std::vector<const char*> warning_texts;
  std::vector<FlaneurFinding> finding_items;
};

IdPool<FlaneurFootprintsId, Town>& Towns() {
  static auto* towns = new IdPool<FlaneurFootprintsId, Town>;  // outlives whatever the program does at its end
  return *towns;
}

LastError& Last() {
  static thread_local LastError last;
  return last;
}

NodeKind NodeKindOf(int kind) {
  constexpr std::array kKinds{NodeKind::kUntagged, NodeKind::kBuilding, NodeKind::kWall,  NodeKind::kTree,
                              NodeKind::kLamp,     NodeKind::kOther,    NodeKind::kGround};
  return kKinds[static_cast<size_t>(kind)];
}

FlaneurObjectKind KindFrom(ObstacleKind kind) {
  switch (kind) {
    case ObstacleKind::kBuilding:
      return FLANEUR_OBJECT_BUILDING;
    case ObstacleKind::kWall:
      return FLANEUR_OBJECT_WALL;
    case ObstacleKind::kTree:
      return FLANEUR_OBJECT_TREE;
    case ObstacleKind::kLamp:
      return FLANEUR_OBJECT_LAMP;
    case ObstacleKind::kOther:
      break;
  }
  return FLANEUR_OBJECT_OTHER;
}

std::string NameOf(const char* name, const char* otherwise, int number) {
  return name ? name : std::string(otherwise) + "_" + std::to_string(number);
}

Failure CheckObject(const FlaneurObject& object, const std::string& name) {
  if (object.kind < FLANEUR_OBJECT_BY_NAME || object.kind > FLANEUR_OBJECT_GROUND)
    return OutOfRange("'" + name + "': kind", "a FlaneurObjectKind");
  if (object.vertex_count < 0 || object.index_count < 0) return OutOfRange("'" + name + "': a count", "at least 0");
  if (object.vertex_count > 0 && !object.positions_m) return NullPointer("positions_m");
  if (object.index_count > 0 && !object.indices) return NullPointer("indices");
  const int corners = object.indices ? object.index_count : object.vertex_count;
  if (corners % 3 != 0) return OutOfRange("'" + name + "': the number of corners", "a multiple of 3");
  if (!(object.radius_m >= 0 && object.radius_m <= 1000)) return OutOfRange("'" + name + "': radius_m", "0 to 1000");
  const auto positions = static_cast<size_t>(object.vertex_count) * 3;
  for (size_t i = 0; i < positions; ++i)
    if (!(std::abs(object.positions_m[i]) < kFarthest_m))
      return OutOfRange("'" + name + "': each coordinate", "a number below 100,000 km");
  for (int i = 0; i < object.index_count; ++i)
    if (object.indices[i] >= static_cast<uint32_t>(object.vertex_count))
      return OutOfRange("'" + name + "': each index", "below vertex_count");
  return {};
}

Point3 Corner(const FlaneurObject& object, int corner) {
  const size_t vertex = object.indices ? object.indices[corner] : static_cast<size_t>(corner);
  const double* p = object.positions_m + 3 * vertex;
  return {p[0], p[1], p[2]};
}

Failure BuildScene(const FlaneurFootprintsDef& def, Town* town) {
  TownBuilder builder;
  std::vector<float> radii;
  for (int i = 0; i < def.object_count; ++i) {
    const FlaneurObject& object = def.objects[i];
    const std::string name = NameOf(object.name, "object", i);
    if (Failure failure = CheckObject(object, name)) return failure;
    const int node = builder.AddNode(name, NodeKindOf(object.kind));
    radii.push_back(static_cast<float>(object.radius_m));
    const int corners = object.indices ? object.index_count : object.vertex_count;
    for (int k = 0; k < corners; k += 3)
      builder.AddPolygon(node, SurfaceKind::kOther,
                         {{Corner(object, k), Corner(object, k + 1), Corner(object, k + 2)}});
  }
  if (Error error = builder.Finish("the town", {"", false}, &town->scene, nullptr, &town->warnings))
    return BadInput(error);
  for (size_t i = 0; i < radii.size(); ++i) town->scene.nodes[i].radius_m = radii[i];
  return {};
}

// The ring in the caller's coordinates, in memory of the town.
FlaneurRing RingOf(const std::vector<Point2>& ring, Town* town) {
  const Point2 origin = town->footprints.origin_m;
  std::vector<FlaneurPoint>& points = town->points.emplace_back();
  for (const Point2& p : ring) points.push_back({p.x + origin.x, p.y + origin.y});
  return {points.data(), static_cast<int>(points.size())};
}

void FillSpans(Town* town) {
  const Point2 origin = town->footprints.origin_m;
  for (const Obstacle& o : town->footprints.obstacles) {
    FlaneurObstacle out{};
    out.name = o.name.c_str(), out.object = o.source.c_str(), out.kind = KindFrom(o.kind);
    out.outer = RingOf(o.outer, town);
    std::vector<FlaneurRing>& holes = town->holes.emplace_back();
    for (const std::vector<Point2>& hole : o.holes) holes.push_back(RingOf(hole, town));
    out.holes = holes.data(), out.hole_count = static_cast<int>(holes.size());
    out.center_m = {o.center.x + origin.x, o.center.y + origin.y}, out.radius_m = o.radius_m;
    if (!o.outer.empty()) out.center_m = {};
    out.ground_z_m = o.ground_z_m, out.is_guess = o.open_shell;
    town->obstacles.push_back(out);
  }
  for (const std::string& warning : town->warnings) town->warning_texts.push_back(warning.c_str());
}

Failure Create(const FlaneurFootprintsDef& def, FlaneurFootprintsId* id) {
  if (def.object_count <= 0) return OutOfRange("object_count", "greater than 0");
  if (!def.objects) return NullPointer("objects");
  const std::array ranges{Range{"clearance_m", def.clearance_m, 0, 10},
                          Range{"band_low_m", def.band_low_m, 0, 100},
                          Range{"band_high_m", def.band_high_m, 0, 100},
                          Range{"tolerance_m", def.tolerance_m, 0, 1},
                          Range{"bridge_m", def.bridge_m, 0, 1},
                          Range{"open_yard_m2", def.open_yard_m2, 0, kMaxArea_m2},
                          Range{"threads", static_cast<double>(def.threads), 0, 1024}};
  if (Failure failure = CheckRanges(ranges)) return failure;
  if (!(def.band_low_m < def.band_high_m)) return OutOfRange("band_low_m", "below band_high_m");
  FootprintOptions options;
  options.clearance_m = def.clearance_m;
  options.band_m = {def.band_low_m, def.band_high_m};
  options.tolerance_m = def.tolerance_m, options.bridge_m = def.bridge_m, options.open_yard_m2 = def.open_yard_m2;
  options.merge_blocks = def.merge_blocks, options.threads = def.threads;
  auto town = std::make_shared<Town>();
  if (Failure failure = BuildScene(def, town.get())) return failure;
  if (Error error = ExtractFootprints(town->scene, options, &town->footprints, nullptr, &town->warnings))
    return BadInput(error);
  FillSpans(town.get());
  *id = Towns().Add(std::move(town));
  return {};
}

Failure TakeCheckDef(const FlaneurCheckDef& def, Point2 origin, CheckOptions* options) {
  if (def.gate_count < 0 || def.street_count < 0) return OutOfRange("gate_count and street_count", "at least 0");
  if (def.gate_count > 0 && !def.gates) return NullPointer("gates");
  if (def.street_count > 0 && !def.streets) return NullPointer("streets");
  constexpr double kMaxLength_m = 1000;
  const std::array ranges{Range{"person_radius_m", def.person_radius_m, 0, 10, true},
                          Range{"clearance_m", def.clearance_m, -kMaxLength_m, 10},
                          Range{"tolerance_m", def.tolerance_m, 0, 10, true},
                          Range{"spike_width_m", def.spike_width_m, 0, 10, true},
                          Range{"spike_length_m", def.spike_length_m, 0, kMaxLength_m, true},
                          Range{"over_cover_share", def.over_cover_share, 0, kMaxArea_m2},
                          Range{"headroom_m", def.headroom_m, 0, 100, true},
                          Range{"overlap_m2", def.overlap_m2, 0, kMaxArea_m2},
                          Range{"least_ground_m2", def.least_ground_m2, 0, kMaxArea_m2, true},
                          Range{"dead_end_m", def.dead_end_m, 0, kFarthest_m, true},
                          Range{"high_resolution_radius_m", def.high_resolution_radius_m, 0, kFarthest_m, true},
                          Range{"most_points", static_cast<double>(def.most_points), 3, kFarthest_m}};
  if (Failure failure = CheckRanges(ranges)) return failure;
  options->person_radius_m = def.person_radius_m, options->clearance_m = def.clearance_m;
  options->tolerance_m = def.tolerance_m, options->spike_width_m = def.spike_width_m;
  options->spike_length_m = def.spike_length_m, options->over_cover_share = def.over_cover_share;
  options->headroom_m = def.headroom_m, options->overlap_m2 = def.overlap_m2;
  options->least_ground_m2 = def.least_ground_m2, options->dead_end_m = def.dead_end_m;
  options->high_resolution_radius_m = def.high_resolution_radius_m, options->most_points = def.most_points;

  const auto is_there = [](FlaneurPoint p) { return std::abs(p.x) < kFarthest_m && std::abs(p.y) < kFarthest_m; };
  for (int i = 0; i < def.gate_count; ++i) {
    const FlaneurGate& gate = def.gates[i];
    const std::string name = NameOf(gate.name, "gate", i);
    const double length = std::hypot(gate.ahead.x, gate.ahead.y);
    if (!is_there(gate.at_m) || !is_there(gate.ahead))
      return OutOfRange("'" + name + "': each coordinate", "a number below 100,000 km");
    const Point2 ahead = length > 0 ? Point2{gate.ahead.x / length, gate.ahead.y / length} : Point2{};
    options->gates.push_back({name, {gate.at_m.x - origin.x, gate.at_m.y - origin.y}, ahead, gate.is_exit});
  }
  for (int i = 0; i < def.street_count; ++i) {
    const FlaneurStreet& street = def.streets[i];
    Centreline line{NameOf(street.name, "street", i), {}};
    if (street.count < 2) return OutOfRange("'" + line.name + "': count", "at least 2");
    if (!street.points_m) return NullPointer("points_m");
    for (int k = 0; k < street.count; ++k) {
      const FlaneurPoint p = street.points_m[k];
      if (!is_there(p)) return OutOfRange("'" + line.name + "': each coordinate", "a number below 100,000 km");
      line.points_m.push_back({p.x - origin.x, p.y - origin.y});
    }
    options->streets.push_back(std::move(line));
  }
  return {};
}

Failure CheckTown(const FlaneurCheckDef& def, Town* town, FlaneurFindingSpan* span) {
  const Point2 origin = town->footprints.origin_m;
  CheckOptions options;
  if (Failure failure = TakeCheckDef(def, origin, &options)) return failure;
  std::vector<Finding> findings;
  if (Error error = Check(town->footprints, &town->scene, options, &findings)) return BadInput(error);
  town->findings = std::move(findings);
  town->finding_items.clear();
  for (const Finding& f : town->findings) {
    const FindingKind& kind = KindOf(f.code);
    town->finding_items.push_back({f.code,
                                   f.severity == Severity::kError,
                                   {f.at_m.x + origin.x, f.at_m.y + origin.y},
                                   f.value,
                                   f.limit,
                                   kind.title,
                                   f.feature.c_str(),
                                   f.other.c_str(),
                                   f.message.c_str(),
                                   kind.advice});
  }
  *span = {town->finding_items.data(), static_cast<int>(town->finding_items.size())};
  return {};
}

// Calls `call(town)` for the footprints with this id.
template <typename Call>
FlaneurStatus WithTown(FlaneurFootprintsId id, const Call& call) {
  return AtBoundary(&Last(), [&]() -> Failure {
    const std::shared_ptr<Town> town = Towns().Find(id);
    return town ? call(town.get()) : NoSuchId("footprints");
  });
}

}  // namespace

FlaneurFootprintsDef flaneur_default_footprints_def(void) {
  const FootprintOptions defaults;
  FlaneurFootprintsDef def{};
  def.clearance_m = defaults.clearance_m;
  def.band_low_m = defaults.band_m[0], def.band_high_m = defaults.band_m[1];
  def.tolerance_m = defaults.tolerance_m, def.bridge_m = defaults.bridge_m, def.open_yard_m2 = defaults.open_yard_m2;
  def.merge_blocks = defaults.merge_blocks, def.threads = defaults.threads;
  def.internal_value = kFootprintsCookie;
  return def;
}

FlaneurCheckDef flaneur_default_check_def(void) {
  const CheckOptions defaults;
  FlaneurCheckDef def{};
  def.person_radius_m = defaults.person_radius_m, def.clearance_m = defaults.clearance_m;
  def.tolerance_m = defaults.tolerance_m, def.spike_width_m = defaults.spike_width_m;
  def.spike_length_m = defaults.spike_length_m, def.over_cover_share = defaults.over_cover_share;
  def.headroom_m = defaults.headroom_m, def.overlap_m2 = defaults.overlap_m2;
  def.least_ground_m2 = defaults.least_ground_m2, def.dead_end_m = defaults.dead_end_m;
  def.high_resolution_radius_m = defaults.high_resolution_radius_m, def.most_points = defaults.most_points;
  def.internal_value = kCheckCookie;
  return def;
}

FlaneurStatus flaneur_create_footprints(const FlaneurFootprintsDef* def, FlaneurFootprintsId* id) {
  return AtBoundary(&Last(), [&]() -> Failure {
    if (!def || !id) return NullPointer(def ? "id" : "def");
    if (def->internal_value != kFootprintsCookie) return NoDefinition("flaneur_default_footprints_def");
    return Create(*def, id);
  });
}

FlaneurStatus flaneur_destroy_footprints(FlaneurFootprintsId id) {
  return AtBoundary(&Last(), [&]() -> Failure { return Towns().Remove(id) ? Failure{} : NoSuchId("footprints"); });
}

bool flaneur_footprints_is_valid(FlaneurFootprintsId id) { return Towns().Find(id) != nullptr; }

FlaneurStatus flaneur_footprints_obstacles(FlaneurFootprintsId id, FlaneurObstacleSpan* obstacles) {
  return WithTown(id, [&](Town* town) -> Failure {
    if (!obstacles) return NullPointer("obstacles");
    *obstacles = {town->obstacles.data(), static_cast<int>(town->obstacles.size())};
    return {};
  });
}

FlaneurStatus flaneur_footprints_warnings(FlaneurFootprintsId id, FlaneurTextSpan* warnings) {
  return WithTown(id, [&](Town* town) -> Failure {
    if (!warnings) return NullPointer("warnings");
    *warnings = {town->warning_texts.data(), static_cast<int>(town->warning_texts.size())};
    return {};
  });
}

FlaneurStatus flaneur_footprints_check(FlaneurFootprintsId id, const FlaneurCheckDef* def,
                                       FlaneurFindingSpan* findings) {
  return WithTown(id, [&](Town* town) -> Failure {
    if (!def || !findings) return NullPointer(def ? "findings" : "def");
    if (def->internal_value != kCheckCookie) return NoDefinition("flaneur_default_check_def");
    return CheckTown(*def, town, findings);
  });
}

const char* flaneur_footprints_last_error(void) { return Last().text; }

FlaneurVersion flaneur_footprints_version(void) {
  return {FLANEUR_VERSION_MAJOR, FLANEUR_VERSION_MINOR, FLANEUR_VERSION_PATCH};
}
