#include "pipeline/avatar/fit_look.h"

#include <gtest/gtest.h>

#include <cmath>

namespace flaneur {
namespace {

// A ball of radius 1 with so many rings, brighter towards +Y. `lean`: how far its normals are off, and its colours with
// them.
Mesh Ball(int rings, float lean) {
  Mesh mesh;
  mesh.name = "ball";
  const int around = 2 * rings;
  for (int r = 0; r <= rings; ++r) {
    for (int a = 0; a < around; ++a) {
      const float polar = kPi * static_cast<float>(r) / static_cast<float>(rings),
                  azimuth = kPi * static_cast<float>(a) / static_cast<float>(rings);
      const Vec3 p{std::sin(polar) * std::sin(azimuth), std::cos(polar), std::sin(polar) * std::cos(azimuth)};
      mesh.positions.push_back(p);
      mesh.normals.push_back(Normalized(p + Vec3{lean, 0, -lean}));
      const float shade = 0.5f + 0.4f * p.y + 0.3f * lean;
      mesh.colors.push_back({shade, shade / 2, 0.1f, 1});
    }
  }
  for (int r = 0; r < rings; ++r) {
    for (int a = 0; a < around; ++a) {
      const auto at = [&](int ring, int step) { return static_cast<uint32_t>(ring * around + step % around); };
      mesh.indices.insert(mesh.indices.end(),
                          {at(r, a), at(r + 1, a), at(r + 1, a + 1), at(r, a), at(r + 1, a + 1), at(r, a + 1)});
    }
  }
  return mesh;
}

// Means over all corners: degrees between the normals and those of a ball, and how far colours are off.
std::pair<double, double> Off(const WedgeSurface& surface) {
  double degrees = 0, off = 0;
  for (const auto& face : surface.faces) {
    for (size_t k = 0; k < 3; ++k) {
      const Vec3 p = surface.vertices[static_cast<size_t>(face.vertices[k])].position;
      const WedgeSurface::Wedge& wedge = surface.wedges[static_cast<size_t>(face.wedges[k])];
      degrees += std::acos(std::min(1.0, static_cast<double>(Dot(wedge.normal, Normalized(p))))) * 180 /
                 static_cast<double>(kPi);
      off += std::abs(static_cast<double>(wedge.color.x - (0.5f + 0.4f * p.y)));
    }
  }
  const auto corners = static_cast<double>(3 * surface.faces.size());
  return {degrees / corners, off / corners};
}

TEST(LookFitter, CoarseSurfaceTakesTheOriginalsNormalsAndColours) {
  WedgeSurface level = JoinWedges({Ball(8, 0.3f)});
  const auto before = Off(level);
  LookFitter(std::vector<Mesh>{Ball(40, 0)}).Fit(&level);
  const auto after = Off(level);
  EXPECT_GT(before.first, 15);
  EXPECT_LT(after.first, 1.5);
  EXPECT_GT(before.second, 0.08);
  EXPECT_LT(after.second, 0.02);
}

TEST(LookFitter, CreaseStays) {
  // Two walls of a corner: each keeps its own normal where they meet.
  Mesh corner;
  corner.positions = {{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}};
  for (int i = 0; i < 8; ++i) corner.normals.push_back(i < 4 ? Vec3{0, 0, -1} : Vec3{-1, 0, 0});
  corner.indices = {0, 1, 2, 0, 2, 3, 4, 6, 5, 4, 7, 6};
  WedgeSurface level = JoinWedges({corner});
  LookFitter(std::vector<Mesh>{corner}).Fit(&level);
  for (const auto& wedge : level.wedges) EXPECT_GT(std::max(-wedge.normal.x, -wedge.normal.z), 0.999f);
}

// A tube of radius 0.1 whose picture is wrapped around it once.
Mesh Tube() {
  Mesh mesh;
  for (int ring = 0; ring <= 20; ++ring) {
    for (int step = 0; step <= 24; ++step) {
      const float u = static_cast<float>(step) / 24, v = static_cast<float>(ring) / 20, turn = 2 * kPi * u;
      mesh.positions.push_back({0.1f * std::sin(turn), v, 0.1f * std::cos(turn)});
      mesh.normals.push_back({std::sin(turn), 0, std::cos(turn)});
      mesh.uvs.push_back({u, v});
    }
  }
  for (uint32_t i = 0; i < 20 * 25; ++i) {
    if (i % 25 != 24) mesh.indices.insert(mesh.indices.end(), {i, i + 1, i + 26, i, i + 26, i + 25});
  }
  return mesh;
}

TEST(LookFitter, DriftedPictureComesBackAlsoBesideItsSeam) {
  const Mesh tube = Tube();
  WedgeSurface level = JoinWedges({tube});
  for (auto& wedge : level.wedges) wedge.uv = wedge.uv + Vec2{0.03f, 0.02f * std::sin(9 * wedge.uv.y)};
  LookFitter(std::vector<Mesh>{tube}).Fit(&level);
  for (size_t v = 0; v < tube.uvs.size(); ++v) EXPECT_LT(Length(level.wedges[v].uv - tube.uvs[v]), 0.006f) << v;
}

TEST(LookFitter, WithoutNormalsNothingChanges) {
  Mesh bare = Ball(6, 0);
  bare.normals.clear();
  bare.colors.clear();
  WedgeSurface level = JoinWedges({bare});
  LookFitter(std::vector<Mesh>{bare}).Fit(&level);
  for (const auto& wedge : level.wedges) EXPECT_EQ(Length(wedge.normal), 0);
}

}  // namespace
}  // namespace flaneur
