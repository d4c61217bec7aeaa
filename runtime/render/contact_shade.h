// The faint shade about feet, which holds people on the ground where no sun does. Internal to runtime/render.
#pragma once
#include "runtime/base/error.h"
#include "runtime/render/gl_objects.h"
#include "runtime/render/people_view.h"

namespace flaneur {

struct ContactShadeView {
  Program program;
  GLuint array = 0;
};

Error CreateContactShade(ContactShadeView* shade);
// Of people.batches.contacts, over the lit surfaces of the bound picture.
DrawCost DrawContactShade(const PeopleView& people, const ContactShadeView& shade);

}  // namespace flaneur
