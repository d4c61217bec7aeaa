// Triangles whose corners know each other, and where their surface ends. Internal to the extraction.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "pipeline/footprint/town_objects.h"

namespace flaneur {

using CornerIndex = uint32_t;
using Corners = std::array<CornerIndex, 3>;              // ascending
using CornerEdge = std::pair<CornerIndex, CornerIndex>;  // the lesser first

// That belongs to one triangle only.
struct BorderEdge {
  CornerEdge edge;
  size_t triangle;  // of the shell's
};

struct WeldedShell {
  std::vector<Point3> points;       // not all of them belong to a triangle
  std::vector<Corners> triangles;   // sorted, each once
  std::vector<size_t> source;       // of each the first of the given triangles
  std::vector<BorderEdge> borders;  // by edge
};

// Vertices count as the same when they agree to a millimetre, and to five where the surface is torn between
// them, as where each wall has corners of its own; repeated and turned triangles do not matter.
WeldedShell Weld(const std::vector<Triangle3>& shell);

// Neighbours of each point along edges that belong to one triangle only.
using Borders = std::map<CornerIndex, std::set<CornerIndex>>;
size_t TriangleAt(const std::vector<BorderEdge>& edges, CornerIndex a, CornerIndex b);  // a border must be there
Borders ToBorders(const std::vector<BorderEdge>& edges);
void RemoveBorder(CornerIndex a, CornerIndex b, Borders* borders);

double Distance(const Point3& a, const Point3& b);
Point3 NormalOf(const Triangle3& triangle);     // as long as twice the area
double ThicknessOf(const Triangle3& triangle);  // over its longest edge
// Give or take 2 cm: whether it lies in the plane of another, and whether a ring's corners lie in one.
bool GoesOnIn(const Triangle3& triangle, const Triangle3& plane);
bool IsPlane(const std::vector<Point3>& ring);

}  // namespace flaneur
