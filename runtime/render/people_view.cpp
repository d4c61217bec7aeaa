#include "runtime/render/people_view.h"

#include <algorithm>
#include <cstddef>

#include "runtime/render/shaders.h"

namespace flaneur {
namespace {

struct PersonVertex {
  Vec3 position, normal;
  Vec2 uv;
  std::array<uint8_t, 4> color;  // the material's base colour is in it
  std::array<uint16_t, 4> joints;
  std::array<float, 4> weights;
};

uint8_t Byte(float v) { return static_cast<uint8_t>(std::clamp(v, 0.0f, 1.0f) * 255 + 0.5f); }

void Append(const PackPrimitive& p, Vec4 base, std::vector<PersonVertex>* vertices) {
  for (size_t i = 0; i < p.positions.size(); ++i) {
    const Vec4 c = p.colors.empty() ? Vec4{1, 1, 1, 1} : p.colors[i];
    PersonVertex v{p.positions[i], p.normals[i], p.uvs.empty() ? Vec2{} : p.uvs[i],
                   {Byte(c.x * base.x), Byte(c.y * base.y), Byte(c.z * base.z), Byte(c.w * base.w)}, {}, {1, 0, 0, 0}};
    if (!p.joints.empty()) v.joints = p.joints[i], v.weights = p.weights[i];
    vertices->push_back(v);
  }
}

PersonLevel UploadLevel(const TourPack& pack, const PackMesh& mesh, const std::vector<Surface>& surfaces) {
  PersonLevel level;
  std::vector<PersonVertex> vertices;
  std::vector<uint32_t> indices;
  for (const PackPrimitive& p : mesh.primitives) {
    const auto base = static_cast<uint32_t>(vertices.size());
    const Surface& surface = p.material >= 0 ? surfaces[static_cast<size_t>(p.material)] : surfaces.back();
    level.ranges.push_back({surface, indices.size(), static_cast<GLsizei>(p.indices.size())});
    Append(p, p.material >= 0 ? pack.materials[static_cast<size_t>(p.material)].base_color : Vec4{1, 1, 1, 1}, &vertices);
    for (uint32_t i : p.indices) indices.push_back(base + i);
  }
  level.triangles = static_cast<int64_t>(indices.size() / 3);
  glGenVertexArrays(1, &level.vertex_array);
  glBindVertexArray(level.vertex_array);
  CreateBuffer(GL_ARRAY_BUFFER, vertices.data(), vertices.size() * sizeof(PersonVertex));
  CreateBuffer(GL_ELEMENT_ARRAY_BUFFER, indices.data(), indices.size() * sizeof(uint32_t));
  constexpr size_t stride = sizeof(PersonVertex);
  EnableAttribute(0, 3, GL_FLOAT, false, stride, offsetof(PersonVertex, position), 0);
  EnableAttribute(1, 3, GL_FLOAT, false, stride, offsetof(PersonVertex, normal), 0);
  EnableAttribute(2, 2, GL_FLOAT, false, stride, offsetof(PersonVertex, uv), 0);
  EnableAttribute(3, 4, GL_UNSIGNED_BYTE, true, stride, offsetof(PersonVertex, color), 0);
  EnableAttribute(4, 4, GL_UNSIGNED_SHORT, false, stride, offsetof(PersonVertex, joints), 0);
  EnableAttribute(5, 4, GL_FLOAT, false, stride, offsetof(PersonVertex, weights), 0);
  return level;
}

AvatarView UploadAvatar(const TourPack& pack, const PackAvatar& avatar, const std::vector<Surface>& surfaces) {
  AvatarView view;
  for (const PackLevel& level : avatar.levels) {
    view.levels.push_back(UploadLevel(pack, pack.meshes[static_cast<size_t>(level.mesh)], surfaces));
  }
  const PackImpostor& atlas = avatar.impostor;
  view.atlas = {1 / (atlas.texel_m * static_cast<float>(atlas.width_px)), 1 / (atlas.texel_m * static_cast<float>(atlas.height_px)),
                static_cast<float>(atlas.width_px), static_cast<float>(atlas.height_px)};
  view.ranges = {atlas.depth_range_m, atlas.motion_range_m, 0};
  if (avatar.impostor_of >= 0) return view;
  const bool decode = DrawsInSoftware();
  view.albedo = UploadAtlasPicture(atlas.albedo, decode);
  view.normals = UploadAtlasPicture(atlas.normal, decode);
  view.depth = UploadAtlasPicture(atlas.depth, decode);
  view.motion = UploadAtlasPicture(atlas.motion, decode);
  return view;
}

void ShareImpostor(const AvatarView& from, AvatarView* view) {
  view->albedo = from.albedo;
  view->normals = from.normals;
  view->depth = from.depth;
  view->motion = from.motion;
}

Error BuildPrograms(const std::string& defines, PeopleView* people) {
  const std::string vertex = std::string(kFrame) + kPersonVertex, impostor_vertex = std::string(kFrame) + kImpostorVertex;
  const std::string views = defines + kFrame + kImpostorViews;
  for (int masked = 0; masked < 2; ++masked) {
    const std::string mask = masked ? "#define MASKED\n" : "";
    const std::string lit = mask + defines + kFrame + kLight;
    if (Error e = BuildProgram(vertex, lit + kSurfaceFragment, &people->programs[masked][0])) return e;
    if (Error e = BuildProgram(vertex, "#define FADES\n" + lit + kFade + kSurfaceFragment, &people->programs[masked][1])) return e;
    if (Error e = BuildProgram(vertex, mask + kShadowFragment, &people->shadow_programs[masked])) return e;
  }
  if (Error e = BuildProgram(impostor_vertex, views + kLight + kFade + kImpostorFragment, &people->impostor_program)) {
    return e;
  }
  return BuildProgram("#define SHADOW\n" + impostor_vertex, "#define SHADOW\n" + views + kImpostorShadowFragment,
                      &people->impostor_shadow_program);
}

void CreateQuad(PeopleView* people) {
  glGenVertexArrays(1, &people->quad_array);
  glBindVertexArray(people->quad_array);
  const float corners[] = {0, 0, 1, 0, 0, 1, 1, 1};
  CreateBuffer(GL_ARRAY_BUFFER, corners, sizeof corners);
  EnableAttribute(0, 2, GL_FLOAT, false, 2 * sizeof(float), 0, 0);
}

void CreatePoses(PeopleView* people) {
  glGenTextures(1, &people->poses);
  glBindTexture(GL_TEXTURE_2D, people->poses);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

// OpenGL ES 3.0 has no base instance: the attributes begin where the batch does.
void BindInstances(GLuint buffer, const PeopleBatch& batch, bool impostor) {
  constexpr size_t stride = sizeof(PersonInstance);
  const size_t first = batch.first * stride;
  glBindBuffer(GL_ARRAY_BUFFER, buffer);
  EnableAttribute(6, 4, GL_FLOAT, false, stride, first + offsetof(PersonInstance, place), 1);
  EnableAttribute(7, 4, GL_FLOAT, false, stride, first + offsetof(PersonInstance, look), 1);
  if (!impostor) return;
  EnableAttribute(8, 4, GL_FLOAT, false, stride, first + offsetof(PersonInstance, views), 1);
  EnableAttribute(9, 4, GL_FLOAT, false, stride, first + offsetof(PersonInstance, cells), 1);
  EnableAttribute(10, 4, GL_FLOAT, false, stride, first + offsetof(PersonInstance, cells) + sizeof(Vec4), 1);
  EnableAttribute(11, 4, GL_FLOAT, false, stride, first + offsetof(PersonInstance, origins), 1);
  EnableAttribute(12, 4, GL_FLOAT, false, stride, first + offsetof(PersonInstance, window), 1);
  EnableAttribute(13, 2, GL_FLOAT, false, stride, first + offsetof(PersonInstance, right), 1);
}

int64_t DrawImpostors(const PeopleView& people, const PeopleBatch& batch, GLuint program) {
  const AvatarView& avatar = people.avatars[static_cast<size_t>(batch.avatar)];
  glUseProgram(program);
  SetUniform(program, "u_atlas", avatar.atlas);
  SetUniform(program, "u_ranges", avatar.ranges);
  BindTexture(kNormalsUnit, avatar.normals);
  BindTexture(kDepthUnit, avatar.depth);
  BindTexture(kMotionUnit, avatar.motion);
  BindTexture(kColorUnit, avatar.albedo);
  glBindVertexArray(people.quad_array);
  BindInstances(people.instances, batch, true);
  CullBackFaces(false);
  if (people.smooth_edges) glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(batch.count));
  if (people.smooth_edges) glDisable(GL_SAMPLE_ALPHA_TO_COVERAGE);
  return 2 * static_cast<int64_t>(batch.count);
}

int64_t DrawMeshes(const PeopleView& people, const PeopleBatch& batch, GLuint plain, GLuint masked) {
  const AvatarView& avatar = people.avatars[static_cast<size_t>(batch.avatar)];
  const PersonLevel& level = avatar.levels[static_cast<size_t>(batch.level)];
  glBindVertexArray(level.vertex_array);
  BindInstances(people.instances, batch, false);
  for (const PersonRange& range : level.ranges) {
    const GLuint program = range.surface.masked ? masked : plain;
    glUseProgram(program);
    if (range.surface.masked) SetUniform(program, "u_alpha_cutoff", range.surface.alpha_cutoff);
    BindTexture(kColorUnit, range.surface.texture);
    CullBackFaces(!range.surface.double_sided);
    glDrawElementsInstanced(GL_TRIANGLES, range.count, GL_UNSIGNED_INT,
                            reinterpret_cast<const void*>(range.first * sizeof(uint32_t)), static_cast<GLsizei>(batch.count));
  }
  return level.triangles * static_cast<int64_t>(batch.count);
}

}  // namespace

Error CreatePeopleView(const TourPack& pack, const std::string& defines, const std::vector<Surface>& surfaces, PeopleView* people) {
  if (Error e = BuildPrograms(defines, people)) return e;
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  for (const PackAvatar& avatar : pack.avatars) {
    if (3 * avatar.joints > most) return Fail("avatar '" + avatar.name + "' has more joints than this machine's OpenGL can hold");
    people->batches.pose_width = std::max(people->batches.pose_width, 3 * static_cast<size_t>(avatar.joints));
    people->layouts.push_back(LayoutOf(avatar));
    people->avatars.push_back(UploadAvatar(pack, avatar, surfaces));
    if (avatar.impostor_of >= 0) ShareImpostor(people->avatars[static_cast<size_t>(avatar.impostor_of)], &people->avatars.back());
  }
  glGenBuffers(1, &people->instances);
  CreateQuad(people);
  CreatePoses(people);
  return Ok();
}

void UploadPeople(PeopleView* people) {
  PeopleBatches& b = people->batches;
  glBindBuffer(GL_ARRAY_BUFFER, people->instances);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(b.instances.size() * sizeof(PersonInstance)), b.instances.data(), GL_STREAM_DRAW);
  BindTexture(kPosesUnit, people->poses);
  const auto width = static_cast<GLsizei>(b.pose_width);
  if (b.pose_rows > people->poses_held) {
    people->poses_held = std::max(2 * people->poses_held, b.pose_rows);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, width, static_cast<GLsizei>(people->poses_held), 0, GL_RGBA, GL_FLOAT, nullptr);
  }
  if (b.pose_rows > 0) {
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, static_cast<GLsizei>(b.pose_rows), GL_RGBA, GL_FLOAT, b.poses.data());
  }
}

int64_t DrawPeople(const PeopleView& people) {
  int64_t triangles = 0;
  for (const PeopleBatch& b : people.batches.seen) {
    triangles += b.level < 0 ? DrawImpostors(people, b, people.impostor_program)
                             : DrawMeshes(people, b, people.programs[0][b.fades], people.programs[1][b.fades]);
  }
  return triangles;
}

int64_t DrawPeopleShadow(const PeopleView& people) {
  int64_t triangles = 0;
  for (const PeopleBatch& b : people.batches.shadows) {
    triangles += b.level < 0 ? DrawImpostors(people, b, people.impostor_shadow_program)
                             : DrawMeshes(people, b, people.shadow_programs[0], people.shadow_programs[1]);
  }
  return triangles;
}

}  // namespace flaneur
