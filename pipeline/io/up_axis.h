// Which axis of a town's file points up.
#pragma once
#include "pipeline/core/scene.h"

namespace flaneur {

enum class UpAxis { kJudged, kX, kY, kZ, kMinusX, kMinusY, kMinusZ };

// A point or direction of the file as it lies with +Z up; turned, never mirrored. kJudged: as with kZ.
template <typename V>
V WithZUp(const V& p, UpAxis up) {
  switch (up) {
    case UpAxis::kX:
      return {p.y, p.z, p.x};
    case UpAxis::kMinusX:
      return {p.y, -p.z, -p.x};
    case UpAxis::kY:
      return {p.x, -p.z, p.y};
    case UpAxis::kMinusY:
      return {p.x, p.z, -p.y};
    case UpAxis::kMinusZ:
      return {p.x, -p.y, -p.z};
    default:
      return p;
  }
}

// Turns a scene, whose +Y is up, so that `up` is.
void StandUp(UpAxis up, Scene* scene);

// Whether the scene lies on its side: far wider in two directions, up among them, than in the third, as no town is,
// and larger than a part of a town.
// `thin`: the axis of that.
bool LiesOnItsSide(const Scene& scene, UpAxis* thin);

}  // namespace flaneur
