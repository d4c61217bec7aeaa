// Draws a tour pack with OpenGL ES 3.0: town, people as skinned meshes or relit impostors, shadows, sky.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/pack/tour_pack.h"
#include "runtime/render/frame.h"

namespace flaneur {

struct RenderOptions {
  int samples = 4;               // multisampling; fewer where the driver has fewer
  int shadow_map_px = 2048;
};

// Owns all OpenGL objects. A context (runtime/render/context.h) must be current from Create() until the destructor is done.
class Renderer {
 public:
  Renderer();
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // Uploads the pack, which isn't needed afterwards.
  // Errors: a shader that the driver rejects, an image or skeleton larger than the driver's limits, out of memory.
  Error Create(const TourPack& pack, const RenderOptions& options = {});

  // Draws into the current framebuffer's own (window) surface and keeps the picture for ReadPixels.
  // people[i].avatar and .level must be valid for the pack. width and height in pixels, positive.
  FrameStatistics Draw(const FrameInput& frame, int width_px, int height_px);

  // The last picture, RGB, top row first: 3 * width * height bytes.
  std::vector<uint8_t> ReadPixels() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace flaneur
