#include "runtime/render/smoke_view.h"

#include <cstddef>

namespace flaneur {

Error CreateSmokeView(SmokeView* view) {
  glGenVertexArrays(1, &view->array);
  glBindVertexArray(view->array);
  const float corners[] = {0, 0, 1, 0, 0, 1, 1, 1};
  CreateBuffer(GL_ARRAY_BUFFER, corners, sizeof corners);
  EnableAttribute(ATTRIBUTE_POSITION, 2, GL_FLOAT, false, 2 * sizeof(float), 0, 0);
  view->puffs = CreateBuffer(GL_ARRAY_BUFFER, nullptr, 0);
  EnableAttribute(ATTRIBUTE_PLACE, 4, GL_FLOAT, false, sizeof(SmokePuff), offsetof(SmokePuff, position), 1);
  EnableAttribute(ATTRIBUTE_LOOK, 2, GL_FLOAT, false, sizeof(SmokePuff), offsetof(SmokePuff, density), 1);
  return BuildProgram(ShaderProgram::kSmoke, &view->program);
}

DrawCost DrawSmoke(const std::vector<SmokePuff>& puffs, const SmokeView& view) {
  if (puffs.empty()) return {};
  glUseProgram(view.program.id);
  glBindVertexArray(view.array);
  glBindBuffer(GL_ARRAY_BUFFER, view.puffs);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(puffs.size() * sizeof(SmokePuff)), puffs.data(),
               GL_STREAM_DRAW);
  CullBackFaces(false);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(puffs.size()));
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  return {2 * static_cast<int64_t>(puffs.size()), 1};
}

}  // namespace flaneur
