// Faces as OBJ, PLY and STL have them: corners that name points, in axes of which nobody says which one is up.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/io/scene_reader.h"
#include "pipeline/io/town_builder.h"

namespace flaneur {

struct PolygonSoup {
  static constexpr uint32_t kNone = ~0u;
  std::vector<Point3> points;
  std::vector<Vec4> colors;   // of the points, linear; as many as had one, or fewer
  std::vector<Vec2> places;   // in a picture, whose lower edge is 0
  std::vector<Vec3> normals;  // unit, or zero
  // Of each corner, one face after the other; a place or normal may be kNone.
  std::vector<uint32_t> corners, corner_places, corner_normals;
  std::vector<uint32_t> sizes;  // of the faces, in corners
};

// How a face looks: a material of the builder's, and where its picture lies.
struct FaceLook {
  int material = -1;  // -1: plain
  Vec2 uv_scale{1, 1}, uv_offset{};
  bool has_picture = false;
};

// The axis that points up: `up`; where that is not known, y or z, judged by map coordinates, the extents or the walls,
// with a warning that names the file and the option.
UpAxis UpOf(const PolygonSoup& soup, UpAxis up, const std::string& file, const char* format,
            std::vector<std::string>* warnings);

// Of a point, linear, of shares of sRGB's colours; and a normal, or zero.
Vec4 ColorOfPoint(double red, double green, double blue);
Vec3 UnitNormal(double x, double y, double z);

// For what has no picture, so that its colours show as they are.
Material WhiteMaterial();

// Adds the face whose corners are the `size` from `corner` on.
void AddFace(const PolygonSoup& soup, size_t corner, size_t size, UpAxis up, const FaceLook& look, int node,
             TownBuilder* builder);

}  // namespace flaneur
