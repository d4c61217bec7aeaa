// Smoke, in one call over the lit picture and behind what stands before it. Internal to runtime/render.
#pragma once
#include <vector>

#include "runtime/base/error.h"
#include "runtime/render/frame.h"
#include "runtime/render/gl_objects.h"

namespace flaneur {

struct SmokeView {
  Program program;
  GLuint array = 0, puffs = 0;
};

Error CreateSmokeView(SmokeView* view);
// In their order, into the bound picture; none: nothing.
DrawCost DrawSmoke(const std::vector<SmokePuff>& puffs, const SmokeView& view);

}  // namespace flaneur
