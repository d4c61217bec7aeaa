// Sun and sky for a direction of the sun. Internal to runtime/render.
#pragma once
#include "runtime/base/math.h"

namespace flaneur {

struct Light {
  Vec3 sun, sky, ground, haze, zenith;
};  // linear colours

Light LightFor(Vec3 to_sun);  // unit, glTF axes

}  // namespace flaneur
