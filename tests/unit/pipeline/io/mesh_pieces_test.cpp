// Large meshes are cut into pieces that together are what was there.
#include "pipeline/io/mesh_pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "pipeline/io/encode_avatar.h"

namespace flaneur {
namespace {

// A square of `side` x `side` fields of two triangles each.
Mesh Field(uint32_t side) {
  Mesh mesh;
  for (uint32_t y = 0; y <= side; ++y) {
    for (uint32_t x = 0; x <= side; ++x) {
      mesh.positions.push_back({static_cast<float>(x) * 0.37f, 0, static_cast<float>(y) * 0.21f});
      mesh.normals.push_back({0, 1, 0});
      if (x == side || y == side) continue;
      const uint32_t a = y * (side + 1) + x, b = a + side + 1;
      mesh.indices.insert(mesh.indices.end(), {a, b, a + 1, a + 1, b, b + 1});
    }
  }
  return mesh;
}

std::vector<std::array<uint32_t, 3>> Sorted(const std::vector<std::vector<uint32_t>>& pieces) {
  std::vector<std::array<uint32_t, 3>> triangles;
  for (const std::vector<uint32_t>& piece : pieces) {
    for (size_t i = 0; i + 2 < piece.size(); i += 3) triangles.push_back({piece[i], piece[i + 1], piece[i + 2]});
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

TEST(MeshPieces, HoldEveryTriangleOnceAndNoMoreThanAsked) {
  std::mt19937 random(11);
  for (uint32_t side : {1u, 7u, 40u}) {
    Mesh mesh = Field(side);
    for (Vec3& p : mesh.positions) p.y = static_cast<float>(random() % 3);
    for (size_t most : {size_t{1}, size_t{17}, size_t{500}}) {
      const auto pieces = InPieces(mesh, most);
      for (const auto& piece : pieces) {
        EXPECT_GT(piece.size(), 0u);
        EXPECT_LE(piece.size(), 3 * most);
      }
      EXPECT_EQ(Sorted(pieces), Sorted({mesh.indices}));
    }
  }
}

TEST(MeshPieces, LeaveAMeshWholeThatIsSmallEnough) {
  const Mesh mesh = Field(8);
  for (size_t most : {size_t{0}, size_t{128}}) {
    const auto pieces = InPieces(mesh, most);
    ASSERT_EQ(pieces.size(), 1u);
    EXPECT_EQ(pieces.front(), mesh.indices);
  }
}

TEST(MeshPieces, AreCompactAndShareFewVertices) {
  const Mesh mesh = Field(40);
  size_t vertices = 0;
  for (const auto& piece : InPieces(mesh, 400)) {
    std::vector<uint32_t> used = piece;
    std::sort(used.begin(), used.end());
    vertices += static_cast<size_t>(std::unique(used.begin(), used.end()) - used.begin());
  }
  EXPECT_LT(vertices, mesh.positions.size() * 5 / 4);
}

// Triangles that all lie in one place cannot be told apart by where they are.
TEST(MeshPieces, CutTrianglesThatLieUponEachOther) {
  Mesh mesh;
  mesh.positions.assign(3, Vec3{1, 2, 3});
  for (int t = 0; t < 100; ++t) mesh.indices.insert(mesh.indices.end(), {0, 1, 2});
  const auto pieces = InPieces(mesh, 9);
  EXPECT_GT(pieces.size(), 10u);
  EXPECT_EQ(Sorted(pieces).size(), 100u);
}

TEST(MeshPieces, KeepTrianglesThatAreNowhere) {
  Mesh mesh = Field(20);
  for (size_t i = 0; i < mesh.positions.size(); i += 3) mesh.positions[i].x = NAN;
  for (size_t i = 1; i < mesh.positions.size(); i += 7) mesh.positions[i].z = INFINITY;
  EXPECT_EQ(Sorted(InPieces(mesh, 50)), Sorted({mesh.indices}));
}

TEST(MeshPieces, StayJoinedWhenTheyAreEncoded) {
  const Mesh mesh = Field(40);
  DracoOptions draco;
  draco.position_bits = 10;  // rough enough that another grid for each would be seen
  const auto places = [&](size_t most_triangles, size_t* parts) {
    draco.most_triangles = most_triangles;
    EncodedMesh encoded;
    EXPECT_EQ(EncodeMesh({&mesh, 1}, draco, &encoded).message, "");
    *parts = encoded.parts.size();
    std::vector<std::array<float, 3>> all;
    for (const EncodedPart& part : encoded.parts) {
      DracoAttribute position{part.draco.position, 0, false, {}};
      std::vector<uint32_t> indices;
      EXPECT_EQ(DecodeDraco(part.draco.bytes, {&position, 1}, &indices).message, "");
      for (size_t i = 0; i < position.values.size(); i += 3)
        all.push_back({position.values[i], position.values[i + 1], position.values[i + 2]});
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  };
  size_t whole = 0, pieces = 0;
  const auto before = places(0, &whole);
  EXPECT_EQ(places(300, &pieces), before);
  EXPECT_EQ(whole, 1u);
  EXPECT_GE(pieces, 11u);
}

}  // namespace
}  // namespace flaneur
