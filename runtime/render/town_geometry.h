// The town as one vertex array and one list of triangles, cut into square blocks that are drawn or left out as wholes.
// Internal to runtime/render; no OpenGL.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "runtime/pack/tour_pack.h"
#include "runtime/render/projection.h"
#include "runtime/render/surface_plan.h"

namespace flaneur {

struct TownVertex {              // as the vertex shader reads it
  Vec3 position;                 // world, glTF axes
  std::array<int8_t, 4> normal;  // normalized; the fourth is the layer of the picture
  Vec2 uv;
  std::array<uint8_t, 4> color;  // normalized; the material's base colour is in it
};

struct TownRange {
  int group = 0;
  uint32_t first = 0, count = 0;
};  // of the indices; group: index into SurfacePlan::groups

struct TownBlock {
  Box box;
  std::vector<TownRange> ranges;     // one a group
  size_t first_wall = 0, walls = 0;  // corners in TownGeometry::walls
  int64_t triangles = 0;
};

// A weathercock, a clock's hand: few triangles, which are drawn on their own, where they have turned to.
struct TurningGeometry {
  TurningPart part;
  int index = 0;                     // of the pack's
  Box box;                           // however it turns
  std::vector<TownVertex> vertices;  // as modelled, in the town
  std::vector<uint32_t> indices;
  std::vector<TownRange> ranges;  // of the indices
};

struct TownGeometry {
  std::vector<TownVertex> vertices;
  std::vector<uint32_t>
      indices;  // of all blocks what is opaque, and after it each group that is cut out: shadows draw those one by one
  std::vector<Vec3> positions;  // of the vertices
  std::vector<uint32_t> walls;  // indices of the triangles that are large and opaque enough to hide what is behind them
  std::vector<TownBlock> blocks;  // neighbours near each other
  std::vector<TurningGeometry> turning;
};

TownGeometry BuildTownGeometry(const TourPack& pack, const SurfacePlan& plan);

// The same in parts, for who has other things to do between them. pack and plan must live longer.
class TownBuilder {
 public:
  TownBuilder(const TourPack& pack, const SurfacePlan& plan);
  TownBuilder(TownBuilder&&) noexcept;
  TownBuilder& operator=(TownBuilder&&) noexcept;
  ~TownBuilder();
  // Some thousands of triangles more; true: these were the last.
  bool Advance();
  TownGeometry Take();  // once, after the last

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace flaneur
