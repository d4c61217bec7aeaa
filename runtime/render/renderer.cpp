#include "runtime/render/renderer.h"

#include <GLES3/gl3.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "runtime/render/gl_objects.h"
#include "runtime/render/shaders.h"

namespace flaneur {
namespace {

constexpr float kNear_m = 0.1f, kFar_m = 900;
constexpr int kTownShadow_px = 2048, kPeopleShadow_px = 1024;
constexpr float kTownShadow_m = 60, kPeopleShadow_m = 28;  // half the width that each map covers around the camera
constexpr float kShadowDepth_m = 140;
constexpr float kShadowStep_m = 10;       // the town's shadows are drawn anew when the camera has gone so far
constexpr float kSunStep = 0.01f;         // or the sun has turned by so much, in radians
constexpr int kImpostorMostLevel = 3;     // smaller mips would mix neighbouring cells

struct Vertex {
  Vec3 position, normal;
  Vec2 uv;
  uint8_t color[4];
  uint8_t joints[4];
  float weights[4];
};

struct GpuPrimitive {
  GLuint vertex_array = 0;
  GLsizei indices = 0;
  GLuint texture = 0;
  Vec4 base_color;
  float alpha_cutoff = 0;
  bool double_sided = false;
};

struct GpuMesh {
  std::vector<GpuPrimitive> primitives;
  Vec3 center;
  float radius_m = 0;
  int64_t triangles = 0;
};

struct GpuClip { int first_row = 0, rows = 1; };

struct GpuAvatar {
  std::vector<int> level_meshes;
  GLuint joint_texture = 0;
  GpuClip clips[3];
  GLuint albedo = 0, normals = 0;
  PackImpostor impostor;
  Vec4 cell;  // size and half a texel, in texture coordinates
};

// Of one person: as a mesh (rows) or as an impostor (cells, row, right).
struct Instance {
  float place[4];
  float rows[3];
  float cells[3];
  float row;
  float right[2];
};

struct Batch { int avatar, level; std::vector<Instance> instances; };

Mat4 LookMatrix(Vec3 eye, Vec3 ahead, Vec3 up) {
  const Vec3 z = Normalized(ahead * -1), x = Normalized(Cross(up, z)), y = Cross(z, x);
  Mat4 m;
  m.m[0] = {x.x, y.x, z.x, 0};
  m.m[1] = {x.y, y.y, z.y, 0};
  m.m[2] = {x.z, y.z, z.z, 0};
  m.m[3] = {-Dot(x, eye), -Dot(y, eye), -Dot(z, eye), 1};
  return m;
}

Mat4 Perspective(float fov_rad, float aspect) {
  const float f = 1 / std::tan(fov_rad / 2);  // horizontal
  Mat4 m;
  m.m[0] = {f, 0, 0, 0};
  m.m[1] = {0, f * aspect, 0, 0};
  m.m[2] = {0, 0, (kFar_m + kNear_m) / (kNear_m - kFar_m), -1};
  m.m[3] = {0, 0, 2 * kFar_m * kNear_m / (kNear_m - kFar_m), 0};
  return m;
}

// Looking along the light at a square around `center`, whose place is rounded to texels so that shadows don't crawl.
Mat4 ShadowMatrix(Vec3 center, Vec3 to_sun, float half_m, int size_px) {
  const Vec3 up = std::abs(to_sun.y) > 0.99f ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Mat4 view = LookMatrix({0, 0, 0}, to_sun * -1, up);
  Vec3 c = TransformPoint(view, center);
  const float texel_m = 2 * half_m / static_cast<float>(size_px);
  c.x = std::floor(c.x / texel_m) * texel_m;
  c.y = std::floor(c.y / texel_m) * texel_m;
  Mat4 ortho;
  ortho.m[0][0] = 1 / half_m;
  ortho.m[1][1] = 1 / half_m;
  ortho.m[2][2] = -1 / kShadowDepth_m;
  ortho.m[3] = {-c.x / half_m, -c.y / half_m, c.z / kShadowDepth_m, 1};
  return ortho * view;
}

uint8_t Byte(float v) { return static_cast<uint8_t>(std::clamp(v, 0.0f, 1.0f) * 255 + 0.5f); }

void EnableAttribute(GLuint index, GLint size, GLenum type, bool normalized, size_t stride, size_t offset, GLuint divisor) {
  glEnableVertexAttribArray(index);
  const void* pointer = reinterpret_cast<const void*>(offset);
  if (type == GL_UNSIGNED_BYTE && !normalized) glVertexAttribIPointer(index, size, type, static_cast<GLsizei>(stride), pointer);
  else glVertexAttribPointer(index, size, type, normalized, static_cast<GLsizei>(stride), pointer);
  glVertexAttribDivisor(index, divisor);
}

void BindInstanceAttributes(GLuint buffer) {
  glBindBuffer(GL_ARRAY_BUFFER, buffer);
  EnableAttribute(6, 4, GL_FLOAT, false, sizeof(Instance), offsetof(Instance, place), 1);
}

struct Light {
  Vec3 sun, sky, ground, haze, zenith;
};

// The sun's colour warms and fades towards the horizon.
Light LightFor(Vec3 to_sun) {
  const float height = std::clamp(to_sun.y, 0.0f, 1.0f);
  const float low = 1 - std::clamp(height / 0.6f, 0.0f, 1.0f);
  const float strength = 3.4f * std::clamp((to_sun.y + 0.02f) / 0.2f, 0.0f, 1.0f);
  Light light;
  light.sun = Vec3{1.0f, 0.92f - 0.22f * low, 0.78f - 0.38f * low} * strength;
  light.sky = {0.62f, 0.72f, 0.92f};
  light.ground = {0.42f, 0.36f, 0.30f};
  light.haze = {0.78f + 0.10f * low, 0.80f, 0.84f - 0.08f * low};
  light.zenith = {0.20f, 0.40f, 0.78f};
  return light;
}

}  // namespace

struct Renderer::Impl {
  std::vector<GLuint> textures;  // by pack image; impostors' stay 0
  GLuint white = 0;
  std::vector<GpuMesh> meshes;
  std::vector<TownInstance> town;
  std::vector<GpuAvatar> avatars;
  GLuint town_program = 0, person_program = 0, impostor_program = 0, sky_program = 0;
  GLuint town_shadow_program = 0, person_shadow_program = 0, impostor_shadow_program = 0;
  GLuint instance_buffer = 0, quad_array = 0, empty_array = 0;
  ShadowMap town_shadow, people_shadow;
  Mat4 town_shadow_matrix, people_shadow_matrix;
  Vec3 shadow_center{1e9f, 0, 0}, shadow_sun;
  Picture picture;
  std::vector<Batch> batches;

  Error BuildPrograms();
  void UploadMeshes(const TourPack& pack);
  void UploadAvatar(const TourPack& pack, const PackAvatar& avatar);
  void FillBatches(const FrameInput& frame, Vec3 eye);
  void DrawTown(GLuint program, const Mat4& view_projection, bool shaded, int64_t* triangles);
  void DrawPeople(bool shadow, const Mat4& view_projection, Vec3 eye, Vec3 to_sun, const Light& light, int64_t* triangles);
  void BindLight(GLuint program, Vec3 eye, Vec3 to_sun, const Light& light) const;
  void DrawShadows(const FrameInput& frame, Vec3 eye, Vec3 to_sun, const Light& light);
  Instance ImpostorInstance(const DrawnPerson& person, const GpuAvatar& avatar, Vec3 eye) const;
  Instance MeshInstance(const DrawnPerson& person, const GpuAvatar& avatar) const;
};

Error Renderer::Impl::BuildPrograms() {
  const std::string light = kLight;
  if (Error e = BuildProgram(kTownVertex, light + kSurfaceFragment, &town_program)) return e;
  if (Error e = BuildProgram(kPersonVertex, light + kSurfaceFragment, &person_program)) return e;
  if (Error e = BuildProgram(kImpostorVertex, light + kImpostorFragment, &impostor_program)) return e;
  if (Error e = BuildProgram(kSkyVertex, kSkyFragment, &sky_program)) return e;
  if (Error e = BuildProgram(kTownVertex, kShadowFragment, &town_shadow_program)) return e;
  if (Error e = BuildProgram(kPersonVertex, kShadowFragment, &person_shadow_program)) return e;
  return BuildProgram(kImpostorVertex, kImpostorShadowFragment, &impostor_shadow_program);
}

namespace {

std::vector<Vertex> Interleave(const PackPrimitive& p) {
  std::vector<Vertex> vertices(p.positions.size());
  for (size_t i = 0; i < vertices.size(); ++i) {
    Vertex& v = vertices[i];
    v.position = p.positions[i];
    v.normal = p.normals[i];
    v.uv = p.uvs.empty() ? Vec2{} : p.uvs[i];
    const Vec4 c = p.colors.empty() ? Vec4{1, 1, 1, 1} : p.colors[i];
    v.color[0] = Byte(c.x), v.color[1] = Byte(c.y), v.color[2] = Byte(c.z), v.color[3] = Byte(c.w);
    for (size_t k = 0; k < 4; ++k) {
      v.joints[k] = p.joints.empty() ? 0 : static_cast<uint8_t>(p.joints[i][k]);
      v.weights[k] = p.weights.empty() ? 0 : p.weights[i][k];
    }
  }
  return vertices;
}

GLuint UploadVertices(const PackPrimitive& p) {
  GLuint array = 0, buffers[2];
  glGenVertexArrays(1, &array);
  glGenBuffers(2, buffers);
  glBindVertexArray(array);
  const std::vector<Vertex> vertices = Interleave(p);
  glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex)), vertices.data(), GL_STATIC_DRAW);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(p.indices.size() * 4), p.indices.data(), GL_STATIC_DRAW);
  EnableAttribute(0, 3, GL_FLOAT, false, sizeof(Vertex), offsetof(Vertex, position), 0);
  EnableAttribute(1, 3, GL_FLOAT, false, sizeof(Vertex), offsetof(Vertex, normal), 0);
  EnableAttribute(2, 2, GL_FLOAT, false, sizeof(Vertex), offsetof(Vertex, uv), 0);
  EnableAttribute(3, 4, GL_UNSIGNED_BYTE, true, sizeof(Vertex), offsetof(Vertex, color), 0);
  if (!p.joints.empty()) {
    EnableAttribute(4, 4, GL_UNSIGNED_BYTE, false, sizeof(Vertex), offsetof(Vertex, joints), 0);
    EnableAttribute(5, 4, GL_FLOAT, false, sizeof(Vertex), offsetof(Vertex, weights), 0);
  }
  return array;
}

void MeasureBounds(const PackMesh& mesh, GpuMesh* out) {
  Vec3 low{1e9f, 1e9f, 1e9f}, high{-1e9f, -1e9f, -1e9f};
  for (const PackPrimitive& p : mesh.primitives) {
    for (Vec3 v : p.positions) {
      low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
      high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
    }
    out->triangles += static_cast<int64_t>(p.indices.size() / 3);
  }
  out->center = (low + high) * 0.5f;
  out->radius_m = Length(high - low) * 0.5f;
}

}  // namespace

void Renderer::Impl::UploadMeshes(const TourPack& pack) {
  std::vector<char> is_impostor(pack.images.size(), 0);
  for (const PackAvatar& a : pack.avatars) {
    is_impostor[static_cast<size_t>(a.impostor.albedo_image)] = is_impostor[static_cast<size_t>(a.impostor.normal_image)] = 1;
  }
  white = UploadWhite();
  for (size_t i = 0; i < pack.images.size(); ++i) {
    textures.push_back(is_impostor[i] ? 0 : UploadTexture(pack.images[i], true, true, 1000));
  }
  for (const PackMesh& mesh : pack.meshes) {
    GpuMesh gpu;
    MeasureBounds(mesh, &gpu);
    for (const PackPrimitive& p : mesh.primitives) {
      GpuPrimitive out;
      out.vertex_array = UploadVertices(p);
      out.indices = static_cast<GLsizei>(p.indices.size());
      const PackMaterial material = p.material >= 0 ? pack.materials[static_cast<size_t>(p.material)] : PackMaterial{};
      out.texture = material.base_color_image >= 0 ? textures[static_cast<size_t>(material.base_color_image)] : white;
      out.base_color = material.base_color;
      out.alpha_cutoff = material.alpha_mask ? material.alpha_cutoff : 0;
      out.double_sided = material.double_sided;
      gpu.primitives.push_back(out);
    }
    meshes.push_back(std::move(gpu));
  }
}

void Renderer::Impl::UploadAvatar(const TourPack& pack, const PackAvatar& avatar) {
  GpuAvatar gpu;
  for (const PackLevel& level : avatar.levels) gpu.level_meshes.push_back(level.mesh);
  std::vector<float> rows;
  const PackClip* clips[3] = {&avatar.walk, &avatar.idle, &avatar.talk};
  int row = 0;
  for (size_t k = 0; k < 3; ++k) {
    gpu.clips[k] = {row, clips[k]->frames};
    row += clips[k]->frames;
    for (const Mat4& m : clips[k]->matrices) {
      for (size_t r = 0; r < 3; ++r) {
        for (size_t c = 0; c < 4; ++c) rows.push_back(m.m[c][r]);
      }
    }
  }
  glGenTextures(1, &gpu.joint_texture);
  glBindTexture(GL_TEXTURE_2D, gpu.joint_texture);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, 3 * avatar.joints, row, 0, GL_RGBA, GL_FLOAT, rows.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);

  gpu.impostor = avatar.impostor;
  const PackImage& albedo = pack.images[static_cast<size_t>(avatar.impostor.albedo_image)];
  gpu.albedo = UploadTexture(albedo, true, false, kImpostorMostLevel);
  gpu.normals = UploadTexture(pack.images[static_cast<size_t>(avatar.impostor.normal_image)], false, false, kImpostorMostLevel);
  const float width = static_cast<float>(albedo.width_px), height = static_cast<float>(albedo.height_px);
  gpu.cell = {static_cast<float>(avatar.impostor.cell_width_px) / width,
              static_cast<float>(avatar.impostor.cell_height_px) / height, 0.5f / width, 0.5f / height};
  avatars.push_back(std::move(gpu));
}

// A mesh faces glTF's +Z; turned about the vertical by heading + 90 degrees it faces the heading.
Instance Renderer::Impl::MeshInstance(const DrawnPerson& person, const GpuAvatar& avatar) const {
  const Vec3 p = GltfFromGround(person.position);
  Instance out{{p.x, p.y, p.z, person.heading_rad + kPi / 2}, {}, {}, 0, {}};
  const GpuClip& clip = avatar.clips[static_cast<size_t>(person.clip)];
  const float at = person.phase * static_cast<float>(clip.rows);
  const int a = std::min(static_cast<int>(at), clip.rows - 1);
  out.rows[0] = static_cast<float>(clip.first_row + a);
  out.rows[1] = static_cast<float>(clip.first_row + (a + 1) % clip.rows);
  out.rows[2] = at - static_cast<float>(a);
  return out;
}

Instance Renderer::Impl::ImpostorInstance(const DrawnPerson& person, const GpuAvatar& avatar, Vec3 eye) const {
  const PackImpostor& atlas = avatar.impostor;
  Instance out = MeshInstance(person, avatar);
  const Vec3 from = GroundFromGltf(eye) - person.position;
  const float distance = std::max(std::sqrt(from.x * from.x + from.y * from.y), 1e-3f);
  const float turn = (std::atan2(from.y, from.x) - person.heading_rad) / (2 * kPi);
  const float direction = (turn - std::floor(turn)) * static_cast<float>(atlas.directions);
  const int d0 = static_cast<int>(direction) % atlas.directions;
  out.cells[0] = static_cast<float>(d0);
  out.cells[1] = static_cast<float>((d0 + 1) % atlas.directions);
  out.cells[2] = direction - std::floor(direction);

  static constexpr const char* kNames[] = {"walk", "idle", "talk"};
  const PackImpostorClip* clip = &atlas.clips.front();
  for (const PackImpostorClip& c : atlas.clips) {
    if (c.name == kNames[static_cast<size_t>(person.clip)]) clip = &c;
  }
  const int phase = static_cast<int>(person.phase * static_cast<float>(clip->phases) + 0.5f) % clip->phases;
  const float pitch_deg = std::atan2(from.z, distance) * 180 / kPi;
  size_t elevation = 0;
  for (size_t e = 1; e < atlas.elevations_deg.size(); ++e) {
    if (std::abs(atlas.elevations_deg[e] - pitch_deg) < std::abs(atlas.elevations_deg[elevation] - pitch_deg)) elevation = e;
  }
  out.row = static_cast<float>(static_cast<size_t>(clip->first_frame + phase) * atlas.elevations_deg.size() + elevation);
  // Right of the view from the eye: ahead turned clockwise; on the ground (x, y), then glTF's (x, z).
  const Vec2 ahead{-from.x / distance, -from.y / distance};
  out.right[0] = ahead.y;
  out.right[1] = ahead.x;
  return out;
}

void Renderer::Impl::FillBatches(const FrameInput& frame, Vec3 eye) {
  for (Batch& batch : batches) batch.instances.clear();
  for (const DrawnPerson& person : frame.people) {
    const GpuAvatar& avatar = avatars[static_cast<size_t>(person.avatar)];
    const int level = std::min(person.level, static_cast<int>(avatar.level_meshes.size()) - 1);
    auto batch = std::find_if(batches.begin(), batches.end(), [&](const Batch& b) {
      return b.avatar == person.avatar && b.level == level;
    });
    if (batch == batches.end()) batch = batches.insert(batches.end(), Batch{person.avatar, level, {}});
    batch->instances.push_back(level >= 0 ? MeshInstance(person, avatar) : ImpostorInstance(person, avatar, eye));
  }
}

void Renderer::Impl::BindLight(GLuint program, Vec3 eye, Vec3 to_sun, const Light& light) const {
  glUseProgram(program);
  SetUniform(program, "u_eye", eye);
  SetUniform(program, "u_to_sun", to_sun);
  SetUniform(program, "u_sun_color", light.sun);
  SetUniform(program, "u_sky_color", light.sky);
  SetUniform(program, "u_ground_color", light.ground);
  SetUniform(program, "u_haze_color", light.haze);
  SetUniform(program, "u_town_shadow", town_shadow_matrix);
  SetUniform(program, "u_people_shadow", people_shadow_matrix);
  SetUniform(program, "u_town_shadow_map", 4);
  SetUniform(program, "u_people_shadow_map", 5);
  glActiveTexture(GL_TEXTURE4);
  glBindTexture(GL_TEXTURE_2D, town_shadow.texture);
  glActiveTexture(GL_TEXTURE5);
  glBindTexture(GL_TEXTURE_2D, people_shadow.texture);
  glActiveTexture(GL_TEXTURE0);
}

namespace {

// Outside where the sphere lies wholly beyond one of the clip planes.
bool SphereInView(const Mat4& vp, Vec3 c, float radius) {
  const auto row = [&](size_t r) { return Vec4{vp.m[0][r], vp.m[1][r], vp.m[2][r], vp.m[3][r]}; };
  const Vec4 w = row(3);
  for (size_t r = 0; r < 3; ++r) {
    const Vec4 v = row(r);
    for (float sign : {1.0f, -1.0f}) {
      const Vec4 plane{w.x + sign * v.x, w.y + sign * v.y, w.z + sign * v.z, w.w + sign * v.w};
      const float length = Length(Vec3{plane.x, plane.y, plane.z});
      if (plane.x * c.x + plane.y * c.y + plane.z * c.z + plane.w < -radius * length) return false;
    }
  }
  return true;
}

float LargestScale(const Mat4& m) {
  float most = 0;
  for (size_t c = 0; c < 3; ++c) most = std::max(most, Length(Vec3{m.m[c][0], m.m[c][1], m.m[c][2]}));
  return most;
}

void BindSurface(GLuint program, const GpuPrimitive& p, bool shaded) {
  glBindVertexArray(p.vertex_array);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, p.texture);
  if (shaded) SetUniform(program, "u_base_color", p.base_color);
  SetUniform(program, "u_alpha_cutoff", p.alpha_cutoff);
  if (p.double_sided) glDisable(GL_CULL_FACE);
  else glEnable(GL_CULL_FACE);
}

}  // namespace

void Renderer::Impl::DrawTown(GLuint program, const Mat4& view_projection, bool shaded, int64_t* triangles) {
  glUseProgram(program);
  SetUniform(program, "u_view_projection", view_projection);
  SetUniform(program, "u_texture", 0);
  for (const TownInstance& instance : town) {
    const GpuMesh& mesh = meshes[static_cast<size_t>(instance.mesh)];
    const Vec3 center = TransformPoint(instance.world, mesh.center);
    if (!SphereInView(view_projection, center, mesh.radius_m * LargestScale(instance.world))) continue;
    SetUniform(program, "u_world", instance.world);
    const Mat4& m = instance.world;
    const bool mirrored = Dot(Cross(Vec3{m.m[0][0], m.m[0][1], m.m[0][2]}, Vec3{m.m[1][0], m.m[1][1], m.m[1][2]}),
                              Vec3{m.m[2][0], m.m[2][1], m.m[2][2]}) < 0;
    glFrontFace(mirrored ? GL_CW : GL_CCW);
    for (const GpuPrimitive& p : mesh.primitives) {
      BindSurface(program, p, shaded);
      glDrawElements(GL_TRIANGLES, p.indices, GL_UNSIGNED_INT, nullptr);
    }
    if (triangles != nullptr) *triangles += mesh.triangles;
  }
  glFrontFace(GL_CCW);
}

void Renderer::Impl::DrawPeople(bool shadow, const Mat4& view_projection, Vec3 eye, Vec3 to_sun, const Light& light,
                                int64_t* triangles) {
  for (const Batch& batch : batches) {
    if (batch.instances.empty()) continue;
    const GpuAvatar& avatar = avatars[static_cast<size_t>(batch.avatar)];
    const bool impostor = batch.level < 0;
    const GLuint program = impostor ? (shadow ? impostor_shadow_program : impostor_program)
                                    : (shadow ? person_shadow_program : person_program);
    if (shadow) glUseProgram(program);
    else BindLight(program, eye, to_sun, light);
    SetUniform(program, "u_view_projection", view_projection);
    SetUniform(program, "u_texture", 0);
    const auto count = static_cast<GLsizei>(batch.instances.size());
    glBindBuffer(GL_ARRAY_BUFFER, instance_buffer);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(batch.instances.size() * sizeof(Instance)), batch.instances.data(),
                 GL_STREAM_DRAW);
    if (impostor) {
      SetUniform(program, "u_window", Vec3{avatar.impostor.window_width_m, avatar.impostor.window_height_m, avatar.impostor.bottom_m});
      SetUniform(program, "u_cell", avatar.cell);
      SetUniform(program, "u_normals", 1);
      glActiveTexture(GL_TEXTURE1);
      glBindTexture(GL_TEXTURE_2D, avatar.normals);
      glActiveTexture(GL_TEXTURE0);
      glBindTexture(GL_TEXTURE_2D, avatar.albedo);
      glBindVertexArray(quad_array);
      BindInstanceAttributes(instance_buffer);
      EnableAttribute(7, 3, GL_FLOAT, false, sizeof(Instance), offsetof(Instance, cells), 1);
      EnableAttribute(8, 1, GL_FLOAT, false, sizeof(Instance), offsetof(Instance, row), 1);
      EnableAttribute(9, 2, GL_FLOAT, false, sizeof(Instance), offsetof(Instance, right), 1);
      glDisable(GL_CULL_FACE);
      glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, count);
      if (triangles != nullptr) *triangles += 2 * count;
      continue;
    }
    SetUniform(program, "u_joint_texture", 1);
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_2D, avatar.joint_texture);
    const GpuMesh& mesh = meshes[static_cast<size_t>(avatar.level_meshes[static_cast<size_t>(batch.level)])];
    for (const GpuPrimitive& p : mesh.primitives) {
      BindSurface(program, p, !shadow);
      BindInstanceAttributes(instance_buffer);
      EnableAttribute(7, 3, GL_FLOAT, false, sizeof(Instance), offsetof(Instance, rows), 1);
      glDrawElementsInstanced(GL_TRIANGLES, p.indices, GL_UNSIGNED_INT, nullptr, count);
    }
    if (triangles != nullptr) *triangles += mesh.triangles * count;
  }
}

void Renderer::Impl::DrawShadows(const FrameInput& frame, Vec3 eye, Vec3 to_sun, const Light& light) {
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(2, 4);
  if (Length(eye - shadow_center) > kShadowStep_m || Length(to_sun - shadow_sun) > kSunStep) {
    shadow_center = eye;
    shadow_sun = to_sun;
    town_shadow_matrix = ShadowMatrix(eye, to_sun, kTownShadow_m, kTownShadow_px);
    glBindFramebuffer(GL_FRAMEBUFFER, town_shadow.framebuffer);
    glViewport(0, 0, kTownShadow_px, kTownShadow_px);
    glClear(GL_DEPTH_BUFFER_BIT);
    DrawTown(town_shadow_program, town_shadow_matrix, false, nullptr);
  }
  // Seen by the sun, an impostor is the picture from the sun's side.
  FillBatches(frame, eye + to_sun * 500);
  people_shadow_matrix = ShadowMatrix(eye, shadow_sun, kPeopleShadow_m, kPeopleShadow_px);
  glBindFramebuffer(GL_FRAMEBUFFER, people_shadow.framebuffer);
  glViewport(0, 0, kPeopleShadow_px, kPeopleShadow_px);
  glClear(GL_DEPTH_BUFFER_BIT);
  DrawPeople(true, people_shadow_matrix, eye, to_sun, light, nullptr);
  glDisable(GL_POLYGON_OFFSET_FILL);
}

Renderer::Renderer() : impl_(std::make_unique<Impl>()) {}
Renderer::~Renderer() = default;  // the context goes with everything in it

Error Renderer::Create(const TourPack& pack) {
  GLint most_px = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most_px);
  for (size_t i = 0; i < pack.images.size(); ++i) {
    if (pack.images[i].width_px > most_px || pack.images[i].height_px > most_px) {
      return Fail("image " + std::to_string(i) + " is larger than this machine's OpenGL can hold (" + std::to_string(most_px) + " px)");
    }
  }
  if (Error e = impl_->BuildPrograms()) return e;
  impl_->UploadMeshes(pack);
  impl_->town = pack.town;
  for (const PackAvatar& avatar : pack.avatars) impl_->UploadAvatar(pack, avatar);
  impl_->town_shadow = CreateShadowMap(kTownShadow_px);
  impl_->people_shadow = CreateShadowMap(kPeopleShadow_px);
  glGenBuffers(1, &impl_->instance_buffer);
  glGenVertexArrays(1, &impl_->empty_array);
  glGenVertexArrays(1, &impl_->quad_array);
  glBindVertexArray(impl_->quad_array);
  GLuint quad = 0;
  glGenBuffers(1, &quad);
  glBindBuffer(GL_ARRAY_BUFFER, quad);
  const float corners[] = {-1, 0, 1, 0, -1, 1, 1, 1};
  glBufferData(GL_ARRAY_BUFFER, sizeof corners, corners, GL_STATIC_DRAW);
  EnableAttribute(0, 2, GL_FLOAT, false, 8, 0, 0);
  return Ok();
}

void Renderer::Draw(const FrameInput& frame, int width_px, int height_px, FrameStatistics* statistics) {
  const auto start = std::chrono::steady_clock::now();
  *statistics = {};
  Impl& r = *impl_;
  const Vec3 eye = GltfFromGround(frame.eye), to_sun = Normalized(GltfFromGround(frame.to_sun));
  const Light light = LightFor(to_sun);
  r.DrawShadows(frame, eye, to_sun, light);

  const float cp = std::cos(frame.pitch_rad);
  const Vec3 ahead = GltfFromGround({std::cos(frame.yaw_rad) * cp, std::sin(frame.yaw_rad) * cp, std::sin(frame.pitch_rad)});
  const float aspect = static_cast<float>(width_px) / static_cast<float>(height_px);
  const Mat4 view_projection = Perspective(frame.fov_rad, aspect) * LookMatrix(eye, ahead, {0, 1, 0});
  ResizePicture(width_px, height_px, &r.picture);
  glBindFramebuffer(GL_FRAMEBUFFER, r.picture.framebuffer);
  glViewport(0, 0, width_px, height_px);
  glClear(GL_DEPTH_BUFFER_BIT | GL_COLOR_BUFFER_BIT);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);

  r.BindLight(r.town_program, eye, to_sun, light);
  r.DrawTown(r.town_program, view_projection, true, &statistics->town_triangles);
  r.FillBatches(frame, eye);
  r.DrawPeople(false, view_projection, eye, to_sun, light, &statistics->people_triangles);

  glUseProgram(r.sky_program);
  SetUniform(r.sky_program, "u_inverse_view_projection", Inverse(view_projection));
  SetUniform(r.sky_program, "u_to_sun", to_sun);
  SetUniform(r.sky_program, "u_sun_color", light.sun);
  SetUniform(r.sky_program, "u_zenith_color", light.zenith);
  SetUniform(r.sky_program, "u_haze_color", light.haze);
  glDisable(GL_CULL_FACE);
  glBindVertexArray(r.empty_array);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  ResolvePicture(r.picture);
  glFinish();  // so that draw_ms means the picture, not the handing over of commands
  const auto end = std::chrono::steady_clock::now();
  statistics->draw_ms = std::chrono::duration<double, std::milli>(end - start).count();
}

void Renderer::Read(std::vector<uint8_t>* rgb) {
  const Picture& p = impl_->picture;
  std::vector<uint8_t> rgba(static_cast<size_t>(p.width_px) * static_cast<size_t>(p.height_px) * 4);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, p.resolved);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, p.width_px, p.height_px, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  rgb->resize(rgba.size() / 4 * 3);
  const size_t width = static_cast<size_t>(p.width_px), height = static_cast<size_t>(p.height_px);
  for (size_t y = 0; y < height; ++y) {
    for (size_t x = 0; x < width; ++x) {
      std::memcpy(&(*rgb)[(y * width + x) * 3], &rgba[((height - 1 - y) * width + x) * 4], 3);
    }
  }
}

void Renderer::Present() {
  const Picture& p = impl_->picture;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, p.resolved);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glBlitFramebuffer(0, 0, p.width_px, p.height_px, 0, 0, p.width_px, p.height_px, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

}  // namespace flaneur
