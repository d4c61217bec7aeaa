#include "pipeline/cli/draft.h"

#include <algorithm>

namespace flaneur {
namespace {

constexpr int kDirections = 8, kPhases = 3, kHeight_px = 48;  // fewer, and who moves falls to pieces
constexpr int kErrorSamples = 2000, kWalkPoses = 2;           // what levels are measured by

}  // namespace

void MakeDraft(TourSettings* settings) {
  ImpostorOptions* impostor = &settings->impostor;
  impostor->directions = std::min(impostor->directions, kDirections);
  impostor->height_px = std::min(impostor->height_px, kHeight_px);
  impostor->elevations_deg.resize(1);
  impostor->samples = 1;
  impostor->work_phases = 1;
  for (ImpostorClipOptions& clip : impostor->clips) clip.phases = std::min(clip.phases, kPhases);
  settings->levels.error_samples = std::min(settings->levels.error_samples, kErrorSamples);
  settings->levels.walk_poses = std::min(settings->levels.walk_poses, kWalkPoses);
}

}  // namespace flaneur
