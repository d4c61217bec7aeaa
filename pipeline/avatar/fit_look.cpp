#include "pipeline/avatar/fit_look.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "pipeline/avatar/surface_distance.h"
#include "pipeline/avatar/surface_places.h"
#include "pipeline/avatar/threads.h"

namespace flaneur {

// One mesh of the original; points of the level look at the same mesh only.
struct LookOriginal {
  const Mesh* mesh = nullptr;
  Triangles triangles;
  std::unique_ptr<SurfaceTree> tree;  // none without triangles
};

namespace {

constexpr float kSameSide = 0.3f;     // cosine between normals of places that belong together
constexpr float kSameNormal = 0.98f;  // cosine; nearer ones at one vertex are one normal
constexpr float kSameColor = 0.01f;
constexpr float kInertia = 0.03f;     // of what a corner has, against what it is tied to

// What a point of the level should look like.
struct Tie {
  std::array<int, 3> wedges{};
  std::array<float, 3> shares{};
  Vec3 normal;
  Vec4 color;
  bool counts = false;
};

template <typename Value>
Value Mixed(const std::vector<Value>& values, const uint32_t* corners, const std::array<float, 3>& shares) {
  return values[corners[0]] * shares[0] + values[corners[1]] * shares[1] + values[corners[2]] * shares[2];
}

// `there`: the triangle that the place is in.
Tie TieOf(const WedgeSurface& level, const std::vector<LookOriginal>& originals, const Place& place, const std::array<Vec3, 3>& there) {
  const WedgeSurface::Face& face = level.faces[place.triangle];
  Tie tie{face.wedges, place.shares, {}, {}, false};
  const LookOriginal& original = originals[static_cast<size_t>(level.wedges[static_cast<size_t>(face.wedges[0])].mesh)];
  if (!original.tree) return tie;
  const auto found = original.tree->Find(At(there, place.shares));
  if (!(Dot(FaceNormal(original.triangles[found.triangle]), FaceNormal(there)) > kSameSide)) return tie;
  const uint32_t* corners = &original.mesh->indices[size_t{3} * found.triangle];
  if (!original.mesh->normals.empty()) tie.normal = Normalized(Mixed(original.mesh->normals, corners, found.shares));
  if (!original.mesh->colors.empty()) tie.color = Mixed(original.mesh->colors, corners, found.shares);
  tie.counts = true;
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
        if (number < 0 && alike(wedge, level.wedges[static_cast<size_t>(other)])) number = numbers[static_cast<size_t>(other)];
      }
      if (number < 0) number = next++;
      others.push_back(face.wedges[k]);
    }
  }
  return numbers;
}

// Values at the corners that, mixed by their shares, come nearest to the ties' wanted ones: solved one after the other, in rounds.
template <typename Value>
void Solve(const std::vector<Tie>& ties, const std::vector<int>& numbers, Value Tie::* wanted, int rounds, std::vector<Value>* values) {
  std::vector<std::vector<std::pair<uint32_t, uint32_t>>> pulls(values->size());  // tie and corner
  std::vector<Value> left(ties.size());
  const auto value_of = [&](const Tie& tie, size_t k) -> Value& {
    return (*values)[static_cast<size_t>(numbers[static_cast<size_t>(tie.wedges[k])])];
  };
  for (size_t i = 0; i < ties.size(); ++i) {
    if (!ties[i].counts) continue;
    left[i] = ties[i].*wanted;
    for (uint32_t k = 0; k < 3; ++k) {
      left[i] = left[i] - value_of(ties[i], k) * ties[i].shares[k];
      pulls[static_cast<size_t>(numbers[static_cast<size_t>(ties[i].wedges[k])])].push_back({static_cast<uint32_t>(i), k});
    }
  }
  const std::vector<Value> before = *values;
  for (int round = 0; round < rounds; ++round) {
    for (size_t v = 0; v < values->size(); ++v) {
      float weight = 0;
      Value sum{};
      for (const auto& [i, k] : pulls[v]) {
        const float share = ties[i].shares[k];
        sum = sum + left[i] * share;
        weight += share * share;
      }
      if (!(weight > 0)) continue;
      const float inertia = kInertia * weight;
      const Value step = (sum + (before[v] - (*values)[v]) * inertia) * (1 / (weight + inertia));
      (*values)[v] = (*values)[v] + step;
      for (const auto& [i, k] : pulls[v]) left[i] = left[i] - step * ties[i].shares[k];
    }
  }
}

template <typename Value>
std::vector<Value> ValuesOf(const WedgeSurface& level, const std::vector<int>& numbers, Value WedgeSurface::Wedge::* member) {
  std::vector<Value> values(numbers.size());
  for (size_t w = 0; w < numbers.size(); ++w) {
    if (numbers[w] >= 0) values[static_cast<size_t>(numbers[w])] = level.wedges[w].*member;
  }
  return values;
}

}  // namespace

LookFitter::LookFitter(const std::vector<Mesh>& original, const LookOptions& options) : options_(options) {
  for (const Mesh& mesh : original) {
    LookOriginal& one = originals_.emplace_back(LookOriginal{&mesh, PosedTriangles({mesh}, nullptr), nullptr});
    if (!one.triangles.empty()) one.tree = std::make_unique<SurfaceTree>(one.triangles);
  }
}

LookFitter::~LookFitter() = default;

void LookFitter::Fit(WedgeSurface* level) const {
  if (2 * level->faces.size() > static_cast<size_t>(options_.samples)) return;
  const Triangles triangles = BindTriangles(*level);
  const std::vector<Place> places = SpreadPlaces(triangles, options_.samples);
  std::vector<Tie> ties(places.size());
  RunOnThreads([&](size_t first, size_t step) {
    for (size_t i = first; i < ties.size(); i += step) ties[i] = TieOf(*level, originals_, places[i], triangles[places[i].triangle]);
  });
  using Wedge = WedgeSurface::Wedge;
  const std::vector<int> normal_of = Alike(*level, [](const Wedge& a, const Wedge& b) { return Dot(a.normal, b.normal) > kSameNormal; });
  std::vector<Vec3> normals = ValuesOf(*level, normal_of, &Wedge::normal);
  Solve(ties, normal_of, &Tie::normal, options_.rounds, &normals);
  const std::vector<int> color_of = Alike(*level, [](const Wedge& a, const Wedge& b) {
    const Vec4 d = a.color - b.color;
    return std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z), std::abs(d.w)}) < kSameColor;
  });
  std::vector<Vec4> colors = ValuesOf(*level, color_of, &Wedge::color);
  Solve(ties, color_of, &Tie::color, options_.rounds, &colors);
  for (size_t w = 0; w < level->wedges.size(); ++w) {
    if (normal_of[w] < 0) continue;
    Wedge& wedge = level->wedges[w];
    const Vec3 normal = Normalized(normals[static_cast<size_t>(normal_of[w])]);
    if (Length(wedge.normal) > 0 && Length(normal) > 0) wedge.normal = normal;
    const Vec4 c = colors[static_cast<size_t>(color_of[w])];
    const auto unit = [](float v) { return std::clamp(v, 0.0f, 1.0f); };
    wedge.color = {unit(c.x), unit(c.y), unit(c.z), unit(c.w)};
  }
}

}  // namespace flaneur
