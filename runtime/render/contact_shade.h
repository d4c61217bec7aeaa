// The faint shade about feet, and at the foot of walls, which holds them on the ground where no sun does. Internal to
// runtime/render.
#pragma once
#include <vector>

#include "runtime/base/error.h"
#include "runtime/render/gl_objects.h"
#include "runtime/render/people_view.h"
#include "runtime/render/wall_shade.h"

namespace flaneur {

struct ContactShadeView {
  Program program, wall_program;
  GLuint array = 0, wall_array = 0, wall_corners = 0;
  std::vector<WallShadeBlock> walls;
};

Error CreateContactShade(ContactShadeView* shade);
// Instead of what was added before.
void AddWallShade(const WallShade& walls, ContactShadeView* shade);
// Of people.batches.contacts and of walls near the eye, over the lit surfaces of the bound picture. share: of the
// light, that a wall keeps from the ground at its foot, 0 to 1.
DrawCost DrawContactShade(const Mat4& view_projection, Vec3 eye, float share, const PeopleView& people,
                          const ContactShadeView& shade);

}  // namespace flaneur
