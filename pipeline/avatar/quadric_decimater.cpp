#include "pipeline/avatar/quadric_decimater.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Utils/HeapT.hh>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <tuple>

#include "pipeline/avatar/in_strides.h"
#include "pipeline/avatar/posed_quadric.h"
#include "pipeline/avatar/wedge_surface.h"

namespace flaneur {
namespace {

using Face = WedgeSurface::Face;
using Wedge = WedgeSurface::Wedge;
using OpenMesh::EdgeHandle, OpenMesh::FaceHandle, OpenMesh::HalfedgeHandle, OpenMesh::VertexHandle;

constexpr double kBorderWeight = 1;         // of an open border's planes, against those of faces
constexpr double kSeamWeight = 0.03;        // of a seam's
constexpr double kStretch = 0.2;            // a picture shifted by a length costs as much as this share of it
constexpr double kSpring = 1e-6;            // towards the edge, where planes leave a vertex free
constexpr double kLengthCost = 1e-9;        // of an edge's squared length: decides where all else is equal
constexpr double kReach = 2;                // of an edge's length: so far may its vertex move from it
constexpr double kMinFaceTurnCosine = 0.2;  // cosine; a face that turns further is taken to fold over
constexpr double kTwoSidedCosine = -0.95;   // cosine between faces: a sheet that is seen from both sides
constexpr float kSameWeights = 0.02f;       // sum of differences
constexpr int kTries = 2000;                // collapses looked at for one that hits the number of triangles

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  VertexAttributes(OpenMesh::Attributes::Status);
  EdgeAttributes(OpenMesh::Attributes::Status);
  FaceAttributes(OpenMesh::Attributes::Status);
};
using HalfEdges = OpenMesh::TriMesh_ArrayKernelT<Traits>;

// Of the edge between vertices a < b, of which a stays.
struct Collapse {
  double cost = 1e300;
  int a = 0, b = 0;
  DVec3 position;
  double weight_t = 0;  // share of b's weights
};

// The edges by cost, for OpenMesh's heap.
struct ByCost {
  HalfEdges* mesh = nullptr;
  OpenMesh::EPropHandleT<Collapse> collapse;
  OpenMesh::EPropHandleT<int> position;

  auto Key(EdgeHandle e) const {
    const Collapse& c = mesh->property(collapse, e);
    return std::tuple(c.cost, c.a, c.b, e.idx());
  }
  bool less(EdgeHandle e, EdgeHandle f) const { return Key(e) < Key(f); }
  int get_heap_position(EdgeHandle e) const { return mesh->property(position, e); }
  void set_heap_position(EdgeHandle e, int i) { mesh->property(position, e) = i; }
};

}  // namespace

// Topology is OpenMesh's. A vertex of ours has one of OpenMesh's a fan: twins, which stand at one place and collapse
// together or not at all. Wedges stay on our faces, found by vertex: a collapse gives a half-edge another one's place
// in the face beside.
struct QuadricDecimater::Impl {
  Jobs* jobs;
  size_t poses;  // with the bind pose
  std::vector<std::vector<Mat4>> matrices;
  WedgeSurface surface;
  HalfEdges mesh;                               // the same faces
  std::vector<int> vertex_of;                   // by vertex of the mesh
  std::vector<std::vector<VertexHandle>> fans;  // by vertex; none: the vertex is gone
  std::vector<Quadric> quadrics;                // by vertex and pose, in posed space
  std::vector<Affine> skinning;                 // by vertex and pose
  std::vector<uint8_t> on_seam;                 // wedges at the vertex don't all continue each other
  std::vector<uint8_t> refused;                 // by vertex: a collapse there, since it was last looked at again
  int triangles = 0;
  bool relaxed = false;
  OpenMesh::EPropHandleT<Collapse> collapse;
  OpenMesh::Utils::HeapT<EdgeHandle, ByCost> heap;

  Impl(const std::vector<Mesh>& meshes, const std::vector<std::vector<Mat4>>& walk, Jobs* with)
      : jobs(with), poses(walk.size() + 1), matrices(walk), surface(JoinWedges(meshes, walk)) {
    const size_t vertices = surface.vertices.size();
    fans.resize(vertices);
    quadrics.resize(vertices * poses);
    skinning.resize(vertices * poses);
    on_seam.resize(vertices);
    triangles = static_cast<int>(surface.faces.size());
    ByCost& by_cost = heap.getInterface();
    by_cost.mesh = &mesh;
    mesh.add_property(by_cost.collapse);
    mesh.add_property(by_cost.position);
    collapse = by_cost.collapse;
    BuildMesh();
    for (int v = 0; v < static_cast<int>(vertices); ++v) {
      SetSkinning(v);
      FindSeam(v);
    }
    AddFaceQuadrics();
    HoldBordersAndSeams();
    QueueAll();
  }

  size_t At(int vertex, size_t pose) const { return static_cast<size_t>(vertex) * poses + pose; }
  Face& FaceAt(int f) { return surface.faces[static_cast<size_t>(f)]; }
  const Face& FaceAt(int f) const { return surface.faces[static_cast<size_t>(f)]; }
  const Wedge& WedgeAt(int w) const { return surface.wedges[static_cast<size_t>(w)]; }
  int WedgeOf(int f, int vertex) const { return FaceAt(f).wedges[CornerOf(FaceAt(f), vertex)]; }
  const std::vector<VertexHandle>& FansOf(int v) const { return fans[static_cast<size_t>(v)]; }
  int VertexOf(VertexHandle fan) const { return vertex_of[static_cast<size_t>(fan.idx())]; }
  bool OnSeam(int v) const { return on_seam[static_cast<size_t>(v)] != 0; }

  static size_t CornerOf(const Face& face, int vertex) {
    return face.vertices[0] == vertex ? 0 : face.vertices[1] == vertex ? 1 : 2;
  }
  static bool Has(const Face& face, int vertex) {
    return face.vertices[0] == vertex || face.vertices[1] == vertex || face.vertices[2] == vertex;
  }

  std::vector<int> FacesOf(int vertex) const {
    std::vector<int> faces;
    for (const VertexHandle fan : FansOf(vertex)) {
      for (const FaceHandle f : mesh.vf_range(fan)) faces.push_back(f.idx());
    }
    std::sort(faces.begin(), faces.end());  // the same whatever was collapsed before
    return faces;
  }

  std::vector<int> FacesBetween(int a, int b) const {
    std::vector<int> faces = FacesOf(a);
    std::erase_if(faces, [&](int f) { return !Has(FaceAt(f), b); });
    return faces;
  }

  DVec3 Position(int vertex) const {
    const OpenMesh::Vec3d& p = mesh.point(FansOf(vertex)[0]);
    return {p[0], p[1], p[2]};
  }

  DVec3 Posed(int vertex, size_t pose) const {
    const DVec3 p = Position(vertex);
    return pose == 0 ? p : Apply(skinning[At(vertex, pose)], p);
  }

  // Across the face, as long as twice its area.
  DVec3 Across(const Face& face, size_t pose) const {
    const DVec3 a = Posed(face.vertices[0], pose);
    return Cross(Posed(face.vertices[1], pose) - a, Posed(face.vertices[2], pose) - a);
  }

  double Area(const Face& face, size_t pose) const {
    const DVec3 across = Across(face, pose);
    return std::sqrt(Dot(across, across)) / 2;
  }

  void SetSkinning(int vertex) {
    const WedgeSurface::Vertex& v = surface.vertices[static_cast<size_t>(vertex)];
    for (size_t k = 1; k < poses; ++k) skinning[At(vertex, k)] = SkinningOf(v.joints, v.weights, matrices[k - 1]);
  }

  // One vertex a fan: a face that has no other to go on into over an edge, or several, ends there.
  void BuildMesh() {
    std::vector<size_t> same_fan(3 * surface.faces.size());  // by corner: another one
    std::iota(same_fan.begin(), same_fan.end(), size_t{0});
    const auto fan_of = [&](size_t corner) {
      while (same_fan[corner] != corner) corner = same_fan[corner] = same_fan[same_fan[corner]];
      return corner;
    };
    const auto vertex_at = [&](size_t corner) { return surface.faces[corner / 3].vertices[corner % 3]; };
    const auto next = [](size_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; };
    std::map<std::pair<int, int>, std::vector<size_t>> sides;  // by the edge's ends: the corners that they start at
    for (size_t c = 0; c < same_fan.size(); ++c) sides[std::minmax(vertex_at(c), vertex_at(next(c)))].push_back(c);
    for (const auto& [ends, at_edge] : sides) {
      if (at_edge.size() != 2 || vertex_at(at_edge[0]) == vertex_at(at_edge[1])) continue;
      same_fan[fan_of(at_edge[0])] = fan_of(next(at_edge[1]));
      same_fan[fan_of(next(at_edge[0]))] = fan_of(at_edge[1]);
    }
    std::vector<VertexHandle> made(same_fan.size()), corners(3);
    for (size_t c = 0; c < same_fan.size(); ++c) {
      VertexHandle& fan = made[fan_of(c)];
      if (!fan.is_valid()) {
        const auto vertex = static_cast<size_t>(vertex_at(c));
        const Vec3 p = surface.vertices[vertex].position;
        fan = mesh.add_vertex(OpenMesh::Vec3d(OpenMesh::Vec3f(p.x, p.y, p.z)));
        fans[vertex].push_back(fan);
        vertex_of.push_back(vertex_at(c));
      }
      corners[c % 3] = fan;
      if (c % 3 == 2) mesh.add_face(corners);
    }
  }

  // The bind pose counts as much as all others together.
  double PoseWeight(size_t pose) const { return pose == 0 ? std::max(1.0, static_cast<double>(poses - 1)) : 1; }

  // The plane through `point` across `normal`, of any length, that the vertices should stay on in a pose.
  void AddPlane(DVec3 normal, DVec3 point, double weight, size_t pose, std::initializer_list<int> vertices) {
    const double length = std::sqrt(Dot(normal, normal));
    if (!(length > 0)) return;
    const Quadric plane = PlaneQuadric(normal * (1 / length), point, weight * PoseWeight(pose));
    for (const int v : vertices) {
      Quadric& q = quadrics[At(v, pose)];
      q = q + plane;
    }
  }

  void AddFaceQuadrics() {
    for (const Face& face : surface.faces) {
      const auto& [a, b, c] = face.vertices;
      for (size_t k = 0; k < poses; ++k) AddPlane(Across(face, k), Posed(a, k), Area(face, k), k, {a, b, c});
    }
  }

  // A plane through the edge at right angles to the face holds its line.
  void HoldEdge(const Face& face, int a, int b, double weight) {
    for (size_t k = 0; k < poses; ++k) {
      const DVec3 from = Posed(a, k);
      AddPlane(Cross(Posed(b, k) - from, Across(face, k)), from, weight * Area(face, k), k, {a, b});
    }
  }

  bool Continues(int f, int g, int vertex) const {
    return NoSeam(WedgeAt(WedgeOf(f, vertex)), WedgeAt(WedgeOf(g, vertex)));
  }

  void HoldBordersAndSeams() {
    for (int f = 0; f < triangles; ++f) {
      const Face& face = FaceAt(f);
      for (size_t k = 0; k < 3; ++k) {
        const int a = face.vertices[k], b = face.vertices[(k + 1) % 3];
        int others = 0;
        bool continued = false, folded = false;
        for (const int g : FacesBetween(a, b)) {
          if (g == f) continue;
          const Face& other = FaceAt(g);
          ++others;
          continued = continued || (Continues(f, g, a) && Continues(f, g, b));
          const DVec3 n = Across(face, 0), m = Across(other, 0);
          folded = folded || Dot(n, m) < kTwoSidedCosine * std::sqrt(Dot(n, n) * Dot(m, m));
        }
        if (others == 0 || (others == 1 && folded)) HoldEdge(face, a, b, kBorderWeight);
        else if (!continued) HoldEdge(face, a, b, kSeamWeight);
      }
    }
  }

  void FindSeam(int vertex) {
    const std::vector<int> faces = FacesOf(vertex);
    on_seam[static_cast<size_t>(vertex)] =
        std::any_of(faces.begin(), faces.end(), [&](int f) { return !Continues(faces[0], f, vertex); });
  }

  // What moving a vertex from its seam does to the pictures that meet there.
  double ShiftCost(int vertex, DVec3 to) const {
    double area = 0;
    for (const int f : FacesOf(vertex)) area += Area(FaceAt(f), 0);
    const DVec3 way = to - Position(vertex);
    return kStretch * kStretch * (PoseWeight(0) + static_cast<double>(poses - 1)) * area / 3 * Dot(way, way);
  }

  bool AlongSeam(int a, int b) const {
    const std::vector<int> faces = FacesBetween(a, b);
    return faces.size() == 1 || std::any_of(faces.begin(), faces.end(), [&](int f) {
             return !Continues(faces[0], f, a) || !Continues(faces[0], f, b);
           });
  }

  Affine MixedSkinning(int a, int b, size_t pose, double weight_t) const {
    Affine m = skinning[At(a, pose)];
    const Affine& of_b = skinning[At(b, pose)];
    for (size_t i = 0; i < 12; ++i) m[i] += static_cast<float>(weight_t) * (of_b[i] - m[i]);
    return m;
  }

  Collapse Place(int a, int b) const {
    const DVec3 from = Position(a), along = Position(b) - from;
    const double length2 = Dot(along, along);
    const auto &of_a = surface.vertices[static_cast<size_t>(a)], &of_b = surface.vertices[static_cast<size_t>(b)];
    const bool alike = WeightDifference(of_a, of_b) < kSameWeights;
    Collapse best;
    best.a = a, best.b = b;
    for (const double t : {0.5, 0.0, 1.0}) {
      if (alike && t != 0.5) break;
      Quadric sum = quadrics[At(a, 0)] + quadrics[At(b, 0)];
      for (size_t k = 1; k < poses; ++k) {
        AddPulledBack(quadrics[At(a, k)] + quadrics[At(b, k)], MixedSkinning(a, b, k, t), &sum);
      }
      const auto consider = [&](DVec3 p) {
        const double cost = std::max(Evaluate(sum, p), 0.0);
        if (cost < best.cost) best = {cost, a, b, p, t};
      };
      const DVec3 anchor = from + along * t;
      const DVec3 p = Minimizer(sum, anchor, kSpring);
      if (Dot(p - anchor, p - anchor) < kReach * kReach * length2) consider(p);
      else
        for (const double s : {0.0, 0.5, 1.0}) consider(from + along * s);
    }
    best.cost += kLengthCost * length2;  // ties, as on flat cloth, go to the shorter edge
    if (!(OnSeam(a) && OnSeam(b) && AlongSeam(a, b))) {
      if (OnSeam(a)) best.cost += ShiftCost(a, best.position);
      if (OnSeam(b)) best.cost += ShiftCost(b, best.position);
    }
    return best;
  }

  void SetCollapse(EdgeHandle e) {
    const HalfedgeHandle h = mesh.halfedge_handle(e, 0);
    const int a = VertexOf(mesh.from_vertex_handle(h)), b = VertexOf(mesh.to_vertex_handle(h));
    mesh.property(collapse, e) = Place(std::min(a, b), std::max(a, b));
  }

  void Queue(EdgeHandle e) {
    SetCollapse(e);
    if (heap.is_stored(e)) heap.update(e);
    else heap.insert(e);
  }

  void QueueAll() {
    heap.clear();
    refused.assign(surface.vertices.size(), 0);
    for (const EdgeHandle e : mesh.edges()) heap.reset_heap_position(e);
    InStrides(jobs, [&](size_t first, size_t step) {
      for (size_t i = first; i < mesh.n_edges(); i += step) {
        const EdgeHandle e(static_cast<int>(i));
        if (!mesh.status(e).deleted()) SetCollapse(e);
      }
    });
    for (const EdgeHandle e : mesh.edges()) heap.insert(e);  // that are not deleted
  }

  void RemoveFace(FaceHandle f) {
    ForgetEdges(f);
    mesh.delete_face(f);
  }

  // Before a face goes; edges of it that stay are queued again.
  void ForgetEdges(FaceHandle f) {
    for (const EdgeHandle e : mesh.fe_range(f)) {
      if (heap.is_stored(e)) heap.remove(e);
    }
    --triangles;
  }

  // The link condition over all fans at once, as OpenMesh's own only sees one: whether both ends have common neighbours
  // that no face between them explains, or faces that would lie on each other.
  bool Pinches(int a, int b) const {
    const std::vector<int> between = FacesBetween(a, b), of_a = FacesOf(a);
    const auto is_opposite = [&](int v) {
      return std::any_of(between.begin(), between.end(), [&](int f) { return Has(FaceAt(f), v); });
    };
    for (const int f : FacesOf(b)) {
      for (const int g : of_a) {
        if (Has(FaceAt(f), a) || Has(FaceAt(g), b)) continue;
        int common = 0;
        for (const int v : FaceAt(f).vertices) {
          if (v == b || !Has(FaceAt(g), v)) continue;
          if (!is_opposite(v) || ++common == 2) return true;
        }
      }
    }
    return false;
  }

  bool TurnsOver(const Collapse& c) const {
    const size_t middle = poses / 2;
    for (size_t pose = 0; pose <= middle; pose += std::max<size_t>(middle, 1)) {
      const DVec3 to = pose == 0 ? c.position : Apply(MixedSkinning(c.a, c.b, pose, c.weight_t), c.position);
      for (const auto& [end, other] : {std::pair(c.a, c.b), std::pair(c.b, c.a)}) {
        for (const int f : FacesOf(end)) {
          const Face& face = FaceAt(f);
          if (Has(face, other)) continue;
          const size_t k = CornerOf(face, end);
          const DVec3 x = Posed(face.vertices[(k + 1) % 3], pose), y = Posed(face.vertices[(k + 2) % 3], pose);
          const DVec3 before = Cross(y - x, Posed(end, pose) - x), after = Cross(y - x, to - x);
          const double lengths = std::sqrt(Dot(before, before) * Dot(after, after));
          if (Dot(before, before) > 0 && Dot(before, after) <= kMinFaceTurnCosine * lengths) return true;
        }
      }
    }
    return false;
  }

  // Where the joined wedges lie between those of a (0) and b (1): a seam keeps its picture.
  float PictureShare(const Collapse& c) const {
    if (OnSeam(c.a) != OnSeam(c.b)) return OnSeam(c.a) ? 0.0f : 1.0f;
    const DVec3 from = Position(c.a), along = Position(c.b) - from;
    const double length2 = Dot(along, along);
    const double t = length2 > 0 ? Dot(c.position - from, along) / length2 : 0;
    return static_cast<float>(std::clamp(t, 0.0, 1.0));
  }

  int AddWedge(const Wedge& wedge) {
    surface.wedges.push_back(wedge);
    return static_cast<int>(surface.wedges.size()) - 1;
  }

  // What the wedges at both ends of a vanishing face become.
  struct Joined {
    std::array<int, 2> ends;
    int wedge;
  };
  std::vector<Joined> JoinWedgesOf(const Collapse& c, const std::vector<int>& vanishing) {
    const float share = PictureShare(c);
    std::vector<Joined> all;
    for (const int f : vanishing) {
      const std::array<int, 2> ends{WedgeOf(f, c.a), WedgeOf(f, c.b)};
      if (std::any_of(all.begin(), all.end(), [&](const Joined& j) { return j.ends == ends; })) continue;
      all.push_back({ends, AddWedge(Mix(WedgeAt(ends[0]), WedgeAt(ends[1]), share))});
    }
    return all;
  }

  // A face that stays takes what its wedge was joined to, or, but for its normal, what one was that is only creased
  // there.
  void MoveWedges(int vertex, size_t end, const std::vector<int>& vanishing, const std::vector<Joined>& joined) {
    std::map<int, int> moved;
    for (const Joined& j : joined) moved.try_emplace(j.ends[end], j.wedge);
    for (const int f : FacesOf(vertex)) {
      if (std::find(vanishing.begin(), vanishing.end(), f) != vanishing.end()) continue;
      const auto [found, is_new] = moved.try_emplace(WedgeOf(f, vertex), WedgeOf(f, vertex));
      const int own = found->first;
      const auto smooth = std::find_if(joined.begin(), joined.end(),
                                       [&](const Joined& j) { return NoSeam(WedgeAt(j.ends[end]), WedgeAt(own)); });
      if (is_new && smooth != joined.end()) {
        Wedge creased = WedgeAt(smooth->wedge);
        creased.normal = WedgeAt(own).normal;
        found->second = AddWedge(creased);
      }
      FaceAt(f).wedges[CornerOf(FaceAt(f), vertex)] = found->second;
    }
  }

  // Faces that fell on each other: opposite ones are a sheet without thickness, equal ones one too many.
  void RemoveFlattened(int vertex) {
    const std::vector<int> faces = FacesOf(vertex);
    for (size_t i = 0; i < faces.size(); ++i) {
      for (size_t j = i + 1; j < faces.size(); ++j) {
        const Face &f = FaceAt(faces[i]), &g = FaceAt(faces[j]);
        const FaceHandle first(faces[i]), second(faces[j]);
        if (mesh.status(first).deleted() || mesh.status(second).deleted()) continue;
        if (!Has(g, f.vertices[0]) || !Has(g, f.vertices[1]) || !Has(g, f.vertices[2])) continue;
        const size_t k = CornerOf(g, f.vertices[0]);
        if (g.vertices[(k + 1) % 3] != f.vertices[1]) RemoveFace(first);
        RemoveFace(second);
      }
    }
  }

  // What OpenMesh cannot collapse loses the faces of the edge alone: its ends stay apart, as twins.
  void CollapseTwins(const Collapse& c, const std::vector<int>& vanishing) {
    for (const int f : vanishing) ForgetEdges(FaceHandle(f));
    auto &of_a = fans[static_cast<size_t>(c.a)], &of_b = fans[static_cast<size_t>(c.b)];
    for (const VertexHandle from : of_b) {
      for (const VertexHandle to : of_a) {
        const HalfedgeHandle h = mesh.find_halfedge(from, to);
        if (h.is_valid() && mesh.is_collapse_ok(h)) mesh.collapse(h);
      }
    }
    for (const int f : vanishing) {
      if (!mesh.status(FaceHandle(f)).deleted()) mesh.delete_face(FaceHandle(f));
    }
    of_a.insert(of_a.end(), of_b.begin(), of_b.end());
    of_b.clear();
    std::erase_if(of_a, [&](VertexHandle fan) { return mesh.status(fan).deleted(); });
    for (const VertexHandle fan : of_a) {
      vertex_of[static_cast<size_t>(fan.idx())] = c.a;
      mesh.set_point(fan, {c.position.x, c.position.y, c.position.z});
    }
  }

  void Perform(const Collapse& c) {
    const std::vector<int> vanishing = FacesBetween(c.a, c.b);
    const std::vector<Joined> joined = JoinWedgesOf(c, vanishing);
    MoveWedges(c.a, 0, vanishing, joined);
    MoveWedges(c.b, 1, vanishing, joined);
    for (const int f : FacesOf(c.b)) {
      Face& face = FaceAt(f);
      if (!Has(face, c.a)) face.vertices[CornerOf(face, c.b)] = c.a;
    }
    MixWeights(surface.vertices[static_cast<size_t>(c.b)], static_cast<float>(c.weight_t),
               &surface.vertices[static_cast<size_t>(c.a)]);
    CollapseTwins(c, vanishing);
    SetSkinning(c.a);
    for (size_t k = 0; k < poses; ++k) quadrics[At(c.a, k)] = quadrics[At(c.a, k)] + quadrics[At(c.b, k)];
    if (relaxed) RemoveFlattened(c.a);
  }

  // Where something was refused, all edges are looked at again: what was refused may do now, and what waits may have
  // become cheaper.
  void QueueAgain(int vertex) {
    if (!refused[static_cast<size_t>(vertex)]) return;
    refused[static_cast<size_t>(vertex)] = 0;
    for (const VertexHandle fan : FansOf(vertex)) {
      for (const EdgeHandle e : mesh.ve_range(fan)) {
        const Collapse before = mesh.property(collapse, e);
        SetCollapse(e);
        if (!heap.is_stored(e)) heap.insert(e);
        else if (mesh.property(collapse, e).cost < before.cost) heap.update(e);
        else mesh.property(collapse, e) = before;
      }
    }
  }

  void Refresh(int a) {
    std::vector<int> ring;
    for (const VertexHandle fan : FansOf(a)) {
      for (const VertexHandle n : mesh.vv_range(fan)) ring.push_back(VertexOf(n));
    }
    FindSeam(a);
    for (const int n : ring) FindSeam(n);
    for (const VertexHandle fan : FansOf(a)) {
      for (const EdgeHandle e : mesh.ve_range(fan)) Queue(e);
    }
    for (const int n : ring) QueueAgain(n);
  }

  // False where nothing on the heap can be collapsed any more.
  bool CollapseOne(int target, std::vector<EdgeHandle>* aside) {
    while (!heap.empty()) {
      const EdgeHandle e = heap.front();
      heap.pop_front();
      const Collapse c = mesh.property(collapse, e);
      const int removed = static_cast<int>(FacesBetween(c.a, c.b).size());
      if (triangles - removed < target && static_cast<int>(aside->size()) < kTries) {
        aside->push_back(e);
      } else if (relaxed || (!Pinches(c.a, c.b) && !TurnsOver(c))) {
        Perform(c);
        Refresh(c.a);
        return true;
      } else {
        refused[static_cast<size_t>(c.a)] = refused[static_cast<size_t>(c.b)] = 1;
      }
    }
    return false;
  }
};

QuadricDecimater::QuadricDecimater(const std::vector<Mesh>& meshes, const std::vector<std::vector<Mat4>>& poses,
                                   Jobs* jobs)
    : impl_(std::make_unique<Impl>(meshes, poses, jobs)) {}

QuadricDecimater::~QuadricDecimater() = default;

int QuadricDecimater::Triangles() const { return impl_->triangles; }

void QuadricDecimater::DecimateTo(int target) {
  Impl& impl = *impl_;
  std::vector<EdgeHandle> aside;
  int at_last_push = impl.triangles;
  while (impl.triangles > target) {
    if (impl.CollapseOne(target, &aside)) continue;
    if (!aside.empty()) break;  // only collapses of too many triangles are left
    if (impl.relaxed && impl.triangles == at_last_push) break;
    if (impl.triangles == at_last_push) impl.relaxed = true;
    at_last_push = impl.triangles;
    impl.QueueAll();
  }
  for (const EdgeHandle e : aside) {
    if (!impl.mesh.status(e).deleted() && !impl.heap.is_stored(e)) impl.heap.insert(e);
  }
}

WedgeSurface QuadricDecimater::Surface() const {
  const Impl& impl = *impl_;
  WedgeSurface out;
  out.vertices = impl.surface.vertices;
  out.wedges = impl.surface.wedges;
  for (size_t v = 0; v < out.vertices.size(); ++v) {
    if (!impl.fans[v].empty()) out.vertices[v].position = ToFloat(impl.Position(static_cast<int>(v)));
  }
  for (const FaceHandle f : impl.mesh.faces()) out.faces.push_back(impl.FaceAt(f.idx()));
  return out;
}

}  // namespace flaneur
