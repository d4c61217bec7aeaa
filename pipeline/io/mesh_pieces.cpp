#include "pipeline/io/mesh_pieces.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

namespace flaneur {
namespace {

// Three times as far from the origin as it is; a town may hold corners that are nowhere.
Vec3 MiddleOf(const Mesh& mesh, size_t triangle) {
  const uint32_t* corners = &mesh.indices[3 * triangle];
  const Vec3 sum = mesh.positions[corners[0]] + mesh.positions[corners[1]] + mesh.positions[corners[2]];
  return std::isfinite(sum.x) && std::isfinite(sum.y) && std::isfinite(sum.z) ? sum : Vec3{};
}

// The axis along which the middles reach furthest.
float Vec3::*LongestAxis(const std::vector<Vec3>& middles, std::span<const size_t> triangles) {
  float Vec3::*longest = &Vec3::x;
  float most = -1;
  for (float Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    const auto [least, largest] = std::minmax_element(
        triangles.begin(), triangles.end(), [&](size_t a, size_t b) { return middles[a].*axis < middles[b].*axis; });
    const float extent = middles[*largest].*axis - middles[*least].*axis;
    if (extent > most) {
      most = extent;
      longest = axis;
    }
  }
  return longest;
}

void Cut(const Mesh& mesh, const std::vector<Vec3>& middles, std::span<size_t> triangles, size_t most_triangles,
         std::vector<std::vector<uint32_t>>* pieces) {
  if (triangles.size() > most_triangles) {
    const float Vec3::*axis = LongestAxis(middles, triangles);
    const size_t half = triangles.size() / 2;
    std::nth_element(triangles.begin(), triangles.begin() + static_cast<std::ptrdiff_t>(half), triangles.end(),
                     [&](size_t a, size_t b) {
                       return middles[a].*axis != middles[b].*axis ? middles[a].*axis < middles[b].*axis : a < b;
                     });
    Cut(mesh, middles, triangles.first(half), most_triangles, pieces);
    return Cut(mesh, middles, triangles.subspan(half), most_triangles, pieces);
  }
  std::sort(triangles.begin(), triangles.end());
  std::vector<uint32_t>& piece = pieces->emplace_back();
  for (const size_t t : triangles) piece.insert(piece.end(), &mesh.indices[3 * t], &mesh.indices[3 * t] + 3);
}

}  // namespace

std::vector<std::vector<uint32_t>> InPieces(const Mesh& mesh, size_t most_triangles) {
  const size_t count = mesh.indices.size() / 3;
  if (most_triangles == 0 || count <= most_triangles) return {mesh.indices};
  std::vector<Vec3> middles(count);
  for (size_t t = 0; t < count; ++t) middles[t] = MiddleOf(mesh, t);
  std::vector<size_t> triangles(count);
  std::iota(triangles.begin(), triangles.end(), size_t{0});
  std::vector<std::vector<uint32_t>> pieces;
  Cut(mesh, middles, triangles, most_triangles, &pieces);
  return pieces;
}

}  // namespace flaneur
