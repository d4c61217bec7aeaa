#include "pipeline/footprint/check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <tuple>

#include "pipeline/footprint/check_parts.h"

namespace flaneur {

void CheckState::Add(int code, const std::string& feature, Point2 at, double value, double limit,
                     const std::string& detail, const std::string& other) {
  const FindingKind& kind = KindOf(code);
  findings->push_back({code, kind.severity, feature, other, at, value, limit,
                       detail.empty() ? kind.title : std::string(kind.title) + ": " + detail});
}

std::string Metres(double value) {
  char text[40];
  std::snprintf(text, sizeof text, std::abs(value) < 0.1 ? "%.3f m" : "%.2f m", value);
  return text;
}

Error Check(const Footprints& footprints, const Scene* town, const CheckOptions& options,
            std::vector<Finding>* findings) {
  if (!(options.tolerance_m > 0)) return Fail("the check's tolerance must be greater than zero");
  if (!(options.person_radius_m > 0)) return Fail("the person's radius must be greater than zero");
  if (!(options.scale > 0)) return Fail("the scale must be greater than zero");
  findings->clear();
  const double clearance = options.clearance_m >= 0 ? options.clearance_m : footprints.clearance_m;
  CheckState state{footprints, options, clearance, {}, findings};
  for (const Obstacle& o : footprints.obstacles) state.obstacles.push_back({&o, false, {}, {}, {}});
  CheckRings(&state);
  CheckPairs(&state);
  if (town)
    if (Error error = CheckAgainstTown(*town, &state)) return error;
  if (Error error = CheckWays(town, &state)) return error;
  std::sort(findings->begin(), findings->end(), [](const Finding& a, const Finding& b) {
    return std::tie(a.code, a.feature, a.other, a.at_m.x, a.at_m.y) <
           std::tie(b.code, b.feature, b.other, b.at_m.x, b.at_m.y);
  });
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
