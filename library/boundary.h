// What stands between C and C++: no exception passes, every failure has a status and a text.
#pragma once
#include <cmath>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "flaneur/base.h"
#include "runtime/base/error.h"
#include "runtime/base/text.h"

namespace flaneur {

struct Failure {
  FlaneurStatus status = FLANEUR_OK;
  std::string message;
  explicit operator bool() const { return status != FLANEUR_OK; }
};

inline Failure NullPointer(const char* name) { return {FLANEUR_ERROR_NULL, std::string(name) + " must not be null"}; }
inline Failure NoDefinition(const char* maker) {
  return {FLANEUR_ERROR_DEFINITION, std::string("the definition was not made by ") + maker + "()"};
}
inline Failure OutOfRange(const std::string& name, const std::string& range) {
  return {FLANEUR_ERROR_OUT_OF_RANGE, name + " must be " + range};
}
inline Failure NoSuchId(const char* thing) {
  return {FLANEUR_ERROR_ID, std::string("there are no such ") + thing + ", or no longer"};
}
inline Failure BadInput(const Error& error) { return error ? Failure{FLANEUR_ERROR_INPUT, error.message} : Failure{}; }

// Numbers that must lie between two others. The first that does not is told.
struct Range {
  const char* name;
  double value, low, high;
  bool without_low = false;
};

template <typename Ranges>
Failure CheckRanges(const Ranges& ranges) {
  for (const Range& r : ranges) {
    if (std::isfinite(r.value) && (r.without_low ? r.value > r.low : r.value >= r.low) && r.value <= r.high) continue;
    char range[80];
    std::snprintf(range, sizeof range, r.without_low ? "greater than %g and at most %g" : "%g to %g", r.low, r.high);
    return OutOfRange(r.name, range);
  }
  return {};
}

// A fixed place, so that being out of memory can be told, too.
struct LastError {
  char text[512] = "";
  void Set(const char* message) noexcept { std::snprintf(text, sizeof text, "%s", message); }
};

// Runs `call`, which returns a Failure; whatever it throws becomes one.
template <typename Call>
FlaneurStatus AtBoundary(LastError* last, const Call& call) noexcept {
  try {
    const Failure failure = call();
    if (failure) last->Set(OneLine(failure.message).c_str());
    return failure.status;
  } catch (const std::bad_alloc&) {
    last->Set("out of memory");
    return FLANEUR_ERROR_MEMORY;
  } catch (const std::exception& e) {
    last->Set(e.what());
  } catch (...) {
    last->Set("an exception of unknown type");
  }
  return FLANEUR_ERROR_INTERNAL;
}

}  // namespace flaneur
