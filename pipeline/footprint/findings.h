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
// and advice.
std::string FindingsJson(const std::vector<Finding>& findings);

}  // namespace flaneur
