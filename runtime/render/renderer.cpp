#include "runtime/render/renderer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

#include "runtime/render/caption.h"
#include "runtime/render/light.h"
#include "runtime/render/people_view.h"
#include "runtime/render/picture.h"
#include "runtime/render/shaders.h"
#include "runtime/render/shadow_maps.h"
#include "runtime/render/town_view.h"

namespace flaneur {
namespace {

constexpr float kNear_m = 0.1f, kFar_m = 900;

Error CheckImages(const TourPack& pack) {
  GLint most_px = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most_px);
  for (size_t i = 0; i < pack.images.size(); ++i) {
    if (pack.images[i].width_px > most_px || pack.images[i].height_px > most_px) {
      return Fail("image " + std::to_string(i) + " is larger than this machine's OpenGL can hold (" + std::to_string(most_px) + " px)");
    }
  }
  return Ok();
}

Vec4 Wide(Vec3 v) { return {v.x, v.y, v.z, 0}; }

FrameBlock MakeFrameBlock(const FrameInput& frame, float aspect, Vec3 eye, Vec3 to_sun, const ShadowMaps& shadows) {
  const float cp = std::cos(frame.pitch_rad);
  const Vec3 ahead = GltfFromGround({std::cos(frame.yaw_rad) * cp, std::sin(frame.yaw_rad) * cp, std::sin(frame.pitch_rad)});
  const Light light = LightFor(to_sun);
  FrameBlock block;
  block.view_projection = Perspective(frame.fov_rad, aspect, kNear_m, kFar_m) * LookMatrix(eye, ahead, {0, 1, 0});
  block.inverse_view_projection = Inverse(block.view_projection);
  block.town_shadow = shadows.town_matrix;
  block.people_shadow = shadows.people_matrix;
  block.eye = Wide(eye);
  block.to_sun = Wide(to_sun);
  block.sun_color = Wide(light.sun);
  block.sky_color = Wide(light.sky);
  block.ground_color = Wide(light.ground);
  block.haze_color = Wide(light.haze);
  block.zenith_color = Wide(light.zenith);
  return block;
}

}  // namespace

struct Renderer::Impl {
  RenderOptions options;
  TownView town;
  PeopleView people;
  ShadowMaps shadows;
  Picture picture;
  CaptionView caption;
  GLuint sky_program = 0, empty_array = 0, block_buffer = 0;

  void DrawSky() const {
    glUseProgram(sky_program);
    CullBackFaces(false);
    glBindVertexArray(empty_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
};

Renderer::Renderer() : impl_(std::make_unique<Impl>()) {}
Renderer::~Renderer() = default;  // the context goes with everything in it

Error Renderer::Create(const TourPack& pack, const RenderOptions& options) {
  Impl& r = *impl_;
  r.options = options;
  if (Error e = CheckImages(pack)) return e;
  const bool software = DrawsInSoftware();
  // In software four samples cost three times the whole rest of a frame.
  const int samples = options.samples > 0 ? options.samples : software ? 1 : 4;
  std::string defines = std::string("#define SHADOW_TAPS ") + (software ? "1" : "4") + "\n#define SHARPER " +
                        (software && samples == 1 ? "-0.6" : "0.0") + "\n#define STEPS " + (software && samples == 1 ? "1" : "3") + "\n";
  if (options.normals) defines += "#define NORMALS\n";
  r.people.smooth_edges = samples > 1 && !options.normals;
  if (r.people.smooth_edges) defines += "#define SMOOTH_EDGES\n";
  const std::vector<GLuint> textures = UploadTextures(pack);
  const std::vector<Surface> surfaces = MakeSurfaces(pack, textures);
  if (Error e = CreateTownView(pack, defines, surfaces, &r.town)) return e;
  if (Error e = CreatePeopleView(pack, defines, surfaces, &r.people)) return e;
  if (Error e = BuildProgram(std::string(kFrame) + kSkyVertex, std::string(kFrame) + kSkyFragment, &r.sky_program)) return e;
  if (Error e = CreatePicture(samples, &r.picture)) return e;
  if (Error e = CreateCaptionView(&r.caption)) return e;
  CreateShadowMaps(&r.shadows);
  glGenVertexArrays(1, &r.empty_array);
  glGenBuffers(1, &r.block_buffer);
  return Ok();
}

void Renderer::Draw(const FrameInput& frame, int width_px, int height_px, FrameStatistics* statistics) {
  const auto start = std::chrono::steady_clock::now();
  Impl& r = *impl_;
  const Vec3 eye = GltfFromGround(frame.eye), to_sun = Normalized(GltfFromGround(frame.to_sun));
  SortPeople(frame.people, r.people.layouts, eye, to_sun, kPeopleShadow_m * 1.5f, &r.people.batches);
  UploadPeople(&r.people);
  UpdateShadowMaps(eye, to_sun, r.block_buffer, r.town, r.people, &r.shadows);

  ResizePicture(width_px, height_px, &r.picture);
  glBindFramebuffer(GL_FRAMEBUFFER, r.picture.framebuffer);
  glViewport(0, 0, width_px, height_px);
  glClear(GL_DEPTH_BUFFER_BIT | GL_COLOR_BUFFER_BIT);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  const float aspect = static_cast<float>(width_px) / static_cast<float>(height_px);
  const FrameBlock block = MakeFrameBlock(frame, aspect, eye, to_sun, r.shadows);
  BindFrameBlock(r.block_buffer, block);
  statistics->people_triangles = DrawPeople(r.people);  // first, for what they hide of the town costs nothing then
  statistics->town_triangles = DrawTown(block.view_projection, eye, r.options.cull, &r.town);
  if (!r.options.normals) r.DrawSky();
  FinishPicture(r.picture);
  DrawCaption(frame.caption, frame.caption_share, width_px, height_px, &r.caption);
  glFinish();  // so that draw_ms means the picture, not the handing over of commands
  const auto end = std::chrono::steady_clock::now();
  statistics->draw_ms = std::chrono::duration<double, std::milli>(end - start).count();
}

void Renderer::ReadWithAlpha(std::vector<uint8_t>* rgba) {
  const Picture& p = impl_->picture;
  const size_t row = static_cast<size_t>(p.width_px) * 4, height = static_cast<size_t>(p.height_px);
  rgba->resize(row * height);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, p.finished);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, p.width_px, p.height_px, GL_RGBA, GL_UNSIGNED_BYTE, rgba->data());
  for (size_t y = 0; y < height / 2; ++y) {
    std::swap_ranges(&(*rgba)[y * row], &(*rgba)[y * row] + row, &(*rgba)[(height - 1 - y) * row]);
  }
}

void Renderer::Read(std::vector<uint8_t>* rgb) {
  std::vector<uint8_t> rgba;
  ReadWithAlpha(&rgba);
  rgb->resize(rgba.size() / 4 * 3);
  for (size_t i = 0; i < rgba.size() / 4; ++i) std::memcpy(&(*rgb)[i * 3], &rgba[i * 4], 3);
}

void Renderer::Present() {
  const Picture& p = impl_->picture;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, p.finished);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glBlitFramebuffer(0, 0, p.width_px, p.height_px, 0, 0, p.width_px, p.height_px, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

}  // namespace flaneur
