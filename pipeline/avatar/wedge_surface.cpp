#include "pipeline/avatar/wedge_surface.h"

#include <map>
#include <numeric>
#include <tuple>
#include <unordered_map>

namespace flaneur {
namespace {

class Sets {
 public:
  explicit Sets(size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  int Find(int i) {
    while (parent_[static_cast<size_t>(i)] != i) {
      parent_[static_cast<size_t>(i)] =
          parent_[static_cast<size_t>(parent_[static_cast<size_t>(i)])];
      i = parent_[static_cast<size_t>(i)];
    }
    return i;
  }
  void Join(int a, int b) { parent_[static_cast<size_t>(Find(a))] = Find(b); }

 private:
  std::vector<int> parent_;
};

// A place for each wedge: equal positions get the same number.
std::vector<int> Places(const std::vector<Mesh>& meshes) {
  std::map<std::tuple<float, float, float>, int> numbers;
  std::vector<int> places;
  for (const Mesh& mesh : meshes) {
    for (const Vec3 p : mesh.positions) {
      // Adding 0 makes -0 equal +0.
      const std::tuple key{p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};
      places.push_back(numbers.try_emplace(key, static_cast<int>(numbers.size())).first->second);
    }
  }
  return places;
}

void AddFaces(const std::vector<Mesh>& meshes, const std::vector<int>& places,
              WedgeSurface* surface) {
  int base = 0;
  for (size_t m = 0; m < meshes.size(); ++m) {
    const Mesh& mesh = meshes[m];
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
      surface->wedges.push_back({static_cast<int>(m), v, v});
    }
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      WedgeSurface::Face face;
      for (size_t k = 0; k < 3; ++k) {
        face.wedges[k] = base + static_cast<int>(mesh.indices[i + k]);
        face.vertices[k] = places[static_cast<size_t>(face.wedges[k])];
      }
      const auto& v = face.vertices;
      if (v[0] != v[1] && v[1] != v[2] && v[2] != v[0]) surface->faces.push_back(face);
    }
    base += static_cast<int>(mesh.positions.size());
  }
}

struct EdgeUse {
  int face[2] = {-1, -1};
  int corner[2] = {0, 0};  // where the edge starts in the face
  bool forward[2] = {};    // from the lower place to the higher
  int count = 0;
};

uint64_t EdgeKey(int a, int b) {
  return static_cast<uint64_t>(std::min(a, b)) << 32 | static_cast<uint32_t>(std::max(a, b));
}

// Joins corners of neighbouring faces across proper edges; each set of corners is a vertex of its
// own.
Sets JoinAcrossEdges(const WedgeSurface& surface) {
  std::unordered_map<uint64_t, EdgeUse> edges;
  for (size_t f = 0; f < surface.faces.size(); ++f) {
    const auto& v = surface.faces[f].vertices;
    for (int k = 0; k < 3; ++k) {
      const int a = v[static_cast<size_t>(k)], b = v[static_cast<size_t>((k + 1) % 3)];
      EdgeUse& use = edges[EdgeKey(a, b)];
      if (use.count < 2) {
        use.face[use.count] = static_cast<int>(f);
        use.corner[use.count] = k;
        use.forward[use.count] = a < b;
      }
      ++use.count;
    }
  }
  Sets corners(3 * surface.faces.size());
  for (const auto& [key, use] : edges) {
    if (use.count != 2 || use.forward[0] == use.forward[1]) continue;
    const auto corner = [&](int side, int step) {
      return 3 * use.face[side] + (use.corner[side] + step) % 3;
    };
    corners.Join(corner(0, 0), corner(1, 1));
    corners.Join(corner(0, 1), corner(1, 0));
  }
  return corners;
}

}  // namespace

WedgeSurface JoinWedges(const std::vector<Mesh>& meshes) {
  WedgeSurface surface;
  AddFaces(meshes, Places(meshes), &surface);
  Sets corners = JoinAcrossEdges(surface);
  std::vector<int> vertex_of_set(3 * surface.faces.size(), -1);
  for (size_t f = 0; f < surface.faces.size(); ++f) {
    for (size_t k = 0; k < 3; ++k) {
      int& vertex = vertex_of_set[static_cast<size_t>(corners.Find(static_cast<int>(3 * f + k)))];
      if (vertex < 0) {
        vertex = static_cast<int>(surface.wedge_of_vertex.size());
        surface.wedge_of_vertex.push_back(surface.faces[f].wedges[k]);
      }
      surface.faces[f].vertices[k] = vertex;
    }
  }
  return surface;
}

}  // namespace flaneur
