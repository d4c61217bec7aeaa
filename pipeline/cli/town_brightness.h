// How bright a town's surfaces are, for the picture's exposure. Internal to pipeline/cli.
#pragma once
#include "pipeline/core/scene.h"
#include "runtime/base/jobs.h"

namespace flaneur {

// Share of the light that comes back from surfaces, 0 to 1 (luminance of the linear base colour, with pictures and
// vertex colours), by area; ground and roofs count for one half, walls for the other.
float BrightnessOf(const Scene& town, Jobs* jobs);

// The exposure of such a town: 1 up to what the light is made for, less where all would be near white.
float ExposureFor(float brightness);

}  // namespace flaneur
