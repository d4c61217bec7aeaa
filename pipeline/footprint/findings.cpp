#include "pipeline/footprint/findings.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "runtime/base/array.h"

namespace flaneur {

const std::vector<FindingKind>& FindingKinds() {
  constexpr Severity kError = Severity::kError, kWarning = Severity::kWarning;
  static const std::vector<FindingKind> kinds = {
      {101, kError, "ring of fewer than three points", "Draw the ring anew or delete the obstacle."},
      {102, kError, "points less than 1 mm apart", "Remove one of the two points."},
      {103, kError, "ring not closed", "Repeat the first point at the end of the ring."},
      {104, kError, "ring crosses itself", "Move the points so that no two edges cross, or split the ring."},
      {105, kError, "ring runs the wrong way", "Turn it: outer rings anticlockwise, holes clockwise."},
      {106, kError, "area below 0.01 m2", "Delete it, or check the units of the file."},
      {107, kError, "coordinate not finite or beyond 1000 km", "Correct the coordinate; subtract an origin."},
      {108, kError, "more than 256 points in a ring", "Simplify the ring; see the tolerance option of footprints."},
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
      {502, kError, "dead end", "Open a way out at its end, or look whether people should go there at all."},
      {503, kError, "trap", "Give the ground a second way out, or a door that people can go in at."},
      {504, kError, "street crosses an obstacle",
       "Move the street or the obstacle; cut a passage out where there is one."},
      {601, kError, "entrance inside an obstacle", "Move the door or spawn point to free ground."},
      {602, kError, "exit inside an obstacle", "Move the exit to free ground."},
      {603, kError, "entrance or exit too close to an obstacle", "Move it at least a person's radius away."},
      {604, kError, "exit out of reach", "Open a way from the entrance to the exit."},
      {901, kError, "file cannot be read", "Correct the file as the message says."},
      {902, kError, "no obstacles", "Give a file with polygons, or with points that have a radius_m."},
      {903, kError, "coordinates in another system than stated", "Correct the crs member, or say it: --units, --crs."},
      {904, kError, "broken feature", "Correct it; it was left out of the check."},
      {905, kError, "number out of range", "Correct the option as the message says."},
      {906, kError, "coordinate system not known", "Use a name that PROJ knows, such as EPSG:25832."},
      {907, kError, "obstacles lie elsewhere",
       "See whether they belong together, and what the file says of its place: crs, origin_m, the order of axes."},
  };
  return kinds;
}

const FindingKind& KindOf(int code) {
  const auto& kinds = FindingKinds();
  return *std::find_if(kinds.begin(), kinds.end(), [&](const FindingKind& k) { return k.code == code; });
}

const char* SeverityName(Severity severity) {
  return severity == Severity::kError ? "error" : severity == Severity::kWarning ? "warning" : "accepted";
}

namespace {

using Json = nlohmann::ordered_json;

Json Number(double v) { return std::isfinite(v) ? Json(std::round(v * 1e6) / 1e6) : Json(); }
Json PlaceJson(Point2 p, double grain) {
  const auto number = [&](double v) { return std::isfinite(v) ? Json(std::round(v / grain) * grain) : Json(); };
  return Json::array({number(p.x), number(p.y)});
}

Json Facts(const Finding& f) {
  Json facts{{"code", f.code},
             {"severity", SeverityName(f.severity)},
             {"feature", f.feature},
             {"other", f.other.empty() ? Json() : Json(f.other)},
             {"at_m", Json::array({Number(f.at_m.x), Number(f.at_m.y)})},
             {"value", Number(f.value)},
             {"limit", Number(f.limit)},
             {"message", f.message},
             {"advice", KindOf(f.code).advice}};
  if (f.Count() > 1) {
    facts["count"] = f.Count();
    facts["features"] = Json::array({f.feature});
    for (const std::string& other : f.others) facts["features"].push_back(other);
  }
  if (!f.reason.empty()) facts["reason"] = f.reason;
  return facts;
}

std::string Text(const Json& json) { return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n"; }

}  // namespace

std::string FindingsJson(const std::vector<Finding>& findings, const std::vector<Point2>& places) {
  Json list = Json::array();
  int errors = 0, warnings = 0;
  for (size_t i = 0; i < findings.size(); ++i) {
    errors += findings[i].severity == Severity::kError;
    warnings += findings[i].severity == Severity::kWarning;
    list.push_back(Facts(findings[i]));
    if (i < places.size()) list.back()["at_file"] = PlaceJson(places[i], 1e-9);
  }
  return Text({{"version", 1}, {"errors", errors}, {"warnings", warnings}, {"findings", std::move(list)}});
}

std::string FindingsGeoJson(const std::vector<Finding>& findings, const std::vector<Point2>& places, bool degrees) {
  Json features = Json::array();
  for (size_t i = 0; i < findings.size(); ++i)
    features.push_back(
        {{"type", "Feature"},
         {"properties", Facts(findings[i])},
         {"geometry", {{"type", "Point"}, {"coordinates", PlaceJson(places[i], degrees ? 1e-9 : 1e-4)}}}});
  Json root = {{"type", "FeatureCollection"}};
  if (!degrees) root["flaneur"] = {{"version", 1}, {"units", "m"}};
  root["features"] = std::move(features);
  return Text(root);
}

namespace {

// Of faults in rings, and of walls: how the whole map was made. Overlaps, gaps and ways have each their own cause.
double JoinedShare(int code) {
  if (code == 306) return 0.2;  // walls that the whole model lacks
  const bool rings = code >= 101 && code <= 203, town = code >= 301 && code <= 305;
  return rings || town ? 0.5 : 2;
}

}  // namespace

void JoinFindings(size_t obstacles, std::vector<Finding>* findings) {
  constexpr size_t kMany = 10;
  std::vector<Finding> joined;
  for (size_t i = 0; i < findings->size();) {
    size_t end = i;
    std::set<std::string> features;
    while (end < findings->size() && (*findings)[end].code == (*findings)[i].code)
      features.insert((*findings)[end++].feature);
    const double share = static_cast<double>(features.size()) / std::max(1.0, static_cast<double>(obstacles));
    if (features.size() < kMany || share < JoinedShare((*findings)[i].code)) {
      joined.insert(joined.end(), std::make_move_iterator(findings->begin() + static_cast<std::ptrdiff_t>(i)),
                    std::make_move_iterator(findings->begin() + static_cast<std::ptrdiff_t>(end)));
    } else {
      Finding one = (*findings)[i];
      features.erase(one.feature);
      one.others.assign(features.begin(), features.end());
      const std::string first =
          one.message.substr(std::min(one.message.size(), std::string(KindOf(one.code).title).size()));
      one.message = std::string(KindOf(one.code).title) + " in " + std::to_string(one.Count()) + " of " +
                    std::to_string(obstacles) + " obstacles, so likely of one cause; the first" + first;
      joined.push_back(std::move(one));
    }
    i = end;
  }
  *findings = std::move(joined);
}

std::vector<size_t> AcceptFindings(const std::vector<AcceptedFinding>& accepted, std::vector<Finding>* findings) {
  std::vector<size_t> idle;
  for (size_t i = 0; i < accepted.size(); ++i) {
    const AcceptedFinding& a = accepted[i];
    bool met = false;
    for (Finding& f : *findings) {
      if (f.code != a.code || !(std::hypot(f.at_m.x - a.at_m.x, f.at_m.y - a.at_m.y) <= a.within_m)) continue;
      f.severity = Severity::kAccepted, f.reason = a.reason;
      met = true;
    }
    if (!met) idle.push_back(i);
  }
  return idle;
}

void SortFindings(std::vector<Finding>* findings) {
  std::stable_sort(findings->begin(), findings->end(), [](const Finding& a, const Finding& b) {
    const auto key = [](const Finding& f) { return std::tie(f.code, f.feature, f.other); };
    return key(a) < key(b);
  });
}

}  // namespace flaneur
