// Meshes to Draco's bytes and back.
#include "pipeline/io/draco_codec.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

namespace flaneur {
namespace {

// So many triangles with a size, each for itself, somewhere, with any uvs.
Mesh Scattered(int triangles, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> share(0, 1);
  const float size_m = 0.01f + share(random), east_m = 20 * share(random) - 10;
  Mesh mesh;
  for (uint32_t v = 0; v < 3 * static_cast<uint32_t>(triangles); ++v) {
    const float x = east_m + size_m * share(random), y = size_m * share(random);
    mesh.positions.push_back({x, y, size_m * share(random)});
    const float u = share(random);
    mesh.uvs.push_back({u, share(random)});
    mesh.indices.push_back(v);
  }
  return mesh;
}

PositionGrid GridAround(const Mesh& mesh) {
  Vec3 least = mesh.positions[0], most = least;
  for (const Vec3& p : mesh.positions) {
    least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
    most = {std::max(most.x, p.x), std::max(most.y, p.y), std::max(most.z, p.z)};
  }
  const Vec3 size = most - least;
  return {least, std::max({size.x, size.y, size.z})};
}

using Corner = std::array<float, 5>;  // place and uv

// Draco changes the order of triangles.
std::vector<Corner> Sorted(std::vector<Corner> corners) {
  std::sort(corners.begin(), corners.end());
  return corners;
}

// Some thousandths of a millimetre: Draco's own rounding of the grid put what lies at its least outside.
TEST(DracoCodec, KeepsWhatLiesAtTheRimOfAFineGrid) {
  for (uint32_t seed = 1; seed <= 200; ++seed) {
    const Mesh mesh = Scattered(1 + static_cast<int>(seed % 3), seed);
    DracoOptions options;
    options.position_bits = 18;
    options.uv_bits = 16;
    DracoMesh encoded;
    ASSERT_EQ(EncodeDraco(mesh, options, GridAround(mesh), false, &encoded).message, "") << "seed " << seed;
    std::vector<DracoAttribute> read(2);
    read[0].id = encoded.position, read[1].id = encoded.uv;
    std::vector<uint32_t> indices;
    ASSERT_EQ(DecodeDraco(encoded.bytes, read, &indices).message, "") << "seed " << seed;
    std::vector<Corner> wanted, there;
    for (const size_t i : mesh.indices) {
      const Vec3 p = mesh.positions[i];
      wanted.push_back({p.x, p.y, p.z, mesh.uvs[i].x, mesh.uvs[i].y});
    }
    for (const size_t i : indices) {
      const float *p = &read[0].values[3 * i], *uv = &read[1].values[2 * i];
      there.push_back({p[0], p[1], p[2], uv[0], uv[1]});
    }
    ASSERT_EQ(there.size(), wanted.size());
    wanted = Sorted(wanted), there = Sorted(there);
    for (size_t k = 0; k < wanted.size(); ++k) {
      for (size_t c = 0; c < 5; ++c) ASSERT_NEAR(there[k][c], wanted[k][c], 1e-4f) << "seed " << seed;
    }
  }
}

}  // namespace
}  // namespace flaneur
