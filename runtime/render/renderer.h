// Draws a tour pack with OpenGL ES 3.0: town, people as skinned meshes near and relit impostors far, sun with shadows.
#pragma once
#include <memory>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/base/jobs.h"
#include "runtime/pack/tour_pack.h"
#include "runtime/render/assets.h"
#include "runtime/render/frame.h"
#include "runtime/text/fonts.h"

namespace flaneur {

struct EyePicture;
struct SurfacePlan;
struct AtlasFormats;

struct RenderOptions {
  int samples = 0;       // of each pixel; 0: four with a GPU, one and a smoothing pass without
  bool cull = true;      // leave out blocks of the town that the picture cannot show; false only to prove that
  bool normals = false;  // people's normals * 0.5 + 0.5 instead of light, over nothing
  bool onto_window =
      false;  // where a pass finishes the picture it does so on the window's surface, and Read does not bring it out
  // Draw hands over its commands and returns, and at most one picture is on its way; FrameStatistics::draw_ms goes by
  // the picture before.
  bool runs_ahead = false;
  bool time_passes = false;  // FrameStatistics::pass_ms; waits for each pass, so that the whole takes longer
  Fonts* fonts = nullptr;    // of captions; outlives the renderer. Null: the built-in one
  Jobs* jobs = nullptr;      // make the pack ready with the caller in Create
  // In software the samples come from as many pictures, each a part of a pixel aside: a fourth of the time. Then no
  // alpha comes of ReadWithAlpha; nothing changes where there is a GPU, or with `normals`.
  bool averages = false;
};

// Needs a current context for its whole life.
class Renderer {
 public:
  Renderer();
  ~Renderer();
  // Uploads the pack, which is not needed afterwards. Errors: a shader that the driver refuses, a machine that cannot
  // hold an avatar.
  Error Create(const TourPack& pack, const RenderOptions& options = {});
  // Begins to compile what a renderer with these options needs. Before Begin, and long before where there is time: it
  // then waits less.
  void Expect(const RenderOptions& options = {});
  // The same in pieces, in any order: `pack` without its bulk first, then one asset after the other. What has not come
  // yet is drawn by the nearest level that has, or not at all.
  Error Begin(const TourPack& pack, const RenderOptions& options = {});
  // About so many bytes more of an asset; true: all of it is there, and drawn from now on. One asset at a time.
  bool Add(size_t most_bytes, Asset* asset);
  // For PrepareAsset, from any thread, after Begin.
  const SurfacePlan& surfaces() const;
  const AtlasFormats& formats() const;
  // What this picture needs beyond the town, whether it is there or not; the town must be there.
  std::vector<AssetId> AssetsFor(const FrameInput& frame, int width_px, int height_px);
  // The next picture is drawn as if it were the first, whatever has changed since the last one.
  void StartAnew();
  // Draws into a picture of its own; Read or Present brings it out.
  void Draw(const FrameInput& frame, int width_px, int height_px, FrameStatistics* statistics);
  // What a headset's eyes see, onto its framebuffer, instead of what eye, yaw, pitch and field of view of the frame
  // say. At least one eye, all of the same size; what is drawn is chosen once for all of them, and shadows are drawn
  // once.
  void DrawEyes(const FrameInput& frame, const std::vector<EyePicture>& eyes, unsigned framebuffer,
                FrameStatistics* statistics);
  // Whether the last picture of who runs ahead is still on its way. What is drawn or uploaded meanwhile can take long:
  // software has all of the processor then, and browsers wait until there is room.
  bool IsDrawing() const;
  bool software() const;
  // Whether walls of the last picture hide a point, in the ground's axes; false where that is not known.
  bool Hides(Vec3 point) const;
  // The last picture: RGB, 8 bits a channel, top row first.
  void Read(std::vector<uint8_t>* rgb);
  // The same as RGBA; alpha is 0 where nothing is drawn.
  void ReadWithAlpha(std::vector<uint8_t>* rgba);
  void Present();  // onto the window's surface, where it is not there already

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace flaneur
