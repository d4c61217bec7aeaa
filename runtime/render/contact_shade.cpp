#include "runtime/render/contact_shade.h"

namespace flaneur {

Error CreateContactShade(ContactShadeView* shade) {
  glGenVertexArrays(1, &shade->array);
  glBindVertexArray(shade->array);
  const float corners[] = {0, 0, 1, 0, 0, 1, 1, 1};
  CreateBuffer(GL_ARRAY_BUFFER, corners, sizeof corners);
  EnableAttribute(ATTRIBUTE_POSITION, 2, GL_FLOAT, false, 2 * sizeof(float), 0, 0);
  return BuildProgram(ShaderProgram::kContactShade, &shade->program);
}

DrawCost DrawContactShade(const PeopleView& people, const ContactShadeView& shade) {
  const PeopleBatch& contacts = people.batches.contacts;
  if (contacts.count == 0) return {};
  glUseProgram(shade.program.id);
  glBindVertexArray(shade.array);
  BindInstances(people.instances, contacts);
  CullBackFaces(false);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ZERO, GL_SRC_COLOR);
  glDepthMask(GL_FALSE);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(contacts.count));
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  return {2 * static_cast<int64_t>(contacts.count), 1};
}

}  // namespace flaneur
