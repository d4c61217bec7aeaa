#include "runtime/render/renderer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>
#include <limits>

#include "runtime/base/clock.h"
#include "runtime/render/asset_content.h"
#include "runtime/render/caption.h"
#include "runtime/render/contact_shade.h"
#include "runtime/render/eyes.h"
#include "runtime/render/ground_mark.h"
#include "runtime/render/light.h"
#include "runtime/render/people_view.h"
#include "runtime/render/picture.h"
#include "runtime/render/picture_clock.h"
#include "runtime/render/shadow_maps.h"
#include "runtime/render/smoke_view.h"
#include "runtime/render/town_view.h"

namespace flaneur {
namespace {

constexpr float kNear_m = 0.1f, kFar_m = 900;
// Of the town's shadows that a picture usually renews: with less, one map waits for the other while the visitor runs
// out of it.
constexpr float kMinShadowShare = 0.5f;

// In software larger pictures cost memory and time that nobody sees at the sizes drawn there, and texels eight times a
// block's memory.
PictureLimits LimitsOfThisMachine(bool fast) {
  GLint most_px = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most_px);
  PictureLimits limits;
  if (fast) limits = {1024, 512, ReadsBc1()};
  return {std::min<int>(limits.town_px, most_px), std::min<int>(limits.people_px, most_px), limits.blocks};
}

ShaderMode ModeFor(bool software, bool several_samples, bool averages, bool normals) {
  if (!software)
    return normals ? ShaderMode::kGpuNormals : several_samples ? ShaderMode::kGpuSamples : ShaderMode::kGpu;
  if (averages) return ShaderMode::kSoftwareAverage;
  if (several_samples) return normals ? ShaderMode::kSoftwareSamplesNormals : ShaderMode::kSoftwareSamples;
  return normals ? ShaderMode::kSoftwareNormals : ShaderMode::kSoftware;
}

// How this machine draws what is asked for.
struct DrawingWay {
  ShaderMode mode;
  int samples;  // that are drawn at once, of `wished`
  int wished;
  bool averages, fast, deferred;  // fast: for a picture many times a second; stills may take their time
};

DrawingWay WayOf(const RenderOptions& options) {
  const bool software = DrawsInSoftware();
  // In software four samples cost a dozen times the whole rest of a frame.
  const int wished = options.samples > 0 ? options.samples : software ? 1 : 4;
  const bool averages = software && options.averages && wished > 1 && !options.normals;
  const int samples = averages ? 1 : wished;
  const ShaderMode mode = ModeFor(software, samples > 1, averages, options.normals);
  return {mode, samples, wished, averages, software && wished == 1, mode == ShaderMode::kSoftware || averages};
}

// By the processor's time of all threads: software draws on several, and others use the machine too.
class PassTimer {
 public:
  PassTimer(bool on, std::array<double, std::size(kDrawPassNames)>* pass_ms)
      : pass_ms_(on ? pass_ms : nullptr), last_ms_(Processor_ms()) {}
  void Passed(DrawPass pass) {
    if (pass_ms_ == nullptr) return;
    glFinish();
    const double now_ms = Processor_ms();
    (*pass_ms_)[static_cast<size_t>(pass)] = now_ms - last_ms_;
    last_ms_ = now_ms;
  }

 private:
  static double Processor_ms() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }
  std::array<double, std::size(kDrawPassNames)>* pass_ms_;
  double last_ms_;
};

Vec3 Ahead(const FrameInput& frame) {
  const float cp = std::cos(frame.pitch_rad);
  return GltfFromGround({std::cos(frame.yaw_rad) * cp, std::sin(frame.yaw_rad) * cp, std::sin(frame.pitch_rad)});
}

Vec4 Wide(Vec3 v) { return {v.x, v.y, v.z, 0}; }

Mat4 ViewProjection(const FrameInput& frame, int width_px, int height_px) {
  const float aspect = static_cast<float>(width_px) / static_cast<float>(height_px);
  return Perspective(frame.fov_rad, aspect, kNear_m, kFar_m) *
         LookMatrix(GltfFromGround(frame.eye), Ahead(frame), {0, 1, 0});
}

// Moves the k-th of a picture's averages by its part of a pixel, so that no two of them share a row or a column.
Mat4 Aside(int k, const Picture& p) {
  Mat4 aside;
  if (p.averages == 1) return aside;
  float row = 0, part = 0.5f;
  for (int bits = k; bits > 0; bits >>= 1, part /= 2) row += part * static_cast<float>(bits & 1);
  const float count = static_cast<float>(p.averages), half = 0.5f / count - 0.5f;
  aside.m[3][0] = 2 * (static_cast<float>(k) / count + half) / static_cast<float>(p.drawn_width_px);
  aside.m[3][1] = 2 * (row + half) / static_cast<float>(p.drawn_height_px);
  return aside;
}

// focal_px: pixels that a metre takes at a distance of one.
FrameBlock MakeFrameBlock(const Mat4& view_projection, Vec3 eye, float focal_px, Vec3 to_sun, float exposure,
                          float shadow_reach_m, const ShadowMaps& shadows) {
  const Light light = LightFor(to_sun);
  FrameBlock block;
  block.view_projection = view_projection;
  block.inverse_view_projection = Inverse(view_projection);
  block.near_shadow = shadows.near.matrix;
  block.middle_shadow = shadows.middle.matrix;
  block.far_shadow = shadows.far.matrix;
  block.fine_shadow = shadows.people_matrices[0];
  block.people_shadow = shadows.people_matrices[1];
  block.town_shadow_layers = {static_cast<float>(shadows.near.layer), static_cast<float>(shadows.middle.layer),
                              static_cast<float>(shadows.far.layer), 0};
  block.town_shadow_texels = {Texel_m(shadows.near), Texel_m(shadows.middle), Texel_m(shadows.far), 0};
  block.people_shadows = {kPeopleTexels_m[0], kPeopleTexels_m[1], shadow_reach_m, 0};
  block.eye = {eye.x, eye.y, eye.z, focal_px};
  block.to_sun = Wide(to_sun);
  block.sun_color = Wide(light.sun * exposure);  // the sky is as it is: no town makes that too bright
  block.sky_color = Wide(light.sky * exposure);
  block.ground_color = Wide(light.ground * exposure);
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
  GroundMarkView ground_mark;
  ContactShadeView contact_shade;
  SmokeView smoke;
  SurfacePlan plan;
  size_t pictures_left = 0;  // to come
  UploadPlace picture_upload;
  AtlasFormats formats;
  std::vector<GLuint> arrays;
  PictureClock clock;
  bool waits = true;  // for every picture
  bool software = false;
  bool drew_eyes = false;  // the last picture was a headset's, where it is already
  Program sky_program;
  GLuint empty_array = 0, block_buffer = 0;

  // From where the picture is chosen, of both eyes together.
  static EyesTogether Chosen(const FrameInput& frame, const std::vector<EyePicture>& eyes, int width_px,
                             int height_px) {
    if (!eyes.empty()) return Together(eyes, kNear_m, kFar_m);
    return {ViewProjection(frame, width_px, height_px), GltfFromGround(frame.eye), Ahead(frame),
            static_cast<float>(width_px) / 2 / std::tan(frame.fov_rad / 2)};
  }
  // About so many bytes more of a picture of surfaces; true: all of it is there.
  bool UploadPicture(size_t most_bytes, int which, const std::vector<std::vector<uint8_t>>& levels) {
    const PicturePlace& place = plan.pictures[static_cast<size_t>(which)];
    if (place.array < 0) return true;
    const auto array = static_cast<size_t>(place.array);
    return UploadLayer(most_bytes, arrays[array], plan.arrays[array], place.layer, levels, &picture_upload);
  }
  float Focal_px(const EyesTogether& view) const {
    return view.focal_px * static_cast<float>(picture.drawn_width_px) / static_cast<float>(picture.width_px);
  }

  PeopleSight Sight(const FrameInput& frame, const EyesTogether& view) const {
    const Vec3 eye = view.eye, to_sun = Normalized(GltfFromGround(frame.to_sun));
    return {eye,
            to_sun,
            FrustumOf(view.view_projection),
            options.cull ? &town.walls : nullptr,
            std::min(2 * kPeopleShadow_m, frame.shadow_reach_m) * frame.detail,
            frame.resolution_scale * frame.detail < 1 && !frame.keeps_levels ? Focal_px(view) * frame.detail : 0,
            frame.fine_shadow_m * (1 + frame.resolution_scale) / 2 * frame.detail,
            FrustumOf(PeopleShadowMatrices(eye, view.ahead, to_sun)[0]),
            frame.contact_shade};
  }

  // The costs are those of one picture, however many are averaged. picks: the town's triangles that this very view
  // shows, not those for both eyes.
  void DrawSurfaces(Vec3 eye, bool picks, PassTimer* timer, DrawCost* meshes_and_impostors, DrawCost* of_town) {
    BeginPicture(picture);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    // Whatever is drawn hides what comes after it at no cost: the costliest comes last, the nearest first.
    *meshes_and_impostors = DrawPeople(people, false);
    timer->Passed(DrawPass::kMeshes);
    if (picture.deferred) glFlush();  // software fills these pixels while it goes through the town's triangles
    *of_town = DrawTown(eye, picture.drawn_width_px, picture.drawn_height_px, options.cull && picks, &town);
    timer->Passed(DrawPass::kTown);
    *meshes_and_impostors += DrawPeople(people, true);
    timer->Passed(DrawPass::kImpostors);
    LightPicture(picture);
    timer->Passed(DrawPass::kLight);
  }

  void Draw(const FrameInput& frame, const std::vector<EyePicture>& eyes, int width_px, int height_px,
            FrameStatistics* statistics);

  void DrawSky() const {
    glUseProgram(sky_program.id);
    CullBackFaces(false);
    glBindVertexArray(empty_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
};

Renderer::Renderer() : impl_(std::make_unique<Impl>()) {}
Renderer::~Renderer() = default;  // the context goes with everything in it

Error Renderer::Create(const TourPack& pack, const RenderOptions& options) {
  if (Error e = Begin(pack, options)) return e;
  const std::vector<AssetId> ids = AssetsOf(pack);
  std::vector<Asset> assets(ids.size());
  ParallelFor(options.jobs, ids.size(),
              [&](size_t i) { assets[i] = PrepareAsset(pack, ids[i], surfaces(), formats()); });
  for (Asset& asset : assets) {
    while (!Add(std::numeric_limits<size_t>::max(), &asset)) {}
    asset.content.reset();
  }
  return Ok();
}

void Renderer::Expect(const RenderOptions& options) {
  const DrawingWay way = WayOf(options);
  using enum ShaderProgram;
  for (const ShaderProgram program :
       {kTown, kPersonImpostor, kTownShadow, kPersonShadow, kSky, kTownMasked, kTownShadowMasked, kPerson,
        kPersonMasked, kPersonFades, kPersonMaskedFades, kSmooth, kSharpen})
    BeginProgram(program, way.mode);
  if (way.deferred) BeginProgram(kLight, way.mode);
  for (const ShaderProgram program : {kEnlarge, kCaption, kWallShade, kContactShade, kGroundMark, kSmoke})
    BeginProgram(program);
  glFlush();  // they may wait in a buffer otherwise
}

Error Renderer::Begin(const TourPack& pack, const RenderOptions& options) {
  Impl& r = *impl_;
  r.options = options;
  Expect(options);
  const auto [mode, samples, wished, averages, fast, deferred] = WayOf(options);
  r.software = DrawsInSoftware();
  r.formats = FormatsOfThisMachine(fast);
  r.people.smooth_edges = samples > 1 && !options.normals;
  r.pictures_left = pack.images.size();
  r.town.triangle_by_triangle = fast || averages;
  r.plan = PlanSurfaces(pack, LimitsOfThisMachine(fast));
  AwaitBegunPrograms();  // the arrays' memory takes a software driver longer
  r.arrays = CreateTextureArrays(r.plan, fast || averages);
  if (Error e = CreateTownView(mode, r.plan, r.arrays, &r.town)) return e;
  if (Error e = CreatePeopleView(pack, mode, r.plan, r.arrays, &r.people)) return e;
  if (Error e = BuildProgram(ShaderProgram::kSky, mode, &r.sky_program)) return e;
  if (Error e = CreatePicture({samples, averages ? wished : 1, deferred, options.onto_window}, mode, &r.picture))
    return e;
  if (Error e = CreateCaptionView(options.fonts, &r.caption)) return e;
  if (Error e = CreateGroundMark(&r.ground_mark)) return e;
  if (Error e = CreateContactShade(&r.contact_shade)) return e;
  if (Error e = CreateSmokeView(&r.smoke)) return e;
  CreateShadowMaps(&r.shadows);
  r.waits = !options.runs_ahead || !CreatePictureClock(&r.clock);
  glGenVertexArrays(1, &r.empty_array);
  glGenBuffers(1, &r.block_buffer);
  glReleaseShaderCompiler();  // some MB; it comes back by itself where it is needed again
  return Ok();
}

const SurfacePlan& Renderer::surfaces() const { return impl_->plan; }
const AtlasFormats& Renderer::formats() const { return impl_->formats; }

bool Renderer::Add(size_t most_bytes, Asset* asset) {
  Impl& r = *impl_;
  Asset::Content& content = *asset->content;
  switch (asset->id.kind) {
    case AssetKind::kTown:
      if (!UploadTown(most_bytes, content.town, &r.town)) return false;
      AddTown(std::move(content.town), &r.town);
      AddWallShade(content.wall_shade, &r.contact_shade);
      ForgetTownShadows(&r.shadows);
      break;
    case AssetKind::kPicture:
      if (!r.UploadPicture(most_bytes, asset->id.index, content.picture)) return false;
      r.picture_upload = {};
      if (--r.pictures_left == 0) ShowLevels(&r.people);
      break;
    case AssetKind::kLevel:
      AddLevel(asset->id.index, asset->id.level, content.person, content.shadows, &r.people);
      if (r.pictures_left == 0) ShowLevels(&r.people);  // never without their clothes
      break;
    case AssetKind::kAtlas:
      if (!UploadAtlas(most_bytes, content.atlas, &r.people.upload)) return false;
      AddAtlas(asset->id.index, &r.people);
      break;
  }
  return true;
}

void Renderer::StartAnew() { ForgetTownShadows(&impl_->shadows); }

std::vector<AssetId> Renderer::AssetsFor(const FrameInput& frame, int width_px, int height_px) {
  Impl& r = *impl_;
  const EyesTogether view = Impl::Chosen(frame, {}, width_px, height_px);
  FindVisibleBlocks(view.view_projection, view.eye, r.options.cull, &r.town);
  ResizePicture(width_px, height_px, frame.resolution_scale, &r.picture);
  return flaneur::AssetsFor(frame.people, r.Sight(frame, view), r.people);
}

void Renderer::Draw(const FrameInput& frame, int width_px, int height_px, FrameStatistics* statistics) {
  FinishBeside(false, &impl_->picture);
  impl_->picture.window = 0;
  impl_->Draw(frame, {}, width_px, height_px, statistics);
}

void Renderer::DrawEyes(const FrameInput& frame, const std::vector<EyePicture>& eyes, unsigned framebuffer,
                        FrameStatistics* statistics) {
  FinishBeside(true, &impl_->picture);
  impl_->picture.window = framebuffer;
  impl_->Draw(frame, eyes, eyes.front().width_px, eyes.front().height_px, statistics);
}

void Renderer::Impl::Draw(const FrameInput& frame, const std::vector<EyePicture>& eyes, int width_px, int height_px,
                          FrameStatistics* statistics) {
  const double start_ms = Now_ms();
  Impl& r = *this;
  const EyesTogether view = Chosen(frame, eyes, width_px, height_px);
  const Mat4& view_projection = view.view_projection;
  PassTimer timer(r.options.time_passes, &statistics->pass_ms);
  FindVisibleBlocks(view_projection, view.eye, r.options.cull, &r.town);
  PlaceTurningParts(view_projection, frame.turns_rad, r.options.cull, &r.town);
  if (!r.waits) BeginPictureTime(&r.clock);
  const double people_ms = Now_ms();
  ResizePicture(width_px, height_px, frame.resolution_scale, &r.picture);
  const PeopleSight sight = r.Sight(frame, view);
  const Vec3 eye = sight.eye, to_sun = sight.to_sun;
  SortPeople(frame.people, r.people.layouts, r.people.ready, sight, &r.people.batches);
  UploadPeople(&r.people);
  statistics->people_ms = Now_ms() - people_ms;
  timer.Passed(DrawPass::kCull);
  DrawCost shadow_cost = DrawPeopleShadows(eye, view.ahead, to_sun, r.block_buffer, r.people, &r.shadows);
  statistics->people_shadow_triangles = shadow_cost.triangles;
  timer.Passed(DrawPass::kPeopleShadow);
  shadow_cost +=
      UpdateTownShadows(eye, to_sun, std::max(kMinShadowShare, frame.resolution_scale * frame.resolution_scale),
                        r.block_buffer, r.town, &r.shadows);
  timer.Passed(DrawPass::kTownShadow);

  DrawCost people_cost, town_cost, mark;
  const auto draw_view = [&](const Mat4& matrix, Vec3 from, bool picks, int average) {
    BindFrameBlock(r.block_buffer, MakeFrameBlock(matrix, from, r.Focal_px(view), to_sun, frame.exposure,
                                                  std::max(sight.shadow_reach_m, 1e-3f), r.shadows));
    r.DrawSurfaces(from, picks, &timer, &people_cost, &town_cost);
    if (!r.options.normals) r.DrawSky();
    mark =
        r.options.normals ? DrawCost{} : DrawContactShade(matrix, from, frame.contact_shade, r.people, r.contact_shade);
    if (!r.options.normals) mark += DrawSmoke(frame.smoke, r.smoke);
    mark += DrawGroundMark(frame.ground_mark, r.ground_mark);
    timer.Passed(DrawPass::kSky);
    FinishPicture(average, r.picture);
  };
  r.picture.left_px = r.picture.bottom_px = 0;
  r.drew_eyes = !eyes.empty();
  for (int k = 0; k < r.picture.averages && !r.drew_eyes; ++k) {
    const Mat4 aside = Aside(k, r.picture) * view_projection;
    if (r.picture.averages > 1) FindVisibleBlocks(aside, eye, r.options.cull, &r.town);
    draw_view(aside, eye, true, k);
  }
  for (const EyePicture& e : eyes) {
    r.picture.left_px = e.left_px;
    r.picture.bottom_px = e.bottom_px;
    draw_view(e.view_projection, e.eye, false, 0);
    PresentPicture(r.picture);
  }
  DrawCaption(frame, width_px, height_px, &r.caption);
  timer.Passed(DrawPass::kFinish);
  if (r.waits) glFinish();  // so that draw_ms means the picture, not the handing over of commands
  else EndPictureTime(&r.clock);
  constexpr int kWholePictures = 4;  // light, sky, smoothing, caption
  statistics->town_triangles = town_cost.triangles;
  statistics->people_triangles = people_cost.triangles;
  statistics->shadow_triangles = shadow_cost.triangles;
  statistics->draw_calls = people_cost.calls + town_cost.calls + shadow_cost.calls + mark.calls + kWholePictures;
  statistics->resolution_scale = frame.resolution_scale;
  statistics->people_hidden = r.people.batches.hidden;
  statistics->people_not_loaded = r.people.batches.not_loaded;
  statistics->people_drawn = static_cast<int>(frame.people.size()) - statistics->people_hidden;
  statistics->draw_ms = std::max(Now_ms() - start_ms, r.clock.took_ms);
}

bool Renderer::IsDrawing() const { return IsOnItsWay(impl_->clock); }

bool Renderer::software() const { return impl_->software; }

bool Renderer::Hides(Vec3 point) const {
  constexpr float kHalf_m = 0.1f;
  const Vec3 p = GltfFromGround(point), half{kHalf_m, kHalf_m, kHalf_m};
  const OcclusionMap& walls = impl_->town.walls;
  return !walls.nearness.empty() && !MayBeSeen(walls, {p - half, p + half}, true);
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
  if (!impl_->drew_eyes) PresentPicture(impl_->picture);
}

}  // namespace flaneur
