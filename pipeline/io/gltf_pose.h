// A glTF file's nodes at a moment of one of its clips.
#pragma once
#include <vector>

#include "pipeline/core/avatar.h"
#include "pipeline/io/gltf_document.h"

namespace flaneur {

struct ClipSpan {
  float start_s = 0, end_s = 0;  // first and last key of any channel
};

ClipSpan SpanOf(const DocumentClip& clip);

// World matrices of all nodes, with the clip's step, linear or cubic interpolation; held before the
// first key and after the last.
std::vector<Mat4> PoseAt(const GltfDocument& document, const DocumentClip& clip, float time_s);

// Translation, rotation and scale of a matrix; a mirrored one gets a negative x scale, shear is
// lost.
Transform Decomposed(const Mat4& matrix);

}  // namespace flaneur
