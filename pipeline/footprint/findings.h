// The numbered findings of the check.
#pragma once
#include <string>
#include <vector>

#include "pipeline/core/footprint.h"

namespace flaneur {

enum class Severity { kError, kWarning };

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
};

// All kinds, by code.
const std::vector<FindingKind>& FindingKinds();
// The code must be one of FindingKinds.
const FindingKind& KindOf(int code);
const char* SeverityName(Severity severity);  // "error", "warning"

// The findings as JSON (version 1): counts, then each with code, severity, feature, other, at_m, value, limit, message
// and advice; with `places`, the same places in a file's own coordinates, also at_file.
std::string FindingsJson(const std::vector<Finding>& findings, const std::vector<Point2>& places = {});

// The same as GeoJSON points at `places`: longitudes and latitudes, else metres, which a member says.
std::string FindingsGeoJson(const std::vector<Finding>& findings, const std::vector<Point2>& places, bool degrees);

// By code, then by obstacle.
void SortFindings(std::vector<Finding>* findings);

}  // namespace flaneur
