// A mark on the ground, over it and behind what stands before it. Internal to runtime/render.
#pragma once
#include <vector>

#include "runtime/base/error.h"
#include "runtime/render/gl_objects.h"

namespace flaneur {

struct GroundMarkView {
  Program program;
  GLuint array = 0, vertices = 0;
};

Error CreateGroundMark(GroundMarkView* mark);
// A strip of triangles in ground axes, into the bound picture; no points: nothing.
DrawCost DrawGroundMark(const std::vector<Vec3>& strip, const GroundMarkView& mark);

}  // namespace flaneur
