#include "runtime/render/people_view.h"

#include <algorithm>
#include <cstddef>

#include "runtime/pack/tint.h"

namespace flaneur {
namespace {

PersonMesh UploadMesh(const PersonGeometry& person) {
  PersonMesh mesh;
  mesh.ranges = person.ranges;
  mesh.triangles = static_cast<int64_t>(person.indices.size() / 3);
  glGenVertexArrays(1, &mesh.vertex_array);
  glBindVertexArray(mesh.vertex_array);
  CreateBuffer(GL_ARRAY_BUFFER, person.vertices.data(), person.vertices.size() * sizeof(PersonVertex));
  CreateBuffer(GL_ELEMENT_ARRAY_BUFFER, person.indices.data(), person.indices.size() * sizeof(uint32_t));
  constexpr size_t stride = sizeof(PersonVertex);
  EnableAttribute(ATTRIBUTE_POSITION, 3, GL_FLOAT, false, stride, offsetof(PersonVertex, position), 0);
  EnableAttribute(ATTRIBUTE_NORMAL, 4, GL_BYTE, true, stride, offsetof(PersonVertex, normal), 0);
  EnableAttribute(ATTRIBUTE_UV, 2, GL_FLOAT, false, stride, offsetof(PersonVertex, uv), 0);
  EnableAttribute(ATTRIBUTE_COLOR, 4, GL_UNSIGNED_BYTE, true, stride, offsetof(PersonVertex, color), 0);
  EnableAttribute(ATTRIBUTE_JOINTS, 4, GL_UNSIGNED_SHORT, false, stride, offsetof(PersonVertex, joints), 0);
  EnableAttribute(ATTRIBUTE_WEIGHTS, 4, GL_UNSIGNED_BYTE, true, stride, offsetof(PersonVertex, weights), 0);
  EnableAttribute(ATTRIBUTE_DYED, 4, GL_UNSIGNED_BYTE, true, stride, offsetof(PersonVertex, dyed), 0);
  return mesh;
}

Error BuildPrograms(ShaderMode mode, PeopleView* people) {
  constexpr ShaderProgram kMeshes[2][2] = {{ShaderProgram::kPerson, ShaderProgram::kPersonFades},
                                           {ShaderProgram::kPersonMasked, ShaderProgram::kPersonMaskedFades}};
  for (int masked = 0; masked < 2; ++masked) {
    for (int fades = 0; fades < 2; ++fades) {
      if (Error e = BuildProgram(kMeshes[masked][fades], mode, &people->programs[masked][fades])) return e;
    }
  }
  if (Error e = BuildProgram(ShaderProgram::kPersonShadow, mode, &people->shadow_program)) return e;
  return BuildProgram(ShaderProgram::kPersonImpostor, mode, &people->impostor_program);
}

void CreateQuad(PeopleView* people) {
  glGenVertexArrays(1, &people->quad_array);
  glBindVertexArray(people->quad_array);
  const float corners[] = {0, 0, 1, 0, 0, 1, 1, 1};
  CreateBuffer(GL_ARRAY_BUFFER, corners, sizeof corners);
  EnableAttribute(ATTRIBUTE_POSITION, 2, GL_FLOAT, false, 2 * sizeof(float), 0, 0);
}

GLuint CreateTable(GLsizei width, GLsizei height, const Vec4* texels) {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
  if (texels != nullptr) glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, width, height, 0, GL_RGBA, GL_FLOAT, texels);
  return texture;
}

// Coarse shadows' poses: some frames of every clip, one a row.
void CreateShadowPoses(PeopleView* people) {
  const size_t width = people->batches.pose_width;
  std::vector<Vec4> texels;
  for (AvatarLayout& layout : people->layouts) {
    for (size_t k = 0; k < layout.clips.size(); ++k) {
      layout.first_shadow_row[k] = static_cast<int>(texels.size() / width);
      for (int row = 0; row < layout.shadow_rows[k]; ++row) {
        const size_t joints = static_cast<size_t>(layout.joints) * 3;
        const PoseRow* from =
            &layout.clips[k]
                 .rows[static_cast<size_t>(ShadowFrame(layout.clips[k], row, layout.shadow_rows[k])) * joints];
        for (size_t i = 0; i < width; ++i) {
          const PoseRow r = i < joints ? from[i] : PoseRow{};
          const float turn = layout.turn_step;
          texels.push_back({turn * static_cast<float>(r[0]), turn * static_cast<float>(r[1]),
                            turn * static_cast<float>(r[2]), layout.shift_step_m * static_cast<float>(r[3])});
        }
      }
    }
  }
  people->shadow_poses = CreateTable(static_cast<GLsizei>(width),
                                     static_cast<GLsizei>(texels.size() / std::max<size_t>(1, width)), texels.data());
}

// The same direction's in the next phase and in the previous one; -1: the clip has one phase alone.
Vec4 CellsBeside(const AvatarLayout& layout, int cell) {
  const int row = static_cast<int>(layout.impostor.elevations_deg.size()) * layout.impostor.directions,
            frame = cell / row;
  for (const ImpostorClip& clip : layout.impostor.clips) {
    const int phase = frame - clip.first_frame, cell_of_first = layout.first_cell + cell - phase * row;
    if (phase < 0 || phase >= clip.phases || clip.phases == 1) continue;
    const int next = (phase + 1) % clip.phases, previous = (phase + clip.phases - 1) % clip.phases;
    return {static_cast<float>(cell_of_first + next * row), static_cast<float>(cell_of_first + previous * row), 0, 0};
  }
  return {-1, -1, 0, 0};
}

void CreateCells(PeopleView* people) {
  std::vector<Vec4> texels;
  for (AvatarLayout& layout : people->layouts) {
    const PackImpostor& atlas = layout.impostor;
    layout.first_cell = static_cast<int>(texels.size() / 3);
    for (size_t i = 0; i < atlas.cells.size(); ++i) {
      const ImpostorCell& c = atlas.cells[i];
      const size_t elevation = i / static_cast<size_t>(atlas.directions) % atlas.elevations_deg.size();
      const float elevation_rad = atlas.elevations_deg[elevation] * kPi / 180;
      const auto left = static_cast<float>(c.x), top = static_cast<float>(c.y);
      texels.push_back({left, top, left + static_cast<float>(c.width), top + static_cast<float>(c.height)});
      texels.push_back({static_cast<float>(c.origin_x), static_cast<float>(c.origin_y), std::sin(elevation_rad),
                        std::cos(elevation_rad)});
      texels.push_back(CellsBeside(layout, static_cast<int>(i)));
    }
  }
  texels.resize((texels.size() + CELLS_WIDTH) / CELLS_WIDTH * CELLS_WIDTH);
  people->cells = CreateTable(CELLS_WIDTH, static_cast<GLsizei>(texels.size() / CELLS_WIDTH), texels.data());
}

void SetTints(const Program& program, const AvatarView& avatar) {
  SetUniform(program.tints, avatar.tints);
  SetUniform(program.tint_shifts, avatar.tint_shifts);
}

DrawCost DrawImpostors(const PeopleView& people, const PeopleBatch& batch) {
  const AvatarView& avatar = people.avatars[static_cast<size_t>(batch.avatar)];
  const Program& program = people.impostor_program;
  glUseProgram(program.id);
  SetUniform(program.atlas, avatar.atlas);
  SetUniform(program.ranges, avatar.ranges);
  SetUniform(program.directions, avatar.directions);
  SetTints(program, avatar);
  BindTexture(kNormalsUnit, avatar.normals);
  BindTexture(kDepthUnit, avatar.depth);
  BindTexture(kMotionUnit, avatar.motion);
  SetUniform(program.tint_regions, avatar.tint_regions != 0 ? 1.0f : 0.0f);
  BindTexture(kTintsUnit, avatar.tint_regions);
  BindTexture(kColorUnit, avatar.albedo);
  BindTexture(kCellsUnit, people.cells);
  glBindVertexArray(people.quad_array);
  BindInstances(people.instances, batch);
  CullBackFaces(false);
  if (people.smooth_edges) glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(batch.count));
  if (people.smooth_edges) glDisable(GL_SAMPLE_ALPHA_TO_COVERAGE);
  return {2 * static_cast<int64_t>(batch.count), 1};
}

void DrawRange(const PersonRange& range, size_t instances) {
  glDrawElementsInstanced(GL_TRIANGLES, static_cast<GLsizei>(range.count), GL_UNSIGNED_INT,
                          reinterpret_cast<const void*>(size_t{range.first} * sizeof(uint32_t)),
                          static_cast<GLsizei>(instances));
}

DrawCost DrawMeshes(const PeopleView& people, const PeopleBatch& batch) {
  const AvatarView& avatar = people.avatars[static_cast<size_t>(batch.avatar)];
  const PersonMesh& mesh = avatar.levels[static_cast<size_t>(batch.level)];
  glBindVertexArray(mesh.vertex_array);
  BindInstances(people.instances, batch);
  BindTexture(kPosesUnit, people.poses);
  for (const PersonRange& range : mesh.ranges) {
    const SurfaceGroup& group = people.groups[static_cast<size_t>(range.group)];
    const Program& program = people.programs[group.masked][batch.fades];
    glUseProgram(program.id);
    SetTints(program, avatar);
    if (group.masked) SetUniform(program.alpha_cutoff, group.alpha_cutoff);
    if (group.array >= 0) BindTextureArray(kArrayUnit, people.arrays[static_cast<size_t>(group.array)]);
    CullBackFaces(!group.double_sided);
    DrawRange(range, batch.count);
  }
  return {mesh.triangles * static_cast<int64_t>(batch.count), static_cast<int>(mesh.ranges.size())};
}

static_assert(kMaxTints == MAX_TINTS && kMaxTintColors == MAX_TINT_COLORS, "the shaders have as many");
static_assert(kMaxTintColors < 16, "an instance has four bits for each tint");

void AddTints(const std::vector<Tint>& tints, AvatarView* view) {
  for (size_t t = 0; t < std::min(tints.size(), kMaxTints); ++t) {
    const Tint& tint = tints[t];
    const Vec3 color = WithHalfLightness(tint.color);
    const float nearness = 1 / (tint.reach * tint.reach);
    view->tints[t] = {color.x, color.y, color.z, tint.by_material ? -nearness : nearness};
    for (size_t k = 0; k < std::min(tint.colors.size(), kMaxTintColors); ++k) {
      const Vec3 shift = tint.colors[k] - tint.color;
      view->tint_shifts[t * kMaxTintColors + k] = {shift.x, shift.y, shift.z, 0};
    }
  }
}

}  // namespace

// OpenGL ES 3.0 has no base instance: the attributes begin where the batch does.
void BindInstances(GLuint buffer, const PeopleBatch& batch) {
  constexpr size_t stride = sizeof(PersonInstance);
  const size_t first = batch.first * stride;
  glBindBuffer(GL_ARRAY_BUFFER, buffer);
  EnableAttribute(ATTRIBUTE_PLACE, 4, GL_FLOAT, false, stride, first + offsetof(PersonInstance, place), 1);
  EnableAttribute(ATTRIBUTE_LOOK, 4, GL_FLOAT, false, stride, first + offsetof(PersonInstance, look), 1);
  EnableAttribute(ATTRIBUTE_TINTS, 4, GL_UNSIGNED_BYTE, false, stride, first + offsetof(PersonInstance, tints), 1);
}

Error CreatePeopleView(const TourPack& pack, ShaderMode mode, const SurfacePlan& plan,
                       const std::vector<GLuint>& arrays, PeopleView* people) {
  if (Error e = BuildPrograms(mode, people)) return e;
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  people->groups = plan.groups;
  people->arrays = arrays;
  for (const PackAvatar& avatar : pack.avatars) {
    if (3 * avatar.joints > most)
      return Fail("avatar '" + avatar.name + "' has more joints than this machine's OpenGL can hold");
    people->batches.pose_width = std::max(people->batches.pose_width, 3 * static_cast<size_t>(avatar.joints));
    people->layouts.push_back(LayoutOf(avatar));
    const PackImpostor& atlas = avatar.impostor;
    const float width_px = static_cast<float>(atlas.width_px), height_px = static_cast<float>(atlas.height_px);
    AvatarView view;
    view.levels.resize(avatar.levels.size() + avatar.props.size());
    view.atlas = {1 / (atlas.texel_m * width_px), 1 / (atlas.texel_m * height_px), width_px, height_px};
    view.ranges = {atlas.depth_range_m, atlas.motion_range_m, atlas.bend_range_m};
    view.directions = static_cast<float>(atlas.directions);
    view.impostor_of = avatar.impostor_of;
    AddTints(avatar.tints, &view);
    people->ready.push_back({std::vector<bool>(view.levels.size(), false), false, false});
    people->avatars.push_back(std::move(view));
  }
  CreateQuad(people);
  people->poses = CreateTable(0, 0, nullptr);
  CreateShadowPoses(people);
  CreateCells(people);
  glGenBuffers(1, &people->instances);
  return Ok();
}

void AddLevel(int avatar, int level, const PersonGeometry& person, const ShadowLevels& shadows, PeopleView* people) {
  const auto index = static_cast<size_t>(avatar);
  people->avatars[index].levels[static_cast<size_t>(level)] = UploadMesh(person);
  if (shadows[0].indices.empty()) return;
  for (size_t k = 0; k < shadows.size(); ++k) people->avatars[index].shadows[k] = UploadMesh(shadows[k]);
  people->ready[index].shadow = true;
}

void ShowLevels(PeopleView* people) {
  for (size_t a = 0; a < people->avatars.size(); ++a) {
    for (size_t k = 0; k < people->avatars[a].levels.size(); ++k)
      people->ready[a].levels[k] = people->avatars[a].levels[k].vertex_array != 0;
  }
}

void AddAtlas(int avatar, PeopleView* people) {
  AvatarView& view = people->avatars[static_cast<size_t>(avatar)];
  GLuint* textures[] = {&view.albedo, &view.normals, &view.depth, &view.motion, &view.tint_regions};
  for (size_t k = 0; k < kAtlasPictures; ++k) {
    if (*textures[k] != 0) glDeleteTextures(1, textures[k]);
    *textures[k] = people->upload.textures[k];
  }
  people->upload = {};
  people->ready[static_cast<size_t>(avatar)].impostor = true;
  for (size_t other = 0; other < people->avatars.size(); ++other) {
    if (people->avatars[other].impostor_of != avatar) continue;
    AvatarView& shares = people->avatars[other];
    shares.albedo = view.albedo, shares.normals = view.normals, shares.depth = view.depth, shares.motion = view.motion;
    shares.tint_regions = view.tint_regions;
    people->ready[other].impostor = true;
  }
}

std::vector<AssetId> AssetsFor(const std::vector<DrawnPerson>& drawn, const PeopleSight& sight,
                               const PeopleView& people) {
  std::vector<AvatarReady> all = people.ready;
  for (AvatarReady& ready : all) ready = {std::vector<bool>(ready.levels.size(), true), true, true};
  PeopleBatches batches;
  batches.pose_width = people.batches.pose_width;
  SortPeople(drawn, people.layouts, all, sight, &batches);
  std::vector<AssetId> ids;
  for (const PeopleBatch& b : batches.seen) {
    const int like = people.avatars[static_cast<size_t>(b.avatar)].impostor_of;
    if (b.level >= 0) ids.push_back({AssetKind::kLevel, b.avatar, b.level});
    else ids.push_back({AssetKind::kAtlas, like < 0 ? b.avatar : like, 0});
  }
  for (const std::vector<PeopleBatch>& map : batches.shadows) {
    for (const PeopleBatch& b : map)  // their figures come with the coarsest level
      ids.push_back({AssetKind::kLevel, b.avatar, people.layouts[static_cast<size_t>(b.avatar)].levels - 1});
  }
  return ids;
}

void UploadPeople(PeopleView* people) {
  const PeopleBatches& b = people->batches;
  glBindBuffer(GL_ARRAY_BUFFER, people->instances);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(b.instances.size() * sizeof(PersonInstance)),
               b.instances.data(), GL_STREAM_DRAW);
  BindTexture(kPosesUnit, people->poses);
  const auto width = static_cast<GLsizei>(b.pose_width);
  if (b.pose_rows > people->poses_held) {
    people->poses_held = b.pose_rows + b.pose_rows / 2;
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, width, static_cast<GLsizei>(people->poses_held), 0, GL_RGBA, GL_FLOAT,
                 nullptr);
  }
  if (b.pose_rows > 0) {
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, static_cast<GLsizei>(b.pose_rows), GL_RGBA, GL_FLOAT,
                    b.poses.data());
  }
}

DrawCost DrawPeople(const PeopleView& people, bool impostors) {
  DrawCost cost;
  for (const PeopleBatch& b : people.batches.seen) {
    if ((b.level < 0) == impostors) cost += impostors ? DrawImpostors(people, b) : DrawMeshes(people, b);
  }
  return cost;
}

DrawCost DrawPeopleShadow(const PeopleView& people, const std::vector<PeopleBatch>& shadows) {
  DrawCost cost;
  glUseProgram(people.shadow_program.id);
  CullBackFaces(false);
  for (const PeopleBatch& b : shadows) {
    BindTexture(kPosesUnit, b.level == 0 ? people.poses : people.shadow_poses);
    const PersonMesh& mesh = people.avatars[static_cast<size_t>(b.avatar)].shadows[static_cast<size_t>(b.level)];
    glBindVertexArray(mesh.vertex_array);
    BindInstances(people.instances, b);
    DrawRange(mesh.ranges[0], b.count);
    cost += {mesh.triangles * static_cast<int64_t>(b.count), 1};
  }
  return cost;
}

}  // namespace flaneur
