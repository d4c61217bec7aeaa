#include "pipeline/avatar/wedge_surface.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>

#include "pipeline/core/avatar.h"

namespace flaneur {
namespace {

constexpr float kSamePlace_m = 2e-5f;
constexpr float kSameUv = 1e-4f;  // uvs nearer than this are no seam
constexpr float kSameColor = 0.02f;
constexpr float kSamePosedPlace_m = 1e-4f;
constexpr float kCell_m = 1e-3f;  // much larger than kSamePlace_m: few corners lie near two cells

uint64_t CellKey(int64_t x, int64_t y, int64_t z) {
  const auto mixed = [](int64_t v, uint64_t prime) { return static_cast<uint64_t>(v) * prime; };
  return mixed(x, 0x9E3779B97F4A7C15u) ^ mixed(y, 0xC2B2AE3D27D4EB4Fu) ^ mixed(z, 0x165667B19E3779F9u);
}

int64_t Cell(float v) { return static_cast<int64_t>(std::floor(v / kCell_m)); }

// Finds vertices that are at one place in the bind pose and in the others.
class Joiner {
 public:
  explicit Joiner(size_t poses) : posed_(poses) {}

  // The vertex at these places, -1: none yet.
  int Find(Vec3 p, const std::vector<Vec3>& posed) const {
    const auto first = [](float v) { return Cell(v - kSamePlace_m); };
    const auto last = [](float v) { return Cell(v + kSamePlace_m); };
    for (int64_t x = first(p.x); x <= last(p.x); ++x) {
      for (int64_t y = first(p.y); y <= last(p.y); ++y) {
        for (int64_t z = first(p.z); z <= last(p.z); ++z) {
          const auto cell = newest_.find(CellKey(x, y, z));
          for (int v = cell == newest_.end() ? -1 : cell->second; v >= 0; v = older_[static_cast<size_t>(v)]) {
            if (Same(static_cast<size_t>(v), p, posed)) return v;
          }
        }
      }
    }
    return -1;
  }

  void Add(Vec3 p, const std::vector<Vec3>& posed) {
    const auto [cell, is_new] = newest_.try_emplace(CellKey(Cell(p.x), Cell(p.y), Cell(p.z)), -1);
    older_.push_back(cell->second);
    cell->second = static_cast<int>(positions_.size());
    positions_.push_back(p);
    for (size_t k = 0; k < posed_.size(); ++k) posed_[k].push_back(posed[k]);
  }

 private:
  bool Same(size_t v, Vec3 p, const std::vector<Vec3>& posed) const {
    if (Length(positions_[v] - p) > kSamePlace_m) return false;
    for (size_t k = 0; k < posed_.size(); ++k) {
      if (Length(posed_[k][v] - posed[k]) > kSamePosedPlace_m) return false;
    }
    return true;
  }

  std::unordered_map<uint64_t, int> newest_;  // vertex by cell
  std::vector<int> older_;                    // the vertex before it in the same cell, -1: none
  std::vector<Vec3> positions_;
  std::vector<std::vector<Vec3>> posed_;
};

WedgeSurface::Wedge WedgeOf(const Mesh& mesh, int index, size_t v) {
  WedgeSurface::Wedge wedge;
  wedge.mesh = index;
  if (!mesh.normals.empty()) wedge.normal = mesh.normals[v];
  if (!mesh.uvs.empty()) wedge.uv = mesh.uvs[v];
  if (!mesh.uvs1.empty()) wedge.uv1 = mesh.uvs1[v];
  if (!mesh.colors.empty()) wedge.color = mesh.colors[v];
  return wedge;
}

// The vertex of each corner; wedges are the meshes' own vertices, one after the other.
std::vector<int> AddVertices(const std::vector<Mesh>& meshes, const std::vector<std::vector<Mat4>>& poses,
                             WedgeSurface* surface) {
  Joiner joiner(poses.size());
  std::vector<int> vertices;
  std::vector<Vec3> posed(poses.size());
  for (size_t m = 0; m < meshes.size(); ++m) {
    const Mesh& mesh = meshes[m];
    Mesh shape;
    shape.positions = mesh.positions;
    shape.joints = mesh.joints;
    shape.weights = mesh.weights;
    std::vector<Mesh> skinned;
    for (const auto& matrices : poses) skinned.push_back(Skinned(shape, matrices));
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
      for (size_t k = 0; k < poses.size(); ++k) posed[k] = skinned[k].positions[v];
      int vertex = joiner.Find(mesh.positions[v], posed);
      if (vertex < 0) {
        vertex = static_cast<int>(surface->vertices.size());
        joiner.Add(mesh.positions[v], posed);
        WedgeSurface::Vertex added{mesh.positions[v], {}, {}};
        if (mesh.joints.size() == mesh.positions.size()) {
          added.joints = mesh.joints[v];
          added.weights = mesh.weights[v];
        }
        surface->vertices.push_back(added);
      }
      vertices.push_back(vertex);
      surface->wedges.push_back(WedgeOf(mesh, static_cast<int>(m), v));
    }
  }
  return vertices;
}

bool operator==(const Vec2& a, const Vec2& b) { return a.x == b.x && a.y == b.y; }

bool Same(const WedgeSurface::Wedge& a, const WedgeSurface::Wedge& b) {
  return a.mesh == b.mesh && a.uv == b.uv && a.uv1 == b.uv1 && Length(a.normal - b.normal) < 1e-4f &&
         a.color.x == b.color.x && a.color.y == b.color.y && a.color.z == b.color.z && a.color.w == b.color.w;
}

template <typename T, typename From>
void Append(const std::vector<From>& like, T value, std::vector<T>* to) {
  if (!like.empty()) to->push_back(value);
}

}  // namespace

bool NoSeam(const WedgeSurface::Wedge& a, const WedgeSurface::Wedge& b) {
  return a.mesh == b.mesh && Length(a.uv - b.uv) < kSameUv &&
         std::max({std::abs(a.color.x - b.color.x), std::abs(a.color.y - b.color.y), std::abs(a.color.z - b.color.z)}) <
             kSameColor;
}

WedgeSurface::Wedge Mix(const WedgeSurface::Wedge& a, const WedgeSurface::Wedge& b, float t) {
  WedgeSurface::Wedge out = a;
  out.normal = Normalized(a.normal * (1 - t) + b.normal * t);
  if (!(Length(out.normal) > 0.5f)) out.normal = a.normal;
  out.uv = a.uv * (1 - t) + b.uv * t;
  out.uv1 = a.uv1 * (1 - t) + b.uv1 * t;
  out.color = {a.color.x + t * (b.color.x - a.color.x), a.color.y + t * (b.color.y - a.color.y),
               a.color.z + t * (b.color.z - a.color.z), a.color.w + t * (b.color.w - a.color.w)};
  return out;
}

float WeightDifference(const WedgeSurface::Vertex& a, const WedgeSurface::Vertex& b) {
  float sum = 0;
  for (size_t i = 0; i < 4; ++i) {
    float in_b = 0;
    for (size_t k = 0; k < 4; ++k) {
      if (b.joints[k] == a.joints[i]) in_b += b.weights[k];
    }
    sum += std::max(a.weights[i] - in_b, 0.0f);
  }
  return 2 * sum;
}

void MixWeights(const WedgeSurface::Vertex& b, float t, WedgeSurface::Vertex* a) {
  std::map<uint16_t, float> sums;
  for (size_t i = 0; i < 4; ++i) sums[a->joints[i]] += (1 - t) * a->weights[i];
  for (size_t i = 0; i < 4; ++i) sums[b.joints[i]] += t * b.weights[i];
  std::vector<std::pair<uint16_t, float>> all(sums.begin(), sums.end());
  std::stable_sort(all.begin(), all.end(), [](const auto& x, const auto& y) { return x.second > y.second; });
  all.resize(4);
  const float sum = all[0].second + all[1].second + all[2].second + all[3].second;
  for (size_t i = 0; i < 4; ++i) {
    const bool used = all[i].second > 0;
    a->weights[i] = used ? all[i].second / sum : 0;
    a->joints[i] = used ? all[i].first : uint16_t{0};
  }
}

WedgeSurface JoinWedges(const std::vector<Mesh>& meshes, const std::vector<std::vector<Mat4>>& poses) {
  WedgeSurface surface;
  const std::vector<int> vertices = AddVertices(meshes, poses, &surface);
  const std::vector<int> charts = ChartsOf(meshes);
  for (size_t w = 0; w < charts.size(); ++w) surface.wedges[w].chart = charts[w];
  std::set<std::array<int, 3>> known;
  int base = 0;
  for (const Mesh& mesh : meshes) {
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      WedgeSurface::Face face;
      for (size_t k = 0; k < 3; ++k) {
        face.wedges[k] = base + static_cast<int>(mesh.indices[i + k]);
        face.vertices[k] = vertices[static_cast<size_t>(face.wedges[k])];
      }
      std::array<int, 3> turned = face.vertices;
      if (turned[0] == turned[1] || turned[1] == turned[2] || turned[2] == turned[0]) continue;
      std::rotate(turned.begin(), std::min_element(turned.begin(), turned.end()), turned.end());
      if (known.insert(turned).second) surface.faces.push_back(face);
    }
    base += static_cast<int>(mesh.positions.size());
  }
  return surface;
}

std::vector<int> ChartsOf(const std::vector<Mesh>& meshes) {
  std::vector<int> charts;
  for (const Mesh& mesh : meshes) {
    const auto base = static_cast<int>(charts.size());
    for (size_t v = 0; v < mesh.positions.size(); ++v) charts.push_back(base + static_cast<int>(v));
    const auto root = [&](uint32_t vertex) {
      auto v = static_cast<size_t>(base) + vertex;
      while (charts[v] != static_cast<int>(v)) {
        charts[v] = charts[static_cast<size_t>(charts[v])];
        v = static_cast<size_t>(charts[v]);
      }
      return static_cast<int>(v);
    };
    const auto join = [&](uint32_t v, uint32_t w) { charts[static_cast<size_t>(root(v))] = root(w); };
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      join(mesh.indices[i], mesh.indices[i + 1]);
      join(mesh.indices[i + 1], mesh.indices[i + 2]);
    }
    std::map<std::array<float, 5>, uint32_t> known;  // vertices that differ by their normal alone go on
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
      const Vec3 p = mesh.positions[v];
      const Vec2 uv = mesh.uvs.empty() ? Vec2{} : mesh.uvs[v];
      join(v, known.try_emplace({p.x, p.y, p.z, uv.x, uv.y}, v).first->second);
    }
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) charts[static_cast<size_t>(base) + v] = root(v);
  }
  return charts;
}

std::vector<Mesh> SplitWedges(const WedgeSurface& surface, const std::vector<Mesh>& like) {
  std::vector<Mesh> out(like.size());
  for (size_t m = 0; m < like.size(); ++m) {
    out[m].name = like[m].name;
    out[m].material = like[m].material;
  }
  struct Made {
    int wedge = 0;
    uint32_t index = 0;
  };
  std::vector<std::vector<Made>> made(surface.vertices.size());
  for (const WedgeSurface::Face& face : surface.faces) {
    for (size_t k = 0; k < 3; ++k) {
      const auto vertex = static_cast<size_t>(face.vertices[k]);
      const WedgeSurface::Wedge& wedge = surface.wedges[static_cast<size_t>(face.wedges[k])];
      Mesh& to = out[static_cast<size_t>(wedge.mesh)];
      const Mesh& from = like[static_cast<size_t>(wedge.mesh)];
      auto found = std::find_if(made[vertex].begin(), made[vertex].end(), [&](const Made& m) {
        return Same(surface.wedges[static_cast<size_t>(m.wedge)], wedge);
      });
      if (found == made[vertex].end()) {
        made[vertex].push_back({face.wedges[k], static_cast<uint32_t>(to.positions.size())});
        found = made[vertex].end() - 1;
        to.positions.push_back(surface.vertices[vertex].position);
        Append(from.joints, surface.vertices[vertex].joints, &to.joints);
        Append(from.weights, surface.vertices[vertex].weights, &to.weights);
        Append(from.normals, wedge.normal, &to.normals);
        Append(from.uvs, wedge.uv, &to.uvs);
        Append(from.uvs1, wedge.uv1, &to.uvs1);
        Append(from.colors, wedge.color, &to.colors);
      }
      to.indices.push_back(found->index);
    }
  }
  return out;
}

}  // namespace flaneur
