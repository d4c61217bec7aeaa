#include "pipeline/avatar/quadric_decimater.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <random>
#include <set>

namespace flaneur {
namespace {

using Edge = std::pair<int, int>;

std::map<Edge, int> FacesAtEdges(const WedgeSurface& surface) {
  std::map<Edge, int> counts;
  for (const auto& face : surface.faces) {
    for (size_t k = 0; k < 3; ++k) ++counts[std::minmax(int{face.vertices[k]}, int{face.vertices[(k + 1) % 3]})];
  }
  return counts;
}

Vec3 PositionOf(const WedgeSurface& surface, int vertex) {
  return surface.vertices[static_cast<size_t>(vertex)].position;
}

// What holds for what is left of any surface.
void ExpectSound(const QuadricDecimater& decimater) {
  const WedgeSurface surface = decimater.Surface();
  ASSERT_EQ(static_cast<int>(surface.faces.size()), decimater.Triangles());
  std::set<std::array<int, 3>> known;
  for (const auto& face : surface.faces) {
    auto corners = face.vertices;
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    EXPECT_TRUE(known.insert(corners).second) << "a face twice";
    ASSERT_EQ((std::set<int>{corners.begin(), corners.end()}).size(), 3u) << "a face without extent";
    const int mesh = surface.wedges[static_cast<size_t>(face.wedges[0])].mesh;
    for (size_t k = 0; k < 3; ++k) {
      const Vec3 p = PositionOf(surface, face.vertices[k]);
      ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
      EXPECT_EQ(surface.wedges[static_cast<size_t>(face.wedges[k])].mesh, mesh) << "a face of two materials";
    }
  }
}

// n x n squares of two triangles each; `place` from (0, 0) to (1, 1).
Mesh Sheet(int n, const std::function<Vec3(float, float)>& place) {
  Mesh mesh;
  for (int k = 0; k < (n + 1) * (n + 1); ++k) {
    const float x = static_cast<float>(k % (n + 1)) / static_cast<float>(n);
    const float y = static_cast<float>(k / (n + 1)) / static_cast<float>(n);
    mesh.positions.push_back(place(x, y));
    mesh.normals.push_back({0, 0, 1});
    mesh.uvs.push_back({x, y});
  }
  const auto width = static_cast<uint32_t>(n);
  for (uint32_t k = 0; k < width * width; ++k) {
    const uint32_t a = k / width * (width + 1) + k % width;
    mesh.indices.insert(mesh.indices.end(), {a, a + 1, a + width + 2, a, a + width + 2, a + width + 1});
  }
  return mesh;
}

TEST(QuadricDecimater, TakesAFlatSheetDownToItsCorners) {
  QuadricDecimater decimater({Sheet(12, [](float x, float y) { return Vec3{x, y, 0}; })}, {});
  decimater.DecimateTo(2);
  ExpectSound(decimater);
  EXPECT_EQ(decimater.Triangles(), 2);
  const WedgeSurface surface = decimater.Surface();
  for (const auto& face : surface.faces) {
    for (const int v : face.vertices) {
      const Vec3 p = PositionOf(surface, v);
      EXPECT_NEAR(std::abs(p.x - 0.5f), 0.5f, 1e-4f);
      EXPECT_NEAR(std::abs(p.y - 0.5f), 0.5f, 1e-4f);
    }
  }
}

// Teeth of 5 mm around a sheet of 1 m: their tips have to go inside, or there are hundreds of triangles.
TEST(QuadricDecimater, LetsVerticesOfABorderGoInside) {
  int tooth = 0;
  Mesh sheet = Sheet(40, [&](float x, float y) {
    const bool at_border = x == 0 || x == 1 || y == 0 || y == 1;
    const float out = at_border && ++tooth % 2 == 0 ? 1.005f : 1.0f;
    return Vec3{(x - 0.5f) * out, (y - 0.5f) * out, 0};
  });
  QuadricDecimater decimater({sheet}, {});
  decimater.DecimateTo(20);
  ExpectSound(decimater);
  EXPECT_EQ(decimater.Triangles(), 20);
  const WedgeSurface surface = decimater.Surface();
  float area = 0;
  for (const auto& face : surface.faces) {
    const Vec3 a = PositionOf(surface, face.vertices[0]);
    area += Cross(PositionOf(surface, face.vertices[1]) - a, PositionOf(surface, face.vertices[2]) - a).z / 2;
  }
  EXPECT_NEAR(area, 1.005f, 0.01f);
}

// Three leaves on one line: what happens to it happens to all three of them, or they would gape.
TEST(QuadricDecimater, LeavesOnOneLineStayTogether) {
  std::vector<Mesh> leaves;
  for (const float angle : {0.0f, 2.1f, 4.2f}) {
    leaves.push_back(Sheet(10, [&](float x, float y) {
      const float wave = 0.05f * std::sin(9 * y);
      return Vec3{std::cos(angle) * x + wave, y, std::sin(angle) * x + wave};
    }));
  }
  QuadricDecimater decimater(leaves, {});
  for (const int target : {300, 150, 60}) {
    decimater.DecimateTo(target);
    ExpectSound(decimater);
    EXPECT_EQ(decimater.Triangles(), target);
    int on_line = 0;
    std::set<int> ends;
    const WedgeSurface surface = decimater.Surface();
    for (const auto& [edge, faces] : FacesAtEdges(surface)) {
      EXPECT_LE(faces, 3);
      if (faces != 3) continue;
      ++on_line;
      ends.insert({edge.first, edge.second});
    }
    EXPECT_GE(on_line, 2);
    EXPECT_EQ(ends.size(), static_cast<size_t>(on_line) + 1) << "the line is broken";
  }
}

// Collapses turn half-edges into others' neighbours: whoever kept uvs on them would find another face's there.
TEST(QuadricDecimater, WedgesStayWithTheirFaces) {
  const Mesh whole = Sheet(16, [](float x, float y) { return Vec3{x, y, 0.1f * std::sin(7 * x) * std::sin(5 * y)}; });
  std::vector<Mesh> meshes(4, whole);  // each a quarter of the triangles, with a picture of its own
  for (size_t m = 0; m < 4; ++m) {
    meshes[m].indices.clear();
    for (size_t i = 0; i < whole.indices.size(); i += 3) {
      const Vec2 uv = whole.uvs[whole.indices[i]];
      const size_t quarter = (uv.x >= 0.5f ? 1 : 0) + (uv.y >= 0.5f ? 2 : 0);
      for (size_t k = 0; k < 3 && quarter == m; ++k) meshes[m].indices.push_back(whole.indices[i + k]);
    }
    for (Vec2& uv : meshes[m].uvs) uv.x += 10 * static_cast<float>(m);
  }
  QuadricDecimater decimater(meshes, {});
  for (const int target : {256, 128, 64, 32}) {
    decimater.DecimateTo(target);
    ExpectSound(decimater);
    const WedgeSurface surface = decimater.Surface();
    for (const auto& face : surface.faces) {
      for (size_t k = 0; k < 3; ++k) {
        const auto& wedge = surface.wedges[static_cast<size_t>(face.wedges[k])];
        const Vec3 p = PositionOf(surface, face.vertices[k]);
        EXPECT_NEAR(wedge.uv.x - 10 * static_cast<float>(wedge.mesh), p.x, 0.15f);
        EXPECT_NEAR(wedge.uv.y, p.y, 0.15f);
      }
    }
  }
}

TEST(QuadricDecimater, ClosedPartsVanishWhole) {
  Mesh mesh;  // tetrahedra, one larger than the other
  for (uint32_t i = 0; i < 10; ++i) {
    const float size = 0.1f + 0.01f * static_cast<float>(i), x = static_cast<float>(i);
    for (const Vec3 p : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
      mesh.positions.push_back(p * size + Vec3{x, 0, 0});
    }
    const uint32_t a = 4 * i;
    mesh.indices.insert(mesh.indices.end(), {a, a + 2, a + 1, a, a + 1, a + 3, a, a + 3, a + 2, a + 1, a + 2, a + 3});
  }
  QuadricDecimater decimater({mesh}, {});
  decimater.DecimateTo(20);
  ExpectSound(decimater);
  EXPECT_EQ(decimater.Triangles(), 20);
  for (const auto& [edge, faces] : FacesAtEdges(decimater.Surface())) EXPECT_EQ(faces, 2);
}

// Open and closed parts, seams, crossed edges, leaves that touch, back sides, faces wound at random or without extent.
std::vector<Mesh> AnyMeshes(unsigned seed) {
  std::mt19937 random(seed);
  const auto below = [&](uint32_t n) { return static_cast<uint32_t>(random() % n); };
  const auto unit = [&] { return static_cast<float>(random() % 1000) / 1000; };
  std::vector<Mesh> meshes;
  for (uint32_t m = 0; m < 1 + seed % 4; ++m) {
    const float bend = 6 * unit(), lift = 0.3f * unit(), shift = 0.5f * static_cast<float>(below(3));
    Mesh mesh = Sheet(static_cast<int>(3 + below(12)), [&](float x, float y) {
      return Vec3{std::cos(bend * x) + shift, y, std::sin(bend * x) + lift * std::sin(9 * y)};
    });
    const size_t faces = mesh.indices.size() / 3;
    for (uint32_t i = 0; i < seed % 7 * 3; ++i) {
      const size_t f = 3 * below(static_cast<uint32_t>(faces));
      uint32_t* const corners = &mesh.indices[f];
      const auto any = [&] { return below(static_cast<uint32_t>(mesh.positions.size())); };
      const uint32_t kind = below(6);
      if (kind == 0) std::swap(corners[0], corners[1]);
      if (kind == 1) corners[0] = corners[1];
      if (kind == 2) mesh.positions[corners[0]] = mesh.positions[corners[1]];
      if (kind == 3) mesh.uvs[corners[2]] = {unit(), unit()};
      const std::array<uint32_t, 3> added =
          kind == 4 ? std::array{corners[0], corners[2], corners[1]} : std::array{corners[0], corners[1], any()};
      if (kind >= 4) mesh.indices.insert(mesh.indices.end(), added.begin(), added.end());
    }
    meshes.push_back(mesh);
  }
  return meshes;
}

TEST(QuadricDecimater, ReachesAnyTargetOnAnySurface) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(seed);
    QuadricDecimater decimater(AnyMeshes(seed), {});
    const int original = decimater.Triangles();
    for (const int share : {2, 4, 10, 50}) {
      decimater.DecimateTo(original / share);
      ExpectSound(decimater);
      EXPECT_LE(decimater.Triangles(), original / share + 4) << "an edge where many meet loses many";
    }
  }
}

TEST(QuadricDecimater, GivesTheSameBytesTwice) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    QuadricDecimater first(AnyMeshes(seed), {}), second(AnyMeshes(seed), {});
    first.DecimateTo(first.Triangles() / 5);
    second.DecimateTo(second.Triangles() / 5);
    const WedgeSurface a = first.Surface(), b = second.Surface();
    ASSERT_EQ(a.faces.size(), b.faces.size());
    ASSERT_EQ(a.vertices.size(), b.vertices.size());
    for (size_t f = 0; f < a.faces.size(); ++f) {
      EXPECT_EQ(a.faces[f].vertices, b.faces[f].vertices);
      EXPECT_EQ(a.faces[f].wedges, b.faces[f].wedges);
    }
    const size_t bytes = a.vertices.size() * sizeof a.vertices[0];
    EXPECT_EQ(std::memcmp(a.vertices.data(), b.vertices.data(), bytes), 0);
  }
}

}  // namespace
}  // namespace flaneur
