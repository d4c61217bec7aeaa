#include "runtime/show/hour.h"

#include <cmath>

namespace flaneur {

float HourOfSun(Vec3 to_sun) {
  const float hour = 12 + std::atan2(-to_sun.x, -to_sun.y) * 12 / kPi;
  return hour < 0 ? hour + 24 : hour;
}

float HourNow(const Simulation& simulation, Vec3 to_sun) {
  if (!simulation.hour) return HourOfSun(to_sun);
  return std::fmod(*simulation.hour + Time_s(simulation) / 3600, 24.0f);
}

}  // namespace flaneur
