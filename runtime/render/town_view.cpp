#include "runtime/render/town_view.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

#include "runtime/render/vertex_bytes.h"
#include "runtime/render/visible_triangles.h"

namespace flaneur {
namespace {

constexpr size_t kMaxOccluderTriangles = 14000;  // triangles a picture: the nearest walls hide most
constexpr uint32_t kPiece = 3 * 15000;  // indices; software keeps all triangles on their way until they are filled
constexpr uint32_t kJoined = 12000;     // indices that a shadow draws in vain rather than in another call

void EnableVertices() {
  constexpr size_t stride = sizeof(TownVertex);
  EnableAttribute(ATTRIBUTE_POSITION, 3, GL_FLOAT, false, stride, offsetof(TownVertex, position), 0);
  EnableAttribute(ATTRIBUTE_NORMAL, 4, GL_BYTE, true, stride, offsetof(TownVertex, normal), 0);
  EnableAttribute(ATTRIBUTE_UV, 2, GL_FLOAT, false, stride, offsetof(TownVertex, uv), 0);
  EnableAttribute(ATTRIBUTE_COLOR, 4, GL_UNSIGNED_BYTE, true, stride, offsetof(TownVertex, color), 0);
}

void BindGroup(const SurfaceGroup& group, const Program* programs, const TownView& town) {
  const Program& program = programs[group.masked];
  glUseProgram(program.id);
  if (group.masked) SetUniform(program.alpha_cutoff, group.alpha_cutoff);
  if (group.array >= 0) BindTextureArray(kArrayUnit, town.arrays[static_cast<size_t>(group.array)]);
  CullBackFaces(!group.double_sided);
}

void DrawIndices(uint32_t first, uint32_t count) {
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(count), GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(size_t{first} * sizeof(uint32_t)));
}

// Of the triangles that turn their front to the eye and, where there is a sight, may be seen. Writes up to three
// indices beyond them.
uint32_t* GatherSeen(const TownRange& range, bool both_sides, Vec3 eye, const TriangleSight* sight,
                     const TownGeometry& geometry, uint32_t* to) {
  const uint32_t* from = &geometry.indices[range.first];
  for (uint32_t i = 0; i < range.count; i += 3, from += 3) {
    const std::array<Vec3, 3> corners{geometry.positions[from[0]], geometry.positions[from[1]],
                                      geometry.positions[from[2]]};
    std::copy_n(from, 3, to);  // what is not seen is written over
    to += (both_sides || !TurnsItsBack(corners, eye)) && (sight == nullptr || MayBeSeen(corners, *sight)) ? 3 : 0;
  }
  return to;
}

// Those that some block has.
std::vector<int> MaskedGroups(const TownGeometry& geometry, const std::vector<SurfaceGroup>& groups) {
  std::vector<bool> found(groups.size());
  for (const TownBlock& block : geometry.blocks) {
    for (const TownRange& range : block.ranges)
      found[static_cast<size_t>(range.group)] = groups[static_cast<size_t>(range.group)].masked;
  }
  std::vector<int> masked;
  for (size_t g = 0; g < groups.size(); ++g) {
    if (found[g]) masked.push_back(static_cast<int>(g));
  }
  return masked;
}

// Indices of the visible blocks, by group and within it nearest first. Returns how many.
size_t GatherIndices(Vec3 eye, const TriangleSight* sight, bool cull, TownView* town) {
  town->counts.assign(town->groups.size(), 0);
  uint32_t* to = town->indices.get();
  for (size_t g = 0; g < town->groups.size(); ++g) {
    const uint32_t* before = to;
    for (uint32_t b : town->visible) {
      for (const TownRange& range : town->geometry.blocks[b].ranges) {
        if (range.group != static_cast<int>(g)) continue;
        to = cull ? GatherSeen(range, town->groups[g].double_sided, eye, sight, town->geometry, to)
                  : std::copy_n(&town->geometry.indices[range.first], range.count, to);
      }
    }
    if (g < town->turned_of.size()) to = std::copy(town->turned_of[g].begin(), town->turned_of[g].end(), to);
    town->counts[g] = static_cast<uint32_t>(to - before);
  }
  return static_cast<size_t>(to - town->indices.get());
}

void RemoveTown(TownView* town) {
  const GLuint arrays[] = {town->vertex_array, town->shadow_array};
  const GLuint buffers[] = {town->visible_indices, town->vertices, town->shadow_indices};
  glDeleteVertexArrays(static_cast<GLsizei>(std::size(arrays)), arrays);
  glDeleteBuffers(static_cast<GLsizei>(std::size(buffers)), buffers);
  town->box = {};
}

}  // namespace

Error CreateTownView(ShaderMode mode, const SurfacePlan& plan, const std::vector<GLuint>& arrays, TownView* town) {
  if (Error e = BuildProgram(ShaderProgram::kTown, mode, &town->lit[0])) return e;
  if (Error e = BuildProgram(ShaderProgram::kTownMasked, mode, &town->lit[1])) return e;
  if (Error e = BuildProgram(ShaderProgram::kTownShadow, mode, &town->shadow[0])) return e;
  if (Error e = BuildProgram(ShaderProgram::kTownShadowMasked, mode, &town->shadow[1])) return e;
  town->groups = plan.groups;
  town->arrays = arrays;
  return Ok();
}

bool UploadTown(size_t most_bytes, const TownGeometry& geometry, TownView* town) {
  TownUpload& upload = town->upload;
  const size_t vertex_bytes = geometry.vertices.size() * sizeof(TownVertex);
  const size_t index_bytes = geometry.indices.size() * sizeof(uint32_t);
  glBindVertexArray(0);
  if (upload.vertices == 0) {
    size_t turning_bytes = 0;
    for (const TurningGeometry& part : geometry.turning) turning_bytes += part.vertices.size() * sizeof(TownVertex);
    upload.vertices = CreateBuffer(GL_ARRAY_BUFFER, nullptr, vertex_bytes + turning_bytes);
    upload.indices = CreateBuffer(GL_ELEMENT_ARRAY_BUFFER, nullptr, index_bytes);
  }
  const auto put = [&](GLenum target, GLuint buffer, const void* data, size_t from, size_t bytes) {
    glBindBuffer(target, buffer);
    glBufferSubData(target, static_cast<GLintptr>(from), static_cast<GLsizeiptr>(bytes),
                    static_cast<const uint8_t*>(data) + from);
    upload.done_bytes += bytes;
  };
  if (upload.done_bytes < vertex_bytes) {
    const size_t from = upload.done_bytes;
    put(GL_ARRAY_BUFFER, upload.vertices, geometry.vertices.data(), from, std::min(most_bytes, vertex_bytes - from));
  } else if (upload.done_bytes < vertex_bytes + index_bytes) {
    const size_t from = upload.done_bytes - vertex_bytes;
    put(GL_ELEMENT_ARRAY_BUFFER, upload.indices, geometry.indices.data(), from,
        std::min(most_bytes, index_bytes - from));
  }
  return upload.done_bytes == vertex_bytes + index_bytes;
}

void AddTown(TownGeometry geometry, TownView* town) {
  if (town->vertex_array != 0) RemoveTown(town);
  glGenVertexArrays(1, &town->shadow_array);
  glBindVertexArray(town->shadow_array);
  town->vertices = town->upload.vertices;
  town->shadow_indices = town->upload.indices;
  town->upload = {};
  glBindBuffer(GL_ARRAY_BUFFER, town->vertices);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, town->shadow_indices);
  town->still = static_cast<uint32_t>(geometry.vertices.size());
  size_t turning = 0, place_bytes = geometry.vertices.size() * sizeof(TownVertex);
  for (const TurningGeometry& part : geometry.turning) {
    const size_t bytes = part.vertices.size() * sizeof(TownVertex);
    if (bytes > 0)
      glBufferSubData(GL_ARRAY_BUFFER, static_cast<GLintptr>(place_bytes), static_cast<GLsizeiptr>(bytes),
                      part.vertices.data());
    place_bytes += bytes;
    turning += part.indices.size();
  }
  EnableVertices();
  glGenVertexArrays(1, &town->vertex_array);
  glBindVertexArray(town->vertex_array);
  glBindBuffer(GL_ARRAY_BUFFER, town->vertices);
  EnableVertices();
  glGenBuffers(1, &town->visible_indices);
  std::vector<TownVertex>().swap(geometry.vertices);  // its memory too
  town->geometry = std::move(geometry);
  town->masked_groups = MaskedGroups(town->geometry, town->groups);
  for (const TownBlock& block : town->geometry.blocks) {
    Include(block.box.low, &town->box);
    Include(block.box.high, &town->box);
  }
  town->order.reserve(town->geometry.blocks.size());
  town->visible.reserve(town->geometry.blocks.size());
  town->indices.reset(new uint32_t[town->geometry.indices.size() + turning + 3]);
}

void FindVisibleBlocks(const Mat4& view_projection, Vec3 eye, bool cull, TownView* town) {
  const Frustum frustum = FrustumOf(view_projection);
  const std::vector<TownBlock>& blocks = town->geometry.blocks;
  town->order.clear();
  for (size_t b = 0; b < blocks.size(); ++b) {
    if (!cull || MayTouch(frustum, blocks[b].box))
      town->order.push_back({Distance(blocks[b].box, eye), static_cast<uint32_t>(b)});
  }
  std::sort(town->order.begin(), town->order.end());
  ClearOcclusion(view_projection, &town->walls);
  town->visible.clear();
  size_t walls = 0;
  for (const auto& [distance_m, b] : town->order) {
    const TownBlock& block = blocks[b];
    if (cull && !MayBeSeen(town->walls, block.box, false)) continue;
    town->visible.push_back(b);
    if (!cull || walls + block.walls > 3 * kMaxOccluderTriangles) continue;
    walls += block.walls;
    AddWalls(town->geometry.positions, {&town->geometry.walls[block.first_wall], block.walls}, &town->walls);
  }
  FinishOcclusion(&town->walls);
}

DrawCost DrawTown(Vec3 eye, int width_px, int height_px, bool cull, TownView* town) {
  DrawCost cost;
  if (town->vertex_array == 0) return cost;
  const TriangleSight sight{width_px, height_px, &town->walls};
  const size_t indices = GatherIndices(eye, town->triangle_by_triangle ? &sight : nullptr, cull, town);
  glBindVertexArray(town->vertex_array);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, town->visible_indices);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices * sizeof(uint32_t)), town->indices.get(),
               GL_STREAM_DRAW);
  uint32_t first = 0;
  for (size_t g = 0; g < town->groups.size(); ++g) {
    const uint32_t count = town->counts[g];
    if (count == 0) continue;
    BindGroup(town->groups[g], town->lit, *town);
    for (uint32_t left = count; left > 0;) {
      const uint32_t some = town->triangle_by_triangle ? std::min(left, kPiece) : left;
      DrawIndices(first, some);
      if (town->triangle_by_triangle && some == kPiece) glFlush();
      cost += {some / 3, 1};
      first += some;
      left -= some;
    }
  }
  return cost;
}

// v turned about `axis`, unit (Rodrigues).
Vec3 Turned(Vec3 v, Vec3 axis, float sin, float cos) {
  return v * cos + Cross(axis, v) * sin + axis * (Dot(axis, v) * (1 - cos));
}

void AppendTurned(const TurningGeometry& part, float turn_rad, TownView* town) {
  const Vec3 pivot = GltfFromGround(part.part.pivot_m), axis = GltfFromGround(part.part.axis);
  const float sin = std::sin(turn_rad), cos = std::cos(turn_rad);
  const auto base = town->still + static_cast<uint32_t>(town->turned.size());
  for (TownVertex v : part.vertices) {
    v.position = pivot + Turned(v.position - pivot, axis, sin, cos);
    const Vec3 n =
        Turned({FromSignedByte(v.normal[0]), FromSignedByte(v.normal[1]), FromSignedByte(v.normal[2])}, axis, sin, cos);
    for (size_t k = 0; k < 3; ++k) v.normal[k] = SignedByte(k == 0 ? n.x : k == 1 ? n.y : n.z);
    town->turned.push_back(v);
  }
  for (const TownRange& range : part.ranges) {
    std::vector<uint32_t>& to = town->turned_of[static_cast<size_t>(range.group)];
    for (uint32_t i = range.first; i < range.first + range.count; ++i) to.push_back(base + part.indices[i]);
  }
}

void PlaceTurningParts(const Mat4& view_projection, const std::vector<float>& turns_rad, bool cull, TownView* town) {
  const Frustum frustum = FrustumOf(view_projection);
  town->turned.clear();
  town->turned_of.resize(town->groups.size());
  for (std::vector<uint32_t>& indices : town->turned_of) indices.clear();
  for (const TurningGeometry& part : town->geometry.turning) {
    if (cull && (!MayTouch(frustum, part.box) || !MayBeSeen(town->walls, part.box, false))) continue;
    const auto index = static_cast<size_t>(part.index);
    AppendTurned(part, index < turns_rad.size() ? turns_rad[index] : 0, town);
  }
  if (town->turned.empty()) return;
  glBindBuffer(GL_ARRAY_BUFFER, town->vertices);
  glBufferSubData(GL_ARRAY_BUFFER, static_cast<GLintptr>(town->still * sizeof(TownVertex)),
                  static_cast<GLsizeiptr>(town->turned.size() * sizeof(TownVertex)), town->turned.data());
}

size_t ShadowSteps(const TownView& town) { return town.geometry.blocks.size() * (1 + town.masked_groups.size()); }

DrawCost DrawTownShadow(const Mat4& light_projection, int64_t triangles, const TownView& town, size_t* next_step) {
  DrawCost cost;
  if (town.shadow_array == 0) return cost;
  const Frustum frustum = FrustumOf(light_projection);
  const std::vector<TownBlock>& blocks = town.geometry.blocks;
  glBindVertexArray(town.shadow_array);
  // Whatever lies one after the other casts its shadow in one call: all that is opaque, then each group that is cut
  // out.
  struct Run {
    uint32_t first = 0, count = 0;
    int group = -1;
  } run;
  const auto draw = [&] {
    if (run.count == 0) return;
    BindGroup(town.groups[static_cast<size_t>(run.group)], town.shadow, town);
    CullBackFaces(false);
    DrawIndices(run.first, run.count);
    cost += {run.count / 3, 1};
  };
  size_t& step = *next_step;
  for (; step < ShadowSteps(town) && cost.triangles + run.count / 3 < triangles; ++step) {
    const TownBlock& block = blocks[step % blocks.size()];
    const size_t part = step / blocks.size();
    if (!MayTouch(frustum, block.box)) continue;
    for (const TownRange& range : block.ranges) {
      const bool masked = town.groups[static_cast<size_t>(range.group)].masked;
      if (part == 0 ? masked : range.group != town.masked_groups[part - 1]) continue;
      const bool joins =
          run.count > 0 && (part == 0 || run.group == range.group) && range.first - (run.first + run.count) <= kJoined;
      if (!joins) {
        draw();
        run = {range.first, 0, range.group};
      }
      run.count = range.first + range.count - run.first;
    }
  }
  draw();
  return cost;
}

}  // namespace flaneur
