#include "runtime/visit/pin.h"

#include <algorithm>

namespace flaneur {

bool TypeDigit(char digit, const std::string& pin, PinEntry* e) {
  if (e->wait_s > 0 || pin.empty() || digit < '0' || digit > '9') return false;
  e->typed += digit;
  if (e->typed.size() < pin.size()) return false;
  const bool right = e->typed == pin;
  e->typed.clear();
  e->wrong = right ? 0 : e->wrong + 1;
  if (e->wrong < kFreeTries) return right;
  e->wait_s = kFirstWait_s;
  for (int k = kFreeTries; k < e->wrong && e->wait_s < kLongestWait_s; ++k) e->wait_s *= 2;
  e->wait_s = std::min(e->wait_s, kLongestWait_s);
  return right;
}

void DeleteDigit(PinEntry* e) {
  if (!e->typed.empty()) e->typed.pop_back();
}

void WaitForPin(float passed_s, PinEntry* e) { e->wait_s = std::max(0.0f, e->wait_s - passed_s); }

}  // namespace flaneur
