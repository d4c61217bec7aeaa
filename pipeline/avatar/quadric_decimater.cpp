#include "pipeline/avatar/quadric_decimater.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <queue>

#include "pipeline/avatar/posed_quadric.h"
#include "pipeline/avatar/threads.h"

namespace flaneur {
namespace {

using Face = WedgeSurface::Face;
using Wedge = WedgeSurface::Wedge;

constexpr double kBorderWeight = 1;   // of an open border's planes, against those of faces
constexpr double kSeamWeight = 0.03;  // of a seam's
constexpr double kStretch = 0.2;  // a picture shifted by a length costs as much as this share of it
constexpr double kSpring = 1e-6;  // towards the edge, where planes leave a vertex free
constexpr double kLengthCost =
    1e-9;                           // of an edge's squared length: decides where all else is equal
constexpr double kReach = 2;        // of an edge's length: so far may its vertex move from it
constexpr double kLeastTurn = 0.2;  // cosine; a face that turns further is taken to fold over
constexpr double kFold = -0.95;     // cosine between faces: a sheet that is seen from both sides
constexpr float kSameUv = 1e-4f;    // uvs nearer than this are no seam
constexpr float kSameColor = 0.02f;
constexpr float kSameWeights = 0.02f;  // sum of differences
constexpr int kTries = 2000;  // collapses looked at for one that hits the number of triangles

// Wedges at one vertex that only differ by their normal: a crease, but no seam.
bool NoSeam(const Wedge& a, const Wedge& b) {
  return a.mesh == b.mesh && Length(a.uv - b.uv) < kSameUv &&
         std::max({std::abs(a.color.x - b.color.x), std::abs(a.color.y - b.color.y),
                   std::abs(a.color.z - b.color.z)}) < kSameColor;
}

Wedge Mix(const Wedge& a, const Wedge& b, float t) {
  Wedge out = a;
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

// The four heaviest of the two together.
void MixWeights(const WedgeSurface::Vertex& b, float t, WedgeSurface::Vertex* a) {
  std::array<std::pair<float, uint16_t>, 8> all{};
  size_t count = 0;
  const auto add = [&](uint16_t joint, float weight) {
    if (!(weight > 0)) return;
    for (size_t i = 0; i < count; ++i) {
      if (all[i].second != joint) continue;
      all[i].first += weight;
      return;
    }
    all[count++] = {weight, joint};
  };
  for (size_t i = 0; i < 4; ++i) add(a->joints[i], (1 - t) * a->weights[i]);
  for (size_t i = 0; i < 4; ++i) add(b.joints[i], t * b.weights[i]);
  std::stable_sort(all.begin(), all.end(), [](auto x, auto y) {
    return x.first != y.first ? x.first > y.first : x.second < y.second;
  });
  float sum = 0;
  for (size_t i = 0; i < std::min<size_t>(count, 4); ++i) sum += all[i].first;
  for (size_t i = 0; i < 4; ++i) {
    const bool used = i < count && sum > 0;
    a->weights[i] = used ? all[i].first / sum : 0;
    a->joints[i] = used ? all[i].second : uint16_t{0};
  }
}

struct Collapse {
  double cost = 0;
  int a = 0, b = 0;  // a stays
  uint32_t stamp_a = 0, stamp_b = 0;
  bool operator<(const Collapse& other) const {  // the cheapest is the greatest
    if (cost != other.cost) return cost > other.cost;
    return a != other.a ? a > other.a : b > other.b;
  }
};

struct Placement {
  double cost = 1e300;
  DVec3 position;
  double weight_t = 0;  // share of b's weights
};

}  // namespace

struct QuadricDecimater::Impl {
  size_t poses = 1;  // with the bind pose
  std::vector<std::vector<Mat4>> matrices;
  WedgeSurface surface;
  std::vector<DVec3> positions;
  std::vector<Quadric> quadrics;           // by vertex and pose, in posed space
  std::vector<Affine> skinning;            // by vertex and pose
  std::vector<std::vector<int>> faces_of;  // by vertex; none: the vertex is gone
  std::vector<uint32_t> stamps;
  std::vector<uint8_t> on_seam;  // wedges at the vertex don't all continue each other
  std::vector<uint8_t> blocked;  // an edge there could not be collapsed
  std::vector<uint8_t> gone;     // by face
  int triangles = 0;
  bool relaxed = false;
  std::priority_queue<Collapse> heap;

  size_t At(int vertex, size_t pose) const { return static_cast<size_t>(vertex) * poses + pose; }
  Face& FaceAt(int f) { return surface.faces[static_cast<size_t>(f)]; }
  const Face& FaceAt(int f) const { return surface.faces[static_cast<size_t>(f)]; }
  const Wedge& WedgeAt(int w) const { return surface.wedges[static_cast<size_t>(w)]; }
  const std::vector<int>& FacesOf(int v) const { return faces_of[static_cast<size_t>(v)]; }

  static size_t CornerOf(const Face& face, int vertex) {
    return face.vertices[0] == vertex ? 0 : face.vertices[1] == vertex ? 1 : 2;
  }
  static bool Has(const Face& face, int vertex) {
    return face.vertices[0] == vertex || face.vertices[1] == vertex || face.vertices[2] == vertex;
  }

  DVec3 Posed(int vertex, size_t pose) const {
    const DVec3 p = positions[static_cast<size_t>(vertex)];
    return pose == 0 ? p : Apply(skinning[At(vertex, pose)], p);
  }

  // Across the face, as long as twice its area.
  DVec3 Across(const Face& face, size_t pose) const {
    const DVec3 a = Posed(face.vertices[0], pose);
    return Cross(Posed(face.vertices[1], pose) - a, Posed(face.vertices[2], pose) - a);
  }

  void SetSkinning(int vertex) {
    const WedgeSurface::Vertex& v = surface.vertices[static_cast<size_t>(vertex)];
    for (size_t k = 0; k < poses; ++k) {
      Affine& out = skinning[At(vertex, k)];
      out = {};
      float sum = 0;
      for (size_t i = 0; k > 0 && i < 4; ++i) {
        if (!(v.weights[i] > 0)) continue;
        sum += v.weights[i];
        const Mat4& m = matrices[k - 1][v.joints[i]];
        for (size_t r = 0; r < 3; ++r) {
          for (size_t c = 0; c < 4; ++c) out[4 * r + c] += v.weights[i] * m.m[c][r];
        }
      }
      if (!(sum > 0)) out = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    }
  }

  // The bind pose counts as much as all others together.
  double PoseWeight(size_t pose) const {
    return pose == 0 ? std::max(1.0, static_cast<double>(poses - 1)) : 1;
  }

  void AddPlane(const Face& face, size_t pose, DVec3 across, double weight,
                std::initializer_list<int> vertices) {
    const double length = std::sqrt(Dot(across, across));
    if (!(length > 0) || !(weight > 0)) return;
    const Quadric plane =
        PlaneQuadric(across * (1 / length), Posed(face.vertices[0], pose), weight);
    for (const int v : vertices) {
      Quadric& q = quadrics[At(v, pose)];
      q = q + plane;
    }
  }

  void AddFaceQuadrics() {
    for (const Face& face : surface.faces) {
      for (size_t k = 0; k < poses; ++k) {
        const DVec3 across = Across(face, k);
        AddPlane(face, k, across, PoseWeight(k) * std::sqrt(Dot(across, across)) / 2,
                 {face.vertices[0], face.vertices[1], face.vertices[2]});
      }
    }
  }

  // A plane through the edge at right angles to the face holds its line.
  void HoldEdge(const Face& face, int a, int b, double weight) {
    for (size_t k = 0; k < poses; ++k) {
      const DVec3 across = Across(face, k), from = Posed(a, k), along = Posed(b, k) - from;
      const DVec3 normal = Cross(along, across);
      const double length = std::sqrt(Dot(normal, normal));
      if (!(length > 0)) continue;
      const Quadric plane = PlaneQuadric(
          normal * (1 / length), from, weight * PoseWeight(k) * std::sqrt(Dot(across, across)) / 2);
      for (const int v : {a, b}) {
        Quadric& q = quadrics[At(v, k)];
        q = q + plane;
      }
    }
  }

  bool Continues(const Face& f, const Face& g, int vertex) const {
    return NoSeam(WedgeAt(f.wedges[CornerOf(f, vertex)]), WedgeAt(g.wedges[CornerOf(g, vertex)]));
  }

  void HoldBordersAndSeams() {
    for (int f = 0; f < static_cast<int>(surface.faces.size()); ++f) {
      const Face face = FaceAt(f);
      for (size_t k = 0; k < 3; ++k) {
        const int a = face.vertices[k], b = face.vertices[(k + 1) % 3];
        int others = 0;
        bool continued = false, folded = false;
        for (const int g : FacesOf(a)) {
          const Face& other = FaceAt(g);
          if (g == f || !Has(other, b)) continue;
          ++others;
          continued = continued || (Continues(face, other, a) && Continues(face, other, b));
          const DVec3 n = Across(face, 0), m = Across(other, 0);
          folded = folded || Dot(n, m) < kFold * std::sqrt(Dot(n, n) * Dot(m, m));
        }
        if (others == 0 || (others == 1 && folded))
          HoldEdge(face, a, b, kBorderWeight);
        else if (!continued)
          HoldEdge(face, a, b, kSeamWeight);
      }
    }
  }

  void FindSeam(int vertex) {
    const auto& faces = FacesOf(vertex);
    bool seam = false;
    for (size_t i = 1; i < faces.size() && !seam; ++i) {
      seam = !Continues(FaceAt(faces[0]), FaceAt(faces[i]), vertex);
    }
    on_seam[static_cast<size_t>(vertex)] = seam;
  }

  // What moving a vertex from its seam does to the pictures that meet there.
  double ShiftCost(int vertex, DVec3 to) const {
    double area = 0;
    for (const int f : FacesOf(vertex)) {
      const DVec3 across = Across(FaceAt(f), 0);
      area += std::sqrt(Dot(across, across)) / 2;
    }
    const DVec3 way = to - positions[static_cast<size_t>(vertex)];
    return kStretch * kStretch * (PoseWeight(0) + static_cast<double>(poses - 1)) * area / 3 *
           Dot(way, way);
  }

  bool AlongSeam(int a, int b) const {
    const Face* first = nullptr;
    int count = 0;
    for (const int f : FacesOf(a)) {
      const Face& face = FaceAt(f);
      if (!Has(face, b)) continue;
      ++count;
      if (first == nullptr)
        first = &face;
      else if (!Continues(*first, face, a) || !Continues(*first, face, b))
        return true;
    }
    return count == 1;
  }

  Placement Place(int a, int b) const {
    const auto va = static_cast<size_t>(a), vb = static_cast<size_t>(b);
    const DVec3 from = positions[va], along = positions[vb] - from;
    const double length2 = Dot(along, along);
    const bool alike = WeightDifference(surface.vertices[va], surface.vertices[vb]) < kSameWeights;
    Placement best;
    for (const double t : {0.5, 0.0, 1.0}) {
      if (alike && t != 0.5) break;
      Quadric sum = quadrics[At(a, 0)] + quadrics[At(b, 0)];
      for (size_t k = 1; k < poses; ++k) {
        Affine m;
        const Affine &ma = skinning[At(a, k)], &mb = skinning[At(b, k)];
        const float u = static_cast<float>(t);
        for (size_t i = 0; i < 12; ++i) m[i] = ma[i] + u * (mb[i] - ma[i]);
        AddPulledBack(quadrics[At(a, k)] + quadrics[At(b, k)], m, &sum);
      }
      const auto consider = [&](DVec3 p) {
        const double cost = std::max(Evaluate(sum, p), 0.0);
        if (cost < best.cost) best = {cost, p, t};
      };
      const DVec3 anchor = from + along * t;
      const DVec3 p = Minimizer(sum, anchor, kSpring);
      if (Dot(p - anchor, p - anchor) < kReach * kReach * length2)
        consider(p);
      else
        for (const double s : {0.0, 0.5, 1.0}) consider(from + along * s);
    }
    best.cost += kLengthCost * length2;  // ties, as on flat cloth, go to the shorter edge
    if ((on_seam[va] || on_seam[vb]) && !(on_seam[va] && on_seam[vb] && AlongSeam(a, b))) {
      if (on_seam[va]) best.cost += ShiftCost(a, best.position);
      if (on_seam[vb]) best.cost += ShiftCost(b, best.position);
    }
    return best;
  }

  void Push(int a, int b) {
    if (a > b) std::swap(a, b);
    heap.push(
        {Place(a, b).cost, a, b, stamps[static_cast<size_t>(a)], stamps[static_cast<size_t>(b)]});
  }

  std::vector<int> Neighbours(int vertex) const {
    std::vector<int> out;
    for (const int f : FacesOf(vertex)) {
      for (const int v : FaceAt(f).vertices) {
        if (v != vertex) out.push_back(v);
      }
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }

  void PushAll() {
    heap = {};
    std::vector<std::pair<int, int>> edges;
    for (int v = 0; v < static_cast<int>(faces_of.size()); ++v) {
      for (const int n : Neighbours(v)) {
        if (n > v) edges.push_back({v, n});
      }
    }
    std::vector<Collapse> all(edges.size());
    const auto place = [&](size_t first, size_t step) {
      for (size_t i = first; i < edges.size(); i += step) {
        const auto [a, b] = edges[i];
        all[i] = {Place(a, b).cost, a, b, stamps[static_cast<size_t>(a)],
                  stamps[static_cast<size_t>(b)]};
      }
    };
    RunOnThreads(place);
    heap = std::priority_queue<Collapse>({}, std::move(all));
    std::fill(blocked.begin(), blocked.end(), uint8_t{0});
  }

  // Whether both ends have common neighbours that no face between them explains, or faces that
  // would lie on each other: the surface would be pinched.
  bool Pinches(int a, int b) const {
    std::vector<int> opposite;
    for (const int f : FacesOf(a)) {
      if (!Has(FaceAt(f), b)) continue;
      for (const int v : FaceAt(f).vertices) {
        if (v != a && v != b) opposite.push_back(v);
      }
    }
    const std::vector<int> of_a = Neighbours(a), of_b = Neighbours(b);
    std::vector<int> common;
    std::set_intersection(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(),
                          std::back_inserter(common));
    for (const int v : common) {
      if (std::find(opposite.begin(), opposite.end(), v) == opposite.end()) return true;
    }
    for (const int f : FacesOf(b)) {
      const Face& face = FaceAt(f);
      if (Has(face, a)) continue;
      if (FacesBeneath(a, b, face) > 0) return true;
    }
    return false;
  }

  // Faces of `a` on the same other two corners as this face of `b`.
  int FacesBeneath(int a, int b, const Face& face) const {
    const size_t k = CornerOf(face, b);
    const int x = face.vertices[(k + 1) % 3], y = face.vertices[(k + 2) % 3];
    int count = 0;
    for (const int g : FacesOf(a)) count += Has(FaceAt(g), x) && Has(FaceAt(g), y) ? 1 : 0;
    return count;
  }

  bool TurnsOver(int a, int b, const Placement& placement) const {
    const size_t middle = poses / 2;
    for (size_t pose = 0; pose <= middle; pose += std::max<size_t>(middle, 1)) {
      Affine m = skinning[At(a, pose)];
      const Affine& mb = skinning[At(b, pose)];
      const float t = static_cast<float>(placement.weight_t);
      for (size_t i = 0; i < 12; ++i) m[i] += t * (mb[i] - m[i]);
      const DVec3 to = pose == 0 ? placement.position : Apply(m, placement.position);
      for (const int end : {a, b}) {
        for (const int f : FacesOf(end)) {
          const Face& face = FaceAt(f);
          if (Has(face, a) && Has(face, b)) continue;
          const size_t k = CornerOf(face, end);
          const DVec3 x = Posed(face.vertices[(k + 1) % 3], pose);
          const DVec3 y = Posed(face.vertices[(k + 2) % 3], pose);
          const DVec3 before = Cross(y - x, Posed(end, pose) - x), after = Cross(y - x, to - x);
          const double lengths = std::sqrt(Dot(before, before) * Dot(after, after));
          if (Dot(before, before) > 0 && Dot(before, after) <= kLeastTurn * lengths) return true;
        }
      }
    }
    return false;
  }

  // New wedges of the faces at `end` that stay, from the pairs that vanishing faces join.
  struct Pair {
    int a, b, joined;
  };
  void MoveWedges(int end, int other, bool is_a, const std::vector<Pair>& pairs) {
    std::vector<std::pair<int, int>> known;
    for (const int f : FacesOf(end)) {
      Face& face = FaceAt(f);
      if (Has(face, other)) continue;
      int& wedge = face.wedges[CornerOf(face, end)];
      const auto found =
          std::find_if(known.begin(), known.end(), [&](const auto& k) { return k.first == wedge; });
      if (found != known.end()) {
        wedge = found->second;
        continue;
      }
      int moved = wedge;
      for (const Pair& pair : pairs) {
        const int own = is_a ? pair.a : pair.b;
        if (own == wedge) {
          moved = pair.joined;
          break;
        }
        if (moved != wedge || !NoSeam(WedgeAt(own), WedgeAt(wedge))) continue;
        Wedge creased = WedgeAt(pair.joined);
        creased.normal = WedgeAt(wedge).normal;
        moved = static_cast<int>(surface.wedges.size());
        surface.wedges.push_back(creased);
      }
      known.push_back({wedge, moved});
      wedge = moved;
    }
  }

  // Where the joined wedges lie between those of a (0) and b (1): a seam keeps its picture.
  float PictureShare(int a, int b, DVec3 to) const {
    const auto va = static_cast<size_t>(a), vb = static_cast<size_t>(b);
    if (on_seam[va] != on_seam[vb]) return on_seam[va] ? 0.0f : 1.0f;
    const DVec3 from = positions[va], along = positions[vb] - from;
    const double length2 = Dot(along, along);
    const double t = length2 > 0 ? Dot(to - from, along) / length2 : 0;
    return static_cast<float>(std::clamp(t, 0.0, 1.0));
  }

  int Removed(int a, int b) const {
    int count = 0;
    for (const int f : FacesOf(a)) count += Has(FaceAt(f), b) ? 1 : 0;
    return count;
  }

  void RemoveFace(int f) {
    gone[static_cast<size_t>(f)] = 1;
    --triangles;
    for (const int v : FaceAt(f).vertices) {
      auto& faces = faces_of[static_cast<size_t>(v)];
      faces.erase(std::remove(faces.begin(), faces.end(), f), faces.end());
    }
  }

  // Faces that fell on each other: opposite ones are a sheet without thickness, equal ones one too
  // many.
  void RemoveFlattened(int vertex) {
    const std::vector<int> faces = FacesOf(vertex);
    for (size_t i = 0; i < faces.size(); ++i) {
      for (size_t j = i + 1; j < faces.size(); ++j) {
        const Face &f = FaceAt(faces[i]), &g = FaceAt(faces[j]);
        if (gone[static_cast<size_t>(faces[i])] || gone[static_cast<size_t>(faces[j])]) continue;
        if (!Has(g, f.vertices[0]) || !Has(g, f.vertices[1]) || !Has(g, f.vertices[2])) continue;
        const size_t k = CornerOf(g, f.vertices[0]);
        if (g.vertices[(k + 1) % 3] != f.vertices[1]) RemoveFace(faces[i]);
        RemoveFace(faces[j]);
      }
    }
  }

  void Perform(int a, int b, const Placement& placement) {
    const auto va = static_cast<size_t>(a), vb = static_cast<size_t>(b);
    const float share = PictureShare(a, b, placement.position);
    std::vector<Pair> pairs;
    std::vector<int> vanishing;
    for (const int f : FacesOf(a)) {
      const Face& face = FaceAt(f);
      if (!Has(face, b)) continue;
      vanishing.push_back(f);
      const int wa = face.wedges[CornerOf(face, a)], wb = face.wedges[CornerOf(face, b)];
      if (std::any_of(pairs.begin(), pairs.end(),
                      [&](const Pair& p) { return p.a == wa && p.b == wb; })) {
        continue;
      }
      pairs.push_back({wa, wb, static_cast<int>(surface.wedges.size())});
      surface.wedges.push_back(Mix(WedgeAt(wa), WedgeAt(wb), share));
    }
    MoveWedges(a, b, true, pairs);
    MoveWedges(b, a, false, pairs);
    for (const int f : vanishing) RemoveFace(f);
    for (const int f : FacesOf(b)) {
      Face& face = FaceAt(f);
      face.vertices[CornerOf(face, b)] = a;
      faces_of[va].push_back(f);
    }
    faces_of[vb].clear();
    MixWeights(surface.vertices[vb], static_cast<float>(placement.weight_t), &surface.vertices[va]);
    positions[va] = placement.position;
    SetSkinning(a);
    for (size_t k = 0; k < poses; ++k) {
      quadrics[At(a, k)] = quadrics[At(a, k)] + quadrics[At(b, k)];
    }
    if (relaxed) RemoveFlattened(a);
    ++stamps[va];
    ++stamps[vb];
  }

  void Refresh(int a) {
    FindSeam(a);
    const std::vector<int> ring = Neighbours(a);
    for (const int n : ring) {
      FindSeam(n);
      Push(a, n);
    }
    for (const int n : ring) {
      if (!blocked[static_cast<size_t>(n)]) continue;
      blocked[static_cast<size_t>(n)] = 0;
      for (const int m : Neighbours(n)) {
        if (m != a) Push(n, m);
      }
    }
  }

  // False where nothing on the heap can be collapsed any more.
  bool CollapseOne(int target, std::vector<Collapse>* aside) {
    while (!heap.empty()) {
      const Collapse top = heap.top();
      heap.pop();
      const auto va = static_cast<size_t>(top.a), vb = static_cast<size_t>(top.b);
      if (top.stamp_a != stamps[va] || top.stamp_b != stamps[vb]) continue;
      const int removed = Removed(top.a, top.b);
      if (removed == 0) continue;
      if (triangles - removed < target && static_cast<int>(aside->size()) < kTries) {
        aside->push_back(top);
        continue;
      }
      const Placement placement = Place(top.a, top.b);
      if (!relaxed && (Pinches(top.a, top.b) || TurnsOver(top.a, top.b, placement))) {
        blocked[va] = blocked[vb] = 1;
        continue;
      }
      Perform(top.a, top.b, placement);
      Refresh(top.a);
      return true;
    }
    return false;
  }
};

QuadricDecimater::QuadricDecimater(const std::vector<Mesh>& meshes,
                                   const std::vector<std::vector<Mat4>>& poses)
    : impl_(std::make_unique<Impl>()) {
  Impl& impl = *impl_;
  impl.poses = poses.size() + 1;
  impl.matrices = poses;
  impl.surface = JoinWedges(meshes, poses);
  const size_t vertices = impl.surface.vertices.size();
  for (const auto& vertex : impl.surface.vertices) {
    impl.positions.push_back(ToDouble(vertex.position));
  }
  impl.quadrics.resize(vertices * impl.poses);
  impl.skinning.resize(vertices * impl.poses);
  impl.faces_of.resize(vertices);
  impl.stamps.resize(vertices);
  impl.on_seam.resize(vertices);
  impl.blocked.resize(vertices);
  impl.gone.resize(impl.surface.faces.size());
  impl.triangles = static_cast<int>(impl.surface.faces.size());
  for (int v = 0; v < static_cast<int>(vertices); ++v) impl.SetSkinning(v);
  for (int f = 0; f < impl.triangles; ++f) {
    for (const int v : impl.FaceAt(f).vertices) impl.faces_of[static_cast<size_t>(v)].push_back(f);
  }
  for (int v = 0; v < static_cast<int>(vertices); ++v) impl.FindSeam(v);
  impl.AddFaceQuadrics();
  impl.HoldBordersAndSeams();
  impl.PushAll();
}

QuadricDecimater::~QuadricDecimater() = default;

int QuadricDecimater::Triangles() const { return impl_->triangles; }

void QuadricDecimater::DecimateTo(int target) {
  Impl& impl = *impl_;
  std::vector<Collapse> aside;
  int at_last_push = impl.triangles;
  while (impl.triangles > target) {
    if (impl.CollapseOne(target, &aside)) continue;
    if (!aside.empty()) break;  // only collapses of too many triangles are left
    if (impl.relaxed && impl.triangles == at_last_push) break;
    if (impl.triangles == at_last_push) impl.relaxed = true;
    at_last_push = impl.triangles;
    impl.PushAll();
  }
  for (const Collapse& collapse : aside) impl.heap.push(collapse);
}

WedgeSurface QuadricDecimater::Surface() const {
  const Impl& impl = *impl_;
  WedgeSurface out;
  out.vertices = impl.surface.vertices;
  out.wedges = impl.surface.wedges;
  for (size_t v = 0; v < out.vertices.size(); ++v) {
    out.vertices[v].position = ToFloat(impl.positions[v]);
  }
  for (size_t f = 0; f < impl.surface.faces.size(); ++f) {
    if (!impl.gone[f]) out.faces.push_back(impl.surface.faces[f]);
  }
  return out;
}

}  // namespace flaneur
