// Small pictures of a person in their clips, drawn without any graphics driver: to see at a glance whether somebody
// stands, faces forward and keeps their hands out of themselves.
#pragma once
#include <vector>

#include "pipeline/core/avatar.h"
#include "runtime/base/pixels.h"

namespace flaneur {

// One drawn figure: matrices as SkinningMatrices gives them, seen from `yaw_deg` to the person's left of their front
// (0: from the front, 90: their left side), without perspective.
struct FigureView {
  std::vector<Mat4> pose;
  float yaw_deg = 0;
};

// The views side by side, each `height_px` high and as wide as what reaches farthest to a side, up to four times its
// height, the ground drawn as a line at y = 0. One scale for all: of `height_m`, or of what reaches higher, with a
// margin. Pictures of materials show; what they hide does not.
Pixels DrawFigures(const std::vector<Mesh>& meshes, const Avatar& avatar, const std::vector<FigureView>& views,
                   float height_m, int height_px);

// A row of a clip's phases: `count` moments evenly spread from the left side, then one from the front and one from
// behind.
std::vector<FigureView> ViewsOfClip(const Avatar& avatar, const Clip& clip, int count);

// The second to the right of the first; both as high as the higher.
Pixels Beside(const Pixels& left, const Pixels& right);

// One below the other, white beside the shorter ones.
Pixels Stacked(const std::vector<Pixels>& rows);

}  // namespace flaneur
