#include "runtime/render/contact_shade.h"

#include "runtime/render/projection.h"

namespace flaneur {
namespace {

constexpr float kWallReach_m = 70;  // as wall_shade.vert lets it end

DrawCost DrawPeopleContacts(const PeopleView& people, const ContactShadeView& shade) {
  const PeopleBatch& contacts = people.batches.contacts;
  if (contacts.count == 0) return {};
  glUseProgram(shade.program.id);
  glBindVertexArray(shade.array);
  BindInstances(people.instances, contacts);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(contacts.count));
  return {2 * static_cast<int64_t>(contacts.count), 1};
}

// Blocks that lie one after the other in one call.
DrawCost DrawWallContacts(const Mat4& view_projection, Vec3 eye, float share, const ContactShadeView& shade) {
  DrawCost cost;
  if (share <= 0) return cost;
  const Frustum frustum = FrustumOf(view_projection);
  uint32_t first = 0, count = 0;
  const auto draw = [&] {
    if (count == 0) return;
    if (cost.calls == 0) {
      glUseProgram(shade.wall_program.id);
      SetUniform(shade.wall_program.share, share);
      glBindVertexArray(shade.wall_array);
    }
    glDrawArrays(GL_TRIANGLES, static_cast<GLint>(first), static_cast<GLsizei>(count));
    cost += {count / 3, 1};
  };
  for (const WallShadeBlock& block : shade.walls) {
    if (Distance(block.box, eye) > kWallReach_m || !MayTouch(frustum, block.box)) continue;
    if (first + count != block.first) {
      draw();
      first = block.first;
      count = 0;
    }
    count += block.count;
  }
  draw();
  return cost;
}

}  // namespace

Error CreateContactShade(ContactShadeView* shade) {
  glGenVertexArrays(1, &shade->array);
  glBindVertexArray(shade->array);
  const float corners[] = {0, 0, 1, 0, 0, 1, 1, 1};
  CreateBuffer(GL_ARRAY_BUFFER, corners, sizeof corners);
  EnableAttribute(ATTRIBUTE_POSITION, 2, GL_FLOAT, false, 2 * sizeof(float), 0, 0);
  if (Error e = BuildProgram(ShaderProgram::kWallShade, &shade->wall_program)) return e;
  return BuildProgram(ShaderProgram::kContactShade, &shade->program);
}

void AddWallShade(const WallShade& walls, ContactShadeView* shade) {
  glDeleteVertexArrays(1, &shade->wall_array);
  glDeleteBuffers(1, &shade->wall_corners);
  shade->walls = walls.blocks;
  glGenVertexArrays(1, &shade->wall_array);
  glBindVertexArray(shade->wall_array);
  shade->wall_corners =
      CreateBuffer(GL_ARRAY_BUFFER, walls.corners.data(), walls.corners.size() * sizeof(WallShadeVertex));
  EnableAttribute(ATTRIBUTE_POSITION, 4, GL_FLOAT, false, sizeof(WallShadeVertex), 0, 0);
}

DrawCost DrawContactShade(const Mat4& view_projection, Vec3 eye, float share, const PeopleView& people,
                          const ContactShadeView& shade) {
  CullBackFaces(false);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ZERO, GL_SRC_COLOR);
  glDepthMask(GL_FALSE);
  DrawCost cost = DrawWallContacts(view_projection, eye, share, shade);
  cost += DrawPeopleContacts(people, shade);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  return cost;
}

}  // namespace flaneur
