#include "pipeline/avatar/quadric_decimater.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
// Needs the above first.
#include <OpenMesh/Core/Geometry/QuadricT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModBaseT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>

namespace flaneur {
namespace {

using HalfEdgeMesh = OpenMesh::TriMesh_ArrayKernelT<>;
using Quadric = OpenMesh::Geometry::Quadricd;
using Face = WedgeSurface::Face;

constexpr double kSeamWeight = 2;  // of a border's or seam's own planes, against those of faces
constexpr float kSameUv = 1e-4f;   // uvs nearer than this are no seam
constexpr float kSameColor = 0.02f;
constexpr double kStretch = 0.3;  // a picture shifted by a length costs as much as this share of it
constexpr float kMaxFlip_deg = 80;  // a face that turns further is taken to fold over

OpenMesh::Vec3d ToDouble(Vec3 v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

// Everything the decimating module needs of the surface; lives as long as the decimater.
struct Surface {
  WedgeSurface wedges;                                  // faces by OpenMesh's face index
  const std::vector<Mesh>* meshes = nullptr;            // the bind pose's
  std::vector<std::vector<OpenMesh::Vec3d>> positions;  // by pose and vertex
};

int WedgeAt(const Surface& surface, int face, int vertex) {
  const Face& f = surface.wedges.faces[static_cast<size_t>(face)];
  for (size_t k = 0; k < 3; ++k) {
    if (f.vertices[k] == vertex) return f.wedges[k];
  }
  return -1;
}

const Mesh& MeshOf(const Surface& surface, int wedge) {
  return (
      *surface.meshes)[static_cast<size_t>(surface.wedges.wedges[static_cast<size_t>(wedge)].mesh)];
}

uint32_t VertexOf(const Surface& surface, int wedge) {
  return surface.wedges.wedges[static_cast<size_t>(wedge)].vertex;
}

bool SameMesh(const Surface& surface, int a, int b) {
  return &MeshOf(surface, a) == &MeshOf(surface, b);
}

// Both wedges of one mesh.
float UvShift(const Surface& surface, int a, int b) {
  const Mesh& mesh = MeshOf(surface, a);
  if (mesh.uvs.empty()) return 0;
  return Length(mesh.uvs[VertexOf(surface, a)] - mesh.uvs[VertexOf(surface, b)]);
}

float ColorShift(const Surface& surface, int a, int b) {
  const Mesh& mesh = MeshOf(surface, a);
  if (mesh.colors.empty()) return 0;
  const Vec4 p = mesh.colors[VertexOf(surface, a)], q = mesh.colors[VertexOf(surface, b)];
  return std::max({std::abs(p.x - q.x), std::abs(p.y - q.y), std::abs(p.z - q.z)});
}

// Wedges of one vertex that only differ by their normal: a crease, but no seam.
bool NoSeam(const Surface& surface, int a, int b) {
  return a == b || (SameMesh(surface, a, b) && UvShift(surface, a, b) < kSameUv &&
                    ColorShift(surface, a, b) < kSameColor);
}

float NormalAgreement(const Surface& surface, int a, int b) {
  const Mesh& mesh = MeshOf(surface, a);
  if (mesh.normals.empty()) return 1;
  return Dot(mesh.normals[VertexOf(surface, a)], MeshOf(surface, b).normals[VertexOf(surface, b)]);
}

// The priority of a collapse is its quadric error over all poses, and the shift of the picture
// where a corner leaves its uv seam; illegal where a border of materials would tear.
template <typename MeshType>
class ModSeamQuadric : public OpenMesh::Decimater::ModBaseT<MeshType> {
 public:
  DECIMATING_MODULE(ModSeamQuadric, MeshType, SeamQuadric);

  explicit ModSeamQuadric(MeshType& mesh) : Base(mesh, false) {}

  void SetSurface(Surface* surface) { surface_ = surface; }

  void initialize() override {
    quadrics_.assign(surface_->positions.size(),
                     std::vector<Quadric>(Base::mesh().n_vertices(), Quadric(0.0)));
    for (const auto face : Base::mesh().faces()) AddFace(face.idx());
    for (const auto edge : Base::mesh().edges()) AddSeam(edge);
  }

  float collapse_priority(const CollapseInfo& info) override {
    double shift = 0;
    if (!MapWedges(info, &shift)) return Base::ILLEGAL_COLLAPSE;
    double cost = 0;
    const auto v0 = static_cast<size_t>(info.v0.idx()), v1 = static_cast<size_t>(info.v1.idx());
    for (size_t pose = 0; pose < quadrics_.size(); ++pose) {
      const Quadric sum = Quadric(quadrics_[pose][v0]) += quadrics_[pose][v1];
      cost += std::max(sum(surface_->positions[pose][v1]), 0.0);
    }
    // Ties, as on flat cloth, go to the shorter edge.
    const auto edge = surface_->positions[0][v1] - surface_->positions[0][v0];
    return static_cast<float>(cost + shift + 1e-9 * edge.sqrnorm());
  }

  void preprocess_collapse(const CollapseInfo& info) override {
    double shift = 0;
    MapWedges(info, &shift);
    for (const Move& move : moved_) {
      Face& f = surface_->wedges.faces[static_cast<size_t>(move.face)];
      const int wedge = move.place < 0 ? move.wedge : Displaced(move.wedge, move.place);
      for (size_t k = 0; k < 3; ++k) {
        if (f.vertices[k] != info.v0.idx()) continue;
        f.vertices[k] = info.v1.idx();
        f.wedges[k] = wedge;
      }
    }
  }

  void postprocess_collapse(const CollapseInfo& info) override {
    for (auto& pose : quadrics_) {
      pose[static_cast<size_t>(info.v1.idx())] += pose[static_cast<size_t>(info.v0.idx())];
    }
  }

 private:
  // What happens to the corner at v0 of a face that stays.
  struct Move {
    int face = 0;
    int wedge = 0;
    int place = -1;  // a wedge at v1 where only the corner's place changes, not its uv; -1: `wedge`
                     // has it all
  };

  // A wedge with the picture of one and the place of another.
  int Displaced(int wedge, int place) {
    auto& wedges = surface_->wedges.wedges;
    WedgeSurface::Wedge displaced = wedges[static_cast<size_t>(wedge)];
    displaced.place = wedges[static_cast<size_t>(place)].place;
    wedges.push_back(displaced);
    return static_cast<int>(wedges.size()) - 1;
  }

  void AddPlane(size_t pose, OpenMesh::Vec3d normal, OpenMesh::Vec3d point, double weight,
                std::initializer_list<int> vertices) {
    const double length = normal.norm();
    if (!(length > 0)) return;
    normal /= length;
    Quadric plane(normal[0], normal[1], normal[2], -(normal | point));
    plane *= weight;
    for (const int v : vertices) quadrics_[pose][static_cast<size_t>(v)] += plane;
  }

  // Weights are lengths: by area the large faces would leave nothing of a hand, with equal ones of
  // a coat.
  void AddFace(int face) {
    const auto& v = surface_->wedges.faces[static_cast<size_t>(face)].vertices;
    for (size_t pose = 0; pose < quadrics_.size(); ++pose) {
      const auto& p = surface_->positions[pose];
      const auto a = p[static_cast<size_t>(v[0])];
      const auto normal = (p[static_cast<size_t>(v[1])] - a) % (p[static_cast<size_t>(v[2])] - a);
      AddPlane(pose, normal, a, std::sqrt(normal.norm() / 2), {v[0], v[1], v[2]});
    }
  }

  // A plane through each border or seam edge, at right angles to the face, holds its line.
  void AddSeam(const OpenMesh::SmartEdgeHandle& edge) {
    const int a = edge.v0().idx(), b = edge.v1().idx();
    const auto left = edge.h0().face(), right = edge.h1().face();
    if (left.is_valid() && right.is_valid() &&
        NoSeam(*surface_, WedgeAt(*surface_, left.idx(), a), WedgeAt(*surface_, right.idx(), a)) &&
        NoSeam(*surface_, WedgeAt(*surface_, left.idx(), b), WedgeAt(*surface_, right.idx(), b))) {
      return;
    }
    for (const auto& face : {left, right}) {
      if (!face.is_valid()) continue;
      const auto& v = surface_->wedges.faces[static_cast<size_t>(face.idx())].vertices;
      for (size_t pose = 0; pose < quadrics_.size(); ++pose) {
        const auto& p = surface_->positions[pose];
        const auto at = [&](int i) { return p[static_cast<size_t>(i)]; };
        const auto normal = (at(v[1]) - at(v[0])) % (at(v[2]) - at(v[0]));
        const auto along = at(b) - at(a);
        AddPlane(pose, along % normal, at(a), kSeamWeight * along.norm(), {a, b});
      }
    }
  }

  // The wedge at v1 that continues `wedge` of v0 across one of the two faces that vanish; -1: none
  // does.
  int Continuation(const CollapseInfo& info, int wedge, bool* exact) const {
    int found = -1;
    for (const auto& face : {info.fl, info.fr}) {
      if (!face.is_valid()) continue;
      const int w0 = WedgeAt(*surface_, face.idx(), info.v0.idx());
      if (w0 == wedge || (found < 0 && NoSeam(*surface_, w0, wedge))) {
        found = WedgeAt(*surface_, face.idx(), info.v1.idx());
        *exact = w0 == wedge;
        if (*exact) return found;
      }
    }
    return found;
  }

  // Of the wedges at v1 the one of the same mesh, without a seam to `like` where given, whose
  // normal fits best; -1: none.
  int Nearest(const CollapseInfo& info, int like, int wedge) {
    int best = -1;
    float closest = -2;
    for (const auto face : Base::mesh().vf_range(info.v1)) {
      const int w1 = WedgeAt(*surface_, face.idx(), info.v1.idx());
      if (w1 < 0 || !SameMesh(*surface_, w1, wedge)) continue;
      if (like >= 0 && !NoSeam(*surface_, w1, like)) continue;
      const float agreement = NormalAgreement(*surface_, w1, wedge);
      if (agreement <= closest) continue;
      closest = agreement;
      best = w1;
    }
    return best;
  }

  // Fills moved_. A corner whose seam does not lead to v1 keeps its uv there, which shifts the
  // picture a little; the wedges of v1 lie elsewhere in the picture. False where the mesh itself
  // ends: borders of materials stay.
  bool MapWedges(const CollapseInfo& info, double* shift) {
    moved_.clear();
    bool whole = true;
    const auto& p = surface_->positions[0];
    const double edge2 =
        (p[static_cast<size_t>(info.v1.idx())] - p[static_cast<size_t>(info.v0.idx())]).sqrnorm();
    for (const auto face : Base::mesh().vf_range(info.v0)) {
      if (face == info.fl || face == info.fr) continue;
      const int w0 = WedgeAt(*surface_, face.idx(), info.v0.idx());
      bool exact = false;
      const int continued = Continuation(info, w0, &exact);
      if (continued >= 0) {
        moved_.push_back({face.idx(), exact ? continued : Nearest(info, continued, w0), -1});
        continue;
      }
      const int place = Nearest(info, -1, w0);
      // Without a place the corner stays where it was: a neighbour's collapse took the mesh away in
      // between.
      moved_.push_back({face.idx(), w0, place});
      whole = whole && place >= 0;
      *shift += kStretch * kStretch * edge2 * std::sqrt(FaceArea(face.idx()));
    }
    return whole;
  }

  double FaceArea(int face) const {
    const auto& v = surface_->wedges.faces[static_cast<size_t>(face)].vertices;
    const auto& p = surface_->positions[0];
    const auto a = p[static_cast<size_t>(v[0])];
    return ((p[static_cast<size_t>(v[1])] - a) % (p[static_cast<size_t>(v[2])] - a)).norm() / 2;
  }

  Surface* surface_ = nullptr;
  std::vector<std::vector<Quadric>> quadrics_;  // by pose and vertex
  std::vector<Move> moved_;
};

}  // namespace

struct QuadricDecimater::Impl {
  using Decimater = OpenMesh::Decimater::DecimaterT<HalfEdgeMesh>;

  Surface surface;
  std::vector<Mesh> bind;
  HalfEdgeMesh mesh;
  std::unique_ptr<Decimater> decimater;
  ModSeamQuadric<HalfEdgeMesh>::Handle quadric;
  OpenMesh::Decimater::ModNormalFlippingT<HalfEdgeMesh>::Handle flipping;

  HalfEdgeMesh::VertexHandle AddVertex(int vertex) {
    const auto p = surface.positions[0][static_cast<size_t>(vertex)];
    return mesh.add_vertex(HalfEdgeMesh::Point(static_cast<float>(p[0]), static_cast<float>(p[1]),
                                               static_cast<float>(p[2])));
  }

  // A face that OpenMesh refuses comes back on vertices of its own.
  void AddFaceAgain(Face* face) {
    for (int& v : face->vertices) {
      for (auto& pose : surface.positions) pose.push_back(pose[static_cast<size_t>(v)]);
      v = AddVertex(v).idx();
    }
    mesh.add_face(mesh.vertex_handle(static_cast<unsigned>(face->vertices[0])),
                  mesh.vertex_handle(static_cast<unsigned>(face->vertices[1])),
                  mesh.vertex_handle(static_cast<unsigned>(face->vertices[2])));
  }

  void BuildMesh() {
    const size_t vertices = surface.wedges.wedge_of_vertex.size();
    for (size_t v = 0; v < vertices; ++v) AddVertex(static_cast<int>(v));
    for (Face& face : surface.wedges.faces) {
      const auto handle = [&](size_t k) {
        return mesh.vertex_handle(static_cast<unsigned>(face.vertices[k]));
      };
      // OpenMesh numbers faces as they are added, so they keep our order.
      if (!mesh.add_face(handle(0), handle(1), handle(2)).is_valid()) AddFaceAgain(&face);
    }
    mesh.request_face_normals();
    mesh.update_face_normals();
  }
};

QuadricDecimater::QuadricDecimater(const std::vector<std::vector<Mesh>>& poses)
    : impl_(std::make_unique<Impl>()) {
  Surface& surface = impl_->surface;
  impl_->bind = poses[0];
  surface.meshes = &impl_->bind;
  surface.wedges = JoinWedges(impl_->bind);
  for (const std::vector<Mesh>& pose : poses) {
    auto& positions = surface.positions.emplace_back();
    for (const int wedge : surface.wedges.wedge_of_vertex) {
      const auto& from = surface.wedges.wedges[static_cast<size_t>(wedge)];
      positions.push_back(ToDouble(pose[static_cast<size_t>(from.mesh)].positions[from.vertex]));
    }
  }
  // Refusals are dealt with; OpenMesh need not tell of each.
  omerr().disable();
  impl_->BuildMesh();
  omerr().enable();
  impl_->decimater = std::make_unique<Impl::Decimater>(impl_->mesh);
  impl_->decimater->add(impl_->quadric);
  impl_->decimater->module(impl_->quadric).SetSurface(&surface);
  impl_->decimater->add(impl_->flipping);
  impl_->decimater->module(impl_->flipping).set_max_normal_deviation(kMaxFlip_deg);
  impl_->decimater->initialize();
}

QuadricDecimater::~QuadricDecimater() = default;

int QuadricDecimater::Triangles() const {
  int count = 0;
  for (const auto face : impl_->mesh.faces()) count += face.is_valid() ? 1 : 0;
  return count;
}

void QuadricDecimater::DecimateTo(int triangles) {
  const int surplus = Triangles() - triangles;
  if (surplus <= 0) return;
  // OpenMesh counts faces with the deleted ones of earlier calls.
  const auto all = static_cast<int>(impl_->mesh.n_faces());
  impl_->decimater->decimate_to_faces(0, static_cast<size_t>(std::max(all - surplus, 0)));
}

std::vector<Mesh> QuadricDecimater::Meshes() const {
  const Surface& surface = impl_->surface;
  std::vector<Mesh> out;
  std::map<std::tuple<int, uint32_t, uint32_t>, uint32_t>
      index;  // of a wedge's mesh, vertex and place
  for (const Mesh& mesh : impl_->bind) {
    out.emplace_back();
    out.back().name = mesh.name;
    out.back().material = mesh.material;
  }
  const auto copy = [](const auto& from, size_t v, auto* to) {
    if (!from.empty()) to->push_back(from[v]);
  };
  for (const auto face : impl_->mesh.faces()) {  // skips deleted ones
    for (const int wedge : surface.wedges.faces[static_cast<size_t>(face.idx())].wedges) {
      const WedgeSurface::Wedge from = surface.wedges.wedges[static_cast<size_t>(wedge)];
      const Mesh& mesh = impl_->bind[static_cast<size_t>(from.mesh)];
      Mesh& to = out[static_cast<size_t>(from.mesh)];
      const auto [at, is_new] = index.try_emplace({from.mesh, from.vertex, from.place},
                                                  static_cast<uint32_t>(to.positions.size()));
      if (is_new) {
        copy(mesh.positions, from.place, &to.positions);
        copy(mesh.joints, from.place, &to.joints);
        copy(mesh.weights, from.place, &to.weights);
        copy(mesh.normals, from.vertex, &to.normals);
        copy(mesh.uvs, from.vertex, &to.uvs);
        copy(mesh.uvs1, from.vertex, &to.uvs1);
        copy(mesh.colors, from.vertex, &to.colors);
      }
      to.indices.push_back(at->second);
    }
  }
  return out;
}

}  // namespace flaneur
