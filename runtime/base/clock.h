// The time that passes, for durations; says nothing about the date.
#pragma once
#include <chrono>

namespace flaneur {

inline double Now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
inline double Now_ms() { return 1000 * Now_s(); }

}  // namespace flaneur
