// The numbered findings of the check.
#pragma once
#include <string>
#include <vector>

#include "pipeline/core/footprint.h"

namespace flaneur {

// kAccepted: the designer has looked at it and wants it so.
enum class Severity { kError, kWarning, kAccepted };

struct FindingKind {
  int code;
  Severity severity;
  const char* title;   // a few words
  const char* advice;  // what to do
};

struct Finding {
  int code = 0;
  Severity severity = Severity::kError;
  std::string feature;  // the obstacle's (or door's) name
  std::string other;    // second obstacle, where there is one
  Point2 at_m;
  double value = 0, limit = 0;  // what was measured, and what it must not pass
  std::string message;
  std::vector<std::string> others = {};  // of many with one cause: the further obstacles
  std::string reason = {};               // why it is accepted
  size_t Count() const { return 1 + others.size(); }
};

// All kinds, by code.
const std::vector<FindingKind>& FindingKinds();
// The code must be one of FindingKinds.
const FindingKind& KindOf(int code);
const char* SeverityName(Severity severity);  // "error", "warning", "accepted"

// The findings as JSON (version 1): counts, then each with code, severity, feature, other, at_m, value, limit, message
// and advice, those with one cause also count and features, accepted ones reason; with `places`, the same places in a
// file's own coordinates, also at_file.
std::string FindingsJson(const std::vector<Finding>& findings, const std::vector<Point2>& places = {});

// The same as GeoJSON points at `places`: longitudes and latitudes, else metres, which a member says.
std::string FindingsGeoJson(const std::vector<Finding>& findings, const std::vector<Point2>& places, bool degrees);

// Where a fault of one kind is in most of this many obstacles it has one cause (a map drawn from roofs, a model without
// floors), and becomes one finding with a count.
void JoinFindings(size_t obstacles, std::vector<Finding>* findings);

// What a designer wants as it is: a finding of this code within `within_m` of the place.
struct AcceptedFinding {
  int code = 0;
  Point2 at_m;
  double within_m = 5;
  std::string reason;
};
// Marks what is accepted; says which of `accepted` meets nothing, by their numbers.
std::vector<size_t> AcceptFindings(const std::vector<AcceptedFinding>& accepted, std::vector<Finding>* findings);

// By code, then by obstacle.
void SortFindings(std::vector<Finding>* findings);

}  // namespace flaneur
