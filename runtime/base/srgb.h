// The transfer curve of sRGB, by IEC 61966-2-1. Real: float or double; values from 0 to 1.
#pragma once
#include <cmath>

namespace flaneur {

template <typename Real>
Real LinearFromSrgb(Real value) {
  return value <= Real(0.04045) ? value / Real(12.92) : std::pow((value + Real(0.055)) / Real(1.055), Real(2.4));
}

template <typename Real>
Real SrgbFromLinear(Real value) {
  return value <= Real(0.0031308) ? Real(12.92) * value : Real(1.055) * std::pow(value, 1 / Real(2.4)) - Real(0.055);
}

}  // namespace flaneur
