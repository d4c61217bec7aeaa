// Draws one person of a pack alone before the sky, as the player does.
#pragma once
#include <memory>

#include "runtime/base/error.h"
#include "runtime/likeness/compare.h"
#include "runtime/pack/tour_pack.h"
#include "runtime/render/frame.h"

namespace flaneur {

struct PortraitMoment {
  int avatar = 0;
  float heading_rad = 0;  // 0: the person looks away from the visitor
  ClipMoment moment;
  Vec3 to_sun{0, 0, 1};  // ground axes; the visitor looks along +x
};

// Needs a current OpenGL context for its whole life.
class PortraitStudio {
 public:
  PortraitStudio();
  ~PortraitStudio();
  // The town is left out. Each pixel is the mean of supersampling x supersampling of the player's: with 1 both pictures
  // have the player's own noise. Errors: as for Renderer::Create.
  Error Create(TourPack pack, int supersampling = 1, Jobs* jobs = nullptr);

  // From the distance at which the person is `person_px` pixels high in the player's picture of 1280 pixels' width.
  void Draw(const PortraitMoment& moment, Level level, float person_px, Portrait* portrait);
  // Only what depends on the light anew; portrait must be of the same moment, level and size.
  void Relight(const PortraitMoment& moment, Level level, float person_px, Portrait* portrait);

  const TourPack& pack() const;
  // The person's height on screen at the impostor's switch: one pixel a texel.
  float ImpostorSwitch_px(int avatar) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace flaneur
