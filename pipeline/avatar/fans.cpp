#include "pipeline/avatar/fans.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace flaneur {
namespace {

constexpr size_t kMostAtEdge = 16;  // faces; where more meet none goes on

// A corner of a face, 3 * face + 0, 1 or 2, and the side that starts there.
using Corner = size_t;

Corner Next(Corner c) { return c % 3 == 2 ? c - 2 : c + 1; }

class FanFinder {
 public:
  explicit FanFinder(const WedgeSurface& surface)
      : surface_(surface), edge_of_(3 * surface.faces.size()), joined_(edge_of_.size()), parents_(edge_of_.size()) {
    std::iota(edge_of_.begin(), edge_of_.end(), Corner{0});
    std::iota(parents_.begin(), parents_.end(), Corner{0});
    std::map<std::pair<int, int>, std::vector<Corner>> sides;
    for (Corner c = 0; c < edge_of_.size(); ++c) sides[std::minmax(Vertex(c), Vertex(Next(c)))].push_back(c);
    for (const auto& [ends, at_edge] : sides) JoinSides(at_edge);
  }

  std::vector<std::array<int, 3>> Fans() {
    std::vector<std::array<int, 3>> fans(surface_.faces.size());
    for (Corner c = 0; c < parents_.size(); ++c) fans[c / 3][c % 3] = static_cast<int>(Root(c));
    // One edge between two fans: a face with a second one is a fan by itself.
    std::map<std::pair<int, int>, Corner> known;
    auto number = static_cast<int>(parents_.size());
    for (size_t f = 0; f < fans.size(); ++f) {
      bool second = false;
      for (Corner c = 3 * f; c < 3 * f + 3; ++c) {
        const std::pair<int, int> ends = std::minmax(fans[f][c % 3], fans[f][Next(c) % 3]);
        second = known.try_emplace(ends, edge_of_[c]).first->second != edge_of_[c] || second;
      }
      for (size_t k = 0; k < 3 && second; ++k) fans[f][k] = number++;
    }
    return fans;
  }

 private:
  int Vertex(Corner c) const { return surface_.faces[c / 3].vertices[c % 3]; }
  Vec3 Position(Corner c) const { return surface_.vertices[static_cast<size_t>(Vertex(c))].position; }

  Vec3 Normal(Corner c) const {
    return Normalized(Cross(Position(Next(c)) - Position(c), Position(Next(Next(c))) - Position(c)));
  }

  Corner Root(Corner c) {
    while (parents_[c] != c) c = parents_[c] = parents_[parents_[c]];
    return c;
  }

  struct Pair {
    float cosine;  // between their faces
    Corner a, b;
  };

  void JoinSides(const std::vector<Corner>& sides) {
    if (sides.size() > kMostAtEdge) return;
    std::vector<Pair> pairs;
    for (size_t i = 0; i < sides.size(); ++i) {
      for (size_t j = i + 1; j < sides.size(); ++j) {
        const Corner a = sides[i], b = sides[j];
        const bool back = Vertex(Next(Next(a))) == Vertex(Next(Next(b)));
        if (Vertex(a) == Vertex(Next(b)) && !back) pairs.push_back({Dot(Normal(a), Normal(b)), a, b});
      }
    }
    std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& p, const Pair& q) { return p.cosine > q.cosine; });
    for (const auto& [cosine, a, b] : pairs) {
      if (joined_[a] || joined_[b]) continue;
      joined_[a] = joined_[b] = true;
      edge_of_[b] = edge_of_[a];
      parents_[Root(a)] = Root(Next(b));
      parents_[Root(Next(a))] = Root(b);
    }
  }

  const WedgeSurface& surface_;
  std::vector<Corner> edge_of_;  // by side: the same for two that are joined
  std::vector<bool> joined_;     // by side
  std::vector<Corner> parents_;
};

}  // namespace

std::vector<std::array<int, 3>> FansOf(const WedgeSurface& surface) { return FanFinder(surface).Fans(); }

}  // namespace flaneur
