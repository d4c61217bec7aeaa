#include "pipeline/footprint/findings.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace flaneur {

const std::vector<FindingKind>& FindingKinds() {
  constexpr Severity kError = Severity::kError, kWarning = Severity::kWarning;
  static const std::vector<FindingKind> kinds = {
      {101, kError, "ring of fewer than three points", "Draw the ring anew or delete the obstacle."},
      {102, kWarning, "points less than 1 mm apart", "Remove one of the two points."},
      {103, kError, "ring not closed", "Repeat the first point at the end of the ring."},
      {104, kError, "ring crosses itself", "Move the points so that no two edges cross, or split the ring."},
      {105, kError, "ring runs the wrong way", "Turn it: outer rings anticlockwise, holes clockwise."},
      {106, kError, "area below 0.01 m2", "Delete it, or check the units of the file."},
      {107, kError, "coordinate not finite or beyond 1000 km", "Correct the coordinate; subtract an origin."},
      {108, kWarning, "more than 256 points in a ring", "Simplify the ring; see the tolerance option of footprints."},
      {109, kError, "circle without a radius", "Give radius_m a number greater than zero."},
      {201, kError, "hole outside its ring", "Move the hole inside, or delete it."},
      {202, kError, "holes overlap", "Merge the two holes."},
      {203, kError, "spike or sliver", "Remove the points of the spike; nobody fits beside it."},
      {301, kError, "wall not covered", "Extract the footprints again from this town, or enlarge the obstacle."},
      {302, kError, "clearance too small", "Enlarge the obstacle, or extract again with this clearance."},
      {303, kError, "covers more than the building", "Shrink the obstacle to the walls and the clearance."},
      {304, kError, "building without obstacle", "Extract the footprints again from this town."},
      {305, kError, "obstacle without building", "Delete it, or check that town and footprints belong together."},
      {306, kWarning, "open shell", "Close the walls in the model, or look whether the obstacle is right."},
      {307, kError, "passage blocked", "Cut the passage out of the obstacle: there is headroom and width to walk."},
      {401, kError, "obstacles overlap", "Cut one out of the other, or merge them."},
      {402, kError, "obstacle stands twice", "Delete one of the two."},
      {403, kWarning, "gap too narrow for a person", "Close the gap or widen it, so that nobody tries."},
      {404, kWarning, "gap too narrow for two", "Widen it where people should pass each other."},
      {501, kError, "ground out of reach", "Open a way at least as wide as a person, or take the ground away."},
      {601, kError, "entrance inside an obstacle", "Move the door or spawn point to free ground."},
      {602, kError, "exit inside an obstacle", "Move the exit to free ground."},
      {603, kError, "entrance or exit too close to an obstacle", "Move it at least a person's radius away."},
      {604, kError, "exit out of reach", "Open a way from the entrance to the exit."},
  };
  return kinds;
}

const FindingKind& KindOf(int code) {
  const auto& kinds = FindingKinds();
  return *std::find_if(kinds.begin(), kinds.end(), [&](const FindingKind& k) { return k.code == code; });
}

const char* SeverityName(Severity severity) { return severity == Severity::kError ? "error" : "warning"; }

std::string FindingsJson(const std::vector<Finding>& findings) {
  using Json = nlohmann::ordered_json;
  const auto number = [](double v) { return std::isfinite(v) ? Json(std::round(v * 1e6) / 1e6) : Json(); };
  Json list = Json::array();
  int errors = 0;
  for (const Finding& f : findings) {
    errors += f.severity == Severity::kError;
    list.push_back({{"code", f.code}, {"severity", SeverityName(f.severity)}, {"feature", f.feature},
                    {"other", f.other.empty() ? Json() : Json(f.other)},
                    {"at_m", Json::array({number(f.at_m.x), number(f.at_m.y)})}, {"value", number(f.value)},
                    {"limit", number(f.limit)}, {"message", f.message}, {"advice", KindOf(f.code).advice}});
  }
  const Json root = {{"version", 1}, {"errors", errors}, {"warnings", static_cast<int>(findings.size()) - errors},
                     {"findings", std::move(list)}};
  return root.dump(1) + "\n";
}

}  // namespace flaneur
