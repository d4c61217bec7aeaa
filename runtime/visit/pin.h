// The operator's PIN, typed digit by digit. Who guesses waits longer and longer.
#pragma once
#include <string>

namespace flaneur {

struct PinEntry {
  std::string typed;
  int wrong = 0;     // PINs since the last right one
  float wait_s = 0;  // until digits are taken again
};

inline constexpr int kFreeTries = 3;                             // before the first wait
inline constexpr float kFirstWait_s = 30, kLongestWait_s = 600;  // the wait doubles with each wrong PIN from then on

// A PIN is compared once as many digits are there as it has; it is empty: nothing is right. True: that was it.
bool TypeDigit(char digit, const std::string& pin, PinEntry* entry);
void DeleteDigit(PinEntry* entry);
// Time passes, whether the keypad is shown or not.
void WaitForPin(float passed_s, PinEntry* entry);

}  // namespace flaneur
