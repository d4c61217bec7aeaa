// Heights in plan, cell by cell, of one object. Internal to the extraction.
#pragma once
#include <limits>
#include <vector>

#include "pipeline/core/footprint.h"
#include "pipeline/footprint/constants.h"
#include "pipeline/footprint/town_objects.h"
#include "runtime/base/array.h"

namespace flaneur {

inline constexpr float kNoHeight = std::numeric_limits<float>::max();

// Cells of `cell_m` over a box, larger where that would be too many; no cell has a height yet.
GroundRaster BlankRaster(Point2 min_m, Point2 max_m, double cell_m = kBaseCell_m);

inline size_t CellAt(const GroundRaster& raster, int column, int row) { return RowMajor(row, raster.columns, column); }
int ColumnAt(const GroundRaster& raster, double x);
int RowAt(const GroundRaster& raster, double y);

// Whether a face is so steep that it covers no ground.
bool IsWall(const Triangle3& triangle);

// Lowers the cells that a triangle's edges pass to their height there; likewise those whose middle it covers.
void DrawEdges(const Triangle3& triangle, GroundRaster* raster);
void DrawArea(const Triangle3& triangle, GroundRaster* raster);
// Of both kinds those lose their height, from `least_m` on, that it passes within so much of it.
void ForgetAt(const Triangle3& triangle, double within_m, float least_m, GroundRaster* raster);

// Each cell with a height takes the least, or the greatest, of those within `reach` cells.
void TakeLeast(int reach, GroundRaster* raster);
void TakeGreatest(int reach, GroundRaster* raster);

}  // namespace flaneur
