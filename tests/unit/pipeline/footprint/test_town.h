// Towns of boxes for the footprint tests: metres, x east, y north, z up.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <vector>

#include "pipeline/core/scene.h"
#include "pipeline/footprint/extract_footprints.h"
#include "pipeline/footprint/polygon_sets.h"

namespace flaneur {

// The sides of a box, to leave some out.
enum class Side { kWest, kEast, kSouth, kNorth, kBottom, kTop };

class TestTown {
 public:
  static constexpr float kBelow = -0.3f;  // houses reach a little into the ground

  // A node that the following meshes hang on.
  TestTown& Node(const std::string& name, NodeKind kind, float radius_m = 0) {
    SceneNode node;
    node.name = name, node.kind = kind, node.radius_m = radius_m;
    scene.nodes.push_back(node);
    return *this;
  }

  TestTown& Box(Vec3 min, Vec3 max, const std::set<Side>& without = {}) {
    const Vec3 a{min.x, min.y, min.z}, b{max.x, min.y, min.z}, c{max.x, max.y, min.z}, d{min.x, max.y, min.z};
    const auto up = [&](Vec3 p) { return Vec3{p.x, p.y, max.z}; };
    Mesh mesh;
    const auto side = [&](Side which, Vec3 p, Vec3 q, Vec3 r, Vec3 s) {
      if (!without.contains(which)) AddQuad(p, q, r, s, &mesh);
    };
    side(Side::kSouth, a, b, up(b), up(a));
    side(Side::kEast, b, c, up(c), up(b));
    side(Side::kNorth, c, d, up(d), up(c));
    side(Side::kWest, d, a, up(a), up(d));
    side(Side::kTop, up(a), up(b), up(c), up(d));
    side(Side::kBottom, d, c, b, a);
    return Add(mesh);
  }

  TestTown& Quad(Vec3 p, Vec3 q, Vec3 r, Vec3 s) {
    Mesh mesh;
    AddQuad(p, q, r, s, &mesh);
    return Add(mesh);
  }

  // A column with an even number of corners.
  TestTown& Column(Vec3 foot, float radius_m, float height_m, int corners) {
    const auto at = [&](int i, float z) {
      const float angle = 2 * kPi * static_cast<float>(i) / static_cast<float>(corners);
      return Vec3{foot.x + radius_m * std::cos(angle), foot.y + radius_m * std::sin(angle), z};
    };
    Mesh mesh;
    for (int i = 0; i < corners; ++i) {
      AddQuad(at(i, foot.z), at(i + 1, foot.z), at(i + 1, foot.z + height_m), at(i, foot.z + height_m), &mesh);
      AddTriangle({foot.x, foot.y, foot.z + height_m}, at(i, foot.z + height_m), at(i + 1, foot.z + height_m), &mesh);
    }
    return Add(mesh);
  }

  // `rise` metres up for each metre east, from 0 at x = 0.
  TestTown& Ground(float width = 40, float depth = 30, float rise = 0) {
    Node("ground", NodeKind::kGround);
    scene.nodes.back().ground = GroundKind::kSquare;
    return Quad({0, 0, 0}, {width, 0, width * rise}, {width, depth, width * rise}, {0, depth, 0});
  }

  // An empty node at ground level; people come out towards `ahead`.
  TestTown& Gate(const std::string& name, NodeKind kind, Vec2 at, Vec2 ahead) {
    Node(name, kind);
    const float yaw = std::atan2(ahead.x, -ahead.y);  // about glTF's +Y, from +Z = our -y
    scene.nodes.back().world = FromTranslationRotationScale(GltfFromGround({at.x, at.y, 0}),
                                                            {0, std::sin(yaw / 2), 0, std::cos(yaw / 2)}, {1, 1, 1});
    return *this;
  }

  // Runs over every triangle as three vertex indices.
  template <typename Function>
  TestTown& EachMesh(const Function& function) {
    for (Mesh& mesh : scene.meshes) function(&mesh);
    return *this;
  }

  Scene scene;

 private:
  static void AddTriangle(Vec3 p, Vec3 q, Vec3 r, Mesh* mesh) {
    for (const Vec3 v : {p, q, r}) {
      mesh->indices.push_back(static_cast<uint32_t>(mesh->positions.size()));
      mesh->positions.push_back(GltfFromGround(v));
    }
  }
  static void AddQuad(Vec3 p, Vec3 q, Vec3 r, Vec3 s, Mesh* mesh) {
    AddTriangle(p, q, r, mesh);
    AddTriangle(p, r, s, mesh);
  }
  TestTown& Add(const Mesh& mesh) {
    scene.nodes.back().meshes.push_back(static_cast<int>(scene.meshes.size()));
    scene.meshes.push_back(mesh);
    return *this;
  }
};

inline Footprints Extract(const TestTown& town, const FootprintOptions& options = {}, FootprintStats* stats = nullptr) {
  Footprints footprints;
  EXPECT_EQ(ExtractFootprints(town.scene, options, &footprints, stats).message, "");
  return footprints;
}

inline Rings RingsOf(const Obstacle& obstacle) {
  Rings rings{obstacle.outer};
  rings.insert(rings.end(), obstacle.holes.begin(), obstacle.holes.end());
  return rings;
}

// Polygons as one area, circles left out.
inline Rings AreaOf(const Footprints& footprints) {
  Rings area;
  for (const Obstacle& o : footprints.obstacles)
    if (!o.outer.empty()) area = Union(area, RingsOf(o));
  return area;
}

inline bool Blocked(const Footprints& footprints, Point2 p) {
  return std::any_of(footprints.obstacles.begin(), footprints.obstacles.end(), [&](const Obstacle& o) {
    if (o.outer.empty()) return std::hypot(p.x - o.center.x, p.y - o.center.y) < o.radius_m;
    return Contains(RingsOf(o), p);
  });
}

inline Ring Rectangle(double x0, double y0, double x1, double y1) { return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}; }

// Square metres by which two areas differ.
inline double Differ(const Rings& a, const Rings& b) { return Area(Difference(a, b)) + Area(Difference(b, a)); }

}  // namespace flaneur
