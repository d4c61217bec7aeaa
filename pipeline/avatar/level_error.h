// How far levels of detail lie from the original, in the bind pose and walking.
#pragma once
#include <memory>

#include "pipeline/core/avatar.h"
#include "runtime/base/jobs.h"

namespace flaneur {

struct MeasuredOriginal;

// Keeps what all levels of one original, which must outlive this, are measured against. Any number of levels may be
// measured at once.
class LevelMeter {
 public:
  // `samples` points and up to 6,000 vertices of each surface; `walk_poses` moments of the walk.
  LevelMeter(const Avatar& original, int samples, int walk_poses, Jobs* jobs = nullptr);
  ~LevelMeter();

  // Sets error_mm and posed_error_mm: the greatest of the distances of either surface's points from the other. The same
  // result on any number of threads.
  void MeasureDistance(AvatarLevel* level) const;

  // Sets normal_deg, at `samples` places of the level whose nearest place of the original faces the same way.
  void MeasureNormals(AvatarLevel* level) const;

 private:
  std::unique_ptr<MeasuredOriginal> original_;
};

}  // namespace flaneur
