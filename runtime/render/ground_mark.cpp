#include "runtime/render/ground_mark.h"

namespace flaneur {

Error CreateGroundMark(GroundMarkView* m) {
  glGenVertexArrays(1, &m->array);
  glBindVertexArray(m->array);
  m->vertices = CreateBuffer(GL_ARRAY_BUFFER, nullptr, 0);
  EnableAttribute(ATTRIBUTE_POSITION, 3, GL_FLOAT, false, sizeof(Vec3), 0, 0);
  return BuildProgram(ShaderProgram::kGroundMark, &m->program);
}

DrawCost DrawGroundMark(const std::vector<Vec3>& strip, const GroundMarkView& m) {
  if (strip.size() < 3) return {};
  glUseProgram(m.program.id);
  glBindVertexArray(m.array);
  glBindBuffer(GL_ARRAY_BUFFER, m.vertices);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(strip.size() * sizeof(Vec3)), strip.data(), GL_STREAM_DRAW);
  CullBackFaces(false);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  glDrawArrays(GL_TRIANGLE_STRIP, 0, static_cast<GLsizei>(strip.size()));
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  return {static_cast<int64_t>(strip.size()) - 2, 1};
}

}  // namespace flaneur
