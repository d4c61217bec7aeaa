#include "pipeline/avatar/fit_look.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "pipeline/avatar/in_strides.h"
#include "pipeline/avatar/surface_distance.h"
#include "pipeline/avatar/surface_places.h"

namespace flaneur {

// One mesh of the original; points of the level look at the same mesh only.
struct LookOriginal {
  const Mesh* mesh = nullptr;
  Triangles triangles;
  std::unique_ptr<SurfaceTree> tree;  // none without triangles
  std::vector<int> charts;            // by vertex
};

namespace {

constexpr float kSameSide = 0.3f;     // cosine between normals of places that belong together
constexpr float kSameNormal = 0.98f;  // cosine; nearer ones at one vertex are one normal
constexpr size_t kSamplesAFace = 7, kMinSamples = 6000;
constexpr size_t kBlock = 256;  // places on one thread
constexpr float kSameColor = 0.01f;
constexpr float kSameUv = 1e-4f;
constexpr float kFarthest_m = 0.06f;  // of where a picture has drifted to; farther off is beyond a seam
constexpr float kInertia = 0.01f;     // of what a corner has, against what it is tied to

// What a point of the level should look like.
struct Tie {
  std::array<int, 3> wedges{};
  std::array<float, 3> shares{};
  Vec3 normal;
  Vec4 color;
  Vec2 uv;
  bool counts = false, has_uv = false;
};

template <typename Value>
Value Mixed(const std::vector<Value>& values, const uint32_t* corners, const std::array<float, 3>& shares) {
  return values[corners[0]] * shares[0] + values[corners[1]] * shares[1] + values[corners[2]] * shares[2];
}

// The longest way on the triangle, per length of uv.
float MetresOfUv(const std::array<Vec3, 3>& triangle, const std::vector<Vec2>& uvs, const uint32_t* corners) {
  float metres = 0, uv = 0;
  for (size_t k = 0; k < 3; ++k) {
    metres = std::max(metres, Length(triangle[(k + 1) % 3] - triangle[k]));
    uv = std::max(uv, Length(uvs[corners[(k + 1) % 3]] - uvs[corners[k]]));
  }
  return uv > 0 ? metres / uv : 0;
}

// `there`: the triangle that the place is in. `guesses`: by mesh, of where the nearest place is.
Tie TieOf(const WedgeSurface& level, const std::vector<LookOriginal>& originals, const SurfacePlace& place,
          const std::array<Vec3, 3>& there, std::vector<uint32_t>* guesses) {
  const WedgeSurface::Face& face = level.faces[place.triangle];
  Tie tie{face.wedges, place.shares, {}, {}, {}, false, false};
  const auto wedge = [&](size_t k) -> const WedgeSurface::Wedge& {
    return level.wedges[static_cast<size_t>(face.wedges[k])];
  };
  const LookOriginal& original = originals[static_cast<size_t>(wedge(0).mesh)];
  if (!original.tree) return tie;
  uint32_t& guess = (*guesses)[static_cast<size_t>(wedge(0).mesh)];
  const auto found = original.tree->Find(At(there, place.shares), guess);
  guess = found.triangle;
  if (!(Dot(FaceNormal(original.triangles[found.triangle]), FaceNormal(there)) > kSameSide)) return tie;
  const uint32_t* corners = &original.mesh->indices[size_t{3} * found.triangle];
  if (!original.mesh->normals.empty()) tie.normal = Normalized(Mixed(original.mesh->normals, corners, found.shares));
  if (!original.mesh->colors.empty()) tie.color = Mixed(original.mesh->colors, corners, found.shares);
  tie.counts = true;
  if (original.mesh->uvs.empty() || original.charts[corners[0]] != wedge(0).chart) return tie;
  tie.uv = Mixed(original.mesh->uvs, corners, found.shares);
  const Vec2 now = wedge(0).uv * place.shares[0] + wedge(1).uv * place.shares[1] + wedge(2).uv * place.shares[2];
  tie.has_uv =
      Length(tie.uv - now) * MetresOfUv(original.triangles[found.triangle], original.mesh->uvs, corners) < kFarthest_m;
  return tie;
}

// A number for each wedge: the same for those of one vertex that are alike.
std::vector<int> Alike(const WedgeSurface& level, auto alike) {
  std::vector<std::vector<int>> of_vertex(level.vertices.size());
  std::vector<int> numbers(level.wedges.size(), -1);
  int next = 0;
  for (const auto& face : level.faces) {
    for (size_t k = 0; k < 3; ++k) {
      int& number = numbers[static_cast<size_t>(face.wedges[k])];
      if (number >= 0) continue;
      auto& others = of_vertex[static_cast<size_t>(face.vertices[k])];
      const WedgeSurface::Wedge& wedge = level.wedges[static_cast<size_t>(face.wedges[k])];
      for (const int other : others) {
        if (number < 0 && alike(wedge, level.wedges[static_cast<size_t>(other)]))
          number = numbers[static_cast<size_t>(other)];
      }
      if (number < 0) number = next++;
      others.push_back(face.wedges[k]);
    }
  }
  return numbers;
}

// The corners of ties that pull at each value, one value after the other.
struct Pulls {
  struct Corner {
    uint32_t tie;
    float share;
  };
  std::vector<size_t> first;  // by value, and the end
  std::vector<Corner> corners;
};

Pulls PullsOf(const std::vector<Tie>& ties, bool Tie::*counts, const std::vector<int>& numbers) {
  Pulls pulls;
  pulls.first.resize(numbers.size() + 2);
  const auto each = [&](auto visit) {
    for (size_t i = 0; i < ties.size(); ++i) {
      for (size_t k = 0; k < 3 && ties[i].*counts; ++k) {
        visit(i, k, static_cast<size_t>(numbers[static_cast<size_t>(ties[i].wedges[k])]));
      }
    }
  };
  each([&](size_t, size_t, size_t value) { ++pulls.first[value + 2]; });
  for (size_t v = 2; v < pulls.first.size(); ++v) pulls.first[v] += pulls.first[v - 1];
  pulls.corners.resize(pulls.first.back());
  each([&](size_t i, size_t k, size_t value) {
    pulls.corners[pulls.first[value + 1]++] = {static_cast<uint32_t>(i), ties[i].shares[k]};
  });
  return pulls;
}

// Values at the corners that, mixed by their shares, come nearest to the ties' wanted ones: solved one after the other,
// in rounds.
template <typename Value>
void Solve(const std::vector<Tie>& ties, bool Tie::*counts, const std::vector<int>& numbers, Value Tie::*wanted,
           int rounds, std::vector<Value>* values) {
  const Pulls pulls = PullsOf(ties, counts, numbers);
  std::vector<Value> left(ties.size());
  for (size_t i = 0; i < ties.size(); ++i) left[i] = ties[i].*wanted;
  for (size_t v = 0; v < values->size(); ++v) {
    for (size_t p = pulls.first[v]; p < pulls.first[v + 1]; ++p) {
      const auto [i, share] = pulls.corners[p];
      left[i] = left[i] - (*values)[v] * share;
    }
  }
  const std::vector<Value> before = *values;
  for (int round = 0; round < rounds; ++round) {
    for (size_t v = 0; v < values->size(); ++v) {
      float weight = 0;
      Value sum{};
      for (size_t p = pulls.first[v]; p < pulls.first[v + 1]; ++p) {
        const auto [i, share] = pulls.corners[p];
        sum = sum + left[i] * share;
        weight += share * share;
      }
      if (!(weight > 0)) continue;
      const float inertia = kInertia * weight;
      const Value step = (sum + (before[v] - (*values)[v]) * inertia) * (1 / (weight + inertia));
      (*values)[v] = (*values)[v] + step;
      for (size_t p = pulls.first[v]; p < pulls.first[v + 1]; ++p) {
        const auto [i, share] = pulls.corners[p];
        left[i] = left[i] - step * share;
      }
    }
  }
}

template <typename Value>
std::vector<Value> ValuesOf(const WedgeSurface& level, const std::vector<int>& numbers,
                            Value WedgeSurface::Wedge::*member) {
  std::vector<Value> values(numbers.size());
  for (size_t w = 0; w < numbers.size(); ++w) {
    if (numbers[w] >= 0) values[static_cast<size_t>(numbers[w])] = level.wedges[w].*member;
  }
  return values;
}

Vec2 Within(const ChartBounds& bounds, Vec2 uv) {
  return {std::max(bounds.min.x, std::min(uv.x, bounds.max.x)), std::max(bounds.min.y, std::min(uv.y, bounds.max.y))};
}

}  // namespace

LookFitter::LookFitter(const std::vector<Mesh>& original, const LookOptions& options) : options_(options) {
  const std::vector<int> charts = ChartsOf(original);
  bounds_.resize(charts.size());
  auto first = charts.begin();
  for (const Mesh& mesh : original) {
    LookOriginal& one = originals_.emplace_back(LookOriginal{&mesh, PosedTriangles({mesh}, nullptr), nullptr, {}});
    colored_ = colored_ || !mesh.colors.empty();
    if (!one.triangles.empty()) one.tree = std::make_unique<SurfaceTree>(one.triangles);
    const auto end = first + static_cast<std::ptrdiff_t>(mesh.positions.size());
    one.charts.assign(first, end);
    first = end;
    for (size_t v = 0; v < mesh.uvs.size(); ++v) {
      ChartBounds& bounds = bounds_[static_cast<size_t>(one.charts[v])];
      const Vec2 uv = mesh.uvs[v];
      bounds.min = {std::min(bounds.min.x, uv.x), std::min(bounds.min.y, uv.y)};
      bounds.max = {std::max(bounds.max.x, uv.x), std::max(bounds.max.y, uv.y)};
    }
  }
}

LookFitter::~LookFitter() = default;

void LookFitter::Fit(WedgeSurface* level) const {
  if (2 * level->faces.size() > static_cast<size_t>(options_.samples)) return;
  const Triangles triangles = BindTriangles(*level);
  const size_t samples =
      std::min(std::max(kSamplesAFace * triangles.size(), kMinSamples), static_cast<size_t>(options_.samples));
  const std::vector<SurfacePlace> places = SpreadPlaces(triangles, static_cast<int>(samples));
  std::vector<Tie> ties(places.size());
  InStrides(options_.jobs, [&](size_t first, size_t step) {
    // In blocks that do not depend on the number of threads: of equal distances a guess decides.
    for (size_t start = first * kBlock; start < ties.size(); start += step * kBlock) {
      std::vector<uint32_t> guesses(originals_.size(), 0);
      for (size_t i = start; i < std::min(start + kBlock, ties.size()); ++i) {
        ties[i] = TieOf(*level, originals_, places[i], triangles[places[i].triangle], &guesses);
      }
    }
  });
  using Wedge = WedgeSurface::Wedge;
  const std::vector<int> normal_of =
      Alike(*level, [](const Wedge& a, const Wedge& b) { return Dot(a.normal, b.normal) > kSameNormal; });
  std::vector<Vec3> normals = ValuesOf(*level, normal_of, &Wedge::normal);
  Solve(ties, &Tie::counts, normal_of, &Tie::normal, options_.rounds, &normals);
  const std::vector<int> color_of = Alike(*level, [](const Wedge& a, const Wedge& b) {
    const Vec4 d = a.color - b.color;
    return std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z), std::abs(d.w)}) < kSameColor;
  });
  std::vector<Vec4> colors = ValuesOf(*level, color_of, &Wedge::color);
  if (colored_) Solve(ties, &Tie::counts, color_of, &Tie::color, options_.rounds, &colors);
  const std::vector<int> uv_of =
      Alike(*level, [](const Wedge& a, const Wedge& b) { return a.chart == b.chart && Length(a.uv - b.uv) < kSameUv; });
  std::vector<Vec2> uvs = ValuesOf(*level, uv_of, &Wedge::uv);
  Solve(ties, &Tie::has_uv, uv_of, &Tie::uv, options_.rounds, &uvs);
  for (size_t w = 0; w < level->wedges.size(); ++w) {
    if (normal_of[w] < 0) continue;
    Wedge& wedge = level->wedges[w];
    const Vec3 normal = Normalized(normals[static_cast<size_t>(normal_of[w])]);
    if (Length(wedge.normal) > 0 && Length(normal) > 0) wedge.normal = normal;
    const Vec4 c = colors[static_cast<size_t>(color_of[w])];
    const auto unit = [](float v) { return std::clamp(v, 0.0f, 1.0f); };
    if (wedge.chart >= 0)
      wedge.uv = Within(bounds_[static_cast<size_t>(wedge.chart)], uvs[static_cast<size_t>(uv_of[w])]);
    wedge.color = {unit(c.x), unit(c.y), unit(c.z), unit(c.w)};
  }
}

}  // namespace flaneur
